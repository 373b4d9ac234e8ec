//! The force of a fed fibre on its air, on the way from the inlet to the belt.

use super::momentum::{MomentumBalance, NodeStates};
use super::{
    Declaration, FIBRE, Figure, Kind, MILLINEWTONS, Measure, Observation, Observer, RATIO, Value, fed, figure,
};
use crate::chain::schemes::Scheme;
use crate::flight::Flight;
use crate::lanes::WIDTH;

/// Name of the measure.
pub const FORCE_ON_AIR: &str = "force_on_air";

/// Name of the other one.
pub const FIBRE_ON_WAY: &str = "fibre_on_way";

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        Measure {
            name: FORCE_ON_AIR,
            column: "force_on_air_n",
            label: "Force on the air",
            meaning: "mean force along x with which the fibre drives the air between the inlet and each distance \
                from it: the drag on it turned round; negative where the air drives the fibre",
            unit: MILLINEWTONS,
            kind: Kind::Way,
            group: FIBRE,
            figure: &Figure {
                from_zero: false,
                caption: "Mean force with which the fibre drives the air between the inlet and a place. It falls \
                    where the air pulls the fibre along and rises where the fibre pulls the air.",
                ..figure("force_on_air", "Force on the air", "force on the air")
            },
            ..Measure::NUMBER
        },
        Measure {
            name: FIBRE_ON_WAY,
            column: "fibre_on_way",
            label: "Fibre per length of the way",
            meaning: "mean length of fibre per length of the way at each distance from the inlet; above one where \
                the fibre swings and folds",
            unit: RATIO,
            kind: Kind::Way,
            group: FIBRE,
            figure: &Figure {
                caption: "Mean length of fibre per length of the way from the inlet to the belt. It is above one \
                    where the fibre swings and folds.",
                ..figure("fibre_on_way", "Fibre per length of the way", "fibre per length of the way")
            },
            ..Measure::NUMBER
        },
    ],
    applies: fed,
    observer: |flight| Box::new(Balances::new(flight)),
};

/// The balances of the fibres of a flight.
#[derive(Debug)]
struct Balances {
    of_lanes: Vec<MomentumBalance>,
    tension_lag: f64,
}

impl Balances {
    fn new(flight: &Flight) -> Self {
        let lanes = (0..WIDTH).map_while(|lane| flight.case(lane));
        // A snapshot has its velocities at the time of its positions.
        let lags = flight.scheme() == Scheme::ImplicitTension;
        let tension_lag = if lags { flight.time_step() } else { 0.0 };
        Self { of_lanes: lanes.map(MomentumBalance::of).collect(), tension_lag }
    }
}

impl Observer for Balances {
    fn see(&mut self, observation: &Observation<'_>) {
        if !observation.settled {
            return;
        }
        let nodes = NodeStates::of(observation.snapshot, self.of_lanes.len(), self.tension_lag);
        MomentumBalance::see(&mut self.of_lanes, &nodes);
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let Some(balance) = self.of_lanes.get(lane) else { return Vec::new() };
        [balance.forces(), balance.lengths()].map(|values| Value::Curve(balance.places(), values)).into()
    }
}
