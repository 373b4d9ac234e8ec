//! The page of `spunlaid reproduce`: the paper's claims with evidence and verdict, its figures, its choices.

use super::methods::{Methods, case_account};
use super::rendered;
use askama::Template;
use spunlaid::case::Case;
use spunlaid::paper::{Claim, Verdict};
use spunlaid_charts::Figure;

/// Everything the page shows.
#[derive(Clone, Copy, Debug)]
pub struct PaperReport<'a> {
    /// What the paper claims, and what was found.
    pub claims: &'a [Claim],
    /// The figures.
    pub figures: &'a [Figure],
    /// Name of a choice, then amplitude y, z and frequency y, z as text.
    pub choices: &'a [(String, Vec<String>)],
    /// How it was computed, in a sentence.
    pub how: &'a str,
    /// The base case.
    pub case: &'a Case,
    /// The case as a case file.
    pub case_toml: &'a str,
}

#[derive(Template)]
#[template(path = "paper.html")]
struct PaperPage<'a> {
    headline: String,
    claims: Vec<ClaimRow<'a>>,
    figures: &'a [Figure],
    choice_heads: [&'static str; 4],
    choices: &'a [(String, Vec<String>)],
    how: &'a str,
    methods_paragraph: Methods,
    case_toml: &'a str,
}

struct ClaimRow<'a> {
    claim: &'a Claim,
    class: &'static str,
    verdict: &'static str,
}

/// The page as one HTML file.
pub fn paper_html(input: &PaperReport<'_>) -> String {
    let count = input.claims.iter().filter(|c| c.verdict == Verdict::Holds).count();
    let headline = match input.claims.len() {
        0 => "The paper’s figures, drawn anew".to_owned(),
        all => format!("{count} of the paper’s {all} claims hold"),
    };
    let rows = input.claims.iter().map(|claim| ClaimRow {
        claim,
        class: match claim.verdict {
            Verdict::Holds => "holds",
            Verdict::Fails => "fails",
            Verdict::Open => "open",
        },
        verdict: claim.verdict.name(),
    });
    let found = [input.how.to_owned(), format!("{headline}.")];
    let page = PaperPage {
        methods_paragraph: Methods::new("reproduce", case_account(input.case), found),
        headline,
        claims: rows.collect(),
        figures: input.figures,
        choice_heads: [
            "Amplitude in y (mm)",
            "Amplitude in z (mm)",
            "Frequency in y (Hz)",
            "Frequency in z (Hz)",
        ],
        choices: input.choices,
        how: input.how,
        case_toml: input.case_toml,
    };
    rendered(&page)
}
