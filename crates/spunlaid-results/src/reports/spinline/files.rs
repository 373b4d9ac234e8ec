//! What leaves a solved spinline: `summary.json`, `spinline.parquet`, and sentences.

use crate::Failure;
use crate::files::folder::Staging;
use crate::files::measured::values;
use crate::files::table::{Column, Value, number, whole};
use crate::files::versioned_json;
use crate::numbers::{number_to, significant, to_decimals};
use serde_json::{Value as Json, json};
use spunlaid_charts::label::plain;
use spunlaid_fibre::{
    Case, FrictionLaw, SPINLINE_MEASURES, SolidificationCause, Solution, Station, ZERO_CELSIUS,
};
use spunlaid_ground::{Dimension, Error};
use spunlaid_input::{Influence, OfFilament, SpinFile};

/// A solved spinline, and what decides its diameter.
#[derive(Clone, Debug)]
pub struct SpinResults {
    /// The solution of each row of the curtain, the quenched side first; one if there is no curtain.
    pub rows: Vec<Solution>,
    /// The influences on the diameter, the largest first.
    pub influences: Vec<Influence>,
}

impl SpinResults {
    /// Solves a spinline.
    ///
    /// # Errors
    /// If it has no steady state that a line could run in.
    pub fn new(file: &SpinFile) -> Result<Self, Error> {
        let rows = file.solve()?;
        let influences = rows.first().map_or_else(Vec::new, |first| file.influences(first));
        Ok(Self { rows, influences })
    }

    /// The spinline from which a case is fed, solved again, which takes milliseconds; `None` if the case has none.
    pub fn from_case(case: &Case) -> Option<Self> {
        // The case could be read, so its spinline can be solved.
        Self::new(&SpinFile::from_case(case)?).ok()
    }
}

/// The text of `summary.json`.
pub fn summary(results: &SpinResults, notes: &[String]) -> String {
    versioned_json(1, json!({"spinline": part(results), "notes": notes}))
}

/// That of the spinline from which a case is fed; `None` if it has none.
pub fn part_of_case(case: &Case) -> Option<Json> {
    SpinResults::from_case(case).as_ref().map(part)
}

/// The measures of a spinline. Those of a curtain are of its first row.
fn part(SpinResults { rows, influences }: &SpinResults) -> Json {
    let mut object = rows.first().map_or_else(|| json!({}), measures);
    if rows.len() > 1 {
        object["rows"] = rows.iter().map(measures).collect();
    }
    object["influences"] = influences.iter().map(summarise_influence).collect();
    object["model_error"] = model_error(rows.first().is_some_and(|row| row.has_low_birefringence)).into();
    object
}

fn measures(row: &Solution) -> Json {
    let mut object = values(SPINLINE_MEASURES, row);
    object["solidification"]["by"] = row.solidification.by.name().into();
    object["second_steady_state"] = row.has_second.into();
    object
}

/// What is changed, how, and what it does.
fn summarise_influence(influence: &Influence) -> Json {
    let setting = influence.change.setting;
    let value = |of: OfFilament| influence.on(of).map(|effect| effect.difference.value);
    json!({
        "key": setting.name,
        "label": plain(setting.words),
        "change": if influence.change.keys[0].by_kelvin { "10 K" } else { "relative" },
        "diameter": value(OfFilament::Diameter),
        "speed": value(OfFilament::Speed),
    })
}

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
/// [`COLUMNS`] distinguish them: `layer` where the layers of a web have different spinlines, and `row` of a curtain.
///
/// * `spinlines` – the number of the layer, from 1, and the solution of each row
pub fn write_stations(staging: &Staging<'_>, spinlines: &[(usize, &[Solution])]) -> Result<(), Failure> {
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

/// What is known of the error of the model.
///
/// * `has_low_birefringence` – as of the solution
pub fn model_error(has_low_birefringence: bool) -> String {
    let of_modulus = if has_low_birefringence {
        "The birefringence of polypropylene is 3 to 5 times too low, because crystals orient more than the \
        stress of the melt does. The modulus that follows from it is too low as well. Neither is an estimate \
        of a real filament."
    } else {
        "The modulus can be wrong by a factor of two."
    };
    format!(
        "How far the model is from a real line is not known: no diameter that it gives has been compared \
        with a measured one. {of_modulus}"
    )
}

/// How well the equations are solved, in a sentence.
pub fn numerical_error(rows: &[Solution]) -> String {
    let largest = |residual: fn(&Solution) -> f64| {
        number_to(rows.iter().map(|row| residual(row).abs()).fold(0.0, f64::max), 1)
    };
    format!(
        "The equations are solved such that over the whole line the balance of momentum holds to {} of the \
        largest tension and that of energy to {} of the heat that the air takes.",
        largest(|row| row.momentum_residual),
        largest(|row| row.energy_residual)
    )
}

/// What a fed case says of its filament, in sentences: size, speed and throughput, and where it comes from if
/// it has a spinline.
pub fn filament(case: &Case) -> Vec<String> {
    let (Some(line), Some(throughput)) = (case.line, case.throughput()) else { return Vec::new() };
    let fed = format!(
        "filaments of {}, {} dtex, fed at {}: {} g/min from each hole",
        Dimension::Length.pretty_to(case.fibre.diameter, 4),
        significant(case.linear_density() * 1e7, 3),
        Dimension::Velocity.pretty_to(line.feed_speed, 4),
        significant(throughput * 6e4, 3),
    );
    let solution = case.spinline.as_ref().and_then(|spinline| spinline.solve(case.drag.along).ok());
    let frozen = solution.map(|solution| format!("from the spinline: {}", solidification(&solution)));
    [fed].into_iter().chain(frozen).collect()
}

/// Where and by what the thread solidifies, in a sentence.
pub fn solidification(solution: &Solution) -> String {
    let point = solution.solidification;
    format!(
        "The filament is drawn {}-fold and solidifies {} below the die, at {}, {}, under a stress of {} MPa and \
        while it cools at {} K/s.",
        significant(solution.draw_ratio(), 3),
        Dimension::Length.pretty_to(point.distance, 3),
        Dimension::Temperature.pretty_to(point.temperature, 4),
        match point.by {
            SolidificationCause::Temperature => "by its temperature",
            SolidificationCause::Crystallisation => "by crystallisation",
        },
        significant(point.stress * 1e-6, 3),
        two_digits(point.cooling_rate)
    )
}

/// `9400` of 9379.2.
fn two_digits(value: f64) -> String {
    let magnitude = if value > 0.0 { value.log10().floor() as i32 } else { 0 };
    to_decimals(value, 1 - magnitude)
}

/// What a number does to the diameter, in a sentence: `Throughput: 1 % more makes the filament 0.43 % thicker.`
pub fn influence(influence: &Influence) -> String {
    let diameter = influence.on(OfFilament::Diameter).map_or(f64::NAN, |effect| effect.difference.value);
    let (change, percent) = match influence.change.keys[0].by_kelvin {
        false => ("1 % more makes", diameter),
        true => ("10 K more make", 100.0 * diameter),
    };
    let way = if percent < 0.0 { "finer" } else { "thicker" };
    let label = plain(influence.change.setting.words);
    format!("{label}: {change} the filament {} % {way}.", significant(percent.abs(), 2))
}

/// What a reader must know of the solution.
pub fn remarks(law: FrictionLaw, rows: &[Solution]) -> Vec<String> {
    let several: Vec<String> = (rows.iter().enumerate())
        .filter(|(_, row)| row.has_second)
        .map(|(i, _)| (i + 1).to_string())
        .collect();
    let whose = match rows.len() {
        0 | 1 => String::new(),
        _ => format!(" in row {}", several.join(", ")),
    };
    let remark =
        format!("there are two steady states{whose}; the one with the smaller tension at the die is given");
    let beyond = rows.iter().find_map(|row| row.beyond_table(law));
    let beyond = beyond.map(|beyond| format!("drag.along = \"{}\" {beyond}", law.name()));
    (!several.is_empty()).then_some(remark).into_iter().chain(beyond).collect()
}
