//! Draws the spectrum of a record with its flat part and the cut-off.

use super::series;
use crate::numbers::significant;
use spunlaid::record::Analysis;
use spunlaid::statistics::Spectrum;
use spunlaid_charts::{
    Axis, Chart, Figure, Series,
    palette::{INK, ORANGE},
};

/// Neighbouring frequencies within this ratio are drawn as one point.
const RATIO: f64 = 1.02;

/// The spectrum of each component; flat part and cut-off of the one along the flow.
pub(super) fn density(analysis: &Analysis) -> Figure {
    let along = &analysis.components[0];
    let (spectrum, flat) = (&along.spectrum, &along.flat);
    let mut chart = Chart::new(
        "spectrum",
        "Spectrum of the fluctuation",
        Axis::logarithmic("Frequency *f* (Hz)").tight(),
        Axis::logarithmic("Power spectral density [(m/s)²/Hz]").decades(9),
    )
    .when_empty("no fluctuation")
    .stretch(Series::new("taken as flat", ORANGE), flat.from, flat.until);
    for (i, component) in analysis.components.iter().enumerate() {
        let points = thinned(&component.spectrum);
        if i == 0 {
            let per_frequency = spectrum.effective_duration * spectrum.step;
            let band: Vec<_> = points
                .iter()
                .map(|&(f, p, n)| {
                    let factor = (1.96 / (n as f64 * per_frequency).sqrt()).exp();
                    (f, p / factor, p * factor)
                })
                .collect();
            chart = chart
                .band(series("", i).unlabelled().named(&format!("{} 95 % interval", component.name)), &band);
        }
        let line: Vec<_> = points.iter().map(|&(f, p, _)| (f, p)).collect();
        let density = component.spectrum.density.iter().enumerate();
        let all = density.map(|(k, p)| (component.spectrum.frequency(k), *p, None)).collect();
        chart = chart.line(series(&component.name, i).width(1.5).thinned_from(all), &line);
    }
    let (level, cutoff) = (flat.density.value, flat.cutoff.value);
    let bottom = spectrum.density.iter().copied().filter(|p| *p > 0.0).fold(level, f64::min);
    let model = [(flat.from, level), (cutoff, level), (cutoff, bottom)];
    let chart = chart.path(Series::new("flat, same plateau and variance", INK).dashed(&[6.0, 4.0]), &model);
    let caption = format!(
        "Power spectral density by Welch’s method with {} segments of {} samples, {} window, {} % overlap; \
        the shaded band is its 95 % interval. The plateau is the mean over the orange range. The dashed line \
        is the flat spectrum with the same variance and the same plateau, which the simulation uses; it ends \
        at the cut-off of {} Hz, where the measured spectrum has already fallen.",
        spectrum.segments,
        spectrum.segment,
        spectrum.window.name(),
        significant(100.0 * spectrum.overlap, 2),
        significant(cutoff, 3),
    );
    Figure::new(&chart, caption)
}

/// Mean frequency, mean density and number of frequencies of each point.
fn thinned(spectrum: &Spectrum) -> Vec<(f64, f64, usize)> {
    let mut points = Vec::new();
    let mut from = 0;
    while from < spectrum.density.len() {
        let end = ((from + 1) as f64 * RATIO) as usize;
        let end = end.clamp(from + 1, spectrum.density.len());
        let count = end - from;
        let mean = spectrum.density[from..end].iter().sum::<f64>() / count as f64;
        points.push((0.5 * (spectrum.frequency(from) + spectrum.frequency(end - 1)), mean, count));
        from = end;
    }
    points
}
