//! The name and the unit in the header of a column.

use crate::error::{FileError, FileFault};
use crate::units::{Dimension, excerpt};

/// The header of a column, taken apart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Head {
    /// As the file has it.
    pub text: String,
    /// Without the unit.
    pub name: String,
    /// As written.
    pub unit: Option<String>,
}

impl Head {
    /// `u_m_s`, `u [m/s]`, `u (m/s)`, `u/(m/s)` and `u m/s` into name and unit.
    pub fn new(text: &str) -> Self {
        let text = text.trim();
        let of = |name: &str, unit: Option<&str>| {
            let name = excerpt(name.trim().trim_matches(['_', '/', '-', ':']), 40);
            Self { text: text.to_owned(), name, unit: unit.map(|unit| unit.trim().to_owned()) }
        };
        for (open, close) in [('[', ']'), ('(', ')')] {
            if let Some((name, rest)) = text.split_once(open)
                && let Some((unit, _)) = rest.split_once(close)
            {
                return of(name, Some(unit));
            }
        }
        for (at, joint) in text.char_indices().filter(|(_, c)| matches!(c, '_' | ' ' | '/')) {
            let (name, unit) = (&text[..at], &text[at + joint.len_utf8()..]);
            if !name.is_empty() && is_unit(unit) {
                return of(name, Some(unit));
            }
        }
        of(text, None)
    }

    /// The unit, if the name is one of these in small letters with `_` between words; else what follows the longest
    /// of them that the header begins with.
    pub(crate) fn named(&self, names: &[&str]) -> Option<Option<&str>> {
        let is = |text: &str| {
            let tidy = text.trim().trim_end_matches('_').to_lowercase().replace([' ', '-'], "_");
            names.contains(&tidy.as_str())
        };
        if is(&self.text) {
            return Some(None);
        }
        if is(&self.name) {
            return Some(self.unit.as_deref());
        }
        let joints = self.text.char_indices().rev().filter(|(_, c)| *c == '_');
        joints
            .map(|(at, _)| self.text.split_at(at))
            .find(|(name, _)| is(name))
            .map(|(_, unit)| Some(&unit[1..]))
    }

    /// SI units in one of this column's.
    ///
    /// * `example` – a header that would do
    ///
    /// # Errors
    /// When it has no unit, or one of something else.
    pub fn factor(&self, dimension: Dimension, example: &'static str) -> Result<f64, FileError> {
        let fault = match &self.unit {
            None => FileFault::NoUnit { dimension, example },
            Some(unit) => match scale(unit, dimension) {
                Some(factor) => return Ok(factor),
                None => FileFault::WrongUnit { unit: excerpt(unit, 20), wanted: dimension },
            },
        };
        Err(FileError::from(fault).column(&self.text))
    }
}

/// Whether a text is a unit that columns are known to have.
pub(super) fn is_unit(text: &str) -> bool {
    const DIMENSIONS: [Dimension; 4] =
        [Dimension::Time, Dimension::Velocity, Dimension::Length, Dimension::Frequency];
    let named = !text.trim().is_empty();
    named && DIMENSIONS.into_iter().any(|dimension| scale(text, dimension).is_some())
}

/// SI units in one of this unit, however a header may spell it; none of what is no unit of this dimension.
pub fn scale(unit: &str, dimension: Dimension) -> Option<f64> {
    let unit = unit.trim().trim_matches(['[', ']', '(', ')']).trim();
    let spelt = match (dimension, unit) {
        (Dimension::Time, "sec" | "seconds" | "Sekunden" | "S") => "s",
        (Dimension::Velocity, "m s-1" | "m s^-1" | "m·s⁻¹" | "m s⁻¹" | "ms^-1" | "ms⁻¹" | "m.s-1") => {
            "m/s"
        }
        (Dimension::Frequency, _) if unit.eq_ignore_ascii_case("hz") => "Hz",
        (Dimension::Frequency, _) if unit.eq_ignore_ascii_case("khz") => "kHz",
        (Dimension::Ratio, _) if unit.eq_ignore_ascii_case("percent") => "%",
        _ => unit,
    };
    let spelt = if dimension == Dimension::Velocity { spelt.replace('_', "/") } else { spelt.to_owned() };
    dimension.parse(&format!("1 {spelt}")).ok()
}
