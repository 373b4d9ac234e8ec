//! Draws the figures of a velocity record.

use crate::numbers::significant;
use spunlaid_air::{Analysis, Record};
use spunlaid_charts::palette::{BLUE, GREEN, GREY, INK, ORANGE, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Series};
use spunlaid_ground::Spectrum;

/// The figures of a record in the order of the report.
pub fn record_figures(record: &Record, analysis: &Analysis) -> Vec<Figure> {
    vec![history(record, analysis), histogram(record, analysis), density(analysis), autocorrelation(analysis)]
}

/// The line of a component: green along the flow, blue and vermilion across.
fn series(name: &str, index: usize) -> Series {
    // A name may hold the signs that mark up labels.
    let plain = name.replace(['*', '^', '_', '{', '}'], " ");
    Series::new(&format!("*{}*", plain.trim()), [GREEN, BLUE, VERMILION][index % 3]).width(1.2)
}

/// Number of stretches along a panel; each has two points.
const ACROSS: usize = 1000;
/// Integral times in the close-up.
const CLOSE_UP: f64 = 40.0;
/// Classes of the histogram within four rms of the mean.
const CLASSES: usize = 64;

/// The whole record, and a close-up of its middle.
fn history(record: &Record, analysis: &Analysis) -> Figure {
    let samples = record.samples();
    let close = ((CLOSE_UP * analysis.integral_time.value / analysis.interval) as usize).clamp(16, samples);
    let first = (samples - close) / 2;
    let panel = |name: &str, range: std::ops::Range<usize>, label: &str| {
        let chart = Chart::new(
            name,
            "The record",
            Axis::linear(label).in_column("time_s").tight(),
            Axis::linear("Velocity (m/s)"),
        );
        record.components.iter().enumerate().fold(chart, |chart, (i, component)| {
            let values = &component.values[range.clone()];
            let line = extremes(values, range.start, analysis.interval);
            let series = series(&component.name, i).width(1.0);
            if range.len() == samples {
                return chart.line(series, &line);
            }
            let all = values.iter().enumerate();
            let all = all.map(|(k, value)| ((range.start + k) as f64 * analysis.interval, *value, None));
            chart.line(series.named(&format!("{} close-up", component.name)).thinned_from(all), &line)
        })
    };
    let whole = panel("record", 0..samples, "");
    let part = panel("record_part", first..first + close, "Time *t* (s)");
    let whole = whole.stretch(
        Series::new("shown below", GREY),
        first as f64 * analysis.interval,
        (first + close) as f64 * analysis.interval,
    );
    let caption = format!(
        "The upper panel shows the lowest and the highest sample along the whole record, the lower one {} s \
        from its middle ({} integral times). The upper panel of a steady flow looks the same everywhere.",
        significant(close as f64 * analysis.interval, 2),
        significant(close as f64 * analysis.interval / analysis.integral_time.value, 2),
    );
    let (whole, part) = (whole.sized(640.0, 230.0), part.sized(640.0, 250.0));
    Figure::stacked(&whole.name, &whole.title, &[&whole, &part], caption)
}

/// The lowest and the highest sample of each stretch, in order of time.
fn extremes(values: &[f64], first: usize, interval: f64) -> Vec<(f64, f64)> {
    let each = values.len().div_ceil(ACROSS).max(1);
    let mut line = Vec::new();
    for (c, chunk) in values.chunks(each).enumerate() {
        let by_value = |a: &usize, b: &usize| chunk[*a].total_cmp(&chunk[*b]);
        let low = (0..chunk.len()).min_by(by_value).unwrap_or(0);
        let high = (0..chunk.len()).max_by(by_value).unwrap_or(0);
        let mut both = vec![low, high];
        both.sort_unstable();
        both.dedup();
        line.extend(both.into_iter().map(|i| ((first + c * each + i) as f64 * interval, chunk[i])));
    }
    line
}

/// The distribution of the velocity and the Gaussian.
fn histogram(record: &Record, analysis: &Analysis) -> Figure {
    let single = analysis.components.len() == 1;
    let (x, y) = if single {
        ("Velocity (m/s)", "Probability density (s/m)")
    } else {
        ("Fluctuation over its rms", "Probability density")
    };
    let mut chart = Chart::new(
        "histogram",
        "Distribution of the velocity",
        Axis::linear(x).tight(),
        Axis::linear(y).zero_based(),
    );
    let mut gaussian = Vec::new();
    for (i, (component, samples)) in analysis.components.iter().zip(&record.components).enumerate() {
        let (mean, rms) = (component.mean.value, component.rms.value);
        let (place, unit) = if single { (mean, rms) } else { (0.0, 1.0) };
        let reach =
            4.0f64.max(((component.range.1 - mean) / rms).max((mean - component.range.0) / rms)).min(8.0);
        let width = 2.0 * 4.0 / CLASSES as f64;
        let count = (2.0 * reach / width).ceil() as usize;
        let mut classes = vec![0u64; count];
        for value in &samples.values {
            let class = ((value - mean) / rms + reach) / width;
            if class >= 0.0 && (class as usize) < count {
                classes[class as usize] += 1;
            }
        }
        let height = |n: u64| n as f64 / (samples.values.len() as f64 * width * unit);
        let edge = |k: usize| place + (k as f64 * width - reach) * unit;
        let steps = (classes.iter().enumerate())
            .flat_map(|(k, n)| [(edge(k), height(*n)), (edge(k + 1), height(*n))]);
        let middles =
            classes.iter().enumerate().map(|(k, n)| (0.5 * (edge(k) + edge(k + 1)), height(*n), None));
        let line = series(&component.name, i).width(1.4).thinned_from(middles);
        chart = chart.path(line, steps);
        if i == 0 {
            let bell = |z: f64| (-0.5 * z * z).exp() / ((2.0 * std::f64::consts::PI).sqrt() * unit);
            gaussian = (-100..=100)
                .map(|k| f64::from(k) * reach / 100.0)
                .map(|z| (place + z * unit, bell(z)))
                .collect();
        }
    }
    let chart = chart.line(Series::reference("Gaussian of the same mean and rms"), &gaussian);
    let caption = "Probability density of the velocity in steps of an eighth of the rms. The dashed line is \
        the Gaussian with the same mean and rms, which the simulated turbulence has. A peak at either end \
        means that the instrument clips."
        .to_owned();
    Figure::new(&chart, caption)
}

/// The autocorrelation and the part that is integrated.
fn autocorrelation(analysis: &Analysis) -> Figure {
    let along = &analysis.components[0].autocorrelation;
    let limit = along.limit * 1e3;
    let shown = 3.0 * limit.max(analysis.interval * 2e3);
    let mut chart = Chart::new(
        "autocorrelation",
        "Autocorrelation of the fluctuation",
        Axis::linear("Lag *τ* (ms)").tight().including(0.0),
        Axis::linear("Autocorrelation coefficient *ρ*").including(0.0),
    )
    .stretch(Series::new("integrated", GREY), 0.0, limit);
    for (i, component) in analysis.components.iter().enumerate() {
        let coefficients = component.autocorrelation.coefficients.iter().enumerate();
        let line = coefficients.map(|(k, c)| (k as f64 * analysis.interval * 1e3, *c));
        let line = line.take_while(|(lag, _)| *lag <= shown);
        chart = chart.line(series(&component.name, i).width(1.5), line);
    }
    let omega = 2.0 * std::f64::consts::PI * analysis.cutoff_frequency.value * 1e-3;
    let sinc = |lag: f64| if lag == 0.0 { 1.0 } else { (omega * lag).sin() / (omega * lag) };
    let end = (along.coefficients.len().saturating_sub(1) as f64 * analysis.interval * 1e3).min(shown);
    let flat = (0..=300).map(|k| f64::from(k) * end / 300.0).map(|lag| (lag, sinc(lag)));
    let chart = chart
        .line(Series::new("", GREY).adorning().width(0.8), [(0.0, 0.0), (end, 0.0)])
        .line(Series::reference("of the flat spectrum"), flat)
        .vertical(Series::new("limit of the integral", GREY).dashed(&[2.0, 3.0]).width(1.2), limit);
    let caption = format!(
        "Mean product of two fluctuations one lag apart, over the variance. The integral over the shaded part, {}, is \
         the integral time of {} ms. The dashed line is the autocorrelation of the simulated turbulence with the flat \
         spectrum, sin(*ω*τ)/(*ω*τ); its integral over all lags is a quarter of the period of the cut-off.",
        analysis.integral.words(),
        significant(analysis.integral_time.value * 1e3, 3),
    )
    .replace('*', "");
    Figure::new(&chart, caption)
}

/// Neighbouring frequencies within this ratio are drawn as one point.
const RATIO: f64 = 1.02;

/// The spectrum of each component; flat part and cut-off of the one along the flow.
fn density(analysis: &Analysis) -> Figure {
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
            let band = points.iter().map(|&(f, p, n)| {
                let factor = (1.96 / (n as f64 * per_frequency).sqrt()).exp();
                (f, p / factor, p * factor)
            });
            chart = chart
                .band(series("", i).unlabelled().named(&format!("{} 95 % interval", component.name)), band);
        }
        let line = points.iter().map(|&(f, p, _)| (f, p));
        let density = component.spectrum.density.iter().enumerate();
        let all = density.map(|(k, p)| (component.spectrum.frequency(k), *p, None));
        chart = chart.line(series(&component.name, i).width(1.5).thinned_from(all), line);
    }
    let (level, cutoff) = (flat.density.value, flat.cutoff.value);
    let bottom = spectrum.density.iter().copied().filter(|p| *p > 0.0).fold(level, f64::min);
    let model = [(flat.from, level), (cutoff, level), (cutoff, bottom)];
    let chart = chart.path(Series::new("flat, same plateau and variance", INK).dashed(&[6.0, 4.0]), model);
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

#[cfg(test)]
mod tests;
