//! Claims with evidence and verdict, in a report and on a terminal.

use super::document::Section;
use super::table::{Cell, Row, Table, Tone};
use spunlaid::claim::{Claim, Verdict};

/// A row for each claim.
///
/// * `head` – of the column of what is claimed
pub(super) fn claim_table(claims: &[Claim], head: &'static str) -> Table {
    let row = |claim: &Claim| {
        let tone = match claim.verdict {
            Verdict::Holds => Tone::Good,
            Verdict::Fails => Tone::Bad,
            Verdict::Open => Tone::Open,
        };
        let said = [&*claim.claim, &claim.evidence].map(Cell::from);
        let verdict = Cell::new(claim.verdict.name(), tone);
        let figure = if claim.figure.is_empty() { String::new() } else { format!("Figure {}", claim.figure) };
        Row::new(figure, said.into_iter().chain([verdict]))
    };
    Table::new([""]).sentences([head, "Evidence", "Verdict"]).rows(claims.iter().map(row))
}

/// The claims for a terminal.
pub(super) fn claims_in_short(claims: &[Claim]) -> Section<'static> {
    let verdict = |claim: &Claim| {
        let figure = if claim.figure.is_empty() { String::new() } else { format!("{:<4} ", claim.figure) };
        (format!("{figure}{:<13} {}", claim.verdict.name(), claim.claim), claim.evidence.clone())
    };
    Section::new("", "Claims").on_terminal().descriptions(claims.iter().map(verdict))
}
