//! What is known of the nodes of fibres at one instant.

use crate::chain::schemes::Scheme;
use crate::flight::{Flight, Snapshot};
use crate::lanes::{Lanes, WIDTH};
use crate::vec3::Vec3;

/// What is known of the nodes of eight fibres at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NodeStates<'a> {
    /// Of the nodes [m, m/s].
    pub(crate) position: &'a [Vec3<Lanes>],
    pub(crate) velocity: &'a [Vec3<Lanes>],
    /// Of the elements [N].
    pub(crate) tension: &'a [Lanes],
    /// Of the elements [N]; empty if it is not known.
    pub(crate) drag: &'a [Vec3<Lanes>],
    /// Number of nodes in each lane.
    pub(crate) count: [usize; WIDTH],
    /// By how much earlier than the positions the velocities are known, the tensions, and the drag [s].
    pub(crate) velocity_lag: f64,
    pub(crate) tension_lag: f64,
    pub(crate) drag_lag: f64,
}

impl<'a> NodeStates<'a> {
    /// Those of a flight between two steps, as its scheme keeps them.
    ///
    /// * `tension`, `drag` – of the elements
    /// * `is_wanted` – whether to look at the fibre in a lane
    pub(crate) fn between_steps(
        flight: &'a Flight,
        (tension, drag): (&'a [Lanes], &'a [Vec3<Lanes>]),
        is_wanted: impl Fn(usize) -> bool,
    ) -> Self {
        let (chain, count) = (flight.chain(), flight.chain().nodes());
        let lag = |lags: bool, steps: f64| if lags { steps * flight.time_step() } else { 0.0 };
        Self {
            position: &chain.position,
            velocity: &chain.velocity,
            tension,
            drag,
            count: std::array::from_fn(|lane| if is_wanted(lane) { count[lane] } else { 0 }),
            velocity_lag: lag(flight.scheme().is_staggered(), 0.5),
            tension_lag: lag(flight.scheme() == Scheme::ImplicitTension, 1.0),
            drag_lag: flight.time_step(),
        }
    }

    /// Those of a snapshot, which has its velocities at the time of its positions.
    ///
    /// * `fibres` – number of fibres; the lanes after the last one repeat the first
    pub(crate) fn of(snapshot: &'a Snapshot, fibres: usize, tension_lag: f64) -> Self {
        Self {
            position: &snapshot.position,
            velocity: &snapshot.velocity,
            tension: &snapshot.tension,
            drag: &snapshot.drag,
            count: std::array::from_fn(|lane| if lane < fibres { snapshot.nodes[lane] } else { 0 }),
            velocity_lag: 0.0,
            tension_lag,
            drag_lag: 0.0,
        }
    }
}
