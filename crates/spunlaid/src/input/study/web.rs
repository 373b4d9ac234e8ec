//! The web that a study varies, with the cases that it flies.

use super::super::web::{WebFile, parse_web_of_case, write_web};
use super::super::{Overrides, document};
use super::fixed_keys::TAKE_A_NUMBER;
use super::plan::Plan;
use super::reader::not_varied;
use super::{Base, ExperimentWithNotes, VariedKey, level};
use crate::case::Case;
use crate::case::keys::{self, Value};
use crate::error::{Error, Place, Problem, nearest_word};
use crate::layers::full_names::{full_name, value, web_key, without_numbers};
use crate::layers::keys::WEB;
use crate::layers::{LaydownSource, LayerSpec, SAME, WEB_KEYS, WebSpec};
use crate::study::{Experiment, Point, Quantity, Study};

/// Why a key of a case has no meaning for a web.
const FLIES_NONE: &str = "it is a key of a case, and this web flies none; write laydown.case in its file";

/// The web of a study before its keys vary.
pub(super) struct WebBase {
    text: String,
    /// The path of its file.
    path: String,
    /// What is the same at all points, and the word for it in messages: of the study file, and asked for from outside.
    set: [(Sides, String); 2],
    /// Whether it flies a case.
    flies: bool,
    spec: WebSpec,
}

/// Keys and values of a web, and those of its cases.
#[derive(Clone, Default)]
struct Sides {
    of_web: Vec<(String, String)>,
    of_case: Vec<(String, String)>,
}

impl Sides {
    fn new(all: impl IntoIterator<Item = (String, String)>, flies: bool) -> Self {
        let (of_case, of_web) = all.into_iter().partition(|(key, _)| is_of_case(key.trim(), flies));
        Self { of_web, of_case }
    }
}

/// Whether a key is one of the cases. Both have some: where a case is flown, it says them.
fn is_of_case(name: &str, flies: bool) -> bool {
    keys::find(name).is_some() && (flies || WEB.find(name).is_none())
}

impl WebBase {
    /// * `path` – of the file
    /// * `set` – keys that are the same at all points: those of the study file, and those that replace them
    pub(super) fn new(text: String, path: String, set: [Overrides<'_>; 2]) -> Result<Self, Error> {
        let of_web = set.map(|set| Sides::new(set.values.to_vec(), false).of_web);
        let of_web = [0, 1].map(|i| Overrides { values: &of_web[i], word: set[i].word });
        let key_values = document::read(&WEB, &text, &path, &of_web)?;
        let flies = key_values.all().any(|(full, _)| full.ends_with("laydown.case"));
        let set = set.map(|Overrides { values, word }| (Sides::new(values.to_vec(), flies), word.to_owned()));
        let no_case = |(sides, word): &(Sides, String)| -> Vec<Problem> {
            let problem = |(key, value): &(String, String)| Problem {
                place: Place::Override(word.clone()),
                key: key.clone(),
                value: Some(value.clone()),
                what: not_varied(FLIES_NONE),
            };
            sides.of_case.iter().filter(|_| !flies).map(problem).collect()
        };
        let problems: Vec<Problem> = set.iter().flat_map(no_case).collect();
        if !problems.is_empty() {
            return Err(problems.into());
        }
        let WebFile { spec, .. } = parse(&text, &path, &set, &Sides::default())?;
        Ok(Self { text, path, set, flies, spec })
    }

    /// The web with these values of keys, and with a seed of its own if there is one.
    pub(super) fn file(&self, values: &[(VariedKey, f64)], seed: Option<u64>) -> Result<WebFile, Error> {
        let value = |(key, value): &(VariedKey, f64)| (key.name.clone(), key.exact(*value));
        let seed = seed.map(|seed| ("web.seed".to_owned(), seed.to_string()));
        let point = Sides::new(values.iter().map(value).chain(seed), self.flies);
        parse(&self.text, &self.path, &self.set, &point)
    }

    /// The web before its keys vary.
    pub(super) const fn spec(&self) -> &WebSpec {
        &self.spec
    }

    /// The number of a key of the cases, if all that are flown have the same.
    pub(super) fn number_of_cases(&self, name: &str) -> Option<f64> {
        let number = |layer: &LayerSpec| Some(value_in_case(layer.source.case()?, name)?.number());
        let mut numbers = self.spec.layers.iter().filter_map(number);
        let first = numbers.next()??;
        let is_same =
            |other: Option<f64>| other.is_some_and(|other| (other - first).abs() <= SAME * first.abs());
        numbers.all(is_same).then_some(first)
    }

    /// The case that it flies, the first of several.
    fn case_value(&self, name: &str) -> Option<Value> {
        let case = self.spec.layers.iter().find_map(|layer| match &layer.source {
            LaydownSource::Case { case, .. } => Some(&**case),
            _ => None,
        });
        value_in_case(case?, name)
    }
}

/// The value of a key of a case.
fn value_in_case(case: &Case, name: &str) -> Option<Value> {
    // The diameter of a case stands for its titre.
    if name == "fibre.linear_density" {
        Some(case.linear_density().into())
    } else {
        keys::find(name)?.get(case)
    }
}

/// Reads a web with these values.
fn parse(text: &str, path: &str, set: &[(Sides, String); 2], point: &Sides) -> Result<WebFile, Error> {
    let [file, outside] = set;
    let all = [(&file.0, &*file.1), (&outside.0, &*outside.1), (point, "point")];
    let of_web = all.map(|(sides, word)| Overrides { values: &sides.of_web, word });
    let of_case = all.map(|(sides, word)| Overrides { values: &sides.of_case, word });
    parse_web_of_case(text, path, &of_web, &of_case, &[])
}

impl Base for WebBase {
    fn varied(&self, name: &str) -> Result<VariedKey, String> {
        if let Some(key) = keys::find(name).filter(|_| is_of_case(name, self.flies)) {
            return match (self.flies, key.varies) {
                (false, _) => Err(FLIES_NONE.to_owned()),
                (true, false) => {
                    Err("the flights of all points have the same; write it under [set]".to_owned())
                }
                (true, true) => Ok(VariedKey::new(name.to_owned(), &key.kind)),
            };
        }
        let full = full_name(&self.spec, name)?;
        match web_key(&full) {
            Some(key) if key.varies => Ok(VariedKey::new(full, &key.kind)),
            Some(_) => Err(TAKE_A_NUMBER.to_owned()),
            None => {
                let of_layer = without_numbers(&full);
                let plain = of_layer.strip_prefix("layer.").unwrap_or(&of_layer);
                Err(match nearest_word(plain, WEB_KEYS.iter().map(|key| key.name)) {
                    Some(near) => format!("did you mean {near}?"),
                    None => format!("{TAKE_A_NUMBER}, of the web or of its case"),
                })
            }
        }
    }

    fn value(&self, key: &VariedKey) -> f64 {
        let found = if is_of_case(&key.name, self.flies) {
            self.case_value(&key.name)
        } else {
            value(&self.spec, &key.name)
        };
        found.and_then(|value| level(key.kind, &value)).unwrap_or(f64::NAN)
    }

    fn seed_and_replicates(&self) -> (u64, u64) {
        (self.spec.seed, 1)
    }

    fn quantities(&self) -> Vec<Quantity> {
        let experiment = Experiment::Web(self.spec.clone());
        Study::quantities_of(&[Point { values: Vec::new(), experiment }])
    }

    fn point(
        &self,
        values: &[(VariedKey, f64)],
        _: &Place,
        _: &Plan,
        seed: Option<u64>,
    ) -> ExperimentWithNotes {
        let WebFile { spec, notes, .. } = self.file(values, seed)?;
        Ok((Experiment::Web(spec), notes))
    }

    fn keys_to_write(&self, set: Vec<(String, String)>) -> Vec<(String, String)> {
        // What is set is in the web already, but for its case.
        Sides::new(set, self.flies).of_case
    }

    fn text(&self) -> String {
        write_web(&self.spec)
    }
}
