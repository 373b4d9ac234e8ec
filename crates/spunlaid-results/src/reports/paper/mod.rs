//! The claims and the figures of the paper.

mod figures;
mod flights;

pub use flights::{FIGURES, PaperFlights, PaperResults};

use crate::Failure;
use crate::files::folder::ENTRIES;
use crate::files::kept_input::Input;
use crate::files::versioned_json;
use crate::folders::{Contents, Maker, Page};
use crate::page::claims::claim_sections;
use crate::page::document::{Report, Section};
use crate::page::methods::{methods, of_case};
use crate::page::table::{Row, Table};
use serde_json::json;
use spunlaid_charts::Figure;
use spunlaid_experiment::{Claim, Verdict};
use spunlaid_fibre::Case;

/// Everything of the paper that goes into the files.
#[derive(Clone, Copy, Debug)]
pub struct PaperFolder<'a> {
    /// The claims, with their evidence and verdicts.
    pub claims: &'a [Claim],
    /// The figures.
    pub figures: &'a [Figure],
    /// The choices that the paper leaves open: name, then amplitude y, z and frequency y, z as text.
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
        let report = || Ok(self.report(&input));
        maker.finish("Battocchio, Sutcliffe & Teschner 2015", &[], self.figures, |_| Ok(()), report)
    }
}

impl PaperFolder<'_> {
    /// The paper's claims with evidence and verdict, its figures, its choices.
    ///
    /// * `toml` – the case as a file
    fn report(&self, toml: &str) -> Report<'_> {
        let holds = self.claims.iter().filter(|claim| claim.verdict == Verdict::Holds).count();
        let headline = match self.claims.len() {
            0 => "The paper’s figures, reproduced".to_owned(),
            all => format!("{holds} of the paper’s {all} claims hold"),
        };
        let verdicts = "The program computes the verdicts from the data. A trend is almost linear if a straight line \
            explains 97\u{202f}% of the variance. A difference is real if it is larger than three standard errors. A \
            step in the wrong direction counts against a trend if it is larger than 2.5 standard errors. “Nearly \
            constant” means a change of at most 10\u{202f}%. “Open” means that the errors are too large to decide; \
            more replicates would help.";
        let sections = claim_sections(self.claims, "Statement of the paper", verdicts);
        let mut report = Report::new("reproduce", headline).lead(self.how).with_all(sections);
        if !self.choices.is_empty() {
            let heads = [
                "Choice",
                "Amplitude in y (mm)",
                "Amplitude in z (mm)",
                "Frequency in y (Hz)",
                "Frequency in z (Hz)",
            ];
            let rows = self.choices.iter().map(|(name, cells)| Row::new(name, cells));
            let table = Table::new(heads).rows(rows);
            report = report.with(Section::new("choices", "What the paper leaves open").table(table).caption(
                "Table 1 of the paper with one choice changed at a time; mean ± one standard error of the mean.",
            ));
        }
        let file = Section::new("case", "The base case")
            .paragraph("Table 1 of the paper with every default filled in.")
            .file("case-toml", toml);
        report
            .with(Section::of_figures(self.figures).open())
            .with(methods("reproduce", of_case(self.case), "case.toml of the results"))
            .with(file)
    }
}
