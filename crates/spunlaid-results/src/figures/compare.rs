//! The measured curves of several runs in one picture each.

use super::run::measured::axes;
use spunlaid::ground::MeasureKind;
use spunlaid::simulation::{DECLARED, FibreMeasure};
use spunlaid_charts::palette::{BLUE, Colour, GREEN, INK, ORANGE, PURPLE, VERMILION};
use spunlaid_charts::{Chart, Figure, Series};
use std::collections::BTreeMap;

/// Most runs in one picture.
pub const MOST: usize = 6;

/// Colours of the runs.
pub(super) const COLOURS: [Colour; MOST] = [BLUE, VERMILION, GREEN, ORANGE, PURPLE, INK];
/// Dashes of the series of one run.
const DASHES: [&[f32]; 4] = [&[], &[8.0, 4.0], &[2.0, 3.0], &[8.0, 3.0, 2.0, 3.0]];

/// A point of a curve, in the units of the axes.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvePoint {
    /// Name of the run or web.
    pub series: String,
    /// Place on the abscissa.
    pub at: f64,
    /// Value there.
    pub value: f64,
    /// One standard error.
    pub error: Option<f64>,
}

/// The curves of a run, by the names of their figures.
#[derive(Clone, Debug)]
pub struct Curves {
    /// Name of the run.
    pub name: String,
    /// The rows of each curve, by the curve’s name.
    pub rows: BTreeMap<String, Vec<CurvePoint>>,
}

/// A figure for each declared curve that all runs have.
pub fn overlaid_figures(runs: &[Curves]) -> Vec<Figure> {
    let mut declared: Vec<Vec<&FibreMeasure>> = Vec::new();
    for measure in DECLARED.iter().flat_map(|declaration| declaration.measures) {
        if measure.kind == MeasureKind::Number {
            continue;
        }
        match declared.iter_mut().find(|measures| measures[0].figure.name == measure.figure.name) {
            Some(measures) => measures.push(measure),
            None => declared.push(vec![measure]),
        }
    }
    let in_all = |measures: &&Vec<&FibreMeasure>| {
        runs.iter().all(|run| run.rows.contains_key(measures[0].figure.name))
    };
    declared.iter().filter(in_all).map(|measures| overlaid(runs, measures)).collect()
}

fn overlaid(runs: &[Curves], measures: &[&FibreMeasure]) -> Figure {
    let figure = measures[0].figure;
    let (along, up) = axes(measures[0], measures.len() == 1);
    let mut chart = Chart::new(figure.name, figure.title, along, up).when_empty("nothing to compare");
    let mut with_errors = false;
    for (run, colour) in runs.iter().zip(COLOURS) {
        let rows = run.rows.get(figure.name).map_or(&[][..], Vec::as_slice);
        let mut names: Vec<&str> = Vec::new();
        // Largest values over time belong to single fibres, and lines across at a frequency are no curves.
        let is_curve = |row: &&CurvePoint| row.value.is_finite() && !row.series.ends_with(" largest");
        for row in rows.iter().filter(is_curve) {
            if !names.contains(&row.series.as_str()) {
                names.push(&row.series);
            }
        }
        for (name, dash) in names.iter().zip(DASHES) {
            let curve = || rows.iter().filter(is_curve).filter(|row| row.series == *name);
            let label = if names.len() == 1 { run.name.clone() } else { format!("{}, {name}", run.name) };
            let band: Vec<_> = curve()
                .filter_map(|row| Some((row.at, row.value - row.error?, row.value + row.error?)))
                .collect();
            with_errors |= !band.is_empty();
            if !band.is_empty() {
                chart = chart.band(Series::new(&label, colour).unlabelled(), &band);
            }
            let series = Series { dash, ..Series::new(&label, colour) }.width(1.3);
            chart = chart.line(series, curve().map(|row| (row.at, row.value)));
        }
    }
    let bands = if with_errors { " The bands are ± one standard error of the mean." } else { "" };
    Figure::new(&chart, format!("{} Means over the replicates of each run.{bands}", figure.caption))
}
