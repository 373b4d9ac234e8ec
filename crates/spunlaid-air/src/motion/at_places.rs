//! The air at any place and time, as fibres in a field of eddies meet it.

use super::eddy_field::EddyFields;
use super::{Air, EddyField, Extent, Flow, LocalAir, Room, StreamKey};
use crate::field::Hint;
use spunlaid_ground::{Dimension, Error, Fault, Isa, Lanes, Register, Task, Vec3, WIDTH};

/// Latest time of a look [s].
const LATEST: f64 = 1e6;

/// Air whose turbulence is a field of eddies in space, to be looked at wherever and whenever one likes.
///
/// The same seed and replicate give the air that a fibre of the case flies in, but for the interpolation of
/// the mean flow along the way, which is linear there and exact here.
#[derive(Clone, Debug)]
pub struct AirAtPlaces {
    air: Air,
    extent: Extent,
    /// None in still air.
    field: Option<EddyField>,
    threads: usize,
    isa: Isa,
}

impl AirAtPlaces {
    /// * `distance` – from the inlet, or the root, to the end of the way [m]
    /// * `extent` – after which the turbulence repeats itself across
    /// * `threads` – that make the field; they do not change it
    ///
    /// # Errors
    /// Turbulence that is the same everywhere across is none in space.
    pub fn new(
        air: &Air,
        distance: f64,
        extent: Extent,
        key: StreamKey,
        threads: usize,
    ) -> Result<Self, Error> {
        if air.lateral.cutoff().is_none() {
            return Err(Error::flight(
                "the air has no turbulence in space: with air.lateral = \"uniform\" each fibre has one of its own",
                "write air.lateral = \"von-karman\"",
            ));
        }
        // The air that a fibre flies in, but everywhere.
        let room = Room::alone(distance, extent).for_fibre(f64::INFINITY);
        let field = air.field_cutoff().map(|cutoff| EddyField::in_room(air, &room, cutoff, key));
        Ok(Self { air: air.clone(), extent, field, threads, isa: Isa::detect() })
    }

    /// Looks with another instruction set. The velocities do not depend on it.
    #[must_use]
    pub fn with_instructions(self, isa: Isa) -> Self {
        Self { isa, ..self }
    }

    /// After what distances the turbulence repeats itself across.
    pub const fn extent(&self) -> Extent {
        self.extent
    }

    /// Velocities of the air at places [m/s].
    ///
    /// Looks at times that rise are fast; one at an earlier time makes the field again.
    ///
    /// * `time` – from the start of a run [s]
    /// * `places` – the origin is the inlet or the root, and x points along gravity [m]. The turbulence
    ///   before the inlet is that at the inlet, and beyond the end of the way that at the end
    ///
    /// # Errors
    /// A time that is negative or above 10⁶ s, or a place that is not finite.
    pub fn velocities(&mut self, time: f64, places: &[Vec3<f64>]) -> Result<Vec<Vec3<f64>>, Error> {
        if !(0.0..=LATEST).contains(&time) {
            let message = format!("the air is not known at {time:e} s");
            return Err(Error::flight(message, "give a time from 0 to 1e6 s after the start of a run"));
        }
        if places.iter().any(|place| ![place.x, place.y, place.z].iter().all(|x| x.is_finite())) {
            return Err(Error::flight("a position is not finite", "give numbers in metres"));
        }
        if let Some(field) = &mut self.field
            && !field.is_made_for(time)
        {
            field.make(time..time + field.block(), self.threads);
        }
        let fluctuations = match &self.field {
            Some(field) => self.isa.run(Look { field, time, places }),
            None => vec![Vec3::new(0.0, 0.0, 0.0); places.len()],
        };
        let mut hint = Hint::default();
        let velocity = |(place, fluctuation): (&Vec3<f64>, Vec3<f64>)| {
            let local = self.air.local(*place, &mut hint);
            local.velocity + fluctuation * local.rms
        };
        Ok(places.iter().zip(fluctuations).map(velocity).collect())
    }
}

/// Fluctuations of rms one at places.
struct Look<'a> {
    field: &'a EddyField,
    time: f64,
    places: &'a [Vec3<f64>],
}

impl Task for Look<'_> {
    type Output = Vec<Vec3<f64>>;

    #[inline(always)]
    fn call<S: Register>(self) -> Self::Output {
        let mut all = Vec::with_capacity(self.places.len());
        let fields = EddyFields::new([self.field; WIDTH]);
        for eight in self.places.chunks(WIDTH) {
            let coordinate = |component: fn(&Vec3<f64>) -> f64| {
                let mut lanes = Lanes::ZERO;
                lanes.0.iter_mut().zip(eight).for_each(|(lane, place)| *lane = component(place));
                lanes
            };
            let at = Vec3::new(coordinate(|p| p.x), coordinate(|p| p.y), coordinate(|p| p.z));
            let (Vec3 { x, y, z }, _) = fields.fluctuations::<S>(self.time, &at);
            all.extend((0..eight.len()).map(|lane| Vec3::new(x.0[lane], y.0[lane], z.0[lane])));
        }
        all
    }
}

named! {
    /// The axes in which places and velocities are reported.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum PlaceAxes {
        /// Of the case: from the root or the inlet, x along gravity, y in machine direction, z in cross direction.
        Line = "line",
        /// Of the file of a CFD field.
        Field = "field",
    }
}

impl LocalAir {
    /// Turbulent kinetic energy `k = 1.5 u²`, with the rms `u` of each component [m²/s²].
    pub fn k(&self) -> f64 {
        1.5 * self.rms * self.rms
    }
}

impl Air {
    /// The axes in which places are reported if nobody says so: those of a CFD field, or of the line.
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
                let message = "the air of the case is not a CFD field, so it has no axes of a field";
                return Err(Error::flight(message, "give the positions in the axes of the line"));
            }
        };
        if let Some(row) = places.iter().position(|at| ![at.x, at.y, at.z].iter().all(|x| x.is_finite())) {
            let message = format!("position {} is not finite", row + 1);
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
                "none of the {places} positions lies where the air is known: {known}, in the axes of the {}",
                axes.name()
            ),
            "check the unit of the coordinates, and in which axes they are",
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{AirInSpace, FibreAir, FibreInField};
    use crate::motion::{EddyModel, Lateral};
    use spunlaid_ground::place::Inlet;
    use spunlaid_ground::{PerLane, Plain};
    use std::sync::Arc;

    const DISTANCE: f64 = 0.2;
    const EXTENT: Extent = Extent { y: 0.16, z: 0.16 };
    const KEY: StreamKey = StreamKey { seed: 5, replicate: 2 };

    fn air() -> Air {
        Air {
            eddies: EddyModel::Convected { decay_time: 10e-3 },
            lateral: Lateral::VonKarman { cutoff: 8.0 },
            ..Air::uniform(10.0, 0.2, 16e-3, 156.0)
        }
    }

    fn at_places() -> AirAtPlaces {
        AirAtPlaces::new(&air(), DISTANCE, EXTENT, KEY, 1).unwrap()
    }

    #[test]
    fn identical_to_the_air_around_a_fibre() {
        let place = Inlet { y: 3e-3, z: -7e-3 };
        // A fibre that swings far beyond what is made of its field at first.
        let room = Room::alone(DISTANCE, EXTENT).for_fibre(0.01);
        let field = EddyField::in_room(&air(), &room, 8.0, KEY);
        let lanes = PerLane::new(vec![FibreInField {
            around: FibreAir { air: air(), inlet: place },
            field: Arc::new(field),
            distance: DISTANCE,
        }])
        .unwrap();
        let mut around = AirInSpace::new(&lanes, 20, 1);
        let mut free = at_places();
        for step in 0..40 {
            let (time, swing) = (1e-3 * step as f64, 1e-2 * (step as f64 - 15.0));
            let node =
                |i: u32| Vec3::new(0.01 * f64::from(i), swing * f64::from(i) / 20.0, 2e-3 - 0.5 * swing);
            let nodes: Vec<Vec3<f64>> = (0..=20).map(node).collect();
            let fibre: Vec<Vec3<Lanes>> = nodes.iter().map(|node| Vec3::splat(*node)).collect();
            let centres: Vec<Vec3<f64>> = (nodes.windows(2))
                .map(|ends| (ends[0] + ends[1]) * 0.5 + Vec3::new(0.0, place.y, place.z))
                .collect();
            let found = free.velocities(time, &centres).unwrap();
            let there = around.look::<Plain>(step, time, &fibre);
            for (j, found) in found.iter().enumerate() {
                let expected = there.at(j).store();
                let off = [expected.x.0[0] - found.x, expected.y.0[0] - found.y, expected.z.0[0] - found.z];
                assert!(off.iter().all(|off| off.abs() < 1e-9), "{step} {j}: {off:?}");
            }
        }
    }

    #[test]
    fn reproducible_whenever_one_looks() {
        let places: Vec<Vec3<f64>> = (0..13).map(|i| Vec3::new(0.01 * f64::from(i), 0.02, 0.0)).collect();
        let mut air = at_places();
        let late = air.velocities(0.35, &places).unwrap();
        let early = air.velocities(0.01, &places).unwrap();
        assert_eq!(early, at_places().velocities(0.01, &places).unwrap());
        assert_eq!(late, air.velocities(0.35, &places).unwrap());
        assert_ne!(early, late);
        // It repeats itself across.
        let beside: Vec<Vec3<f64>> = places.iter().map(|p| *p + Vec3::new(0.0, EXTENT.y, 0.0)).collect();
        for (a, b) in air.velocities(0.35, &beside).unwrap().iter().zip(&late) {
            assert!((a.y - b.y).abs() < 1e-5, "{a:?} {b:?}");
        }
    }

    #[test]
    fn rejects_what_cannot_be_looked_at() {
        let mut air = at_places();
        assert!(air.velocities(-1.0, &[]).is_err() && air.velocities(f64::NAN, &[]).is_err());
        assert!(air.velocities(0.0, &[Vec3::new(f64::NAN, 0.0, 0.0)]).is_err());
        let uniform = Air { lateral: Lateral::Uniform, ..self::air() };
        let refused = AirAtPlaces::new(&uniform, DISTANCE, EXTENT, KEY, 1).unwrap_err().to_string();
        assert!(refused.contains("air.lateral = \"von-karman\""), "{refused}");
    }
}
