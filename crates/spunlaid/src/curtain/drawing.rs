//! Curves of a curtain on the sheet.

use super::Curtain;
use crate::error::{Error, Fault};
use crate::threads::try_each;
use crate::web::{Canvas, Edges, LaidWeb, Sheet, Strand, Window};
use std::sync::atomic::{AtomicBool, Ordering};

/// Points that are computed at once.
const BLOCK: usize = 1024;

/// The stretch of belt that becomes the sheet, as in a [beam](crate::beam): places on the belt are counted from where a filament in the middle of the slot
/// is fed when its first point is fed, and what is laid later lies farther back.
#[derive(Clone, Copy, Debug)]
pub struct Belt<'a> {
    /// The sheet.
    pub sheet: &'a Sheet,
    /// Window of the sheet, whose single fibres are kept.
    pub window: Window,
    /// Where the sheet begins, at its back [m].
    pub back: f64,
}

impl<'a> Belt<'a> {
    /// The stretch on which all filaments of a curtain lie from edge to edge, as near to their start as it can be.
    ///
    /// # Errors
    /// If the curves are too short for the sheet.
    pub fn within(curtain: &dyn Curtain, sheet: &'a Sheet, window: Window) -> Result<Self, Fault> {
        let [back_of_start, front_of_end] = curtain.reach();
        let passed = curtain.belt_ratio() * curtain.spacing() * (curtain.points() as f64 - 1.0);
        let longest = back_of_start - (front_of_end - passed);
        if sheet.length > longest {
            return Err(Fault::new(
                format!(
                    "the curves of the filaments cover {} mm of belt from edge to edge, and the sheet is {} mm long",
                    (longest.max(0.0) * 1e3).floor(),
                    (sheet.length * 1e3).ceil()
                ),
                "fly the filaments for longer, or make the sheet shorter (web.length)",
            ));
        }
        Ok(Self { sheet, window, back: back_of_start - sheet.length })
    }

    /// A place on the sheet as seen from the corner of the window.
    fn in_window(&self, [cd, md]: [f64; 2]) -> [f64; 2] {
        let Window { corner, sides } = self.window;
        let (across, middle) = (cd - corner[0], 0.5 * sides[0]);
        let turns = match self.sheet.edges {
            Edges::Periodic => ((across - middle) / self.sheet.width).round(),
            Edges::Cut => 0.0,
        };
        [across - turns * self.sheet.width, md - corner[1]]
    }
}

/// Draws all filaments of a curtain; the parts of them in the window are returned.
///
/// * `quanta` – of the canvas, for a piece from point to point
///
/// # Errors
/// If it is stopped.
pub(crate) fn draw(
    curtain: &dyn Curtain,
    belt: Belt<'_>,
    (canvas, quanta): (&Canvas, u32),
    (threads, stop): (usize, &AtomicBool),
) -> Result<Vec<Strand>, Error> {
    let strands = try_each(threads, curtain.places().len(), |filament| {
        if stop.load(Ordering::Relaxed) {
            return Err(Error::Interrupted);
        }
        Ok(draw_filament(curtain, filament, belt, (canvas, quanta)))
    })?;
    Ok(strands.concat())
}

fn draw_filament(
    curtain: &dyn Curtain,
    filament: usize,
    belt: Belt<'_>,
    (canvas, quanta): (&Canvas, u32),
) -> Vec<Strand> {
    let place = curtain.places()[filament];
    let advance = curtain.belt_ratio() * curtain.spacing();
    let mut values = [[0.0; BLOCK]; 2];
    let (mut strands, mut enters): (Vec<Strand>, bool) = (Vec::new(), false);
    let mut last: Option<[f64; 2]> = None;
    for first in (0..curtain.points()).step_by(BLOCK) {
        let count = BLOCK.min(curtain.points() - first);
        curtain.curve(filament, first, values.each_mut().map(|values| &mut values[..count]));
        for i in 0..count {
            let [md, cd] = values.map(|values| f64::from(values[i]));
            let to = [place.z + cd, place.y + md - advance * (first + i) as f64 - belt.back];
            if let Some(from) = last {
                canvas.draw(from, to, quanta);
                let start = belt.in_window(from);
                let end = [start[0] + to[0] - from[0], start[1] + to[1] - from[1]];
                let shown = belt.window.holds(start) || belt.window.holds(end);
                match strands.last_mut().filter(|_| shown && enters) {
                    Some(strand) => strand.points.push(end),
                    None if shown => strands.push(Strand { layer: 0, filament, points: vec![start, end] }),
                    None => {}
                }
                enters = shown;
            }
            last = Some(to);
        }
    }
    strands
}

/// Lays all filaments of a curtain on a sheet; the parts of them in the window are returned too.
///
/// * `element` – mass of a piece from point to point [kg]
///
/// # Errors
/// If a cell would hold more fibre than can be counted, or if it is stopped.
pub fn lay(
    curtain: &dyn Curtain,
    belt: Belt<'_>,
    element: f64,
    by: (usize, &AtomicBool),
) -> Result<(LaidWeb, Vec<Strand>), Error> {
    let per_length = element / curtain.spacing() * curtain.places().len() as f64;
    let basis_weight = per_length / curtain.belt_ratio() / belt.sheet.width;
    let canvas = Canvas::new(belt.sheet, &[element], basis_weight)?;
    let strands = draw(curtain, belt, (&canvas, canvas.quanta(element)), by)?;
    Ok((canvas.finish()?, strands))
}
