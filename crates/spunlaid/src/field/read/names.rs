//! The names and units that CFD programs use.

use crate::error::FileError;
use crate::field::fault;
use crate::units::excerpt;

/// Names of the velocity vector, the preferred ones first. The mean comes before the velocity that a transient
/// solver has at one instant, because turbulence is added to it.
const VECTORS: [&str; 8] = ["umean", "u_mean", "velocity_mean", "mean_velocity", "u", "velocity", "vel", "v"];
/// Endings that mark the components.
const ENDINGS: [[&str; 3]; 4] = [["x", "y", "z"], ["0", "1", "2"], ["i", "j", "k"], ["u", "v", "w"]];
/// Names of single components.
const COMPONENTS: [[&str; 3]; 2] = [["u", "v", "w"], ["x_velocity", "y_velocity", "z_velocity"]];
const COORDINATES: [[&str; 3]; 5] = [
    ["x", "y", "z"],
    ["x_coordinate", "y_coordinate", "z_coordinate"],
    ["points_0", "points_1", "points_2"],
    ["points_x", "points_y", "points_z"],
    ["coordinates_0", "coordinates_1", "coordinates_2"],
];
const K: [&str; 7] = [
    "kmean",
    "k",
    "tke",
    "turb_kinetic_energy",
    "turbulence_kinetic_energy",
    "turbulent_kinetic_energy",
    "turbulencekineticenergy",
];
const EPSILON: [&str; 9] = [
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
const OMEGA: [&str; 6] = [
    "omegamean",
    "omega",
    "om",
    "specific_diss_rate",
    "specific_dissipation_rate",
    "turbulence_eddy_frequency",
];

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
            Self::Length => &[("m", 1.0), ("cm", 1e-2), ("mm", 1e-3), ("um", 1e-6), ("µm", 1e-6)],
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

    /// The value of a unit in SI units.
    pub(super) fn factor(self, unit: &str) -> Result<f64, FileError> {
        let known = self.units().iter().find(|(spelt, _)| *spelt == unit.replace('μ', "µ"));
        known.map(|(_, factor)| *factor).ok_or_else(|| fault::wrong_unit(unit, self.wanted()).into())
    }

    const fn wanted(self) -> &'static str {
        match self {
            Self::Length => "m, cm, mm or µm",
            Self::Velocity => "m/s, cm/s or mm/s",
            Self::K => "m2/s2, cm2/s2 or mm2/s2",
            Self::Epsilon => "m2/s3, cm2/s3 or mm2/s3",
            Self::Omega => "1/s",
        }
    }
}

/// The name of an array or a column.
#[derive(Clone, Debug)]
pub(super) struct Name {
    /// As written.
    pub(super) written: String,
    /// In lower case, with one `_` between words and before units.
    plain: String,
}

impl Name {
    pub(super) fn new(written: &str) -> Self {
        let mut plain = String::new();
        for c in written.trim().chars().flat_map(char::to_lowercase) {
            if c.is_alphanumeric() {
                plain.push(if c == 'μ' { 'µ' } else { c });
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
        let known = measure.units().iter().find(|(spelt, _)| *spelt == unit);
        if let Some((_, factor)) = known {
            return Some(Ok(*factor));
        }
        // A word in brackets can only be a unit.
        let bracket = self.written.trim_end().strip_suffix([']', ')'])?.rsplit(['[', '(']).next()?;
        if Self::new(bracket).plain.split('_').collect::<String>() != unit {
            return None;
        }
        let fault = fault::wrong_unit(bracket, measure.wanted());
        Some(Err(FileError::from(fault).array(&self.written)))
    }
}

/// Where a quantity is: its index in the list of arrays, and the value of its unit in SI units.
pub(super) type ScaledColumn = (usize, f64);

/// Where the velocity is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Velocity {
    /// An array of three components.
    Vector(ScaledColumn),
    /// Three arrays, or two in a plane flow.
    Components([Option<ScaledColumn>; 3]),
}

/// The first of some names that exists.
fn first(
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

/// Finds the velocity.
///
/// * `components` – of each array
pub(super) fn velocity(names: &[Name], components: &[usize]) -> Result<Option<Velocity>, FileError> {
    let one = |i: usize| components[i] == 1;
    for vector in VECTORS {
        let found = first(names, &[vector], Measure::Velocity, |i| components[i] == 3)?;
        if let Some(found) = found {
            return Ok(Some(Velocity::Vector(found)));
        }
        for endings in ENDINGS {
            let mut parts = [None; 3];
            for (part, ending) in parts.iter_mut().zip(endings) {
                let spelt = [format!("{vector}_{ending}"), format!("{vector}{ending}")];
                *part = first(names, &spelt.each_ref().map(String::as_str), Measure::Velocity, one)?;
            }
            if parts[0].is_some() && parts[1].is_some() {
                return Ok(Some(Velocity::Components(parts)));
            }
        }
    }
    for letters in COMPONENTS {
        let mut parts = [None; 3];
        for (part, letter) in parts.iter_mut().zip(letters) {
            *part = first(names, &[letter], Measure::Velocity, one)?;
        }
        if parts[0].is_some() && parts[1].is_some() {
            return Ok(Some(Velocity::Components(parts)));
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

/// Finds a quantity of one component.
pub(super) fn scalar(
    names: &[Name],
    components: &[usize],
    measure: Measure,
) -> Result<Option<ScaledColumn>, FileError> {
    let wanted: &[&str] = match measure {
        Measure::K => &K,
        Measure::Epsilon => &EPSILON,
        Measure::Omega => &OMEGA,
        Measure::Length | Measure::Velocity => &[],
    };
    first(names, wanted, measure, |i| components[i] == 1)
}

/// The indices of the columns that are used.
pub(super) fn used(names: &[Name]) -> Result<Vec<usize>, FileError> {
    let ones = vec![1; names.len()];
    let velocity = match velocity(names, &ones)? {
        Some(Velocity::Components(columns)) => columns,
        _ => {
            let found: Vec<String> = names.iter().map(|name| excerpt(&name.written, 40)).collect();
            return Err(fault::no_velocity(&found).into());
        }
    };
    let mut used: Vec<ScaledColumn> = coordinates(names)?.into_iter().chain(velocity).flatten().collect();
    for measure in [Measure::K, Measure::Epsilon, Measure::Omega] {
        used.extend(scalar(names, &ones, measure)?);
    }
    Ok(used.into_iter().map(|(column, _)| column).collect())
}
