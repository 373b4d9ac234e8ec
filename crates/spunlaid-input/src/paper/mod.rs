//! The studies of the paper that the model comes from, and the paper's claims about their results.
//!
//! Battocchio, Sutcliffe & Teschner 2015 vary Table 1 one parameter at a time (Figures 9 to 11) and show the work
//! error for three time steps (Figure 8b). Each study is a file in `cases/paper` that is compiled in, so that a
//! program can fly it from anywhere. The claims and their judgement are code.

mod claims;

pub use claims::{claims_of_step_errors, claims_of_trend};

use crate::{parse_study, read_case};
use spunlaid_experiment::{PointResults, Study};
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, ERROR_TOLERANCE};
use spunlaid_ground::Error;

/// A file in the repository.
#[derive(Clone, Copy)]
struct BuiltInFile {
    name: &'static str,
    text: &'static str,
}

/// A file in the repository. A published crate holds no file from outside of its folder, so `cases`
/// beside this file has a copy of each.
macro_rules! file {
    ($name:literal) => {
        BuiltInFile { name: $name, text: include_str!($name) }
    };
}

/// The case that all the studies vary.
const TABLE_1: BuiltInFile = file!("cases/table1.toml");

/// The file of Table 1.
pub const TABLE1: &str = TABLE_1.text;

named! {
    /// A parameter of Table 1 that the paper varies.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Parameter {
        /// Mean velocity, Figure 9.
        Velocity = "mean air velocity",
        /// Turbulence intensity, Figure 10.
        Intensity = "turbulence intensity",
        /// Fibre diameter, Figure 11a.
        Diameter = "fibre diameter",
        /// Turbulent length scale, Figure 11b.
        LengthScale = "turbulent length scale",
        /// Cut-off frequency at constant rms, Figure 11c.
        Cutoff = "frequency of turbulence",
    }
}

impl Parameter {
    /// The number of its figure: `9`, `11a`.
    pub const fn figure(self) -> &'static str {
        match self {
            Self::Velocity => "9",
            Self::Intensity => "10",
            Self::Diameter => "11a",
            Self::LengthScale => "11b",
            Self::Cutoff => "11c",
        }
    }

    /// Symbol, displayed unit, and the factor from SI to that unit.
    pub const fn unit(self) -> (&'static str, &'static str, f64) {
        match self {
            Self::Velocity => ("U", "m/s", 1.0),
            Self::Intensity => ("Tu", "–", 1.0),
            Self::Diameter => ("d", "µm", 1e6),
            Self::LengthScale => ("L_T", "mm", 1e3),
            Self::Cutoff => ("f", "Hz", 1.0),
        }
    }

    /// The study that varies it.
    ///
    /// # Errors
    /// As [`parse_study`]. The built-in files give no error.
    pub fn study(self) -> Result<Study, Error> {
        study(match self {
            Self::Velocity => file!("cases/paper/velocity.toml"),
            Self::Intensity => file!("cases/paper/intensity.toml"),
            Self::Diameter => file!("cases/paper/diameter.toml"),
            Self::LengthScale => file!("cases/paper/length_scale.toml"),
            Self::Cutoff => file!("cases/paper/cutoff.toml"),
        })
    }
}

/// Reads a study that varies Table 1.
fn study(file: BuiltInFile) -> Result<Study, Error> {
    let case = || Ok((TABLE_1.text.to_owned(), TABLE_1.name.to_owned()));
    let read = parse_study(file.text, file.name, None, |_, _| case());
    Ok(read?.study)
}

fn case(file: BuiltInFile) -> Result<Case, Error> {
    Ok(read_case((file.text, file.name), &[])?.0)
}

/// Table 1 with a scheme. The paper's scheme has the paper's time step of 1 µs; others have a suitable step.
///
/// # Errors
/// As [`read_case`]. The built-in file gives no error.
pub fn table1(scheme: Scheme) -> Result<Case, Error> {
    let mut case = case(TABLE_1)?;
    case.run.scheme = scheme;
    let time_step = match scheme {
        Scheme::SemiImplicitEuler => case.run.time_step,
        _ => case.suggested_time_step(ERROR_TOLERANCE, case.run.duration()).0,
    };
    Ok(in_scheme(case, scheme, time_step))
}

/// The case with another scheme and time step [s]. The recorded times stay the same if they are whole steps.
pub fn in_scheme(mut case: Case, scheme: Scheme, time_step: f64) -> Case {
    case.run.scheme = scheme;
    case.set_time_step(time_step);
    case
}

/// The study of three time steps in Figure 8b. Figure 8a shows its first point.
///
/// # Errors
/// As [`parse_study`]. The built-in file gives no error.
pub fn time_steps() -> Result<Study, Error> {
    study(file!("cases/paper/time_step.toml"))
}

/// The choices that the paper leaves open: the name of each, and Table 1 with it.
///
/// # Errors
/// As [`parse_study`]. The built-in files give no error.
pub fn choices() -> Result<Vec<(&'static str, Case)>, Error> {
    let points = study(file!("cases/paper/choices.toml"))?.points;
    let varied = points.iter().filter_map(|point| point.experiment.case().cloned());
    let names = [
        "this project's choice: pinned root, β = 0.9, variance u²",
        "β = 0.78 (Majumdar & Shambaugh)",
        "β = 0.37 (Matsui)",
        "variance 2u², Eqs 6–7 taken literally",
        "eddies of 25 mm, by Taylor's hypothesis",
    ];
    let mut choices: Vec<_> = names.into_iter().zip(varied).collect();
    choices.push(("clamped root", case(file!("cases/clamped_root.toml"))?));
    Ok(choices)
}

/// For y and for z: mean and standard error of the mean.
pub type LateralEstimates = [(f64, Option<f64>); 2];

/// A point of a figure: mean and standard error of the mean for y and z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrendPoint {
    /// Value of the parameter [SI].
    pub value: f64,
    /// Amplitudes of y and z [m].
    pub amplitude: LateralEstimates,
    /// Frequencies of y and z [Hz].
    pub frequency: LateralEstimates,
    /// Number of replicates.
    pub n: u64,
}

impl TrendPoint {
    /// Takes the values from the results of a study's point.
    pub fn new(value: f64, results: &PointResults) -> Self {
        let measure = |name| results.find(name).unwrap_or((f64::NAN, None));
        Self {
            value,
            amplitude: ["amplitude_y", "amplitude_z"].map(measure),
            frequency: ["frequency_y", "frequency_z"].map(measure),
            n: results.n,
        }
    }
}
