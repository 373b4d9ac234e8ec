//! Results over one factor: alone, as a family of curves for a second factor, or with all others as in the base case.

use super::quantity::{FactorAxis, QuantityGroup, name_of_key};
use super::{FAMILY, file_name};
use crate::figures::{COLOURS, joined};
use spunlaid_charts::palette::GREEN;
use spunlaid_charts::{Chart, Figure, Marker, Series};
use spunlaid_experiment::{PointResults, Study};

/// Dashes of the lines, so that curves can be distinguished without their colours.
const DASHES: [&[f32]; FAMILY] =
    [&[], &[8.0, 4.0], &[2.0, 3.0], &[8.0, 3.0, 2.0, 3.0], &[14.0, 4.0], &[8.0, 3.0, 2.0, 3.0, 2.0, 3.0]];

/// The end of a caption: what the points are, and the meaning of the error bars. Nothing of a spinline is by chance.
pub(super) fn means(study: &Study) -> String {
    if study.noun() == "spinline" { ".".to_owned() } else { format!(", means over the replicates. {BARS}") }
}

/// The meaning of the error bars.
pub(super) const BARS: &str = "The bars show one standard error of the mean over the replicates.";

/// A point of the figure: abscissa, value, error.
type Spot = (f64, f64, Option<f64>);

fn series(group: &QuantityGroup, position: usize) -> Series {
    let label = &group.members[position].1;
    match (position, group.members.len()) {
        (_, 3..) => Series::spots(label, COLOURS[position % FAMILY]),
        (_, 1) => Series::spots(label, GREEN).unlabelled(),
        (0, _) => Series::circles(label),
        _ => Series::triangles(label),
    }
}

/// Results over the first factor at all points, joined by a line.
pub(super) fn one(study: &Study, results: &[PointResults], group: &QuantityGroup) -> Figure {
    let all: Vec<usize> = (0..results.len()).collect();
    let others: Vec<String> =
        study.factors.iter().skip(1).map(|factor| name_of_key(&factor.key.name)).collect();
    let with =
        if others.is_empty() { String::new() } else { format!(", {} along with it", others.join(" and ")) };
    over_factor(
        study,
        results,
        group,
        0,
        &all,
        &format!("over {}{with}", name_of_key(&study.factors[0].key.name)),
    )
}

/// Results over a factor at the points where all others are as in the base case, which is the first point.
pub(super) fn alone(study: &Study, results: &[PointResults], group: &QuantityGroup, factor: usize) -> Figure {
    let count = study.factors.len();
    let is_alone = |point: &usize| {
        let values = &study.points[*point].values;
        (0..count).all(|other| other == factor || values[other] == study.points[0].values[other])
    };
    let points: Vec<usize> = (0..results.len()).filter(is_alone).collect();
    let words = format!(
        "over {} alone, everything else as in the base case",
        name_of_key(&study.factors[factor].key.name)
    );
    over_factor(study, results, group, factor, &points, &words)
}

fn over_factor(
    study: &Study,
    results: &[PointResults],
    group: &QuantityGroup,
    factor: usize,
    points: &[usize],
    words: &str,
) -> Figure {
    let along = FactorAxis::from_study(study, factor);
    let title = format!("{} {}", group.title, words.split(',').next().unwrap_or(words));
    let name = file_name(group, &study.factors[factor].key.name);
    let mut chart = Chart::new(&name, &title, along.axis.clone(), group.axis());
    for (position, (measure, _)) in group.members.iter().enumerate() {
        let shift = along.aside(position, group.members.len());
        let x = |point: usize| along.place(study.points[point].values[factor]) + shift;
        let spots = spots(results, group, *measure, points, x);
        let series = series(group, position);
        chart = if along.is_joined() { joined(chart, series, &spots) } else { chart.scatter(series, &spots) };
    }
    let caption = format!("{} {words}{}", group.title, means(study));
    Figure::new(&chart, caption)
}

/// Results over one factor, with a curve for each value of another.
pub(super) fn family(
    study: &Study,
    results: &[PointResults],
    group: &QuantityGroup,
    along: usize,
    family: usize,
) -> Figure {
    let (parameter, key) = (&study.factors[family], &*study.factors[along].key.name);
    let place = FactorAxis::from_study(study, along);
    let title = format!("{} over {} and {}", group.title, name_of_key(key), name_of_key(&parameter.key.name));
    let mut chart = Chart::new(&file_name(group, key), &title, place.axis.clone(), group.axis());
    let levels = parameter.levels();
    for (index, ((level, colour), dash)) in levels.iter().copied().zip(COLOURS).zip(DASHES).enumerate() {
        let points: Vec<usize> =
            (0..results.len()).filter(|point| study.points[*point].values[family] == level).collect();
        for (position, (measure, called)) in group.members.iter().enumerate() {
            let marker = if position == 0 { Marker::Circle } else { Marker::Triangle };
            let label = parameter.key.pretty(level);
            // Markers without lines have shapes of their own, as long as the shape does not distinguish the results.
            let dash = if place.is_joined() || group.members.len() > 1 { dash } else { &[] };
            let series = Series { marker: Some(marker), dash, ..Series::new(&label, colour) }
                .named(&format!("{called} at {label}"));
            let series_count = levels.len() * group.members.len();
            let shift = place.aside(index * group.members.len() + position, series_count);
            let x = |point: usize| place.place(study.points[point].values[along]) + shift;
            let spots = spots(results, group, *measure, &points, x);
            if !place.is_joined() {
                let series = if position == 0 { series } else { series.unlabelled() };
                chart = chart.scatter(series, &spots);
                continue;
            }
            let line = spots.iter().map(|(x, y, _)| (*x, *y));
            // The legend shows the line of the first result; the table has the points with their errors.
            let thin = series.clone().drawn_only().unmarked().width(1.6);
            let thin = if position == 0 { thin } else { thin.unlabelled() };
            chart = chart.line(thin, line).scatter(series.unlabelled(), &spots);
        }
    }
    let signs = match group.members.as_slice() {
        [(_, first), (_, second)] => {
            format!(" Circles: {}, triangles: {}.", first.replace('*', ""), second.replace('*', ""))
        }
        _ => String::new(),
    };
    let distinction = if place.is_joined() { "a colour and a dash" } else { "a colour" };
    let caption = format!(
        "{} over {}, {distinction} for each value of the {}{}{signs}",
        group.title,
        name_of_key(key),
        name_of_key(&parameter.key.name),
        means(study),
    );
    Figure::new(&chart, caption)
}

/// The values of a measure at some points of a study, from left to right.
///
/// * `x` – the abscissa of a point
fn spots(
    results: &[PointResults],
    group: &QuantityGroup,
    measure: usize,
    points: &[usize],
    x: impl Fn(usize) -> f64,
) -> Vec<Spot> {
    let spot = |point: &usize| {
        let (value, error) = group.value(&results[*point], measure);
        (x(*point), value, error)
    };
    let mut spots: Vec<Spot> = points.iter().map(spot).collect();
    spots.sort_by(|a, b| a.0.total_cmp(&b.0));
    spots
}
