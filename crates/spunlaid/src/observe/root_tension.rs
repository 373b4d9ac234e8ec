//! Tension at the root.

use super::{Declaration, FIBRE, Figure, Kind, MILLINEWTONS, Measure, Observer, Over, Seen, Value};
use crate::fibre::Root;
use crate::flight::Flight;
use crate::lanes::Lanes;

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        measure(
            "root_tension",
            "root_tension_n",
            "Tension at the root, mean",
            "mean over time of the tension of the element at the root, at the recorded instants",
            Over::Mean,
            "mean",
        ),
        measure(
            "peak_root_tension",
            "peak_root_tension_n",
            "Tension at the root, peak",
            "largest tension of the element at the root at the recorded instants. As with the largest strain, implicit tension \
             makes it lower",
            Over::Largest,
            "peak",
        ),
    ],
    applies: |case| case.fibre.root != Root::Free,
    observer: |_| {
        Box::new(RootTension { count: 0.0, sum: Lanes::ZERO, peak: Lanes::splat(f64::NEG_INFINITY) })
    },
};

const fn measure(
    name: &'static str,
    column: &'static str,
    label: &'static str,
    meaning: &'static str,
    over_replicates: Over,
    series: &'static str,
) -> Measure {
    let figure = &Figure {
        name: "root_tension",
        title: "Tension at the root",
        words: "tension at the root",
        logarithmic: false,
        from_zero: true,
        caption: "",
    };
    let (unit, kind, group) = (MILLINEWTONS, Kind::Number, FIBRE);
    Measure { name, column, label, meaning, unit, kind, group, over_replicates, figure, series }
}

/// Tension of the elements at the root after the spin-up [N].
#[derive(Debug)]
struct RootTension {
    count: f64,
    sum: Lanes,
    peak: Lanes,
}

impl Observer for RootTension {
    fn see(&mut self, seen: &Seen<'_>) {
        if let (true, Some(&tension)) = (seen.settled, seen.snapshot.tension.first()) {
            self.count += 1.0;
            self.sum = self.sum + tension;
            self.peak = Lanes::from_fn(|lane| self.peak.0[lane].max(tension.0[lane]));
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        vec![Value::Number(self.sum.0[lane] / self.count), Value::Number(self.peak.0[lane])]
    }
}
