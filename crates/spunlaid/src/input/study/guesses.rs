//! The webs that say what guesses matter: the same web with half and with twice of a number that its file calls a guess.

use super::super::Overrides;
use super::super::unread::Unread;
use super::super::web::Guess;
use super::open_web::{OpenWeb, changed_webs, changed_webs_of_file};
use super::{Base, VariedKey};
use crate::advice::{Change, ChangedKey, Setting};
use std::path::Path;

/// The factors on a guess.
const FACTORS: [f64; 2] = [0.5, 2.0];
/// Largest lateral wave number times the length of the eddies.
const CUTOFF: &str = "air.lateral_cutoff";
/// Guesses at the length of the eddies. Half as long ones keep the smallest waves across, because a field of half as long waves would take four times the
/// memory.
const OF_EDDIES: [&str; 3] = ["air.length_factor", "air.length_scale", "air.length_constant"];

/// Reads the file of a web and makes the webs in which one of the numbers that it calls guesses is half and twice as large.
///
/// # Errors
/// If the web cannot be read. And what has to be flown first, if a case has a spinline whose tension is that of flights.
pub fn read_guesses(path: &Path, set: Overrides<'_>) -> Result<Vec<Change>, Unread<Vec<Change>>> {
    changed_webs_of_file(path, set, changes)
}

/// [`read_guesses`] of a text.
///
/// # Errors
/// As [`read_guesses`].
pub fn parse_guesses(
    text: String,
    name: &str,
    set: Overrides<'_>,
) -> Result<Vec<Change>, Unread<Vec<Change>>> {
    changed_webs(text, name, set, changes)
}

fn changes(web: OpenWeb<'_>) -> Vec<Change> {
    let spec = web.base.spec();
    let named = spec.guessed.iter().filter_map(|name| Some((name, Guess::new(spec, name).ok()?)));
    named
        .flat_map(|(name, guess)| FACTORS.map(|factor| web.changed(name, &guess, factor)))
        .flatten()
        .collect()
}

impl OpenWeb<'_> {
    /// The web with another value of a guess; None if that is no other value.
    fn changed(&self, name: &str, guess: &Guess, factor: f64) -> Option<Change> {
        let value = factor * guess.value;
        let to = if guess.kind.dimension().is_none() { value.round().max(1.0) } else { value };
        let mut values: Vec<(VariedKey, f64)> =
            guess.keys.iter().map(|key| (VariedKey::new(key.clone(), guess.kind), to)).collect();
        if OF_EDDIES.contains(&name)
            && factor < 1.0
            && let Some(cutoff) = self.base.spec().lateral_cutoff(0)
        {
            values.push((self.base.varied(CUTOFF).ok()?, factor * cutoff));
        }
        let (spec, refusal) = match self.base.changed(&values, self.lookup) {
            Ok(changed) => (changed.spec, None),
            Err(why) => (self.base.spec().clone(), Some(why.to_string())),
        };
        let (key, _) = values.first()?;
        let changed = ChangedKey {
            key: name.to_owned(),
            dimension: key.dimension(),
            whole: key.is_whole(),
            from: guess.value,
            to,
        };
        let (keys, layers, file) = (vec![changed], Vec::new(), self.base.path().to_owned());
        let set = self.with_settings(values.iter().map(|value| self.setting(value)).collect());
        let setting = Setting::Guess;
        (to != guess.value).then_some(Change { setting, layers, keys, file, set, spec, refusal })
    }
}
