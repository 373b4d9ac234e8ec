//! The sheet: its size, cells, patches and edges.

use super::read::Reading;
use crate::case::keys::Value;
use crate::case::whole_parts;
use crate::error::WebFault;
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
            let fault = WebFault::TooManyCells { cells, most: MOST_CELLS, cell };
            self.refuse("web.cell", Dimension::Length.pretty(cell), fault);
            return None;
        }
        let mut whole = true;
        for (key, size) in [("web.width", width), ("web.length", length)] {
            if !is_whole(size, cell) {
                whole = false;
                self.written.reject(key, WebFault::NotWholeCells { size, cell }.into());
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
                self.written.reject(KEY, WebFault::NoPatches { cell }.into());
            }
            return Some(patches).filter(|patches| !patches.is_empty());
        };
        let Some(Value::Numbers(mut patches)) = said.value.clone() else { return None };
        patches.sort_by(f64::total_cmp);
        patches.dedup();
        let before = self.written.problems.len();
        if patches.len() > MOST_PATCHES {
            let fault = WebFault::TooManyPatches { patches: patches.len(), most: MOST_PATCHES };
            self.written.reject(KEY, fault.into());
            return None;
        }
        for &patch in &patches {
            if !is_whole(patch, cell) {
                self.written.reject(KEY, WebFault::PatchNotWholeCells { patch, cell }.into());
            } else if patch > 0.5 * side {
                self.written.reject(KEY, WebFault::PatchTooLarge { patch, side }.into());
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
            self.written.reject("web.window", WebFault::WindowTooLarge { side }.into());
        }
        Some(window)
    }
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
