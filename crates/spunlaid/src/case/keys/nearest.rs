//! Which word or key a misspelt one may mean.

use super::{Key, all};

/// The keys most like one written in `table`, there or elsewhere, the most like first.
pub(crate) fn like_in(table: &str, key: &str) -> Vec<&'static Key> {
    // At equal likeness, the table it was written in.
    let bonus = |home: &str| if home == table { 0.05 } else { 0.0 };
    by_likeness(key, all().iter().map(|known| (known, known.short(), bonus(known.table()))))
}

/// The word most like the one written, if any is like it.
pub(crate) fn nearest_word(word: &str, known: impl Iterator<Item = &'static str>) -> Option<&'static str> {
    by_likeness(word, known.map(|known| (known, known, 0.0))).first().copied()
}

/// Those that are like the word, the most like first.
///
/// * `known` – each with its spelling and what is added to its likeness
fn by_likeness<T>(word: &str, known: impl Iterator<Item = (T, &'static str, f64)>) -> Vec<T> {
    // Nothing this long is a slip of the pen, and comparing it would take long.
    if word.len() > 60 {
        return Vec::new();
    }
    let word = word.to_lowercase().replace(['-', ' '], "_");
    let likeness = |known: &str| {
        let known = known.replace('-', "_");
        let part = word.len() >= 4 && (known.contains(&word) || word.contains(&known));
        strsim::normalized_damerau_levenshtein(&word, &known).max(if part { 0.7 } else { 0.0 })
    };
    let mut like: Vec<(f64, T)> = known
        .map(|(candidate, spelling, bonus)| (likeness(spelling) + bonus, candidate))
        .filter(|(likeness, _)| *likeness >= 0.6)
        .collect();
    // Of equals the last, as the tables go from the general to the particular.
    like.reverse();
    like.sort_by(|a, b| b.0.total_cmp(&a.0));
    like.into_iter().map(|(_, candidate)| candidate).collect()
}
