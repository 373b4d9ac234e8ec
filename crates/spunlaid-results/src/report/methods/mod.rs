//! The paragraph about methods in every report: what a paper says of the numbers that it takes, with what it cites.
//!
//! ```text
//! case, web, spinline, study → sentences with their references (case) → Methods, which assets/methods.html shows and copies
//! ```

mod case;
mod reference;

pub(super) use case::{Account, case_account, web_account};
pub(super) use reference::{MOMENTS, PROGRAM, Reference};

/// A paragraph to copy, and the works that it cites.
#[derive(Debug)]
pub(super) struct Methods {
    pub(super) text: String,
    /// Each once, the program first.
    pub(super) references: Vec<&'static str>,
}

impl Methods {
    /// * `command` – that made the results
    /// * `account` – what was done, with the works that are cited for it
    /// * `found` – the results, in sentences
    pub(super) fn new(command: &str, account: Account, found: impl IntoIterator<Item = String>) -> Self {
        let (sentences, cited) = account;
        let first = format!("The numbers come from {} (spunlaid {command}).", PROGRAM.short);
        let all: Vec<String> = [first].into_iter().chain(sentences).chain(found).collect();
        let mut references = vec![PROGRAM.full];
        for Reference { full, .. } in cited {
            if !references.contains(&full) {
                references.push(full);
            }
        }
        let text = all.iter().map(|sentence| sentence.trim()).filter(|sentence| !sentence.is_empty());
        Self { text: text.collect::<Vec<_>>().join(" "), references }
    }
}
