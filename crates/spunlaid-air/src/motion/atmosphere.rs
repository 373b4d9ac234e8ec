//! The kinds of air in which fibres fly, and the velocity that each gives at their elements.
//!
//! ```text
//! look   once a step: the time and the places of the nodes → Velocities
//! run    once a block of elements: a task that asks for the velocity at each
//! ```
//!
//! The kernel asks for velocities whatever the kind of air. A kind is a variant of both types here, and what
//! it looks at is its own: it may belong to one flight, or be a handle to what many flights read. Velocities
//! that are all written into a buffer beforehand cost up to a seventh of a step: the signals of many eddies
//! do not fit into the first-level cache.

use super::in_space::InstantStations;
use super::surroundings::InstantFlow;
use super::wind::EddyVelocities;
use super::{AirInSpace, Eddies, Stations, Surroundings, Wind};
use spunlaid_ground::{Lanes, Register, Vec3, Wide};

/// The air in which up to eight fibres fly.
// A flight has one, so its size does not matter.
#[allow(clippy::large_enum_variant)]
#[derive(Clone, Debug)]
pub enum Atmosphere {
    /// Eddies in a flow that is the same everywhere.
    Uniform(EddyWind),
    /// Eddies in a flow that differs from place to place. Their wind has the mean zero and the rms one.
    Flow(EddyWind, Surroundings),
    /// The air along the way of fed fibres, with a signal for each station.
    Way(Wind, Stations),
    /// Fields of eddies in space, which fibres side by side may share.
    Space(AirInSpace),
}

/// The velocities of the air at the elements at one instant.
pub enum Velocities<'a, S: Register> {
    /// Of eddies in air that is the same everywhere.
    Uniform(InstantEddies<'a, S>),
    /// Of eddies, and of the mean flow around the fibre.
    Flow(InstantEddies<'a, S>, InstantFlow<'a, S>),
    /// Of eddies that change on the way of the air.
    Way(InstantStations<'a, S>),
}

/// Gives the velocity of the air at each element.
pub trait VelocityAt<S: Register> {
    /// Velocity of the air at element `j` [m/s].
    ///
    /// * `last` – the eddy of the element before, and its velocity
    fn at(&self, j: usize, last: &mut LastEddy<S>) -> Vec3<Wide<S>>;
}

/// Work that needs the velocities at many elements.
pub trait VelocityTask<S: Register> {
    /// Does it.
    fn call(self, air: &impl VelocityAt<S>);
}

impl<S: Register> Velocities<'_, S> {
    /// Does a task, compiled for each kind of air. A kernel that asks for the kind at each element is slower
    /// by a twentieth.
    #[inline(always)]
    pub fn run(&self, task: impl VelocityTask<S>) {
        match self {
            Self::Uniform(eddies) => task.call(eddies),
            Self::Flow(eddies, flow) => task.call(&(eddies, flow)),
            Self::Way(elements) => task.call(elements),
        }
    }
}

impl<S: Register> VelocityAt<S> for InstantEddies<'_, S> {
    #[inline(always)]
    fn at(&self, j: usize, last: &mut LastEddy<S>) -> Vec3<Wide<S>> {
        self.at(j, last)
    }
}

impl<S: Register> VelocityAt<S> for (&InstantEddies<'_, S>, &InstantFlow<'_, S>) {
    #[inline(always)]
    fn at(&self, j: usize, last: &mut LastEddy<S>) -> Vec3<Wide<S>> {
        self.1.carried(j, self.0.at(j, last))
    }
}

impl<S: Register> VelocityAt<S> for InstantStations<'_, S> {
    #[inline(always)]
    fn at(&self, j: usize, _: &mut LastEddy<S>) -> Vec3<Wide<S>> {
        self.at(j)
    }
}

/// An instant of a flight.
#[derive(Clone, Copy, Debug)]
pub struct Instant {
    /// Number of steps done.
    pub step: u64,
    /// Time since the start [s].
    pub time: f64,
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
    pub fn look<S: Register>(&mut self, now: Instant, position: &[Vec3<Lanes>]) -> Velocities<'_, S> {
        let Instant { step, time } = now;
        match self {
            Self::Uniform(air) => Velocities::Uniform(air.look(time)),
            Self::Flow(air, flow) => Velocities::Flow(air.look(time), flow.look(step, position)),
            Self::Way(wind, stations) => Velocities::Way(stations.look(step, time, wind, position)),
            Self::Space(air) => Velocities::Way(air.look(step, time, position)),
        }
    }

    /// Velocity of the air at element `j` of fed fibres, as the last step has felt it [m/s]; None of other fibres, and
    /// beyond the last element.
    ///
    /// * `step` – number of that step, from 0
    pub fn felt(&self, j: usize, step: u64) -> Option<Vec3<Lanes>> {
        match self {
            Self::Way(_, Stations { elements, .. }) | Self::Space(AirInSpace { elements, .. }) => {
                elements.velocity(j, step)
            }
            Self::Uniform(_) | Self::Flow(..) => None,
        }
    }

    /// Makes the samples around time 0, which clones made later share.
    pub fn prepare(&mut self) {
        match self {
            Self::Uniform(EddyWind { wind, .. })
            | Self::Flow(EddyWind { wind, .. }, _)
            | Self::Way(wind, _) => wind.prepare(),
            // Made at the first look.
            Self::Space(_) => {}
        }
    }

    /// Forgets how the air was so far, before fibres start again.
    pub fn forget(&mut self) {
        match self {
            Self::Uniform(_) => {}
            Self::Flow(_, flow) => flow.forget(),
            Self::Way(_, Stations { elements, .. }) | Self::Space(AirInSpace { elements, .. }) => {
                elements.forget();
            }
        }
    }

    /// Follows fibres that have grown at their roots and become shorter at their ends to so many elements.
    pub fn follow(&mut self, elements: usize, born: bool) {
        if let Self::Way(_, Stations { elements: air, .. }) | Self::Space(AirInSpace { elements: air, .. }) =
            self
        {
            air.follow(elements, born);
        }
    }

    /// Whether each element lies in the same eddy of another air of this kind.
    pub fn has_eddies_of(&self, other: &Self) -> bool {
        // Along a way it is enough that there are as many stations.
        fn eddies(air: &Atmosphere) -> (Option<&Eddies>, usize) {
            match air {
                Atmosphere::Uniform(air) | Atmosphere::Flow(air, _) => (Some(&air.eddies), 0),
                Atmosphere::Way(wind, _) => (None, wind.eddies()),
                Atmosphere::Space(_) => (None, 0),
            }
        }
        std::mem::discriminant(self) == std::mem::discriminant(other) && eddies(self) == eddies(other)
    }

    /// Replaces the air by another one of the same kind and eddies.
    pub fn change(&mut self, by: Self) {
        match (self, by) {
            (Self::Flow(air, flow), Self::Flow(new_air, new_flow)) => {
                *air = new_air;
                flow.change(new_flow);
            }
            (Self::Way(wind, stations), Self::Way(new_wind, new_stations)) => {
                *wind = new_wind;
                stations.change(new_stations);
            }
            (Self::Space(air), Self::Space(by)) => air.change(by),
            (air, by) => *air = by,
        }
    }

    /// Share of the time that the elements of the fibre in a lane have spent outside the given flow. `None`
    /// in uniform air.
    pub fn outside(&self, lane: usize) -> Option<f64> {
        match self {
            Self::Uniform(_) => None,
            Self::Flow(_, flow) => Some(flow.outside(lane)),
            Self::Way(_, Stations { elements, .. }) | Self::Space(AirInSpace { elements, .. }) => {
                elements.outside(lane)
            }
        }
    }
}

/// The wind of eddies, and which element lies in which of them.
#[derive(Clone, Debug)]
pub struct EddyWind {
    /// Which element lies in which eddy.
    pub eddies: Eddies,
    /// The wind in each eddy.
    pub wind: Wind,
}

impl EddyWind {
    /// Looks at the wind at a time [s].
    #[inline(always)]
    pub(super) fn look<S: Register>(&mut self, time: f64) -> InstantEddies<'_, S> {
        InstantEddies { now: self.wind.blow(time), of_element: self.eddies.index_of_element() }
    }
}

/// The wind of eddies at one instant.
pub struct InstantEddies<'a, S: Register> {
    now: EddyVelocities<'a, S>,
    /// The eddy of each element.
    of_element: &'a [u32],
}

/// The last eddy that was asked for, and its velocity [m/s].
pub struct LastEddy<S: Register>(u32, Vec3<Wide<S>>);

impl<S: Register> LastEddy<S> {
    /// Before any eddy was asked for.
    #[inline(always)]
    pub fn none() -> Self {
        // No eddy has this number.
        Self(u32::MAX, Vec3::zero())
    }
}

impl<S: Register> InstantEddies<'_, S> {
    /// The wind at element `j`.
    #[inline(always)]
    pub(super) fn at(&self, j: usize, last: &mut LastEddy<S>) -> Vec3<Wide<S>> {
        let eddy = self.of_element[j];
        if eddy != last.0 {
            *last = LastEddy(eddy, self.now.velocity(eddy));
        }
        last.1
    }
}
