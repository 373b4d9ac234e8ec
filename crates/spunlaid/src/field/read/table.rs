//! Tables of points: a row for each, with commas, semicolons, tabs or blanks between its numbers.

use super::array::{Array, Number, Source};
use super::encoding::Budget;
use super::grid::Grid;
use super::names::{self, Found, Name};
use super::piece::{Piece, assemble};
use crate::error::{FieldError, FieldFault, FieldPlace};
use crate::field::{Field, FieldWarning};
use crate::units::excerpt;
use crate::vec3::Vec3;
use std::borrow::Cow;

/// Reads a table.
pub(super) fn read(bytes: &[u8]) -> Result<(Field, Vec<FieldWarning>), FieldError> {
    // UTF-16 begins with one of two marks; a zero is in no text.
    if bytes.contains(&0) || bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        let found = "neither VTK nor text".to_owned();
        let advice = "write it as VTK (.vtu, .vti, .vts, .vtr, .vtk) or as a table (.csv) in UTF-8";
        return Err(FieldFault::Format { found, advice }.into());
    }
    let mut rows = Rows { lines: bytes.split(|byte| *byte == b'\n').zip(1..), separator: Separator::Blanks };
    let (header, first) = rows.header()?;
    let names: Vec<Name> = header.iter().map(|name| Name::new(name)).collect();
    let coordinates = coordinates(&names)?;
    let used = names::used(&names)?;
    let mut columns = Columns { header, numbers: vec![Vec::new(); used.len()], used, dropped: (0, 0) };
    let mut row = Some(first);
    while let Some((line, text)) = row {
        let added = columns.add(line, &text, rows.separator);
        added.map_err(|error| error.at(FieldPlace::Line(line)))?;
        row = rows.next();
    }
    let (field, mut warnings) = assemble(vec![columns.piece(coordinates)], &mut Budget::new())?;
    if let (rows @ 1.., first) = columns.dropped {
        warnings.push(FieldWarning::Dropped { rows, first });
    }
    Ok((field, warnings))
}

/// The columns of the coordinates, the third of which a plane flow does without.
fn coordinates(names: &[Name]) -> Result<[Option<Found>; 3], FieldError> {
    let columns = names::coordinates(names)?;
    let missing = ['x', 'y'].into_iter().zip(columns).find(|(_, column)| column.is_none());
    match missing {
        None => Ok(columns),
        Some((axis, _)) => {
            let found = names.iter().map(|name| excerpt(&name.written, 40)).collect();
            Err(FieldFault::NoCoordinate { axis, found }.into())
        }
    }
}

/// What stands between cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Separator {
    Sign(char),
    Blanks,
}

impl Separator {
    fn of(line: &str) -> Self {
        let sign = ['\t', ';', ','].into_iter().find(|sign| line.contains(*sign));
        sign.map_or(Self::Blanks, Self::Sign)
    }

    fn cells(self, line: &str) -> impl Iterator<Item = &str> {
        let (mut by_sign, mut by_blanks) = (None, None);
        match self {
            Self::Sign(sign) => by_sign = Some(line.split(sign)),
            Self::Blanks => by_blanks = Some(line.split_whitespace()),
        }
        let cells = by_sign.into_iter().flatten().chain(by_blanks.into_iter().flatten());
        cells.map(|cell| cell.trim().trim_matches('"').trim())
    }

    /// The number in a cell, with a decimal comma where that can be meant; NaN where there is none.
    fn number(self, cell: &str) -> Option<f64> {
        if self != Self::Sign(',') && cell.contains(',') && !cell.contains('.') {
            return cell.replacen(',', ".", 1).parse().ok();
        }
        let missing =
            || matches!(cell.to_ascii_lowercase().as_str(), "" | "-" | "null" | "n/a" | "-nan" | "-nan(ind)");
        cell.parse().ok().or_else(|| missing().then_some(f64::NAN))
    }
}

/// A line that is not empty, and its number from 1.
type Row<'a> = (u64, Cow<'a, str>);

/// Goes through the lines.
struct Rows<'a, L: Iterator<Item = (&'a [u8], u64)>> {
    lines: L,
    separator: Separator,
}

impl<'a, L: Iterator<Item = (&'a [u8], u64)>> Rows<'a, L> {
    /// The names of the columns, which stand in the last line before the first row of numbers, and that row
    /// with its line.
    fn header(&mut self) -> Result<(Vec<String>, Row<'a>), FieldError> {
        let mut header = None;
        while let Some((line, text)) = self.next() {
            let separator = Separator::of(&text);
            let cells: Vec<&str> = separator.cells(&text).collect();
            let numbers = || cells.iter().map(|cell| separator.number(cell));
            let row = cells.len() > 1
                && numbers().all(|number| number.is_some())
                && numbers().flatten().any(|number| !number.is_nan());
            if !row {
                header = Some(text);
                continue;
            }
            self.separator = separator;
            let Some(header) = header else {
                return Err(FieldError::from(FieldFault::NoHeader).at(FieldPlace::Line(line)));
            };
            let header = header.trim_start_matches(['#', '%', '/', ' ']);
            // Names may be parted otherwise than numbers are.
            let names = [separator, Separator::of(header)].map(|separator| {
                let names: Vec<String> = separator.cells(header).map(str::to_owned).collect();
                let named = names.iter().rposition(|name| !name.is_empty()).map_or(0, |last| last + 1);
                names[..named].to_vec()
            });
            let [by_rows, by_itself] = names;
            let fits = within(&cells, by_rows.len()).is_ok();
            return Ok((if fits { by_rows } else { by_itself }, (line, text)));
        }
        Err(FieldFault::Empty.into())
    }

    /// The next line that is not empty.
    fn next(&mut self) -> Option<Row<'a>> {
        let (line, number) = self.lines.by_ref().find(|(line, _)| !line.trim_ascii().is_empty())?;
        let text = match str::from_utf8(line) {
            Ok(text) => Cow::Borrowed(text),
            // Latin-1.
            Err(_) => Cow::Owned(line.iter().map(|byte| char::from(*byte)).collect()),
        };
        Some((number, text))
    }
}

/// So many cells of a row; those left over must be empty, for a separator may stand after the last.
fn within<'a, 'b>(cells: &'a [&'b str], wanted: usize) -> Result<&'a [&'b str], FieldFault> {
    match cells.split_at_checked(wanted) {
        Some((cells, rest)) if rest.iter().all(|cell| cell.is_empty()) => Ok(cells),
        _ => Err(FieldFault::Cells { found: cells.len(), wanted }),
    }
}

/// The columns that are used.
struct Columns {
    header: Vec<String>,
    /// Their places in a row.
    used: Vec<usize>,
    numbers: Vec<Vec<f64>>,
    /// Rows that lack a number, and the line of the first.
    dropped: (u64, u64),
}

impl Columns {
    /// Takes in a row, unless it lacks a number.
    fn add(&mut self, line: u64, row: &str, separator: Separator) -> Result<(), FieldError> {
        let cells: Vec<&str> = separator.cells(row).collect();
        let cells = within(&cells, self.header.len())?;
        let number = |column: &usize| {
            let fault = || FieldFault::NotANumber { text: excerpt(cells[*column], 40) };
            separator
                .number(cells[*column])
                .ok_or_else(|| FieldError::from(fault()).array(&self.header[*column]))
        };
        let numbers = self.used.iter().map(number).collect::<Result<Vec<f64>, _>>()?;
        if numbers.iter().any(|number| number.is_nan()) {
            let (count, first) = self.dropped;
            self.dropped = (count + 1, if count == 0 { line } else { first });
            return Ok(());
        }
        self.numbers.iter_mut().zip(numbers).for_each(|(column, number)| column.push(number));
        Ok(())
    }

    fn piece(&self, coordinates: [Option<Found>; 3]) -> Piece<'_> {
        let rows = self.numbers.first().map_or(0, Vec::len);
        let numbers =
            |column: usize| self.used.iter().position(|used| *used == column).map(|i| &self.numbers[i]);
        let along = |axis: Option<Found>, row: usize| {
            axis.and_then(|(column, factor)| Some(numbers(column)?[row] * factor)).unwrap_or(0.0)
        };
        let [x, y, z] = coordinates;
        let points = (0..rows).map(|row| Vec3::new(along(x, row), along(y, row), along(z, row))).collect();
        let is_value = |used: usize| coordinates.iter().flatten().all(|(column, _)| *column != used);
        let values = self.used.iter().zip(&self.numbers).filter(|(used, _)| is_value(**used));
        let arrays = values.map(|(used, numbers)| Array {
            name: self.header[*used].clone(),
            number: Number::F64,
            components: 1,
            source: Source::Numbers(numbers),
            place: FieldPlace::Whole,
        });
        Piece { grid: Grid::Scattered(points), point_data: arrays.collect(), cell_data: Vec::new() }
    }
}
