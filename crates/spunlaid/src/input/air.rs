//! The air of a case file.

use super::data::DataFiles;
use super::document::{Document, Entry, kind};
use super::layout;
use crate::air::{
    Air, Axis, EddyModel, Flow, FromFile, FromFlow, LENGTH_CONSTANT, Measured, PlacedField, Said,
    SpectrumShape, TIME_CONSTANT,
};
use crate::case::keys::{self, Quantity};
use crate::case::{Note, Remark};
use crate::error::{Fault, FileError, Place};
use std::path::PathBuf;
use toml::de::DeValue;

/// Default density `ρ_a` of air at 20 °C [kg/m³].
const AIR_DENSITY: f64 = 1.204;
/// Default kinematic viscosity `ν` of air at 20 °C [m²/s].
const AIR_VISCOSITY: f64 = 1.51e-5;

/// What a document says of the air. Numbers that the flow tells are NaN until it is settled.
pub(super) fn read(d: &mut Document<'_>, files: &DataFiles) -> Air {
    let flow = flow(d, files);
    let spectrum = spectrum(d, files);
    let records = records(d, files);
    let said = records.first().map_or_else(Said::default, |record| record.says);
    let tells = flow.tells();
    let mut from_flow = FromFlow::default();
    let velocity = if flow == Flow::Uniform {
        number(d, &keys::VELOCITY, said.velocity, "velocity = \"10 m/s\"")
    } else {
        if let Some(Entry { place, shown, .. }) = d.take(keys::VELOCITY.key) {
            let flow = if matches!(flow, Flow::Field(_)) { keys::FIELD } else { keys::PROFILE };
            d.reject(place, keys::VELOCITY.key, shown, Fault::FlowTells { flow });
        }
        f64::NAN
    };
    let unless_told = |d: &mut Document<'_>, quantity, told: bool, from: &mut bool, said, line| {
        *from = told && !d.has(quantity);
        if *from { f64::NAN } else { number(d, quantity, said, line) }
    };
    let turbulence_intensity = unless_told(
        d,
        &keys::TURBULENCE_INTENSITY,
        tells.turbulence_intensity,
        &mut from_flow.turbulence_intensity,
        said.turbulence_intensity,
        "turbulence_intensity = 0.1",
    );
    let length_scale = unless_told(
        d,
        &keys::LENGTH_SCALE,
        tells.length_scale,
        &mut from_flow.length_scale,
        said.length_scale,
        "length_scale = \"50 mm\"",
    );
    let highest = match &spectrum {
        SpectrumShape::Measured(table) => Some(table.highest()),
        _ => None,
    };
    let cutoff_frequency = unless_told(
        d,
        &keys::CUTOFF_FREQUENCY,
        tells.cutoff_frequency,
        &mut from_flow.cutoff_frequency,
        highest.or(records.first().map(|_| said.cutoff_frequency)),
        "cutoff_frequency = \"100 Hz\"",
    );
    let speed_factor = match d.take(keys::SPEED_FACTOR.key) {
        Some(Entry { place, shown, .. }) if flow == Flow::Uniform => {
            let (needed, remedy) = ("air.profile or air.field", "change air.velocity");
            d.reject(place, keys::SPEED_FACTOR.key, shown, Fault::Needs { needed, remedy });
            1.0
        }
        Some(entry) => d.quantity(&keys::SPEED_FACTOR, entry),
        None => 1.0,
    };
    Air {
        velocity,
        turbulence_intensity,
        length_scale,
        cutoff_frequency,
        density: d.optional(&keys::AIR_DENSITY).unwrap_or(AIR_DENSITY),
        kinematic_viscosity: d.optional(&keys::VISCOSITY).unwrap_or(AIR_VISCOSITY),
        harmonics: 0,
        flow,
        from_flow,
        speed_factor,
        spectrum,
        eddies: eddies(d),
        records,
    }
}

/// A quantity as written, or else as measured.
fn number(d: &mut Document<'_>, quantity: &Quantity, said: Option<f64>, line: &'static str) -> f64 {
    match said {
        Some(said) => d.optional(quantity).unwrap_or(said),
        None => d.required(quantity, line),
    }
}

fn flow(d: &mut Document<'_>, files: &DataFiles) -> Flow {
    let (profile, field) = (d.file(keys::PROFILE), d.file(keys::FIELD));
    if let (Some(profile), Some(_)) = (&profile, &field) {
        let (other, remedy) = (keys::FIELD, "the air is one or the other; leave one out");
        let fault = Fault::Excludes { other, remedy };
        d.reject(profile.place.clone(), keys::PROFILE, profile.shown.clone(), fault);
    }
    let flow = match (profile, field) {
        (None, None) => {
            refuse_without_field(d);
            return Flow::Uniform;
        }
        (_, Some(named)) => placed_field(d, files, named).map(Flow::Field),
        (Some(named), None) => {
            refuse_without_field(d);
            d.loaded(keys::PROFILE, named, |path| files.profile(path)).map(Flow::Profile)
        }
    };
    flow.unwrap_or_else(|| {
        // Who knows what it would have told.
        d.excuse("air.");
        Flow::Uniform
    })
}

fn placed_field(d: &mut Document<'_>, files: &DataFiles, named: Named) -> Option<PlacedField> {
    let place = named.place.clone();
    let shown = named.shown.clone();
    let axis = d.choice(keys::FIELD_AXIS, &Axis::ALL.map(|axis| (axis.name(), axis)));
    let axis = axis.unwrap_or(Axis::ALL[0]);
    let unit = d.optional(&keys::FIELD_UNIT).unwrap_or(1.0);
    let length_constant = d.optional(&keys::LENGTH_CONSTANT).unwrap_or(LENGTH_CONSTANT);
    let time_constant = d.optional(&keys::TIME_CONSTANT).unwrap_or(TIME_CONSTANT);
    let root = d.point(keys::FIELD_ROOT);
    let (field, warnings) = d.loaded(keys::FIELD, named, |path| files.field(path))?;
    for warning in warnings {
        let (place, key) = (place.clone(), keys::FIELD.to_owned());
        d.notes.push(Note { place, key, value: shown.clone(), what: Remark::Field(warning) });
    }
    let root = root.unwrap_or_else(|| PlacedField::middle_of_inlet(&field, axis, unit));
    Some(PlacedField { field, root, axis, unit, length_constant, time_constant })
}

/// Keys that only a field gives a meaning.
fn refuse_without_field(d: &mut Document<'_>) {
    let (length_constant, time_constant) = (keys::LENGTH_CONSTANT.key, keys::TIME_CONSTANT.key);
    for key in [keys::FIELD_ROOT, keys::FIELD_AXIS, keys::FIELD_UNIT.key, length_constant, time_constant] {
        if let Some(Entry { place, shown, .. }) = d.take(key) {
            let (needed, remedy) = (keys::FIELD, "leave it out, or name the file of a CFD field");
            d.reject(place, key, shown, Fault::Needs { needed, remedy });
        }
    }
}

fn spectrum(d: &mut Document<'_>, files: &DataFiles) -> SpectrumShape {
    match d.file(keys::SPECTRUM) {
        None => SpectrumShape::Flat,
        Some(named) => match named.text.as_str() {
            "flat" => SpectrumShape::Flat,
            "von-karman" => SpectrumShape::VonKarman,
            // No name of a table.
            text if !text.contains('.') => {
                let allowed = vec!["flat", "von-karman", "spectrum.csv"];
                let nearest = layout::nearest(text, allowed.iter().map(|name| (*name, 0.0)));
                let nearest = nearest.map(|name| format!("\"{name}\""));
                d.reject(named.place, keys::SPECTRUM, named.shown, Fault::NotOneOf { nearest, allowed });
                SpectrumShape::Flat
            }
            _ => match d.loaded(keys::SPECTRUM, named, |path| files.spectrum(path)) {
                Some(table) => SpectrumShape::Measured(table),
                None => {
                    d.excuse(keys::CUTOFF_FREQUENCY.key);
                    SpectrumShape::Flat
                }
            },
        },
    }
}

fn records(d: &mut Document<'_>, files: &DataFiles) -> Vec<FromFile<Measured>> {
    let rate = d.take(keys::RECORD_RATE.key);
    let Some(entry) = d.take(keys::RECORD) else {
        if let Some(Entry { place, shown, .. }) = rate {
            let (needed, remedy) = ("air.record", "leave it out");
            d.reject(place, keys::RECORD_RATE.key, shown, Fault::Needs { needed, remedy });
        }
        return Vec::new();
    };
    let rate = rate.map(|entry| d.quantity(&keys::RECORD_RATE, entry));
    let names: Option<Vec<String>> = match &entry.value {
        DeValue::String(text) => Some(vec![text.to_string()]),
        DeValue::Array(list) if !list.is_empty() => {
            list.iter().map(|one| one.get_ref().as_str().map(str::to_owned)).collect()
        }
        _ => None,
    };
    let Some(names) = names else {
        let found = kind(&entry.value);
        let wanted = "the path of a record, \"probe.csv\", or a list with one for each eddy".to_owned();
        d.reject(entry.place, keys::RECORD, entry.shown, Fault::WrongType { found, wanted });
        return Vec::new();
    };
    let mut records = Vec::new();
    for text in names {
        let path = d.beside(&entry.place, &text);
        let named = Named { place: entry.place.clone(), shown: entry.shown.clone(), text, path };
        match d.loaded(keys::RECORD, named, |path| files.record(path, rate)) {
            Some(record) => records.push(record),
            None => {
                d.excuse("air.");
                return Vec::new();
            }
        }
    }
    let first = records.first().map_or(0.0, |record| 1.0 / record.interval);
    let same = |rate: f64| (rate / first - 1.0).abs() < 1e-9;
    if let Some(other) = records.iter().map(|record| 1.0 / record.interval).find(|rate| !same(*rate)) {
        d.reject(entry.place, keys::RECORD, entry.shown, Fault::RecordRates { first, other });
    }
    records
}

fn eddies(d: &mut Document<'_>) -> EddyModel {
    let convected = d.choice(keys::EDDIES, &[("independent", false), ("convected", true)]).unwrap_or(false);
    match d.take(keys::DECAY_TIME.key) {
        Some(Entry { place, shown, .. }) if !convected => {
            let (needed, remedy) =
                ("air.eddies = \"convected\"", "leave it out, or have the eddies convected");
            d.reject(place, keys::DECAY_TIME.key, shown, Fault::Needs { needed, remedy });
            EddyModel::Independent
        }
        Some(entry) => EddyModel::Convected { decay_time: d.quantity(&keys::DECAY_TIME, entry) },
        None if convected => EddyModel::Convected { decay_time: f64::INFINITY },
        None => EddyModel::Independent,
    }
}

/// A file as the case names it.
struct Named {
    place: Place,
    shown: Option<String>,
    text: String,
    path: PathBuf,
}

impl Document<'_> {
    /// A text that may be the path of a file.
    fn file(&mut self, key: &str) -> Option<Named> {
        let Entry { place, shown, value } = self.take(key)?;
        match &value {
            DeValue::String(text) if !text.is_empty() => {
                let (path, text) = (self.beside(&place, text), text.to_string());
                Some(Named { place, shown, text, path })
            }
            other => {
                let wanted = "the path of a file, in quotes".to_owned();
                let found = if other.is_str() { "an empty text" } else { kind(other) };
                self.reject(place, key, shown, Fault::WrongType { found, wanted });
                None
            }
        }
    }

    /// The content of a file; what is wrong with it is told.
    fn loaded<T>(
        &mut self,
        key: &str,
        named: Named,
        load: impl FnOnce(&std::path::Path) -> Result<T, FileError>,
    ) -> Option<T> {
        match load(&named.path) {
            Ok(content) => Some(content),
            Err(error) => {
                self.reject(named.place, key, named.shown, Fault::File(Box::new(error)));
                None
            }
        }
    }
}
