//! The sheet: its size, cells, patches and edges.

use super::read::Reading;
use crate::case::keys::Value;
use crate::case::whole_parts;
use crate::error::Fault;
use crate::layers::keys::EDGES;
use crate::units::Dimension;
use crate::web::{Edges, Sheet};

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

impl Reading<'_> {
    /// The sheet; none if there is a problem with it, which is noted.
    pub(super) fn sheet(&mut self) -> Option<Sheet> {
        let (width, length) = (self.number("", "web.width"), self.number("", "web.length"));
        let edges = match self.written.text("web.edges") {
            Some(name) if name == EDGES[1] => Edges::Cut,
            _ => Edges::Periodic,
        };
        let (width, length) = (width?, length?);
        let cell = match self.written.get("web.cell") {
            Some(_) => self.written.number("web.cell")?,
            None => chosen_cell(width, length),
        };
        let cells = width / cell * (length / cell);
        if !cells.is_finite() || cells > MOST_CELLS {
            let cell = Dimension::Length.pretty(cell);
            let fault = Fault::new(
                format!("makes {cells:.1e} cells of {cell} in the web; at most {MOST_CELLS:e} are possible"),
                "make the cells larger, or the web smaller",
            );
            self.refuse("web.cell", cell, fault);
            return None;
        }
        let mut whole = true;
        for (key, size) in [("web.width", width), ("web.length", length)] {
            if !is_whole(size, cell) {
                whole = false;
                let fault = not_whole("is", size, cell);
                self.written.reject(key, fault);
            }
        }
        let patches = if whole { self.patches(width.min(length), cell) } else { None };
        Some(Sheet { width, length, cell, patches: patches?, edges })
    }

    /// The sides of the patches, the smallest first.
    fn patches(&mut self, side: f64, cell: f64) -> Option<Vec<f64>> {
        const KEY: &str = "web.patches";
        let Some(said) = self.written.get(KEY) else {
            let fits = |patch: &f64| is_whole(*patch, cell) && *patch <= 0.5 * side;
            let patches: Vec<f64> = PATCHES.into_iter().filter(fits).collect();
            if patches.is_empty() && !self.written.is_excused(KEY) {
                let [shown, exact] = [4, 12].map(|digits| Dimension::Length.pretty_to(cell, digits));
                let fault = Fault::new(
                    format!(
                        "is missing, and none of the usual patches, 1, 2, 5, 10, 20 and 50 mm, is a whole number of cells of \
                         {shown} and at most half as large as the web"
                    ),
                    format!("add patches = [\"{exact}\"] to [web], or change web.cell"),
                );
                self.written.reject(KEY, fault);
            }
            return Some(patches).filter(|patches| !patches.is_empty());
        };
        let Some(Value::Numbers(mut patches)) = said.value.clone() else { return None };
        patches.sort_by(f64::total_cmp);
        patches.dedup();
        let before = self.written.problems.len();
        if patches.len() > MOST_PATCHES {
            let fault = Fault::new(
                format!("lists {} patches", patches.len()),
                format!("at most {MOST_PATCHES} are compared"),
            );
            self.written.reject(KEY, fault);
            return None;
        }
        for &patch in &patches {
            if !is_whole(patch, cell) {
                let shown = Dimension::Length.pretty(patch);
                let fault = not_whole(&format!("has {shown}, which is"), patch, cell);
                self.written.reject(KEY, fault);
            } else if patch > 0.5 * side {
                let [patch, side] = [patch, side].map(|size| Dimension::Length.pretty(size));
                let fault = Fault::new(
                    format!(
                        "has {patch}, which is more than half of the web's smaller side, {side}, so that there is nothing to \
                         compare"
                    ),
                    "leave it out, or make the web larger",
                );
                self.written.reject(KEY, fault);
            }
        }
        (self.written.problems.len() == before).then_some(patches)
    }

    /// Side of the window whose single fibres are written out.
    pub(super) fn window(&mut self, sheet: &Sheet) -> Option<f64> {
        let side = sheet.width.min(sheet.length);
        if self.written.get("web.window").is_none() {
            return Some(WINDOW.min(side));
        }
        let window = self.written.number("web.window")?;
        if window > side {
            let side = Dimension::Length.pretty(side);
            let fault =
                Fault::new(format!("is larger than the web's smaller side, {side}"), "write a smaller one");
            self.written.reject("web.window", fault);
        }
        Some(window)
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
