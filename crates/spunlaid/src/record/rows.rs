//! Makes an evenly sampled record of rows: checks the times and fills gaps.

use super::columns::Roles;
use super::{Layout, MOST_NUMBERS, Reading, Record, Samples};
use crate::error::{Fault, FileError, Position, memory};
use crate::units::{Dimension, shortest};

/// Largest deviation of a time step from the usual one, as a share of it.
const JITTER: f64 = 0.01;
/// Largest deviation that the rounding of written times may explain, as a share of a step.
const ROUNDING: f64 = 0.25;

/// Collects rows.
pub(super) struct Rows {
    roles: Roles,
    longest_gap: usize,
    clock: Clock,
    values: Vec<Vec<f64>>,
    /// For each component the number of missing samples since the last valid one, and whether there was a valid one.
    missing: Vec<(usize, bool)>,
    reading: Reading,
}

/// How the times of the rows are known.
#[derive(Clone, Copy, Debug)]
enum Clock {
    /// By a fixed interval [s].
    Even(f64),
    /// By a column of the file.
    Watched {
        /// First time and its row, last time and its row.
        known: Option<((f64, usize), (f64, usize))>,
        /// Unit of the last digit of the times [s].
        rounding: f64,
    },
}

impl Rows {
    pub(super) fn new(roles: Roles, layout: &Layout) -> Self {
        let clock = match layout.rate {
            Some(rate) => Clock::Even(1.0 / rate),
            None => Clock::Watched { known: None, rounding: f64::INFINITY },
        };
        let count = roles.components.len();
        let reading =
            Reading { unused: roles.unused.clone(), timed: roles.time.is_some(), ..Reading::default() };
        Self {
            roles,
            longest_gap: layout.longest_gap,
            clock,
            values: vec![Vec::new(); count],
            missing: vec![(0, false); count],
            reading,
        }
    }

    /// Adds a row.
    ///
    /// * `time` – time and unit of its last digit, in the unit of the file; NaN if it is missing
    /// * `values` – in the units of the file; NaN if one is missing
    pub(super) fn push(
        &mut self,
        place: Position,
        time: (f64, f64),
        values: &[f64],
    ) -> Result<(), FileError> {
        let lost = self.watch(place, time)?;
        let length = self.values.first().map_or(0, Vec::len) + lost + 1;
        if length.saturating_mul(self.values.len()) > MOST_NUMBERS {
            let fault = Fault::new(
                format!(
                    "holds more than {} numbers, which would take more than {} of memory",
                    MOST_NUMBERS,
                    memory(MOST_NUMBERS as f64 * 8.0)
                ),
                "cut it into pieces",
            );
            return Err(FileError::from(fault).at(place));
        }
        for component in 0..self.values.len() {
            for _ in 0..lost {
                self.put(place, component, f64::NAN)?;
            }
            let value = values.get(component).copied().unwrap_or(f64::NAN);
            self.put(place, component, value * self.roles.components[component].factor)?;
        }
        self.reading.skipped += lost;
        Ok(())
    }

    fn put(&mut self, place: Position, component: usize, value: f64) -> Result<(), FileError> {
        let (missing, begun) = self.missing[component];
        if value.is_nan() {
            self.missing[component].0 = missing + 1;
        } else {
            if begun && missing > self.longest_gap {
                let header = &self.roles.components[component].header;
                let fault = gap_too_long(missing as f64, self.longest_gap);
                return Err(FileError::from(fault).at(place).column(header));
            }
            self.missing[component] = (0, true);
        }
        self.values[component].push(value);
        Ok(())
    }

    /// Checks the time of a row; returns how many rows are missing before it.
    fn watch(&mut self, place: Position, (time, unit): (f64, f64)) -> Result<usize, FileError> {
        let Clock::Watched { known, rounding } = self.clock else { return Ok(0) };
        let Some(column) = &self.roles.time else { return Ok(0) };
        let blame = |fault: Fault| Err(FileError::from(fault).at(place).column(&column.header));
        if time.is_nan() {
            return Ok(0);
        }
        let row = self.values.first().map_or(0, Vec::len);
        let time = time * column.factor;
        let rounding = rounding.min(unit * column.factor);
        let Some(((first, first_row), (last, last_row))) = known else {
            self.clock = Clock::Watched { known: Some(((time, row), (time, row))), rounding };
            return Ok(0);
        };
        let step = time - last;
        if !step.is_finite() || step <= 0.0 {
            return blame(Fault::new(format!("time goes from {} s to {} s", shortest(last), shortest(time)), "rows must be in order of time. If the times are only written with too few digits, give the sampling rate").option("--rate"));
        }
        let mut lost = 0;
        let rows = (row - last_row) as f64;
        if last_row > first_row {
            let usual = (last - first) / (last_row - first_row) as f64;
            let bound = JITTER * usual + (2.0 * rounding).min(ROUNDING * usual);
            let off = (step - rows * usual).abs();
            if off <= bound {
                self.reading.jitter = self.reading.jitter.max(off / usual);
            } else {
                let whole = (step / usual).round();
                let skips =
                    whole > rows && (step - whole * usual).abs() <= bound + JITTER * (whole - rows) * usual;
                if !skips {
                    return blame(Fault::new(format!("the time step changes from {} to {}", Dimension::Time.pretty(usual), Dimension::Time.pretty(step)), "samples must be evenly spaced to within 1 %. Resample the record, or give the sampling rate if you know that the clock was even").option("--rate"));
                }
                if whole - rows > self.longest_gap as f64 {
                    let fault = gap_too_long(whole - rows, self.longest_gap);
                    return blame(fault);
                }
                lost = (whole - rows) as usize;
            }
        }
        self.clock = Clock::Watched { known: Some(((first, first_row), (time, row + lost))), rounding };
        Ok(lost)
    }

    /// Makes the record.
    pub(super) fn finish(mut self) -> Result<Record, FileError> {
        let rows = self.values.first().map_or(0, Vec::len);
        let whole = |i: &usize| self.values.iter().all(|v| v.get(*i).is_some_and(|x| !x.is_nan()));
        let first = (0..rows).find(whole).unwrap_or(rows);
        let end = (first..rows).rev().find(whole).map_or(first, |last| last + 1);
        if first == end {
            return Err(Fault::no_rows().into());
        }
        let interval = match self.clock {
            Clock::Even(interval) => interval,
            Clock::Watched { known: Some((a, b)), .. } if b.1 > a.1 => (b.0 - a.0) / (b.1 - a.1) as f64,
            Clock::Watched { .. } => {
                let least = super::limits::LEAST_SAMPLES;
                return Err(super::limits::too_few_samples(end - first, least).into());
            }
        };
        self.reading.cut_off = rows - (end - first);
        self.reading.cut_off_start = first;
        let mut components = Vec::new();
        for (mut values, column) in self.values.into_iter().zip(&self.roles.components) {
            values.truncate(end);
            values.drain(..first);
            values.shrink_to_fit();
            self.reading.filled += fill(&mut values);
            components.push(Samples { name: column.name.clone(), values });
        }
        Ok(Record { file: String::new(), interval, components, reading: self.reading })
    }
}

/// Interpolates missing values linearly; returns how many there were.
fn fill(values: &mut [f64]) -> usize {
    let mut filled = 0;
    let mut last = 0;
    for i in 0..values.len() {
        if values[i].is_nan() {
            continue;
        }
        let gap = i - last;
        if gap > 1 {
            let (from, to) = (values[last], values[i]);
            for k in 1..gap {
                values[last + k] = from + (to - from) * (k as f64 / gap as f64);
            }
            filled += gap - 1;
        }
        last = i;
    }
    filled
}

/// The fault of too many samples that are missing in a row.
fn gap_too_long(missing: f64, most: usize) -> Fault {
    let missing = shortest(missing);
    Fault::new(
        format!("{missing} samples in a row are missing up to here, more than the {most} that are filled in"),
        "cut the record here, fill in the missing samples, or allow longer gaps (air.record_max_gap in a case)",
    )
    .option("--max-gap")
}
