//! The webs that say what guesses matter: the same web with half and with twice of a number that its file
//! calls a guess.

use super::super::web::Guess;
use super::open_web::OpenWeb;
use super::{Base, VariedKey};
use crate::advice::Change;
use crate::effects::{ChangedKey, Setting};

/// The factors on a guess.
const FACTORS: [f64; 2] = [0.5, 2.0];
/// Largest lateral wave number times the length of the eddies.
const CUTOFF: &str = "air.lateral_cutoff";
/// Guesses at the length of the eddies. Half as long ones keep the smallest waves across, because a field of
/// half as long waves would take four times the memory.
const OF_EDDIES: [&str; 3] = ["air.length_factor", "air.length_scale", "air.length_constant"];

pub(super) fn changes(web: &OpenWeb<'_>) -> Vec<Change> {
    let spec = web.base.spec();
    let named = spec.guessed.iter().filter_map(|name| Some((name, Guess::new(spec, name).ok()?)));
    named
        .flat_map(|(name, guess)| FACTORS.map(|factor| changed(web, name, &guess, factor)))
        .flatten()
        .collect()
}

/// The web with another value of a guess; None if that is no other value.
fn changed(web: &OpenWeb<'_>, name: &str, guess: &Guess, factor: f64) -> Option<Change> {
    let value = factor * guess.value;
    let to = if guess.kind.dimension().is_none() { value.round().max(1.0) } else { value };
    let mut values: Vec<(VariedKey, f64)> =
        guess.keys.iter().map(|key| (VariedKey::new(key.clone(), guess.kind), to)).collect();
    let key = web.changed_key(&values.first()?.0, [guess.value, to]);
    if OF_EDDIES.contains(&name)
        && factor < 1.0
        && let Some(cutoff) = web.base.spec().lateral_cutoff(0)
    {
        values.push((web.base.varied(CUTOFF).ok()?, factor * cutoff));
    }
    let keys = vec![ChangedKey { key: name.to_owned(), ..key }];
    let new = values.iter().map(|value| web.setting(value)).collect();
    (to != guess.value).then(|| web.change((Setting::GUESS, Vec::new()), keys, new, web.with(&values)))
}
