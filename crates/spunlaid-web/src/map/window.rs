//! Windows of the sheet, and the parts of fibres in them.

use super::{Edges, Sheet};

/// The largest whole number that is not above, without a call.
#[inline(always)]
pub(super) fn floor(at: f64) -> i64 {
    let whole = at as i64;
    whole - i64::from(whole as f64 > at)
}

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
pub struct WindowCurve {
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
}

/// Whether two places are the same but for rounding.
fn is_same(a: [f64; 2], b: [f64; 2]) -> bool {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) < 1e-9
}

/// A window as it is met on a sheet.
#[derive(Clone, Copy, Debug)]
pub struct WindowOnSheet {
    window: Window,
    /// After which the sheet goes on at its edges in cross and in machine direction [m].
    turns: [Option<f64>; 2],
    /// How far before and behind the window a piece is looked at [m].
    margin: f64,
}

impl WindowOnSheet {
    /// A window on a sheet, which may go on at its edges.
    pub fn new(window: Window, sheet: &Sheet) -> Self {
        let turns = [(sheet.edges == Edges::Periodic).then_some(sheet.width), None];
        Self { window, turns, margin: sheet.cell }
    }

    /// On a sheet that is closed to a ring in machine direction.
    pub(super) fn on_ring(window: Window, sheet: &Sheet) -> Self {
        let of_sheet = Self::new(window, sheet);
        Self { turns: [of_sheet.turns[0], Some(sheet.length)], ..of_sheet }
    }

    /// Whether a place is in the window, or so far from it either way.
    pub(super) fn nears(&self, place: [f64; 2], distance: f64) -> bool {
        self.window.nears(self.seen(place), distance)
    }

    /// A place on the sheet as seen from the corner of the window.
    #[inline(always)]
    fn seen(&self, place: [f64; 2]) -> [f64; 2] {
        let Window { corner, sides } = self.window;
        [0, 1].map(|axis| {
            let (from_corner, middle) = (place[axis] - corner[axis], 0.5 * sides[axis]);
            let turned = |turn: f64| turn * floor((from_corner - middle) / turn + 0.5) as f64;
            from_corner - self.turns[axis].map_or(0.0, turned)
        })
    }

    /// Whether something that reaches from one place to another in machine direction lies beside the window in cross
    /// direction, or a little before or behind that.
    #[inline(always)]
    pub(crate) fn is_beside(&self, from: f64, to: f64) -> bool {
        let [start, end] = [0.0, self.window.sides[1]].map(|side| self.window.corner[1] + side);
        self.turns[1].is_some() || (from <= end + self.margin && to >= start - self.margin)
    }
}

/// The parts of a filament in a window, while it is laid piece by piece.
#[derive(Debug, Default)]
pub struct WindowCurves {
    strands: Vec<WindowCurve>,
    /// Whether the last of them goes on.
    enters: bool,
}

impl WindowCurves {
    /// Keeps a piece of a filament that is in the window.
    ///
    /// * `ends` – on the sheet [m]
    /// * `titre` – its mass per length over that of the others; nothing is kept of one without mass
    pub fn keep(&mut self, filament: usize, ends: [[f64; 2]; 2], titre: f64, on: &WindowOnSheet) {
        let [from, to] = ends;
        // Most pieces are far before or behind it.
        if titre == 0.0 || !(on.is_beside(from[1], from[1]) || on.is_beside(to[1], to[1])) {
            self.enters = false;
            return;
        }
        let (window, start) = (on.window, on.seen(from));
        let by = [to[0] - from[0], to[1] - from[1]];
        let end = [start[0] + by[0], start[1] + by[1]];
        let shown = window.holds(start) || window.holds(end);
        // Where the sheet goes on, a piece may begin at the other edge.
        let is_there = |strand: &WindowCurve| strand.points.last().is_some_and(|last| is_same(*last, start));
        match self.strands.last_mut().filter(|strand| shown && self.enters && is_there(strand)) {
            Some(strand) => strand.points.push(end),
            None if shown => self.strands.push(WindowCurve { layer: 0, filament, points: vec![start, end] }),
            None => {}
        }
        self.enters = shown;
        let arrived = on.seen(to);
        if !is_same(arrived, end) && window.holds(arrived) {
            // It comes in at the other edge.
            let start = [arrived[0] - by[0], arrived[1] - by[1]];
            self.strands.push(WindowCurve { layer: 0, filament, points: vec![start, arrived] });
            self.enters = true;
        }
    }

    /// The parts, in the order of the filament.
    pub fn into_parts(self) -> Vec<WindowCurve> {
        self.strands
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet of 100 mm by 200 mm in which a window of 20 mm by 30 mm begins 5 mm from both edges.
    fn window(edges: Edges, is_ring: bool) -> WindowOnSheet {
        let sheet = Sheet { edges, ..Sheet::new(0.1, 0.2, 1e-3) };
        let window = Window { corner: [5e-3; 2], sides: [20e-3, 30e-3] };
        if is_ring { WindowOnSheet::on_ring(window, &sheet) } else { WindowOnSheet::new(window, &sheet) }
    }

    #[test]
    fn analytic_positions_as_a_window_sees_them() {
        let wholes = [-3.0, -2.5, -1.0, -0.25, 0.0, 0.25, 1.0, 1.75];
        assert_eq!(wholes.map(floor), [-3, -3, -1, -1, 0, 0, 1, 1]);
        let close =
            |found: [f64; 2], expected: [f64; 2]| assert!(is_same(found, expected), "{found:?} {expected:?}");
        let (cut, ring) = (window(Edges::Cut, false), window(Edges::Periodic, true));
        close(cut.seen([0.09, 0.19]), [0.085, 0.185]);
        close(window(Edges::Periodic, false).seen([0.09, 0.19]), [-0.015, 0.185]);
        close(ring.seen([0.09, 0.19]), [-0.015, -0.015]);
        close(ring.seen([-0.09, 0.21]), [0.005, 0.005]);
        // Half of the way around from the middle of the window.
        close(ring.seen([0.0649, 0.1199]), [0.0599, 0.1149]);
        close(ring.seen([0.0651, 0.1201]), [-0.0399, -0.0849]);
        // Within 4 mm of it, and a cell before and behind.
        for (position, is_near) in [
            ([0.0011, 0.02], true),
            ([0.0009, 0.02], false),
            ([0.0289, 0.0389], true),
            ([0.02, 0.0391], false),
        ] {
            assert_eq!(cut.nears(position, 4e-3), is_near, "{position:?}");
        }
        for ([from, to], is_beside) in
            [([0.0, 0.0039], false), ([0.0, 0.0041], true), ([0.0359, 0.05], true), ([0.0361, 0.05], false)]
        {
            assert_eq!((cut.is_beside(from, to), ring.is_beside(from, to)), (is_beside, true), "{from} {to}");
        }
    }

    /// A filament goes out over an edge of the sheet, comes in at the other one, and stops for a while.
    #[test]
    fn analytic_the_parts_of_a_filament_in_a_window() {
        let on = WindowOnSheet::new(
            Window { corner: [0.0, 0.0], sides: [0.1, 0.05] },
            &Sheet::new(0.1, 0.2, 1e-3),
        );
        let mut curves = WindowCurves::default();
        let at = |cd: f64| [1e-3 * cd, 10e-3];
        for (from, to, titre) in [
            (96.0, 98.0, 1.0),
            (98.0, 102.0, 1.0),
            (102.0, 104.0, 1.0),
            (104.0, 106.0, 0.0),
            (106.0, 108.0, 0.5),
        ] {
            curves.keep(4, [at(from), at(to)], titre, &on);
        }
        curves.keep(4, [[8e-3, 10e-3], [8e-3, 60e-3]], 1.0, &on);
        curves.keep(4, [[8e-3, 60e-3], [8e-3, 62e-3]], 1.0, &on);
        let parts = curves.into_parts();
        let wanted: [&[[f64; 2]]; 3] = [
            &[[96.0, 10.0], [98.0, 10.0], [102.0, 10.0]],
            &[[-2.0, 10.0], [2.0, 10.0], [4.0, 10.0]],
            &[[6.0, 10.0], [8.0, 10.0], [8.0, 60.0]],
        ];
        assert_eq!(parts.len(), 3, "{parts:?}");
        for (part, wanted) in parts.iter().zip(wanted) {
            assert_eq!((part.filament, part.points.len()), (4, wanted.len()), "{part:?}");
            let is_near = |(found, wanted): (&[f64; 2], &[f64; 2])| is_same(*found, wanted.map(|x| 1e-3 * x));
            assert!(part.points.iter().zip(wanted).all(is_near), "{part:?}");
        }
    }
}
