//! Units in which measures are shown.

use crate::units::{si_unit_of, udunits};

/// A unit to show values in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// As it is written; empty for a plain number.
    pub shown: &'static str,
    /// Factor from the SI unit to this unit.
    pub per_si: f64,
}

/// Counts over an area: large ones are easier to read over a smaller area.
pub const PER_SQUARE_METRE: Unit = Unit { shown: "1/m²", per_si: 1.0 };
const SMALLER_AREAS: [Unit; 2] =
    [Unit { shown: "1/mm²", per_si: 1e-6 }, Unit { shown: "1/cm²", per_si: 1e-4 }];

impl Unit {
    /// This unit, or the one in which numbers of this size are easier to read.
    ///
    /// * `value` – of the size of the numbers, in the SI unit
    pub fn readable(self, value: f64) -> Self {
        let smaller = SMALLER_AREAS.into_iter().filter(|_| self == PER_SQUARE_METRE);
        smaller.into_iter().find(|unit| value * unit.per_si >= 1.0).unwrap_or(self)
    }

    /// The unit of the values as they are kept, before they are shown, in the spelling of [`udunits`].
    pub fn of_values(self) -> String {
        match self.shown.split_once(' ') {
            // After a power of ten.
            Some((_, unit)) => udunits(unit),
            None if self.per_si == 1.0 => udunits(self.shown),
            None => udunits(&si_unit_of(self.shown)),
        }
    }
}

/// Millimetres.
pub const MILLIMETRES: Unit = Unit { shown: "mm", per_si: 1e3 };
/// Hertz.
pub const HERTZ: Unit = Unit { shown: "Hz", per_si: 1.0 };
/// Metres per second.
pub const METRES_PER_SECOND: Unit = Unit { shown: "m/s", per_si: 1.0 };
/// Kelvin.
pub const KELVIN: Unit = Unit { shown: "K", per_si: 1.0 };
/// Millinewtons.
pub const MILLINEWTONS: Unit = Unit { shown: "mN", per_si: 1e3 };
/// A plain number.
pub const RATIO: Unit = Unit { shown: "", per_si: 1.0 };
/// Per metre.
pub const PER_METRE: Unit = Unit { shown: "1/m", per_si: 1.0 };
/// Square millimetres per hertz.
pub const SQUARE_MILLIMETRES_PER_HERTZ: Unit = Unit { shown: "mm²/Hz", per_si: 1e6 };
/// Per cent, of a ratio.
pub const PERCENT: Unit = Unit { shown: "%", per_si: 1e2 };
/// Per cent, of a value that is already in per cent.
pub const OF_PERCENT: Unit = Unit { shown: "%", per_si: 1.0 };
