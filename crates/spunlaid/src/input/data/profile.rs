//! Reads profiles of the air and spectra: small tables with units in their headers.

use crate::air::{Profile, SpectrumTable};
use crate::error::{Fault, FileError, FileKind, listed};
use crate::spinline::{AirTable, ZERO_CELSIUS};
use crate::table::{Head, Table};
use crate::units::{Dimension, excerpt, shortest};

/// Fewest rows of a table.
const LEAST_ROWS: usize = 2;

/// A column that a table may or must have.
struct ColumnRule {
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

/// Reads a profile of the air: `x_m, velocity_m_s, turbulence_intensity, length_scale_m, cutoff_frequency_hz`; the
/// last three are optional.
pub(super) fn profile(text: &[u8]) -> Result<Profile, FileError> {
    let column = |what, names, dimension, example, required, sign| ColumnRule {
        what,
        names,
        dimension,
        example,
        required,
        sign,
    };
    let rules = [
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
    let [x, velocity, turbulence_intensity, length_scale, cutoff_frequency] =
        read(text, &rules, "x_mm,velocity_m_s")?;
    Ok(Profile { x, velocity, turbulence_intensity, length_scale, cutoff_frequency })
}

/// Reads the air along a spinline: `z_mm, velocity_m_s, cross_velocity_m_s, temperature_c`.
pub(super) fn spinline_air(text: &[u8]) -> Result<AirTable, FileError> {
    let column = |what, names, dimension, example, sign| ColumnRule {
        what,
        names,
        dimension,
        example,
        required: true,
        sign,
    };
    let rules = [
        column(
            "of distances from the die",
            &["z", "distance", "x"],
            Dimension::Length,
            "z_mm",
            Sign::NotNegative,
        ),
        column(
            "of velocities along the thread",
            &["velocity", "u", "speed"],
            Dimension::Velocity,
            "velocity_m_s",
            Sign::Any,
        ),
        column(
            "of velocities across the thread",
            &["cross_velocity", "quench_velocity", "v_c"],
            Dimension::Velocity,
            "cross_velocity_m_s",
            Sign::NotNegative,
        ),
        column(
            "of temperatures",
            &["temperature", "air_temperature"],
            Dimension::Temperature,
            "temperature_c",
            Sign::Any,
        ),
    ];
    let [distance, velocity, cross_velocity, temperature] =
        read(text, &rules, "z_mm,velocity_m_s,cross_velocity_m_s,temperature_c")?;
    Ok(AirTable { distance, velocity, cross_velocity, temperature })
}

/// Reads a spectrum: `frequency_hz, energy`.
pub(super) fn spectrum(text: &[u8]) -> Result<SpectrumTable, FileError> {
    let rules = [
        ColumnRule {
            what: "of frequencies",
            names: &["frequency", "f"],
            dimension: Dimension::Frequency,
            example: "frequency_hz",
            required: true,
            sign: Sign::NotNegative,
        },
        ColumnRule {
            what: "of energies",
            names: &["energy", "density", "psd", "e", "s"],
            // Only the shape counts, so that any unit will do.
            dimension: Dimension::Ratio,
            example: "energy",
            required: true,
            sign: Sign::NotNegative,
        },
    ];
    let [frequency, energy] = read(text, &rules, "frequency_hz,energy")?;
    if energy.iter().all(|e| *e == 0.0) {
        return Err(Fault::new("is zero at every frequency", "at least one value must be positive").into());
    }
    Ok(SpectrumTable { frequency, energy })
}

/// The columns in SI units; an optional column that is not there is empty. The first column must rise.
fn read<const N: usize>(
    text: &[u8],
    rules: &[ColumnRule; N],
    example: &'static str,
) -> Result<[Vec<f64>; N], FileError> {
    let mut table = Table::open(text, FileKind::Table, 0)?;
    if !table.named() {
        return Err(Fault::no_header(example).into());
    }
    let mut columns = [None; N];
    for (column, rule) in columns.iter_mut().zip(rules) {
        *column = find(table.heads(), rule).map_err(|error| error.at(table.header()))?;
    }
    let mut values: [Vec<f64>; N] = std::array::from_fn(|_| Vec::new());
    while table.next_row()? {
        for (i, (column, rule)) in columns.iter().zip(rules).enumerate() {
            let Some((index, unit)) = *column else { continue };
            let value = match table.number(index) {
                Ok(number) => number * unit.factor + unit.zero,
                Err(_) if !table.is_number(index) => f64::NAN,
                Err(error) => return Err(error),
            };
            if !value.is_finite() {
                let text = excerpt(table.text(index), 40);
                return Err(table.blame(
                    index,
                    Fault::new(
                        format!("\"{text}\" is not a finite number"),
                        "every cell of the table needs one",
                    ),
                ));
            }
            let zero = rule.sign == Sign::NotNegative;
            if rule.dimension == Dimension::Temperature && value <= 0.0 {
                let text = excerpt(table.text(index), 40);
                let remedy = "a temperature above 0 K, which is -273.15 °C, is needed";
                return Err(
                    table.blame(index, Fault::new(format!("{text} is not above absolute zero"), remedy))
                );
            }
            if rule.sign != Sign::Any && (value < 0.0 || value == 0.0 && !zero) {
                let sign = if value < 0.0 { "negative" } else { "zero" };
                let needed = if zero { "zero or more is needed" } else { "more than zero is needed" };
                let fault = Fault::new(format!("{} is {sign}", shortest(value)), needed);
                return Err(table.blame(index, fault));
            }
            if i == 0
                && let Some(before) = values[0].last().copied().filter(|before| *before >= value)
            {
                return Err(table.blame(index, Fault::not_increasing(before, value)));
            }
            values[i].push(value);
        }
    }
    let found = values[0].len();
    if found < LEAST_ROWS {
        return Err(Fault::new(
            format!("has {found} {} of numbers", if found == 1 { "row" } else { "rows" }),
            format!("at least {LEAST_ROWS} are needed for interpolation"),
        )
        .into());
    }
    Ok(values)
}

/// How the numbers of a column become SI units: times the factor, plus the zero of the scale.
#[derive(Clone, Copy)]
struct ColumnUnit {
    factor: f64,
    zero: f64,
}

/// Index of the column, and its unit.
fn find(heads: &[Head], rule: &ColumnRule) -> Result<Option<(usize, ColumnUnit)>, FileError> {
    let named = heads.iter().enumerate();
    let matching: Vec<(usize, Option<&str>)> =
        named.filter_map(|(i, head)| Some((i, head.named(rule.names)?))).collect();
    let text = |i: usize| excerpt(&heads[i].text, 60);
    let (index, unit) = match matching[..] {
        [] if rule.required => {
            let (name, example) = (rule.what, rule.example);
            let found: Vec<String> = (0..heads.len()).map(text).collect();
            return Err(Fault::new(
                format!("has no column {name} (it has {})", listed(&found)),
                format!("name one like {example}"),
            )
            .into());
        }
        [] => return Ok(None),
        [one] => one,
        [(first, _), (second, _), ..] => {
            let (first, second) = (text(first), text(second));
            return Err(Fault::new(
                format!("the columns \"{first}\" and \"{second}\" both are columns {}", rule.what),
                "keep one",
            )
            .into());
        }
    };
    // The unit of an energy does not matter.
    if rule.names.contains(&"energy") || unit.is_none() && rule.dimension == Dimension::Ratio {
        return Ok(Some((index, ColumnUnit { factor: 1.0, zero: 0.0 })));
    }
    if rule.dimension == Dimension::Temperature
        && let Some(unit) = unit.map(|unit| unit.trim_matches(['[', ']', '(', ')', ' ']))
    {
        let celsius = ["c", "C", "°C", "degc", "degC", "deg_c", "celsius"].contains(&unit);
        if celsius || unit.eq_ignore_ascii_case("k") {
            let zero = if celsius { ZERO_CELSIUS } else { 0.0 };
            return Ok(Some((index, ColumnUnit { factor: 1.0, zero })));
        }
    }
    let head = Head { unit: unit.map(str::to_owned), ..heads[index].clone() };
    Ok(Some((index, ColumnUnit { factor: head.factor(rule.dimension, rule.example)?, zero: 0.0 })))
}
