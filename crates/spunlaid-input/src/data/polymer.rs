//! Reads the file of a polymer: the table `[spinline.material]` with every constant, as in a case.

use crate::document;
use crate::write::toml_value;
use spunlaid_fibre::case::keys::{self, Key};
use spunlaid_fibre::{Case, Material, Polymer, PolymerFile, PolymerSource, Spinline};
use spunlaid_ground::error::Place;
use spunlaid_ground::{Diagnostic, Fault, FileError, Position};

/// The table of the constants.
const TABLE: &str = "spinline.material";

/// Reads the constants. Messages call the file `name`.
pub(super) fn read(text: &str, name: &str) -> Result<PolymerFile, FileError> {
    let problem = |key: &str, what: Fault| {
        let place = Place::in_file(name, Position::Whole);
        Box::new(Diagnostic { place, key: key.to_owned(), ..what.into() })
    };
    let key_values = document::read(&keys::CASE, text, name, &[]).map_err(|error| {
        let first = error.problems().first().cloned();
        first.map_or_else(|| problem("", Fault::plain(error.to_string())), Box::new)
    })?;
    if let Some(first) = key_values.problems.first() {
        return Err(Box::new(first.clone()));
    }
    let mut case = Case { spinline: Some(Box::new(Spinline::UNKNOWN)), ..Case::unset() };
    for (key, written_value) in key_values.all() {
        let constant = keys::find(key).filter(|key| key.table() == TABLE);
        let (Some(constant), Some(value)) = (constant, &written_value.value) else {
            let what = Fault::new(
                "does not belong in the file of a polymer",
                format!("it takes the table [{TABLE}] only"),
            );
            return Err(Box::new(Diagnostic { place: written_value.place.clone(), ..*problem(key, what) }));
        };
        constant.apply(&mut case, value).map_err(|what| problem(key, what))?;
    }
    let line = case.spinline.as_deref().cloned().unwrap_or(Spinline::UNKNOWN);
    // What every polymer has: the constants of one that does not crystallise.
    let polymer = Polymer::Pla;
    let usual = Spinline {
        material: Material { crystals: Material::UNKNOWN.crystals, ..polymer.material(false) },
        polymer: PolymerSource::Known(polymer),
        ..Spinline::UNKNOWN
    };
    let usual = Case { spinline: Some(Box::new(usual)), ..Case::unset() };
    let missing = |key: &'static Key| Some((key, key.get(&usual)?)).filter(|_| key.get(&case).is_none());
    if let Some((key, value)) = keys::keys_of_table(TABLE).find_map(missing) {
        let example = format!("a line like {} = {}", key.short(), toml_value(&key.kind, value));
        let what =
            Fault::new("is missing", format!("the file of a polymer needs every constant; add {example}"));
        return Err(problem(key.name, what));
    }
    let Some(source) = line.source else {
        let what = Fault::new(
            "is missing",
            "say where the constants come from: source = \"data sheet of the grade\"",
        );
        return Err(problem("spinline.material.source", what));
    };
    Ok(PolymerFile { material: line.material, source })
}
