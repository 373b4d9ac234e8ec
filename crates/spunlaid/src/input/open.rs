//! Makes a case from the written values, the files that they name and the defaults of the other keys.

use super::data::DataFiles;
use super::written_values::{WrittenValue, WrittenValues, sorted};
use crate::air::{Air, EddyModel, FileContent, Flow, Measured, PlacedField, RecordLayout, SpectrumShape};
use crate::case::keys::{self, Content, FileKind, Key, Kind, Omission, TAYLOR, Value};
use crate::case::{Case, Note, Remark};
use crate::chain::schemes::Scheme;
use crate::error::{Error, Fault, FileError};
use crate::field::FieldLayout;
use crate::line::Line;
use crate::sort::sort_by_key;
use crate::spinline::Spinline;
use std::path::PathBuf;

/// A case in which every independent key is set. Keys that are counted in whole elements, steps and harmonics are
/// still open.
#[derive(Clone)]
pub(super) struct OpenCase {
    /// The values that the case was made from.
    pub(super) key_values: WrittenValues,
    /// The case. Numbers that the flow gives are NaN.
    pub(super) case: Case,
    pub(super) notes: Vec<Note>,
}

/// Sets the written values and the defaults of the other keys.
///
/// # Errors
/// Every problem with any key.
pub(super) fn open(key_values: WrittenValues, files: &DataFiles) -> Result<OpenCase, Error> {
    open_part(key_values, files, |_| true)
}

/// [`open`] for a part of the keys.
pub(super) fn open_part(
    mut key_values: WrittenValues,
    files: &DataFiles,
    is_wanted: impl Fn(&Key) -> bool,
) -> Result<OpenCase, Error> {
    let (mut case, mut notes) = (Case::unset(), Vec::new());
    let fed = ["feed", "belt", "spinline"].iter().any(|table| key_values.has_table(table));
    if key_values.has_table("spinline") {
        case.spinline = Some(Box::new(Spinline::UNKNOWN));
    }
    if fed {
        case.line = Some(Line::UNKNOWN);
    }
    let twice = ["air.profile", "air.field"].map(|key| key_values.get(key).is_some()) == [true; 2];
    // Files come first, because they may give the values of other keys. Names come next, because a law or a model
    // decides which numbers have a meaning.
    let rank = |key: &&Key| match key.kind {
        Kind::File(_) => 0_usize,
        Kind::Choice(_) => 1,
        // It may follow from velocity and length scale.
        _ if key.name == "air.cutoff_frequency" => 3,
        _ => 2,
    };
    let mut in_order: Vec<&Key> = keys::all().iter().filter(|key| is_wanted(key)).collect();
    sort_by_key(&mut in_order, rank);
    for key in in_order {
        let Some(WrittenValue { place, shown, value }) = key_values.get(key.name).cloned() else {
            match key.omission {
                // A key without a meaning for this case refuses its default, which is then not needed.
                Omission::Value(text) if !key.counted => {
                    drop(key.set(&mut case, if fed { default_if_fed(key.name, text) } else { text }));
                }
                Omission::Follows(_) if key.is_derived(&case) => {}
                Omission::Follows(_) if fed && REQUIRED_IF_FED.iter().any(|(name, _)| *name == key.name) => {
                    let (_, line) =
                        REQUIRED_IF_FED.iter().find(|(name, _)| *name == key.name).unwrap_or(&("", ""));
                    let table = key.table();
                    let other = if table == "feed" {
                        "belt"
                    } else if key_values.has_table("feed") {
                        "feed"
                    } else {
                        "spinline"
                    };
                    let fault = if key_values.has_table(table) {
                        Fault::missing(table, line)
                    } else {
                        Fault::new(
                            format!("is missing, and a case with [{other}] needs it"),
                            format!("add {line} to [{table}], or leave out [{other}]"),
                        )
                    };
                    key_values.reject(key.name, fault);
                }
                Omission::Required(_) if key.is_derived(&case) => {}
                Omission::Required(_)
                    if !(infer_number(&mut case.air, key.name)
                        || key_values.is_excused(key.name)
                        || key.name == "fibre.diameter"
                            && key_values.get("fibre.linear_density").is_some()) =>
                {
                    let (table, line) = (key.table(), key.example());
                    let why = match &case.air.flow {
                        Flow::Field(placed) if key.table() == "air" => placed.field.why_no_turbulence(),
                        _ => None,
                    };
                    let fault = match why {
                        Some(Fault { message, remedy, .. }) => Fault::new(
                            format!("is missing, and the field does not contain it: it {message}"),
                            format!("{remedy}, or add {line} to [{table}]"),
                        ),
                        None => Fault::missing(table, &line),
                    };
                    key_values.reject(key.name, fault);
                }
                _ => {}
            }
            continue;
        };
        let set = match (value, key.kind) {
            (None, Kind::File(kind)) => {
                key_values.excuse(missed_with(kind));
                continue;
            }
            (None, _) => continue,
            _ if twice && key.name == "air.profile" => {
                let (other, remedy) = ("air.field", "the air is one or the other; leave one out");
                Err(Fault::excludes(other, remedy))
            }
            (Some(Value::Paths(paths)), Kind::File(kind)) => match load(files, kind, &paths, &key_values) {
                Ok((content, remarks)) => {
                    notes.extend(remarks.into_iter().map(|what| Note {
                        place: place.clone(),
                        key: key.name.to_owned(),
                        value: shown.clone(),
                        what,
                    }));
                    key.apply(&mut case, &Value::Content(content))
                }
                Err(error) => {
                    key_values.excuse(missed_with(kind));
                    key_values.reject(key.name, error.into());
                    continue;
                }
            },
            (Some(_), _) if key.counted => Ok(()),
            (Some(Value::Text(word)), Kind::Quantity(..)) if word == TAYLOR => by_taylor(&mut case.air),
            (Some(value), _) => match rival(key.name, |other| key_values.get(other).is_some()) {
                Some((other, remedy)) => Err(Fault::excludes(other, remedy)),
                None => key.apply(&mut case, &value),
            },
        };
        if let Err(fault) = set
            && !key_values.is_excused(key.name)
        {
            key_values.reject(key.name, fault);
        }
    }
    if let Flow::Field(placed) = &mut case.air.flow
        && key_values.get("air.field_root").is_none()
    {
        placed.root = PlacedField::middle_of_inlet(&placed.field, placed.axis, placed.unit);
    }
    if key_values.problems.is_empty() {
        Ok(OpenCase { key_values, case, notes })
    } else {
        Err(sorted(key_values.problems).into())
    }
}

/// Keys that a fed fibre needs, with a line for each.
const REQUIRED_IF_FED: [(&str, &str); 3] = [
    ("feed.speed", "speed = \"50 m/s\""),
    ("belt.distance", "distance = \"0.5 m\""),
    ("belt.speed", "speed = \"3 m/s\""),
];

/// The default of a key for a fed fibre, which may differ from that of others.
fn default_if_fed(key: &str, text: &'static str) -> &'static str {
    match key {
        "run.scheme" => Scheme::ImplicitTension.name(),
        "air.eddies" => EddyModel::Convected { decay_time: f64::INFINITY }.name(),
        _ => text,
    }
}

/// A written key that says the same as this one in other words, and the way out.
pub(super) fn rival(key: &str, is_written: impl Fn(&str) -> bool) -> Option<(&'static str, &'static str)> {
    let (others, remedy): (&[&'static str], _) = match key {
        "spinline.material.viscosity" => {
            (&["spinline.melt_flow_rate"], "the melt flow rate gives the viscosity; write one of the two")
        }
        "air.field_omega" => (&["air.field_epsilon"], "either gives ε; write one of the two"),
        "fibre.linear_density" => (&["fibre.diameter"], "either gives the other; write one of the two"),
        "air.temperature" => (
            &["air.density", "air.kinematic_viscosity"],
            "the temperature gives density and viscosity; leave it out, or leave out both of these",
        ),
        _ => return None,
    };
    Some((others.iter().find(|other| is_written(other))?, remedy))
}

/// Sets the cut-off frequency by Taylor's hypothesis: eddies of length `L` that pass at velocity `U` make `U/(4 L)`.
fn by_taylor(air: &mut Air) -> Result<(), Fault> {
    if !air.is_uniform() || air.from_flow.length_scale {
        let (needed, remedy) = ("air.velocity and air.length_scale", "write a frequency, or leave it out");
        return Err(Fault::needs(needed, remedy));
    }
    // NaN where either is missing, which has been reported.
    air.cutoff_frequency = air.velocity.abs() / (4.0 * air.length_scale);
    Ok(())
}

/// Keys that may be missing only because a file cannot be used.
const fn missed_with(kind: FileKind) -> &'static str {
    match kind {
        FileKind::Spectrum => "air.cutoff_frequency",
        FileKind::Profile | FileKind::Field | FileKind::Records => "air.",
        FileKind::SpinlineAir | FileKind::Polymer => "spinline.",
    }
}

/// What the case says of the files of its records.
fn record_layout(key_values: &WrittenValues) -> RecordLayout {
    let whole = |key: &str| match key_values.get(key).and_then(|written_value| written_value.value.as_ref()) {
        Some(Value::Whole(number)) => Some(*number),
        _ => None,
    };
    RecordLayout {
        rate: key_values.number("air.record_rate"),
        skip: whole("air.record_skip"),
        columns: key_values.text("air.record_columns"),
        time: key_values.text("air.record_time"),
        velocity_unit: key_values.text("air.record_velocity_unit"),
        max_gap: whole("air.record_max_gap"),
    }
}

/// The arrays of the field that the case names.
fn field_layout(key_values: &WrittenValues) -> FieldLayout {
    FieldLayout {
        velocity: key_values.text("air.field_velocity"),
        k: key_values.text("air.field_k"),
        epsilon: key_values.text("air.field_epsilon"),
        omega: key_values.text("air.field_omega"),
    }
}

fn load(
    files: &DataFiles,
    kind: FileKind,
    paths: &[PathBuf],
    key_values: &WrittenValues,
) -> Result<(Content, Vec<Remark>), FileError> {
    let path = paths.first().cloned().unwrap_or_default();
    let content = match kind {
        FileKind::Profile => Content::Profile(files.profile(&path)?),
        FileKind::Spectrum => Content::Spectrum(files.spectrum(&path)?),
        FileKind::SpinlineAir => Content::SpinlineAir(files.spinline_air(&path)?),
        FileKind::Polymer => Content::Polymer(files.polymer(&path)?),
        FileKind::Records => {
            let layout = record_layout(key_values);
            let records = paths.iter().map(|path| files.record(path, &layout));
            let records: Vec<_> = records.collect::<Result<_, _>>()?;
            let several = records.len() > 1;
            let of = |(record, remarks): &(FileContent<Measured>, Vec<Remark>)| {
                let file = record.path().display().to_string();
                let remarks = remarks.iter().cloned();
                remarks.map(|what| if several { what.of_file(&file) } else { what }).collect::<Vec<_>>()
            };
            let remarks = records.iter().flat_map(of).collect();
            return Ok((Content::Records(records.into_iter().map(|(record, _)| record).collect()), remarks));
        }
        FileKind::Field => {
            let (field, remarks) = files.field(&path, &field_layout(key_values))?;
            return Ok((Content::Field(field), remarks));
        }
    };
    Ok((content, Vec::new()))
}

/// Takes a number of the air that the case leaves out from the flow or a file, and says whether one of them gives it. A
/// number from a file is set here; a number from the flow is set later, when the air is settled.
fn infer_number(air: &mut Air, key: &str) -> bool {
    let (tells, uniform) = (air.flow.numbers(), air.is_uniform());
    let record = air.records.first().map(|record| record.says);
    let highest = match &air.spectrum {
        SpectrumShape::Measured(table) => Some(table.highest()),
        _ => None,
    };
    let (from, mut of_velocity) = (&mut air.from_flow, false);
    let (number, from_flow, tells, file) = match key {
        "air.velocity" => {
            (&mut air.velocity, &mut of_velocity, !uniform, record.and_then(|says| says.velocity))
        }
        "air.turbulence_intensity" => (
            &mut air.turbulence_intensity,
            &mut from.turbulence_intensity,
            tells.turbulence_intensity,
            record.and_then(|says| says.turbulence_intensity),
        ),
        "air.length_scale" => (
            &mut air.length_scale,
            &mut from.length_scale,
            tells.length_scale,
            record.and_then(|says| says.length_scale),
        ),
        "air.cutoff_frequency" => (
            &mut air.cutoff_frequency,
            &mut from.cutoff_frequency,
            tells.cutoff_frequency,
            highest.or(record.map(|says| says.cutoff_frequency)),
        ),
        _ => return false,
    };
    *from_flow = tells;
    if !tells && let Some(file) = file {
        *number = file;
    }
    tells || file.is_some()
}

impl OpenCase {
    /// The number of a key, as written or by default. None if it follows from other keys.
    pub(super) fn number(&self, key: &Key) -> Option<f64> {
        let number = match (self.key_values.get(key.name), key.omission) {
            (Some(written_value), _) => match written_value.value.as_ref()? {
                Value::Text(_) => key.get(&self.case)?.number(),
                value => value.number(),
            },
            (None, Omission::Value(text)) if key.counted => key.kind.accept(text.into()).ok()?.number(),
            (None, _) if key.counted => None,
            (None, _) => key.get(&self.case)?.number(),
        };
        number.filter(|number| !number.is_nan())
    }
}
