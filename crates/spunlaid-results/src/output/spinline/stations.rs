//! `spinline.parquet`: the thread from the die to the end.

use crate::Failure;
use crate::output::folder::Staging;
use crate::output::parquet::{Column, Holds, Parquet};
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

/// Writes the stations of all rows, one row of the curtain after the other. The first column of a curtain is the number of its
/// row, from 1.
pub fn write(staging: &Staging<'_>, rows: &[Solution]) -> Result<(), Failure> {
    write_as(staging, STATIONS, rows)
}

/// The same under another name.
pub fn write_as(staging: &Staging<'_>, name: &str, rows: &[Solution]) -> Result<(), Failure> {
    let place = staging.place(name);
    let folder = place.0.parent().map_or(Ok(()), fs::create_dir_all);
    folder.map_err(Failure::unwritable(&place.1))?;
    let row = (rows.len() > 1).then(|| Column { name: "row".to_owned(), holds: Holds::Whole });
    let first = usize::from(row.is_some());
    let numbers = COLUMNS.iter().map(|(name, _)| Column { name: (*name).to_owned(), holds: Holds::Number });
    let columns: Vec<Column> = row.into_iter().chain(numbers).collect();
    let stations: usize = rows.iter().map(|row| row.stations.len()).sum();
    let mut table = Parquet::create(place, &columns, stations)?;
    for (number, solution) in rows.iter().enumerate() {
        if first == 1 {
            table.extend_whole(0, solution.stations.iter().map(|_| number as i64 + 1));
        }
        for (column, (_, value)) in COLUMNS.iter().enumerate() {
            table.extend(first + column, solution.stations.iter().map(value));
        }
    }
    table.finish().map(drop)
}
