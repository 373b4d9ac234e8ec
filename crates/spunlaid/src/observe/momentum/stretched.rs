//! The balance of fibres that fly in one air, in stretches of time.

use super::{MomentumBalance, NodeStates};
use crate::case::Case;
use crate::load::WayPlace;
use crate::statistics::Estimate;

/// Length of a stretch of time that is independent of the next, in times from the inlet to the belt.
const WAYS_OF_STRETCH: f64 = 2.0;

/// Balances of one or more fibres of a case in stretches of time, one after the other.
///
/// Fibres that fly in one air are not independent of each other, but their stretches are, if these are long enough.
#[derive(Clone, Debug)]
pub(crate) struct StretchedBalance {
    stretch: f64,
    empty: MomentumBalance,
    stretches: Vec<MomentumBalance>,
}

impl StretchedBalance {
    pub(crate) fn new(case: &Case) -> Self {
        let way = case.line.map_or(f64::NAN, |line| line.distance / line.feed_speed);
        let empty = MomentumBalance::of(case);
        Self { stretch: WAYS_OF_STRETCH * way, empty, stretches: Vec::new() }
    }

    /// Adds an instant of all lanes.
    ///
    /// * `time` – since the end of the spin-up [s]; nothing is added before
    pub(crate) fn see(&mut self, nodes: &NodeStates<'_>, time: f64) {
        if time < 0.0 {
            return;
        }
        let stretch = (time / self.stretch) as usize;
        self.reach(stretch + 1);
        MomentumBalance::see(&mut self.stretches[stretch..=stretch], nodes);
    }

    /// Adds what other fibres have done during the same time.
    pub(crate) fn add(&mut self, other: &Self) {
        self.reach(other.stretches.len());
        self.stretches.iter_mut().zip(&other.stretches).for_each(|(all, other)| all.add(other));
    }

    fn reach(&mut self, stretches: usize) {
        if self.stretches.len() < stretches {
            self.stretches.resize(stretches, self.empty.clone());
        }
    }

    /// Means and standard errors over the stretches; empty without one. The last one is left out if it is not
    /// whole.
    pub(crate) fn way(&self) -> Vec<WayPlace> {
        let fullest = self.stretches.iter().map(|balance| balance.instants).fold(0.0, f64::max);
        let whole = || self.stretches.iter().filter(|balance| balance.instants > 0.9 * fullest);
        let all: Vec<[Vec<f64>; 2]> = whole().map(|balance| [balance.forces(), balance.lengths()]).collect();
        let at = |(class, distance): (usize, f64)| {
            let values =
                |which: usize| all.iter().filter_map(move |of| of[which].get(class).copied()).collect();
            let [force, fibre] = [0, 1].map(|which| Estimate::new(values(which)));
            WayPlace { distance, force: force.mean, standard_error: force.standard_error, fibre: fibre.mean }
        };
        let places = whole().next().map(MomentumBalance::places).unwrap_or_default();
        places.into_iter().enumerate().map(at).collect()
    }
}
