//! The settings that a page can change, from the table of keys.

use serde::Serialize;
use spunlaid::fibre::Case;
use spunlaid::fibre::case::keys::{self, Key, Kind, Omission, Value};
use spunlaid::ground::Dimension;

/// A slider or a choice.
#[derive(Debug, Serialize, PartialEq)]
pub(super) struct Setting {
    key: &'static str,
    table: &'static str,
    /// With `*italics*` and `_{subscripts}`.
    label: &'static str,
    meaning: &'static str,
    /// What applies if it is left out, and the values that it takes.
    about: String,
    /// Whether it changes at once; otherwise the fibres start again, from the present shape where they can.
    in_flight: bool,
    /// Whether it is one of the first to look at.
    first: bool,
    #[serde(flatten)]
    takes: SettingKind,
}

#[derive(Debug, Serialize, PartialEq)]
#[serde(tag = "takes", rename_all = "snake_case")]
enum SettingKind {
    /// A quantity; the ends of the slider in SI units, and whether it is logarithmic.
    Quantity { low: f64, high: f64, logarithmic: bool },
    /// A word.
    Word { words: Vec<&'static str> },
    /// A whole number.
    Whole { low: u64 },
}

/// The present value of a setting.
#[derive(Debug, Serialize, PartialEq)]
pub(super) struct SettingValue {
    key: &'static str,
    /// In SI units, if it is a quantity.
    si: Option<f64>,
    /// For people.
    text: String,
}

/// Everything that can be changed in a case.
pub(super) fn settings(case: &Case) -> Vec<Setting> {
    shown(case).filter_map(|(key, value)| setting(case, key, &value)).collect()
}

/// The present values, in the same order.
pub(super) fn present(case: &Case) -> Vec<SettingValue> {
    shown(case)
        .filter(|(key, value)| setting(case, key, value).is_some())
        .map(|(key, value)| {
            let text = match (&value, key.kind.dimension()) {
                (Value::Number(number), Some(dimension)) => dimension.pretty_to(*number, 4),
                (Value::Whole(number), _) => number.to_string(),
                (Value::Text(text), _) => text.clone(),
                _ => String::new(),
            };
            SettingValue { key: key.name, si: value.number(), text }
        })
        .collect()
}

fn shown(case: &Case) -> impl Iterator<Item = (&'static Key, Value)> {
    // How long a run lasts and what it records has no meaning while a page looks on.
    let is_of_run = |key: &Key| key.table() == "run" && key.dimension().is_some() && !key.in_flight;
    keys::all()
        .iter()
        .filter(move |key| !is_of_run(key) && !key.is_derived(case))
        .filter_map(move |key| Some((key, key.get(case)?)))
}

fn setting(case: &Case, key: &'static Key, value: &Value) -> Option<Setting> {
    let takes = match (&key.kind, key.slider, value) {
        (Kind::Quantity(..), Some((low, high)), Value::Number(now)) => {
            // A slider reaches to the value of the case.
            let (low, high) = (low.min(*now), high.max(*now));
            SettingKind::Quantity { low, high, logarithmic: low > 0.0 && high / low >= 50.0 }
        }
        // A law of the drag may also come from a file, which a page does not choose.
        (Kind::File(_), _, Value::Text(_)) if !key.in_flight => return None,
        (Kind::Choice(_) | Kind::File(_), _, Value::Text(_)) => SettingKind::Word { words: key.kind.words() },
        (Kind::Whole(low, _), _, Value::Whole(_)) if key.name == "run.seed" => {
            SettingKind::Whole { low: *low }
        }
        _ => return None,
    };
    let omission = match (key.omission, key.default_in(case)) {
        (_, Some(value)) => format!(" Default: {value}."),
        (Omission::Follows(words), None) => format!(" If it is left out: {words}."),
        (_, None) => String::new(),
    };
    let unit = match key.kind.dimension() {
        Some(Dimension::Ratio) | None => String::new(),
        Some(dimension) => format!(", in {} for example", dimension.si_unit()),
    };
    let first =
        matches!(key.omission, Omission::Required(_)) || ["spinline", "feed", "belt"].contains(&key.table());
    Some(Setting {
        key: key.name,
        table: key.table(),
        label: key.label,
        meaning: key.meaning,
        about: format!("Takes {}{unit}.{omission}", key.allowed()),
        in_flight: key.in_flight,
        first: first && !matches!(takes, SettingKind::Word { .. }),
        takes,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use spunlaid::input::{read_case, starter_case, starter_case_of_fed};

    #[test]
    fn sliders_and_choices_come_from_the_table_of_keys() {
        let (case, _) = read_case((starter_case(), "a.toml"), &[]).unwrap();
        let all = settings(&case);
        assert_eq!(
            all.iter().map(|s| s.key).collect::<Vec<_>>(),
            present(&case).iter().map(|p| p.key).collect::<Vec<_>>()
        );
        let setting = |name: &str| all.iter().find(|s| s.key == name).unwrap();
        assert_eq!(
            setting("air.velocity").takes,
            SettingKind::Quantity { low: 0.0, high: 60.0, logarithmic: false }
        );
        assert_eq!(
            setting("fibre.diameter").takes,
            SettingKind::Quantity { low: 5e-6, high: 2e-4, logarithmic: false }
        );
        assert_eq!(
            setting("fibre.youngs_modulus").takes,
            SettingKind::Quantity { low: 1e7, high: 1e10, logarithmic: true }
        );
        assert!(
            setting("air.velocity").in_flight
                && setting("air.velocity").first
                && !setting("air.length_scale").in_flight
        );
        assert_eq!(
            setting("fibre.root").takes,
            SettingKind::Word { words: vec!["pinned", "clamped", "free"] }
        );
        assert!(setting("run.seed").about.contains("Default: 1."));
        let first: Vec<&str> = all.iter().filter(|s| s.first).map(|s| s.key).collect();
        assert_eq!(first.len(), 8, "{first:?}");
        assert_eq!(present(&case).iter().find(|p| p.key == "fibre.diameter").unwrap().text, "50 µm");
    }

    #[test]
    fn a_fibre_that_begins_at_the_die_has_sliders_of_its_spinline() {
        const SPINLINE: &str = "[spinline]\npolymer = \"pp\"\nmelt_flow_rate = 35\ndie_temperature = \"230 °C\"\n\
            hole_diameter = \"0.6 mm\"\nthroughput = \"0.5 g/min\"\nlength = \"1.2 m\"\nvelocity = \"50 m/s\"\n";
        let fed = starter_case_of_fed();
        let given = |key: &str| {
            ["diameter", "density", "youngs_modulus", "speed = \"50"].iter().any(|name| key.starts_with(name))
        };
        let kept: Vec<&str> = fed.lines().filter(|line| !given(line)).collect();
        let text = kept.join("\n").replace("[feed]", SPINLINE);
        let (case, _) = read_case((&text, "a.toml"), &[]).unwrap();
        let all = settings(&case);
        let first: Vec<&str> =
            all.iter().filter(|s| s.first && s.table == "spinline").map(|s| s.key).collect();
        assert_eq!(
            first,
            [
                "spinline.melt_flow_rate",
                "spinline.die_temperature",
                "spinline.throughput",
                "spinline.velocity",
                "spinline.cross_velocity",
                "spinline.temperature",
                "spinline.nusselt_factor",
                "spinline.drag_factor"
            ]
        );
        // What the spinline gives has none.
        for key in ["feed.speed", "fibre.diameter", "fibre.density", "fibre.youngs_modulus"] {
            assert!(!all.iter().any(|setting| setting.key == key), "{key}");
        }
        let text = |key: &str| present(&case).into_iter().find(|one| one.key == key).unwrap().text;
        assert_eq!(
            (text("spinline.throughput"), text("spinline.die_temperature")),
            ("0.5 g/min".to_owned(), "230 °C".to_owned())
        );
    }

    #[test]
    fn a_fed_fibre_has_feed_and_belt_and_no_length() {
        let (case, _) = read_case((starter_case_of_fed(), "a.toml"), &[]).unwrap();
        let all = settings(&case);
        for (key, is_setting) in [("feed.speed", true), ("belt.speed", true), ("fibre.length", false)] {
            assert_eq!(all.iter().any(|s| s.key == key && s.first), is_setting, "{key}");
        }
        assert!(!all.iter().any(|setting| setting.table.starts_with("spinline")));
    }
}
