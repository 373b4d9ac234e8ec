//! What decides the diameter of a filament: every number of a spinline is changed a little.

use super::spinline::SpinFile;
use crate::case::Case;
use crate::case::keys::{self, Key, Kind, Sign, Value};
use crate::sort::sort_by_key;
use crate::spinline::{Failure, Solution, Spinline};
use crate::units::Dimension;
use std::cmp::Reverse;

/// The change of a number, either way.
const STEP: f64 = 0.02;
/// The change of a temperature, either way [K].
const KELVIN: f64 = 2.0;
/// Influences below this are left out.
const LEAST: f64 = 5e-4;

/// What a change of a number does to the filament.
#[derive(Clone, Debug, PartialEq)]
pub struct Influence {
    /// Full name of the key, `spinline.throughput`.
    pub key: &'static str,
    /// What is changed, with its symbol: `Throughput of a hole`.
    pub label: &'static str,
    /// How it is changed.
    pub change: Change,
    /// What the change does to the final diameter: `d ln d/d ln x` [-], or its relative change [-] for 10 K.
    pub diameter: f64,
    /// The same of the final speed.
    pub speed: f64,
}

/// How a number is changed to see its influence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// By a share of its value.
    Relative,
    /// By 10 K.
    TenKelvin,
}

impl SpinFile {
    /// What decides the diameter: the influence of each number on the filament of the first row, the largest first. The factor
    /// of the friction law is among them. Numbers without influence are left out.
    ///
    /// A number whose change leaves no steady state is left out too.
    ///
    /// * `filament` – the steady state of the first row, from which those of the changed lines are not far
    pub fn influences(&self, filament: &Solution) -> Vec<Influence> {
        let carrier = Case::from(&self.spec);
        let mut found = Vec::new();
        let tables = ["spinline", "spinline.material", "drag"];
        for key in tables.into_iter().flat_map(keys::keys_of_table) {
            let Some(Value::Number(value)) = key.get(&carrier) else { continue };
            let change = Change::from_key(key);
            if (value != 0.0 || change == Change::TenKelvin) && is_physical(key) {
                let changed = |sign: f64| {
                    let mut case = carrier.clone();
                    key.set(&mut case, change.apply(value, sign)).ok()?;
                    solve(&case, filament).ok()
                };
                // A factor on the air stands for the air.
                let label = key.label.trim_end_matches(", factor").trim_end_matches(", change");
                found.extend(change.influence(key.name, label, changed));
            }
        }
        sort_by_key(&mut found, |influence| Reverse(influence.diameter.abs()));
        found
    }
}

/// Whether a key is a number of the line: a limit or the size of the curtain is none.
fn is_physical(key: &Key) -> bool {
    !["spinline.break_stress", "spinline.filaments_per_metre_and_row"].contains(&key.name)
}

/// Diameter [m] and speed [m/s] of the filament of a changed line.
fn solve(case: &Case, near: &Solution) -> Result<Option<[f64; 2]>, Failure> {
    let numbers = |line: &Spinline| {
        let speed = line.final_speed_near(case.drag.along, near)?;
        Ok([line.final_diameter(speed), speed])
    };
    case.spinline.as_deref().map(numbers).transpose()
}

impl Change {
    /// How a key is changed: a temperature, and a difference of temperatures that may be zero, has no share of its value.
    fn from_key(key: &Key) -> Self {
        match key.kind {
            Kind::Quantity(Dimension::Temperature, _)
            | Kind::Quantity(Dimension::TemperatureDifference, Sign::Any) => Self::TenKelvin,
            _ => Self::Relative,
        }
    }

    fn apply(self, value: f64, sign: f64) -> f64 {
        match self {
            Self::Relative => value * (1.0 + sign * STEP),
            Self::TenKelvin => value + sign * KELVIN,
        }
    }

    /// The influence of a number, from the filaments with a larger and with a smaller one.
    fn influence(
        self,
        key: &'static str,
        label: &'static str,
        changed: impl Fn(f64) -> Option<Option<[f64; 2]>>,
    ) -> Option<Influence> {
        let (more, less) = (changed(1.0)??, changed(-1.0)??);
        let scale = match self {
            Self::Relative => libm::log((1.0 + STEP) / (1.0 - STEP)),
            Self::TenKelvin => 2.0 * KELVIN / 10.0,
        };
        let [diameter, speed] = [0, 1].map(|number| libm::log(more[number] / less[number]) / scale);
        (diameter.abs() >= LEAST).then_some(Influence { key, label, change: self, diameter, speed })
    }
}
