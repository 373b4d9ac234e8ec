//! What changes do, in the words that files, figures and reports share.

use crate::numbers::{HARD, THIN, in_sentence, plus_minus, rounded, significant};
use spunlaid_experiment::{Change, setting};
use spunlaid_fibre::case::keys;
use spunlaid_ground::{ChangedKey, Difference};
use spunlaid_simulation::WebSpec;
use spunlaid_simulation::layers::web_key;

pub(crate) const PER_CENT: f64 = 100.0;

/// `−10.6 ± 0.7`, or `+3.2 ± 1.3`: a difference with its standard error, both times a factor.
pub(crate) fn difference_text(difference: &Difference, factor: f64) -> String {
    let value = factor * difference.value;
    let error = Some(factor * difference.standard_error);
    let is_above = value > 0.0 && rounded(value, error).0.contains(|c| ('1'..='9').contains(&c));
    format!("{}{}", if is_above { "+" } else { "" }, plus_minus(value, error))
}

/// `20 % less titre of layer 2, 2 to 1.6 dtex`.
pub(crate) fn describe(change: &Change, spec: &WebSpec) -> String {
    let Some(key) = change.keys.first() else { return String::new() };
    format!("{} {}, {}", share(key), name(change, spec), values(key))
}

/// `titre of layer 2`.
pub(crate) fn name(change: &Change, spec: &WebSpec) -> String {
    let name_of = |layer: &usize| {
        let named = spec.layers.get(layer - 1).and_then(|layer| layer.name.clone());
        named.unwrap_or_else(|| layer.to_string())
    };
    let names: Vec<String> = change.layers.iter().map(name_of).collect();
    let whose = match &names[..] {
        [] => String::new(),
        [one] => format!(" of layer {one}"),
        [more @ .., last] => format!(" of layers {} and {last}", more.join(", ")),
    };
    let assumed = change.keys.first().filter(|_| change.setting == setting::ASSUMED);
    let what = assumed.map(|assumed| in_sentence(label(&assumed.key)));
    format!("{}{whose}", what.unwrap_or_else(|| change.setting.words.to_owned()))
}

/// Label of a key of a case or a web: `Depth of the slot`.
pub(crate) fn label(key: &str) -> &str {
    let of_case = || keys::find(key).map(|key| key.label);
    web_key(key).map(|key| key.label).or_else(of_case).unwrap_or(key)
}

/// `20 % less`, or `10 °C more`.
fn share(key: &ChangedKey) -> String {
    let way = match (key.to < key.from, key.whole) {
        (true, true) => "fewer",
        (true, false) => "less",
        (false, _) => "more",
    };
    if key.by_kelvin {
        return format!("{}{THIN}°C {way}", significant((key.to - key.from).abs(), 3));
    }
    format!("{}{THIN}% {way}", significant(PER_CENT * (key.to / key.from - 1.0).abs(), 3))
}

/// `2 to 1.6 dtex`; no line ends between a number and its unit.
fn values(key: &ChangedKey) -> String {
    let [from, to] = [key.from, key.to].map(|value| key.pretty(value).replace(' ', &HARD.to_string()));
    format!("{from} to {to}")
}
