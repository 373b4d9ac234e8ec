//! Where charged filaments hang between inlet and belt, as they are seen from the side.

use super::MM;
use spunlaid::web::LaidWeb;
use spunlaid_charts::palette::{BLUE, GREEN, ORANGE, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Series};

/// Colours of the first layer and of others.
const COLOURS: [spunlaid_charts::palette::Colour; 4] = [BLUE, VERMILION, GREEN, ORANGE];

/// The curtain of each charged layer; none of filaments without charge.
pub(super) fn figure(laid: &LaidWeb) -> Option<Figure> {
    let charged: Vec<_> = laid.charged().collect();
    charged.first()?;
    let mut chart = Chart::new(
        "web_charge",
        "The charged curtain from the side",
        Axis::linear("Distance from the inlet (mm)").in_column("x_mm").tight(),
        Axis::linear("Place in machine direction (mm)").in_column("md_mm"),
    );
    for ((layer, curtain), colour) in charged.iter().zip(COLOURS.into_iter().cycle()) {
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
        "Where the filaments hung above the belt at the end of their flight, as a mean over the time in \
        which one comes down: the places in machine direction between which 95 % and half of the length of \
        all filaments hangs, over the distance from the inlet. Their charge drives them apart.",
    ))
}
