//! The paragraph about methods in every report: by what the numbers were made, where the case stands, and what is cited.

mod reference;

pub(super) use reference::{MOMENTS, Reference, of_case, of_web};

use super::document::{Part, Section};
use reference::PROGRAM;

/// A paragraph to copy, and below it the works that it cites, each once, the program first.
///
/// * `command` – that made the results
/// * `cited` – the works on whose models they rest
/// * `input` – where everything stands with which the command gives them again; empty if it made nothing of a case
pub(super) fn methods(command: &str, cited: Vec<Reference>, input: &str) -> Section<'static> {
    let mut works: Vec<Reference> = Vec::new();
    for work in cited {
        if !works.iter().any(|known| known.full == work.full) {
            works.push(work);
        }
    }
    let models = match &works[..] {
        [] => String::new(),
        works => {
            let names: Vec<&str> = works.iter().map(|work| work.short).collect();
            format!(", by the models of {}", names.join("; "))
        }
    };
    let case = match input {
        "" => String::new(),
        input => format!(" The input with all its numbers is {input}."),
    };
    let text = format!("The numbers come from {} (spunlaid {command}){models}.{case}", PROGRAM.short);
    let full = works.iter().map(|work| work.full.to_owned());
    let paragraphs = [text, PROGRAM.full.to_owned()].into_iter().chain(full).collect();
    Section::new("methods-paragraph", "Methods, for a paper")
        .with(Part::Prose { id: "methods-text", paragraphs })
}
