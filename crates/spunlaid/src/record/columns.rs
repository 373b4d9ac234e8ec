//! Which column is the time, which are velocities, and in which units.

use super::Layout;
use crate::error::RecordFault;
use crate::units::{Dimension, QuantityFault, excerpt};

/// Most components of a velocity.
const COMPONENTS: usize = 3;

const TIMES: [&str; 5] = ["time", "t", "zeit", "timestamp", "elapsed"];
const VELOCITIES: [&str; 15] =
    ["u", "v", "w", "ux", "uy", "uz", "vx", "vy", "vz", "u1", "u2", "u3", "velocity", "vel", "speed"];
/// Names of the component along the flow.
const ALONG: [&str; 5] = ["u", "ux", "vx", "u1", "velocity"];

/// A column to read.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    /// Which one, from 0.
    pub(super) index: usize,
    /// As the file has it.
    pub(super) header: String,
    /// Without the unit.
    pub(super) name: String,
    /// SI units per unit of the file.
    pub(super) factor: f64,
}

/// What the columns of a file are.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Roles {
    pub(super) time: Option<Column>,
    pub(super) components: Vec<Column>,
    pub(super) unused: Vec<String>,
}

/// A fault and the column to blame.
pub(super) type ColumnFault = (Option<String>, RecordFault);

/// A header, taken apart.
struct Header<'a> {
    text: &'a str,
    name: String,
    unit: Option<String>,
}

/// Finds out what the columns are; `headers` are `column 1`, `column 2` … where a file has none.
///
/// * `named` – whether the headers are the file's own
pub(super) fn roles(headers: &[String], named: bool, layout: &Layout) -> Result<Roles, ColumnFault> {
    if let Some(rate) = layout.rate.filter(|rate| !(rate.is_finite() && *rate > 0.0)) {
        return Err((None, RecordFault::Rate { rate }));
    }
    let taken_apart: Vec<Header<'_>> = headers.iter().map(|text| take_apart(text)).collect();
    let time = find_time(&taken_apart, named, layout)?;
    let mut chosen = if layout.columns.is_empty() {
        find_velocities(&taken_apart, named, time)
    } else {
        let asked = layout.columns.iter().map(|asked| find(&taken_apart, asked));
        asked.collect::<Result<Vec<_>, _>>()?
    };
    if chosen.is_empty() {
        return Err((None, RecordFault::NoVelocity { found: shown(headers) }));
    }
    if chosen.len() > COMPONENTS {
        let found: Vec<String> = chosen.iter().map(|&i| headers[i].clone()).collect();
        return Err((None, RecordFault::TooManyComponents { found: shown(&found) }));
    }
    for (n, &i) in chosen.iter().enumerate() {
        if chosen[..n].contains(&i) || time == Some(i) {
            return Err((Some(headers[i].clone()), RecordFault::ColumnTwice));
        }
    }
    if layout.columns.is_empty() {
        chosen.sort_by_key(|&i| !ALONG.contains(&taken_apart[i].name.to_lowercase().as_str()));
    }
    let mut components = Vec::new();
    for &i in &chosen {
        let factor = factor(&taken_apart[i], Dimension::Velocity, layout.velocity_unit.as_deref())?;
        let name = if named { taken_apart[i].name.clone() } else { ["u", "v", "w"][components.len()].into() };
        components.push(Column { index: i, header: headers[i].clone(), name, factor });
    }
    // With a rate given, the clock of the file is not asked.
    let clock = time.filter(|_| layout.rate.is_none());
    let time = clock
        .map(|i| {
            let factor = factor(&taken_apart[i], Dimension::Time, layout.time_unit.as_deref())?;
            Ok(Column { index: i, header: headers[i].clone(), name: taken_apart[i].name.clone(), factor })
        })
        .transpose()?;
    let is_used = |i: usize| chosen.contains(&i) || clock == Some(i);
    let unused: Vec<String> =
        headers.iter().enumerate().filter(|(i, _)| !is_used(*i)).map(|(_, h)| h.clone()).collect();
    Ok(Roles { time, components, unused: shown(&unused) })
}

/// Names made fit for messages.
fn shown(names: &[String]) -> Vec<String> {
    names.iter().map(|name| excerpt(name, 40)).collect()
}

fn find_time(headers: &[Header<'_>], named: bool, layout: &Layout) -> Result<Option<usize>, ColumnFault> {
    if let Some(asked) = &layout.time_column {
        return find(headers, asked).map(Some);
    }
    let is_time = |h: &Header<'_>| TIMES.contains(&h.name.to_lowercase().as_str());
    let found = match headers.iter().position(is_time) {
        // Without names the first is the time, unless a rate says that there is none.
        None if !named && layout.rate.is_none() && headers.len() > 1 => Some(0),
        found => found,
    };
    if found.is_none() && layout.rate.is_none() {
        let headers: Vec<String> = headers.iter().map(|h| h.text.to_owned()).collect();
        return Err((None, RecordFault::NoTime { found: shown(&headers) }));
    }
    Ok(found)
}

fn find_velocities(headers: &[Header<'_>], named: bool, time: Option<usize>) -> Vec<usize> {
    let is_velocity = |i: usize| {
        let header = &headers[i];
        let by_unit = header.unit.as_deref().map(|unit| scale(unit, Dimension::Velocity).is_ok());
        let by_name = VELOCITIES.contains(&header.name.to_lowercase().as_str());
        !named || by_unit == Some(true) || by_name
    };
    (0..headers.len()).filter(|&i| Some(i) != time && is_velocity(i)).collect()
}

/// A column by its header, its name without the unit, or its number.
fn find(headers: &[Header<'_>], asked: &str) -> Result<usize, ColumnFault> {
    let asked = asked.trim();
    let by = |same: &dyn Fn(&Header<'_>) -> bool| headers.iter().position(same);
    by(&|h| h.text == asked)
        .or_else(|| by(&|h| h.name.eq_ignore_ascii_case(asked)))
        .or_else(|| asked.parse().ok().and_then(|n: usize| n.checked_sub(1)).filter(|i| *i < headers.len()))
        .ok_or_else(|| {
            let found: Vec<String> = headers.iter().map(|h| h.text.to_owned()).collect();
            (None, RecordFault::NoSuchColumn { asked: excerpt(asked, 40), found: shown(&found) })
        })
}

/// `u_m_s`, `u [m/s]`, `u (m/s)` and `u m/s` into name and unit.
fn take_apart(text: &str) -> Header<'_> {
    let text = text.trim();
    let known = |unit: &str| scale(unit, Dimension::Time).is_ok() || scale(unit, Dimension::Velocity).is_ok();
    for (open, close) in [('[', ']'), ('(', ')')] {
        if let Some((name, rest)) = text.split_once(open)
            && let Some((unit, _)) = rest.split_once(close)
        {
            return Header { text, name: tidy(name), unit: Some(unit.trim().to_owned()) };
        }
    }
    for (at, joint) in text.char_indices().filter(|(_, c)| matches!(c, '_' | ' ' | '/')) {
        let (name, unit) = (&text[..at], &text[at + joint.len_utf8()..]);
        if !name.is_empty() && known(unit) {
            return Header { text, name: tidy(name), unit: Some(unit.trim().to_owned()) };
        }
    }
    Header { text, name: tidy(text), unit: None }
}

fn tidy(name: &str) -> String {
    excerpt(name.trim().trim_matches(['_', '/', '-', ':']), 40)
}

fn factor(header: &Header<'_>, dimension: Dimension, asked: Option<&str>) -> Result<f64, ColumnFault> {
    let (example, flag) = match dimension {
        Dimension::Time => ("time_s", "--time-unit"),
        _ => ("u_m_s", "--velocity-unit"),
    };
    let blamed = |fault| (Some(header.text.to_owned()), fault);
    let asked_factor = asked
        .map(|unit| {
            let option = format!("{flag} \"{}\"", excerpt(unit, 20));
            scale(unit, dimension).map_err(|fault| (None, RecordFault::Option { option, fault }))
        })
        .transpose()?;
    match (&header.unit, asked_factor) {
        (None, None) => {
            let flag = if dimension == Dimension::Time { "--time-unit s" } else { "--velocity-unit m/s" };
            Err(blamed(RecordFault::NoUnit { example, flag }))
        }
        (None, Some(factor)) => Ok(factor),
        (Some(unit), asked_factor) => {
            let Ok(factor) = scale(unit, dimension) else {
                return Err(blamed(RecordFault::WrongUnit { unit: excerpt(unit, 20), wanted: dimension }));
            };
            match asked_factor {
                Some(other) if other != factor => Err(blamed(RecordFault::MixedUnits {
                    written: excerpt(unit, 20),
                    asked: excerpt(asked.unwrap_or_default(), 20),
                    flag,
                })),
                _ => Ok(factor),
            }
        }
    }
}

/// SI units in one of this unit, however a header may spell it.
fn scale(unit: &str, dimension: Dimension) -> Result<f64, QuantityFault> {
    let unit = unit.trim();
    let spelt = match (dimension, unit) {
        (Dimension::Time, "sec" | "seconds" | "Sekunden" | "S") => "s",
        (Dimension::Velocity, "m s-1" | "m s^-1" | "m·s⁻¹" | "m s⁻¹" | "ms^-1" | "ms⁻¹" | "m.s-1") => {
            "m/s"
        }
        _ => unit,
    };
    let spelt = if dimension == Dimension::Velocity { spelt.replace('_', "/") } else { spelt.to_owned() };
    dimension.parse(&format!("1 {spelt}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apart(text: &str) -> (String, Option<String>) {
        let header = take_apart(text);
        (header.name, header.unit)
    }

    #[test]
    fn headers_are_taken_apart_however_they_are_spelt() {
        for (text, name, unit) in [
            ("u_m_s", "u", Some("m_s")),
            ("time_ms", "time", Some("ms")),
            ("U [m/s]", "U", Some("m/s")),
            ("Zeit (µs)", "Zeit", Some("µs")),
            ("t/s", "t", Some("s")),
            ("v m/s", "v", Some("m/s")),
            ("mean_u_cm_s", "mean_u", Some("cm_s")),
            ("velocity_x", "velocity_x", None),
            ("", "", None),
            ("_", "", None),
        ] {
            assert_eq!(apart(text), (name.to_owned(), unit.map(str::to_owned)), "{text}");
        }
    }

    #[test]
    fn the_component_along_the_flow_comes_first() {
        let headers = ["w_m_s", "t_s", "T_degC", "u_cm_s"].map(str::to_owned);
        let roles = roles(&headers, true, &Layout::default()).unwrap();
        let names: Vec<_> = roles.components.iter().map(|c| (c.name.as_str(), c.factor)).collect();
        assert_eq!(names, [("u", 0.01), ("w", 1.0)]);
        assert_eq!(roles.unused, ["T_degC"]);
    }
}
