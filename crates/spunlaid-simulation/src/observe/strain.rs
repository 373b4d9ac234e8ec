//! Strain of the fibre, tension at its root, and its time outside the given flow.

use super::{Declaration, FIBRE, FibreMeasure, Observation, Observer, fixed, number_of_each};
use spunlaid_air::Flow;
use spunlaid_fibre::{Flight, Root};
use spunlaid_ground::measure::figure;
use spunlaid_ground::statistics::quantile;
use spunlaid_ground::{Aggregate, EvenSample, Figure, Lanes, MILLINEWTONS, Measure, PERCENT, Value, WIDTH};
use std::collections::VecDeque;

/// The strain that does not depend on the time step.
pub(super) const USUAL: Declaration = Declaration {
    measures: &[Measure {
        is_main: true,
        ..measure(
            "strain_99",
            "Strain, 99 % of the time",
            "strain at the root, averaged over the period of the slowest axial wave, 4 L √(density / Young's \
             modulus), or a longer output interval, that is not exceeded during 99 % of the time after the spin-up. \
             Compare it with the limit of the polymer",
            Aggregate::Mean,
            "99 % of the time",
        )
    }],
    applies: |case| case.fibre.root != Root::Free,
    observer: |flight| Box::new(AveragedStrain::new(flight)),
};

/// The extreme.
pub(super) const LARGEST: Declaration = Declaration {
    measures: &[measure(
        "max_strain",
        "Largest strain",
        "largest absolute strain of any element, including the start with its axial waves. It depends on duration \
         and output interval, and with implicit tension on the time step",
        Aggregate::Largest,
        "largest",
    )],
    applies: fixed,
    observer: |_| Box::new(Largest(Lanes::ZERO)),
};

const fn measure(
    name: &'static str,
    label: &'static str,
    meaning: &'static str,
    aggregate: Aggregate,
    series: &'static str,
) -> FibreMeasure {
    Measure {
        name,
        column: name,
        label,
        meaning,
        unit: PERCENT,
        group: FIBRE,
        aggregate,
        figure: &FIGURE,
        series,
        ..Measure::NUMBER
    }
}

const FIGURE: Figure = figure("strain", "Strain", "strain");

/// Strain at the root, averaged over some intervals that end at the recorded instants after the spin-up.
///                                                                                             theory.md (57)
#[derive(Debug)]
struct AveragedStrain {
    /// Number of intervals over which is averaged, of each fibre.
    intervals: [usize; WIDTH],
    /// Times of the first and the last recorded instants [s], and the integral of the strain over time [s]:
    /// as many of the last as the longest average needs. The period of an axial wave is a few times as many
    /// stable steps as there are elements.
    first: Option<StrainIntegral>,
    last: VecDeque<StrainIntegral>,
    means: [EvenSample<f64>; WIDTH],
}

impl AveragedStrain {
    fn new(flight: &Flight) -> Self {
        let intervals =
            number_of_each(flight, |case| (case.fibre.axial_period() / case.run.output_interval()).round());
        // More intervals than the run has mean the whole run.
        Self::over_intervals(intervals.map(|intervals| intervals.clamp(1.0, 1e15) as usize))
    }

    fn over_intervals(intervals: [usize; WIDTH]) -> Self {
        Self { intervals, first: None, last: VecDeque::new(), means: Default::default() }
    }

    fn add(&mut self, now: StrainIntegral) {
        self.first.get_or_insert(now);
        for (lane, (intervals, means)) in self.intervals.iter().zip(&mut self.means).enumerate() {
            let before = self.last.len().checked_sub(*intervals).and_then(|at| self.last.get(at));
            if let Some(before) = before {
                means.push(mean(before, &now, lane));
            }
        }
        self.last.push_back(now);
        if self.last.len() > self.intervals.iter().copied().max().unwrap_or(0) {
            self.last.pop_front();
        }
    }

    /// The average that is not exceeded for 99 % of the time [-].
    fn usual(&self, lane: usize) -> f64 {
        match (self.means[lane].values(), self.first, self.last.back()) {
            ([], Some(first), Some(last)) if last.time > first.time => mean(&first, last, lane),
            (means, ..) => quantile(means, 0.99),
        }
    }
}

/// The integral of the strain over time, up to an instant.
#[derive(Clone, Copy, Debug)]
struct StrainIntegral {
    /// The instant [s].
    time: f64,
    /// [s].
    sum: Lanes,
}

/// Mean strain between two instants [-].
fn mean(from: &StrainIntegral, to: &StrainIntegral, lane: usize) -> f64 {
    (to.sum.0[lane] - from.sum.0[lane]) / (to.time - from.time)
}

impl Observer for AveragedStrain {
    fn see(&mut self, observation: &Observation<'_>) {
        if observation.settled {
            let snapshot = observation.snapshot;
            self.add(StrainIntegral { time: snapshot.time, sum: snapshot.root_strain_integral });
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        vec![Value::Number(self.usual(lane))]
    }
}

/// The largest so far [-].
#[derive(Debug)]
struct Largest(Lanes);

impl Observer for Largest {
    fn see(&mut self, observation: &Observation<'_>) {
        let now = observation.snapshot.energy.strain;
        self.0 = Lanes::from_fn(|lane| self.0.0[lane].max(now.0[lane]));
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        vec![Value::Number(self.0.0[lane])]
    }
}

pub(super) const ROOT_TENSION: Declaration = Declaration {
    measures: &[
        TENSION
            .observed("root_tension", "root_tension_n", "Tension at the root, mean")
            .meaning("mean over time of the tension of the element at the root")
            .series("mean"),
        TENSION
            .observed("peak_root_tension", "peak_root_tension_n", "Tension at the root, peak")
            .meaning("largest tension of the element at the root; implicit tension makes it lower")
            .aggregate(Aggregate::Largest)
            .series("peak"),
    ],
    applies: |case| case.fibre.root != Root::Free,
    observer: |_| {
        Box::new(RootTension { count: 0.0, sum: Lanes::ZERO, peak: Lanes::splat(f64::NEG_INFINITY) })
    },
};

const TENSION: FibreMeasure = Measure {
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

pub(super) const OUTSIDE_FLOW: Declaration = Declaration {
    measures: &[Measure {
        name: "share_outside_flow",
        column: "share_outside_flow",
        label: "Time outside the flow",
        meaning: "fraction of the time that elements spend outside the profile or the field, in the air \
             of the nearest point",
        unit: PERCENT,
        group: FIBRE,
        figure: &figure("share_outside_flow", "Time outside the flow", "time outside the flow"),
        series: "share",
        ..Measure::NUMBER
    }],
    // A profile reaches from the inlet to the belt as far as it was measured; a fed fibre does not leave it sideways.
    applies: |case| match case.air.flow {
        Flow::Uniform => false,
        Flow::Profile(_) => case.line.is_none(),
        Flow::Field(_) => true,
    },
    observer: |_| Box::new(Outside),
};

/// The flight itself counts how often it looks up the flow outside.
#[derive(Debug)]
struct Outside;

impl Observer for Outside {
    fn see(&mut self, _: &Observation<'_>) {}

    fn finish(&self, lane: usize, flight: &Flight) -> Vec<Value> {
        vec![Value::Number(flight.outside(lane).unwrap_or(f64::NAN))]
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
            // The other fibres average over other times.
            let mut averaged =
                AveragedStrain::over_intervals(std::array::from_fn(
                    |lane| if lane == 3 { intervals } else { 7 },
                ));
            integrals
                .iter()
                .for_each(|(time, integral)| averaged.add(StrainIntegral { time: *time, sum: *integral }));
            averaged.usual(3)
        };
        // 99 % of the way from the first average, over 0 to 10 ms, to the last one, over 0.99 to 1 s.
        assert!((found(10, &integrals) - (0.005 + 0.99 * 0.99)).abs() < 1e-12);
        assert!(found(1, &integrals) > 3.0);
        // Longer than the run, and a run without an interval.
        assert!((found(usize::MAX, &integrals) - 0.5).abs() < 1e-12);
        assert!(found(10, &integrals[..1]).is_nan());
    }
}
