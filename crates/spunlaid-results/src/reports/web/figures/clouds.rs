//! Sizes of the clouds: their variance by wavelength, spectra and autocorrelation.

use super::{MM, PER_CENT};
use crate::figures::joined;
use crate::numbers::significant;
use spunlaid_charts::palette::{BLUE, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Series};
use spunlaid_web::Clouds;

/// Waves of clouds that the eye sees, for the cloudiness index [m].
pub const SEEN: [f64; 2] = [5e-3, 50e-3];

/// The figures about clouds, in the order of the report.
pub(super) fn figures(clouds: Option<&Clouds>, coefficients: &[Vec<f64>; 2], cell: f64) -> Vec<Figure> {
    let of_clouds = clouds.map(|clouds| [octaves(clouds, cell), spectrum(clouds)]);
    of_clouds.into_iter().flatten().chain([autocorrelation(coefficients, cell)]).collect()
}

/// The variance by octaves of wavelength.
fn octaves(clouds: &Clouds, cell: f64) -> Figure {
    let points: Vec<(f64, f64, Option<f64>)> = clouds
        .octaves()
        .iter()
        .map(|([from, to], variance)| {
            let scale = PER_CENT * PER_CENT;
            (
                (from * to).sqrt() * MM,
                variance.mean * scale,
                variance.standard_error.map(|error| error * scale),
            )
        })
        .collect();
    let chart = Chart::new(
        "web_clouds",
        "Clouds that contribute to the CV",
        Axis::logarithmic("Wavelength (mm), an octave each").in_column("wavelength_mm"),
        Axis::linear("Part of CV^{2} (%^{2})").zero_based().in_column("part_of_cv_squared_percent2"),
    );
    let chart = joined(chart, Series::spots("octaves", BLUE).unlabelled(), &points);
    let (index, error) = clouds.cloudiness(SEEN[0], SEEN[1]);
    let caption = format!(
        "The variance of the basis weight over its mean, split by the wavelength of the clouds: each point \
        holds wavelengths from 0.7 to 1.4 times its own, with one standard error. Waves below two cells ({} \
        mm) and above {} mm are not resolved. Cloudiness index, the standard deviation of the relative basis \
        weight in wavelengths from {} to {} mm (doi 10.1186/s13362-022-00124-z): {} %.",
        significant(2.0 * cell * MM, 2),
        significant(clouds.longest() * MM, 3),
        significant(SEEN[0] * MM, 2),
        significant(SEEN[1] * MM, 2),
        crate::numbers::plus_minus(index * PER_CENT, error.map(|error| error * PER_CENT))
    );
    Figure::new(&chart, caption)
}

/// An empty chart of a power spectrum.
pub(crate) fn empty_spectrum() -> Chart {
    Chart::new(
        "web_spectrum",
        "Power spectrum along and across the web",
        Axis::logarithmic("Wavelength (mm)").in_column("wavelength_mm"),
        Axis::logarithmic("Density of the relative variance (mm)").in_column("density_mm").decades(6),
    )
}

/// Wavelength and density in cross (0) or machine direction (1), from short waves to long [mm].
pub(crate) fn density(clouds: &Clouds, direction: usize) -> impl Iterator<Item = (f64, f64)> {
    clouds.spectrum(direction).into_iter().rev().map(|(wave, density)| (wave * MM, density * MM))
}

/// The power spectrum in both directions.
fn spectrum(clouds: &Clouds) -> Figure {
    let chart = empty_spectrum()
        .line(Series::new("machine direction", BLUE).width(1.5), density(clouds, 1))
        .line(Series::new("cross direction", VERMILION).width(1.5), density(clouds, 0));
    Figure::new(
        &chart,
        "One-sided power spectral density of the basis weight over its mean, by wave number along each \
        direction and averaged over the other. Its integral over wave number (one over the wavelength) is \
        CV² of the cells. Mean over square tiles of the sheet with a Hann window.",
    )
}

/// The autocorrelation in both directions.
fn autocorrelation(coefficients: &[Vec<f64>; 2], cell: f64) -> Figure {
    let points = |direction: usize| {
        coefficients[direction].iter().enumerate().map(|(lag, c)| (lag as f64 * cell * MM, *c))
    };
    let chart = Chart::new(
        "web_autocorrelation",
        "Autocorrelation along and across the web",
        Axis::linear("Distance (mm)").tight(),
        Axis::linear("Autocorrelation coefficient").including(0.0).in_column("coefficient"),
    )
    .line(Series::new("machine direction", BLUE).width(1.5), points(1))
    .line(Series::new("cross direction", VERMILION).width(1.5), points(0));
    Figure::new(
        &chart,
        "Correlation of the basis weights of two cells over the distance between them. Correlation that remains at \
        large distances along the machine direction comes from streaks.",
    )
}
