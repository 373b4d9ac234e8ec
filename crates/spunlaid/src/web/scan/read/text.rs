//! Text tables: a line for each row of the map.

use super::{LEAST_SIDE, RawPicture, within_limits};
use crate::ground::{FileError, FileKind, Table};
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
    Ok(without_numbers(RawPicture::plain(values, columns, rows)))
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
fn without_numbers(raw: RawPicture) -> RawPicture {
    let (columns, rows) = (raw.columns, raw.rows);
    if columns < 2 || rows < 2 {
        return raw;
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
    let values = raw.values.chunks_exact(columns).skip(top).flat_map(|row| row[left..].to_vec()).collect();
    RawPicture { values, columns: columns - left, rows: rows - top, numbered, ..raw }
}

/// Numbers differ from even ones by less than this share of their distance, for they may be rounded.
const EVEN: f64 = 0.02;

/// Whether the values rise or fall evenly.
fn counts(values: &[f64]) -> bool {
    let (Some(first), Some(last)) = (values.first(), values.last()) else { return false };
    let step = (last - first) / (values.len() - 1).max(1) as f64;
    let is_even = |(i, value): (usize, &f64)| (value - first - step * i as f64).abs() <= EVEN * step.abs();
    values.len() >= LEAST_SIDE && step != 0.0 && values.iter().enumerate().all(is_even)
}
