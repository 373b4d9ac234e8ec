//! The studies of the paper the model is from, and what it says of their outcome.
//!
//! Battocchio, Sutcliffe & Teschner 2015: Table 1, varied one parameter at a time (Figures 9 to 11), and the
//! error of the work for three time steps (Figure 8b).

mod claims;
mod fits;

pub use claims::{Claim, Verdict, claims_of_step_errors, claims_of_trend};

use crate::case::{Case, ERROR_TOLERANCE};
use crate::chain::schemes::Scheme;
use crate::drag::FrictionLaw;
use crate::fibre::Root;
use crate::input::{parse_case, starter_case};
use crate::study::PointResults;

/// A parameter of Table 1 that the paper varies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// Mean velocity, Figure 9.
    Velocity,
    /// Turbulence intensity, Figure 10.
    Intensity,
    /// Fibre diameter, Figure 11a.
    Diameter,
    /// Turbulent length scale, Figure 11b.
    LengthScale,
    /// Cut-off frequency at constant rms, Figure 11c.
    Cutoff,
}

impl Parameter {
    /// All of them, in the order of the figures.
    pub const ALL: [Self; 5] =
        [Self::Velocity, Self::Intensity, Self::Diameter, Self::LengthScale, Self::Cutoff];

    /// The figure that shows it: `9`, `11a`.
    pub const fn figure(self) -> &'static str {
        match self {
            Self::Velocity => "9",
            Self::Intensity => "10",
            Self::Diameter => "11a",
            Self::LengthScale => "11b",
            Self::Cutoff => "11c",
        }
    }

    /// In words.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Velocity => "mean air velocity",
            Self::Intensity => "turbulence intensity",
            Self::Diameter => "fibre diameter",
            Self::LengthScale => "turbulent length scale",
            Self::Cutoff => "frequency of turbulence",
        }
    }

    /// Symbol, unit shown, and the factor from SI to it.
    pub const fn unit(self) -> (&'static str, &'static str, f64) {
        match self {
            Self::Velocity => ("U", "m/s", 1.0),
            Self::Intensity => ("Tu", "–", 1.0),
            Self::Diameter => ("d", "µm", 1e6),
            Self::LengthScale => ("L_T", "mm", 1e3),
            Self::Cutoff => ("f", "Hz", 1.0),
        }
    }

    /// Name of the parameter in tables, with its unit.
    pub const fn column(self) -> &'static str {
        match self {
            Self::Velocity => "air.velocity_m_s",
            Self::Intensity => "air.turbulence_intensity",
            Self::Diameter => "fibre.diameter_m",
            Self::LengthScale => "air.length_scale_m",
            Self::Cutoff => "air.cutoff_frequency_hz",
        }
    }

    /// The values flown [SI]. The paper's own are lost with its figures; these span its text and Part I.
    pub const fn values(self) -> &'static [f64] {
        match self {
            Self::Velocity => &[5.0, 7.5, 10.0, 12.5, 15.0, 20.0],
            Self::Intensity => &[0.05, 0.075, 0.1, 0.125, 0.15, 0.2, 0.25],
            Self::Diameter => &[18e-6, 30e-6, 50e-6, 80e-6, 120e-6, 200e-6, 300e-6],
            Self::LengthScale => &[20e-3, 25e-3, 40e-3, 50e-3, 100e-3, 125e-3, 200e-3],
            Self::Cutoff => &[25.0, 50.0, 100.0, 150.0, 200.0, 400.0],
        }
    }

    /// The case with another value of the parameter, as the paper varies it: an eddy to each element, and the
    /// rms kept where the frequency changes.
    pub fn set(self, base: &Case, value: f64) -> Case {
        let mut case = base.clone();
        match self {
            Self::Velocity => case.air.velocity = value,
            Self::Intensity => case.air.turbulence_intensity = value,
            Self::Diameter => case.fibre.diameter = value,
            Self::LengthScale => {
                case.air.length_scale = value;
                case.fibre.elements = (case.fibre.length / value).round().max(1.0) as usize;
            }
            Self::Cutoff => {
                case.air.cutoff_frequency = value;
                case.air.harmonics = case.air.default_harmonics(case.run.duration());
            }
        }
        case
    }
}

/// Table 1 in a scheme: the paper's with its step of 1 µs, others with the step that suits them.
pub fn table1(scheme: Scheme, replicates: u64) -> Option<Case> {
    let (mut case, _) = parse_case(starter_case(), "Table 1", &[]).ok()?;
    let duration = case.run.duration();
    case.run.replicates = replicates;
    case.run.scheme = scheme;
    if scheme != Scheme::SemiImplicitEuler {
        let interval = case.run.output_interval();
        let (time_step, _) = case.suggested_time_step(ERROR_TOLERANCE, duration);
        case = with_time_step(&case, time_step);
        case.run.output_steps = (interval / time_step).round().max(1.0) as u64;
    }
    Some(case)
}

/// The case with another time step, recorded at the same instants as far as whole steps allow.
pub fn with_time_step(case: &Case, time_step: f64) -> Case {
    let (duration, interval) = (case.run.duration(), case.run.output_interval());
    let mut case = case.clone();
    case.run.time_step = time_step;
    case.run.steps = (duration / time_step).round().max(1.0) as u64;
    case.run.output_steps = (interval / time_step).round().max(1.0) as u64;
    case
}

/// The time steps of Figure 8b [s].
pub const ERROR_STEPS: [f64; 3] = [1e-6, 4e-6, 1.6e-5];

/// What the paper's text leaves open, with what Table 1 becomes of it: name, case.
pub fn choices(base: &Case) -> Vec<(&'static str, Case)> {
    let changed = |change: &dyn Fn(&mut Case)| {
        let mut case = base.clone();
        change(&mut case);
        case
    };
    vec![
        ("as taken here: pinned root, β = 0.9, variance u²", base.clone()),
        ("clamped root", changed(&|c| c.fibre.root = Root::Clamped)),
        ("β = 0.78 (Majumdar & Shambaugh)", changed(&|c| c.drag.along = FrictionLaw::MajumdarShambaugh)),
        ("β = 0.37 (Matsui)", changed(&|c| c.drag.along = FrictionLaw::Matsui { factor: 0.37 })),
        (
            "variance 2u², as Eqs 6–7 read literally",
            changed(&|c| c.air.turbulence_intensity *= std::f64::consts::SQRT_2),
        ),
        ("eddies of 25 mm, as Taylor's hypothesis has it", Parameter::LengthScale.set(base, 25e-3)),
    ]
}

/// Of y and of z: mean and standard error of the mean.
pub type Both = [(f64, Option<f64>); 2];

/// What a point of a figure shows: y and z, mean and standard error of the mean.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrendPoint {
    /// Value of the parameter [SI].
    pub value: f64,
    /// Amplitudes of y and z [m].
    pub amplitude: Both,
    /// Frequencies of y and z [Hz].
    pub frequency: Both,
    /// Number of replicates.
    pub n: u64,
}

impl TrendPoint {
    /// Of the results of a study's point.
    pub fn of(value: f64, results: &PointResults) -> Self {
        let of = |i: usize| (results.mean[i], results.standard_error[i]);
        Self { value, amplitude: [of(0), of(1)], frequency: [of(2), of(3)], n: results.n }
    }
}
