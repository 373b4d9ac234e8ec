//! Tables of points, one row for each point.

use super::array::{Array, NumberType, Source};
use super::arrays::{Arrays, Velocity};
use super::assembly::Assembly;
use super::blanks::Mark;
use super::grid::Grid;
use super::missing;
use super::names::{self, Measure, Name, ScaledColumn};
use super::piece::Piece;
use super::times::{self, Times};
use crate::{Field, FieldLayout};
use spunlaid_ground::error::listed;
use spunlaid_ground::units::excerpt;
use spunlaid_ground::{Fault, FileError, FileKind, Position, Table, Vec3, refuse_twice};

/// An example of a valid header.
const EXAMPLE: &str = "x_m,y_m,z_m,u_m_s,v_m_s,w_m_s";

/// Reads a table.
pub(super) fn read(bytes: &[u8], layout: &FieldLayout) -> Result<(Field, Vec<Fault>), FileError> {
    let mut table = Table::open(bytes, FileKind::Field, 0)?;
    if !table.named() {
        return Err(Fault::no_header(EXAMPLE).into());
    }
    let heads = table.heads().iter().map(|head| head.text.as_str());
    let names: Vec<Name> = times::of_one_time(heads)?.into_iter().map(Name::new).collect();
    let coordinates = coordinates(&names)?;
    let arrays = Arrays::from_table(layout, names);
    if arrays.velocity()?.is_none() {
        return Err(missing::velocity(&arrays).into());
    }
    let mut used: Vec<usize> = coordinates.into_iter().flatten().map(|(column, _)| column).collect();
    used.extend(arrays.used()?);
    used.extend((0..arrays.names.len()).filter(|column| Mark::of(&arrays.names[*column]).is_some()));
    refuse_twice(table.heads(), &used)?;
    let placed = coordinates.iter().flatten().count();
    let mut times = Times::new(&arrays.names);
    let mut columns: Vec<Vec<f64>> = vec![Vec::new(); used.len()];
    let mut lines = Vec::new();
    // Number of rows that lack a coordinate, and the line of the first.
    let mut dropped = (0, 0);
    while table.next_row()? {
        let numbers =
            used.iter().map(|column| number(&mut table, *column)).collect::<Result<Vec<f64>, _>>()?;
        if numbers[..placed].iter().any(|number| number.is_nan()) {
            dropped = (dropped.0 + 1, if dropped.0 == 0 { table.line() } else { dropped.1 });
            continue;
        }
        times.look(&table, &numbers[..placed])?;
        lines.push(table.line());
        columns.iter_mut().zip(numbers).for_each(|(column, number)| column.push(number));
    }
    // A case that names two components means a plane flow.
    if let (Some(Velocity::Components([Some(_), Some(_), None])), [.., Some(_)], None) =
        (arrays.velocity()?, coordinates, &layout.velocity)
    {
        refuse_missing_component(&columns[..placed], &columns[placed..])?;
    }
    let own_unit = length_unit(bytes)?;
    let unit = own_unit.unwrap_or(1.0);
    let in_metres = |found: Option<ScaledColumn>| found.map(|(column, factor)| (column, factor * unit));
    let mut assembly = Assembly::new(layout);
    let piece = piece(&arrays.names, &used, &columns, coordinates.map(in_metres));
    assembly.add(Piece { lines, ..piece })?;
    let (mut field, mut warnings) = assembly.finish()?;
    let with_unit = |(column, _): &ScaledColumn| arrays.names[*column].has_unit(Measure::Length);
    let mut found = coordinates.into_iter().flatten().filter(with_unit);
    let above = own_unit.map(|_| "Length unit".to_owned());
    field.measured_coordinate = above.or_else(|| Some(arrays.shown(found.next()?.0)));
    if let (rows @ 1.., first) = dropped {
        let message = match rows {
            1 => format!("the row in line {first} lacks a coordinate and is left out"),
            _ => format!("{rows} rows lack a coordinate and are left out; the first is in line {first}"),
        };
        warnings.push(Fault::plain(message));
    }
    Ok((field, warnings))
}

/// Refuses a table without the component along z whose air is not that of a plane flow: it differs along z, or no two
/// points lie above each other, so that nothing shows that it does not.
fn refuse_missing_component(at: &[Vec<f64>], values: &[Vec<f64>]) -> Result<(), FileError> {
    /// Values that differ by no more than this share of the largest of their column are equal.
    const ALIKE: f64 = 1e-5;
    let [x, y, z] = at else { return Ok(()) };
    let mut order: Vec<usize> = (0..z.len()).collect();
    order.sort_unstable_by(|a, b| x[*a].total_cmp(&x[*b]).then(y[*a].total_cmp(&y[*b])));
    let largest = |column: &Vec<f64>| column.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    let apart: Vec<f64> = values.iter().map(|column| ALIKE * largest(column)).collect();
    let (mut above, mut differs) = (0, false);
    for pair in order.windows(2) {
        let [one, other] = [pair[0], pair[1]];
        if (x[one], y[one]) == (x[other], y[other]) && z[one] != z[other] {
            above += 1;
            differs |=
                values.iter().zip(&apart).any(|(column, apart)| (column[one] - column[other]).abs() > *apart);
        }
    }
    let is_plane = z.iter().all(|other| *other == z[0]);
    if is_plane || above > 0 && !differs {
        return Ok(());
    }
    let remedy = "write the component along z too, like w_m_s; a plane flow needs no z";
    Err(Fault::new(
        "has no velocity along z, and its points lie at different z, where the air differs",
        remedy,
    )
    .into())
}

/// The number in a column of the row; NaN also for infinity, which no air has.
fn number(table: &mut Table<&[u8]>, column: usize) -> Result<f64, FileError> {
    let is_infinite = table.text(column).trim().parse::<f64>().is_ok_and(f64::is_infinite);
    if is_infinite { Ok(f64::NAN) } else { table.number(column) }
}

/// The columns of the coordinates. A plane flow may lack the third.
fn coordinates(names: &[Name]) -> Result<[Option<ScaledColumn>; 3], FileError> {
    let columns = names::coordinates(names)?;
    let missing = ['x', 'y'].into_iter().zip(columns).find(|(_, column)| column.is_none());
    match missing {
        None => Ok(columns),
        Some((axis, _)) => {
            let found: Vec<String> = names.iter().map(|name| excerpt(&name.written, 40)).collect();
            Err(Fault::new(
                format!("none of the columns is a coordinate along {axis} ({})", listed(&found)),
                format!("name it like {axis}_m"),
            )
            .into())
        }
    }
}

/// The value in metres of the unit of length that COMSOL writes above its tables, in a line `% Length unit: mm`, or
/// `% Length unit,mm` where commas separate columns. None if there is no such line.
fn length_unit(bytes: &[u8]) -> Result<Option<f64>, FileError> {
    let above = bytes.split(|byte| *byte == b'\n').take_while(|line| line.starts_with(b"%")).zip(1..);
    for (line, number) in above {
        let text = String::from_utf8_lossy(line);
        let is_separator = |c: char| [':', ',', ';', '\t'].contains(&c);
        if let Some((key, unit)) = text.trim_start_matches(['%', ' ', '"']).split_once(is_separator)
            && key.trim().eq_ignore_ascii_case("length unit")
        {
            // A program for tables may have put separators at the end of each line.
            return Measure::Length
                .factor(unit.trim_matches(|c: char| c.is_whitespace() || c == '"' || is_separator(c)))
                .map(Some)
                .map_err(|error| error.at(Position::Line(number)));
        }
    }
    Ok(None)
}

fn piece<'a>(
    names: &[Name],
    used: &[usize],
    columns: &'a [Vec<f64>],
    coordinates: [Option<ScaledColumn>; 3],
) -> Piece<'a> {
    let rows = columns.first().map_or(0, Vec::len);
    let numbers = |column: usize| used.iter().position(|used| *used == column).map(|i| &columns[i]);
    let along = |axis: Option<ScaledColumn>, row: usize| {
        axis.and_then(|(column, factor)| Some(numbers(column)?[row] * factor)).unwrap_or(0.0)
    };
    let [x, y, z] = coordinates;
    let points = (0..rows).map(|row| Vec3::new(along(x, row), along(y, row), along(z, row))).collect();
    let is_value = |column: &usize| coordinates.iter().flatten().all(|(coordinate, _)| coordinate != column);
    // A column that is not used is there by its name.
    let arrays = (0..names.len()).filter(is_value).map(|column| Array {
        name: names[column].written.clone(),
        number: NumberType::F64,
        components: 1,
        source: Source::Numbers(numbers(column).map_or(&[], Vec::as_slice)),
        place: Position::Whole,
    });
    Piece {
        grid: Grid::Scattered(points),
        point_data: arrays.collect(),
        cell_data: Vec::new(),
        lines: Vec::new(),
    }
}
