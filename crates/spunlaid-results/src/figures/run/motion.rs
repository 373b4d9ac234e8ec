//! Where the free end is: over time, and across the flow.

use super::{MM, swings};
use crate::numbers::significant;
use spunlaid::case::Case;
use spunlaid::ensemble::{Results, Sample};
use spunlaid_charts::{
    Axis, Chart, Figure, Series,
    palette::{GREEN, GREY, INK, ORANGE},
};

/// Most swings that can be told apart in a history.
const SWINGS: f64 = 60.0;
/// Most swings of a path, and most of its points.
const PATH: (f64, usize) = (40.0, 20_000);

/// What is recorded of the first replicate.
fn recorded(results: &Results) -> &[Sample] {
    results.trajectories.first().map_or(&[][..], |trajectory| &trajectory.samples)
}

/// The free end's y and z over time; of a long run the whole, and its last swings below.
pub(super) fn end_node_history(case: &Case, results: &Results) -> Figure {
    let samples = recorded(results);
    let end = samples.last().map_or(0.0, |s| s.time);
    let spin_up = case.run.spin_up();
    let history = |name: &str, from: f64| {
        let shown = samples.iter().filter(|s| s.time >= from);
        let (y, z): (Vec<_>, Vec<_>) =
            shown.map(|s| ((s.time, s.end.y * MM), (s.time, s.end.z * MM))).unzip();
        let x = Axis::linear("Time *t* (s)").tight();
        let chart = Chart::new(
            name,
            "Free end over time",
            x,
            Axis::linear("Position of the free end (mm)").in_column("position_mm"),
        );
        let series = if from > 0.0 { Series::drawn_only } else { |series| series };
        let chart = chart.line(series(Series::circles("*y*")), &y).line(series(Series::triangles("*z*")), &z);
        if spin_up > from {
            chart.stretch(Series::new("spin-up, not in the statistics", GREY), from, spin_up)
        } else {
            chart
        }
    };
    let mut chart = history("end_node_history", 0.0);
    let mut caption = "Sideways position of the fibre’s free end in the first replicate: y (blue, circles) and z \
                       (vermilion, triangles), both across the mean flow. The amplitude of the table is the \
                       standard deviation of such a curve over time; its frequency is half the number of sign \
                       changes per second."
        .to_owned();
    let last = swings(results, SWINGS / 2.0).filter(|part| *part < end / 2.0);
    let Some(last) = last else {
        return Figure::of(&chart, caption);
    };
    caption.push_str(&format!(
        " The upper panel shows the whole run, the lower one its last {} s.",
        significant(last, 2)
    ));
    chart.x.label.clear();
    let mut part = history("end_node_history_part", end - last);
    for chart in [&mut chart, &mut part] {
        chart.y.label = "Position (mm)".to_owned();
    }
    let (chart, part) = (chart.sized(640.0, 230.0), part.sized(640.0, 260.0));
    Figure::stacked(&chart.name, &chart.title, &[&chart, &part], caption)
}

/// The path of the free end, seen along the flow.
pub(super) fn end_node_path(case: &Case, results: &Results) -> Figure {
    let flown: Vec<&Sample> = recorded(results).iter().filter(|s| s.time >= case.run.spin_up()).collect();
    let end = flown.last().map_or(0.0, |s| s.time);
    let from = swings(results, PATH.0).map_or(0.0, |part| end - part);
    let first = flown.partition_point(|s| s.time < from).max(flown.len().saturating_sub(PATH.1));
    let drawn = &flown[first..];
    let points: Vec<_> = drawn.iter().map(|s| (s.end.y * MM, s.end.z * MM)).collect();
    let spot = |p: Option<&(f64, f64)>| -> Vec<_> { p.map(|&(y, z)| (y, z, None)).into_iter().collect() };
    let chart = Chart::new(
        "end_node_path",
        "Path of the free end across the flow",
        Axis::linear("*y* (mm)"),
        Axis::linear("*z* (mm)"),
    )
    .sized(520.0, 500.0)
    .equal()
    .path(Series::new("path of the free end", GREEN).width(1.0), &points)
    .scatter(Series::spots("first", INK), &spot(points.first()))
    .scatter(Series::spots("last", ORANGE), &spot(points.last()));
    let mut caption =
        "The path of the free end across the mean flow in the first replicate, with the same scale in both \
                       directions."
            .to_owned();
    if let (true, Some(start)) = (first > 0, drawn.first()) {
        caption.push_str(&format!(" Only the last {} s are drawn.", significant(end - start.time, 2)));
    }
    Figure::of(&chart, caption)
}
