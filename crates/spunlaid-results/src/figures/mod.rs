//! The figures of a run, a spinline, a study, a fit, a record and the paper, drawn with `spunlaid-charts`.

mod compare;
#[cfg(test)]
mod drag_laws;
mod effects;
mod field;
mod fit;
pub mod paper;
mod record;
#[cfg(test)]
pub mod record_sample;
mod run;
#[cfg(test)]
pub mod sample;
mod scales;
mod spinline;
#[cfg(test)]
pub mod spinline_sample;
mod study;
#[cfg(test)]
mod tests;
mod web;

use spunlaid_charts::{Chart, Series};

pub use compare::{CurvePoint, Curves, MOST as MOST_COMPARED, overlaid_figures};
pub use field::field_figure;
pub use fit::fit_figures;
pub use record::record_figures;
pub use run::{run_figures, swing_frequency};
pub use scales::Scale;
pub use spinline::{SPINLINE, spinline_figures};
pub use spunlaid::web::map::uniformity::Unevenness;
pub use study::{name_of_key, study_figures};
pub use web::{
    ComparedPatch, ComparedSpectrum, SEEN, effects_figure, overlaid_spectra, overlaid_webs, scan_figures,
    web_figures,
};

/// Markers with bars, joined by a thin line.
fn joined(chart: Chart, series: Series, spots: &[(f64, f64, Option<f64>)]) -> Chart {
    let line = series.clone().adorning().unmarked().width(1.0);
    chart.line(line, spots.iter().map(|(x, y, _)| (*x, *y))).scatter(series, spots)
}

/// Label of an axis: `Length laid (m)`.
fn with_unit(label: &str, unit: &str) -> String {
    if unit.is_empty() { label.to_owned() } else { format!("{label} ({unit})") }
}
