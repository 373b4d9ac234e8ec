//! Whether a file holds the air of one time.

use super::array::Array;
use super::names::Name;
use crate::fault::several_times;
use spunlaid_ground::units::{excerpt, shortest};
use spunlaid_ground::{FileError, Table};

/// Names of columns of time, with or without a unit of time at their end.
const COLUMNS: [&str; 13] = [
    "time",
    "timestep",
    "time_step",
    "timevalue",
    "time_value",
    "solutiontime",
    "solution_time",
    "flow_time",
    "physical_time",
    "time_index",
    "timestep_index",
    "time_step_index",
    "zeit",
];
const UNITS: [&str; 8] = ["s", "sec", "second", "seconds", "ms", "us", "µs", "min"];
/// Names of the arrays with which VTK files give the time of their values.
const ARRAYS: [&str; 2] = ["TimeValue", "TIME"];
/// Times that differ by less than this share are one, in single and in double precision.
const ROUNDING: f64 = 1e-6;

/// The columns of time of a table.
pub(super) struct Times {
    columns: Vec<Column>,
    /// Where the first point is.
    first: Option<Vec<f64>>,
}

struct Column {
    index: usize,
    /// Whether it may be a temperature: it is a time if the first point occurs again with another value.
    is_doubtful: bool,
    /// What the first row has.
    first: Option<String>,
}

impl Times {
    pub(super) fn new(names: &[Name]) -> Self {
        let column = |(index, name): (usize, &Name)| {
            let is_doubtful = name.plain == "t";
            let is_time = is_doubtful || is_time(&name.plain);
            is_time.then_some(Column { index, is_doubtful, first: None })
        };
        Self { columns: names.iter().enumerate().filter_map(column).collect(), first: None }
    }

    /// Looks at a row.
    ///
    /// * `place` – its coordinates
    pub(super) fn look(&mut self, table: &Table<&[u8]>, place: &[f64]) -> Result<(), FileError> {
        if self.columns.is_empty() {
            return Ok(());
        }
        let is_first_place = self.first.get_or_insert_with(|| place.to_vec()) == place;
        for column in &mut self.columns {
            let text = table.text(column.index).trim();
            let first = column.first.get_or_insert_with(|| text.to_owned());
            if !text.is_empty() && !is_same(first, text) && (is_first_place || !column.is_doubtful) {
                let [first, text] = [first.as_str(), text].map(|text| excerpt(text, 20));
                let fault = several_times(&format!("has {text} here and {first} in the first row"));
                return Err(table.blame(column.index, fault));
            }
        }
        Ok(())
    }
}

fn is_time(plain: &str) -> bool {
    COLUMNS.iter().chain(&["t"]).any(|name| match plain.strip_prefix(name) {
        Some("") => true,
        Some(rest) => rest.strip_prefix('_').is_some_and(|unit| UNITS.contains(&unit)),
        None => false,
    })
}

/// Whether two cells are the same number, or the same text.
fn is_same(one: &str, other: &str) -> bool {
    let number = |text: &str| text.replace(',', ".").parse::<f64>().ok();
    one == other || number(one).zip(number(other)).is_some_and(|(one, other)| one == other)
}

/// The names of columns without the time that COMSOL writes behind each, `u (m/s) @ t=0.1`.
pub(super) fn of_one_time<'a>(heads: impl Iterator<Item = &'a str>) -> Result<Vec<&'a str>, FileError> {
    let mut first: Option<&str> = None;
    let mut names = Vec::new();
    for head in heads {
        let (name, time) = head.split_once(" @ t=").map_or((head, None), |(name, time)| (name, Some(time)));
        names.push(name.trim_end());
        if let Some(time) = time.map(str::trim)
            && !is_same(first.get_or_insert(time), time)
        {
            let [first, time] = [*first.get_or_insert(time), time].map(|time| excerpt(time, 20));
            return Err(several_times(&format!("has columns at t={first} and at t={time}")).into());
        }
    }
    Ok(names)
}

/// Whether this array of a whole VTK file reports its time.
pub(super) fn contains_time(name: &str) -> bool {
    ARRAYS.iter().any(|known| known.eq_ignore_ascii_case(name))
}

/// The one time of a file and of the files before it.
///
/// * `known` – that of the files before it
pub(super) fn one_time(known: &mut Option<f64>, array: &Array<'_>, times: &[f64]) -> Result<(), FileError> {
    for time in times {
        let first = *known.get_or_insert(*time);
        if (first - time).abs() > ROUNDING * first.abs().max(time.abs()) {
            let [first, time] = [first, *time].map(shortest);
            return Err(array.fault(several_times(&format!("is {time} here and {first} before"))));
        }
    }
    Ok(())
}
