//! The units in which measures are shown, and numbers with what is known of them.

use crate::Estimate;
use crate::units::{si_unit_of, udunits};
use serde::ser::{Serialize, SerializeMap, Serializer};

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

/// A number with what is known of it. There is none that stands alone as if it were exact, but
/// for counts and for what follows from given numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// It is just this.
    Exact(f64),
    /// A value and its standard error; none if the sheet is too small to say.
    Value(f64, Option<f64>),
    /// It is at least this.
    AtLeast(f64),
    /// It is at most this.
    AtMost(f64),
    /// It lies between these.
    Between([f64; 2]),
}

impl Known {
    /// A mean with its standard error.
    pub const fn of(estimate: &Estimate) -> Self {
        Self::Value(estimate.mean, estimate.standard_error)
    }

    /// The value, the bound, or the middle of the range.
    pub const fn value(self) -> f64 {
        match self {
            Self::Exact(value) | Self::Value(value, _) | Self::AtLeast(value) | Self::AtMost(value) => value,
            Self::Between([low, high]) => 0.5 * (low + high),
        }
    }

    /// The value alone.
    #[must_use]
    pub const fn without_error(self) -> Self {
        match self {
            Self::Value(value, _) => Self::Value(value, None),
            other => other,
        }
    }

    /// In another unit, or as a multiple of something.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        match self {
            Self::Exact(value) => Self::Exact(value * factor),
            Self::Value(value, error) => Self::Value(value * factor, error.map(|error| error * factor.abs())),
            Self::AtLeast(value) => Self::AtLeast(value * factor),
            Self::AtMost(value) => Self::AtMost(value * factor),
            Self::Between(ends) => Self::Between(ends.map(|end| end * factor)),
        }
    }
}

impl Serialize for Known {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let entries = match self {
            Self::Exact(value) => return serializer.serialize_f64(*value),
            Self::Value(value, error) => [Some(("value", Some(*value))), Some(("standard_error", *error))],
            Self::AtLeast(least) => [Some(("at_least", Some(*least))), None],
            Self::AtMost(most) => [Some(("at_most", Some(*most))), None],
            Self::Between([low, high]) => [Some(("low", Some(*low))), Some(("high", Some(*high)))],
        };
        let mut map = serializer.serialize_map(None)?;
        for (name, value) in entries.into_iter().flatten() {
            map.serialize_entry(name, &value)?;
        }
        map.end()
    }
}
