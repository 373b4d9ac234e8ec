//! By how much a number is changed to see what it does.

use crate::case::keys::{Kind, Sign};
use crate::effects::ChangedKey;
use crate::units::Dimension;

/// A change of a number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// Its value is multiplied by this.
    pub(super) factor: f64,
    /// What is added in place of that to a temperature, and to a difference of temperatures that may be zero,
    /// which have no share of their value [K].
    pub(super) kelvin: f64,
}

impl Step {
    /// The number after the change. A whole number stays one, and above zero.
    pub(super) fn apply(self, kind: &Kind, number: f64) -> f64 {
        match kind {
            _ if is_by_kelvin(kind) => number + self.kelvin,
            Kind::Whole(..) => (number * self.factor).round().max(1.0),
            _ => number * self.factor,
        }
    }
}

/// Whether a number is changed by kelvins.
pub(super) const fn is_by_kelvin(kind: &Kind) -> bool {
    matches!(
        kind,
        Kind::Quantity(Dimension::Temperature, _)
            | Kind::Quantity(Dimension::TemperatureDifference, Sign::Any)
    )
}

/// A key that has been changed.
pub(super) fn changed_key(key: String, kind: &Kind, [from, to]: [f64; 2]) -> ChangedKey {
    let dimension = kind.dimension().unwrap_or(Dimension::Ratio);
    let (whole, by_kelvin) = (matches!(kind, Kind::Whole(..)), is_by_kelvin(kind));
    ChangedKey { key, dimension, whole, by_kelvin, from, to }
}
