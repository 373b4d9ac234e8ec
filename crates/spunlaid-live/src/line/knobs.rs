//! Knobs as pages have them: values in the unit of the knob.

use super::found::SEEN;
use super::known_web::{DIGITS, KnownWeb};
use crate::message::KeyValue;
use serde_json::{Value as Json, json};
use spunlaid::experiment::Change;
use spunlaid::ground::units::rounded;
use spunlaid::ground::{Effect, Fault};
use spunlaid::input::Knob;

/// Digits that a slider has.
const SLIDER_DIGITS: usize = 3;

/// The unit of a knob, as it is shown.
pub(super) fn unit(knob: &Knob) -> String {
    let text = knob.dimension.pretty_to(knob.value, DIGITS);
    text.split_once(' ').map_or_else(String::new, |(_, unit)| unit.to_owned())
}

/// A value in a unit [SI].
fn in_si(knob: &Knob, value: f64, unit: &str) -> Result<f64, Fault> {
    knob.dimension.parse(format!("{value} {unit}").trim_end())
}

/// A value [SI] in a unit.
fn in_unit(knob: &Knob, value: f64, unit: &str) -> f64 {
    // Degrees Celsius do not begin at zero.
    let [zero, one] = [0.0, 1.0].map(|value| in_si(knob, value, unit).unwrap_or(value));
    rounded((value - zero) / (one - zero), 8)
}

/// The value that a page sends for a knob [SI].
///
/// # Errors
/// Why it is none.
pub(super) fn value_of(knob: &Knob, value: &KeyValue) -> Result<f64, Fault> {
    let unit = unit(knob);
    match value {
        KeyValue::Number(number) if !number.is_finite() => Err(Fault::plain("the number is not finite")),
        KeyValue::Number(number) => in_si(knob, *number, &unit),
        KeyValue::Text(text) => match text.trim().parse::<f64>() {
            Ok(number) if number.is_finite() => in_si(knob, number, &unit),
            _ => knob.dimension.parse(text.trim()),
        },
    }
}

/// What is known of a change of a knob.
#[derive(Clone, Debug)]
pub(super) struct Slope {
    pub(super) change: Change,
    /// Number of the change.
    pub(super) place: usize,
    pub(super) effects: Vec<Effect<f64>>,
}

/// The effect of a knob on the CV over the patches that are judged first; of two changes the increase.
///
/// * `side` – of these patches [m]
fn effect_of(knob: &Knob, slopes: &[Slope], side: f64) -> Option<Json> {
    let known = slopes.iter().filter(|slope| knob.is_changed_by(&slope.change)).filter_map(|slope| {
        let far = |effect: &&Effect<f64>| (effect.of / side).ln().abs();
        let effect = slope.effects.iter().min_by(|a, b| far(a).total_cmp(&far(b)))?;
        let key = slope.change.keys.first()?;
        Some((key, effect.difference))
    });
    let (key, difference) = known.max_by(|(a, _), (b, _)| (a.to / a.from).total_cmp(&(b.to / b.from)))?;
    let step = key.to / key.from - 1.0;
    let by = key.to - key.from;
    let words = if key.by_kelvin { format!("{by:+.0} K") } else { format!("{:+.0} %", 100.0 * step) };
    let words = words.replace('-', "−");
    let (change, error) = (difference.value, difference.standard_error);
    Some(json!({"step": step, "words": words, "change": change, "standard_error": error}))
}

/// The message with the knobs.
///
/// * `title` – of the line
pub(super) fn knobs(title: &str, before: &KnownWeb, now: &KnownWeb, slopes: &[Slope]) -> Json {
    let of_knob = |knob: &Knob| {
        let unit = unit(knob);
        let value =
            |web: &KnownWeb| web.line.knobs.iter().find(|other| other.name == knob.name).map(|one| one.value);
        let [is, was] = [now, before].map(|web| in_unit(knob, value(web).unwrap_or(knob.value), &unit));
        let [from, to] = knob.range.map(|end| in_unit(knob, end, &unit));
        json!({
            "name": knob.name,
            "label": knob.label,
            "turned": knob.setting.turned.name(),
            "key": knob.keys.first(),
            "unit": unit,
            "value": is,
            "was": was,
            "from": from.min(is).min(was),
            "to": to.max(is).max(was),
            "digits": SLIDER_DIGITS,
            "is_whole": knob.is_whole,
            "effect": effect_of(knob, slopes, SEEN),
        })
    };
    // Units and ranges stay those of the web of comparison while a knob is turned.
    json!({"is": "knobs", "title": title, "knobs": before.line.knobs.iter().map(of_knob).collect::<Vec<_>>()})
}

#[cfg(test)]
mod tests {
    use super::*;
    use spunlaid::ground::{Dimension, Setting, Turned};

    fn knob(dimension: Dimension, value: f64) -> Knob {
        let setting = Setting { name: "one", words: "one", turned: Turned::Running };
        let name = "one".to_owned();
        let label = "one".to_owned();
        let keys = vec!["line.one".to_owned()];
        let range = [0.5 * value, 2.0 * value];
        Knob { name, label, setting, layers: Vec::new(), keys, dimension, is_whole: false, value, range }
    }

    #[test]
    fn values_are_in_the_unit_of_the_knob_both_ways() {
        for (dimension, value, shown, text) in [
            (Dimension::Length, 0.02, (20.0, "mm"), "2 cm"),
            (Dimension::Temperature, 503.15, (230.0, "°C"), "503.15 K"),
            (Dimension::Ratio, 0.12, (0.12, ""), "12 %"),
        ] {
            let knob = knob(dimension, value);
            let unit = unit(&knob);
            assert_eq!((in_unit(&knob, value, &unit), &*unit), shown);
            for sent in [KeyValue::Number(shown.0), KeyValue::Text(text.to_owned())] {
                let read = value_of(&knob, &sent).unwrap_or_else(|fault| panic!("{sent:?}: {fault}"));
                assert!((read / value - 1.0).abs() < 1e-12, "{sent:?}: {read}");
            }
            // A number alone is one in the unit that is shown.
            let plain = value_of(&knob, &KeyValue::Text(format!(" {} ", shown.0))).unwrap();
            assert!((plain / value - 1.0).abs() < 1e-12, "{plain}");
        }
    }

    #[test]
    fn rejects_other_units_and_what_is_no_number() {
        let knob = knob(Dimension::Length, 0.02);
        for text in ["20 s", "twenty mm", "", "nan", "inf mm", "../a.toml"] {
            assert!(value_of(&knob, &KeyValue::Text(text.to_owned())).is_err(), "{text}");
        }
        assert!(value_of(&knob, &KeyValue::Number(f64::INFINITY)).is_err());
    }
}
