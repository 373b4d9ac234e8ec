//! What settings of the line and what assumed values matter for the CV.

use super::PER_CENT;
use crate::effects::{describe, name};
use crate::figures::effects::{EffectRow, EffectsFigure, Panel, in_unit};
use spunlaid_charts::{Figure, Table};
use spunlaid_experiment::{Advice, SensitivityRun, setting};
use spunlaid_ground::{Difference, Dimension};
use spunlaid_simulation::WebSpec;

/// What changes of a web do to its CV over the patches by which they are judged, the largest effect at the
/// top. None if none is known.
pub fn effects_figure(spec: &WebSpec, advice: &Advice) -> Option<Figure> {
    let (patch, first) = (advice.judged_by?, advice.tried.first()?);
    let are_assumed = first.change.setting == setting::ASSUMED;
    let mut rows: Vec<(String, Vec<&SensitivityRun>)> = Vec::new();
    for tried in &advice.tried {
        let name = name(&tried.change, spec);
        match rows.iter_mut().find(|(other, _)| *other == name) {
            Some((_, same)) => same.push(tried),
            None => rows.push((name, vec![tried])),
        }
    }
    let difference = |tried: &SensitivityRun| Some(in_unit(&tried.on(patch)?.difference, PER_CENT));
    let size =
        |row: &EffectRow| row.effects.iter().flatten().map(|effect| effect.value.abs()).fold(0.0, f64::max);
    let mut rows: Vec<EffectRow> =
        rows.into_iter().map(|(name, same)| row(name, &same, &difference)).collect();
    rows.sort_by(|a, b| size(b).total_cmp(&size(a)));
    let side = Dimension::Length.pretty_to(patch, 3);
    let keys = if are_assumed { ["half", "twice"] } else { ["less", "more"] };
    let label = format!("Change of the CV over patches of {side} (%)");
    let panel = Panel { heading: "", keys: keys.map(str::to_owned).to_vec(), label, rows, decimals: 1 };
    let mut table = Table::new(["cv_change_percent", "half_width_percent"]);
    for tried in &advice.tried {
        let numbers = difference(tried).map(|of| [of.value, of.known_half_width().unwrap_or(f64::NAN)]);
        table.add(&describe(&tried.change, spec), numbers);
    }
    let (name, title, what) = match are_assumed {
        true => (
            "web_assumed_values",
            "Influence of the assumed values",
            "when an assumed value is half or twice as large",
        ),
        false => (
            "web_advice",
            "What would make the web more uniform",
            "at the same basis weight when one setting of the line is changed and the belt follows",
        ),
    };
    let caption = format!(
        "Relative change of the CV over patches of {side}, {what}. The bars are 95 % confidence intervals; if a bar \
        crosses zero, there may be no effect."
    );
    let figure = EffectsFigure { name: name.to_owned(), title: title.to_owned(), panels: vec![panel] };
    Some(figure.figure(table, caption))
}

/// The changes of one key, with less and with more of it.
fn row(
    name: String,
    same: &[&SensitivityRun],
    difference: &dyn Fn(&SensitivityRun) -> Option<Difference>,
) -> EffectRow {
    let key = |tried: &&SensitivityRun| tried.change.keys.first().cloned();
    let values: Vec<String> = same.iter().filter_map(key).map(|key| key.pretty(key.to)).collect();
    let from = same.first().and_then(key).map_or_else(String::new, |key| key.pretty(key.from));
    let effect = |less: bool| {
        let is_it = |tried: &&&SensitivityRun| key(tried).is_some_and(|key| (key.to < key.from) == less);
        difference(same.iter().find(is_it)?)
    };
    let detail = format!("{} instead of {from}", values.join(" or "));
    EffectRow { name, detail, effects: [true, false].map(effect).to_vec() }
}
