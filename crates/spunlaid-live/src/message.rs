//! The requests of a page, as JSON. The messages to the pages are written where their content is known.

use super::board::{Board, PageId};
use serde::{Deserialize, Serialize};

use spunlaid::ground::{Diagnostic, Error};
use std::collections::BTreeSet;
use std::iter;
use std::sync::mpsc::Receiver;

/// Size of the largest message that is read [bytes].
pub(super) const LARGEST: usize = 1 << 18;

/// Messages that are heard before something is shown.
const MOST_HEARD: usize = 256;

/// Something that a page asks for.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
pub(super) enum Command {
    /// Change a key. The answer repeats the stamp.
    Set { key: String, value: KeyValue, stamp: u64 },
    /// Fly this case.
    Case { text: String },
    /// Fly the filament of a line as its knobs are now. The session of the line asks for it, and no page.
    #[serde(skip)]
    Filament { text: String },
    /// Fly at another pace.
    Pace { pace: Pace },
    /// Stop the time.
    Pause {},
    /// Let the time go on.
    Go {},
    /// Go on by one recorded instant and stop.
    Step {},
    /// Start the fibres again, straight and at rest; of a line all knobs as in the web of comparison.
    Reset {},
    /// Begin the statistics again.
    Forget {},
    /// What the plant's numbers would be with a knob at this value, while its slider is held. Nothing is simulated.
    Preview { key: String, value: KeyValue, stamp: u64 },
    /// The present web becomes the one with which others are compared.
    Pin {},
    /// Simulate the change from the web of comparison to the present one again, in an air with another seed.
    Confirm {},
    /// The knobs of an earlier answer.
    Back { to: u32 },
    /// Whether the page can be seen.
    Look { visible: bool },
    /// Write the case or the line as a file into the folder where the program was started.
    Save { name: String, replace: bool },
}

/// The value of a key: a number in SI units, or a text as in a case file.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(untagged)]
pub(super) enum KeyValue {
    Number(f64),
    Text(String),
}

/// How fast the time of the fibres goes.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum Pace {
    Real,
    Tenth,
    Hundredth,
    /// As fast as it goes.
    Free,
}

impl Pace {
    /// Time of the fibres over time of the clock; `None` as fast as it goes.
    pub(super) const fn ratio(self) -> Option<f64> {
        match self {
            Self::Real => Some(1.0),
            Self::Tenth => Some(0.1),
            Self::Hundredth => Some(0.01),
            Self::Free => None,
        }
    }
}

/// An answer to the one page that asked.
#[derive(Clone, Debug, Serialize, PartialEq)]
#[serde(tag = "is", rename_all = "snake_case")]
pub(super) enum Answer {
    /// A change was made; frames of this generation or later show it.
    Applied { stamp: u64, generation: u32 },
    /// The plant's numbers with a knob at the value that was sent with this stamp, the others as in this generation;
    /// none where flights have to find a tension first.
    Preview { stamp: u64, generation: u32, plant: Vec<serde_json::Value> },
    /// The case was saved under this name.
    Saved { name: String },
    /// There is a file of this name already.
    Exists { name: String },
    /// What was asked cannot be done.
    Refused { about: Subject, problems: Vec<PageDiagnostic> },
}

/// What a refusal is about, so that the page shows it there.
#[derive(Clone, Copy, Debug, Serialize, PartialEq)]
#[serde(tag = "is", rename_all = "snake_case")]
pub(super) enum Subject {
    /// The value of a key, which was sent with this stamp.
    Setting { stamp: u64 },
    /// A value that a slider has passed.
    Preview,
    /// The name of a file.
    Name,
    /// Something else.
    Other,
}

/// A message of a page.
#[derive(Debug)]
pub(super) struct PageRequest {
    pub(super) page: PageId,
    pub(super) command: Command,
}

impl PageRequest {
    /// Whether a later message sets the same key: of values that come at once only the last one counts.
    pub(super) fn is_replaced_by(&self, later: &Self) -> bool {
        match (&self.command, &later.command) {
            (Command::Set { key, .. }, Command::Set { key: other, .. }) => key == other,
            (Command::Preview { .. }, Command::Preview { .. } | Command::Set { .. }) => {
                self.page == later.page
            }
            _ => false,
        }
    }
}

/// A session that hears what pages ask.
pub(super) trait Receives {
    /// Does what was asked.
    ///
    /// # Errors
    /// The answer that refuses it.
    fn dispatch(&mut self, command: &Command) -> Result<Option<Answer>, Answer>;

    /// The generation that the next change of a key will have.
    fn next_generation(&self) -> u32;

    /// The pages that can be seen.
    fn pages(&mut self) -> &mut BTreeSet<PageId>;

    /// Does what has come at once, and answers it; returns whether more was asked than to look.
    fn receive<P>(&mut self, requests: &[PageRequest], board: &Board<P>) -> bool {
        let mut is_asked = false;
        for (i, request) in requests.iter().enumerate() {
            let PageRequest { page, command } = request;
            // Each of several values gets its answer.
            let is_replaced = requests[i + 1..].iter().any(|later| request.is_replaced_by(later));
            let answer = match command {
                Command::Look { visible: true } => {
                    self.pages().insert(*page);
                    None
                }
                Command::Look { visible: false } => {
                    self.pages().remove(page);
                    None
                }
                Command::Set { stamp, .. } if is_replaced => {
                    Some(Answer::Applied { stamp: *stamp, generation: self.next_generation() })
                }
                Command::Preview { .. } if is_replaced => None,
                command => {
                    is_asked = true;
                    self.dispatch(command).unwrap_or_else(|refusal| Some(refusal.about(command.subject())))
                }
            };
            if let Some(answer) = answer {
                board.answer(*page, answer.json());
            }
        }
        is_asked
    }
}

/// What has come at once, of which the first is there already.
pub(super) fn at_once<T>(first: T, heard: &Receiver<T>) -> Vec<T> {
    iter::once(first).chain(heard.try_iter()).take(MOST_HEARD).collect()
}

impl Command {
    /// What its refusal would be about.
    pub(super) const fn subject(&self) -> Subject {
        match self {
            Self::Set { stamp, .. } => Subject::Setting { stamp: *stamp },
            Self::Preview { .. } => Subject::Preview,
            Self::Save { .. } => Subject::Name,
            _ => Subject::Other,
        }
    }
}

/// A diagnostic as a page shows it: why something cannot be done.
#[derive(Clone, Debug, Serialize, PartialEq)]
pub(super) struct PageDiagnostic {
    /// Line of the case, counted from 1, if it is about one.
    pub(super) line: Option<usize>,
    /// In words.
    pub(super) text: String,
}

pub(super) fn diagnostic(text: impl Into<String>) -> Vec<PageDiagnostic> {
    vec![PageDiagnostic { line: None, text: text.into() }]
}

/// The problems of an error, each with its line.
pub(super) fn diagnostics(error: &Error) -> Vec<PageDiagnostic> {
    let Error::Rejected(problems) = error else {
        return diagnostic(error.to_string());
    };
    let on_page = |problem: &Diagnostic| {
        let line = problem.place.line().and_then(|line| usize::try_from(line).ok());
        PageDiagnostic { line, text: problem.without_place() }
    };
    problems.iter().take(20).map(on_page).collect()
}

impl Answer {
    pub(super) fn refused(text: impl Into<String>) -> Self {
        Self::rejected(vec![PageDiagnostic { line: None, text: text.into() }])
    }

    pub(super) const fn rejected(problems: Vec<PageDiagnostic>) -> Self {
        Self::Refused { about: Subject::Other, problems }
    }

    /// The answer to a request about this.
    pub(super) fn about(self, about: Subject) -> Self {
        match self {
            Self::Refused { problems, .. } => Self::Refused { about, problems },
            other => other,
        }
    }

    /// Why it refuses.
    pub(super) fn words(&self) -> String {
        let Self::Refused { problems, .. } = self else { return String::new() };
        problems.iter().map(|problem| problem.text.as_str()).collect::<Vec<_>>().join("; ")
    }

    pub(super) fn json(&self) -> String {
        // A value of this type always has a text.
        serde_json::to_string(self).unwrap_or_default()
    }
}

/// Reads a message.
///
/// # Errors
/// The answer to a message that is none.
pub(super) fn read(text: &str) -> Result<Command, Answer> {
    serde_json::from_str(text)
        .map_err(|error| Answer::refused(format!("this message is not understood: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_message_of_the_page_is_understood() {
        let set = |value| Command::Set { key: "air.velocity".to_owned(), value, stamp: 7 };
        for (text, expected) in [
            (r#"{"do":"set","key":"air.velocity","value":20,"stamp":7}"#, set(KeyValue::Number(20.0))),
            (
                r#"{"do":"set","key":"air.velocity","value":"20 m/s","stamp":7}"#,
                set(KeyValue::Text("20 m/s".to_owned())),
            ),
            (r#"{"do":"case","text":"[fibre]"}"#, Command::Case { text: "[fibre]".to_owned() }),
            (r#"{"do":"pace","pace":"hundredth"}"#, Command::Pace { pace: Pace::Hundredth }),
            (r#"{"do":"pause"}"#, Command::Pause {}),
            (r#"{"do":"go"}"#, Command::Go {}),
            (r#"{"do":"step"}"#, Command::Step {}),
            (r#"{"do":"reset"}"#, Command::Reset {}),
            (r#"{"do":"forget"}"#, Command::Forget {}),
            (r#"{"do":"pin"}"#, Command::Pin {}),
            (r#"{"do":"back","to":1}"#, Command::Back { to: 1 }),
            (r#"{"do":"look","visible":false}"#, Command::Look { visible: false }),
            (
                r#"{"do":"save","name":"a","replace":true}"#,
                Command::Save { name: "a".to_owned(), replace: true },
            ),
        ] {
            assert_eq!(read(text), Ok(expected), "{text}");
        }
    }

    #[test]
    fn rejects_messages_that_are_none() {
        let deep = "[".repeat(100_000);
        for text in [
            "",
            "null",
            "{}",
            r#"{"do":"fly"}"#,
            r#"{"do":"pause","now":true}"#,
            r#"{"do":"set","key":"air.velocity","value":null,"stamp":7}"#,
            r#"{"do":"set","key":"air.velocity","value":1e999,"stamp":7}"#,
            r#"{"do":"set","key":"air.velocity","value":1,"stamp":-7}"#,
            r#"{"do":"pace","pace":"double"}"#,
            r#"{"do":"back","to":-1}"#,
            r#"{"do":"pin","to":1}"#,
            &deep,
        ] {
            let Err(Answer::Refused { problems, .. }) = read(text) else {
                panic!("{text} is understood");
            };
            assert!(problems[0].text.starts_with("this message is not understood: "), "{problems:?}");
        }
    }
}
