//! Where the free end is: over time, and across the flow.

use super::{MM, swings};
use crate::numbers::significant;
use spunlaid_charts::palette::{GREEN, GREY, INK, ORANGE};
use spunlaid_charts::{Axis, Chart, Figure, Series};
use spunlaid_fibre::Case;
use spunlaid_simulation::{EndPath, EndPoint, Results};

/// Most swings that can be distinguished in a history.
const SWINGS: f64 = 60.0;
/// Most swings of a path.
const PATH: f64 = 40.0;

/// The path of the first replicate that was not lost.
fn recorded(results: &Results) -> EndPath {
    results.trajectories.first().map_or_else(EndPath::default, |trajectory| trajectory.path.clone())
}

/// The free end's y and z over time; of a long run the whole, and its last swings below.
pub(super) fn end_node_history(case: &Case, results: &Results) -> Figure {
    let path = recorded(results);
    let end = path.last().last().map_or(0.0, |(time, _)| *time);
    let spin_up = case.run.spin_up();
    let history = |name: &str, from: f64| {
        let shown = path.since(from);
        let (y, z): (Vec<_>, Vec<_>) =
            shown.map(|(time, end)| ((*time, end.y * MM), (*time, end.z * MM))).unzip();
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
        return Figure::new(&chart, caption);
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
    let path = recorded(results);
    let spin_up = case.run.spin_up();
    let end = path.last().last().map_or(0.0, |(time, _)| *time);
    let from = swings(results, PATH).map_or(0.0, |part| end - part).max(spin_up);
    let drawn: Vec<&EndPoint> = path.last().filter(|(time, _)| *time >= from).collect();
    let points: Vec<_> = drawn.iter().map(|(_, end)| (end.y * MM, end.z * MM)).collect();
    let spot = |place: Option<&(f64, f64)>| place.map(|&(y, z)| (y, z, None));
    let chart = Chart::new(
        "end_node_path",
        "Path of the free end across the flow",
        Axis::linear("*y* (mm)"),
        Axis::linear("*z* (mm)"),
    )
    .sized(520.0, 500.0)
    .equal()
    .path(Series::new("path of the free end", GREEN).width(1.0), &points)
    .scatter(Series::spots("first", INK), spot(points.first()))
    .scatter(Series::spots("last", ORANGE), spot(points.last()));
    let mut caption =
        "The path of the free end across the mean flow in the first replicate, with the same scale in both \
                       directions."
            .to_owned();
    let simulated = path.since(spin_up).next().map_or(end, |(time, _)| *time);
    if let Some((start, _)) = drawn.first().filter(|(start, _)| *start > simulated) {
        caption.push_str(&format!(" Only the last {} s are drawn.", significant(end - start, 2)));
    }
    Figure::new(&chart, caption)
}
