//! Small tables: columns of numbers with units in their headers.

use crate::air::{Profile, SpectrumTable};
use crate::error::{DataError, TableFault};
use crate::units::{Dimension, excerpt};
use std::path::Path;

/// Largest table read [bytes].
pub(super) const LARGEST_TABLE: u64 = 1 << 24;
/// Fewest rows of a table.
const LEAST_ROWS: usize = 2;

/// A column that a table may have.
struct Wanted {
    what: &'static str,
    names: &'static [&'static str],
    dimension: Dimension,
    example: &'static str,
    required: bool,
    sign: Sign,
}

#[derive(Clone, Copy, PartialEq)]
enum Sign {
    Any,
    NotNegative,
    Positive,
}

/// A profile of the air: `x_m, velocity_m_s, turbulence_intensity, length_scale_m, cutoff_frequency_hz`, the
/// last three as far as known.
pub(super) fn profile(path: &Path, text: &[u8]) -> Result<Profile, DataError> {
    let column = |what, names, dimension, example, required, sign| Wanted {
        what,
        names,
        dimension,
        example,
        required,
        sign,
    };
    let wanted = [
        column("of distances", &["x", "distance", "position"], Dimension::Length, "x_mm", true, Sign::Any),
        column(
            "of mean velocities",
            &["velocity", "u", "mean_velocity", "speed"],
            Dimension::Velocity,
            "velocity_m_s",
            true,
            Sign::Any,
        ),
        column(
            "of turbulence intensities",
            &["turbulence_intensity", "tu", "intensity"],
            Dimension::Ratio,
            "turbulence_intensity",
            false,
            Sign::NotNegative,
        ),
        column(
            "of length scales",
            &["length_scale", "l_t", "lt", "l"],
            Dimension::Length,
            "length_scale_mm",
            false,
            Sign::Positive,
        ),
        column(
            "of cut-off frequencies",
            &["cutoff_frequency", "cutoff", "f", "frequency"],
            Dimension::Frequency,
            "cutoff_frequency_hz",
            false,
            Sign::Positive,
        ),
    ];
    let [x, velocity, turbulence_intensity, length_scale, cutoff_frequency] = read(path, text, &wanted)?;
    Ok(Profile { x, velocity, turbulence_intensity, length_scale, cutoff_frequency })
}

/// A spectrum: `frequency_hz, energy`.
pub(super) fn spectrum(path: &Path, text: &[u8]) -> Result<SpectrumTable, DataError> {
    let wanted = [
        Wanted {
            what: "of frequencies",
            names: &["frequency", "f"],
            dimension: Dimension::Frequency,
            example: "frequency_hz",
            required: true,
            sign: Sign::NotNegative,
        },
        Wanted {
            what: "of energies",
            names: &["energy", "density", "psd", "e", "s"],
            // In whatever unit: only the shape counts.
            dimension: Dimension::Ratio,
            example: "energy",
            required: true,
            sign: Sign::NotNegative,
        },
    ];
    let [frequency, energy] = read(path, text, &wanted)?;
    if energy.iter().all(|e| *e == 0.0) {
        return Err(DataError::Table { path: path.to_owned(), line: None, fault: TableFault::NoEnergy });
    }
    Ok(SpectrumTable { frequency, energy })
}

/// The wanted columns in SI units, the first in rising order; empty where one is not there.
fn read<const N: usize>(path: &Path, text: &[u8], wanted: &[Wanted; N]) -> Result<[Vec<f64>; N], DataError> {
    let refused = |line, fault| DataError::Table { path: path.to_owned(), line, fault };
    let not_a_table = |error: &csv::Error| {
        let line = error.position().map(csv::Position::line);
        refused(line, TableFault::NotATable { message: error.to_string() })
    };
    let separator = separator(text);
    let mut reader = csv::ReaderBuilder::new()
        .delimiter(separator)
        .comment(Some(b'#'))
        .trim(csv::Trim::All)
        .from_reader(text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(text));
    let headers: Vec<String> =
        reader.headers().map_err(|error| not_a_table(&error))?.iter().map(|h| excerpt(h, 60)).collect();
    let mut columns = [None; N];
    for (column, wanted) in columns.iter_mut().zip(wanted) {
        *column = find(&headers, wanted).map_err(|fault| refused(Some(1), fault))?;
    }
    let mut values: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
    for row in reader.records() {
        let row = row.map_err(|error| not_a_table(&error))?;
        let line = row.position().map(csv::Position::line);
        for (i, (column, wanted)) in columns.iter().zip(wanted).enumerate() {
            let Some((index, factor)) = *column else { continue };
            let header = || headers[index].clone();
            let value = cell(row.get(index).unwrap_or_default(), separator)
                .map(|value| value * factor)
                .filter(|value| value.is_finite())
                .ok_or_else(|| TableFault::NotANumber {
                    header: header(),
                    text: excerpt(row.get(index).unwrap_or_default(), 40),
                })
                .map_err(|fault| refused(line, fault))?;
            let zero = wanted.sign == Sign::NotNegative;
            if wanted.sign != Sign::Any && (value < 0.0 || value == 0.0 && !zero) {
                return Err(refused(line, TableFault::Sign { header: header(), value, zero }));
            }
            if i == 0
                && let Some(before) = values[0].last().copied().filter(|before| *before >= value)
            {
                let fault = TableFault::NotRising { header: header(), before, after: value };
                return Err(refused(line, fault));
            }
            values[i].push(value);
        }
    }
    let found = values[0].len();
    if found < LEAST_ROWS {
        return Err(refused(None, TableFault::TooFewRows { found, least: LEAST_ROWS }));
    }
    Ok(values)
}

/// The sign between cells, as the first line that is no comment has it.
fn separator(text: &[u8]) -> u8 {
    let mut lines = text.split(|byte| *byte == b'\n');
    let head = lines.find(|line| !line.starts_with(b"#") && !line.is_empty()).unwrap_or_default();
    [b'\t', b';', b','].into_iter().find(|sign| head.contains(sign)).unwrap_or(b',')
}

/// A number, with a decimal comma where commas do not part cells.
fn cell(text: &str, separator: u8) -> Option<f64> {
    let number = if separator == b',' { text.parse() } else { text.replacen(',', ".", 1).parse() };
    number.ok()
}

/// Index of the column and SI units in one of its own.
fn find(headers: &[String], wanted: &Wanted) -> Result<Option<(usize, f64)>, TableFault> {
    let matching: Vec<(usize, Option<&str>)> = (headers.iter().enumerate())
        .filter_map(|(i, header)| {
            let (name, unit) = take_apart(header, wanted)?;
            wanted.names.contains(&name.as_str()).then_some((i, unit))
        })
        .collect();
    let (index, unit) = match matching[..] {
        [] if wanted.required => {
            let (wanted, example) = (wanted.what, wanted.example);
            return Err(TableFault::NoColumn { wanted, example, found: headers.to_vec() });
        }
        [] => return Ok(None),
        [one] => one,
        [(first, _), (second, _), ..] => {
            let (first, second) = (headers[first].clone(), headers[second].clone());
            return Err(TableFault::Twice { what: wanted.what, first, second });
        }
    };
    let factor = match unit {
        // Of an energy the unit does not matter.
        _ if wanted.names.contains(&"energy") => Some(1.0),
        None if wanted.dimension == Dimension::Ratio => Some(1.0),
        None => None,
        Some(unit) => scale(unit, wanted.dimension),
    };
    factor.map(|factor| Some((index, factor))).ok_or_else(|| TableFault::Unit {
        header: headers[index].clone(),
        dimension: wanted.dimension,
        example: wanted.example,
    })
}

/// `x_mm`, `x [mm]` and `x (mm)` into name, in small letters, and unit.
fn take_apart<'h>(header: &'h str, wanted: &Wanted) -> Option<(String, Option<&'h str>)> {
    let tidy = |name: &str| name.trim().trim_end_matches('_').to_lowercase().replace([' ', '-'], "_");
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, rest)) = header.split_once(open) {
            return Some((tidy(name), Some(rest.split(close).next()?.trim())));
        }
    }
    let whole = tidy(header);
    if wanted.names.contains(&whole.as_str()) {
        return Some((whole, None));
    }
    // The longest name that is known: of cutoff_frequency_hz it is not cutoff.
    let joints = header.char_indices().rev().filter(|(_, c)| *c == '_');
    joints
        .map(|(at, _)| (tidy(&header[..at]), Some(&header[at + 1..])))
        .find(|(name, _)| wanted.names.contains(&name.as_str()))
}

/// SI units in one of this unit, however a header may spell it.
fn scale(unit: &str, dimension: Dimension) -> Option<f64> {
    let spelt = match unit.to_lowercase().as_str() {
        "hz" => "Hz".to_owned(),
        "khz" => "kHz".to_owned(),
        "percent" | "%" if dimension == Dimension::Ratio => return Some(0.01),
        _ if dimension == Dimension::Velocity => unit.replace('_', "/"),
        _ => unit.to_owned(),
    };
    dimension.parse(&format!("1 {spelt}")).ok()
}
