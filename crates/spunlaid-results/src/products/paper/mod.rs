//! The claims and the figures of the paper.

mod figures;
mod flights;
mod report;

pub use flights::{FIGURES, PaperFlights, PaperResults};

use crate::Failure;
use crate::files::folder::ENTRIES;
use crate::files::kept_input::Input;
use crate::files::versioned_json;
use crate::folders::{Contents, Maker, Page};
use report::paper_report;
use serde_json::json;
use spunlaid::experiment::Claim;
use spunlaid::fibre::Case;
use spunlaid_charts::Figure;

/// Everything of the paper that goes into the files.
#[derive(Clone, Copy, Debug)]
pub struct PaperFolder<'a> {
    /// The claims, with their evidence and verdicts.
    pub claims: &'a [Claim],
    /// The figures.
    pub figures: &'a [Figure],
    /// The choices that the paper leaves open, with their results.
    pub choices: &'a [(String, Vec<String>)],
    /// How it was computed, in a sentence.
    pub how: &'a str,
    /// The case that is varied.
    pub case: &'a Case,
}

impl Contents for PaperFolder<'_> {
    const ENTRIES: &'static [&'static str] = ENTRIES;

    fn summary(&self) -> String {
        versioned_json(1, json!({"claims": self.claims}))
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let input = maker.keep(Input::Case(self.case))?;
        let report =
            || Ok(paper_report(self.claims, self.figures, self.choices, self.how, (self.case, &input)));
        maker.finish(("Battocchio, Sutcliffe & Teschner 2015", &[]), self.figures, |_| Ok(()), report)
    }
}
