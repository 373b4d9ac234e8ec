//! Makes the rows of the result tables for the report and the terminal.

use super::half_width;
use crate::numbers::{decimals, rounded, to_decimals};
use spunlaid::observe::{Measure, Measured, OF_COMPONENTS, OF_RECORDS, Unit, Value, measured};
use spunlaid::record::{Analysis, Component, Interval};

/// A result with its interval and how it was computed.
pub struct ResultRow {
    /// Name of the quantity.
    pub name: &'static str,
    /// Its value, as shown.
    pub value: String,
    /// Lower end of the 95 % interval, as shown.
    pub low: String,
    /// Upper end of the 95 % interval, as shown.
    pub high: String,
    /// Unit.
    pub unit: &'static str,
    /// What it means.
    pub meaning: String,
}

/// The measures that have a label, as rows of a table.
fn rows<T>(measures: &'static [Measure<T>], found: &T) -> Vec<ResultRow> {
    let row = |row: Measured<T>| {
        let interval = match row.value {
            Some(Value::Interval(interval)) => interval,
            _ => Interval::exactly(row.measure.number(found)),
        };
        let Unit { shown, per_si } = row.measure.unit;
        let half = half_width(&interval) * per_si;
        // A value that was given has no interval.
        let end = |end: f64| {
            decimals(half).map_or_else(|| "–".to_owned(), |decimals| to_decimals(end * per_si, decimals))
        };
        ResultRow {
            name: row.measure.label,
            value: rounded(interval.value * per_si, Some(half)).0,
            low: end(interval.low),
            high: end(interval.high),
            unit: shown,
            meaning: row.meaning().to_owned(),
        }
    };
    measured(measures, found).filter(|row| !row.measure.label.is_empty()).map(row).collect()
}

/// The results for the [air] of a case, then those of each component.
pub fn results(analysis: &Analysis) -> (Vec<ResultRow>, Vec<(String, Vec<ResultRow>)>) {
    let component = |component: &Component| (component.name.clone(), rows(OF_COMPONENTS, component));
    (rows(OF_RECORDS, analysis), analysis.components.iter().map(component).collect())
}
