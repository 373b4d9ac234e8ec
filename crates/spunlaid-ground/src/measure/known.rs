//! A number with what is known of it.

use crate::Estimate;
use serde::ser::{Serialize, SerializeMap, Serializer};

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
