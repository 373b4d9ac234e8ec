//! Values that are most likely slips, of a unit above all.

use super::Case;
use super::keys::{self, Key, Value, diagnostic};
use spunlaid_air::{Flow, Hint};
use spunlaid_ground::{Diagnostic, Dimension};

/// Pressure of the atmosphere [Pa], and ratio of the specific heats of air [-]. The speed of sound is √(1.4 p/ρ).
const ATMOSPHERE: f64 = 101_325.0;
const SPECIFIC_HEATS: f64 = 1.4;
/// Densities of air between which the temperature follows from them, at the pressure of the atmosphere [kg/m³].
const OF_AIR: std::ops::RangeInclusive<f64> = 0.18..=2.1;
/// Mach number up to which the density of air changes by less than 5 % [-].
const SLOW: f64 = 0.3;
/// Places along the fibre at which a flow is looked at.
const PLACES: usize = 64;

/// What is said of a value whose magnitude is outside the usual range; nothing of zero.
pub fn unusual(dimension: Dimension, usual: (f64, f64), value: f64) -> Option<Diagnostic> {
    is_unusual(usual, value).then(|| {
        let advice = match &dimension.in_other_units(value, usual.0, usual.1)[..] {
            [] => "check the value and its unit".to_owned(),
            [one] => format!("did you mean {one}?"),
            [more @ .., last] => format!("did you mean {} or {last}?", more.join(", ")),
        };
        Diagnostic::warning(format!("is outside the usual range, {}; {advice}", range(dimension, usual)))
            .outside_by(excess(usual, value))
    })
}

/// How many times outside a value is.
fn excess((least, greatest): (f64, f64), value: f64) -> f64 {
    (least / value.abs()).max(value.abs() / greatest)
}

fn is_unusual((least, greatest): (f64, f64), value: f64) -> bool {
    // Rounding to whole elements and steps must not matter.
    value != 0.0 && !(0.999 * least..=1.001 * greatest).contains(&value.abs())
}

fn range(dimension: Dimension, (least, greatest): (f64, f64)) -> String {
    format!("{} to {}", dimension.pretty(least), dimension.pretty(greatest))
}

impl Case {
    /// Warnings about values that are most likely slips.
    pub(super) fn slips(&self) -> Vec<Diagnostic> {
        let mut notes = self.fast().into_iter().chain(self.intensity()).collect::<Vec<_>>();
        let fast = !notes.is_empty();
        for key in keys::all() {
            let of_air = key.table() == "air";
            if of_air && (self.air.density == 0.0 && key.name != "air.density") {
                continue;
            }
            // A flow that is too fast has been reported, with the way out.
            let is_reported = fast && ["air.velocity", "air.turbulence_intensity"].contains(&key.name);
            if is_reported {
                continue;
            }
            match self.intensity_above_one().filter(|_| key.name == "air.turbulence_intensity") {
                Some(value) => {
                    let shown = Dimension::Ratio.pretty(value);
                    let text = format!(
                        "means that the rms of the fluctuation is {shown} times the mean velocity; if {shown} % was \
                         meant, write \"{shown} %\""
                    );
                    notes.push(diagnostic(key.name, value, Diagnostic::warning(text).outside_by(value)));
                }
                None => notes.extend(self.unusual(key)),
            }
        }
        notes.extend(self.dissipation());
        notes.extend(self.profile_size());
        notes
    }

    /// Adds values that are most likely slips to the problems of a case: they may be why it cannot be run.
    pub fn blame_slips(&self, problems: &mut Vec<Diagnostic>) {
        for note in self.slips() {
            if !problems.iter().any(|problem| problem.key == note.key) {
                problems.push(note.into_error());
            }
        }
    }

    /// Notes on unusual values of the keys of some tables.
    pub fn unusual_in(&self, tables: &[&str]) -> Vec<Diagnostic> {
        let keys = keys::all().iter().filter(|key| tables.contains(&key.table()));
        keys.filter_map(|key| self.unusual(key)).collect()
    }

    fn unusual(&self, key: &Key) -> Option<Diagnostic> {
        let Value::Number(value) = key.get(self)? else { return None };
        let (dimension, usual) = (key.dimension()?, key.usual?);
        if key.is_derived(self) {
            let text = format!(
                "gives {} = {} along the fibre, which is outside the usual range, {}; check the units in the file",
                key.name,
                key.kind.pretty(&Value::Number(value)),
                range(dimension, usual)
            );
            let remark = Diagnostic::warning(text).outside_by(excess(usual, value));
            return is_unusual(usual, value).then(|| self.note_of_file(remark))?;
        }
        Some(diagnostic(key.name, value, unusual(dimension, usual, value)?))
    }

    /// A note about the file that the air comes from; none if it comes from no file.
    fn note_of_file(&self, what: Diagnostic) -> Option<Diagnostic> {
        let key = match (&self.air.flow, self.air.records.is_empty()) {
            (Flow::Profile(_), _) => "air.profile",
            (Flow::Field(_), _) => "air.field",
            (Flow::Uniform, false) => "air.record",
            (Flow::Uniform, true) => return None,
        };
        let value = keys::find(key).and_then(|key| Some(key.kind.pretty(&key.get(self)?)));
        Some(what.with_key(key, value))
    }

    /// The largest mean velocity of the air along the way of the fibre, if there is air [m/s].
    pub fn fastest_air(&self) -> Option<f64> {
        let (mut hint, along) = (Hint::default(), self.along());
        let places = (0..=PLACES).map(|i| along * (i as f64 / PLACES as f64));
        let speeds = places.map(|at| self.air.local(at, &mut hint).velocity.norm());
        Some(speeds.fold(0.0, f64::max)).filter(|speed| self.air.density > 0.0 && *speed > 0.0)
    }

    /// Air that is too fast for air of constant density.
    fn fast(&self) -> Option<Diagnostic> {
        let air = &self.air;
        if air.density == 0.0 {
            return None;
        }
        let mut hint = Hint::default();
        let along = self.along();
        let places = (0..PLACES).map(|i| along * ((i as f64 + 0.5) / PLACES as f64));
        let speed = places.map(|at| air.local(at, &mut hint).velocity.norm()).fold(0.0, f64::max);
        let density = if OF_AIR.contains(&air.density) { air.density } else { 1.204 };
        let mach_number = speed / (SPECIFIC_HEATS * ATMOSPHERE / density).sqrt();
        if mach_number <= SLOW {
            return None;
        }
        // A thousandth of it is the speed of a flow: 1 to 100 m/s.
        let of_millimetres = mach_number > 3.0 && (1.0..=100.0).contains(&(speed / 1000.0));
        let advice = |text| if of_millimetres { text } else { "" };
        let shown = Dimension::Velocity.pretty_to(speed, 3);
        let mach = Dimension::Ratio.pretty_to(mach_number, 2);
        let remark = |advice| {
            Diagnostic::warning(format!(
                "makes the air as fast as {shown}, which is Mach {mach}: the model's air has a constant density, as \
                 air has up to about Mach {SLOW}{advice}"
            ))
            .outside_by(mach_number / SLOW)
        };
        let note = match (&air.flow, air.records.is_empty()) {
            (Flow::Uniform, true) => {
                return Some(diagnostic(
                    "air.velocity",
                    air.velocity,
                    remark(advice(". Did you mean mm/s?")),
                ));
            }
            (Flow::Uniform, false) => {
                remark(advice(". If its velocities are in mm/s, write air.record_velocity_unit = \"mm/s\""))
            }
            (Flow::Profile(_), _) => remark(advice(
                ". If its velocities are in mm/s, write this unit at the end of the column's name: velocity_mm_s",
            )),
            (Flow::Field(_), _) => remark(advice(
                ". If its velocities are in mm/s, write this unit at the end of the name of their array or \
                columns, like U_mm_s; k and ε likewise, k_mm2_s2 and epsilon_mm2_s3",
            )),
        };
        self.note_of_file(note)
    }

    /// Turbulence of a file that is stronger than its mean flow.
    fn intensity(&self) -> Option<Diagnostic> {
        let air = &self.air;
        let of_record = !air.records.is_empty();
        let intensity = air.turbulence_intensity;
        if air.density == 0.0 || intensity <= 1.0 || !(of_record || air.from_flow.turbulence_intensity) {
            return None;
        }
        let advice = match &air.flow {
            Flow::Field(_) if (30.0..=1000.0).contains(&intensity) => {
                "if its k is in mm²/s², write this unit at the end of the name of the array or column: k_mm2_s2"
            }
            Flow::Field(_) => "check the units of k and of the velocity",
            Flow::Profile(_) => "if it is in per cent, call the column turbulence_intensity_percent",
            Flow::Uniform => "check the mean velocity",
        };
        let shown = Dimension::Ratio.pretty_to(intensity, 2);
        let text = format!(
            "makes the rms of the fluctuation {shown} times the mean velocity along the fibre; {advice}"
        );
        self.note_of_file(Diagnostic::warning(text).outside_by(intensity))
    }

    /// A profile whose distances seem to have another unit.
    fn profile_size(&self) -> Option<Diagnostic> {
        let Flow::Profile(table) = &self.air.flow else { return None };
        let ((first, last), fibre) = (table.range(), self.fibre.length);
        let profile = last - first;
        if profile <= 100.0 * fibre {
            return None;
        }
        let [profile, fibre] = [profile, fibre].map(|length| Dimension::Length.pretty_to(length, 3));
        self.note_of_file(Diagnostic::warning(format!(
            "is {profile} long, while the fibre is {fibre} long, so that it feels the first rows only; check the unit \
             of the distances"
        )))
    }

    /// Turbulence of a field without a length of its own, and a field without any.
    fn dissipation(&self) -> Option<Diagnostic> {
        let Flow::Field(placed) = &self.air.flow else { return None };
        if self.air.density == 0.0 || !self.air.from_flow.length_scale {
            return None;
        }
        let (mut hint, along) = (Hint::default(), self.along());
        let places = (0..PLACES).map(|i| along * ((i as f64 + 0.5) / PLACES as f64));
        let turbulence = places.map(|at| placed.turbulence(at, &mut hint)).collect::<Vec<_>>();
        if turbulence.iter().all(|(k, _)| *k == 0.0) {
            return self.note_of_file(Diagnostic::warning(
                "has k = 0 everywhere along the fibre, so the air there is not turbulent; check that the file has the \
                 k of the solution",
            ));
        }
        let places = turbulence.iter().filter(|(k, epsilon)| *k > 0.0 && *epsilon == 0.0).count();
        if places == 0 {
            return None;
        }
        self.note_of_file(Diagnostic::warning(format!(
            "has k above zero and ε = 0 at {places} of {PLACES} points along the fibre; the eddies there \
             are taken to be as large as the field. Write ε or ω for every point"
        )))
    }
}
