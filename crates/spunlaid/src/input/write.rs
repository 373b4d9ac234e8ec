//! A case as a file that reads back to the same bits.

use super::FORMAT_VERSION;
use super::resolve::nearest_whole;
use crate::air::{Air, EddyModel, Flow, PlacedField, SpectrumShape};
use crate::case::Case;
use crate::case::keys::{self, Quantity};
use crate::units::{Dimension, shortest};
use std::fmt::Write;
use std::path::Path;

/// Writes a case as TOML: every key, in SI units.
///
/// Reading the text gives the same case to the last bit, and writing that the same text, for every case
/// that passes [`Case::check`].
pub fn write_case(case: &Case) -> String {
    let Case { fibre, air, drag, run } = case;
    let mut w = Writer { text: format!("version = {FORMAT_VERSION}\n") };

    w.table("fibre");
    w.quantity(&keys::LENGTH, fibre.length);
    w.quantity(&keys::DIAMETER, fibre.diameter);
    w.quantity(&keys::FIBRE_DENSITY, fibre.density);
    w.quantity(&keys::YOUNGS_MODULUS, fibre.youngs_modulus);
    w.quantity(
        &keys::ELEMENT_LENGTH,
        tidy(fibre.rest_length(), |l| nearest_whole(fibre.length, l) == (fibre.elements as u64, true)),
    );
    w.name("root", fibre.root.name());
    let [x, y, z] = [fibre.direction.x, fibre.direction.y, fibre.direction.z].map(float);
    w.line("direction", &format!("[{x}, {y}, {z}]"));

    w.table("air");
    w.air(air);

    w.table("drag");
    w.name("along", drag.along.name());
    w.name("across", drag.across.name());
    if let Some(factor) = drag.along.factor() {
        w.line("friction_coefficient", &float(factor));
    }

    w.table("run");
    let time = |time: f64, steps: u64| tidy(time, |t| nearest_whole(t, run.time_step) == (steps, true));
    w.quantity(&keys::DURATION, time(run.duration(), run.steps));
    w.quantity(&keys::TIME_STEP, run.time_step);
    w.line("replicates", &run.replicates.to_string());
    w.line("seed", &run.seed.to_string());
    w.name("scheme", run.scheme.name());
    w.quantity(&keys::GRAVITY, run.gravity);
    w.quantity(&keys::SPIN_UP, time(run.spin_up(), run.spin_up_steps));
    w.quantity(&keys::OUTPUT_INTERVAL, time(run.output_interval(), run.output_steps));
    w.quantity(&keys::DAMPING, run.damping);
    w.text
}

struct Writer {
    text: String,
}

impl Writer {
    fn table(&mut self, name: &str) {
        // Writing to a text cannot fail.
        let _ = writeln!(self.text, "\n[{name}]");
    }

    /// What the flow tells is left to it.
    fn air(&mut self, air: &Air) {
        match &air.flow {
            Flow::Uniform => self.quantity(&keys::VELOCITY, air.velocity),
            Flow::Profile(profile) => self.file(keys::PROFILE, profile.path()),
            Flow::Field(placed) => {
                let PlacedField { field, root, axis, unit, length_constant, time_constant } = placed;
                self.file(keys::FIELD, field.path());
                let root = [root.x, root.y, root.z].map(|x| format!("\"{}\"", Dimension::Length.exact(x)));
                self.line("field_root", &format!("[{}]", root.join(", ")));
                self.name("field_axis", axis.name());
                self.quantity(&keys::FIELD_UNIT, *unit);
                self.line("length_constant", &float(*length_constant));
                self.line("time_constant", &float(*time_constant));
            }
        }
        if !air.is_uniform() {
            self.line("speed_factor", &float(air.speed_factor));
        }
        let from = air.from_flow;
        if !from.turbulence_intensity {
            self.line("turbulence_intensity", &float(air.turbulence_intensity));
        }
        if !from.length_scale {
            self.quantity(&keys::LENGTH_SCALE, air.length_scale);
        }
        if !from.cutoff_frequency {
            self.quantity(&keys::CUTOFF_FREQUENCY, air.cutoff_frequency);
        }
        self.quantity(&keys::AIR_DENSITY, air.density);
        self.quantity(&keys::VISCOSITY, air.kinematic_viscosity);
        match &air.spectrum {
            SpectrumShape::Flat => self.name("spectrum", "flat"),
            SpectrumShape::VonKarman => self.name("spectrum", "von-karman"),
            SpectrumShape::Measured(table) => self.file(keys::SPECTRUM, table.path()),
        }
        match &air.records[..] {
            [] => {}
            [record] => self.file(keys::RECORD, record.path()),
            records => {
                let names: Vec<String> = records.iter().map(|record| text(record.path())).collect();
                self.line("record", &format!("[{}]", names.join(", ")));
            }
        }
        if let Some(rate) = air.records.first().and_then(|record| record.rate) {
            self.quantity(&keys::RECORD_RATE, rate);
        }
        self.name("eddies", air.eddies.name());
        if let EddyModel::Convected { decay_time } = air.eddies
            && decay_time.is_finite()
        {
            self.quantity(&keys::DECAY_TIME, decay_time);
        }
        self.line("harmonics", &air.harmonics.to_string());
    }

    fn file(&mut self, key: &str, path: &Path) {
        let key = key.split_once('.').map_or(key, |(_, key)| key);
        self.line(key, &text(path));
    }

    fn line(&mut self, key: &str, value: &str) {
        let _ = writeln!(self.text, "{key} = {value}");
    }

    fn name(&mut self, key: &str, name: &str) {
        self.line(key, &format!("\"{name}\""));
    }

    fn quantity(&mut self, quantity: &Quantity, value: f64) {
        let key = quantity.key.split_once('.').map_or(quantity.key, |(_, key)| key);
        self.line(key, &format!("\"{}\"", quantity.dimension.exact(value)));
    }
}

/// A path as a TOML text.
fn text(path: &Path) -> String {
    let escaped = path.to_string_lossy().chars().fold(String::new(), |mut text, c| {
        match c {
            '"' | '\\' => text.extend(['\\', c]),
            c if c.is_control() => text.push_str(&format!("\\u{:04X}", u32::from(c))),
            c => text.push(c),
        }
        text
    });
    format!("\"{escaped}\"")
}

/// A TOML float that reads back to the same bits.
fn float(value: f64) -> String {
    let text = shortest(value);
    if text.contains(['.', 'e']) { text } else { format!("{text}.0") }
}

/// The value without the noise of its last digit, where the reader makes the same of it.
fn tidy(value: f64, same: impl Fn(f64) -> bool) -> f64 {
    match format!("{value:.14e}").parse() {
        Ok(tidied) if same(tidied) => tidied,
        _ => value,
    }
}
