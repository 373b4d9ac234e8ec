//! The choice of the time step where the case does not give one.

use super::{Case, FEEDING, GUSTS, STRING, StepLimit, whole_parts};
use crate::chain::schemes::Scheme;
use crate::line::{Contact, Line};
use std::f64::consts::PI;

/// Error tolerance if the case does not give one either [-].
pub const ERROR_TOLERANCE: f64 = 0.003;

/// What limited the choice of the time step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepChoice {
    /// The error of the free end's path.
    Error,
    /// Half the stability limit.
    Stability,
    /// The run is not longer than this step.
    Duration,
    /// An element is fed in as few steps as can be.
    Feed,
}

impl StepChoice {
    /// The reason in words.
    pub const fn reason(self) -> &'static str {
        match self {
            Self::Error => "it keeps the error tolerance",
            Self::Stability => "it is at most half the stability limit",
            Self::Duration => "the run is one step long",
            Self::Feed => "an element is fed in as few steps as can be",
        }
    }
}

/// Part of the limits of the tensions up to which the suggested step of a fed fibre may go [-]. Hundreds of flights were
/// sound at the limits themselves.
const PART_OF_LIMIT: f64 = 0.85;

impl Case {
    /// Changes the time step [s]; that of a fed fibre becomes a little shorter if an element is not fed in whole steps. All
    /// times of the run stay the same if they are whole steps; their numbers of steps
    /// change.
    pub fn set_time_step(&mut self, time_step: f64) {
        let length = self.fibre.rest_length();
        let time_step = match &mut self.line {
            Some(line) => {
                line.steps_per_element = line.steps_of(length, time_step);
                length / line.feed_speed / line.steps_per_element as f64
            }
            None => time_step,
        };
        let run = &mut self.run;
        let steps = |time: f64| whole_parts(time, time_step).0;
        let (duration, spin_up, output) = (run.duration(), run.spin_up(), run.output_interval());
        (run.steps, run.spin_up_steps, run.output_steps) =
            (steps(duration).max(1), steps(spin_up), steps(output).max(1));
        run.time_step = time_step;
    }

    /// A suitable time step [s]: 1, 2 or 5 times a power of ten.
    ///
    /// The step keeps the error of the free end's path below `tolerance` times its amplitude, and it is at most half
    /// the stability limit. The present [`Run::time_step`](super::Run) does not matter.
    ///
    /// The error was measured on the paper's Table 1 case against the converged path: `0.20 ω_c h` for
    /// semi-implicit Euler, `0.06 (ω_c h)²` for leapfrog and `0.12 (ω_c h)²` for implicit tension. `ω_c` is the
    /// angular cut-off frequency.                                         theory.md (55)
    ///
    /// * `duration` – simulated time [s]
    pub fn suggested_time_step(&self, tolerance: f64, duration: f64) -> (f64, StepChoice) {
        let cutoff = 2.0 * PI * self.air.cutoff_frequency;
        let accurate = match self.run.scheme {
            Scheme::SemiImplicitEuler => tolerance / (0.20 * cutoff),
            Scheme::Leapfrog => (tolerance / 0.06).sqrt() / cutoff,
            Scheme::ImplicitTension => (tolerance / 0.12).sqrt() / cutoff,
        };
        if let Some(line) = self.line {
            return self.suggested_feeding_step(&line);
        }
        let limits = self.stable_step_limits();
        let stable = 0.5 * limits.iter().map(|limit| limit.limit).fold(f64::INFINITY, f64::min);
        let (longest, choice) =
            if accurate <= stable { (accurate, StepChoice::Error) } else { (stable, StepChoice::Stability) };
        if longest >= duration { (duration, StepChoice::Duration) } else { (round_down(longest), choice) }
    }

    /// A suitable time step of a fed fibre [s]: whole steps to an element, as few as [`PART_OF_LIMIT`] and half of the
    /// other limits allow. With steps as long as that, the statistics of the lay-down stay the same.
    fn suggested_feeding_step(&self, line: &Line) -> (f64, StepChoice) {
        let longest = |limit: &StepLimit| match limit.cause {
            FEEDING => f64::INFINITY,
            STRING | GUSTS => PART_OF_LIMIT * limit.limit,
            _ => 0.5 * limit.limit,
        };
        let longest = self.stable_step_limits().iter().map(longest).fold(f64::INFINITY, f64::min);
        let length = self.fibre.rest_length();
        // Half of the limit where that is not known to be safe in every flight.
        let usual =
            if line.contact == Contact::Stick { line.fewest_steps() } else { 2 * line.fewest_steps() };
        let steps = line.steps_of(length, longest).max(usual);
        let choice = if steps == usual { StepChoice::Feed } else { StepChoice::Stability };
        (length / line.feed_speed / steps as f64, choice)
    }
}

/// The largest of 1, 2, 5 times a power of ten that is not above a positive number.
fn round_down(value: f64) -> f64 {
    let exponent = value.log10().floor() as i32;
    // Parsing gives exactly the number that is written `2e-4`; multiplying would not.
    let candidate = |digit: &str, exponent: i32| format!("{digit}e{exponent}").parse().unwrap_or(value);
    [("5", exponent), ("2", exponent), ("1", exponent), ("5", exponent - 1)]
        .into_iter()
        .map(|(digit, exponent)| candidate(digit, exponent))
        .find(|&candidate| candidate <= value)
        .unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::round_down;

    #[test]
    fn analytic_round_down() {
        let pairs = [
            (1.0, 1.0),
            (1.9, 1.0),
            (2.0, 2.0),
            (4.99e-4, 2e-4),
            (5e-5, 5e-5),
            (9.99e-6, 5e-6),
            (1e-6, 1e-6),
        ];
        for (value, expected) in pairs {
            assert_eq!(round_down(value), expected, "{value}");
        }
    }
}
