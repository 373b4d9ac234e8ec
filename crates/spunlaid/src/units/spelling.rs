//! The ways in which a unit is written: `m²/s²`, `m^2 s^-2`, `m²·s⁻²`, `m**2/s**2`.

/// A symbol, as `m`, and its power.
type Factor = (String, f64);

/// Brings the signs of a unit to one spelling in plain characters: `kg/m³`, `kg/m^3` and `kg/m3` become
/// `kg/m3`; `µ` (micro) and `μ` (mu) become `u`; the signs for minus, times and divided by become `-`, `·`
/// and `/`.
pub(crate) fn plain_spelling(unit: &str) -> String {
    let plain = unit.replace("**", "");
    let plain = plain.chars().filter(|c| *c != '^').map(|c| match c {
        'µ' | 'μ' => 'u',
        '⁰' => '0',
        '¹' => '1',
        '²' => '2',
        '³' => '3',
        '⁴' => '4',
        '⁵' => '5',
        '⁶' => '6',
        '⁷' => '7',
        '⁸' => '8',
        '⁹' => '9',
        '⁻' | '−' | '‐' | '‑' | '–' => '-',
        '⋅' | '∙' | '•' | '×' | '*' => '·',
        '∕' | '⁄' | '÷' => '/',
        '\u{a0}' | '\u{2009}' | '\u{202f}' => ' ',
        other => other,
    });
    plain.collect()
}

/// Whether a unit in plain spelling has these factors.
pub(super) fn is_same(factors_of_other: Option<&[Factor]>, plain: &str) -> bool {
    factors_of_other.is_some_and(|other| factors(plain).is_some_and(|own| own == other))
}

/// The factors of a unit in plain spelling, sorted by their symbols, each of them once. None if it is not
/// written as symbols with powers.
///
/// A slash divides by the next factor only, or by a parenthesis: `J/(kg K)`, `J/kg/K`.
pub(super) fn factors(plain: &str) -> Option<Vec<Factor>> {
    let mut found = Vec::new();
    let rest = product(plain.trim(), 1.0, &mut found, 0)?;
    found.retain(|(_, power)| *power != 0.0);
    found.sort_by(|a, b| a.0.cmp(&b.0));
    (rest.is_empty() && !found.is_empty()).then_some(found)
}

/// Reads a product up to its end or a closing parenthesis, and returns what follows.
///
/// * `sign` – the power of the whole product
fn product<'a>(mut rest: &'a str, sign: f64, found: &mut Vec<Factor>, depth: usize) -> Option<&'a str> {
    const DEEPEST: usize = 4;
    let mut divided = 1.0;
    loop {
        rest = rest.trim_start();
        if let Some(inner) = rest.strip_prefix('(').filter(|_| depth < DEEPEST) {
            let mut group = Vec::new();
            let after = product(inner, 1.0, &mut group, depth + 1)?.strip_prefix(')')?;
            let (outer, after) = power(after)?;
            group.into_iter().for_each(|(symbol, inner)| add(found, &symbol, sign * divided * outer * inner));
            rest = after;
        } else if let Some(after) = rest.strip_prefix('1').filter(|after| !after.starts_with(is_digit)) {
            rest = after;
        } else {
            let end = rest.find(|c| !is_in_symbol(c)).unwrap_or(rest.len());
            let (symbol, after) = rest.split_at(end);
            let (own, after) = power(after)?;
            if symbol.is_empty() {
                return None;
            }
            add(found, symbol, sign * divided * own);
            rest = after;
        }
        let after = rest.trim_start();
        divided = if after.starts_with('/') { -1.0 } else { 1.0 };
        rest = match after.strip_prefix(['/', '·', '.']) {
            Some(after) => after,
            None if after.is_empty() || after.starts_with(')') => return Some(after),
            // A blank between two factors, or nothing at a parenthesis.
            None => after,
        };
    }
}

/// The power at the start of a text, 1 if there is none, and what follows.
fn power(text: &str) -> Option<(f64, &str)> {
    let digits = text.strip_prefix(['-', '+']).unwrap_or(text);
    let whole = digits.find(|c| !is_digit(c)).unwrap_or(digits.len());
    let fraction = digits[whole..].strip_prefix('.').filter(|after| after.starts_with(is_digit));
    let length = whole + fraction.map_or(0, |after| 1 + after.find(|c| !is_digit(c)).unwrap_or(after.len()));
    let end = text.len() - digits.len() + length;
    match &text[..end] {
        "" => Some((1.0, text)),
        written => Some((written.parse().ok()?, &text[end..])),
    }
}

fn add(found: &mut Vec<Factor>, symbol: &str, power: f64) {
    match found.iter_mut().find(|(known, _)| known == symbol) {
        Some((_, sum)) => *sum += power,
        None => found.push((symbol.to_owned(), power)),
    }
}

fn is_digit(c: char) -> bool {
    c.is_ascii_digit()
}

fn is_in_symbol(c: char) -> bool {
    c.is_alphabetic() || matches!(c, '°' | '%' | '√')
}
