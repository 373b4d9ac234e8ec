//! Notes and warnings about a case that can be run.

use spunlaid_ground::{Fault, Finding, Problem};
use std::fmt;
use std::panic::Location;

/// A note or a warning about a case that can be run.
pub type Note = Finding<Remark>;

/// What a note or a warning says about a value of a case. The text continues after `key = value `.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    text: String,
    weight: Weight,
    /// How many times outside of what is usual its number is; 0 where that is not known.
    excess: f64,
    /// Where in the program it arises: all remarks from there are of one kind.
    origin: &'static Location<'static>,
}

/// From how many times outside of what is usual on a number is taken for a slip.
const ABSURD: f64 = 10.0;

/// How much a remark matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Weight {
    /// A choice of the program, which is no flaw: the case with every default written out says it.
    Choice,
    /// For example on rounding.
    Note,
    /// The results may mislead.
    Warning,
    /// A number that no spunbond line is known to have.
    Doubt,
}

impl Remark {
    /// A choice that the program made.
    #[track_caller]
    pub fn choice(text: impl Into<String>) -> Self {
        Self::new(Weight::Choice, text.into())
    }

    /// Something worth knowing.
    #[track_caller]
    pub fn note(text: impl Into<String>) -> Self {
        Self::new(Weight::Note, text.into())
    }

    /// A warning.
    #[track_caller]
    pub fn warning(text: impl Into<String>) -> Self {
        Self::new(Weight::Warning, text.into())
    }

    /// A result that cannot be relied on.
    #[track_caller]
    pub fn doubt(text: impl Into<String>) -> Self {
        Self::new(Weight::Doubt, text.into())
    }

    #[track_caller]
    fn new(weight: Weight, text: String) -> Self {
        Self { text, weight, excess: 0.0, origin: Location::caller() }
    }

    /// Whether its number is outside of what is usual.
    pub fn is_unusual(&self) -> bool {
        self.excess > 0.0
    }

    /// The same of a number that is so many times outside of what is usual.
    pub fn outside_by(self, excess: f64) -> Self {
        Self { excess, ..self }
    }

    /// Whether its number is outside of what is usual by a factor of ten or more, as after a slip of a unit.
    pub fn is_absurd(&self) -> bool {
        self.excess >= ABSURD
    }

    /// Whether this is a warning: the results may mislead. Otherwise it is a note, for example on rounding.
    pub fn is_warning(&self) -> bool {
        self.weight >= Weight::Warning
    }

    /// Whether it is about a number that no spunbond line is known to have.
    pub fn is_doubt(&self) -> bool {
        self.weight == Weight::Doubt
    }

    /// Whether it is a choice of the program, which is no flaw.
    pub fn is_choice(&self) -> bool {
        self.weight == Weight::Choice
    }

    /// Whether another one says the same, perhaps with other numbers.
    pub fn is_like(&self, other: &Self) -> bool {
        self.origin == other.origin
    }

    /// The notes that go with results: all but choices.
    pub fn notes_of_results(notes: &[Note]) -> Vec<String> {
        notes.iter().filter(|note| !note.what.is_choice()).map(Note::to_string).collect()
    }

    /// A warning becomes a problem where something else is wrong with the case, because it may be the cause.
    pub fn problem(Note { place, key, value, what }: Note) -> Problem {
        Problem { place, key, value, what: Fault::plain(what.text) }
    }

    /// The same, said of one file of several.
    pub fn of_file(self, file: &str) -> Self {
        Self { text: format!("{file}: {}", self.text), ..self }
    }
}

impl fmt::Display for Remark {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.text)
    }
}
