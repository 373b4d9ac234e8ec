//! The longest stable time step, and the choice of one where the case does not give it.

use super::{Case, whole_parts};
use crate::chain::Scheme;
use crate::line::{Contact, Line};
use std::f64::consts::PI;

/// The limit that the feed sets, see [`Line::fewest_steps`].
pub(super) const FEEDING: &str = "feed of an element";
const STRING: &str = "waves of the taut string";
const GUSTS: &str = "eddies that turn an element";
const AXIAL: &str = "axial waves";
const BENDING: &str = "bending waves";

/// Factor of the root of a fed fibre on the limit of the bending waves: its largest stiffness is sixteen times that of
/// other nodes, the bending waves are 18 % faster then.
const FED_ROOT: f64 = 0.84;

/// A limit on the time step and what sets it.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct StepLimit {
    /// What sets the limit, for example `axial waves`.
    pub cause: &'static str,
    /// The longest stable step [s]; steps must stay below it.
    #[serde(rename = "limit_s")]
    pub limit: f64,
}

impl StepLimit {
    /// Where it comes from, and what allows longer steps.
    pub fn reason(&self) -> &'static str {
        match self.cause {
            AXIAL => {
                "sound crosses an element in this time, all along the fibre; run.scheme = \"implicit-tension\" has \
                no such limit, and longer elements (fibre.element_length) lengthen it"
            }
            BENDING => {
                "the shortest bending wave oscillates once in this time, at the root first; longer \
                elements (fibre.element_length) or a thinner or softer fibre lengthen it"
            }
            STRING => {
                "a wave of the taut fibre crosses an element in this time at the root, where the tension is \
                largest; longer elements (fibre.element_length) or less drag lengthen it"
            }
            FEEDING => {
                "an element is fed at the inlet in whole steps; longer elements (fibre.element_length) or a \
                lower feed.speed lengthen it"
            }
            GUSTS => {
                "eddies may turn an element only a little in a step; longer elements \
                (fibre.element_length) or weaker turbulence lengthen it"
            }
            _ => "",
        }
    }
}

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
            Self::Feed => "an element is fed in as few steps as possible",
        }
    }
}

/// Part of the limits of the tensions up to which the suggested step of a fed fibre may go [-]. Hundreds of
/// flights were sound at the limits themselves.
const PART_OF_LIMIT: f64 = 0.85;

impl Case {
    /// The limits on the time step of an undamped flight with this mesh and the case's scheme.
    pub fn step_limits(&self) -> Vec<StepLimit> {
        let axial = StepLimit { cause: AXIAL, limit: self.fibre.axial_step_limit() };
        let bending = StepLimit { cause: BENDING, limit: self.bending_step_limit() };
        let mut limits = match self.run.scheme {
            Scheme::SemiImplicitEuler | Scheme::Leapfrog => vec![axial, bending],
            Scheme::ImplicitTension => vec![bending, self.string_step_limit()],
        };
        if let Some(line) = self.line {
            // A step may be exactly this part of the time in which an element is fed.
            let limit =
                self.fibre.rest_length() / line.feed_speed / line.fewest_steps() as f64 * (1.0 + 1e-9);
            limits.push(StepLimit { cause: FEEDING, limit });
            if self.run.scheme == Scheme::ImplicitTension && self.air.density > 0.0 && self.air.rms() > 0.0 {
                // The tensions are found where eddies turn an element little in a step. Flights of spunbond.toml at
                // 40 % of turbulence were seen to fail at 1.7 times this. theory.md (63)
                let limit = self.fibre.rest_length() / (12.0 * self.air.rms());
                limits.push(StepLimit { cause: GUSTS, limit });
            }
        }
        limits
    }

    /// Longest stable step for bending waves [s], with the stiff root of a fed fibre and the bending viscosity.
    ///
    /// The bending viscosity damps a wave of angular frequency `ω = 2/h₀` by `ω²τ`, so `(h/h₀)² + κ ω²τ h < 1`, `κ` as
    /// of [`Case::stable_step_limits`].                                                 theory.md (63)
    fn bending_step_limit(&self) -> f64 {
        let stiff_root = if self.line.is_some() { FED_ROOT } else { 1.0 };
        let alone = self.fibre.bending_step_limit() * stiff_root;
        let share = if self.run.scheme.is_staggered() { 1.0 } else { 0.5 };
        let half = 2.0 * share * self.fibre.bending_viscosity_time / alone;
        alone / (half + half.hypot(1.0))
    }

    /// Longest step of implicit tension at which the waves of the taut fibre stay stable [s].
    ///
    /// It is 1.5 times the time in which such a wave passes an element. Flights were seen to fail at twice this
    /// step.                                                                   theory.md (55)
    ///
    /// The tension is estimated at the root, from the fibre's weight and the friction of the mean flow at half
    /// the fibre's length.
    fn string_step_limit(&self) -> StepLimit {
        let strand = self.strand();
        let elements = self.fibre.elements as f64;
        let weight = self.fibre.element_mass() * elements * self.run.gravity.abs();
        let feed = self.line.map_or(0.0, |line| line.feed_speed);
        let relative = (self.air.velocity - feed).abs();
        let there_is_air = self.air.density > 0.0 && relative > 0.0;
        let friction =
            if there_is_air { strand.drag.along.force(relative, 0.5 * elements) * elements } else { 0.0 };
        let line_density = self.fibre.density * self.fibre.cross_section();
        let speed = ((weight + friction) / line_density).sqrt();
        StepLimit { cause: STRING, limit: 1.5 * self.fibre.rest_length() / speed }
    }

    /// The limits on the time step of the case's scheme [s], with damping taken into account.
    ///
    /// A mode whose limit without damping is `h₀` is stable while `(h/h₀)² + κ c h < 1`, where `c` is the damping
    /// and `κ` is ½ for semi-implicit Euler and 1 for leapfrog.                                    theory.md (32)
    pub fn stable_step_limits(&self) -> Vec<StepLimit> {
        let share = match self.run.scheme {
            Scheme::SemiImplicitEuler => 0.5,
            Scheme::Leapfrog | Scheme::ImplicitTension => 1.0,
        };
        let rate = share * self.run.damping;
        let tightened = |StepLimit { cause, limit }| {
            // Without a limit there is none to tighten.
            let half = if rate > 0.0 { 0.5 * rate * limit } else { 0.0 };
            StepLimit { cause, limit: limit / (half + half.hypot(1.0)) }
        };
        self.step_limits().into_iter().map(tightened).collect()
    }

    /// Changes the time step [s]; that of a fed fibre becomes a little shorter if an element is not fed in
    /// whole steps. All times of the run stay the same if they are whole steps; their numbers of steps
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
        let duration = run.duration();
        let spin_up = run.spin_up();
        let output = run.output_interval();
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
    /// other limits allow. With steps as long as that, the statistics of the laydown stay the same.
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
