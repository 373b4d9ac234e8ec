//! How far the elements are stretched.

use super::{Declaration, FIBRE, Figure, Kind, Measure, Observer, Over, PERCENT, Seen, Value, always};
use crate::flight::Flight;
use crate::lanes::Lanes;

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[Measure {
        name: "max_strain",
        column: "max_strain",
        label: "Largest strain",
        meaning: "largest strain of any element, by size, at the recorded instants",
        unit: PERCENT,
        kind: Kind::Number,
        group: FIBRE,
        over_replicates: Over::Largest,
        figure: &Figure {
            name: "max_strain",
            title: "Largest strain",
            words: "largest strain",
            logarithmic: false,
            from_zero: true,
            caption: "",
        },
        series: "strain",
    }],
    applies: always,
    observer: |_| Box::new(Strain(Lanes::ZERO)),
};

/// The largest so far [-].
#[derive(Debug)]
struct Strain(Lanes);

impl Observer for Strain {
    fn see(&mut self, seen: &Seen<'_>) {
        let now = seen.snapshot.energy.strain;
        self.0 = Lanes::from_fn(|lane| self.0.0[lane].max(now.0[lane]));
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        vec![Value::Number(self.0.0[lane])]
    }
}
