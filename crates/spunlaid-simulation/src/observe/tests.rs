//! Every measure has names, a label, a meaning and a unit, and stands in `docs/measures.md`.

use super::*;
use spunlaid_air::{COMPONENT_MEASURES, RECORD_MEASURES};
use spunlaid_fibre::{LOAD_MEASURES, LOAD_POSITION_MEASURES, SPINLINE_MEASURES};
use spunlaid_ground::{Formula, KELVIN, Unit, measure};
use spunlaid_web::{
    FABRIC_MEASURES, FABRIC_PATCH_MEASURES, PATCH_MEASURES, SCAN_MEASURES, SCAN_PERIOD_MEASURES,
    SCAN_STREAK_MEASURES, SCANNED_PATCH_MEASURES, STREAK_LIMIT_MEASURES, STREAK_MEASURES, STRIP_MEASURES,
    THINNEST_PATCH_MEASURES, WEB_MEASURES,
};
use std::collections::BTreeSet;
use std::fmt::Write;

/// Fails unless a name of a column ends with the unit of its values, `_m2_hz`.
fn check_unit(column: &str, unit: Unit) {
    let unit = unit.of_values();
    let ending = match unit.as_str() {
        "1" => return,
        "degC" => "c".to_owned(),
        "degree" => "degrees".to_owned(),
        // A power that is no whole number has words.
        "m-0.5" => "per_sqrt_m".to_owned(),
        "1/m" => "per_m".to_owned(),
        "1/m2" => "per_m2".to_owned(),
        // Not a moment.
        "N/m" => "n_per_m".to_owned(),
        "W/m" => "w_per_m".to_owned(),
        "1/s" => "per_s".to_owned(),
        "(m/s)2/Hz" => "m2_s2_per_hz".to_owned(),
        unit => unit.to_lowercase().replace('/', "_"),
    };
    assert!(column == ending || column.ends_with(&format!("_{ending}")), "{column} in {unit}");
}

/// Fails unless names that are not empty are unique.
fn check_names(names: impl Iterator<Item = &'static str>) {
    let names: Vec<&str> = names.filter(|name| !name.is_empty()).collect();
    assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "{names:?}");
}

/// Fails unless measures have names of their own, which end with the unit, and a meaning; those that studies
/// keep a label too.
fn check<T: 'static>(measures: impl Iterator<Item = &'static Measure<T>>) {
    let all: Vec<&Measure<T>> = measures.collect();
    check_names(all.iter().map(|measure| measure.name));
    check_names(all.iter().map(|measure| measure.column));
    check_names(all.iter().map(|measure| measure.entry()));
    for measure in all {
        let (column, entry) = (measure.column, measure.entry());
        assert!(!column.is_empty() && !measure.meaning.is_empty(), "{column}");
        assert!(measure.name.is_empty() || !measure.label.is_empty(), "{column}");
        check_unit(if entry.is_empty() { column } else { entry }, measure.unit);
        check_unit(column, if entry == column || measure.zero == 0.0 { measure.unit } else { KELVIN });
    }
}

/// Fails unless this holds for measures with formulas and for their errors. Studies keep an error only beside
/// its measure.
fn check_list<T>(measures: &'static [Measure<T>]) {
    check(measure::with_errors(measures));
    check_names(measures.iter().map(|measure| measure.label));
    assert!(measure::with_errors(measures).all(|measure| !matches!(measure.formula, Formula::Observed)));
    let left_out = measures.iter().filter(|measure| measure.name.is_empty());
    let mut errors = left_out.flat_map(|measure| measure.errors);
    assert!(errors.all(|error| error.name.is_empty()));
}

#[test]
fn every_measure_has_names_a_label_a_meaning_and_a_unit() {
    let observed = || DECLARED.iter().flat_map(|declaration| declaration.measures);
    check(observed());
    assert!(observed().all(|measure| measure.column.starts_with(measure.name) && !measure.label.is_empty()));
    assert!(MEASURES.iter().all(|measure| measure.kind == MeasureKind::Number));
    check_list(PATCH_MEASURES);
    check_list(WEB_MEASURES);
    check_list(SCAN_MEASURES);
    check_list(SCANNED_PATCH_MEASURES);
    check_list(SCAN_STREAK_MEASURES);
    check_list(SCAN_PERIOD_MEASURES);
    check_list(STREAK_LIMIT_MEASURES);
    check_list(RECORD_MEASURES);
    check_list(COMPONENT_MEASURES);
    check_list(SPINLINE_MEASURES);
    check_list(LOAD_MEASURES);
    check_list(LOAD_POSITION_MEASURES);
    check_list(FABRIC_MEASURES);
    check_list(FABRIC_PATCH_MEASURES);
    check_list(STRIP_MEASURES);
}

/// A list of measures for `docs/measures.md`.
fn list<T: 'static>(text: &mut String, title: &str, measures: impl Iterator<Item = &'static Measure<T>>) {
    let part = if title.starts_with("Strips") { "md" } else { "10" };
    // Measures with the same meaning share a row.
    let mut rows: Vec<(Vec<String>, Vec<String>, &str)> = Vec::new();
    for measure in measures {
        let name = if measure.entry().is_empty() { measure.column } else { measure.entry() };
        let is_kept = !measure.name.is_empty() && measure.kind == MeasureKind::Number;
        let kept = match measure.column.replace('#', part) {
            column if is_kept && column != name => Some(format!("`{column}`")),
            _ => is_kept.then(String::new),
        };
        let name = format!("`{name}`");
        match rows.last_mut() {
            Some((names, all_kept, meaning))
                if *meaning == measure.meaning && kept.is_some() != all_kept.is_empty() =>
            {
                names.push(name);
                all_kept.extend(kept);
                all_kept.dedup();
            }
            _ => rows.push((vec![name], kept.into_iter().collect(), measure.meaning)),
        }
    }
    let _ = write!(text, "\n## {title}\n\n");
    for (names, kept, meaning) in rows {
        let kept = match &kept[..] {
            [] => String::new(),
            [same] if same.is_empty() => " *study*".to_owned(),
            _ => format!(" (in studies {})", kept.join(", ")),
        };
        let _ = writeln!(text, "- {}{kept}: {meaning}", names.join(", "));
    }
}

/// With `BLESS=1` it writes the page.
#[test]
fn every_measure_is_in_the_docs() {
    let mut text = "# All measures\n\nA test writes this page from the declarations of the measures. Names are those \
        of `summary.json`, of a velocity record those of `analysis.json`, and end with the unit; a name without a unit \
        is a ratio or a count. Studies have those marked *study*, some under another name, here of patches of 10 mm \
        and of strips along MD. [results.md](results.md) describes the files.\n"
        .to_owned();
    let mut groups: Vec<Group> = Vec::new();
    let observed = || DECLARED.iter().flat_map(|declaration| declaration.measures);
    for measure in observed() {
        if !groups.contains(&measure.group) {
            groups.push(measure.group);
        }
    }
    for group in groups {
        list(&mut text, group.title, observed().filter(|measure| measure.group == group));
    }
    list(&mut text, "The patches of a web", measure::with_errors(PATCH_MEASURES));
    list(&mut text, "A web", measure::with_errors(WEB_MEASURES));
    list(&mut text, "The fabric of a web", measure::with_errors(FABRIC_MEASURES));
    list(&mut text, "The patches of a fabric", measure::with_errors(FABRIC_PATCH_MEASURES));
    list(&mut text, "The thinnest spots of a fabric", measure::with_errors(THINNEST_PATCH_MEASURES));
    list(&mut text, "Strips of a fabric", measure::with_errors(STRIP_MEASURES));
    list(&mut text, "Streaks of a fabric, of the defects of its line", measure::with_errors(STREAK_MEASURES));
    list(&mut text, "A scan", measure::with_errors(SCAN_MEASURES));
    list(&mut text, "The patches of a scan", measure::with_errors(SCANNED_PATCH_MEASURES));
    list(&mut text, "The streaks of a scan", measure::with_errors(SCAN_STREAK_MEASURES));
    list(&mut text, "The periods of a scan", measure::with_errors(SCAN_PERIOD_MEASURES));
    list(&mut text, "The least streaks that a scan would show", measure::with_errors(STREAK_LIMIT_MEASURES));
    list(&mut text, "A velocity record", measure::with_errors(RECORD_MEASURES));
    list(&mut text, "A component of a velocity record", measure::with_errors(COMPONENT_MEASURES));
    list(&mut text, "A spinline", measure::with_errors(SPINLINE_MEASURES));
    list(&mut text, "The load of the filaments on their air", measure::with_errors(LOAD_MEASURES));
    list(
        &mut text,
        "The load between the inlet and a position",
        measure::with_errors(LOAD_POSITION_MEASURES),
    );
    let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/measures.md");
    if std::env::var_os("BLESS").is_some() {
        std::fs::write(&path, &text).unwrap();
    }
    let page = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(page == text, "docs/measures.md is not up to date: the test writes it with BLESS=1");
}
