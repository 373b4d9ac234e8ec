//! The sheet: its size, cells, patches and edges.

use super::read::WebParser;
use spunlaid_fibre::case::whole_parts;
use spunlaid_ground::{Dimension, Fault};
use spunlaid_simulation::WebSpec;
use spunlaid_web::Sheet;

/// Sides of the cells and of the patches that are chosen if the file gives none [m].
const CELLS: [f64; 5] = [0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3];
const PATCHES: [f64; 6] = [1e-3, 2e-3, 5e-3, 10e-3, 20e-3, 50e-3];
/// Most cells that are chosen, and that are possible.
const MANY_CELLS: f64 = 1e7;
const MOST_CELLS: f64 = 4e8;
/// Most patches that are compared.
const MOST_PATCHES: usize = 100;
/// The window that is chosen [m].
const WINDOW: f64 = 20e-3;

impl WebParser<'_> {
    /// Sets what a file leaves out of the sheet, and checks it.
    pub(super) fn complete_sheet(&mut self, web: &mut WebSpec) {
        let Sheet { width, length, .. } = web.sheet;
        if !self.is_written("web.cell") {
            web.sheet.cell = chosen_cell(width, length);
        }
        let cell = web.sheet.cell;
        if [width, length, cell].iter().any(|size| size.is_nan()) {
            return;
        }
        let cells = width / cell * (length / cell);
        if !cells.is_finite() || cells > MOST_CELLS {
            let cell = Dimension::Length.pretty(cell);
            let fault = Fault::new(
                format!("makes {cells:.1e} cells of {cell} in the web; at most {MOST_CELLS:e} are possible"),
                "make the cells larger, or the web smaller",
            );
            self.refuse("web.cell", cell, fault);
            return;
        }
        let mut whole = true;
        for (key, size) in [("web.width", width), ("web.length", length)] {
            if !is_whole(size, cell) {
                whole = false;
                self.key_values.reject(key, not_whole("is", size, cell));
            }
        }
        let side = width.min(length);
        if whole {
            self.complete_patches(&mut web.sheet.patches, side, cell);
        }
        if let Some(saleable) = web.fabric.saleable_width.filter(|saleable| *saleable > width) {
            let [shown, width] = [saleable, width].map(|size| Dimension::Length.pretty(size));
            let fault = Fault::new(format!("is wider than the web, {width}"), "write a smaller one");
            self.refuse("fabric.saleable_width", shown, fault);
        }
        if !self.is_written("web.window") {
            web.window = WINDOW.min(side);
        } else if web.window > side {
            let side = Dimension::Length.pretty(side);
            let fault =
                Fault::new(format!("is larger than the web's smaller side, {side}"), "write a smaller one");
            self.key_values.reject("web.window", fault);
        }
    }

    /// Sorts the sides of the patches, or chooses them, and checks them.
    fn complete_patches(&mut self, patches: &mut Vec<f64>, side: f64, cell: f64) {
        const KEY: &str = "web.patches";
        if !self.is_written(KEY) {
            let fits = |patch: &f64| is_whole(*patch, cell) && *patch <= 0.5 * side;
            *patches = PATCHES.into_iter().filter(fits).collect();
            if patches.is_empty() && !self.key_values.is_excused(KEY) {
                let [shown, exact] = [4, 12].map(|digits| Dimension::Length.pretty_to(cell, digits));
                let fault = Fault::new(
                    format!(
                        "is missing, and none of the usual patches, 1, 2, 5, 10, 20 and 50 mm, is a whole \
                        number of cells of {shown} and at most half as large as the web"
                    ),
                    format!("add patches = [\"{exact}\"] to [web], or change web.cell"),
                );
                self.key_values.reject(KEY, fault);
            }
            return;
        }
        patches.sort_by(f64::total_cmp);
        patches.dedup();
        if patches.len() > MOST_PATCHES {
            let fault = Fault::new(
                format!("lists {} patches", patches.len()),
                format!("at most {MOST_PATCHES} are compared"),
            );
            self.key_values.reject(KEY, fault);
            return;
        }
        for &patch in &*patches {
            if !is_whole(patch, cell) {
                let shown = Dimension::Length.pretty(patch);
                let fault = not_whole(&format!("has {shown}, which is"), patch, cell);
                self.key_values.reject(KEY, fault);
            } else if patch > 0.5 * side {
                let [patch, side] = [patch, side].map(|size| Dimension::Length.pretty(size));
                let fault = Fault::new(
                    format!(
                        "has {patch}, which is more than half of the web's smaller side, {side}, so that \
                        there is nothing to compare"
                    ),
                    "leave it out, or make the web larger",
                );
                self.key_values.reject(KEY, fault);
            }
        }
    }
}

/// The fault of a size that is not a whole number of cells.
fn not_whole(is: &str, size: f64, cell: f64) -> Fault {
    let below = (size / cell).floor();
    let shown = |cells: f64| Dimension::Length.pretty_to(cells * cell, 12);
    let nearest =
        if below < 1.0 { shown(1.0) } else { format!("{} or {}", shown(below), shown(below + 1.0)) };
    Fault::new(
        format!("{is} not a whole number of cells of {}", Dimension::Length.pretty(cell)),
        format!("write {nearest}, or another web.cell"),
    )
}

fn is_whole(size: f64, cell: f64) -> bool {
    let (cells, whole) = whole_parts(size, cell);
    whole && cells > 0
}

/// The smallest of the usual cells that makes not too many of them, of those that divide the sheet if any does.
fn chosen_cell(width: f64, length: f64) -> f64 {
    let few = |cell: &f64| width / cell * (length / cell) <= MANY_CELLS;
    let divides = |cell: &f64| is_whole(width, *cell) && is_whole(length, *cell);
    let mut fitting = CELLS.into_iter().filter(few);
    fitting.clone().find(divides).or_else(|| fitting.next()).unwrap_or(CELLS[CELLS.len() - 1])
}
