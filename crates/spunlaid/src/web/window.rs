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

/// Windows of the sheet, whose fibres are kept while it is laid: the one that is shown, and those in which
/// holes are counted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Windows {
    /// The window whose fibres are shown.
    pub shown: Window,
    /// The windows in which holes are counted; None to keep nothing there.
    pub counted: Option<WindowLattice>,
}

impl From<Window> for Windows {
    fn from(shown: Window) -> Self {
        Self { shown, counted: None }
    }
}

/// Small square windows, evenly spread over the sheet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindowLattice {
    /// Number of windows in cross and in machine direction.
    pub count: [usize; 2],
    /// From window to window [m].
    pub pitch: [f64; 2],
    /// Side of a window [m].
    pub side: f64,
    /// Width about it in which pieces are kept too [m].
    pub margin: f64,
    /// Whether the sheet goes on at its edge across.
    is_closed: bool,
}

/// A straight piece of a fibre in one of the windows of a [`WindowLattice`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PieceInWindow {
    /// Number of the window, counted across the web first.
    pub window: usize,
    /// Number of the layer, from 0.
    pub layer: usize,
    /// Its ends, from the corner of the window [m].
    pub ends: [[f64; 2]; 2],
    /// Its mass per length over that of the other filaments of its layer.
    pub titre: f64,
}

impl PieceInWindow {
    /// Of a filament of another titre.
    pub(super) const fn of(self, titre: f64) -> Self {
        Self { titre, ..self }
    }
}

impl WindowLattice {
    /// So many windows, or fewer where they would be too near to each other; None if the sheet is too small for any.
    ///
    /// * `side` – of a window [m]
    /// * `margin` – width about it in which pieces are kept too [m]
    pub fn new(sheet: &Sheet, (side, margin): (f64, f64), windows: usize) -> Option<Self> {
        let whole = side + 2.0 * margin;
        let sizes = [sheet.width, sheet.length];
        let apart = (sizes[0] * sizes[1] / windows as f64).sqrt().max(2.0 * whole);
        let count = sizes.map(|size| ((size / apart).round() as usize).max(usize::from(size >= whole)));
        let pitch = [0, 1].map(|axis| sizes[axis] / count[axis] as f64);
        let is_closed = sheet.edges == Edges::Periodic;
        (whole > 0.0 && count.iter().all(|count| *count > 0)).then_some(Self {
            count,
            pitch,
            side,
            margin,
            is_closed,
        })
    }

    /// Number of windows.
    pub const fn windows(&self) -> usize {
        self.count[0] * self.count[1]
    }

    /// The corner of a window on the sheet [m].
    pub fn corner(&self, window: usize) -> [f64; 2] {
        let numbers = [window % self.count[0], window / self.count[0]];
        [0, 1].map(|axis| (numbers[axis] as f64 + 0.5) * self.pitch[axis] - 0.5 * self.side)
    }

    /// A piece as it lies in the window that is nearest to its middle, if it is in that.
    ///
    /// * `ends` – on the sheet, which they may leave [m]
    /// * `is_ring` – whether the sheet is closed in machine direction
    #[inline(always)]
    pub(crate) fn piece(&self, layer: usize, ends: [[f64; 2]; 2], is_ring: bool) -> Option<PieceInWindow> {
        let along = self.near(1, ends, is_ring)?;
        let across = self.near(0, ends, self.is_closed)?;
        let ends = [0, 1].map(|end| [ends[end][0] - across.1, ends[end][1] - along.1]);
        Some(PieceInWindow { window: along.0 * self.count[0] + across.0, layer, ends, titre: 1.0 })
    }

    /// The number of the window in one direction, and the place of its corner.
    #[inline(always)]
    fn near(&self, axis: usize, ends: [[f64; 2]; 2], is_closed: bool) -> Option<(usize, f64)> {
        let (from, to, pitch) = (ends[0][axis], ends[1][axis], self.pitch[axis]);
        let number = floor(0.5 * (from + to) / pitch);
        let corner = (number as f64 + 0.5) * pitch - 0.5 * self.side;
        let (low, high) = (from.min(to) - corner, from.max(to) - corner);
        if low > self.side + self.margin || high < -self.margin {
            return None;
        }
        let count = self.count[axis] as i64;
        let number = if is_closed { number.rem_euclid(count) } else { number };
        (0..count).contains(&number).then_some((number as usize, corner))
    }
}

/// A window as it is met on a sheet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WindowOnSheet {
    /// The window that is shown; None if it is on another stretch.
    window: Option<Window>,
    /// The windows in which holes are counted, and which of their rows are on this stretch: from the first to
    /// before the last.
    counted: Option<(WindowLattice, [usize; 2])>,
    /// Width after which the sheet goes on at its edges [m].
    turn: Option<f64>,
    /// How far before and behind the window a piece is looked at [m].
    margin: f64,
}

impl WindowOnSheet {
    pub(crate) fn new(windows: Windows, sheet: &Sheet) -> Self {
        Self::beginning_on(windows, sheet, [f64::NEG_INFINITY, f64::INFINITY])
    }

    /// The windows that begin on a stretch of the sheet.
    ///
    /// * `from`, `to` – in machine direction [m]
    pub(crate) fn beginning_on(windows: Windows, sheet: &Sheet, [from, to]: [f64; 2]) -> Self {
        let turn = (sheet.edges == Edges::Periodic).then_some(sheet.width);
        let rows_before = |lattice: &WindowLattice, end: f64| {
            (0..lattice.count[1]).filter(|row| lattice.corner(row * lattice.count[0])[1] < end).count()
        };
        let counted =
            windows.counted.map(|lattice| (lattice, [from, to].map(|end| rows_before(&lattice, end))));
        Self {
            window: Some(windows.shown).filter(|window| (from..to).contains(&window.corner[1])),
            counted: counted.filter(|(_, [first, end])| first < end),
            turn,
            margin: sheet.cell,
        }
    }

    /// From where to where a piece may be kept in machine direction [m]; None if no window is there.
    pub(crate) fn reach(&self) -> Option<[f64; 2]> {
        // A piece that begins a cell beside the window is looked at.
        let shown = self.window.map(|Window { corner, sides }| {
            [corner[1] - 2.0 * self.margin, corner[1] + sides[1] + 2.0 * self.margin]
        });
        let counted = self.counted.map(|(lattice, [first, end])| {
            let corner = |row: usize| lattice.corner(row * lattice.count[0])[1];
            let beside = lattice.margin + 2.0 * self.margin;
            [corner(first) - beside, corner(end - 1) + lattice.side + beside]
        });
        [shown, counted].into_iter().flatten().reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])])
    }

    /// A piece as it lies in one of the windows in which holes are counted.
    #[inline(always)]
    fn counted_piece(&self, ends: [[f64; 2]; 2]) -> Option<PieceInWindow> {
        let (lattice, [first, end]) = self.counted?;
        let piece = lattice.piece(0, ends, false)?;
        (first..end).contains(&(piece.window / lattice.count[0])).then_some(piece)
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
    pieces: Vec<PieceInWindow>,
}

/// The parts of filaments in the windows of a sheet.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct KeptFibres {
    /// In the window that is shown, in the order of each filament.
    pub(crate) strands: Vec<Strand>,
    /// In the windows in which holes are counted.
    pub(crate) pieces: Vec<PieceInWindow>,
}

impl KeptFibres {
    pub(crate) fn add(&mut self, other: Self) {
        self.strands.extend(other.strands);
        self.pieces.extend(other.pieces);
    }
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
        self.pieces.extend(on.counted_piece([from, to]).map(|piece| piece.of(titre)));
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
    pub(crate) fn into_parts(self) -> KeptFibres {
        KeptFibres { strands: self.strands, pieces: self.pieces }
    }
}
