//! Several webs in one chart: how uneven they are, and their spectra.

use super::super::compare::COLOURS;
use super::clouds::{density, empty_spectrum};
use super::unevenness::empty_chart;
use super::{MM, PER_CENT};
use crate::numbers::significant;
use spunlaid::web::Clouds;
use spunlaid_charts::palette::GREY;
use spunlaid_charts::{Figure, Series};

/// The unevenness of a web over patches of one size.
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
        let spots = Series::spots(name, colour).thinned_from(points(true, true).collect());
        chart = chart
            .line(Series::new("", colour).adorning().width(1.0), line)
            .scatter(spots, points(true, false))
            .scatter(Series { colour, ..Series::circles(name) }.unlabelled(), points(false, false));
    }
    Figure::new(
        &chart,
        "Standard deviation of the basis weight of square patches over its mean, for each web. Bars and \
        bands are 95 % intervals: they hold the CV of all such webs, with the error of the model where \
        fibres were flown. An open circle has no interval, so nothing is said about its difference; the \
        table says why.",
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
            " Waves shorter than {} mm, in the grey part, are below the blur of {}: one more pixel of blur \
            would take more than one per cent of their amplitude, so the web itself is stronger there than \
            its picture. The noise of a camera is in its spectrum, too.",
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
