//! The air of a case at given places: its mean flow and its turbulence, as an element there would meet them.

use super::{Air, Flow, LocalAir};
use crate::error::{Error, Fault};
use crate::field::Hint;
use crate::units::Dimension;
use crate::vec3::Vec3;

/// The axes in which places and velocities are told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlaceAxes {
    /// Of the case: from the root or the inlet, x along gravity, y in machine direction, z in cross direction.
    Line,
    /// Of the file of a CFD field.
    Field,
}

impl PlaceAxes {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Line, Self::Field];

    /// What they are called.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Line => "line",
            Self::Field => "field",
        }
    }
}

impl LocalAir {
    /// Turbulent kinetic energy `k = 1.5 u²`, with the rms `u` of each component [m²/s²].
    pub fn k(&self) -> f64 {
        1.5 * self.rms * self.rms
    }
}

impl Air {
    /// The axes in which places are told if nobody says so: those of a CFD field, or of the line.
    pub const fn usual_axes(&self) -> PlaceAxes {
        if self.flow.is_field() { PlaceAxes::Field } else { PlaceAxes::Line }
    }

    /// The air at places; None where it is not known, outside of the field or of the rows of the profile.
    ///
    /// * `places` – in these axes [m]; velocities have the same axes
    ///
    /// # Errors
    /// Axes of a field where there is none, a place that is not finite, or no place at which the air is known.
    pub fn at_points(&self, places: &[Vec3<f64>], axes: PlaceAxes) -> Result<Vec<Option<LocalAir>>, Error> {
        let placed = match (&self.flow, axes) {
            (Flow::Field(placed), PlaceAxes::Field) => Some(placed),
            (_, PlaceAxes::Line) => None,
            (_, PlaceAxes::Field) => {
                let message = "the air of the case is no CFD field, so it has no axes of a field";
                return Err(Error::flight(message, "give the places in the axes of the line"));
            }
        };
        if let Some(row) = places.iter().position(|at| ![at.x, at.y, at.z].iter().all(|x| x.is_finite())) {
            let message = format!("place {} is not finite", row + 1);
            return Err(Error::flight(message, "give three numbers in metres"));
        }
        let mut hint = Hint::default();
        let look = |at: &Vec3<f64>| {
            let local = self.local(placed.map_or(*at, |placed| placed.in_fibre_frame(*at)), &mut hint);
            let velocity = placed.map_or(local.velocity, |placed| placed.turned(local.velocity));
            local.inside.then_some(LocalAir { velocity, ..local })
        };
        let found: Vec<Option<LocalAir>> = places.iter().map(look).collect();
        match found.iter().any(Option::is_some) || places.is_empty() {
            true => Ok(found),
            false => Err(Error::Flight(self.all_outside(places.len(), axes))),
        }
    }

    /// The fault of places of which none has known air.
    fn all_outside(&self, places: usize, axes: PlaceAxes) -> Fault {
        let length = |metres: f64| Dimension::Length.pretty_to(metres + 0.0, 4);
        let known = match &self.flow {
            Flow::Field(placed) => {
                let (low, high) = match axes {
                    PlaceAxes::Line => placed.extent(),
                    PlaceAxes::Field => {
                        let (low, high) = placed.field.bounds();
                        (low * placed.unit, high * placed.unit)
                    }
                };
                let range = |(name, low, high)| format!("{name} from {} to {}", length(low), length(high));
                [("x", low.x, high.x), ("y", low.y, high.y), ("z", low.z, high.z)].map(range).join(", ")
            }
            Flow::Profile(profile) => {
                let (first, last) = profile.range();
                format!("x from {} to {}", length(first), length(last))
            }
            Flow::Uniform => "everywhere".to_owned(),
        };
        Fault::new(
            format!(
                "none of the {places} places lies where the air is known: {known}, in the axes of the {}",
                axes.name()
            ),
            "check the unit of the coordinates, and in which axes they are",
        )
    }
}
