//! Keys that are set from outside, for a web and for the cases that it flies.

use super::super::{Overrides, document};
use crate::case::keys::{self, CASE};
use crate::error::{Error, Fault, Place, Problem};
use crate::layers::full_names::without_numbers;
use crate::layers::keys::WEB;

/// Why a key of a case has no meaning for a web.
const FLIES_NONE: &str = "is a key of a case, and this web flies none";
const NAME_ONE: &str = "write laydown.case in its file";

/// What is set from one place, in two parts: keys of the web, and those of the cases that it flies.
#[derive(Clone, Debug)]
pub(crate) struct Sides {
    pub(crate) of_web: Vec<(String, String)>,
    pub(crate) of_case: Vec<(String, String)>,
    /// What messages call the place.
    word: String,
}

impl Sides {
    /// * `flies` – whether the web flies a case
    pub(crate) fn new(all: impl IntoIterator<Item = (String, String)>, word: &str, flies: bool) -> Self {
        let (of_case, of_web) = all.into_iter().partition(|(key, _)| is_of_case(key.trim(), flies));
        Self { of_web, of_case, word: word.to_owned() }
    }

    /// The parts of what is set from several places, each of which replaces those before it.
    ///
    /// # Errors
    /// If the text is not the file of a web, or if a key of a case is set and the web flies none.
    pub(crate) fn split(text: &str, name: &str, set: &[Overrides<'_>]) -> Result<AllSides, Error> {
        let all = |flies| -> Vec<Self> {
            set.iter().map(|set| Self::new(set.values.to_vec(), set.word, flies)).collect()
        };
        let of_web = all(false);
        let of_web: Vec<Overrides<'_>> = of_web.iter().map(Self::web).collect();
        let key_values = document::read(&WEB, text, name, &of_web)?;
        let flies = key_values.all().any(|(full, _)| full.ends_with("laydown.case"));
        let sides = all(flies);
        let problem = |(sides, (key, value)): (&Self, &(String, String))| Problem {
            place: Place::Override(sides.word.clone()),
            key: key.clone(),
            value: Some(value.clone()),
            what: Fault::new(FLIES_NONE, NAME_ONE),
        };
        let without_case = |sides: &'_ Self| -> Vec<Problem> {
            sides.of_case.iter().filter(|_| !flies).map(|one| problem((sides, one))).collect()
        };
        let problems: Vec<Problem> = sides.iter().flat_map(without_case).collect();
        let is_layered = key_values.get("layer").is_some();
        if problems.is_empty() { Ok(AllSides { sides, flies, is_layered }) } else { Err(problems.into()) }
    }

    /// What is left without some keys.
    pub(crate) fn without(&self, is_left_out: impl Fn(&str) -> bool) -> Self {
        let mut left = self.clone();
        left.of_web.retain(|(key, _)| !is_left_out(key));
        left.of_case.retain(|(key, _)| !is_left_out(key));
        left
    }

    pub(crate) fn web(&self) -> Overrides<'_> {
        Overrides { values: &self.of_web, word: &self.word }
    }

    pub(crate) fn case(&self) -> Overrides<'_> {
        Overrides { values: &self.of_case, word: &self.word }
    }
}

/// What is set from several places, each of which replaces those before it.
pub(crate) struct AllSides {
    pub(crate) sides: Vec<Sides>,
    /// Whether the web flies a case.
    pub(crate) flies: bool,
    /// Whether its file has a list of layers, whose numbers stand in the names of its keys.
    pub(crate) is_layered: bool,
}

/// Whether a key is one of the cases. Both have some: where a case is flown, it says them.
pub(crate) fn is_of_case(name: &str, flies: bool) -> bool {
    keys::find(name).is_some() && (flies || WEB.find(name).is_none())
}

/// Why a key of a case cannot be set or varied, in a sentence.
pub(crate) fn flies_none() -> String {
    format!("it {FLIES_NONE}; {NAME_ONE}")
}

/// Whether a key that is set takes the place of another one.
pub(crate) fn replaces(key: &str, other: &str) -> bool {
    let plain = |full: &str| {
        let name = without_numbers(full);
        name.strip_prefix("layer.").map_or(name.clone(), ToOwned::to_owned)
    };
    let (of_key, of_other) = (plain(key), plain(other));
    key == other || WEB.gives(&of_key, &of_other) || CASE.gives(&of_key, &of_other)
}
