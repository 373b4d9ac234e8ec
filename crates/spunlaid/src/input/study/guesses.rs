//! The webs that say what guesses matter: the same web with half and with twice of a number that its file calls a guess.

use super::super::entry::Entry;
use super::super::lookup::Lookup;
use super::super::unread::{self, Unread};
use super::super::web::{Guess, replaces};
use super::super::{Overrides, file};
use super::web::WebBase;
use super::{Base, VariedKey};
use crate::advice::{Change, ChangedKey, Setting};
use crate::error::FileKind;
use std::path::Path;

/// The factors on a guess.
const FACTORS: [f64; 2] = [0.5, 2.0];
/// Largest lateral wave number times the length of the eddies.
const CUTOFF: &str = "air.lateral_cutoff";
/// Guesses at the length of the eddies. Half as long ones keep the smallest waves across, because a field of half as long waves would take four times the
/// memory.
const OF_EDDIES: [&str; 3] = ["air.length_factor", "air.length_scale", "air.length_constant"];
/// What a case must say that has one.
const IN_SPACE: (&str, &str) = ("air.lateral", "von-karman");

/// Reads the file of a web and makes the webs in which one of the numbers that it calls guesses is half and twice as large.
///
/// # Errors
/// If the web cannot be read. And what has to be flown first, if a case has a spinline whose tension is that of flights.
pub fn read_guesses(path: &Path, set: Overrides<'_>) -> Result<Vec<Change>, Unread<Vec<Change>>> {
    let text = file::read(path, FileKind::Web).map_err(Unread::Faulty)?;
    parse_guesses(text, &path.display().to_string(), set)
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
    let (name, word, values) = (name.to_owned(), set.word.to_owned(), set.values.to_vec());
    unread::read(move |lookup| {
        let [none, set] = [&[][..], &values].map(|values| Overrides { values, word: &word });
        let base = WebBase::new(text.clone(), name.clone(), [none, set], lookup)?;
        Ok(Guesses { base: &base, set: &values, lookup }.changes())
    })
}

/// The guesses of a web.
struct Guesses<'a> {
    base: &'a WebBase,
    /// What is set beside the file.
    set: &'a [(String, String)],
    lookup: &'a Lookup,
}

impl Guesses<'_> {
    fn changes(&self) -> Vec<Change> {
        let spec = self.base.spec();
        let named = spec.guessed.iter().filter_map(|name| Some((name, Guess::new(spec, name).ok()?)));
        named
            .flat_map(|(name, guess)| FACTORS.map(|factor| self.changed(name, &guess, factor)))
            .flatten()
            .collect()
    }

    /// The web with another value of a guess; None if it cannot be laid.
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
        if values.iter().any(|(key, _)| key.name == CUTOFF) {
            let key = self.base.varied(IN_SPACE.0).ok()?;
            let word = key.words().iter().position(|word| *word == IN_SPACE.1)?;
            values.push((key, word as f64));
        }
        let spec = self.base.changed(&values, self.lookup).ok()?.spec;
        let (key, _) = values.first()?;
        let changed = ChangedKey {
            key: name.to_owned(),
            dimension: key.dimension(),
            whole: key.is_whole(),
            from: guess.value,
            to,
        };
        let (keys, layers, file) = (vec![changed], Vec::new(), self.base.path().to_owned());
        let set = self.settings_of(&values);
        (to != guess.value).then_some(Change { setting: Setting::Guess, layers, keys, file, set, spec })
    }

    /// The keys and values that make a changed web of the file: what was set before, unless it is replaced, and the values.
    fn settings_of(&self, values: &[(VariedKey, f64)]) -> Vec<(String, String)> {
        let is_replaced = |set: &str| values.iter().any(|(key, _)| replaces(&key.name, set.trim()));
        let before = self.set.iter().filter(|(key, _)| !is_replaced(key));
        let before = before.map(|(key, value)| (key.clone(), Entry::plain_override(value)));
        let text = |(key, value): &(VariedKey, f64)| {
            let name = self.base.short_name(&key.name).to_owned();
            let word = key.words().get(*value as usize).map(|word| (*word).to_owned());
            let number =
                || if key.is_whole() { format!("{value:.0}") } else { key.dimension().written(*value) };
            (name, word.unwrap_or_else(number))
        };
        before.chain(values.iter().map(text)).collect()
    }
}
