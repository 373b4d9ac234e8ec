//! The spinlines of a web: a section for each layer that comes from one.

use crate::numbers::{THIN, significant};
use crate::page::document::Section;
use crate::page::words::grams;
use crate::reports::spinline::files::{SpinResults, solidification};
use crate::reports::spinline::report::section;
use crate::reports::web::files::summary::LayerSummary;
use spunlaid_charts::Figure;
use spunlaid_web::Web;

/// A spinline from which filaments of a web come.
#[derive(Clone, Debug)]
pub struct LayerSpinline {
    /// The layers of these filaments, from 0.
    pub layers: Vec<usize>,
    /// Mass flow of a hole [kg/s].
    pub throughput: f64,
    /// Its solution.
    pub results: SpinResults,
    /// Its figures.
    pub figures: Vec<Figure>,
}

/// The spinlines of a web, a section for each.
pub(super) fn sections_of_web<'a>(
    web: &Web,
    layers: &[LayerSummary],
    spinlines: &'a [LayerSpinline],
) -> Vec<Section<'a>> {
    let of_layers = |(number, spinline): (usize, &'a LayerSpinline)| {
        let own = |layer: &usize| {
            let row = layers.get(*layer)?;
            Some(way(row, row.filaments as f64 / web.sheet.width, spinline, layers.len() > 1))
        };
        let about = spinline.results.rows.first().map(solidification);
        let sentences = spinline.layers.iter().filter_map(own).chain(about).collect();
        let (id, title) = match number {
            0 => ("spinline".to_owned(), "From the die to the web"),
            _ => (format!("spinline-{}", number + 1), "Another spinline"),
        };
        section(Section::new(id, title), sentences, &spinline.results, &spinline.figures)
    };
    spinlines.iter().enumerate().map(of_layers).collect()
}

/// The way from the die to the web, with its basis weight from the holes, in a sentence.
///
/// * `holes` – filaments per metre of width [1/m]
fn way(layer: &LayerSummary, holes: f64, spinline: &LayerSpinline, is_named: bool) -> String {
    let Some(solution) = spinline.results.rows.first() else { return String::new() };
    let from_holes = holes * spinline.throughput / layer.belt_speed_m_s;
    let apart = (from_holes / layer.basis_weight_kg_m2 - 1.0).abs();
    let verdict = if apart < 0.005 {
        "the same".to_owned()
    } else {
        format!("{}{THIN}% apart", significant(100.0 * apart, 2))
    };
    format!(
        "Die → diffuser → belt → web{}: {} holes per metre with {}{THIN}g/min each; filaments of {}{THIN}µm \
        that enter at {}{THIN}m/s; a belt of {}{THIN}m/s. Holes × throughput / belt speed is {}, and the web \
        has {}: {verdict}.",
        if is_named { format!(", layer {}", layer.name) } else { String::new() },
        significant(holes, 4),
        significant(spinline.throughput * 6e4, 3),
        significant(solution.final_diameter * 1e6, 3),
        significant(solution.final_speed, 3),
        significant(layer.belt_speed_m_s, 3),
        grams(from_holes),
        grams(layer.basis_weight_kg_m2)
    )
}
