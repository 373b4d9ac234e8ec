//! Finds the column of time, the columns of velocity and their units.

use super::Layout;
use spunlaid_ground::error::listed;
use spunlaid_ground::table::{refuse_twice, scale};
use spunlaid_ground::units::excerpt;
use spunlaid_ground::{Dimension, FORMS, Fault, FileError, FirstCell, Head};

/// Most components of a velocity.
const COMPONENTS: usize = 3;

const TIMES: [&str; 4] = ["time", "zeit", "timestamp", "elapsed"];
/// Letter of the time.
const LETTER: &str = "t";
const VELOCITIES: [&str; 15] =
    ["u", "v", "w", "ux", "uy", "uz", "vx", "vy", "vz", "u1", "u2", "u3", "velocity", "vel", "speed"];
/// Names of the component along the flow.
const ALONG: [&str; 5] = ["u", "ux", "vx", "u1", "velocity"];

/// A column to read.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    /// Index, from 0.
    pub(super) index: usize,
    /// The header in the file.
    pub(super) header: String,
    /// The header without the unit.
    pub(super) name: String,
    /// Factor from the unit of the file to SI.
    pub(super) factor: f64,
    /// Whether it holds time stamps in place of numbers.
    pub(super) stamped: bool,
}

/// The columns of a file by their use.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Roles {
    pub(super) time: Option<Column>,
    pub(super) components: Vec<Column>,
    pub(super) unused: Vec<String>,
}

/// Finds the use of each column.
///
/// * `named` – whether the file names its columns
/// * `first` – what each column begins with
pub(super) fn roles(
    heads: &[Head],
    named: bool,
    first: &[FirstCell],
    layout: &Layout,
) -> Result<Roles, FileError> {
    if let Some(rate) = layout.rate.filter(|rate| !(rate.is_finite() && *rate > 0.0)) {
        return Err(super::rate_fault(rate).into());
    }
    let time = find_time(heads, named, first, layout)?;
    let mut chosen = if layout.columns.is_empty() {
        find_velocities(heads, named, time)
    } else {
        let asked = layout.columns.iter().map(|asked| find(heads, asked));
        asked.collect::<Result<Vec<_>, _>>()?
    };
    if chosen.is_empty() {
        return Err(Fault::new(
            format!("none of the columns is a velocity ({})", listed(&shown(heads))),
            "name them like u_m_s, or say which columns are velocities, and in which unit",
        )
        .option("--columns, --velocity-unit")
        .into());
    }
    if chosen.len() > COMPONENTS {
        let found = shown(chosen.iter().map(|&i| &heads[i]));
        return Err(Fault::new(
            format!("has {} velocity columns, {}", found.len(), listed(&found)),
            "say which of them to take, one to three",
        )
        .option("--columns")
        .into());
    }
    refuse_twice(heads, &chosen.iter().copied().chain(time).collect::<Vec<_>>())?;
    for (n, &i) in chosen.iter().enumerate() {
        if chosen[..n].contains(&i) || time == Some(i) {
            return Err(
                FileError::from(Fault::new("is named twice", "name each column once")).column(&heads[i].text)
            );
        }
    }
    if layout.columns.is_empty() {
        chosen.sort_by_key(|&i| !ALONG.contains(&heads[i].name.to_lowercase().as_str()));
    }
    let column = |index: usize, name: &str, dimension, asked: &Option<String>| {
        // A time stamp says its unit itself.
        let is_time = dimension == Dimension::Time;
        let stamped = is_time && is_stamped(first, index);
        let factor = match first.get(index) {
            _ if stamped => 1.0,
            Some(FirstCell::Text(text)) if is_time => return Err(unknown_stamp(&heads[index], text)),
            _ => factor(&heads[index], dimension, asked.as_deref())?,
        };
        let (header, name) = (heads[index].text.clone(), name.to_owned());
        Ok::<_, FileError>(Column { index, header, name, factor, stamped })
    };
    let mut components = Vec::new();
    for (&i, letter) in chosen.iter().zip(["u", "v", "w"]) {
        let name = if named { &heads[i].name } else { letter };
        components.push(column(i, name, Dimension::Velocity, &layout.velocity_unit)?);
    }
    // A given rate replaces the times of the file.
    let clock = time.filter(|_| layout.rate.is_none());
    let time = clock.map(|i| column(i, &heads[i].name, Dimension::Time, &layout.time_unit)).transpose()?;
    let is_used = |i: usize| chosen.contains(&i) || clock == Some(i);
    let unused = shown(heads.iter().enumerate().filter(|(i, _)| !is_used(*i)).map(|(_, head)| head));
    Ok(Roles { time, components, unused })
}

/// Headers, shortened for messages.
fn shown<'a>(heads: impl IntoIterator<Item = &'a Head>) -> Vec<String> {
    heads.into_iter().map(|head| excerpt(&head.text, 40)).collect()
}

fn is_stamped(first: &[FirstCell], index: usize) -> bool {
    first.get(index) == Some(&FirstCell::Stamp)
}

/// The error of a column of time that begins with a text.
fn unknown_stamp(head: &Head, text: &str) -> FileError {
    let fault = Fault::new(
        format!("\"{text}\" is neither a number nor a time stamp"),
        format!("stamps are written as {FORMS}; or give the sampling rate"),
    );
    FileError::from(fault.option("--rate")).column(&head.text)
}

fn find_time(
    heads: &[Head],
    named: bool,
    first: &[FirstCell],
    layout: &Layout,
) -> Result<Option<usize>, FileError> {
    if let Some(asked) = &layout.time_column {
        return find(heads, asked).map(Some);
    }
    let ranked = (0..heads.len()).filter_map(|i| Some((rank(&heads[i], is_stamped(first, i))?, i)));
    let found = match ranked.min().map(|(_, i)| i) {
        // Without names the first column is the time, unless a rate is given.
        None if !named && layout.rate.is_none() && heads.len() > 1 => Some(0),
        found => found,
    };
    if found.is_none() && layout.rate.is_none() {
        return Err(Fault::new(
            format!("has no column of time (it has {})", listed(&shown(heads))),
            "name it like time_s, write time stamps in it, say which column it is (air.record_time in a \
            case), or give the sampling rate",
        )
        .option("--time-column, --rate")
        .into());
    }
    Ok(found)
}

/// How surely a column is the time: the smallest number is the surest, none is no time. A bare `T` is a temperature in
/// many files.
fn rank(head: &Head, stamped: bool) -> Option<u8> {
    let name = head.name.to_lowercase();
    let (is_named, is_letter) = (TIMES.contains(&name.as_str()), name == LETTER);
    let unit = head.unit.as_deref().map(|unit| scale(unit, Dimension::Time).is_some());
    match (is_named || is_letter, unit) {
        (true, Some(true)) => Some(0),
        (true, _) if stamped => Some(0),
        _ if stamped => Some(1),
        (_, unit) if is_named => Some(if unit.is_none() { 2 } else { 3 }),
        (_, None) if is_letter => Some(if head.name == LETTER { 4 } else { 5 }),
        _ => None,
    }
}

fn find_velocities(heads: &[Head], named: bool, time: Option<usize>) -> Vec<usize> {
    let is_velocity = |head: &Head| {
        let by_unit = head.unit.as_deref().is_some_and(|unit| scale(unit, Dimension::Velocity).is_some());
        !named || by_unit || VELOCITIES.contains(&head.name.to_lowercase().as_str())
    };
    (0..heads.len()).filter(|&i| Some(i) != time && is_velocity(&heads[i])).collect()
}

/// Finds a column by its header, its name without the unit, or its number.
fn find(heads: &[Head], asked: &str) -> Result<usize, FileError> {
    let asked = asked.trim();
    let position = |same: &dyn Fn(&Head) -> bool| heads.iter().position(same);
    position(&|head| head.text == asked)
        .or_else(|| position(&|head| head.name.eq_ignore_ascii_case(asked)))
        .or_else(|| asked.parse().ok().and_then(|n: usize| n.checked_sub(1)).filter(|i| *i < heads.len()))
        .ok_or_else(|| {
            Fault::new(
                format!("has no column {}", excerpt(asked, 40)),
                format!("there are {}", listed(&shown(heads))),
            )
            .into()
        })
}

/// The factor from the unit of a column to SI, by its header or as asked.
fn factor(head: &Head, dimension: Dimension, asked: Option<&str>) -> Result<f64, FileError> {
    let example = if dimension == Dimension::Time { "time_s" } else { "u_m_s" };
    let Some(asked) = asked else { return head.factor(dimension, example) };
    let wanted = Head { unit: Some(asked.to_owned()), ..head.clone() }.factor(dimension, example)?;
    match &head.unit {
        Some(written) if head.factor(dimension, example)? != wanted => {
            let (written, asked) = (excerpt(written, 20), excerpt(asked, 20));
            Err(FileError::from(
                Fault::new(
                    format!("has the unit {written} in its header, but {asked} was given"),
                    "give no unit, or correct the header",
                )
                .option("--time-unit, --velocity-unit"),
            )
            .column(&head.text))
        }
        _ => Ok(wanted),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_component_along_the_flow_comes_first() {
        let heads = ["w_m_s", "t_s", "T_degC", "u_cm_s"].map(Head::new);
        let roles = roles(&heads, true, &[], &Layout::default()).unwrap();
        let names: Vec<_> = roles.components.iter().map(|c| (c.name.as_str(), c.factor)).collect();
        assert_eq!(names, [("u", 0.01), ("w", 1.0)]);
        assert_eq!(roles.unused, ["T_degC"]);
    }
}
