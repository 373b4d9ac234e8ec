//! Text tables: a line for each row of the map, or a row for each of its points.

use super::{LEAST_SIDE, RawPicture, within_limits};
use spunlaid_ground::table::scale;
use spunlaid_ground::units::shortest;
use spunlaid_ground::{Dimension, Fault, FileError, FileKind, Head, Table};
use std::io::Read;

pub(super) fn parse(bytes: &[u8]) -> Result<RawPicture, FileError> {
    let corner = corner(bytes).unwrap_or_default();
    let mut table = Table::open(corner.as_bytes().chain(bytes), FileKind::Scan, 0)?;
    let columns = table.heads().len();
    let (mut values, mut rows) = (Vec::new(), 0);
    while table.next_row()? {
        rows += 1;
        within_limits(columns as u64, rows as u64)?;
        for column in 0..columns {
            values.push(table.number(column)?);
        }
    }
    let raw = RawPicture::plain(values, columns, rows);
    Ok(if columns == POINT { of_points(&raw, table.heads())? } else { without_numbers(raw, table.heads())? })
}

/// Columns of a table of points: x, y and the value there.
const POINT: usize = 3;
/// Coordinates that differ by less than this share of a cell are the same.
const SAME: f64 = 0.1;

/// The map of a table with a row for each of its points, in any order.
fn of_points(raw: &RawPicture, heads: &[Head]) -> Result<RawPicture, Fault> {
    let place = |name: &str, usual: usize| {
        heads.iter().position(|head| head.name.trim().eq_ignore_ascii_case(name)).unwrap_or(usual)
    };
    let [x, y] = [place("x", 0), place("y", 1)];
    let no_lattice = || {
        Fault::new(
            format!(
                "has three columns, as x, y and the value at each point, and its {} points are not a \
                 structured grid of square cells",
                raw.rows
            ),
            "write a line for each row of the map, or the value at each point of a structured grid of square cells",
        )
    };
    let along = |column: usize| Positions::new(raw.values.iter().skip(column).step_by(POINT).copied());
    let [Some(across), Some(along)] = [along(x), along(y)] else { return Err(no_lattice()) };
    let [columns, rows] = within_limits(across.count as u64, along.count as u64)?;
    if x == y || columns * rows < raw.rows || 2 * raw.rows < columns * rows {
        return Err(no_lattice());
    }
    let mut values = vec![f64::NAN; columns * rows];
    for point in raw.values.chunks_exact(POINT) {
        let [Some(column), Some(row)] = [across.place(point[x]), along.place(point[y])] else {
            return Err(no_lattice());
        };
        values[row * columns + column] = point[POINT - x - y];
    }
    let unit = |column: usize| scale(heads[column].unit.as_deref()?, Dimension::Length);
    let pixel = square([across.step, along.step], unit(x).filter(|_| unit(x) == unit(y)))?;
    Ok(RawPicture { pixel, ..RawPicture::plain(values, columns, rows) })
}

/// Coordinates of cells that lie evenly along an axis.
struct Positions {
    first: f64,
    step: f64,
    count: usize,
}

impl Positions {
    fn new(coordinates: impl Iterator<Item = f64>) -> Option<Self> {
        let mut sorted: Vec<f64> = coordinates.collect();
        sorted.sort_unstable_by(f64::total_cmp);
        let (first, last) = (*sorted.first()?, *sorted.last()?);
        // The smallest distance that is not one of rounding.
        let rounding = 1e-6 * (last - first);
        let steps = sorted.windows(2).map(|pair| pair[1] - pair[0]).filter(|step| *step > rounding);
        let step = steps.fold(f64::INFINITY, f64::min);
        let count = ((last - first) / step).round();
        (count.is_finite() && count < sorted.len() as f64).then(|| Self {
            first,
            step: (last - first) / count,
            count: count as usize + 1,
        })
    }

    fn place(&self, coordinate: f64) -> Option<usize> {
        let place = (coordinate - self.first) / self.step;
        ((place - place.round()).abs() < SAME).then(|| place.round() as usize)
    }
}

/// Width and height of a cell by the positions of columns and rows, where their unit is known [m].
///
/// # Errors
/// When the positions show that the cells are not square.
fn square(steps: [f64; 2], unit: Option<f64>) -> Result<Option<[f64; 2]>, Fault> {
    let [width, height] = steps.map(f64::abs);
    // One of the two may count, where the other one has positions.
    let counts = [width, height].iter().filter(|step| **step == 1.0).count();
    if (unit.is_some() || counts != 1) && (width / height - 1.0).abs() > EVEN {
        let [wide, high] = [width, height].map(|step| {
            unit.map_or_else(|| shortest(step), |unit| Dimension::Length.pretty_to(step * unit, 4))
        });
        return Err(Fault::new(
            format!("has cells that are {wide} wide and {high} high, by the positions next to them"),
            "write the map in square cells: join cells along the direction in which they are shorter",
        ));
    }
    Ok(unit.map(|unit| [width * unit, height * unit]))
}

/// Lines that are compared with the first one.
const COMPARED: usize = 100;

/// The head of the first column, where the first line lacks it: programs write the names of columns without
/// one for those of rows.
fn corner(bytes: &[u8]) -> Option<String> {
    let lines = bytes.split(|byte| *byte == b'\n').filter(|line| !line.trim_ascii().is_empty());
    let lines: Vec<_> = lines.take(COMPARED).map(String::from_utf8_lossy).collect();
    let (head, rows) = lines.split_first().filter(|(_, rows)| rows.len() > 1)?;
    let by = |sign: char, line: &str| match sign {
        ' ' => line.split_ascii_whitespace().count(),
        _ => line.trim_end().split(sign).count(),
    };
    let sign = [' ', ',', ';', '\t'].into_iter().max_by_key(|sign| by(*sign, &rows[0]))?;
    let cells = by(sign, head) + 1;
    rows.iter().all(|row| by(sign, row) == cells).then(|| format!("row{sign}"))
}

/// The map without the numbers of its rows and columns, which programs for tables write beside it. Measured
/// weights never lie so evenly.
///
/// * `heads` – what stands above the columns
fn without_numbers(raw: RawPicture, heads: &[Head]) -> Result<RawPicture, Fault> {
    let (columns, rows) = (raw.columns, raw.rows);
    if columns < 2 || rows < 2 {
        return Ok(raw);
    }
    let line = |first: usize, step: usize, count: usize| -> Vec<f64> {
        raw.values[first..].iter().copied().step_by(step).take(count).collect()
    };
    // Beside a line of numbers, the next line is none, or the map itself is even.
    let row = |at: usize, left: usize| line(at * columns + left, 1, columns - left);
    let column = |at: usize, top: usize| line(top * columns + at, columns, rows - top);
    let is_above = |left: usize| counts(&row(0, left)) && !counts(&row(1, left));
    let is_beside = |top: usize| counts(&column(0, top)) && !counts(&column(1, top));
    let is_corner_empty = raw.values[0].is_nan() && is_above(1);
    let numbered = if is_corner_empty || is_above(1) && is_beside(1) {
        [true, true]
    } else {
        [is_beside(0), is_above(0)]
    };
    let [left, top] = numbered.map(usize::from);
    let above = if top == 1 {
        row(0, left)
    } else {
        heads[left..].iter().map(|head| head.text.trim().parse().unwrap_or(f64::NAN)).collect()
    };
    let beside = if left == 1 { column(0, top) } else { Vec::new() };
    let corner =
        heads.first().and_then(|head| scale(head.unit.as_ref().unwrap_or(&head.text), Dimension::Length));
    let pixel = match counts(&above) && counts(&beside) {
        true => square([&above, &beside].map(|line| step(line)), corner)?,
        false => None,
    };
    let values = raw.values.chunks_exact(columns).skip(top).flat_map(|row| row[left..].to_vec()).collect();
    Ok(RawPicture { values, columns: columns - left, rows: rows - top, numbered, pixel, ..raw })
}

/// Numbers differ from even ones by less than this share of their distance, for they may be rounded.
const EVEN: f64 = 0.02;

/// The mean distance of values in order.
fn step(values: &[f64]) -> f64 {
    match (values.first(), values.last()) {
        (Some(first), Some(last)) => (last - first) / (values.len() - 1).max(1) as f64,
        _ => f64::NAN,
    }
}

/// Whether the values rise or fall evenly.
fn counts(values: &[f64]) -> bool {
    let (Some(first), step) = (values.first(), step(values)) else { return false };
    let is_even = |(i, value): (usize, &f64)| (value - first - step * i as f64).abs() <= EVEN * step.abs();
    values.len() >= LEAST_SIDE && step != 0.0 && values.iter().enumerate().all(is_even)
}
