//! The errors of the two energy checks.

use super::{
    Declaration, ENERGY, Figure, Kind, Measure, OF_PERCENT, Observer, Over, Sample, Seen, Value, always,
};
use crate::chain::schemes::Scheme;
use crate::flight::Flight;
use crate::lanes::WIDTH;
use crate::statistics::median;

/// The paper's work check. Under implicit tension it does not apply: there it is tens of per cent where the amplitudes
/// agree with those of the other schemes.
pub(super) const WORK: Declaration = Declaration {
    measures: &[
        number(
            "work_error",
            "work_error_percent",
            "Work check, typical",
            WORK_MEANING,
            Over::Median,
            &FIGURE,
            "work check",
        ),
        number(
            "work_error_at_end",
            "work_error_at_end_percent",
            "Work check, at the end",
            "the work check at the end of the flight",
            Over::Mean,
            &AT_END,
            "work check",
        ),
        series("work_error_over_time", "work_error_over_time_percent", "Work check over time", "work check"),
    ],
    applies: |case| case.run.scheme != Scheme::ImplicitTension,
    observer: |_| Errors::observer(Sample::work_error_percent, true),
};

/// The full energy balance.
pub(super) const BALANCE: Declaration = Declaration {
    measures: &[
        number(
            "balance_error",
            "balance_error_percent",
            "Full balance, typical",
            BALANCE_MEANING,
            Over::Median,
            &FIGURE,
            "energy balance",
        ),
        number(
            "balance_error_at_end",
            "balance_error_at_end_percent",
            "Full balance, at the end",
            "the full balance at the end of the flight",
            Over::Mean,
            &AT_END,
            "energy balance",
        ),
        series(
            "balance_error_over_time",
            "balance_error_over_time_percent",
            "Full balance over time",
            "energy balance",
        ),
    ],
    applies: always,
    observer: |_| Errors::observer(Sample::balance_error_percent, true),
};

/// Energy that the scheme takes out of the motion.
pub(super) const DISSIPATION: Declaration = Declaration {
    measures: &[
        number(
            "tension_dissipation",
            "tension_dissipation_percent",
            "Axial waves damped by the scheme",
            "energy that the scheme has taken out of the motion by damping axial waves, as a share of the air’s work; median \
             over time. It is no error: the full balance counts it",
            Over::Median,
            &TAKEN_OUT,
            "typical",
        ),
        number(
            "tension_dissipation_at_end",
            "tension_dissipation_at_end_percent",
            "Axial waves damped, at the end",
            "the same at the end of the flight",
            Over::Mean,
            &TAKEN_OUT,
            "at the end",
        ),
    ],
    applies: |case| case.run.scheme == Scheme::ImplicitTension,
    observer: |_| Errors::observer(Sample::tension_dissipation_percent, false),
};

const WORK_MEANING: &str = "the paper’s work check: difference between the work of all forces and the kinetic energy; median over time. It shows \
     only whether the steps are short against the motion";
const BALANCE_MEANING: &str = "error of the full energy balance, as a share of the air’s work; median over time. It would reveal a wrong force";

const FIGURE: Figure = Figure {
    name: "energy_error",
    title: "Energy error",
    words: "energy error",
    logarithmic: true,
    from_zero: false,
    caption: "",
};

const AT_END: Figure = Figure {
    name: "energy_error_at_end",
    title: "Energy error at the end",
    words: "energy error at the end",
    ..FIGURE
};

const TAKEN_OUT: Figure = Figure {
    name: "tension_dissipation",
    title: "Axial waves damped by the scheme",
    words: "dissipation of the scheme",
    logarithmic: false,
    from_zero: true,
    caption: "",
};

const OVER_TIME: Figure = Figure {
    name: "energy_errors",
    title: "Energy errors over time",
    words: "energy errors",
    logarithmic: true,
    from_zero: false,
    caption: "Errors of both energy checks over time, mean over the replicates. The shaded area reaches to the largest of any replicate.",
};

const fn number(
    name: &'static str,
    column: &'static str,
    label: &'static str,
    meaning: &'static str,
    over_replicates: Over,
    figure: &'static Figure,
    series: &'static str,
) -> Measure {
    let (unit, kind, group) = (OF_PERCENT, Kind::Number, ENERGY);
    Measure { name, column, label, meaning, unit, kind, group, over_replicates, figure, series }
}

const fn series(
    name: &'static str,
    column: &'static str,
    label: &'static str,
    series: &'static str,
) -> Measure {
    let meaning = "the error at each recorded instant; not defined at rest";
    let (unit, kind, group, figure) = (OF_PERCENT, Kind::Series, ENERGY, &OVER_TIME);
    Measure { name, column, label, meaning, unit, kind, group, over_replicates: Over::Mean, figure, series }
}

/// An error at the recorded instants.
#[derive(Debug)]
struct Errors {
    /// The error of a sample [%].
    of: fn(&Sample) -> f64,
    /// Whether it is drawn over time.
    drawn: bool,
    times: Vec<f64>,
    /// By lane [%].
    percent: [Vec<f64>; WIDTH],
}

impl Errors {
    fn observer(of: fn(&Sample) -> f64, drawn: bool) -> Box<dyn Observer> {
        Box::new(Self { of, drawn, times: Vec::new(), percent: Default::default() })
    }
}

impl Observer for Errors {
    fn see(&mut self, seen: &Seen<'_>) {
        self.times.push(seen.snapshot.time);
        for (percent, sample) in self.percent.iter_mut().zip(seen.samples) {
            percent.push((self.of)(sample));
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let percent = &self.percent[lane];
        let mut values =
            vec![Value::Number(median(percent)), Value::Number(percent.last().copied().unwrap_or(f64::NAN))];
        if self.drawn {
            values.push(Value::Curve(self.times.clone(), percent.clone()));
        }
        values
    }
}
