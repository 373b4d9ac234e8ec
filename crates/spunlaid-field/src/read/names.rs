//! The names that CFD programs use.

use crate::{FieldLayout, fault};
use spunlaid_ground::FileError;
use spunlaid_ground::units::plain_spelling;

/// Names of the velocity vector, the preferred ones first. The mean comes before the velocity that a transient
/// solver has at one instant, because turbulence is added to it.
pub(super) const VECTORS: [&str; 8] =
    ["umean", "u_mean", "velocity_mean", "mean_velocity", "u", "velocity", "vel", "v"];
/// Endings that mark the components.
pub(super) const ENDINGS: [[&str; 3]; 4] =
    [["x", "y", "z"], ["0", "1", "2"], ["i", "j", "k"], ["u", "v", "w"]];
/// Names of single components.
pub(super) const COMPONENTS: [[&str; 3]; 2] = [["u", "v", "w"], ["x_velocity", "y_velocity", "z_velocity"]];
const COORDINATES: [[&str; 3]; 5] = [
    ["x", "y", "z"],
    ["x_coordinate", "y_coordinate", "z_coordinate"],
    ["points_0", "points_1", "points_2"],
    ["points_x", "points_y", "points_z"],
    ["coordinates_0", "coordinates_1", "coordinates_2"],
];
pub(super) const K: [&str; 7] = [
    "kmean",
    "k",
    "tke",
    "turb_kinetic_energy",
    "turbulence_kinetic_energy",
    "turbulent_kinetic_energy",
    "turbulencekineticenergy",
];
pub(super) const EPSILON: [&str; 9] = [
    "epsilonmean",
    "epsilon",
    "eps",
    "ep",
    "turb_diss_rate",
    "turbulent_dissipation_rate",
    "turbulence_dissipation_rate",
    "turbulence_eddy_dissipation",
    "dissipation_rate",
];
pub(super) const OMEGA: [&str; 6] = [
    "omegamean",
    "omega",
    "om",
    "specific_diss_rate",
    "specific_dissipation_rate",
    "turbulence_eddy_frequency",
];

/// The name of an array or a column.
#[derive(Clone, Debug)]
pub(super) struct Name {
    /// As written.
    pub(super) written: String,
    /// In lower case, with one `_` between words and before units.
    pub(super) plain: String,
}

impl Name {
    pub(super) fn new(written: &str) -> Self {
        let mut plain = String::new();
        for c in plain_spelling(written.trim()).chars().flat_map(char::to_lowercase) {
            if c.is_alphanumeric() {
                plain.push(c);
            } else if !plain.is_empty() && !plain.ends_with('_') {
                plain.push('_');
            }
        }
        plain.truncate(plain.trim_end_matches('_').len());
        Self { written: written.to_owned(), plain }
    }

    /// The value of its unit in SI units, if this is the name, with or without a unit at its end.
    fn is(&self, name: &str, measure: Measure) -> Option<Result<f64, FileError>> {
        let unit = self.plain.strip_prefix(name)?;
        if unit.is_empty() {
            return Some(Ok(1.0));
        }
        let unit: String = unit.strip_prefix('_')?.split('_').collect();
        // A word in brackets can only be a unit.
        measure
            .unit_value(&unit)
            .map(Ok)
            .or_else(|| Some(Err(self.wrong_unit(measure).filter(|(word, _)| *word == unit)?.1)))
    }

    /// The value of the unit at its end in SI units, if there is one.
    fn known_unit(&self, measure: Measure) -> Option<f64> {
        let words: Vec<&str> = self.plain.split('_').collect();
        (1..words.len()).find_map(|start| measure.unit_value(&words[start..].concat()))
    }

    /// Whether it ends with a unit of this quantity.
    pub(super) fn has_unit(&self, measure: Measure) -> bool {
        self.known_unit(measure).is_some()
    }

    /// The value of the unit at its end in SI units; 1 if there is none.
    pub(super) fn unit_at_end(&self, measure: Measure) -> Result<f64, FileError> {
        if let Some(factor) = self.known_unit(measure) {
            return Ok(factor);
        }
        match self.wrong_unit(measure) {
            Some((word, error)) if !ENDINGS.iter().flatten().any(|ending| *ending == word) => Err(error),
            _ => Ok(1.0),
        }
    }

    /// The word in brackets at its end in letters and digits, and the error if it is no unit.
    fn wrong_unit(&self, measure: Measure) -> Option<(String, FileError)> {
        let bracket = self.written.trim_end().strip_suffix([']', ')'])?.rsplit(['[', '(']).next()?;
        let error = FileError::from(fault::wrong_unit(bracket, measure.wanted())).array(&self.written);
        Some((Self::new(bracket).plain.split('_').collect(), error))
    }
}

/// Where a quantity is: its index in the list of arrays, and the value of its unit in SI units.
pub(super) type ScaledColumn = (usize, f64);

/// The first of some names that exists.
pub(super) fn first(
    names: &[Name],
    wanted: &[&str],
    measure: Measure,
    fits: impl Fn(usize) -> bool,
) -> Result<Option<ScaledColumn>, FileError> {
    for name in wanted {
        for (i, candidate) in names.iter().enumerate() {
            if fits(i)
                && let Some(factor) = candidate.is(name, measure)
            {
                return Ok(Some((i, factor?)));
            }
        }
    }
    Ok(None)
}

/// Finds the coordinates. A plane flow may lack the third.
pub(super) fn coordinates(names: &[Name]) -> Result<[Option<ScaledColumn>; 3], FileError> {
    let mut best = [None; 3];
    for spelt in COORDINATES {
        let mut parts = [None; 3];
        for (part, name) in parts.iter_mut().zip(spelt) {
            *part = first(names, &[name], Measure::Length, |_| true)?;
        }
        let count = |parts: &[Option<ScaledColumn>; 3]| parts.iter().flatten().count();
        if count(&parts) > count(&best) {
            best = parts;
        }
    }
    Ok(best)
}

spunlaid_ground::named! {
    /// The dimension of a quantity.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub(super) enum Measure {
        Length = "length",
        Velocity = "velocity",
        K = "k",
        Epsilon = "ε",
        Omega = "ω",
    }
}

impl Measure {
    /// Units, written with letters and digits only, and their values in SI units.
    const fn units(self) -> &'static [(&'static str, f64)] {
        match self {
            Self::Length => &[
                ("m", 1.0),
                ("dm", 0.1),
                ("cm", 1e-2),
                ("mm", 1e-3),
                ("um", 1e-6),
                ("in", 0.0254),
                ("inch", 0.0254),
                ("ft", 0.3048),
            ],
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

    pub(super) const fn wanted(self) -> &'static str {
        match self {
            Self::Length => "m, dm, cm, mm, µm, in or ft",
            Self::Velocity => "m/s, cm/s or mm/s",
            Self::K => "m2/s2, cm2/s2 or mm2/s2",
            Self::Epsilon => "m2/s3, cm2/s3 or mm2/s3",
            Self::Omega => "1/s",
        }
    }
}
