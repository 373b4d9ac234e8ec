//! Makes a case from the written values, the files that they name and the defaults of the other keys.

use super::data::{DataFiles, Layouts};
use super::written_values::{WrittenValues, sorted};
use spunlaid_air::{FieldLayout, Flow, RecordLayout};
use spunlaid_fibre::case::keys::{self, Content, DataFile, Key, Kind, Omission, Value};
use spunlaid_fibre::{Case, Line, Spinline};
use spunlaid_ground::{Diagnostic, Error, Fault, FileError};
use std::path::PathBuf;

/// A case in which every independent key is set. Keys that are counted in whole elements, steps and harmonics are
/// still open.
#[derive(Clone, Debug)]
pub(super) struct OpenCase {
    /// The values that the case was made from.
    pub(super) key_values: WrittenValues,
    /// The case. Numbers that the flow gives are NaN.
    pub(super) case: Case,
    pub(super) notes: Vec<Diagnostic>,
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
    if key_values.has_table("spinline") {
        case.spinline = Some(Box::new(Spinline::UNKNOWN));
    }
    if OF_FED.iter().any(|table| key_values.has_table(table)) {
        case.line = Some(Line::UNKNOWN);
    }
    let mut in_order: Vec<&Key> = keys::all().iter().filter(|key| is_wanted(key)).collect();
    in_order.sort_by_key(|key| rank(key));
    for key in in_order {
        let mut written = key_values.get(key.name).map(|written_value| written_value.value.clone());
        if let (Some(Some(Value::Paths(paths))), Kind::File(kind)) = (&written, key.kind)
            && key.beside_alternative(|other| key_values.get(other).is_some()).is_none()
        {
            written = Some(match load(files, kind, paths, &key_values) {
                Ok((content, remarks)) => {
                    let about_key = |what: Diagnostic| Diagnostic {
                        value: None,
                        ..keys::diagnostic(key.name, 0.0, what)
                    };
                    notes.extend(remarks.into_iter().map(|what| key_values.placed(about_key(what))));
                    Some(Value::Content(content))
                }
                Err(error) => {
                    key_values.reject(key.name, error.into());
                    None
                }
            });
        }
        if let (Some(None), Kind::File(_)) = (&written, key.kind) {
            key_values.suppress_missing(key.relations.gives);
        }
        let is_written = |other: &str| key_values.get(other).is_some();
        let missing = |case: &Case| Some(missing(key, case, &key_values));
        let set = keys::CASE.fill(key, &mut case, written, is_written, missing);
        if let Err(fault) = set
            && !key_values.is_excused(key.name)
        {
            key_values.reject(key.name, fault);
        }
    }
    if key_values.problems.is_empty() {
        Ok(OpenCase { key_values, case, notes })
    } else {
        Err(sorted(key_values.problems).into())
    }
}

/// The tables of which each makes a fibre one that is fed.
const OF_FED: [&str; 3] = ["feed", "belt", "spinline"];

/// Files come first, because they may give the values of other keys. Names come next, because a law or a model
/// decides which numbers have a meaning.
fn rank(key: &Key) -> usize {
    let own = match key.kind {
        Kind::File(_) => 0,
        Kind::Choice(_) => 1,
        _ => 2,
    };
    let before = key.relations.read_after.iter().filter_map(|name| keys::find(name));
    before.map(|key| rank(key) + 1).fold(own, usize::max)
}

/// The fault of a key that is missing.
fn missing(key: &Key, case: &Case, key_values: &WrittenValues) -> Fault {
    let (table, line) = (key.table(), key.example());
    let why = match &case.air.flow {
        Flow::Field(placed) if table == "air" => placed.field.why_no_turbulence(),
        _ => None,
    };
    let of_fed = OF_FED.iter().find(|other| **other != table && key_values.has_table(other));
    match (why, of_fed) {
        (Some(Fault { message, remedy, .. }), _) => Fault::new(
            format!("is missing, and the field does not contain it: it {message}"),
            format!("{remedy}, or add {line} to [{table}]"),
        ),
        (None, Some(other)) if OF_FED.contains(&table) && !key_values.has_table(table) => Fault::new(
            format!("is missing, and a case with [{other}] needs it"),
            format!("add {line} to [{table}], or leave out [{other}]"),
        ),
        _ => Fault::missing(table, &line),
    }
}

/// What the case says of the files of its records.
fn record_layout(key_values: &WrittenValues) -> RecordLayout {
    RecordLayout {
        rate: key_values.number("air.record_rate"),
        skip: key_values.integer("air.record_skip"),
        columns: key_values.text("air.record_columns"),
        time: key_values.text("air.record_time"),
        velocity_unit: key_values.text("air.record_velocity_unit"),
        max_gap: key_values.integer("air.record_max_gap"),
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

/// The content of the files that a key names, and what is said of them.
fn load(
    files: &DataFiles,
    kind: DataFile,
    paths: &[PathBuf],
    key_values: &WrittenValues,
) -> Result<(Content, Vec<Diagnostic>), FileError> {
    let layouts = Layouts { record: record_layout(key_values), field: field_layout(key_values) };
    let (mut all, mut remarks): (Option<Content>, Vec<Diagnostic>) = (None, Vec::new());
    for path in paths {
        let (content, of_file) = files.read(kind, path, &layouts)?;
        let place =
            |what: Diagnostic| if paths.len() > 1 { what.of_file(&path.display().to_string()) } else { what };
        remarks.extend(of_file.into_iter().map(place));
        all = Some(all.map_or(content.clone(), |others| others.with(content)));
    }
    Ok((all.unwrap_or(Content::Records(Vec::new())), remarks))
}

impl OpenCase {
    /// The number of a key, as written or by default. None if it follows from other keys.
    pub(super) fn number(&self, key: &Key) -> Option<f64> {
        let number = match (self.key_values.get(key.name), key.omission) {
            (Some(written_value), _) => match written_value.value.as_ref()? {
                Value::Text(_) => key.get(&self.case)?.number(),
                value => value.number(),
            },
            (None, Omission::Value(text)) if key.read_last => key.kind.accept(text.into()).ok()?.number(),
            (None, _) if key.read_last => None,
            (None, _) => key.get(&self.case)?.number(),
        };
        number.filter(|number| !number.is_nan())
    }
}
