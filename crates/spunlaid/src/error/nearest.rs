//! Suggestions for misspelt keys and words.

use crate::sort::sort_by_key;
use std::cmp::Reverse;

/// The most similar word, if any is similar.
pub(crate) fn nearest_word<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    by_similarity(word, known.map(|known| (known, known, 0.0))).first().copied()
}

/// The candidates that are similar to the word, the most similar first.
///
/// * `known` – candidate, its spelling, and a number that is added to its similarity
pub(crate) fn by_similarity<'a, T>(word: &str, known: impl Iterator<Item = (T, &'a str, f64)>) -> Vec<T> {
    // So long a word is not a typing error, and comparing it would take long.
    if word.len() > 60 {
        return Vec::new();
    }
    let word = word.to_lowercase().replace(['-', ' '], "_");
    let similarity = |known: &str| {
        let known = known.to_lowercase().replace(['-', ' '], "_");
        let part = word.len() >= 4 && (known.contains(&word) || word.contains(&known));
        strsim::normalized_damerau_levenshtein(&word, &known).max(if part { 0.7 } else { 0.0 })
    };
    let mut like: Vec<(f64, T)> = known
        // The top of a file has no name that can be meant.
        .filter(|(_, spelling, _)| !spelling.is_empty())
        .map(|(candidate, spelling, bonus)| (similarity(spelling) + bonus, candidate))
        .filter(|(similarity, _)| *similarity >= 0.6)
        .collect();
    // Of equals, take the last: the tables go from general to specific keys.
    like.reverse();
    sort_by_key(&mut like, |(similarity, _)| Reverse(*similarity));
    like.into_iter().map(|(_, candidate)| candidate).collect()
}
