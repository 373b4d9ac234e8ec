//! Makes an evenly sampled record of rows: places them by their times and fills gaps.

use super::clock::{Spacing, place};
use super::columns::Roles;
use super::{Layout, MOST_NUMBERS, Reading, Record, Samples};
use spunlaid_ground::error::memory;
use spunlaid_ground::units::shortest;
use spunlaid_ground::{Fault, FileError, Position};

/// Collects rows.
pub(super) struct Rows {
    roles: Roles,
    longest_gap: usize,
    /// Time between samples [s], if it is given.
    interval: Option<f64>,
    /// Times of the rows [s], NaN where they are missing; empty if the interval is given.
    times: Vec<f64>,
    /// Unit of the last digit of the times [s].
    unit: f64,
    places: Places,
    values: Vec<Vec<f64>>,
    reading: Reading,
}

impl Rows {
    pub(super) fn new(roles: Roles, layout: &Layout) -> Self {
        let count = roles.components.len();
        let reading =
            Reading { unused: roles.unused.clone(), timed: roles.time.is_some(), ..Reading::default() };
        Self {
            roles,
            longest_gap: layout.longest_gap,
            interval: layout.rate.map(|rate| 1.0 / rate),
            times: Vec::new(),
            unit: f64::INFINITY,
            places: Places::default(),
            values: vec![Vec::new(); count],
            reading,
        }
    }

    /// Adds a row.
    ///
    /// * `time` – in the unit of the file; NaN if it is missing
    /// * `unit` – of its last digit
    /// * `values` – in the units of the file; NaN if one is missing
    pub(super) fn push(
        &mut self,
        place: Position,
        time: f64,
        unit: f64,
        values: &[f64],
    ) -> Result<(), FileError> {
        let rows = self.values.first().map_or(0, Vec::len);
        self.places.put(rows, place);
        check_size((rows + 1).saturating_mul(self.values.len())).map_err(|error| error.at(place))?;
        if self.interval.is_none()
            && let Some(column) = &self.roles.time
        {
            self.times.push(time * column.factor);
            if !time.is_nan() {
                self.unit = self.unit.min(unit * column.factor);
            }
        }
        let numbers = values.iter().copied().chain(std::iter::repeat(f64::NAN));
        for ((all, column), value) in self.values.iter_mut().zip(&self.roles.components).zip(numbers) {
            all.push(value * column.factor);
        }
        Ok(())
    }

    /// Places the rows by their times.
    fn place(&mut self) -> Result<Spacing, FileError> {
        if let Some(interval) = self.interval {
            return Ok(Spacing { interval: Some(interval), ..Spacing::default() });
        }
        let header = self.roles.time.as_ref().map_or("", |column| &column.header);
        let blame = |row: usize, fault: Fault| FileError::from(fault).at(self.places.of(row)).column(header);
        let times = std::mem::take(&mut self.times);
        let spacing = place(&times, self.unit).map_err(|(row, fault)| blame(row, fault))?;
        match spacing.lost.iter().find(|(_, lost)| *lost > self.longest_gap) {
            Some((row, lost)) => Err(blame(*row, gap_too_long(*lost as f64, self.longest_gap))),
            None => Ok(spacing),
        }
    }

    /// The component with its missing rows, and the error of a gap that is too long.
    fn spread(&self, component: usize, lost: &[(usize, usize)]) -> Result<Vec<f64>, FileError> {
        let values = &self.values[component];
        let mut spread = Vec::with_capacity(values.len() + lost.iter().map(|(_, lost)| lost).sum::<usize>());
        let mut lost = lost.iter().peekable();
        // Samples that are missing since the last valid one; none before the first.
        let mut missing = None;
        for (row, value) in values.iter().enumerate() {
            if let Some((_, count)) = lost.next_if(|(at, _)| *at == row) {
                spread.extend(std::iter::repeat_n(f64::NAN, *count));
                missing = missing.map(|missing| missing + count);
            }
            spread.push(*value);
            if value.is_nan() {
                missing = missing.map(|missing| missing + 1);
                continue;
            }
            if let Some(missing) = missing.filter(|missing| *missing > self.longest_gap) {
                let fault = gap_too_long(missing as f64, self.longest_gap);
                let header = &self.roles.components[component].header;
                return Err(FileError::from(fault).at(self.places.of(row)).column(header));
            }
            missing = Some(0);
        }
        Ok(spread)
    }

    /// Makes the record.
    pub(super) fn finish(mut self) -> Result<Record, FileError> {
        let Spacing { interval, lost, jitter, doubt } = self.place()?;
        let skipped: usize = lost.iter().map(|(_, lost)| lost).sum();
        let rows = self.values.first().map_or(0, Vec::len) + skipped;
        check_size(rows.saturating_mul(self.values.len()))?;
        for component in 0..self.values.len() {
            self.values[component] = self.spread(component, &lost)?;
        }
        let whole = |i: &usize| self.values.iter().all(|v| v.get(*i).is_some_and(|x| !x.is_nan()));
        let first = (0..rows).find(whole).unwrap_or(rows);
        let end = (first..rows).rev().find(whole).map_or(first, |last| last + 1);
        if first == end {
            return Err(Fault::no_rows().into());
        }
        let Some(interval) = interval else {
            let least = super::LEAST_SAMPLES;
            return Err(super::too_few_samples(end - first, least).into());
        };
        self.reading.skipped = skipped;
        self.reading.jitter = jitter;
        self.reading.doubt = doubt;
        self.reading.cut_off = rows - (end - first);
        self.reading.cut_off_start = first;
        self.reading.factors = self.roles.components.iter().map(|column| column.factor).collect();
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

fn check_size(numbers: usize) -> Result<(), FileError> {
    if numbers <= MOST_NUMBERS {
        return Ok(());
    }
    let most = memory(MOST_NUMBERS as f64 * 8.0);
    let fault = Fault::new(
        format!("holds more than {MOST_NUMBERS} numbers, which would take more than {most} of memory"),
        "cut it into pieces",
    );
    Err(fault.into())
}

/// Where rows stand in the file. Most follow one another.
#[derive(Default)]
struct Places {
    /// Rows that do not stand just behind the row before, with their place.
    leaps: Vec<(usize, Position)>,
}

impl Places {
    fn put(&mut self, row: usize, place: Position) {
        if self.leaps.is_empty() || self.of(row) != place {
            self.leaps.push((row, place));
        }
    }

    fn of(&self, row: usize) -> Position {
        let leap = self.leaps.partition_point(|(leap, _)| *leap <= row).saturating_sub(1);
        let Some((from, place)) = self.leaps.get(leap) else { return Position::Row(row as u64 + 1) };
        let further = (row - from) as u64;
        match place {
            Position::Line(line) => Position::Line(line + further),
            Position::Row(first) => Position::Row(first + further),
            other => *other,
        }
    }
}

/// Interpolates missing values linearly; returns how many there were.
pub(super) fn fill(values: &mut [f64]) -> usize {
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
    let missing = if missing == 1.0 {
        "1 sample is missing before here".to_owned()
    } else {
        format!("{} samples in a row are missing up to here", shortest(missing))
    };
    Fault::new(
        format!("{missing}, more than the {most} that are filled in"),
        "cut the record here, fill in the missing samples, or allow longer gaps (air.record_max_gap in a case)",
    )
    .option("--max-gap")
}
