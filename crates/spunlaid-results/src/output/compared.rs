//! With what a check compares a run, in words.

use crate::numbers::plus_minus;
use spunlaid::case::Case;
use spunlaid::ensemble::{FinerCheck, Refinement};
use spunlaid::statistics::Estimate;
use spunlaid::units::Dimension;

/// With what a run is compared: `half of it`.
pub(super) fn compared_with(check: &FinerCheck, case: &Case) -> String {
    match check.refined {
        Refinement::TimeStep => shorter(check, case),
        Refinement::Elements => {
            let length = Dimension::Length.pretty_to(check.element_length, 3);
            format!("elements of {length}, half the length,")
        }
    }
}

pub(super) fn percent(estimate: &Estimate) -> String {
    format!("{} %", plus_minus(100.0 * estimate.mean, estimate.standard_error.map(|error| 100.0 * error)))
}

/// With what a step is compared.
fn shorter(check: &FinerCheck, case: &Case) -> String {
    let step = Dimension::Time.pretty_to(check.time_step, 3);
    match check.is_resolved {
        true if check.scheme == case.run.scheme => format!("steps of {step}, which resolve axial waves,"),
        true => format!("{} at {step}, which resolves axial waves,", check.scheme.name()),
        false => "half of it".to_owned(),
    }
}
