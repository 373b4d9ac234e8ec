//! Tension at the root.

use super::{Aggregate, Declaration, FIBRE, MILLINEWTONS, Measure, Observation, Observer, Value, figure};
use crate::fibre::Root;
use crate::flight::Flight;
use crate::lanes::Lanes;

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        TENSION
            .observed("root_tension", "root_tension_n", "Tension at the root, mean")
            .meaning("mean over time of the tension of the element at the root, at the recorded instants")
            .series("mean"),
        TENSION
            .observed("peak_root_tension", "peak_root_tension_n", "Tension at the root, peak")
            .meaning(
                "largest tension of the element at the root at the recorded instants. As with the \
                 largest strain, implicit tension makes it lower",
            )
            .aggregate(Aggregate::Largest)
            .series("peak"),
    ],
    applies: |case| case.fibre.root != Root::Free,
    observer: |_| {
        Box::new(RootTension { count: 0.0, sum: Lanes::ZERO, peak: Lanes::splat(f64::NEG_INFINITY) })
    },
};

const TENSION: Measure = Measure {
    unit: MILLINEWTONS,
    group: FIBRE,
    figure: &figure("root_tension", "Tension at the root", "tension at the root"),
    ..Measure::NUMBER
};

/// Tension of the elements at the root after the spin-up [N].
#[derive(Debug)]
struct RootTension {
    count: f64,
    sum: Lanes,
    peak: Lanes,
}

impl Observer for RootTension {
    fn see(&mut self, observation: &Observation<'_>) {
        if let (true, Some(&tension)) = (observation.settled, observation.snapshot.tension.first()) {
            self.count += 1.0;
            self.sum = self.sum + tension;
            self.peak = Lanes::from_fn(|lane| self.peak.0[lane].max(tension.0[lane]));
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        vec![Value::Number(self.sum.0[lane] / self.count), Value::Number(self.peak.0[lane])]
    }
}
