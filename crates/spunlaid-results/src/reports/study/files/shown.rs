//! Quantities as tables for readers show them.

use crate::numbers::plus_minus;
use spunlaid_experiment::{Experiment, PointResults, Quantity, Study};
use spunlaid_fibre::Case;
use spunlaid_simulation::{DECLARED, FibreMeasure};

/// The quantities that tables show, by their indices: those of a figure together, which are the patches of all sizes.
pub fn quantities(study: &Study) -> Vec<usize> {
    let experiments = || study.points.iter().map(|point| &point.experiment);
    let has = |quantity: &Quantity| {
        experiments().any(|experiment| match experiment {
            Experiment::Case(case) => applies(quantity, case),
            Experiment::Web(_) | Experiment::Spinline(_) => true,
        })
    };
    let all = &study.quantities;
    let mut shown: Vec<usize> = (0..all.len()).filter(|i| all[*i].is_main && has(&all[*i])).collect();
    shown.sort_by_key(|i| all.iter().position(|other| other.figure.name == all[*i].figure.name));
    shown
}

/// Whether a quantity has a meaning for a fibre.
fn applies(quantity: &Quantity, case: &Case) -> bool {
    let is_it = |measure: &FibreMeasure| measure.name == quantity.name;
    DECLARED.iter().any(|declared| (declared.applies)(case) && declared.measures.iter().any(is_it))
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
    let whole = results.total_error(&study.quantities, quantity);
    let error = whole.or_else(|| results.standard_error(quantity));
    in_unit(&study.quantities[quantity], results.mean(quantity), error)
}

/// A value ± its error, in the unit of a quantity.
pub fn in_unit(quantity: &Quantity, value: f64, error: Option<f64>) -> String {
    plus_minus(value * quantity.unit.per_si, error.map(|error| error * quantity.unit.per_si))
}
