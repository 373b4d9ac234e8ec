//! The quantities of a field and the units in which files write them.

use crate::error::FileError;
use crate::field::{FieldLayout, fault};
use crate::units::plain_spelling;

/// The dimension of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Measure {
    Length,
    Velocity,
    K,
    Epsilon,
    Omega,
}

impl Measure {
    /// Units, written with letters and digits only, and their values in SI units.
    const fn units(self) -> &'static [(&'static str, f64)] {
        match self {
            Self::Length => &[("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6)],
            Self::Velocity => {
                &[("ms", 1.0), ("ms1", 1.0), ("cms", 1e-2), ("cms1", 1e-2), ("mms", 1e-3), ("mms1", 1e-3)]
            }
            Self::K => &[("m2s2", 1.0), ("cm2s2", 1e-4), ("mm2s2", 1e-6), ("jkg", 1.0), ("jkg1", 1.0)],
            Self::Epsilon => {
                &[("m2s3", 1.0), ("cm2s3", 1e-4), ("mm2s3", 1e-6), ("wkg", 1.0), ("wkg1", 1.0), ("jkgs", 1.0)]
            }
            Self::Omega => &[("s", 1.0), ("1s", 1.0), ("s1", 1.0)],
        }
    }

    /// The value of a unit in SI units, if it is one of this quantity.
    ///
    /// * `unit` – with letters and digits only
    pub(super) fn unit_value(self, unit: &str) -> Option<f64> {
        self.units().iter().find(|(spelt, _)| *spelt == unit).map(|(_, factor)| *factor)
    }

    /// The value of a unit in SI units.
    pub(super) fn factor(self, unit: &str) -> Result<f64, FileError> {
        let value = self.unit_value(&plain_spelling(unit));
        value.ok_or_else(|| fault::wrong_unit(unit, self.wanted()).into())
    }

    /// The array that a case names for it.
    pub(super) fn request(self, layout: &FieldLayout) -> Option<&str> {
        match self {
            Self::Length => None,
            Self::Velocity => layout.velocity.as_deref(),
            Self::K => layout.k.as_deref(),
            Self::Epsilon => layout.epsilon.as_deref(),
            Self::Omega => layout.omega.as_deref(),
        }
    }

    /// The key with which a case names its array.
    pub(super) const fn key(self) -> &'static str {
        match self {
            Self::Length => "",
            Self::Velocity => "air.field_velocity",
            Self::K => "air.field_k",
            Self::Epsilon => "air.field_epsilon",
            Self::Omega => "air.field_omega",
        }
    }

    /// Its name or symbol in messages.
    pub(super) const fn symbol(self) -> &'static str {
        match self {
            Self::Length => "length",
            Self::Velocity => "velocity",
            Self::K => "k",
            Self::Epsilon => "ε",
            Self::Omega => "ω",
        }
    }

    pub(super) const fn wanted(self) -> &'static str {
        match self {
            Self::Length => "m, cm, mm or µm",
            Self::Velocity => "m/s, cm/s or mm/s",
            Self::K => "m2/s2, cm2/s2 or mm2/s2",
            Self::Epsilon => "m2/s3, cm2/s3 or mm2/s3",
            Self::Omega => "1/s",
        }
    }
}
