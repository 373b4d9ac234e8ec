//! Windows of the sheet, and the parts of fibres in them.

use super::floor::floor;
use super::{Edges, Sheet};

/// A rectangle of the sheet, in cross and in machine direction [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The corner nearest to the origin.
    pub corner: [f64; 2],
    /// Its sides.
    pub sides: [f64; 2],
}

/// A part of a fibre within a window.
#[derive(Clone, Debug, PartialEq)]
pub struct Strand {
    /// Number of the layer, from 0.
    pub layer: usize,
    /// Number of the filament in its layer, counted across the web from 0.
    pub filament: usize,
    /// Places in cross and in machine direction, from the corner of the window [m]. The first and the last may be one
    /// piece outside.
    pub points: Vec<[f64; 2]>,
}

impl Window {
    pub(crate) fn holds(&self, point: [f64; 2]) -> bool {
        self.nears(point, 0.0)
    }

    /// Whether a point lies in the window, or so far from it either way.
    pub(super) fn nears(&self, point: [f64; 2], distance: f64) -> bool {
        point.iter().zip(self.sides).all(|(at, side)| (-distance..=side + distance).contains(at))
    }

    /// The larger distance of two points either way, over the window's sides.
    pub(super) fn distance(&self, a: [f64; 2], b: [f64; 2]) -> f64 {
        ((a[0] - b[0]) / self.sides[0]).abs().max(((a[1] - b[1]) / self.sides[1]).abs())
    }
}

/// A window as it is met on a sheet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WindowOnSheet {
    /// The window that is shown; None if it is on another stretch.
    window: Option<Window>,
    /// Width after which the sheet goes on at its edges [m].
    turn: Option<f64>,
    /// How far before and behind the window a piece is looked at [m].
    margin: f64,
}

impl WindowOnSheet {
    pub(crate) fn new(window: Window, sheet: &Sheet) -> Self {
        Self::beginning_on(window, sheet, [f64::NEG_INFINITY, f64::INFINITY])
    }

    /// The window, if it begins on a stretch of the sheet.
    ///
    /// * `from`, `to` – in machine direction [m]
    pub(crate) fn beginning_on(window: Window, sheet: &Sheet, [from, to]: [f64; 2]) -> Self {
        let turn = (sheet.edges == Edges::Periodic).then_some(sheet.width);
        let window = (from..to).contains(&window.corner[1]).then_some(window);
        Self { window, turn, margin: sheet.cell }
    }

    /// From where to where a piece may be kept in machine direction [m]; None if the window is not there.
    pub(crate) fn reach(&self) -> Option<[f64; 2]> {
        // A piece that begins a cell beside the window is looked at.
        let beside = 2.0 * self.margin;
        self.window.map(|Window { corner, sides }| [corner[1] - beside, corner[1] + sides[1] + beside])
    }

    /// A place on the sheet as seen from the corner of a window.
    fn seen(&self, Window { corner, sides }: Window, [cd, md]: [f64; 2]) -> [f64; 2] {
        let (across, middle) = (cd - corner[0], 0.5 * sides[0]);
        let turned = |turn: f64| turn * floor((across - middle) / turn + 0.5) as f64;
        [across - self.turn.map_or(0.0, turned), md - corner[1]]
    }

    /// Whether a place lies beside a window in cross direction, or a little before or behind that.
    fn is_beside(&self, window: Window, [_, md]: [f64; 2]) -> bool {
        let from_corner = md - window.corner[1];
        (-self.margin..=window.sides[1] + self.margin).contains(&from_corner)
    }
}

/// The parts of a filament in a window, while it is laid piece by piece.
#[derive(Debug, Default)]
pub(crate) struct Strands {
    strands: Vec<Strand>,
    /// Whether the last of them goes on.
    enters: bool,
}

impl Strands {
    /// Keeps a piece of a filament that is in the window.
    ///
    /// * `from`, `to` – its ends on the sheet [m]
    /// * `titre` – its mass per length over that of the others; nothing is kept of one without mass
    pub(crate) fn keep(
        &mut self,
        filament: usize,
        ([from, to], titre): ([[f64; 2]; 2], f64),
        on: &WindowOnSheet,
    ) {
        if titre == 0.0 {
            self.enters = false;
            return;
        }
        // Most pieces are far before or behind it.
        let near = on.window.filter(|window| on.is_beside(*window, from) || on.is_beside(*window, to));
        let Some(window) = near else {
            self.enters = false;
            return;
        };
        let start = on.seen(window, from);
        let end = [start[0] + to[0] - from[0], start[1] + to[1] - from[1]];
        let shown = window.holds(start) || window.holds(end);
        match self.strands.last_mut().filter(|_| shown && self.enters) {
            Some(strand) => strand.points.push(end),
            None if shown => self.strands.push(Strand { layer: 0, filament, points: vec![start, end] }),
            None => {}
        }
        self.enters = shown;
    }

    /// The parts, in the order of the filament.
    pub(crate) fn into_parts(self) -> Vec<Strand> {
        self.strands
    }
}
