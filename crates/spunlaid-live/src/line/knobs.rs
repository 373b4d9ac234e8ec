//! Knobs as pages have them: values in the unit of the knob.

use super::found::SEEN;
use super::known_web::{DIGITS, KnownWeb};
use crate::message::KeyValue;
use serde_json::{Value as Json, json};
use spunlaid::experiment::Change;
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
    let exact = (value - zero) / (one - zero);
    format!("{exact:.8e}").parse().unwrap_or(exact)
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
            |web: &KnownWeb| web.knobs.iter().find(|other| other.name == knob.name).map(|one| one.value);
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
    json!({"is": "knobs", "title": title, "knobs": before.knobs.iter().map(of_knob).collect::<Vec<_>>()})
}
