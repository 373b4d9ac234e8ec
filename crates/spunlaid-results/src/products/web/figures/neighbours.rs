//! How filaments that hang side by side in one air come down together.

use super::MM;
use crate::figures::joined;
use spunlaid::web::{Correlation, LayerFlown, NeighbourCorrelation};
use spunlaid_charts::palette::{BLUE, Colour, GREEN, ORANGE, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Series};

/// Colours in machine and in cross direction, of the first layer and of the others.
const COLOURS: [[Colour; 2]; 2] = [[BLUE, VERMILION], [GREEN, ORANGE]];

/// What it is called, which correlation it has, and with which sign it is drawn.
type Direction = (&'static str, fn(&NeighbourCorrelation) -> Correlation, fn(&str) -> Series);

const DIRECTIONS: [Direction; 2] = [
    ("machine direction", |neighbour| neighbour.md, Series::circles),
    ("cross direction", |neighbour| neighbour.cd, Series::triangles),
];

/// The correlation of the places where two filaments come down, over the distance of their inlets; none of
/// filaments that have no neighbours.
pub(super) fn figure(layers: &[LayerFlown]) -> Option<Figure> {
    let last = layers.iter().rposition(|layer| !layer.neighbours.is_empty())?;
    let mut chart = Chart::new(
        "web_neighbours",
        "Correlation of neighbours",
        Axis::logarithmic("Distance in cross direction (mm)").in_column("distance_mm"),
        Axis::linear("Correlation").zero_based().in_column("correlation"),
    );
    for (layer, flown) in layers[..=last].iter().enumerate() {
        for ((name, correlation, sign), colour) in DIRECTIONS.into_iter().zip(COLOURS[layer.min(1)]) {
            let name = if last == 0 { name.to_owned() } else { format!("layer {}, {name}", layer + 1) };
            let point = |neighbour: &NeighbourCorrelation| {
                let Correlation { value, standard_error, .. } = correlation(neighbour);
                (neighbour.distance * MM, value, standard_error)
            };
            let points: Vec<_> = flown.neighbours.iter().map(point).collect();
            chart = joined(chart, Series { colour, ..sign(&name) }, &points);
        }
    }
    Some(Figure::new(
        &chart,
        "Correlation of the places where two filaments of the web come down at equal fed length, over the \
        distance of their inlets in cross direction: one if they come down beside each other all the time, \
        zero if their places are independent. Filaments of one row are compared with those of the same \
        row, those in a slot wherever they hang in its depth. Bars are one standard error, from the scatter \
        between stretches of the fibre and from the places of the filaments.",
    ))
}
