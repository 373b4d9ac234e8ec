//! The kinds of air in which fibres fly, and the velocity that each gives at their elements.
//!
//! ```text
//! look   once a step: the time and the places of the nodes → what the air needs to know
//! fill   block by block: a buffer with the velocity at each element → forces
//! ```
//!
//! The kernel reads the buffer and knows no kind of air. A kind is a variant here, and what it looks at is its own: it may
//! belong to one flight, or be a handle to something that many flights read. The buffer is filled in blocks, because the
//! signals of many eddies come from outside of the first-level cache while the forces of a block are computed; filled at once
//! it cost up to a seventh of a step.

use super::{Eddies, EddyWind, Stations, Surroundings, Wind};
use crate::error::FlightFault;
use crate::lanes::{Lanes, Register};
use crate::vec3::Vec3;

/// The air in which up to eight fibres fly.
#[derive(Clone, Debug)]
pub enum Atmosphere {
    /// Eddies in a flow that is the same everywhere.
    Uniform(EddyWind),
    /// Eddies in a flow that differs from place to place. Their wind has the mean zero and the rms one.
    Flow(EddyWind, Surroundings),
    /// The air along the way of fed fibres, with a signal for each station.
    Way(Wind, Stations),
}

/// An instant of a flight.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant {
    /// Number of steps done.
    pub(crate) step: u64,
    /// Time since the start [s].
    pub(crate) time: f64,
}

impl From<(&Eddies, &Wind)> for Atmosphere {
    fn from((eddies, wind): (&Eddies, &Wind)) -> Self {
        Self::Uniform(EddyWind { eddies: eddies.clone(), wind: wind.clone() })
    }
}

impl From<(&Eddies, &Wind, Surroundings)> for Atmosphere {
    fn from((eddies, wind, flow): (&Eddies, &Wind, Surroundings)) -> Self {
        Self::Flow(EddyWind { eddies: eddies.clone(), wind: wind.clone() }, flow)
    }
}

impl Atmosphere {
    /// Looks at the air at an instant.
    ///
    /// * `position` – of the `N+1` nodes [m]
    #[inline(always)]
    pub(crate) fn look<S: Register>(&mut self, now: Instant, position: &[Vec3<Lanes>]) {
        let Instant { step, time } = now;
        match self {
            Self::Uniform(air) => air.wind.go_to::<S>(time),
            Self::Flow(air, flow) => {
                air.wind.go_to::<S>(time);
                flow.look::<S>(step, position);
            }
            Self::Way(wind, stations) => stations.look::<S>(step, time, wind, position),
        }
    }

    /// Writes the velocity of the air at each element from `start` on [m/s], at the instant of the look.
    #[inline(always)]
    pub(crate) fn fill<S: Register>(&self, start: usize, velocity: &mut [Vec3<Lanes>]) {
        match self {
            Self::Uniform(air) => air.fill::<S>(start, velocity),
            Self::Flow(air, flow) => {
                air.fill::<S>(start, velocity);
                flow.carry::<S>(start, velocity);
            }
            Self::Way(_, stations) => stations.fill::<S>(start, velocity),
        }
    }

    /// Whether it fits fibres of so many elements.
    ///
    /// # Errors
    /// A part of it is made for another number of elements or of eddies.
    pub(crate) fn check(&self, elements: usize) -> Result<(), FlightFault> {
        let fits = |what, of, found, wanted| match found == wanted {
            true => Ok(()),
            false => Err(FlightFault::Size { what, of, found, wanted }),
        };
        if let Self::Uniform(air) | Self::Flow(air, _) = self {
            fits("air", "elements", air.eddies.of_element().len(), elements)?;
            fits("wind", "eddies", air.wind.eddies(), air.eddies.count())?;
        }
        if let Self::Flow(_, flow) = self {
            fits("surrounding flow", "elements", flow.elements(), elements)?;
        }
        Ok(())
    }

    /// Makes the samples around time 0, which clones made later share.
    pub(crate) fn prepare(&mut self) {
        match self {
            Self::Uniform(EddyWind { wind, .. })
            | Self::Flow(EddyWind { wind, .. }, _)
            | Self::Way(wind, _) => wind.prepare(),
        }
    }

    /// Forgets how the air was so far, before fibres start anew.
    pub(crate) fn forget(&mut self) {
        match self {
            Self::Uniform(_) => {}
            Self::Flow(_, flow) => flow.forget(),
            Self::Way(_, stations) => stations.forget(),
        }
    }

    /// Follows fibres that have grown at their roots and become shorter at their ends to so many elements.
    pub(crate) fn follow(&mut self, elements: usize, born: bool) {
        if let Self::Way(_, stations) = self {
            stations.follow(elements, born);
        }
    }

    /// Whether each element lies in the same eddy of another air of this kind.
    pub(crate) fn has_eddies_of(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Uniform(one), Self::Uniform(other)) => one.eddies == other.eddies,
            (Self::Flow(one, _), Self::Flow(other, _)) => one.eddies == other.eddies,
            (Self::Way(one, _), Self::Way(other, _)) => one.eddies() == other.eddies(),
            _ => false,
        }
    }

    /// Replaces the air by another one of the same kind and eddies.
    pub(crate) fn change(&mut self, by: Self) {
        match (self, by) {
            (Self::Flow(air, flow), Self::Flow(new_air, new_flow)) => {
                *air = new_air;
                flow.change(new_flow);
            }
            (Self::Way(wind, stations), Self::Way(new_wind, new_stations)) => {
                *wind = new_wind;
                stations.change(new_stations);
            }
            (air, by) => *air = by,
        }
    }

    /// Share of the time that the elements of the fibre in a lane have spent outside the given flow. `None` in uniform air.
    pub(crate) fn outside(&self, lane: usize) -> Option<f64> {
        match self {
            Self::Uniform(_) => None,
            Self::Flow(_, flow) => Some(flow.outside(lane)),
            Self::Way(_, stations) => stations.outside(lane),
        }
    }
}
