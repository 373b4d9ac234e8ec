//! Claims with evidence and verdict, in a report and on a terminal.

use super::document::Section;
use super::table::{Cell, Row, Table, Tone};
use spunlaid_experiment::{Claim, Verdict};

/// The claims for a page and for a terminal; nothing if there are none.
///
/// * `head` – of the column of what is claimed
/// * `verdicts` – what they mean
pub(crate) fn claim_sections(claims: &[Claim], head: &'static str, verdicts: &str) -> Vec<Section<'static>> {
    if claims.is_empty() {
        return Vec::new();
    }
    let page =
        Section::new("claims", "Claim by claim").open().table(claim_table(claims, head)).caption(verdicts);
    vec![page, in_short(claims)]
}

/// A row for each claim, with its figure if it is about one.
fn claim_table(claims: &[Claim], head: &'static str) -> Table {
    let has_figures = claims.iter().any(|claim| !claim.figure.is_empty());
    let row = |claim: &Claim| {
        let tone = match claim.verdict {
            Verdict::Holds => Tone::Good,
            Verdict::Fails => Tone::Bad,
            Verdict::Open => Tone::Open,
        };
        let rest = [Cell::from(&*claim.evidence), Cell::new(claim.verdict.name(), tone)];
        match has_figures {
            true => {
                let said = [Cell::from(&*claim.claim)].into_iter().chain(rest);
                Row::new(format!("Figure {}", claim.figure), said)
            }
            false => Row::new(&*claim.claim, rest),
        }
    };
    let rows = claims.iter().map(row);
    match has_figures {
        true => Table::new([""]).sentences([head, "Evidence", "Verdict"]).rows(rows),
        false => Table::new([head]).sentences(["Evidence", "Verdict"]).rows(rows),
    }
}

/// The claims for a terminal.
fn in_short(claims: &[Claim]) -> Section<'static> {
    let verdict = |claim: &Claim| {
        let figure = if claim.figure.is_empty() { String::new() } else { format!("{:<4} ", claim.figure) };
        (format!("{figure}{:<13} {}", claim.verdict.name(), claim.claim), claim.evidence.clone())
    };
    Section::new("", "Claims").on_terminal().descriptions(claims.iter().map(verdict))
}
