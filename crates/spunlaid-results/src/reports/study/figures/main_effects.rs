//! Results over one of many factors, adjusted for the others.

use super::curves::BARS;
use super::file_name;
use super::quantity::{FactorAxis, QuantityGroup, name_of_key};
use spunlaid_charts::{Chart, Figure, Series, even};
use spunlaid_experiment::{Factor, PointResults, Ranking, Study};

/// Most points of a study that are drawn; the file of numbers has them all.
const DRAWN: usize = 300;
/// Points on the line of best fit.
const FINE: usize = 40;

/// Every point over one factor, adjusted for the other factors, with the line of the main effect.
pub(super) fn figure(
    study: &Study,
    results: &[PointResults],
    rankings: &[Ranking],
    group: &QuantityGroup,
    factor: usize,
) -> Figure {
    let varied = &study.factors[factor];
    let along = FactorAxis::from_study(study, factor);
    let title = format!("{} over {}", group.title, name_of_key(&varied.key.name));
    let mut chart = Chart::new(&file_name(group, &varied.key.name), &title, along.axis.clone(), group.axis());
    let (mut is_adjusted, mut left_out) = (false, false);
    for (position, (measure, label)) in group.members.iter().enumerate() {
        let series = if position == 0 { Series::circles(label) } else { Series::triangles(label) };
        let ranking = rankings.iter().find(|ranking| ranking.measure == *measure);
        let spot = |(index, point): (usize, &PointResults)| {
            let (mean, error) = group.value(point, *measure);
            let adjusted =
                ranking.map(|ranking| ranking.adjusted(study, index, factor, point.mean(*measure)));
            let value = adjusted.map_or(mean, |value| value * group.unit.per_si);
            let shift = along.aside(position, group.members.len());
            (along.place(study.points[index].values[factor]) + shift, value, error)
        };
        let spots: Vec<_> = results.iter().enumerate().map(spot).collect();
        is_adjusted |= ranking.is_some();
        if let Some(line) = line(varied, rankings, *measure, factor) {
            let line: Vec<_> =
                line.into_iter().map(|(x, y)| (along.place(x), y * group.unit.per_si)).collect();
            let fit = series.clone().unlabelled().named(&format!("{label} line of best fit"));
            chart = chart.line(fit.unmarked().dashed(&[2.0, 4.0]).width(1.2), &line);
        }
        let drawn: Vec<_> = even(spots.len(), DRAWN).iter().map(|&i| spots[i]).collect();
        left_out |= drawn.len() < spots.len();
        chart = chart.scatter(series.thinned_from(spots), &drawn);
    }
    let how = if is_adjusted && along.is_joined() {
        "the mean of every point, without the fitted contributions of the other factors. Dotted: the straight line of \
         the main effect."
    } else if is_adjusted {
        "the mean of every point, without the fitted contributions of the other factors."
    } else {
        "the mean of every point, as it is: the study cannot separate the contributions of the other factors."
    };
    let drawn =
        if left_out { format!(" {DRAWN} of {} points are drawn.", results.len()) } else { String::new() };
    let bars = if study.noun() == "spinline" { String::new() } else { format!(" {BARS}") };
    let caption = format!("{} over {}: {how}{bars}{drawn}", group.title, name_of_key(&varied.key.name));
    Figure::new(&chart, caption)
}

/// The line of best fit over the factor's range, the other factors in the middle of theirs.
fn line(factor: &Factor, rankings: &[Ranking], measure: usize, index: usize) -> Option<Vec<(f64, f64)>> {
    let ranking = rankings.iter().find(|ranking| ranking.measure == measure)?;
    let middle = ranking.middle.unwrap_or(f64::NAN);
    let effect = ranking.effects.iter().find(|effect| effect.of.factor == index)?;
    if !factor.key.words().is_empty() {
        return None;
    }
    let (least, greatest) = factor.ends();
    let at = |i: usize| {
        let x = least + (greatest - least) * i as f64 / FINE as f64;
        (x, middle + 0.5 * effect.difference.value * factor.place(x))
    };
    Some((0..=FINE).map(at).collect())
}
