//! How much guesses matter for a web, in the sentences below its headline.

use super::unevenness::{PER_CENT, headline_patch};
use super::words::millimetres;
use crate::numbers::{HARD, THIN, plus_minus, significant};
use spunlaid::advice::{Advice, Effect};
use spunlaid::layers::WebSpec;
use spunlaid::web::Findings;

/// What the CV of a web is with half and twice of each number that its file calls a guess, because the error of the CV knows nothing of them. Empty
/// without such numbers.
///
/// * `guesses` – None if nothing was tried
pub fn guess_words(spec: &WebSpec, findings: &Findings, guesses: Option<&Advice>) -> String {
    let names = listed(&spec.guessed);
    if names.is_empty() {
        return String::new();
    }
    let are = if spec.guessed.len() == 1 { "is a guess" } else { "are guesses" };
    let begin = format!("Its error does not know that {names} {are} (web.guessed)");
    let Some((guesses, i)) = guesses.zip(headline_patch(findings)) else {
        return format!(
            "{begin}, and what half and twice of them would do was not tried: spunlaid web with --advice tries it."
        );
    };
    let (patch, cv) = (findings.patches[i].map.patch, findings.patches[i].map.cv);
    let place = format!("over patches of {}", millimetres(patch));
    let mut told: Vec<(String, Vec<String>)> = Vec::new();
    for effect in &guesses.effects {
        let Some((name, value)) = value_and_cv(effect, patch, cv) else { continue };
        match told.iter_mut().find(|(other, _)| *other == name) {
            Some((_, values)) => values.push(value),
            None => told.push((name, vec![value])),
        }
    }
    if told.is_empty() {
        let failed = failed_words(guesses);
        return format!("{begin}, and no web with half or twice of them could be flown.{failed}");
    }
    let each: Vec<String> =
        told.iter().map(|(name, values)| format!("{name} = {}", values.join(", "))).collect();
    let range = guesses.range(patch);
    let whole = match range {
        [1.0, 1.0] => "none of them changes it beyond chance".to_owned(),
        ends => {
            let [from, to] = ends.map(|end| significant(PER_CENT * end * cv, 2));
            format!("it lies between {from} and {to}{THIN}%")
        }
    };
    format!(
        "{begin}. With half and twice of each, {whole} {place}: {}.{}",
        each.join("; "),
        failed_words(guesses)
    )
}

/// Which values could not be laid or flown, and why.
fn failed_words(guesses: &Advice) -> String {
    let failed = guesses.failed.iter().filter_map(|(change, why)| {
        let key = change.keys.first()?;
        let part = if key.to < key.from { "Half" } else { "Twice" };
        let verb = if change.refusal.is_some() { "cannot be laid" } else { "could not be flown" };
        Some(format!(" {part} of {}, {}, {verb}: {why}.", key.key, key.pretty(key.to)))
    });
    failed.collect()
}

/// A key, and `10 mm: 18.3 ± 1.5 %`.
fn value_and_cv(effect: &Effect, patch: f64, cv: f64) -> Option<(String, String)> {
    let (key, change) = (effect.change.keys.first()?, effect.over(patch)?);
    let error = Some(PER_CENT * cv * change.standard_error).filter(|error| error.is_finite());
    let value = key.pretty(key.to).replace(' ', &HARD.to_string());
    let told = plus_minus(PER_CENT * cv * (1.0 + change.change), error);
    Some((key.key.clone(), format!("{value}: {told}{THIN}%")))
}

/// `a, b and c`.
fn listed(names: &[String]) -> String {
    match names {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        names => names.concat(),
    }
}
