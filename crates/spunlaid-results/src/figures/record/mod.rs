//! Draws the figures of a velocity record.

mod spectrum;
#[cfg(test)]
mod tests;
mod time;

use spunlaid::record::{Analysis, Record};
use spunlaid_charts::{
    Figure, Series,
    palette::{BLUE, GREEN, VERMILION},
};

/// The figures of a record in the order of the report.
pub fn record_figures(record: &Record, analysis: &Analysis) -> Vec<Figure> {
    vec![
        time::history(record, analysis),
        time::histogram(record, analysis),
        spectrum::density(analysis),
        time::autocorrelation(analysis),
    ]
}

/// The line of a component: green along the flow, blue and vermilion across.
fn series(name: &str, index: usize) -> Series {
    // A name may hold the signs that mark up labels.
    let plain = name.replace(['*', '^', '_', '{', '}'], " ");
    Series::new(&format!("*{}*", plain.trim()), [GREEN, BLUE, VERMILION][index % 3]).width(1.2)
}
