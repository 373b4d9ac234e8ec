//! The arrays of a file by their names: the usual ones, or those that a case gives.

use super::array::Array;
use super::names::{COMPONENTS, ENDINGS, EPSILON, K, Measure, Name, OMEGA, ScaledColumn, VECTORS, first};
use crate::FieldLayout;
use spunlaid_ground::FileError;
use spunlaid_ground::error::listed;
use spunlaid_ground::units::excerpt;

/// Where the velocity is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Velocity {
    /// An array of three components.
    Vector(ScaledColumn),
    /// Three arrays, or two in a plane flow.
    Components([Option<ScaledColumn>; 3]),
}

impl Velocity {
    /// The indices of its arrays.
    pub(super) fn columns(self) -> impl Iterator<Item = usize> {
        let parts = match self {
            Self::Vector(vector) => [Some(vector), None, None],
            Self::Components(parts) => parts,
        };
        parts.into_iter().flatten().map(|(column, _)| column)
    }
}

/// The arrays of a file by their names, and which of them a case names.
pub(super) struct Arrays<'a> {
    pub(super) names: Vec<Name>,
    /// Components of each.
    pub(super) components: Vec<usize>,
    pub(super) layout: &'a FieldLayout,
}

impl<'a> Arrays<'a> {
    pub(super) fn new<'b>(layout: &'a FieldLayout, arrays: impl Iterator<Item = &'b Array<'b>>) -> Self {
        let (names, components) = arrays.map(|array| (Name::new(&array.name), array.components)).unzip();
        Self { names, components, layout }
    }

    /// The columns of a table, each of one component.
    pub(super) fn from_table(layout: &'a FieldLayout, names: Vec<Name>) -> Self {
        Self { components: vec![1; names.len()], names, layout }
    }

    /// The name of an array for a message.
    pub(super) fn shown(&self, array: usize) -> String {
        excerpt(&self.names[array].written, 40)
    }

    /// The names for a message.
    pub(super) fn listed(&self) -> String {
        listed(&(0..self.names.len()).map(|array| self.shown(array)).collect::<Vec<_>>())
    }

    /// Finds the velocity.
    pub(super) fn velocity(&self) -> Result<Option<Velocity>, FileError> {
        let Some(request) = Measure::Velocity.request(self.layout) else {
            return self.usual_velocity();
        };
        if let Some(vector) = self.find(request, Measure::Velocity, 3)? {
            return Ok(Some(Velocity::Vector(vector)));
        }
        if let Some(parts) = self.with_endings(&Name::new(request).plain)? {
            return Ok(Some(Velocity::Components(parts)));
        }
        let found = request.split(',').map(|name| self.find(name, Measure::Velocity, 1));
        let found: Option<Vec<ScaledColumn>> = found.collect::<Result<_, _>>()?;
        Ok(match found.unwrap_or_default()[..] {
            [u, v] if u.0 != v.0 => Some(Velocity::Components([Some(u), Some(v), None])),
            [u, v, w] if u.0 != v.0 && v.0 != w.0 && u.0 != w.0 => {
                Some(Velocity::Components([Some(u), Some(v), Some(w)]))
            }
            _ => None,
        })
    }

    fn usual_velocity(&self) -> Result<Option<Velocity>, FileError> {
        for vector in VECTORS {
            if let Some(found) = self.first(&[vector], Measure::Velocity, 3)? {
                return Ok(Some(Velocity::Vector(found)));
            }
            if let Some(parts) = self.with_endings(vector)? {
                return Ok(Some(Velocity::Components(parts)));
            }
        }
        for letters in COMPONENTS {
            let found = self.parts(letters.map(|letter| [letter.to_owned()]))?;
            if found.is_some() {
                return Ok(found.map(Velocity::Components));
            }
        }
        Ok(None)
    }

    /// The components of a vector, each in an array with the name of the vector and an ending.
    pub(super) fn with_endings(&self, vector: &str) -> Result<Option<[Option<ScaledColumn>; 3]>, FileError> {
        for endings in ENDINGS {
            let spelt = endings.map(|ending| [format!("{vector}_{ending}"), format!("{vector}{ending}")]);
            if let Some(parts) = self.parts(spelt)? {
                return Ok(Some(parts));
            }
        }
        Ok(None)
    }

    /// The arrays of three components. A plane flow may lack the third.
    ///
    /// * `spelt` – the ways in which each is spelt
    fn parts<const N: usize>(
        &self,
        spelt: [[String; N]; 3],
    ) -> Result<Option<[Option<ScaledColumn>; 3]>, FileError> {
        let mut parts = [None; 3];
        for (part, spelt) in parts.iter_mut().zip(spelt) {
            *part = self.first(&spelt.each_ref().map(String::as_str), Measure::Velocity, 1)?;
        }
        Ok((parts[0].is_some() && parts[1].is_some()).then_some(parts))
    }

    /// Finds a quantity of one component.
    pub(super) fn scalar(&self, measure: Measure) -> Result<Option<ScaledColumn>, FileError> {
        if let Some(request) = measure.request(self.layout) {
            return self.find(request, measure, 1);
        }
        let usual: &[&str] = match measure {
            Measure::K => &K,
            // A case that names ω does not mean another ε.
            Measure::Epsilon if self.layout.omega.is_none() => &EPSILON,
            Measure::Omega => &OMEGA,
            Measure::Epsilon | Measure::Length | Measure::Velocity => &[],
        };
        self.first(usual, measure, 1)
    }

    /// The first of some usual names that exists.
    fn first(
        &self,
        usual: &[&str],
        measure: Measure,
        components: usize,
    ) -> Result<Option<ScaledColumn>, FileError> {
        first(&self.names, usual, measure, |i| self.components[i] == components)
    }

    /// The array with a name that a case gives: as it is written, or else without regard to case, blanks and unit.
    fn find(
        &self,
        request: &str,
        measure: Measure,
        components: usize,
    ) -> Result<Option<ScaledColumn>, FileError> {
        let plain = Name::new(request).plain;
        let of_size = || self.names.iter().enumerate().filter(|(i, _)| self.components[*i] == components);
        let whole = of_size()
            .find(|(_, name)| name.written.trim() == request.trim())
            .or_else(|| of_size().find(|(_, name)| name.plain == plain));
        match whole {
            Some((i, name)) => Ok(Some((i, name.unit_at_end(measure)?))),
            None => first(&self.names, &[plain.as_str()], measure, |i| self.components[i] == components),
        }
    }

    /// The number of components of the array with a name, whatever it is; none if there is none.
    pub(super) fn components_of(&self, request: &str, measure: Measure) -> Option<usize> {
        self.components
            .iter()
            .copied()
            .find(|size| matches!(self.find(request, measure, *size), Ok(Some(_)) | Err(_)))
    }

    /// The columns of a table that are used, besides the coordinates.
    pub(super) fn used(&self) -> Result<Vec<usize>, FileError> {
        let mut used: Vec<usize> = self.velocity()?.into_iter().flat_map(Velocity::columns).collect();
        for measure in [Measure::K, Measure::Epsilon, Measure::Omega] {
            used.extend(self.scalar(measure)?.map(|(column, _)| column));
        }
        Ok(used)
    }
}
