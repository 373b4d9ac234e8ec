//! The web that a study varies, with the cases that it flies.

use super::super::Overrides;
use super::super::web::{WebFile, parse_web_of_case, write_web};
use super::plan::Plan;
use super::{Base, MadeExperiment, VariedKey, level};
use crate::case::keys::{self, nearest_word};
use crate::error::{Error, Place};
use crate::layers::{LaydownSource, WEB_KEYS, WebSpec, keys as web_keys};
use crate::study::{Experiment, Point, Quantity, Study};

/// The web of a study before its keys vary.
pub(super) struct WebBase {
    text: String,
    /// The path of its file.
    path: String,
    /// What is the same at all points, and the word for it in messages: of the study file, and asked for from outside.
    set: [(Sides, String); 2],
    file: WebFile,
}

/// Keys and values of a web, and those of its cases.
#[derive(Clone, Default)]
struct Sides {
    of_web: Vec<(String, String)>,
    of_case: Vec<(String, String)>,
}

impl Sides {
    fn new(all: impl IntoIterator<Item = (String, String)>) -> Self {
        let is_of_case = |(key, _): &(String, String)| {
            of_web(key).is_none() && keys::find(key).is_some_and(|key| key.varies)
        };
        let (of_case, of_web) = all.into_iter().partition(is_of_case);
        Self { of_web, of_case }
    }
}

/// The key of a web with this name, if its values can vary.
fn of_web(name: &str) -> Option<VariedKey> {
    web_keys::find(name).filter(|key| key.varies).map(VariedKey::from)
}

impl WebBase {
    /// * `path` – of the file
    /// * `set` – keys that are the same at all points: those of the study file, and those that replace them
    pub(super) fn new(text: String, path: String, set: [Overrides<'_>; 2]) -> Result<Self, Error> {
        let set = set.map(|Overrides { values, word }| (Sides::new(values.to_vec()), word.to_owned()));
        let file = parse(&text, &path, &set, &Sides::default())?;
        Ok(Self { text, path, set, file })
    }

    fn spec(&self) -> &WebSpec {
        &self.file.spec
    }

    /// Whether it flies a case.
    fn flies(&self) -> bool {
        self.spec().layers.iter().any(|layer| matches!(layer.source, LaydownSource::Case { .. }))
    }
}

/// Reads a web with these values.
fn parse(text: &str, path: &str, set: &[(Sides, String); 2], point: &Sides) -> Result<WebFile, Error> {
    let all =
        |side: fn(&Sides) -> &[(String, String)]| [side(&set[0].0), side(&set[1].0), side(point)].concat();
    let (web, case) = (all(|sides| &sides.of_web), all(|sides| &sides.of_case));
    let word = if set[1].0.of_web.is_empty() && set[1].0.of_case.is_empty() { &set[0].1 } else { &set[1].1 };
    parse_web_of_case(text, path, Overrides { values: &web, word }, Overrides { values: &case, word }, &[])
}

impl Base for WebBase {
    fn varied(&self, name: &str) -> Result<VariedKey, String> {
        let advice = match (of_web(name), keys::find(name).filter(|key| key.varies)) {
            (Some(key), _) if self.spec().layers.len() == 1 || key.name.starts_with("web.") => {
                return Ok(key);
            }
            (Some(_), _) => "the web has several layers; vary keys of its table [web], or of its cases",
            (None, Some(key)) if self.flies() => return Ok(key.into()),
            (None, Some(_)) => {
                "it is a key of a case, and this web flies none; write laydown.case in its file"
            }
            (None, None) => match nearest_word(name, WEB_KEYS.iter().map(|key| key.name)) {
                Some(near) if near != name => return Err(format!("did you mean {near}?")),
                _ => "take a key whose value is a number or one of a few words, of the web or of its case",
            },
        };
        Err(advice.to_owned())
    }

    fn value(&self, key: VariedKey) -> f64 {
        let of_case = || {
            let case = self.spec().layers.iter().find_map(|layer| match &layer.source {
                LaydownSource::Case { case, .. } => Some(&**case),
                _ => None,
            });
            level(key.kind, &keys::find(key.name)?.get(case?)?)
        };
        let Some(found) = web_keys::find(key.name) else { return of_case().unwrap_or(f64::NAN) };
        let of_spec = found.get(self.spec()).and_then(|value| level(key.kind, &value));
        of_spec.unwrap_or(f64::NAN)
    }

    fn seed_and_replicates(&self) -> (u64, u64) {
        (self.spec().seed, 1)
    }

    fn quantities(&self) -> Vec<Quantity> {
        let experiment = Experiment::Web(self.spec().clone());
        Study::quantities_of(&[Point { values: Vec::new(), experiment }])
    }

    fn point(&self, values: &[(VariedKey, f64)], _: &Place, _: &Plan, seed: Option<u64>) -> MadeExperiment {
        let value = |(key, value): &(VariedKey, f64)| (key.name.to_owned(), key.exact(*value));
        let seed = seed.map(|seed| ("web.seed".to_owned(), seed.to_string()));
        let point = Sides::new(values.iter().map(value).chain(seed));
        let WebFile { spec, notes, .. } = parse(&self.text, &self.path, &self.set, &point)?;
        Ok((Experiment::Web(spec), notes))
    }

    fn set_beside(&self, set: Vec<(String, String)>) -> Vec<(String, String)> {
        // What is set is in the web already, but for its case.
        Sides::new(set).of_case
    }

    fn text(&self) -> String {
        write_web(self.spec())
    }
}
