//! The report of `spunlaid reproduce`: the paper's claims with evidence and verdict, its figures, its choices.

use crate::page::claims::claim_sections;
use crate::page::document::{Report, Section};
use crate::page::methods::{methods, of_case};
use crate::page::table::{Row, Table};
use spunlaid::experiment::{Claim, Verdict};
use spunlaid::fibre::Case;
use spunlaid_charts::Figure;

/// What the paper claims, and what was found.
///
/// * `choices` – name of a choice, then amplitude y, z and frequency y, z as text
/// * `how` – how it was computed, in a sentence
/// * `case` – the base case, and as a case file
pub fn paper_report<'a>(
    claims: &[Claim],
    figures: &'a [Figure],
    choices: &[(String, Vec<String>)],
    how: &str,
    (case, toml): (&Case, &str),
) -> Report<'a> {
    let holds = claims.iter().filter(|claim| claim.verdict == Verdict::Holds).count();
    let headline = match claims.len() {
        0 => "The paper’s figures, drawn anew".to_owned(),
        all => format!("{holds} of the paper’s {all} claims hold"),
    };
    let verdicts = "The program computes the verdicts from the data. A trend is almost linear if a straight line \
        explains 97\u{202f}% of the variance. A difference is real if it is larger than three standard errors. A \
        step in the wrong direction counts against a trend if it is larger than 2.5 standard errors. “Nearly \
        constant” means a change of at most 10\u{202f}%. “Open” means that the errors are too large to decide; \
        more replicates would help.";
    let sections = claim_sections(claims, "What the paper says", verdicts);
    let mut report = Report::new("reproduce", headline).lead(how).with_all(sections);
    if !choices.is_empty() {
        let heads = [
            "Choice",
            "Amplitude in y (mm)",
            "Amplitude in z (mm)",
            "Frequency in y (Hz)",
            "Frequency in z (Hz)",
        ];
        let rows = choices.iter().map(|(name, cells)| Row::new(name, cells));
        let table = Table::new(heads).rows(rows);
        report = report.with(Section::new("choices", "What the paper leaves open").table(table).caption(
            "Table 1 of the paper with one choice changed at a time; mean ± one standard error of the mean.",
        ));
    }
    let file = Section::new("case", "The base case")
        .paragraph("Table 1 of the paper with every default filled in.")
        .file("case-toml", toml);
    report
        .with(Section::of_figures(figures).open())
        .with(methods("reproduce", of_case(case), "case.toml of the results"))
        .with(file)
}
