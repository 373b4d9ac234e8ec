//! What pages see: as JSON the knobs, the state and the numbers, and the picture.

use super::Session;
use super::flight::other_seed;
use super::found::{answer, found};
use super::knobs::knobs;
use super::known_web::KnownWeb;
use super::plan::{Air, Task};
use crate::board::Topic;
use serde_json::{Value as Json, json};
use spunlaid::experiment::PlantNumber;
use spunlaid::ground::Diagnostic;
use spunlaid_results::command::{beside_of, quoted};

/// A web that takes so many times as long as the one before has a price.
const DEAR: f64 = 1.25;

impl Session {
    /// Shows what has changed.
    pub(super) fn show(&self) {
        let (before, now) = (self.web(self.before), self.web(self.now));
        for (topic, message) in [
            (Topic::State, self.state(before, now)),
            (Topic::Keys, knobs(&self.title(), before, now, &self.slopes)),
            (Topic::Numbers, found(self.picture.generation, before, now)),
        ] {
            let text = message.to_string();
            if !self.board.shows(topic, &text) {
                self.board.show_text(topic, text);
            }
        }
    }

    /// Shows the points and the maps.
    pub(super) fn show_picture(&mut self) {
        let map = |number: u32| Some((number, std::sync::Arc::clone(&self.web(number).laid.as_ref()?.map)));
        let now = if self.now == self.before { None } else { map(self.now) };
        self.picture.maps = [map(self.before), now];
        self.board.show_picture(self.picture.clone());
    }

    /// The name of the line, for headings.
    pub(super) fn title(&self) -> String {
        self.path().file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
    }

    fn state(&self, before: &KnownWeb, now: &KnownWeb) -> Json {
        json!({
            "is": "state",
            "generation": self.picture.generation,
            "pinned": before.number,
            "now": now.number,
            "stands": self.stands,
            "text": now.line.text,
            "command": self.command(now),
            "save_name": self.save_name,
            "plant": now.plant.iter().map(|number| of_plant(number, before)).collect::<Vec<Json>>(),
            "notes": self.notes(before, now),
            "trouble": self.trouble,
            "work": self.work(),
            "answers": self.answers(before),
            "price": price(before, now),
            "confirmation": now.comparison(Air::Other, before.number).map(|one| {
                json!({"seed": other_seed(&now.spec), "is_done": one.is_done})
            }),
        })
    }

    /// Warnings about the line, and what must be known of its numbers.
    fn notes(&self, before: &KnownWeb, now: &KnownWeb) -> Vec<String> {
        let of_line = now.line.notes.iter().filter(|note| note.is_warning()).map(Diagnostic::without_place);
        let laid = now.laid.as_ref().or(before.laid.as_ref());
        let found = laid.into_iter().flat_map(|laid| laid.notes.iter().cloned());
        let no_sketch = self.no_sketch.iter().cloned().chain(too_small(before, now));
        let mut all: Vec<String> = Vec::new();
        for note in of_line.chain(found).chain(no_sketch).chain(self.lacking.iter().cloned()) {
            if !all.contains(&note) {
                all.push(note);
            }
        }
        all
    }

    /// What is simulated.
    fn work(&self) -> Option<Json> {
        let flying = self.flying.as_ref().filter(|flying| !flying.is_unwanted())?;
        let (stage, words) = match flying.task {
            Task::Settle(_) => ("before", "Finding the tension at the end of the spinline"),
            Task::Pin(_) => ("before", "Laying a coarse reference web from a sample of filaments"),
            Task::Compare { air: Air::OfFile, .. } => {
                ("sketch", "Comparing the changed web in the same turbulence")
            }
            Task::Compare { air: Air::Other, .. } => {
                ("confirm", "Simulating both webs again, in turbulence with another seed")
            }
            Task::Lay(_) if self.now == self.before => ("complete", "Laying the complete web"),
            Task::Lay(web) if web == self.before => ("complete", "Laying the complete web before the change"),
            Task::Lay(_) => ("complete", "Laying the complete changed web"),
            Task::Try(_) => ("effects", "Testing the effect of each setting"),
        };
        Some(json!({"stage": stage, "words": words, "share": (100.0 * flying.share).floor() / 100.0}))
    }

    /// The webs of which a number is known, in the order of their numbers.
    fn answers(&self, before: &KnownWeb) -> Vec<Json> {
        let mut webs: Vec<&KnownWeb> = self.webs.iter().collect();
        webs.sort_by_key(|web| web.number);
        let of_web = |web: &KnownWeb| {
            let cv = answer(before, web)?;
            Some(json!({
                "number": web.number,
                "label": web.label,
                "is_now": web.number == self.now,
                "cv": cv.cv,
                "standard_error": cv.standard_error,
                "is_complete": cv.is_complete,
            }))
        };
        webs.into_iter().filter_map(of_web).collect()
    }

    /// The command that lays the same web.
    fn command(&self, web: &KnownWeb) -> String {
        let Some(path) = &self.path else {
            return "save the line first; this command then lays its web".to_owned();
        };
        let set: String = web
            .line
            .set
            .iter()
            .map(|(key, value)| format!(" --set {}", quoted(&format!("{key}={value}"))))
            .collect();
        let file = quoted(&path.to_string_lossy());
        if set.is_empty() {
            return format!("spunlaid web {file}");
        }
        let out =
            beside_of(&format!("results/{}", self.title()), web.line.set.iter().map(|(k, v)| (&**k, &**v)));
        format!("spunlaid web {file}{set} --out {}", quoted(&out))
    }
}

/// A number of the plant, as it is and as it was.
pub(super) fn of_plant(number: &PlantNumber, before: &KnownWeb) -> Json {
    let was = before.plant.iter().find(|other| other.name == number.name);
    json!({"name": number.name, "label": number.label, "now": number.text, "was": was.map(|was| &was.text)})
}

/// That a sample of filaments says nothing, where it does.
fn too_small(before: &KnownWeb, now: &KnownWeb) -> Option<String> {
    let says_nothing = match now.look_beside(Air::OfFile, before.number) {
        _ if now.laid.is_some() => false,
        Some(look) => look.changes.is_empty(),
        None => before.laid.is_none() && before.coarse.as_ref().is_some_and(|look| look.cvs.is_empty()),
    };
    let text = "the sample of filaments is too small for first numbers; the complete web will give them";
    says_nothing.then(|| text.to_owned())
}

/// What a web costs that takes longer than the one before.
fn price(before: &KnownWeb, now: &KnownWeb) -> Option<String> {
    let ratio = now.steps as f64 / before.steps as f64;
    let ratio = Some(ratio).filter(|ratio| ratio.is_finite() && *ratio > DEAR && now.laid.is_none())?;
    let digits = if ratio < 10.0 { 1 } else { 0 };
    Some(format!("takes about {ratio:.digits$} times as long"))
}
