//! `spinline.parquet`: the thread from the die to the end.

use crate::Failure;
use crate::output::folder::Staging;
use crate::output::parquet::{Column, ColumnValues, Parquet};
use spunlaid::spinline::{Solution, Station, ZERO_CELSIUS};
use std::fs;

/// Name of the file.
pub const STATIONS: &str = "spinline.parquet";

/// A column: its name with the unit, and its value at a station.
pub type StationColumn = (&'static str, fn(&Station) -> f64);

/// The columns, in the order of the file.
pub const COLUMNS: &[StationColumn] = &[
    ("z_m", |station| station.distance),
    ("speed_m_s", |station| station.speed),
    ("diameter_m", |station| station.diameter),
    ("temperature_c", |station| station.temperature - ZERO_CELSIUS),
    ("tension_n", |station| station.tension),
    ("stress_pa", |station| station.stress),
    ("transformed", |station| station.transformed),
    ("strain_rate_per_s", |station| station.strain_rate),
    ("air_velocity_m_s", |station| station.air_velocity),
    ("air_cross_velocity_m_s", |station| station.air_cross_velocity),
    ("air_temperature_c", |station| station.air_temperature - ZERO_CELSIUS),
];

/// Writes the stations of all threads, one thread after the other. If there are several, the columns before those of
/// [`COLUMNS`] tell them apart: `layer` where the layers of a web have different spinlines, and `row` of a curtain.
///
/// * `spinlines` – the number of the layer, from 1, and the solution of each row
pub fn write(staging: &Staging<'_>, spinlines: &[(usize, &[Solution])]) -> Result<(), Failure> {
    let place = staging.place(STATIONS);
    let folder = place.0.parent().map_or(Ok(()), fs::create_dir_all);
    folder.map_err(Failure::unwritable(&place.1))?;
    let layer = (spinlines.len() > 1).then_some("layer");
    let row = spinlines.iter().any(|(_, rows)| rows.len() > 1).then_some("row");
    let whole = layer.into_iter().chain(row).map(|name| (name, ColumnValues::Whole));
    let numbers = COLUMNS.iter().map(|(name, _)| (*name, ColumnValues::Number));
    let column = |(name, holds): (&str, ColumnValues)| Column { name: name.to_owned(), holds };
    let columns: Vec<Column> = whole.chain(numbers).map(column).collect();
    let first = columns.len() - COLUMNS.len();
    let threads = spinlines.iter().flat_map(|(layer, rows)| {
        rows.iter().enumerate().map(move |(row, solution)| ([*layer, row + 1], &solution.stations))
    });
    let most = threads.clone().map(|(_, stations)| stations.len()).sum();
    let mut table = Parquet::create(place, &columns, most)?;
    for ([of_layer, of_row], stations) in threads {
        let whole = layer.map(|_| of_layer).into_iter().chain(row.map(|_| of_row));
        for (column, number) in whole.enumerate() {
            table.extend_whole(column, stations.iter().map(|_| number as i64));
        }
        for (column, (_, value)) in COLUMNS.iter().enumerate() {
            table.extend(first + column, stations.iter().map(value));
        }
    }
    table.finish().map(drop)
}
