//! Values at points: as given by the caller, and as stored.

use super::fault;
use crate::error::{Fault, FileError, Position};
use crate::units::shortest;
use crate::vec3::Vec3;

/// Largest coordinate [m] and largest value [SI] that are accepted. Larger ones make volumes and squares overflow.
pub(super) const LARGEST: f64 = 1e30;

/// `C_µ` of the k-ε model. The dissipation rate is `ε = C_µ k ω`                 Wilcox 1988.
pub(super) const C_MU: f64 = 0.09;

/// Velocity along x, y and z [m/s], `k` [m²/s²] and `ε` [m²/s³] at a point.
pub(super) type Quantities = [f64; 5];

/// The values of a field at its points, in SI units.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values {
    /// Mean velocity [m/s].
    pub velocity: Vec<Vec3<f64>>,
    /// Turbulent kinetic energy `k` [m²/s²]; empty if it is not known.
    pub k: Vec<f64>,
    /// Dissipation rate `ε` [m²/s³]; empty if it is not known.
    pub epsilon: Vec<f64>,
}

impl Values {
    /// Whether both `k` and `ε` are there.
    pub fn has_turbulence(&self) -> bool {
        !self.k.is_empty() && !self.epsilon.is_empty()
    }

    /// Adds values of further points.
    pub(super) fn append(&mut self, mut more: Self) {
        self.velocity.append(&mut more.velocity);
        self.k.append(&mut more.k);
        self.epsilon.append(&mut more.epsilon);
    }

    /// The values point by point, after checking that there is one for each of `points`.
    pub(super) fn check(&self, points: usize) -> Result<Vec<Quantities>, FileError> {
        let lengths = [
            ("velocity", self.velocity.len(), false),
            ("k", self.k.len(), true),
            ("epsilon", self.epsilon.len(), true),
        ];
        for (array, found, optional) in lengths {
            if found != points && !(optional && found == 0) {
                let fault = fault::count(found, points, "values");
                return Err(FileError::from(fault).array(array));
            }
        }
        let turbulent = self.has_turbulence();
        if turbulent {
            let decay =
                self.k.iter().zip(&self.epsilon).filter(|(k, _)| **k > 0.0).map(|(_, epsilon)| *epsilon);
            if decay.clone().next().is_some() && decay.clone().all(|epsilon| epsilon == 0.0) {
                let fault = Fault::new(
                    format!(
                        "is zero at all {} points at which k is above zero, so the eddies would be infinitely long",
                        decay.count()
                    ),
                    "write the ε or ω of the solution, or leave out k, and give turbulence_intensity, \
                    length_scale and cutoff_frequency in the case",
                );
                return Err(FileError::from(fault).array("epsilon"));
            }
        }
        let mut quantities = Vec::with_capacity(points);
        for (i, velocity) in self.velocity.iter().enumerate() {
            let [k, epsilon] = if turbulent { [self.k[i], self.epsilon[i]] } else { [0.0; 2] };
            let values = [velocity.x, velocity.y, velocity.z, k, epsilon];
            check_range(&values).map_err(|fault| at_point(fault, i))?;
            quantities.push(values);
        }
        Ok(quantities)
    }
}

/// Checks that numbers are finite and small enough to compute with.
pub(super) fn check_range(numbers: &[f64]) -> Result<(), Fault> {
    match numbers.iter().find(|number| number.is_nan() || number.abs() > LARGEST) {
        None => Ok(()),
        Some(number) => Err(Fault::new(
            format!("{} is not a number between −{LARGEST:e} and {LARGEST:e}", shortest(*number)),
            "correct the value, or leave out points without one",
        )),
    }
}

/// The fault of a point, counted from 0.
pub(super) fn at_point(fault: Fault, point: usize) -> FileError {
    FileError::from(fault).at(Position::Point(point as u64 + 1))
}

/// Which arrays of a file are the velocity and the turbulence. A quantity without a name here is found by its
/// usual names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FieldLayout {
    /// Velocity: one array of three components, or two or three arrays of one, with commas between them.
    pub velocity: Option<String>,
    /// Turbulent kinetic energy `k`.
    pub k: Option<String>,
    /// Dissipation rate `ε`.
    pub epsilon: Option<String>,
    /// Specific dissipation rate `ω`.
    pub omega: Option<String>,
}
