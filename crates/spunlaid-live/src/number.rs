//! A number as the page shows it.

use serde::Serialize;
use spunlaid::observe::{DECLARED, Measure};
use spunlaid::statistics::Estimate;

/// A number with its standard error, in the unit in which it is shown.
#[derive(Debug, Serialize)]
pub(super) struct ShownNumber {
    pub(super) name: &'static str,
    label: &'static str,
    meaning: &'static str,
    unit: &'static str,
    pub(super) value: Option<f64>,
    pub(super) error: Option<f64>,
}

impl ShownNumber {
    /// The mean of a measure over the fibres, with the error that its scatter tells.
    ///
    /// * `values` – of each fibre, in SI units; NaN where there is none
    pub(super) fn of_fibres(name: &str, mut values: Vec<f64>) -> Option<Self> {
        values.retain(|value| value.is_finite());
        let Estimate { mean, standard_error, .. } = Estimate::new(values);
        let Measure { name, label, meaning, unit, .. } = *measure(name)?;
        let finite = |x: f64| x.is_finite().then_some(x * unit.per_si);
        Some(Self {
            name,
            label,
            meaning,
            unit: unit.shown,
            value: finite(mean),
            error: standard_error.and_then(finite),
        })
    }
}

pub(super) fn measure(name: &str) -> Option<&'static Measure> {
    DECLARED.iter().flat_map(|declared| declared.measures).find(|measure| measure.name == name)
}
