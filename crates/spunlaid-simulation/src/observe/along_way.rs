//! Speed and tension of a fed fibre on its way from the inlet to the belt.

use super::momentum::{MomentumBalance, NodeStates, tension_lag};
use super::{Declaration, FIBRE, Observation, Observer, fed, number_of_each};
use spunlaid_fibre::Flight;
use spunlaid_ground::measure::figure;
use spunlaid_ground::{Figure, MILLINEWTONS, Measure, MeasureKind, RATIO, Unit, Value, WIDTH};

/// Classes of distance from the inlet.
const CLASSES: usize = 50;

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        Measure {
            name: "speed_along_way",
            column: "speed_along_way_m_s",
            label: "Speed on the way",
            meaning: "mean velocity of the fibre along x at each distance from the inlet",
            unit: Unit { shown: "m/s", per_si: 1.0 },
            kind: MeasureKind::Way,
            group: FIBRE,
            figure: &Figure {
                from_zero: false,
                caption: "Mean velocity of the fibre towards the belt. It is below the feed speed where \
                    the fibre oscillates and folds.",
                ..figure("speed_along_way", "Velocity towards the belt", "velocity towards the belt")
            },
            ..Measure::NUMBER
        },
        Measure {
            name: "tension_along_way",
            column: "tension_along_way_n",
            label: "Tension on the way",
            meaning: "mean tension at each distance from the inlet; negative in compression",
            unit: MILLINEWTONS,
            kind: MeasureKind::Way,
            group: FIBRE,
            figure: &Figure {
                from_zero: false,
                caption: "Mean tension of the fibre on its way to the belt.",
                ..figure("tension_along_way", "Tension", "tension")
            },
            ..Measure::NUMBER
        },
    ],
    applies: fed,
    observer: |flight| Box::new(Way::new(flight)),
};

/// Sums over the elements in each class of distance.
#[derive(Debug)]
struct Way {
    distance: [f64; WIDTH],
    /// Count, sum of the velocity and of the tension, for each lane and class.
    classes: Vec<[[f64; 3]; CLASSES]>,
}

impl Way {
    fn new(flight: &Flight) -> Self {
        let distance = number_of_each(flight, |case| case.line.map_or(f64::NAN, |line| line.distance));
        Self { distance, classes: vec![[[0.0; 3]; CLASSES]; WIDTH] }
    }
}

impl Observer for Way {
    fn see(&mut self, observation: &Observation<'_>) {
        if !observation.settled {
            return;
        }
        let snapshot = observation.snapshot;
        for (lane, classes) in self.classes.iter_mut().enumerate() {
            let elements = snapshot.in_air[lane].min(snapshot.tension.len());
            for (j, tension) in snapshot.tension.iter().enumerate().take(elements) {
                let x = 0.5 * (snapshot.position[j].x.0[lane] + snapshot.position[j + 1].x.0[lane]);
                let class = x / self.distance[lane] * CLASSES as f64;
                if (0.0..CLASSES as f64).contains(&class) {
                    let v = 0.5 * (snapshot.velocity[j].x.0[lane] + snapshot.velocity[j + 1].x.0[lane]);
                    let [count, velocity, force] = &mut classes[class as usize];
                    *count += 1.0;
                    *velocity += v;
                    *force += tension.0[lane];
                }
            }
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let classes = &self.classes[lane];
        let at = |i: usize| (i as f64 + 0.5) / CLASSES as f64 * self.distance[lane];
        let curve = |which: usize| {
            let places = (0..CLASSES).map(at).collect();
            Value::Curve(places, classes.iter().map(|sums| sums[which] / sums[0]).collect())
        };
        vec![curve(1), curve(2)]
    }
}

/// Name of the measure.
pub(crate) const FORCE_ON_AIR: &str = "force_on_air";

/// Name of the other one.
pub(crate) const FIBRE_ON_WAY: &str = "fibre_on_way";

pub(super) const FORCES: Declaration = Declaration {
    measures: &[
        Measure {
            name: FORCE_ON_AIR,
            column: "force_on_air_n",
            label: "Force on the air",
            meaning: "mean force of the fibre on the air along x between the inlet and each distance",
            unit: MILLINEWTONS,
            kind: MeasureKind::Way,
            group: FIBRE,
            figure: &Figure {
                from_zero: false,
                caption: "Mean force with which the fibre drives the air between the inlet and a position. It falls \
                    where the air pulls the fibre along and rises where the fibre pulls the air.",
                ..figure("force_on_air", "Force on the air", "force on the air")
            },
            ..Measure::NUMBER
        },
        Measure {
            name: FIBRE_ON_WAY,
            column: "fibre_on_way",
            label: "Fibre per length of the way",
            meaning: "mean length of fibre per length of the way; above one where the fibre oscillates and folds",
            unit: RATIO,
            kind: MeasureKind::Way,
            group: FIBRE,
            figure: &Figure {
                caption: "Mean length of fibre per length of the way from the inlet to the belt. It is \
                    above one where the fibre oscillates and folds.",
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
        Self { of_lanes: lanes.map(MomentumBalance::of).collect(), tension_lag: tension_lag(flight) }
    }
}

impl Observer for Balances {
    fn see(&mut self, observation: &Observation<'_>) {
        if !observation.settled {
            return;
        }
        let nodes = NodeStates::of(observation.snapshot, self.tension_lag, |lane| lane < self.of_lanes.len());
        MomentumBalance::see(&mut self.of_lanes, &nodes);
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let Some(balance) = self.of_lanes.get(lane) else { return Vec::new() };
        [balance.forces(), balance.lengths()].map(|values| Value::Curve(balance.places(), values)).into()
    }
}
