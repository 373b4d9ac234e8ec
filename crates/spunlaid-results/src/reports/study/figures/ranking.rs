//! Main effects of the factors with their confidence intervals, the largest at the top.

use super::quantity::{FactorAxis, QuantityGroup, label_of_key};
use crate::figures::effects::{EffectRow, EffectsFigure, Panel, in_unit};
use crate::figures::with_unit;
use crate::numbers::range;
use spunlaid_charts::{Axis, Figure, Table};
use spunlaid_experiment::{Contrast, Ranking, Study};
use spunlaid_ground::Effect;

/// What is compared: `5 to 30 m/s`, `sakiadis instead of matsui`.
fn change_of(study: &Study, Contrast { factor, from, to }: Contrast) -> String {
    let factor = &study.factors[factor];
    if factor.key.words().is_empty() {
        let place = FactorAxis::new(factor, None);
        return format!("{} {}", range(place.place(from), place.place(to)), place.unit).trim_end().to_owned();
    }
    format!("{} instead of {}", factor.key.pretty(to), factor.key.pretty(from))
}

/// The effects of all factors on a group of results.
pub(super) fn figure(study: &Study, rankings: &[Ranking], group: &QuantityGroup) -> Figure {
    let of_measure = |measure: usize| rankings.iter().find(|ranking| ranking.measure == measure);
    let members = group.members.iter().take(2);
    let shown: Vec<(&Ranking, &str)> =
        members.filter_map(|(measure, label)| Some((of_measure(*measure)?, label.as_str()))).collect();
    let with_words = study.factors.iter().any(|factor| !factor.key.words().is_empty());
    // With words, the change is given below each factor.
    let change = if with_words { "" } else { " from the least to the greatest value" };
    let row = |main: &Effect<Contrast>| {
        let effect = |(ranking, _): &(&Ranking, &str)| {
            ranking.of(main.of).map(|effect| in_unit(&effect.difference, group.unit.per_si))
        };
        EffectRow {
            name: label_of_key(&study.factors[main.of.factor].key.name),
            detail: change_of(study, main.of),
            effects: shown.iter().map(effect).collect(),
        }
    };
    let panel = Panel {
        heading: "",
        keys: shown.iter().map(|(_, label)| (*label).to_owned()).filter(|label| !label.is_empty()).collect(),
        label: with_unit(&format!("Change of {}{change}", group.figure.words), group.unit.shown),
        rows: shown.first().map_or_else(Vec::new, |(first, _)| first.effects.iter().map(row).collect()),
        decimals: 2,
    };
    let explained: Vec<String> = shown
        .iter()
        .filter_map(|(ranking, label)| {
            let whose =
                if label.is_empty() { String::new() } else { format!(" in {}", label.replace('*', "")) };
            Some(format!("{:.0} %{whose}", 100.0 * ranking.explained?))
        })
        .collect();
    let explained = if explained.is_empty() {
        String::new()
    } else {
        format!(
            " Straight lines explain {} of the variation between points; if that is little, look at the \
            curves instead.",
            explained.join(" and ")
        )
    };
    let of_words = if with_words {
        " For a factor of words it is the change of the mean from one word to another."
    } else {
        ""
    };
    let caption = format!(
        "Change of the {} from the least to the greatest value of each factor, by linear regression with the \
        other factors constant.{of_words} Bars are 95 % confidence \
        intervals; if a bar crosses zero, there may be no effect.{explained}",
        group.figure.words,
    );
    let change = Axis::linear(&with_unit("Change", group.unit.shown));
    let mut table = Table::new([change.column(), "error".to_owned()]);
    for (ranking, label) in &shown {
        for effect in &ranking.effects {
            let half = effect.difference.known_half_width().unwrap_or(f64::NAN) * group.unit.per_si;
            let factor = &study.factors[effect.of.factor];
            let words = if factor.key.words().is_empty() {
                String::new()
            } else {
                format!(": {}", change_of(study, effect.of))
            };
            let series = format!("{} over {}{words}", label.replace('*', ""), factor.key.name);
            table.add(&series, [[effect.difference.value * group.unit.per_si, half]]);
        }
    }
    let name = format!("{}_ranking", group.figure.name);
    let title = format!("Effects on the {}", group.figure.words);
    EffectsFigure { name, title, panels: vec![panel] }.figure(table, caption)
}
