//! The name and the unit in the header of a column.

use crate::error::{Fault, FileError};
use crate::units::{Dimension, UnitAdvice, excerpt};

/// The header of a column, split into name and unit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Head {
    /// The text in the file.
    pub text: String,
    /// The text without the unit.
    pub name: String,
    /// The unit as written.
    pub unit: Option<String>,
}

impl Head {
    /// Splits `u_m_s`, `u [m/s]`, `u (m/s)`, `u/(m/s)` and `u m/s` into name and unit.
    pub fn new(text: &str) -> Self {
        let text = text.trim();
        let head = |name: &str, unit: Option<&str>| {
            let name = excerpt(name.trim().trim_matches(['_', '/', '-', ':']), 40);
            // Spellings of "no dimension".
            let unit = unit.map(str::trim).filter(|unit| !["-", "–", "1"].contains(unit));
            Self { text: text.to_owned(), name, unit: unit.map(str::to_owned) }
        };
        for (open, close) in [('[', ']'), ('(', ')')] {
            if let Some((name, rest)) = text.split_once(open)
                && let Some((unit, _)) = rest.split_once(close)
            {
                return head(name, Some(unit));
            }
        }
        for (at, joint) in text.char_indices().filter(|(_, c)| matches!(c, '_' | ' ' | '/')) {
            let (name, unit) = (&text[..at], &text[at + joint.len_utf8()..]);
            if !name.is_empty() && is_unit(unit) {
                return head(name, Some(unit));
            }
        }
        head(text, None)
    }

    /// Compares the header with names in small letters, with `_` between words. If one of them is the name, the result
    /// is the unit; otherwise it is the text after the longest of them that the header begins with.
    pub fn named(&self, names: &[&str]) -> Option<Option<&str>> {
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

    /// Whether this is a column of remarks.
    pub(super) fn is_remark(&self) -> bool {
        const REMARKS: [&str; 9] = [
            "comment",
            "comments",
            "remark",
            "remarks",
            "note",
            "notes",
            "kommentar",
            "bemerkung",
            "anmerkung",
        ];
        REMARKS.contains(&self.name.to_lowercase().as_str())
    }

    /// The factor from the unit of this column to SI.
    ///
    /// * `example` – a valid header, for the message
    ///
    /// # Errors
    /// When the header has no unit, or a unit of another dimension.
    pub fn factor(&self, dimension: Dimension, example: &'static str) -> Result<f64, FileError> {
        let fault = match &self.unit {
            None => Fault::new(
                format!("contains {} and has no unit", dimension.name()),
                format!("write the unit in its name, like {example}"),
            )
            .option("or --time-unit, --velocity-unit"),
            Some(unit) => match scale(unit, dimension) {
                Some(factor) => return Ok(factor),
                None => Fault::new(
                    format!("has the unit \"{}\"", excerpt(unit, 20)),
                    format!("{} is needed", UnitAdvice(dimension)),
                ),
            },
        };
        Err(FileError::from(fault).column(&self.text))
    }
}

/// Refuses a table of which a column that is read has the header of another column, or the name of another one that is
/// read, as `u_m_s` beside `u [m/s]`.
///
/// * `read` – the columns that are read
///
/// # Errors
/// The first such column, with its places.
pub fn refuse_twice(heads: &[Head], read: &[usize]) -> Result<(), FileError> {
    let is_same = |one: &str, other: &str| one.to_lowercase() == other.to_lowercase();
    for &column in read {
        let own = &heads[column];
        let is_twice = |other: &usize| {
            let head = &heads[*other];
            // In `U [i]` and `U [j]` the brackets hold no unit.
            let have_units = [own, head].iter().all(|head| head.unit.as_deref().is_some_and(is_unit));
            let is_of_name = have_units && read.contains(other) && is_same(&head.name, &own.name);
            *other != column && (is_same(&head.text, &own.text) || is_of_name)
        };
        let other = (0..heads.len()).find(is_twice);
        let Some(other) = other.filter(|_| !heads[column].text.is_empty()) else { continue };
        let (first, second) = (column.min(other) + 1, column.max(other) + 1);
        let fault = Fault::new(
            format!("occurs twice, in columns {first} and {second}"),
            "leave one of them, or give them different names",
        );
        return Err(FileError::from(fault).column(&heads[column].text));
    }
    Ok(())
}

/// Whether a text is a unit of time, velocity, length or frequency.
pub(super) fn is_unit(text: &str) -> bool {
    const DIMENSIONS: [Dimension; 4] =
        [Dimension::Time, Dimension::Velocity, Dimension::Length, Dimension::Frequency];
    let named = !text.trim().is_empty();
    named && DIMENSIONS.into_iter().any(|dimension| scale(text, dimension).is_some())
}

/// The factor from a unit to SI, in any of the spellings that headers use; `None` if the text is no unit of the
/// dimension.
pub fn scale(unit: &str, dimension: Dimension) -> Option<f64> {
    let unit = unit.trim().trim_matches(['[', ']', '(', ')']).trim();
    let spelt = match (dimension, unit) {
        (Dimension::Time, "sec" | "seconds" | "Sekunden" | "S") => "s",
        // An inverse millisecond is no velocity.
        (Dimension::Velocity, "ms^-1" | "ms⁻¹" | "ms-1") => "m/s",
        (Dimension::Frequency, _) if unit.eq_ignore_ascii_case("hz") => "Hz",
        (Dimension::Frequency, _) if unit.eq_ignore_ascii_case("khz") => "kHz",
        (Dimension::Ratio, _) if unit.eq_ignore_ascii_case("percent") => "%",
        _ => unit,
    };
    let spelt = if dimension == Dimension::Velocity { spelt.replace('_', "/") } else { spelt.to_owned() };
    dimension.parse(&format!("1 {spelt}")).ok()
}

/// Names with units of the time and of three components at each probe; OpenFOAM writes in SI units. None if the lines
/// above the numbers are not those of as many probes as the rows have.
pub(super) fn names_of_probes<'a>(above: impl Iterator<Item = &'a str>, cells: usize) -> Option<Vec<String>> {
    let place = |line: &'a str| {
        let (number, place) = line.trim_start_matches(['#', ' ']).strip_prefix("Probe")?.split_once('(')?;
        let number: usize = number.trim().parse().ok()?;
        place.contains(')').then_some(number)
    };
    let probes: Vec<usize> = above.filter_map(place).collect();
    let components = |probe: &usize| {
        let at = if probes.len() > 1 { format!(" at probe {probe}") } else { String::new() };
        ["Ux", "Uy", "Uz"].map(|name| format!("{name}{at} [m/s]"))
    };
    let names = std::iter::once("Time [s]".to_owned()).chain(probes.iter().flat_map(components));
    (!probes.is_empty() && cells == 1 + 3 * probes.len()).then(|| names.collect())
}
