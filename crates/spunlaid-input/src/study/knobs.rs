//! The knobs of a line: its settings as somebody turns them, several at once and by any amount.
//!
//! ```text
//! file → settings of the line (`line.rs`), each with its keys → `Knob`
//! `Turn`s → keys and values → the same file with these set → `TurnedLine`
//! ```

use super::super::edit::with_keys;
use super::super::influence::Step;
use super::super::web::WebFile;
use super::super::{Overrides, Resources};
use super::line::{KnownKey, LineKnob, WebToChange};
use super::web::WebBase;
use super::written_at;
use spunlaid_air::Flow;
use spunlaid_experiment::plausible::LIMITS;
use spunlaid_experiment::{Change, setting};
use spunlaid_fibre::Case;
use spunlaid_fibre::case::keys::VariedKey;
use spunlaid_ground::error::Place;
use spunlaid_ground::{Diagnostic, Dimension, Error, Fault, Setting};
use spunlaid_simulation::layers::full_names::{layer_and_name, web_key};
use spunlaid_simulation::{WebKey, WebSpec};

/// What messages write before a key that a knob has set.
const KNOB: &str = "knob";
/// Digits of the number to which a knob is turned.
const DIGITS: usize = 12;
/// A factor on the speeds of a table of the air.
const SPEED_FACTOR: &str = "air.speed_factor";
/// How far the slider of a knob goes: factors on its value, and the change of a temperature either way [K].
const FACTORS: [f64; 2] = [0.5, 2.0];
const KELVINS: f64 = 25.0;

/// A line whose knobs can be turned.
pub struct LineFile {
    text: String,
    base: WebBase,
    knobs: Vec<LineKnob>,
}

/// What a knob shows of a number in the file.
struct Shown {
    dimension: Dimension,
    /// What it shows of the number 1.
    size: f64,
}

/// A setting of a line that can be turned.
#[derive(Clone, Debug, PartialEq)]
pub struct Knob {
    /// A name that no other knob of the line has: `throughput`, or `throughput.2` where the second layer has one of
    /// its own.
    pub name: String,
    /// In words.
    pub label: String,
    /// The setting, which says when it can be turned.
    pub setting: Setting,
    /// Numbers of the layers in which it is turned, from 1; none where it is turned in all.
    pub layers: Vec<usize>,
    /// The keys that change, by their names in the file. The value is that of the first one, and the others follow.
    /// A factor on a table of the air has the speed at the slot as its value.
    pub keys: Vec<String>,
    /// Physical dimension of the value.
    pub dimension: Dimension,
    /// Whether the value is a whole number.
    pub is_whole: bool,
    /// The value [SI].
    pub value: f64,
    /// Least and greatest value of a slider [SI]: half and twice the value, or 25 K less and more of a temperature,
    /// as far as spunbond lines have it. Both are those of the file, and go as far as the value.
    pub range: [f64; 2],
}

impl Knob {
    /// Whether a change of [`LineFile::changes`] is one of this knob.
    pub fn is_changed_by(&self, change: &Change) -> bool {
        change.setting.name == self.setting.name && change.layers == self.layers
    }
}

/// A knob that is turned.
#[derive(Clone, Debug, PartialEq)]
pub struct Turn {
    /// The name of the knob.
    pub name: String,
    /// Its new value [SI].
    pub value: f64,
}

/// A line after some of its knobs have been turned.
#[derive(Clone, Debug)]
pub struct TurnedLine {
    /// The web.
    pub spec: WebSpec,
    /// Keys and values with which the file is this web. As in advice, what holds the basis weight is among them.
    pub set: Vec<(String, String)>,
    /// The file with these values, for the same folder. Its comments stay.
    pub text: String,
    /// The knobs of the file with the values that they have now: those that were turned, and what follows from them.
    pub knobs: Vec<Knob>,
    /// Notes and warnings.
    pub notes: Vec<Diagnostic>,
    /// Whether flights have still to find a tension: until then the web is that of a tension of 0 N
    /// (`Resources::resolve_tension`).
    pub needs_flights: bool,
}

/// Reads the file of a web as a line whose knobs can be turned.
///
/// * `name` – its path, for messages and for the files that it names
/// * `resources` – as of [`read_web`](crate::read_web)
///
/// # Errors
/// As [`read_web`](crate::read_web).
pub fn read_line(text: &str, name: &str, resources: &Resources) -> Result<LineFile, Error> {
    let base = WebBase::new(text, name.to_owned(), &[], resources)?;
    let web = WebToChange { base: &base, set: &[], resources };
    let knobs = [web.knobs(), web.knobs_of_belt()].concat();
    Ok(LineFile { text: text.to_owned(), base, knobs })
}

impl LineFile {
    /// The web as it is written.
    pub fn spec(&self) -> &WebSpec {
        self.base.spec()
    }

    /// Notes and warnings about the file.
    pub fn notes(&self) -> &[Diagnostic] {
        &self.base.file.notes
    }

    /// The knobs, with those of the belt at the end.
    pub fn knobs(&self) -> Vec<Knob> {
        let knob = |knob: &LineKnob| self.knob(knob, knob.known.first()?.from);
        self.knobs.iter().filter_map(knob).collect()
    }

    /// The changes of the knobs that advice tries: 20 % less and more, or 10 K.
    pub fn changes(&self) -> Vec<Change> {
        self.knobs.iter().flat_map(|knob| knob.changes.clone()).collect()
    }

    /// The web with knobs turned, all of them together and from the file as it is written.
    ///
    /// The belt follows, so that the basis weight stays. Where the belt itself is turned, it has that speed, and where
    /// the basis weight is turned, the web has that one; of both, the last one counts. A knob that stands where it
    /// stood sets nothing.
    ///
    /// # Errors
    /// If a knob is not there, or takes no such value; if the web cannot be laid; or if numbers are outside of what is
    /// usual by a factor of ten or more, and were not before.
    pub fn turned(&self, turns: &[Turn], resources: &Resources) -> Result<TurnedLine, Error> {
        let web = WebToChange { base: &self.base, set: &[], resources };
        let turned = self.found(turns)?;
        let values = values(&web, &turned);
        let mut set: Vec<(String, String)> = web.settings_of(&values).collect();
        if !set.is_empty() && !turned.iter().any(|(knob, _)| is_of_belt(knob)) {
            set.extend(web.held_weight());
        }
        let path = self.base.path();
        let base = WebBase::new(&self.text, path.to_owned(), &[Overrides::new(&set, KNOB)], resources);
        let is_absurd = self.notes().iter().any(|note| note.is_absurd);
        let in_reason = |base: WebBase| if is_absurd { Ok(base) } else { base.within_reason() };
        let base = base.and_then(in_reason).map_err(of_knobs_first)?;
        let now = WebToChange { base: &base, set: &[], resources };
        let knobs = self.knobs.iter().filter_map(|knob| self.knob(knob, now.value(knob)?)).collect();
        let text = self.text_with(&set).ok_or_else(|| {
            Fault::new(
                format!("the text of {path} cannot be changed"),
                "write its tables with headings, [line]",
            )
        })?;
        let WebFile { spec, notes, .. } = base.file;
        let needs_flights = spec.cases().any(Case::waits_for_flights);
        Ok(TurnedLine { spec, set, text, knobs, notes, needs_flights })
    }

    /// The knobs that are turned, each to a value that its key takes.
    fn found(&self, turns: &[Turn]) -> Result<Vec<(&LineKnob, f64)>, Error> {
        let place = Place::Override(KNOB.to_owned());
        let mut found: Vec<(&LineKnob, f64)> = Vec::new();
        for Turn { name, value } in turns {
            let knob = self.knobs.iter().find(|knob| knob.name() == *name).ok_or_else(|| {
                let all: Vec<String> = self.knobs.iter().map(LineKnob::name).collect();
                let what =
                    Fault::new("is not a setting of this line", format!("change one of {}", all.join(", ")));
                vec![Diagnostic { place: place.clone(), key: name.clone(), ..what.into() }]
            })?;
            let Some(known @ KnownKey { key, from, .. }) = knob.known.first() else { continue };
            let Shown { size, .. } = self.shown(known);
            // What is shown of the file is the file to the last digit.
            let value = if *value == size * from { *from } else { value / size };
            let value = if key.is_whole() { value.round() } else { value };
            let named = VariedKey::new(self.base.short_name(&key.name), key.kind);
            written_at(&[(named, value)], &place)?;
            found.retain(|(other, _)| other.name() != *name && !(is_of_belt(knob) && is_of_belt(other)));
            if value != *from || is_of_belt(knob) {
                found.push((knob, value));
            }
        }
        Ok(found)
    }

    /// The text of the file with these keys set.
    fn text_with(&self, set: &[(String, String)]) -> Option<String> {
        let names: Vec<&str> = set.iter().map(|(key, _)| &**key).collect();
        let displaced = self.base.replaced_by(&names);
        // What the file says by another name stays where it stands.
        let is_layered = self.base.is_layered();
        let other =
            |key: &str| displaced.iter().copied().find(|other| !is_layered && is_same_number(key, other));
        let set: Vec<(&str, &str)> =
            set.iter().map(|(key, value)| (other(key).unwrap_or(key), &**value)).collect();
        let removed = displaced.iter().copied().filter(|name| !set.iter().any(|(key, _)| key == name));
        with_keys(&self.text, removed, set.iter().copied())
    }

    /// What a knob shows of the number of its first key. A factor on a table of the air is the speed at the slot, if
    /// all layers have one table.
    fn shown(&self, first: &KnownKey) -> Shown {
        let of_table = |case: &Case| match &case.air.flow {
            Flow::Profile(profile) => profile.velocity_at_root().filter(|speed| *speed > 0.0),
            Flow::Uniform | Flow::Field(_) => None,
        };
        let mut speeds = self.spec().cases().map(of_table);
        match speeds.next().flatten() {
            Some(size) if first.key.name == SPEED_FACTOR && speeds.all(|other| other == Some(size)) => {
                Shown { dimension: Dimension::Velocity, size }
            }
            _ => Shown { dimension: first.key.dimension(), size: 1.0 },
        }
    }

    /// A knob with the value that it has now.
    fn knob(&self, knob: &LineKnob, value: f64) -> Option<Knob> {
        let (name, first) = (knob.name(), knob.known.first()?);
        let Shown { dimension, size } = self.shown(first);
        // A factor on a table has no unit that would say what it is.
        let is_factor = first.key.name.ends_with("_factor") && dimension == first.key.dimension();
        let label = knob.label(is_factor);
        let value = size * value;
        let [least, greatest] = range(first).map(|end| size * end);
        let changed = knob.known.iter().filter(|known| known.power != 0.0);
        Some(Knob {
            name,
            label,
            setting: knob.setting,
            layers: knob.layers.clone(),
            keys: changed.map(|known| self.base.short_name(&known.key.name).to_owned()).collect(),
            dimension,
            is_whole: first.key.is_whole(),
            value,
            range: [least.min(value), greatest.max(value)],
        })
    }
}

impl LineKnob {
    fn name(&self) -> String {
        let Setting { name, .. } = self.setting;
        self.layers.first().map_or_else(|| name.to_owned(), |layer| format!("{name}.{layer}"))
    }

    fn label(&self, is_factor: bool) -> String {
        let words = format!("{}{}", self.setting.words, if is_factor { ", as a factor" } else { "" });
        let layers: Vec<String> = self.layers.iter().map(ToString::to_string).collect();
        match &layers[..] {
            [] => words,
            [layer] => format!("{words}, layer {layer}"),
            _ => format!("{words}, layers {}", layers.join(", ")),
        }
    }
}

/// What is wrong with what the knobs have set is said before what follows from it.
fn of_knobs_first(error: Error) -> Error {
    match error {
        Error::Rejected(problems) => {
            let is_set = |problem: &Diagnostic| matches!(problem.place, Place::Override(_));
            let (first, others): (Vec<_>, Vec<_>) = problems.into_iter().partition(is_set);
            [first, others].concat().into()
        }
        other => other,
    }
}

/// Whether a knob is one of the belt, under which the filaments fly as they did.
fn is_of_belt(knob: &LineKnob) -> bool {
    [setting::BELT_SPEED, setting::BASIS_WEIGHT].contains(&knob.setting)
}

/// The values of all keys that some knobs set. What one of them holds is no longer held where another one turns it.
fn values(web: &WebToChange<'_>, turned: &[(&LineKnob, f64)]) -> Vec<(VariedKey, f64)> {
    let known = || turned.iter().flat_map(|(knob, _)| &knob.known);
    let is_turned = |key: &VariedKey| known().any(|known| known.key == *key && known.power != 0.0);
    let of_knob = |(knob, value): &(&LineKnob, f64)| {
        let from = knob.known.first().map_or(f64::NAN, |known| known.from);
        let step = Step { factor: value / from, kelvin: value - from };
        let values = web.values(knob, step, DIGITS);
        let kept = |((key, _), known): &(&(VariedKey, f64), &KnownKey)| known.power != 0.0 || !is_turned(key);
        values.iter().zip(&knob.known).filter(kept).map(|(value, _)| value.clone()).collect::<Vec<_>>()
    };
    turned.iter().flat_map(of_knob).collect()
}

/// Whether two keys are one number, which a web may say in its own words and in those of a case.
fn is_same_number(a: &str, b: &str) -> bool {
    let name = |full| {
        let of_case = web_key(full).and_then(WebKey::key_of_case);
        of_case.map_or_else(|| layer_and_name(full).1, |key| key.name.to_owned())
    };
    name(a) == name(b)
}

/// The least and the greatest value of a slider.
fn range(known: &KnownKey) -> [f64; 2] {
    let KnownKey { key, from, .. } = known;
    let name = layer_and_name(&key.name).1;
    let limit = LIMITS.iter().find(|limit| limit.key == name && !limit.is_law);
    let [least, greatest] =
        limit.map_or([f64::NEG_INFINITY, f64::INFINITY], |limit| limit.range.map(|end| end * limit.unit.1));
    let steps = FACTORS.map(|factor| Step { factor, kelvin: KELVINS * (factor - 1.0).signum() });
    let ends = steps.map(|step| step.apply(&key.kind, *from).clamp(least, greatest));
    [ends[0].min(ends[1]).min(*from), ends[0].max(ends[1]).max(*from)]
}
