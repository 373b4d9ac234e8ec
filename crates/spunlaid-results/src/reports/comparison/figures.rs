//! The measured curves of several runs in one picture each; the CV and the spectra of several webs.

use crate::figures::COLOURS;
use crate::numbers::significant;
use crate::reports::run::figures::measured::axes;
use crate::reports::web::figures::clouds::{density, empty_spectrum};
use crate::reports::web::figures::patch_cv::empty_chart;
use crate::reports::web::figures::{MM, PER_CENT};
use spunlaid_charts::palette::GREY;
use spunlaid_charts::{Chart, Figure, Series};
use spunlaid_ground::MeasureKind;
use spunlaid_simulation::{DECLARED, FibreMeasure};
use spunlaid_web::Clouds;
use std::collections::BTreeMap;

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

/// The CV of a web over patches of one size.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedPatch {
    /// Side of a patch [m].
    pub side: f64,
    /// Coefficient of variation.
    pub cv: f64,
    /// Its standard error, if it is known.
    pub standard_error: Option<f64>,
    /// Its 95 % interval; none where there is no verdict.
    pub interval: Option<[f64; 2]>,
}

/// The spectrum of a web, and up to which wave blur has lowered it.
#[derive(Clone, Debug)]
pub struct ComparedSpectrum {
    /// The name of the web.
    pub name: String,
    /// Of its map.
    pub clouds: Clouds,
    /// The shortest wave that the scan shows sharply [m]; none of a laid web.
    pub sharp_from: Option<f64>,
}

/// The coefficient of variation of several webs, by their names, over the size of the patches.
pub fn overlaid_webs(webs: &[(String, Vec<ComparedPatch>)]) -> Figure {
    let mut chart = empty_chart();
    for ((name, patches), colour) in webs.iter().zip(COLOURS) {
        let end = |patch: &ComparedPatch| {
            patch.interval.map(|[low, high]| (patch.side * MM, low * PER_CENT, high * PER_CENT))
        };
        // A band does not reach over patches without an interval.
        for run in patches.chunk_by(|a, b| a.interval.is_some() == b.interval.is_some()) {
            let band: Vec<_> = run.iter().filter_map(end).collect();
            if !band.is_empty() {
                chart = chart.band(Series::new(name, colour).unlabelled(), &band);
            }
            for (side, low, high) in band {
                let bar = Series::new("", colour).adorning().width(1.2);
                chart = chart.path(bar, [(side, low), (side, high)]);
            }
        }
        let line = patches.iter().map(|patch| (patch.side * MM, patch.cv * PER_CENT));
        let points = |known: bool, with_errors: bool| {
            let shown = patches.iter().filter(move |patch| patch.interval.is_some() == known);
            shown.map(move |patch| {
                let error = patch.standard_error.filter(|_| with_errors);
                (patch.side * MM, patch.cv * PER_CENT, error.map(|error| error * PER_CENT))
            })
        };
        let spots = Series::spots(name, colour).thinned_from(points(true, true));
        chart = chart
            .line(Series::new("", colour).adorning().width(1.0), line)
            .scatter(spots, points(true, false))
            .scatter(Series { colour, ..Series::circles(name) }.unlabelled(), points(false, false));
    }
    Figure::new(
        &chart,
        "Standard deviation of the basis weight of square patches over its mean, for each web. Bars and bands are \
        95 % intervals: they hold the CV of all such webs, with the error of the model where fibres were simulated. \
        An open circle has no interval, so its difference is not judged; the table gives the reason.",
    )
}

/// The power spectra of several webs, all in cells of one size; none without any.
///
/// * `cell` – side of a cell [m]
pub fn overlaid_spectra(webs: &[ComparedSpectrum], cell: f64) -> Option<Figure> {
    let mut chart = empty_spectrum();
    let blurred = webs.iter().filter_map(|web| Some((web, web.sharp_from?)));
    let shortest = 2.0 * cell;
    let blurred = blurred.filter(|(_, wave)| *wave > shortest).max_by(|a, b| a.1.total_cmp(&b.1));
    if let Some((_, wave)) = blurred {
        let series = Series::new("below the blur of the scan", GREY);
        chart = chart.stretch(series, shortest * MM, wave * MM);
    }
    for (web, colour) in webs.iter().zip(COLOURS) {
        let directions = [(1, "machine direction", &[][..]), (0, "cross direction", &[6.0, 4.0])];
        for (direction, words, dash) in directions {
            let series = Series::new(&format!("{}, {words}", web.name), colour);
            chart = chart.line(Series { dash, ..series }.width(1.5), density(&web.clouds, direction));
        }
    }
    let about_blur = blurred.map_or_else(String::new, |(web, wave)| {
        format!(
            " Waves shorter than {} mm, in the grey part, are below the blur of {}. One more pixel of blur \
            would take more than one per cent of their amplitude, so the web itself has stronger waves there than \
            its scan. The noise of a camera is in its spectrum, too.",
            significant(wave * MM, 2),
            web.name
        )
    });
    let caption = format!(
        "One-sided power spectral density of the basis weight over its mean, by wave number along each \
        direction and averaged over the other. All maps were brought to cells of {} mm first, the largest of \
        them, because finer cells hold more variance.{about_blur}",
        significant(cell * MM, 3)
    );
    (!webs.is_empty()).then(|| Figure::new(&chart, caption))
}
