//! What decides the diameter of a filament: every number of a spinline is changed a little.

use super::spinline::SpinFile;
use spunlaid_fibre::case::keys::{self, Key, Kind, Sign, Value};
use spunlaid_fibre::{Case, Solution};
use spunlaid_ground::{Change, ChangedKey, Difference, Dimension, Effect, SensitivityRun, Setting, Turned};

/// The change of a number, either way, and that of a temperature [K].
const STEP: f64 = 0.02;
const KELVIN: f64 = 2.0;
/// Influences below this are left out.
const LEAST: f64 = 5e-4;

/// What a change of a number does to the cold filament: `d ln d/d ln x` [-] of its diameter d, or the
/// relative change [-] for 10 K, and the same of its speed. They are computed and have no error of chance.
pub type Influence = SensitivityRun<(), OfFilament>;

/// What an [`Influence`] is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OfFilament {
    /// The final diameter.
    Diameter,
    /// The final speed.
    Speed,
}

impl SpinFile {
    /// What decides the diameter: the influence of each number on the filament of the first row, the largest
    /// first. The factor of the friction law is among them. Numbers without influence are left out.
    ///
    /// A number whose change leaves no steady state is left out too.
    ///
    /// * `filament` – the steady state of the first row, from which those of the changed lines are not far
    pub fn influences(&self, filament: &Solution) -> Vec<Influence> {
        let carrier = Case::from(&self.spec);
        let tables = ["spinline", "spinline.material", "drag"];
        let all = tables.into_iter().flat_map(keys::keys_of_table);
        let mut found: Vec<Influence> = all.filter_map(|key| influence(key, &carrier, filament)).collect();
        let change = |of: &Influence| of.effects[0].difference.value.abs();
        found.sort_by(|one, other| change(other).total_cmp(&change(one)));
        found
    }
}

/// Whether a key is a number of the line: a limit or the size of the curtain is none.
fn is_physical(key: &Key) -> bool {
    !["spinline.break_stress", "spinline.filaments_per_metre_and_row"].contains(&key.name)
}

/// The influence of a number, from the filaments with a smaller and with a larger one; None if it has none,
/// or hardly any.
fn influence(key: &'static Key, carrier: &Case, near: &Solution) -> Option<Influence> {
    let Some(Value::Number(number)) = key.get(carrier) else { return None };
    let by_kelvin = is_by_kelvin(&key.kind);
    if (number == 0.0 && !by_kelvin) || !is_physical(key) {
        return None;
    }
    let ends = [-1.0, 1.0]
        .map(|sign| Step { factor: 1.0 + sign * STEP, kelvin: sign * KELVIN }.apply(&key.kind, number));
    // Diameter and speed of the filament of the changed line.
    let solve = |number: f64| -> Option<[f64; 2]> {
        let mut case = carrier.clone();
        key.set(&mut case, number).ok()?;
        let line = case.spinline.as_deref()?;
        let speed = line.final_speed_near(case.drag.along, near).ok()?;
        Some([line.final_diameter(speed), speed])
    };
    let (less, more) = (solve(ends[0])?, solve(ends[1])?);
    let scale = match by_kelvin {
        true => 2.0 * KELVIN / 10.0,
        false => libm::log((1.0 + STEP) / (1.0 - STEP)),
    };
    let effect = |(measure, number): (OfFilament, usize)| {
        Effect::new(measure, Difference::exact(libm::log(more[number] / less[number]) / scale))
    };
    let effects = [(OfFilament::Diameter, 0), (OfFilament::Speed, 1)].map(effect).to_vec();
    // A factor on the air stands for the air.
    let words = key.label.trim_end_matches(", factor").trim_end_matches(", change");
    let change = Change {
        setting: Setting { name: key.name, words, turned: Turned::Running },
        layers: Vec::new(),
        keys: vec![changed_key(key.name.to_owned(), &key.kind, ends)],
        experiment: (),
        refusal: None,
    };
    (effects[0].difference.value.abs() >= LEAST).then_some(SensitivityRun {
        change,
        effects,
        at_first: Vec::new(),
    })
}

/// A change of a number.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// Its value is multiplied by this.
    pub(super) factor: f64,
    /// What is added in place of that to a temperature, and to a difference of temperatures that may be zero,
    /// which have no share of their value [K].
    pub(super) kelvin: f64,
}

impl Step {
    /// The number after the change. A whole number stays one, and above zero.
    pub(super) fn apply(self, kind: &Kind, number: f64) -> f64 {
        match kind {
            _ if is_by_kelvin(kind) => number + self.kelvin,
            Kind::Whole(..) => (number * self.factor).round().max(1.0),
            _ => number * self.factor,
        }
    }
}

/// Whether a number is changed by kelvins.
pub(super) const fn is_by_kelvin(kind: &Kind) -> bool {
    matches!(
        kind,
        Kind::Quantity(Dimension::Temperature, _)
            | Kind::Quantity(Dimension::TemperatureDifference, Sign::Any)
    )
}

/// A key that has been changed.
pub(super) fn changed_key(key: String, kind: &Kind, [from, to]: [f64; 2]) -> ChangedKey {
    let dimension = kind.dimension().unwrap_or(Dimension::Ratio);
    let (whole, by_kelvin) = (matches!(kind, Kind::Whole(..)), is_by_kelvin(kind));
    ChangedKey { key, dimension, whole, by_kelvin, from, to }
}
