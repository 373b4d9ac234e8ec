//! Strain of the elements.

use super::{Declaration, FIBRE, Figure, Kind, Measure, Observer, Over, PERCENT, Seen, Value, fixed};
use crate::fibre::Root;
use crate::flight::Flight;
use crate::lanes::Lanes;
use crate::statistics::quantile;

/// The strain that does not depend on the time step.
pub(super) const USUAL: Declaration = Declaration {
    measures: &[measure(
        "strain_99",
        "Strain, 99 % of the time",
        "strain of the element at the root that is not exceeded for 99 % of the time after the spin-up. It is averaged \
         over the period of the slowest axial wave, 4 L √(density / Young's modulus), or over the output interval if \
         that is longer. It hardly depends on the time step; compare it with the strain that the polymer can take",
        Over::Mean,
        "99 % of the time",
    )],
    applies: |case| case.fibre.root != Root::Free,
    observer: |_| Box::new(Averaged::default()),
};

/// The extreme.
pub(super) const LARGEST: Declaration = Declaration {
    measures: &[measure(
        "max_strain",
        "Largest strain",
        "largest absolute strain of any element at all recorded instants, the start included. The fibre starts without \
         tension, so axial waves run along it at first. Implicit tension damps those that are fast compared with the \
         time step, and the value then decreases with the step; it also depends on duration and output interval",
        Over::Largest,
        "largest",
    )],
    applies: fixed,
    observer: |_| Box::new(Largest(Lanes::ZERO)),
};

const fn measure(
    name: &'static str,
    label: &'static str,
    meaning: &'static str,
    over_replicates: Over,
    series: &'static str,
) -> Measure {
    let figure = &Figure {
        name: "strain",
        title: "Strain",
        words: "strain",
        logarithmic: false,
        from_zero: true,
        caption: "",
    };
    let (column, unit, kind, group) = (name, PERCENT, Kind::Number, FIBRE);
    Measure { name, column, label, meaning, unit, kind, group, over_replicates, figure, series }
}

/// Strain at the root, averaged over some intervals between recorded instants.
#[derive(Debug, Default)]
struct Averaged {
    /// Times of the recorded instants after the spin-up [s], and the integral of the strain over time [s].
    integrals: Vec<(f64, Lanes)>,
}

impl Observer for Averaged {
    fn see(&mut self, seen: &Seen<'_>) {
        if seen.settled {
            self.integrals.push((seen.snapshot.time, seen.snapshot.root_strain_integral));
        }
    }

    fn finish(&self, lane: usize, flight: &Flight) -> Vec<Value> {
        let intervals = flight
            .case(lane)
            .map_or(1.0, |case| (case.fibre.axial_period() / case.run.output_interval()).round());
        // More intervals than the run has mean the whole run.
        let means = self.means(lane, intervals.clamp(1.0, 1e15) as usize);
        vec![Value::Number(quantile(&means, 0.99))]
    }
}

impl Averaged {
    /// The averages over some intervals that end at the recorded instants [-].       theory.md (57)
    fn means(&self, lane: usize, intervals: usize) -> Vec<f64> {
        let intervals = intervals.min(self.integrals.len().saturating_sub(1)).max(1);
        let mean = |((from, before), (to, after)): (&(f64, Lanes), &(f64, Lanes))| {
            (after.0[lane] - before.0[lane]) / (to - from)
        };
        let later = self.integrals.iter().skip(intervals);
        self.integrals.iter().zip(later).map(mean).collect()
    }
}

/// The largest so far [-].
#[derive(Debug)]
struct Largest(Lanes);

impl Observer for Largest {
    fn see(&mut self, seen: &Seen<'_>) {
        let now = seen.snapshot.energy.strain;
        self.0 = Lanes::from_fn(|lane| self.0.0[lane].max(now.0[lane]));
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        vec![Value::Number(self.0.0[lane])]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn analytic_an_average_over_its_period_removes_a_wave() {
        // A strain that rises from 0 to 1, and a wave on it with a period of ten intervals, as its integral.
        let wave = |i: u32| {
            let t = f64::from(i) * 1e-3;
            (t, Lanes::splat(0.5 * t * t - 3.0 * (TAU * t / 1e-2).cos() * 1e-2 / TAU))
        };
        let integrals: Vec<_> = (0..=1000).map(wave).collect();
        let found = |intervals, integrals: &[(f64, Lanes)]| {
            quantile(&Averaged { integrals: integrals.to_vec() }.means(3, intervals), 0.99)
        };
        // 99 % of the way from the first average, over 0 to 10 ms, to the last one, over 0.99 to 1 s.
        assert!((found(10, &integrals) - (0.005 + 0.99 * 0.99)).abs() < 1e-12);
        assert!(found(1, &integrals) > 3.0);
        // Longer than the run, and a run without an interval.
        assert!((found(usize::MAX, &integrals) - 0.5).abs() < 1e-12);
        assert!(found(10, &integrals[..1]).is_nan());
    }
}
