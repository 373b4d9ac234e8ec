//! Numbers as text.

/// A number with so many decimals; a minus sign instead of a hyphen, and none before a zero.
pub fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    let digits = text.trim_start_matches('-');
    if text.starts_with('-') && digits.chars().any(|c| ('1'..='9').contains(&c)) {
        format!("−{digits}")
    } else {
        digits.to_owned()
    }
}

/// A number to so many significant digits, without a power of ten and without zeros at its end.
pub fn significant(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return signed(value, 0);
    }
    let magnitude = value.abs().log10().floor() as i32;
    let decimals = (digits - 1 - magnitude).max(0) as usize;
    let text = signed(value, decimals);
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// The shortest text that reads back to the same bits; nothing for what is not finite.
pub fn shortest(value: f64) -> String {
    if !value.is_finite() {
        return String::new();
    }
    let (plain, scientific) = (format!("{value}"), format!("{value:e}"));
    if scientific.len() < plain.len() { scientific } else { plain }
}
