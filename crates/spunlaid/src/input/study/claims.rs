//! What is claimed of the results of a study.

use super::super::document::Named;
use super::reader::Reader;
use crate::error::{Fault, nearest_word};
use crate::study::{Factor, Quantity, Statement, StudyClaim, Way};

const FORM: &str =
    "write `RESULT: KEY > 5 * OTHER KEY`, `RESULT: KEY rises`, `RESULT: KEY falls` or `RESULT: KEY turns`";

impl Reader<'_> {
    /// The claims. Those that cannot be judged are noted as problems.
    pub(super) fn claims(&mut self, factors: &[Factor], quantities: &[Quantity]) -> Vec<StudyClaim> {
        let mut claims = Vec::new();
        for Named { row, name, entry } in self.named("claims") {
            let claim = self.as_kind(&row.kind, &entry).and_then(|_| {
                let text = entry.value.as_str().unwrap_or_default().trim().to_owned();
                let (result, statement) = read(&text, factors, quantities)?;
                Ok(StudyClaim { sentence: name.clone(), text, result, statement })
            });
            match claim {
                Ok(claim) => claims.push(claim),
                Err(fault) => self.reject(&format!("claims.{name:?}"), &entry, fault),
            }
        }
        claims
    }
}

/// Reads what is claimed: the name of the result, and the statement.
fn read(text: &str, factors: &[Factor], quantities: &[Quantity]) -> Result<(String, Statement), Fault> {
    let (result, said) = text.split_once(':').ok_or_else(|| Fault::new("names no result", FORM))?;
    let result = result.trim();
    if !quantities.iter().any(|quantity| quantity.name == result) {
        return Err(unknown("is not the name of a result", "the results are", result, &names_of(quantities)));
    }
    let keys: Vec<&str> = factors.iter().map(|factor| &*factor.key).collect();
    let factor = |key: &str| {
        let found = keys.iter().position(|name| *name == key.trim());
        let unknown = || unknown("names a key that does not vary here", "the keys are", key.trim(), &keys);
        let index = found.ok_or_else(unknown)?;
        match factors[index].words.is_empty() {
            true => Ok(index),
            false => Err(Fault::new("names a key of words, which have no order", "name a key of numbers")),
        }
    };
    let statement = match said.split_once('>') {
        Some((more, less)) => {
            let (times, less) = less.split_once('*').unwrap_or(("1", less));
            let times = times.trim().parse::<f64>().ok().filter(|times| times.is_finite() && *times > 0.0);
            let times = times.ok_or_else(|| Fault::new("has no number above zero before `*`", FORM))?;
            Statement::Matters { more: factor(more)?, times, less: factor(less)? }
        }
        None => {
            let said = said.trim();
            let way = Way::ALL.into_iter().find_map(|way| Some((said.strip_suffix(way.name())?, way)));
            let (key, way) = way.ok_or_else(|| Fault::new("says nothing that can be judged", FORM))?;
            Statement::Follows(factor(key)?, way)
        }
    };
    Ok((result.to_owned(), statement))
}

fn names_of(quantities: &[Quantity]) -> Vec<&str> {
    quantities.iter().map(|quantity| &*quantity.name).collect()
}

fn unknown(what: &'static str, all: &'static str, name: &str, names: &[&str]) -> Fault {
    Fault::unknown(what, nearest_word(name, names.iter().copied()).map(ToOwned::to_owned), all, names)
}
