//! The errors of the two energy checks.

use super::{Declaration, ENERGY, FibreMeasure, Observation, Observer, Sample, always};
use spunlaid_fibre::Flight;
use spunlaid_fibre::chain::Scheme;
use spunlaid_ground::measure::figure;
use spunlaid_ground::statistics::median;
use spunlaid_ground::{Aggregate, EvenSample, Figure, Measure, MeasureKind, OF_PERCENT, Value, WIDTH};

/// The paper's work check. Under implicit tension it does not apply: there it is tens of per cent where the amplitudes
/// agree with those of the other schemes.
pub(super) const WORK: Declaration = Declaration {
    measures: &[
        TYPICAL
            .observed("work_error", "work_error_percent", "Work check, typical")
            .meaning(
                "the paper’s work check: work of all forces against kinetic energy; median over time, \
                 the spin-up included. It shows only whether the steps are short enough for the \
                 motion",
            )
            .series("work check"),
        AT_END
            .observed("work_error_at_end", "work_error_at_end_percent", "Work check, at the end")
            .meaning("the work check at the end of the run")
            .series("work check"),
        OVER_TIME
            .observed("work_error_over_time", "work_error_over_time_percent", "Work check over time")
            .series("work check"),
    ],
    applies: |case| case.line.is_none() && case.run.scheme != Scheme::ImplicitTension,
    observer: |_| Errors::observer(Sample::work_error_percent, true),
};

/// The full energy balance.
pub(super) const BALANCE: Declaration = Declaration {
    measures: &[
        TYPICAL
            .observed("balance_error", "balance_error_percent", "Full balance, typical")
            .meaning(
                "error of the full balance over the energy that flowed in or out; median over time, \
                 the spin-up included. It would show a wrong force",
            )
            .series("full balance"),
        AT_END
            .observed("balance_error_at_end", "balance_error_at_end_percent", "Full balance, at the end")
            .meaning("the full balance at the end of the run")
            .series("full balance"),
        OVER_TIME
            .observed("balance_error_over_time", "balance_error_over_time_percent", "Full balance over time")
            .series("full balance"),
    ],
    applies: always,
    observer: |_| Errors::observer(Sample::balance_error_percent, true),
};

/// Energy that the scheme takes out of the motion.
pub(super) const DISSIPATION: Declaration = Declaration {
    measures: &[
        TAKEN_OUT
            .observed(
                "tension_dissipation",
                "tension_dissipation_percent",
                "Axial waves damped by the scheme",
            )
            .meaning(
                "energy that the scheme has removed from axial waves, over the energy that flowed; median over \
                 time. It is not an error: the full balance includes it",
            )
            .aggregate(Aggregate::Median)
            .series("typical"),
        TAKEN_OUT
            .observed(
                "tension_dissipation_at_end",
                "tension_dissipation_at_end_percent",
                "Axial waves damped, at the end",
            )
            .meaning("the same at the end of the run")
            .series("at the end"),
    ],
    applies: |case| case.run.scheme == Scheme::ImplicitTension,
    observer: |_| Errors::observer(Sample::tension_dissipation_percent, false),
};

const TYPICAL: FibreMeasure = Measure { aggregate: Aggregate::Median, figure: &FIGURE, ..ERROR };

const AT_END: FibreMeasure = Measure {
    figure: &Figure {
        name: "energy_error_at_end",
        title: "Energy error at the end",
        words: "energy error at the end",
        ..FIGURE
    },
    ..ERROR
};

const OVER_TIME: FibreMeasure = Measure {
    meaning: "the error at up to 4096 recorded instants; not defined at rest",
    kind: MeasureKind::Series,
    figure: &Figure {
        name: "energy_errors",
        title: "Energy errors over time",
        words: "energy errors",
        caption: "Errors of the energy checks over time.",
        ..FIGURE
    },
    ..ERROR
};

const TAKEN_OUT: FibreMeasure = Measure {
    figure: &figure("tension_dissipation", "Axial waves damped by the scheme", "dissipation of the scheme"),
    ..ERROR
};

const ERROR: FibreMeasure = Measure { unit: OF_PERCENT, group: ENERGY, ..Measure::NUMBER };

const FIGURE: Figure =
    Figure { logarithmic: true, from_zero: false, ..figure("energy_error", "Energy error", "energy error") };

/// An error at the recorded instants.
#[derive(Debug)]
struct Errors {
    /// The error of a sample [%].
    error: fn(&Sample) -> f64,
    /// Whether it is drawn over time.
    drawn: bool,
    times: EvenSample<f64>,
    /// By lane [%].
    percent: [EvenSample<f64>; WIDTH],
    /// The newest [%].
    newest: [f64; WIDTH],
}

/// Most instants that are drawn over time.
const DRAWN: usize = 1 << 12;

impl Errors {
    fn observer(error: fn(&Sample) -> f64, drawn: bool) -> Box<dyn Observer> {
        let (times, percent) = Default::default();
        Box::new(Self { error, drawn, times, percent, newest: [f64::NAN; WIDTH] })
    }
}

impl Observer for Errors {
    fn see(&mut self, observation: &Observation<'_>) {
        self.times.push(observation.snapshot.time);
        for ((percent, newest), sample) in
            self.percent.iter_mut().zip(&mut self.newest).zip(observation.samples)
        {
            *newest = (self.error)(sample);
            percent.push(*newest);
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let percent = self.percent[lane].values();
        let mut values = vec![Value::Number(median(percent)), Value::Number(self.newest[lane])];
        if self.drawn {
            let drawn = |all: &[f64]| all.iter().copied().step_by(all.len().div_ceil(DRAWN).max(1)).collect();
            values.push(Value::Curve(drawn(self.times.values()), drawn(percent)));
        }
        values
    }
}
