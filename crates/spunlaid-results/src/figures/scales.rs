//! The scales of axes, for programs that draw with other means.

use super::run::measured::axes;
use super::study::FactorAxis;
use super::with_unit;
use spunlaid::experiment::Study;
use spunlaid::ground::Unit;
use spunlaid::simulation::FibreMeasure;
use spunlaid_charts::{Axis, Spacing};

/// How values in SI units stand on an axis.
#[derive(Clone, Debug)]
pub struct Scale {
    /// Quantity and unit, with letters between asterisks: `Frequency *f* (Hz)`.
    pub label: String,
    /// The value at which the unit of the axis counts zero [SI unit].
    pub zero: f64,
    /// Factor from the SI unit to the unit of the axis.
    pub per_si: f64,
    /// Whether the axis is logarithmic.
    pub logarithmic: bool,
}

impl Scale {
    fn new(axis: Axis, per_si: f64) -> Self {
        let logarithmic = axis.spacing == Spacing::Logarithmic;
        Self { label: axis.label, zero: 0.0, per_si, logarithmic }
    }

    /// The scale of a number that is measured.
    pub fn from_quantity(label: &str, unit: Unit) -> Self {
        Self::new(Axis::linear(&with_unit(label, unit.shown)), unit.per_si)
    }

    /// The scales of a curve, along and up; `None` for a number.
    pub fn from_curve(measure: &FibreMeasure) -> Option<[Self; 2]> {
        let (.., unit) = measure.kind.abscissa()?;
        let (along, up) = axes(measure, true);
        Some([Self::new(along, unit.per_si), Self::new(up, measure.unit.per_si)])
    }

    /// The scale of a factor of a study.
    pub fn from_factor(study: &Study, factor: usize) -> Self {
        let FactorAxis { axis, zero, scale, .. } = FactorAxis::from_study(study, factor);
        Self { zero, ..Self::new(axis, scale) }
    }
}
