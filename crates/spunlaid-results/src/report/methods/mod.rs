//! The paragraph about methods in every report: what a paper says of the numbers that it takes, with what it cites.
//!
//! ```text
//! case, web, spinline, study → sentences with their references (case) → methods, a section to copy
//! ```

mod case;
mod reference;

pub(super) use case::{Account, case_account, web_account};
pub(super) use reference::MOMENTS;

use super::document::{Part, Section};
use reference::PROGRAM;

/// A paragraph to copy, and below it the works that it cites, each once, the program first.
///
/// * `command` – that made the results
/// * `account` – what was done, with the works that are cited for it
/// * `found` – the results, in sentences
pub(super) fn methods(
    command: &str,
    (sentences, cited): Account,
    found: impl IntoIterator<Item = String>,
) -> Section<'static> {
    let first = format!("The numbers come from {} (spunlaid {command}).", PROGRAM.short);
    let all: Vec<String> = [first].into_iter().chain(sentences).chain(found).collect();
    let text = all.iter().map(|sentence| sentence.trim()).filter(|sentence| !sentence.is_empty());
    let mut paragraphs = vec![text.collect::<Vec<_>>().join(" "), PROGRAM.full.to_owned()];
    for reference in cited {
        if !paragraphs.iter().any(|known| known == reference.full) {
            paragraphs.push(reference.full.to_owned());
        }
    }
    Section::new("methods-paragraph", "Methods, for a paper")
        .paragraph("What was computed and how, with all numbers of the case, to copy and to shorten.")
        .with(Part::Prose { id: "methods-text", paragraphs })
}
