//! Makes the rows of the result tables for the terminal and the report.

use super::half_width;
use crate::numbers::{decimals, rounded, to_decimals};
use spunlaid::record::{Analysis, Interval, Record};
use spunlaid::units::Dimension;
use std::fmt::Write;

/// A result with its interval and how it was computed.
pub struct ResultRow {
    /// Name of the quantity.
    pub name: String,
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

fn row(name: &str, interval: &Interval, factor: f64, unit: &'static str, meaning: String) -> ResultRow {
    let half = half_width(interval) * factor;
    // A value that was given has no interval.
    let end = |end: f64| {
        decimals(half).map_or_else(|| "–".to_owned(), |decimals| to_decimals(end * factor, decimals))
    };
    ResultRow {
        name: name.to_owned(),
        value: rounded(interval.value * factor, Some(half)).0,
        low: end(interval.low),
        high: end(interval.high),
        unit,
        meaning,
    }
}

/// The results for the [air] of a case, then those of each component.
pub fn results(analysis: &Analysis) -> (Vec<ResultRow>, Vec<(String, Vec<ResultRow>)>) {
    let along = analysis.components.first().map_or("u", |c| c.name.as_str());
    let isotropic = if analysis.components.len() > 1 {
        "square root of the mean of the components’ variances, over the mean velocity"
    } else {
        "rms of the fluctuation over the mean velocity"
    };
    let air = vec![
        row("Mean velocity", &analysis.mean_velocity, 1.0, "m/s", format!("mean of {along}")),
        row("Turbulence intensity", &analysis.turbulence_intensity, 100.0, "%", isotropic.to_owned()),
        row(
            "Integral time",
            &analysis.integral_time,
            1e3,
            "ms",
            format!("autocorrelation of {along}, integrated {}", analysis.integral.words()),
        ),
        row(
            "Length scale",
            &analysis.length_scale,
            1e3,
            "mm",
            "integral time × mean velocity: Taylor’s hypothesis".to_owned(),
        ),
        row(
            "Cut-off frequency",
            &analysis.cutoff_frequency,
            1.0,
            "Hz",
            format!(
                "variance of {along} over the plateau of its spectrum: here a flat spectrum with this variance and this \
                 plateau would end"
            ),
        ),
    ];
    (air, analysis.components.iter().map(|c| (c.name.clone(), component(analysis, c))).collect())
}

fn component(analysis: &Analysis, c: &spunlaid::record::Component) -> Vec<ResultRow> {
    let time = |s: f64| Dimension::Time.pretty_to(s, 3);
    let hertz = |f: f64| Dimension::Frequency.pretty_to(f, 3);
    vec![
        row("Mean", &c.mean, 1.0, "m/s", String::new()),
        row("Rms", &c.rms, 1.0, "m/s", "root mean square of the fluctuation about the mean".to_owned()),
        row("Skewness", &c.skewness, 1.0, "", "0 for a Gaussian".to_owned()),
        row("Flatness", &c.flatness, 1.0, "", "3 for a Gaussian".to_owned()),
        row(
            "Integral time",
            &c.integral_time,
            1e3,
            "ms",
            format!(
                "{}, here {}; by the plateau of the spectrum {}",
                analysis.integral.words(),
                time(c.autocorrelation.limit),
                time(c.flat.integral_time())
            ),
        ),
        row(
            "Plateau of the spectrum",
            &c.flat.density,
            1e3,
            "10⁻³ (m/s)²/Hz",
            format!("mean density up to {}", hertz(c.flat.until)),
        ),
        row("Cut-off frequency", &c.flat.cutoff, 1.0, "Hz", "variance over plateau".to_owned()),
        row(
            "Drift of the mean",
            &c.mean_trend.change,
            1.0,
            "m/s",
            "from start to end, by a straight line".to_owned(),
        ),
        row(
            "Drift of the rms",
            &c.rms_trend.change,
            1.0,
            "m/s",
            "from start to end, by a straight line".to_owned(),
        ),
    ]
}

/// The table for the terminal.
pub fn result_table(record: &Record, analysis: &Analysis) -> String {
    let mut text = format!(
        "{}: {} samples of {} at {} over {}, 95 % confidence intervals\n",
        record.file,
        analysis.samples,
        analysis.components.iter().map(|c| c.name.as_str()).collect::<Vec<_>>().join(", "),
        Dimension::Frequency.pretty(1.0 / analysis.interval),
        Dimension::Time.pretty(analysis.duration),
    );
    let (air, components) = results(analysis);
    let write = |text: &mut String, rows: &[ResultRow]| {
        for r in rows {
            let range = if r.low == r.high { r.low.clone() } else { format!("{} to {}", r.low, r.high) };
            let line = format!("  {:<24}{:>10}   {range:<22}{:<5} {}", r.name, r.value, r.unit, r.meaning);
            let _ = writeln!(text, "{}", line.trim_end());
        }
    };
    write(&mut text, &air);
    for (name, rows) in &components {
        let _ = writeln!(text, "{name}");
        write(&mut text, rows);
    }
    text
}
