//! Quantities as tables for readers show them.

use crate::numbers::plus_minus;
use spunlaid::study::{PointResults, Quantity, Study};

/// The quantities that tables show, the most important first, by their indices.
pub fn quantities(study: &Study) -> Vec<usize> {
    let names: &[&str] = match study.points.first().map(|point| &point.experiment) {
        Some(spunlaid::study::Experiment::Web(_)) => return quantities_of_webs(study),
        Some(spunlaid::study::Experiment::Case(case)) if case.line.is_some() => &[
            "sigma_md",
            "sigma_cd",
            "half_correlation_length_md",
            "half_correlation_length_cd",
            "noise",
            "orientation_md",
        ],
        Some(spunlaid::study::Experiment::Spinline(_)) => &[
            "final_diameter",
            "final_speed",
            "freezing_distance",
            "freezing_stress",
            "linear_density",
            "modulus_estimate",
        ],
        _ => &["amplitude_y", "amplitude_z", "frequency_y", "frequency_z", "mean_x", "strain_99"],
    };
    names.iter().filter_map(|name| study.quantity(name)).collect()
}

/// The unevenness of the maps, the one expected from the flown curves if anything is flown, and what else is in a web.
fn quantities_of_webs(study: &Study) -> Vec<usize> {
    let flies = |point: &spunlaid::study::Point| {
        let web = point.experiment.web();
        web.is_some_and(|web| web.layers.iter().any(|layer| layer.source.case().is_some()))
    };
    let figures: &[&str] = if study.points.iter().any(flies) { &["cv", "cv_flown"] } else { &["cv"] };
    let of_figure = |figure: &&str| {
        let all = study.quantities.iter().enumerate();
        all.filter(move |(_, quantity)| quantity.figure.name == *figure)
            .map(|(index, _)| index)
            .collect::<Vec<_>>()
    };
    let others = ["basis_weight", "md_cd_ratio"].into_iter().filter_map(|name| study.quantity(name));
    figures.iter().flat_map(of_figure).chain(others).collect()
}

/// The head of a column: `Amplitude in y (mm)`.
pub fn head(quantity: &Quantity) -> String {
    if quantity.unit.shown.is_empty() {
        quantity.label.clone()
    } else {
        format!("{} ({})", quantity.label, quantity.unit.shown)
    }
}

/// Mean ± error at a point: by all causes, or else the standard error.
pub fn cell(study: &Study, results: &PointResults, quantity: usize) -> String {
    let whole = results.whole_error(&study.quantities, quantity);
    let error = whole.or_else(|| results.standard_error(quantity));
    in_unit(&study.quantities[quantity], results.mean[quantity], error)
}

/// A value ± its error, in the unit of a quantity.
pub fn in_unit(quantity: &Quantity, value: f64, error: Option<f64>) -> String {
    plus_minus(value * quantity.unit.per_si, error.map(|error| error * quantity.unit.per_si))
}
