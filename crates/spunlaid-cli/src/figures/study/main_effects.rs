//! Results over one of many factors, averaged over what the others do.

use super::curves::drawn;
use super::file_name;
use super::quantity::{Along, Group, name_of_key};
use spunlaid::study::{Factor, PointResults, Ranking, Study};
use spunlaid_charts::{Chart, Figure, Series};

/// Slices of a factor's range whose points are averaged, where they are many and all different.
const SLICES: usize = 8;
/// Points on the line of best fit.
const FINE: usize = 40;

/// Means over the points of one value, or slice, of a factor, with the line that the main effect is of.
pub(super) fn of(
    study: &Study,
    results: &[PointResults],
    rankings: &[Ranking],
    group: &Group,
    factor: usize,
) -> Figure {
    let varied = &study.factors[factor];
    let along = Along::new(varied);
    let title = format!("{} over {}", group.figure.title, name_of_key(varied.key));
    let mut chart = Chart::new(&file_name(group, varied.key), &title, along.axis.clone(), group.axis());
    for (position, (measure, label)) in group.of.iter().enumerate() {
        let series = if position == 0 { Series::circles(label) } else { Series::triangles(label) };
        let values = results.iter().zip(&study.points);
        let values = values.map(|(of, point)| (point.values[factor], of.mean[*measure] * group.unit.per_si));
        let spots = averaged(varied, values.collect());
        let spots: Vec<_> = spots.into_iter().map(|(x, y, error)| (along.place(x), y, error)).collect();
        if let Some(line) = line(varied, rankings, *measure, factor) {
            let line: Vec<_> =
                line.into_iter().map(|(x, y)| (along.place(x), y * group.unit.per_si)).collect();
            let fit = series.clone().unlabelled().named(&format!("{label} line of best fit"));
            chart = chart.line(fit.unmarked().dashed("2 4").width(1.2), &line);
        }
        chart = drawn(chart, series, &spots);
    }
    let caption = format!(
        "{} over {}: means over all points that share a value of it, or a slice of its range, whatever the other \
         factors do there. Bars: one standard error of that mean, up and down, from the spread between the points. \
         Dotted: the straight line that the main effect is taken from.",
        group.figure.title,
        name_of_key(varied.key),
    );
    Figure::of(&chart, caption)
}

/// Mean and standard error at each level, or in each slice: value of the factor, mean, error.
fn averaged(factor: &Factor, mut values: Vec<(f64, f64)>) -> Vec<(f64, f64, Option<f64>)> {
    values.retain(|(x, y)| x.is_finite() && y.is_finite());
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let levels = values.chunk_by(|a, b| a.0 == b.0).count();
    let slices: Vec<&[(f64, f64)]> = if levels <= 2 * SLICES {
        values.chunk_by(|a, b| a.0 == b.0).collect()
    } else {
        let slice =
            |x: f64| ((factor.place(x) + 1.0) / 2.0 * SLICES as f64).min(SLICES as f64 - 1.0) as usize;
        values.chunk_by(|a, b| slice(a.0) == slice(b.0)).collect()
    };
    let mean = |slice: &[(f64, f64)]| {
        let n = slice.len() as f64;
        let x = slice.iter().map(|value| value.0).sum::<f64>() / n;
        let y = slice.iter().map(|value| value.1).sum::<f64>() / n;
        let squares: f64 = slice.iter().map(|value| (value.1 - y).powi(2)).sum();
        (x, y, (slice.len() > 1).then(|| (squares / (n - 1.0) / n).sqrt()))
    };
    slices.into_iter().map(mean).collect()
}

/// The line of best fit over the factor's range, the other factors in the middle of theirs.
fn line(factor: &Factor, rankings: &[Ranking], measure: usize, index: usize) -> Option<Vec<(f64, f64)>> {
    let ranking = rankings.iter().find(|ranking| ranking.measure == measure)?;
    let effect = ranking.effects.iter().find(|effect| effect.factor == index)?;
    let (least, greatest) = factor.ends();
    let at = |i: usize| {
        let x = least + (greatest - least) * i as f64 / FINE as f64;
        (x, ranking.middle + 0.5 * effect.change * factor.place(x))
    };
    Some((0..=FINE).map(at).collect())
}
