//! Lists, numbers and foreign text in the words of messages.

use std::fmt;

pub(super) fn did_you_mean(nearest: &Option<String>, otherwise: impl Fn() -> String) -> String {
    nearest.as_ref().map_or_else(otherwise, |nearest| format!("did you mean {nearest}?"))
}

pub(super) fn all_of(words: &[impl ToString]) -> String {
    joined(words.iter().map(ToString::to_string).collect(), "and")
}

/// `"a", "b" or "c"`.
pub fn one_of(words: &[&str]) -> String {
    joined(words.iter().map(|word| format!("\"{word}\"")).collect(), "or")
}

fn joined(mut words: Vec<String>, last: &str) -> String {
    match words.pop() {
        Some(word) if words.is_empty() => word,
        Some(word) => format!("{} {last} {word}", words.join(", ")),
        None => String::new(),
    }
}

/// The first names of a list, and how many more there are: `u, v and 3 more`.
pub fn listed(names: &[String]) -> String {
    const MOST: usize = 12;
    let mut shown: Vec<&str> = names.iter().take(MOST).map(String::as_str).collect();
    let more = format!("{} more", names.len().saturating_sub(MOST));
    if names.len() > MOST {
        shown.push(&more);
    }
    if shown.is_empty() { "none".to_owned() } else { all_of(&shown) }
}

/// A number of things: `1 row`, `2 rows`.
pub fn counted(count: u64, thing: &str) -> String {
    format!("{count} {thing}{}", if count == 1 { "" } else { "s" })
}

/// One of two words, for one thing or for several: `is` or `are`.
pub const fn by_count(count: u64, (one, several): (&'static str, &'static str)) -> &'static str {
    if count == 1 { one } else { several }
}

/// The verb behind a number of things.
pub const IS: (&str, &str) = ("is", "are");
/// The same of the past.
pub const WAS: (&str, &str) = ("was", "were");

/// Memory formatted for people: `3.1 GiB`.
pub fn memory(bytes: f64) -> String {
    let (unit, size) = [("GiB", 30), ("MiB", 20), ("KiB", 10), ("bytes", 0)]
        .into_iter()
        .map(|(unit, power)| (unit, f64::from(1u32 << power)))
        .find(|(_, size)| bytes >= *size)
        .unwrap_or(("bytes", 1.0));
    let number = bytes / size;
    if number < 1e4 {
        format!("{} {unit}", (number * 10.0).round() / 10.0)
    } else {
        format!("{number:.1e} {unit}")
    }
}

/// Foreign text for a message: on one line, and shortened to `longest` characters.
pub fn excerpt(text: &str, longest: usize) -> String {
    let mut excerpt = String::new();
    for c in text.trim().chars().take(longest) {
        if c.is_control() || is_invisible(c) { excerpt.extend(c.escape_debug()) } else { excerpt.push(c) }
    }
    if text.trim().chars().count() > longest {
        excerpt.push('…');
    }
    excerpt
}

/// Whether a character takes no room: zero-width spaces and joiners, marks of direction and of the order of bytes, soft
/// hyphens. Text that is copied from a page or a document has some.
pub const fn is_invisible(c: char) -> bool {
    matches!(c, '\u{ad}' | '\u{200b}'..='\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2060}'..='\u{2064}' | '\u{feff}')
}

/// A formatter that escapes control characters as `\u{1b}`, so that no message can act on the terminal.
pub(crate) struct Printable<'a, 'f>(pub &'a mut fmt::Formatter<'f>);

impl fmt::Write for Printable<'_, '_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        text.chars().try_for_each(|c| {
            if c.is_control() { write!(self.0, "{}", c.escape_debug()) } else { self.0.write_char(c) }
        })
    }
}

/// The shortest text that reads back to the same bits, with an exponent if that is shorter.
pub fn shortest(value: f64) -> String {
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    if scientific.len() < plain.len() { scientific } else { plain }
}

/// The number with so many decimals in its form with an exponent: 2 of them are three significant digits.
pub fn rounded(value: f64, decimals: usize) -> f64 {
    format!("{value:.decimals$e}").parse().unwrap_or(value)
}

/// The most similar word, if any is similar.
pub fn nearest_word<'a>(word: &str, known: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    by_similarity(word, known.map(|known| (known, known, 0.0))).first().copied()
}

/// The candidates that are similar to the word, the most similar first.
///
/// * `known` – candidate, its spelling, and a number that is added to its similarity
pub fn by_similarity<'a, T>(word: &str, known: impl Iterator<Item = (T, &'a str, f64)>) -> Vec<T> {
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
    like.sort_by(|(one, _), (other, _)| other.total_cmp(one));
    like.into_iter().map(|(_, candidate)| candidate).collect()
}
