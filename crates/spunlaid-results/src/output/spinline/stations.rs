//! `spinline.parquet`: the thread from the die to the end.

use crate::Failure;
use crate::output::folder::Staging;
use crate::output::table::{Column, Value, number, whole};
use spunlaid::spinline::{Solution, Station, ZERO_CELSIUS};

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
    let layer = (spinlines.len() > 1).then_some("layer");
    let row = spinlines.iter().any(|(_, rows)| rows.len() > 1).then_some("row");
    let numbers = COLUMNS.iter().map(|(name, _)| number(*name));
    let columns: Vec<Column> = layer.into_iter().chain(row).map(whole).chain(numbers).collect();
    let mut table = staging.table("spinline", &["parquet"], &columns)?;
    for (of_layer, rows) in spinlines {
        for (of_row, solution) in rows.iter().enumerate() {
            let apart = layer.map(|_| *of_layer).into_iter().chain(row.map(|_| of_row + 1));
            let apart: Vec<Value> = apart.map(|number| Value::Whole(number as i64)).collect();
            for station in &solution.stations {
                let numbers = COLUMNS.iter().map(|(_, value)| Value::Number(value(station)));
                table.add(&apart.iter().copied().chain(numbers).collect::<Vec<_>>())?;
            }
        }
    }
    table.finish()
}
