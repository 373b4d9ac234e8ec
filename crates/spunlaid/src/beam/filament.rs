//! A filament of a beam: what it has laid, and where on the sheet.

use crate::error::Error;
use crate::fibre::Place;
use crate::flight::LaidPoint;
use crate::line::Line;
use crate::web::{Brush, Sheet, Strands, Window, WindowOnSheet};

/// How far what has been laid reaches along the belt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reach {
    /// Farthest that a point lies ahead of where the belt was when it was fed at its start [m].
    pub(super) ahead: f64,
    /// Farthest back that a point of the start lies on the belt [m].
    pub(super) start: f64,
    /// Length of fibre that each filament has laid at least [m]; filaments that are lost do not count.
    pub(super) fed: f64,
    /// Number of filaments that are lost.
    pub(super) lost: usize,
}

impl Default for Reach {
    fn default() -> Self {
        Self { ahead: f64::NEG_INFINITY, start: f64::INFINITY, fed: 0.0, lost: 0 }
    }
}

impl Reach {
    pub(super) fn with(self, other: Self) -> Self {
        Self {
            ahead: self.ahead.max(other.ahead),
            start: self.start.min(other.start),
            fed: self.fed.min(other.fed),
            lost: self.lost + other.lost,
        }
    }
}

/// The stretch of belt that becomes the sheet. Places on the belt are `y − v_b t`: what is laid later lies
/// farther back.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    belt_ratio: f64,
    /// Length of fibre that is fed in the start [m].
    start: f64,
    length: f64,
    window: WindowOnSheet,
    /// Where the sheet begins, at its back [m]; None while filaments lay the fibre of their start.
    back: Option<f64>,
}

impl Stretch {
    /// While nothing has been laid.
    ///
    /// * `start` – length of fibre that is fed in the start [m]
    pub(super) fn before(line: &Line, start: f64, window: Window, sheet: &Sheet) -> Self {
        let window = WindowOnSheet::new(window, sheet);
        Self { belt_ratio: line.belt_ratio(), start, length: sheet.length, window, back: None }
    }

    /// Finds the place of the sheet as soon as all filaments have laid the fibre of their start.
    pub(super) fn settle(&mut self, reach: &Reach) {
        if self.back.is_none() && reach.fed > self.start {
            self.back = Some(reach.start - self.length);
        }
    }

    /// Where the sheet begins, at its back [m]; None while filaments lay the fibre of their start.
    pub(super) const fn back(&self) -> Option<f64> {
        self.back
    }

    /// The place of a point on the sheet, in cross and in machine direction [m], if it is known where the sheet is.
    fn on_sheet(&self, place: Place, point: &LaidPoint) -> Option<[f64; 2]> {
        Some([place.z + point.cd, place.y + point.md - self.back?])
    }
}

/// A filament: its place, and what of it has not been drawn.
#[derive(Debug)]
pub(super) struct Filament {
    /// Number across the web.
    pub(super) number: usize,
    pub(super) place: Place,
    /// The last point that was drawn, and those after it.
    waiting: Vec<LaidPoint>,
    /// Deviations of the points after the start from the straight trace of a filament that comes down at one
    /// place, in machine and in cross direction [m].
    pub(super) deviations: Vec<[f64; 2]>,
    /// All points, if they are kept.
    pub(super) kept: Option<Vec<LaidPoint>>,
    /// Its parts in the window.
    pub(super) strands: Strands,
    /// Why it is lost.
    pub(super) lost: Option<Error>,
}

impl Filament {
    pub(super) fn new(number: usize, place: Place, kept: bool) -> Self {
        let kept = kept.then(Vec::new);
        let (waiting, deviations) = (Vec::new(), Vec::new());
        Self { number, place, waiting, deviations, kept, strands: Strands::default(), lost: None }
    }

    /// Takes points that it has laid, and draws its pieces on the sheet as soon as it is known where that is.
    pub(super) fn lay(
        &mut self,
        points: Vec<LaidPoint>,
        stretch: &Stretch,
        on: Option<&Brush<'_>>,
        reach: &mut Reach,
    ) {
        for point in &points {
            let md = self.place.y + point.md;
            reach.ahead = reach.ahead.max(md + stretch.belt_ratio * point.fed);
            if point.fed < stretch.start {
                reach.start = reach.start.min(md);
            } else {
                self.deviations.push([point.md + stretch.belt_ratio * point.fed, point.cd]);
            }
        }
        if let Some(kept) = &mut self.kept {
            kept.extend(&points);
        }
        self.waiting.extend(points);
        if stretch.back.is_some() {
            let titre = on.and_then(|brush| brush.titres.of(self.number));
            for pair in 1..self.waiting.len() {
                let ends = [pair - 1, pair].map(|i| stretch.on_sheet(self.place, &self.waiting[i]));
                if let [Some(from), Some(to)] = ends {
                    let mut of_others = 1.0;
                    if let Some(brush) = on {
                        let (quanta, titre) = brush.quanta_at(titre, to[1]);
                        brush.canvas.draw(from, to, quanta);
                        of_others = titre;
                    }
                    self.strands.keep(self.number, ([from, to], of_others), &stretch.window);
                }
            }
        } else {
            // The points of the start lie before the sheet.
            let first = self.waiting.iter().position(|point| point.fed >= stretch.start);
            self.waiting.drain(..first.unwrap_or(self.waiting.len()).saturating_sub(1));
        }
        reach.fed = reach.fed.min(self.waiting.last().map_or(0.0, |point| point.fed));
        if stretch.back.is_some() {
            self.waiting.drain(..self.waiting.len().saturating_sub(1));
        }
    }
}
