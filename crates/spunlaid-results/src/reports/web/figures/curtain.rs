//! The curtain of filaments: where charged ones hang between inlet and belt, as they are seen from the side, and how
//! those that hang side by side in one air come down together.

use super::MM;
use crate::figures::joined;
use spunlaid_charts::palette::{BLUE, Colour, GREEN, ORANGE, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Series};
use spunlaid_web::{Correlation, LaidWeb, LayerFlown, NeighbourCorrelation};

/// Colours of the first layer and of others.
const OF_LAYERS: [Colour; 4] = [BLUE, VERMILION, GREEN, ORANGE];

/// The curtain of each charged layer; none of filaments without charge.
pub(super) fn charge(laid: &LaidWeb) -> Option<Figure> {
    let charged: Vec<_> = laid.charged().collect();
    charged.first()?;
    let mut chart = Chart::new(
        "web_charge",
        "The charged curtain from the side",
        Axis::linear("Distance from the inlet (mm)").in_column("x_mm").tight(),
        Axis::linear("Position in machine direction (mm)").in_column("md_mm"),
    );
    for ((layer, curtain), colour) in charged.iter().zip(OF_LAYERS.into_iter().cycle()) {
        let heights =
            || curtain.heights.iter().map(|height| (height.x * MM, height.places.map(|at| at * MM)));
        let between =
            |low: usize, high: usize| heights().map(move |(x, places)| (x, places[low], places[high]));
        let of = if charged.len() > 1 { format!(" of layer {}", layer + 1) } else { String::new() };
        chart = chart
            .band(Series::new(&format!("95 % of the filament{of}"), colour), between(0, 4))
            .band(Series::new(&format!("half of it{of}"), colour), between(1, 3))
            .line(Series::new(&format!("middle{of}"), colour), heights().map(|(x, places)| (x, places[2])));
    }
    Some(Figure::new(
        &chart,
        "Positions of the filaments above the belt at the end of the simulation, as a mean over the time in which \
        one lands. 95 % and half of the length of all filaments are between these positions in machine direction, \
        over the distance from the inlet. Their charge makes them repel each other.",
    ))
}

/// Colours in machine and in cross direction, of the first layer and of the others.
const OF_DIRECTIONS: [[Colour; 2]; 2] = [[BLUE, VERMILION], [GREEN, ORANGE]];

/// What it is called, which correlation it has, and with which sign it is drawn.
type Direction = (&'static str, fn(&NeighbourCorrelation) -> Correlation, fn(&str) -> Series);

const DIRECTIONS: [Direction; 2] = [
    ("machine direction", |neighbour| neighbour.md, Series::circles),
    ("cross direction", |neighbour| neighbour.cd, Series::triangles),
];

/// The correlation of the places where two filaments come down, over the distance of their inlets; none of
/// filaments that have no neighbours.
pub(super) fn neighbours(layers: &[LayerFlown]) -> Option<Figure> {
    let last = layers.iter().rposition(|layer| !layer.neighbours.is_empty())?;
    let mut chart = Chart::new(
        "web_neighbours",
        "Correlation of neighbours",
        Axis::logarithmic("Distance in cross direction (mm)").in_column("distance_mm"),
        Axis::linear("Correlation").zero_based().in_column("correlation"),
    );
    for (layer, simulated) in layers[..=last].iter().enumerate() {
        for ((name, correlation, sign), colour) in DIRECTIONS.into_iter().zip(OF_DIRECTIONS[layer.min(1)]) {
            let name = if last == 0 { name.to_owned() } else { format!("layer {}, {name}", layer + 1) };
            let point = |neighbour: &NeighbourCorrelation| {
                let Correlation { value, standard_error, .. } = correlation(neighbour);
                (neighbour.distance * MM, value, standard_error)
            };
            let points: Vec<_> = simulated.neighbours.iter().map(point).collect();
            chart = joined(chart, Series { colour, ..sign(&name) }, &points);
        }
    }
    Some(Figure::new(
        &chart,
        "Correlation of the positions where two filaments of the web land at equal fed length, over the distance of \
        their inlets in cross direction. It is one if they always land next to each other, and zero if their \
        positions are independent. Filaments of one row are compared with those of the same row, those in a slot at \
        any position in its gap. Bars are one standard error, from the scatter between lengths of the fibre and \
        from the positions of the filaments.",
    ))
}
