//! The figures of a spinline.

use crate::figures::effects::{EffectRow, EffectsFigure, Panel, in_unit};
use spunlaid_charts::label::plain;
use spunlaid_charts::palette::{BLUE, Colour, GREEN, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Series, Table};
use spunlaid_fibre::{Solution, Station, ZERO_CELSIUS};
use spunlaid_input::{Influence, OfFilament};

/// Beginning of the names of the figures where there is one spinline.
pub const SPINLINE: &str = "spinline";

/// Millimetres per metre.
const MM: f64 = 1e3;
/// Micrometres per metre.
const MICROMETRES: f64 = 1e6;

/// The figures of a spinline, in the order a reader wants them.
///
/// * `prefix` – the beginning of their names
/// * `rows` – the solution of each row of the curtain, the quenched side first
pub fn spinline_figures(prefix: &str, rows: &[Solution], influences: &[Influence]) -> Vec<Figure> {
    let mut figures = thread_figures(prefix, rows);
    if rows.len() > 1 {
        figures.push(curtain_figure(prefix, rows));
    }
    if !influences.is_empty() {
        figures.push(influences_figure(prefix, influences));
    }
    figures
}

/// The strain rate is shown to this multiple of the distance at which the thread solidifies, because it is zero
/// from there on.
const BEYOND_FREEZING: f64 = 1.25;

/// A quantity of the filament, in the unit of its axis.
type Quantity = fn(&Station) -> f64;

/// A row of filaments to draw: its name, nothing if there is only one, and its colour.
struct FilamentRow<'a> {
    name: &'static str,
    colour: Colour,
    solution: &'a Solution,
}

impl FilamentRow<'_> {
    fn points(&self, quantity: Quantity) -> impl Iterator<Item = (f64, f64)> {
        self.solution.stations.iter().map(move |station| (station.distance * MM, quantity(station)))
    }

    /// `thread`, or `thread, last row`.
    fn label(&self, what: &str) -> String {
        if self.name.is_empty() { what.to_owned() } else { format!("{what}, {}", self.name) }
    }
}

/// The figures of a thread; of a curtain those of its first and of its last row.
fn thread_figures(prefix: &str, solutions: &[Solution]) -> Vec<Figure> {
    let rows: Vec<FilamentRow<'_>> = match solutions {
        [] => return Vec::new(),
        [solution] => vec![FilamentRow { name: "", colour: BLUE, solution }],
        [first, .., last] => vec![
            FilamentRow { name: "first row", colour: BLUE, solution: first },
            FilamentRow { name: "last row", colour: VERMILION, solution: last },
        ],
    };
    let frozen = rows.iter().map(|row| row.solution.solidification.distance).fold(0.0, f64::max);
    let crystallises = solutions.iter().any(|solution| solution.end().transformed > 0.0);
    let mut figures = vec![
        drawing(prefix, &rows),
        temperature(prefix, &rows),
        tension(prefix, &rows),
        strain_rate(prefix, &rows, BEYOND_FREEZING * frozen),
    ];
    if crystallises {
        figures.push(transformed(prefix, &rows));
    }
    figures
}

/// An empty chart over the distance from the die.
fn chart(prefix: &str, name: &str, title: &str, up: Axis) -> Chart {
    let along = Axis::linear("Distance from the die (mm)").tight().including(0.0);
    Chart::new(&format!("{prefix}_{name}"), title, along, up)
}

/// A chart with a quantity of each row, and where the row solidifies.
///
/// * `is_keyed` – whether the chart has a legend
fn with_rows(chart: Chart, rows: &[FilamentRow<'_>], quantity: Quantity, is_keyed: bool) -> Chart {
    with_points(chart, rows, |row| row.points(quantity), is_keyed)
}

/// The same with points for each row.
fn with_points<'a, P: Iterator<Item = (f64, f64)>>(
    chart: Chart,
    rows: &'a [FilamentRow<'a>],
    points: impl Fn(&'a FilamentRow<'a>) -> P,
    is_keyed: bool,
) -> Chart {
    rows.iter().enumerate().fold(chart, |chart, (i, row)| {
        let keyed = |series: Series, is_keyed: bool| if is_keyed { series } else { series.unlabelled() };
        let line = Series::new(&row.label("filament"), row.colour).width(2.0);
        let solidification =
            Series::new("solidification point", row.colour).named(&row.label("solidification point"));
        let frozen = row.solution.solidification.distance * MM;
        chart
            .line(keyed(line, is_keyed), points(row))
            .vertical(keyed(solidification.dashed(&[5.0, 4.0]).width(1.2), is_keyed && i == 0), frozen)
    })
}

/// The words of a caption that say what frozen means.
fn about_solidification(rows: &[FilamentRow<'_>]) -> String {
    let [first, ..] = rows else { return String::new() };
    let rows = if first.name.is_empty() { "" } else { " of each row" };
    format!(
        "The dashed line marks the solidification point{rows}: from there on the filament keeps its speed."
    )
}

fn drawing(prefix: &str, rows: &[FilamentRow<'_>]) -> Figure {
    let title = "Speed and diameter of the filament";
    let speed = chart(prefix, "speed", title, Axis::logarithmic("Speed *v* (m/s)").decades(4));
    let speed = with_rows(speed, rows, |station| station.speed, true);
    let speed = with_air(speed, rows, |station| station.air_velocity);
    let diameter = chart(prefix, "diameter", title, Axis::logarithmic("Diameter *d* (µm)"));
    let diameter = with_rows(diameter, rows, |station| station.diameter * MICROMETRES, false);
    let caption = format!(
        "Speed and diameter of the filament, averaged over its cross-section, and the velocity of the air along it. {}",
        about_solidification(rows)
    );
    Figure::stacked(
        &format!("{prefix}_speed_and_diameter"),
        title,
        &[&speed.sized(640.0, 340.0), &diameter.sized(640.0, 320.0)],
        caption,
    )
}

/// The air that the rows meet.
fn with_air(chart: Chart, rows: &[FilamentRow<'_>], quantity: Quantity) -> Chart {
    let dashes = [&[][..], &[2.0, 3.0]];
    rows.iter().zip(dashes).fold(chart, |chart, (row, dash)| {
        let series = Series { dash, ..Series::new(&row.label("air"), GREEN) };
        chart.line(series, row.points(quantity))
    })
}

fn temperature(prefix: &str, rows: &[FilamentRow<'_>]) -> Figure {
    let title = "Temperature of the filament and of the air";
    let chart = chart(prefix, "temperature", title, Axis::linear("Temperature *T* (°C)"));
    let chart = with_rows(chart, rows, |station| station.temperature - ZERO_CELSIUS, true);
    let chart = with_air(chart, rows, |station| station.air_temperature - ZERO_CELSIUS);
    let caption = format!(
        "Temperature of the filament, averaged over its cross-section, and of the air around it. {}",
        about_solidification(rows)
    );
    Figure::new(&chart, caption)
}

fn tension(prefix: &str, rows: &[FilamentRow<'_>]) -> Figure {
    let title = "Tension and stress of the filament";
    let tension = chart(prefix, "tension", title, Axis::linear("Tension *F* (mN)").zero_based());
    let tension = with_rows(tension, rows, |station| station.tension * 1e3, true);
    let stress = chart(prefix, "stress", title, Axis::linear("Stress *N*_{1} (MPa)").zero_based());
    let stress = with_rows(stress, rows, |station| station.stress * 1e-6, false);
    let caption = format!(
        "Above, the force in the filament; below, the stress in its cross-section. The stress at the \
        solidification point orients the polymer, and so decides birefringence and modulus. {}",
        about_solidification(rows)
    );
    Figure::stacked(
        &format!("{prefix}_tension_and_stress"),
        title,
        &[&tension.sized(640.0, 320.0), &stress.sized(640.0, 320.0)],
        caption,
    )
}

/// From the solidification point on it is zero, at once.
fn strain_rate(prefix: &str, rows: &[FilamentRow<'_>], until: f64) -> Figure {
    let title = "Strain rate of the filament";
    let up = Axis::linear("Strain rate d*v*/d*z* (1/s)").zero_based().in_column("strain_rate_per_s");
    let chart = chart(prefix, "strain_rate", title, up);
    let chart = with_points(
        chart,
        rows,
        |row| {
            let frozen = row.solution.solidification.distance * MM;
            let points = row.points(|station| station.strain_rate);
            let points = points.filter(move |(distance, _)| *distance <= frozen);
            points.chain([(frozen, 0.0), (until * MM, 0.0)])
        },
        true,
    );
    let caption = format!(
        "Rate of stretching of the filament, up to a little below the solidification point. {}",
        about_solidification(rows)
    );
    Figure::new(&chart, caption)
}

fn transformed(prefix: &str, rows: &[FilamentRow<'_>]) -> Figure {
    let title = "Transformed fraction of the polymer";
    let up = Axis::linear("Transformed fraction *θ* (–)").zero_based().in_column("transformed");
    let chart = chart(prefix, "transformed", title, up);
    let chart = with_rows(chart, rows, |station| station.transformed, true);
    let caption = format!(
        "Crystallinity over the largest crystallinity that the polymer reaches. {}",
        about_solidification(rows)
    );
    Figure::new(&chart, caption)
}

/// Diameter and solidification point of each row.
fn curtain_figure(prefix: &str, rows: &[Solution]) -> Figure {
    let title = "Rows of the curtain";
    let chart = |name: &str, up: &str, value: fn(&Solution) -> f64| {
        let along = Axis::linear("Row, from the side of the quench").in_column("row");
        Chart::new(&format!("{prefix}_rows_{name}"), title, along, Axis::linear(up))
            .sized(640.0, 300.0)
            .scatter(
                Series::circles("filament").unlabelled(),
                rows.iter().enumerate().map(|(i, row)| ((i + 1) as f64, value(row), None)),
            )
    };
    let diameter = chart("diameter", "Diameter *d*, cold (µm)", |row| row.final_diameter * MICROMETRES);
    let solidification = chart("solidification", "Solidification point, below the die (mm)", |row| {
        row.solidification.distance * MM
    });
    Figure::stacked(
        &format!("{prefix}_rows"),
        title,
        &[&diameter, &solidification],
        "Each row meets the air that the rows before it have warmed and dragged along. The air does not mix \
        between the rows in this model.",
    )
}

/// Most bars of a panel; the table has all.
const MOST: usize = 16;

/// The influences on the diameter, relative changes and those of 10 K apart.
fn influences_figure(prefix: &str, influences: &[Influence]) -> Figure {
    let panel = |by_kelvin: bool, heading: &'static str, factor: f64, decimals: usize| {
        let row = |influence: &Influence| {
            let effect = influence.on(OfFilament::Diameter).map(|effect| in_unit(&effect.difference, factor));
            let name = influence.change.setting.words.to_owned();
            let detail = String::new();
            EffectRow { name, detail, effects: vec![effect] }
        };
        let changed =
            influences.iter().filter(|influence| influence.change.keys[0].by_kelvin == by_kelvin).take(MOST);
        let label = "Change of the diameter (%)".to_owned();
        Panel { heading, keys: Vec::new(), label, rows: changed.map(row).collect(), decimals }
    };
    let mut panels = vec![panel(false, "1 % more of", 1.0, 2), panel(true, "10 K more of", 100.0, 1)];
    panels.retain(|panel| !panel.rows.is_empty());
    let left_out = influences.len() - panels.iter().map(|panel| panel.rows.len()).sum::<usize>();
    let others = if left_out > 0 { " Weaker ones are in the numbers of the figure." } else { "" };
    let caption = format!(
        "Relative change of the diameter of the cold filament when one number changes and all others stay, \
        by small changes of the model: d ln d / d ln x, and the change for 10 K. Blue is finer, orange is \
        thicker.{others} These are slopes: they hold for small changes."
    );
    let name = format!("{prefix}_influences");
    let title = "What decides the diameter".to_owned();
    EffectsFigure { name, title, panels }.figure(table(influences), caption)
}

/// All influences, on the diameter and on the speed.
fn table(influences: &[Influence]) -> Table {
    let mut table = Table::new([
        "diameter_dlnd_dlnx",
        "speed_dlnv_dlnx",
        "diameter_percent_per_10_k",
        "speed_percent_per_10_k",
    ]);
    for influence in influences {
        let [diameter, speed] = [OfFilament::Diameter, OfFilament::Speed]
            .map(|of| influence.on(of).map_or(f64::NAN, |effect| effect.difference.value));
        let numbers = match influence.change.keys[0].by_kelvin {
            false => [diameter, speed, f64::NAN, f64::NAN],
            true => [f64::NAN, f64::NAN, 100.0 * diameter, 100.0 * speed],
        };
        table.add(&plain(influence.change.setting.words), [numbers]);
    }
    table
}

#[cfg(test)]
mod tests;
