//! The largest disc in each hole of a window.

use super::Piece;
use super::bitmap::Bitmap;
use super::nearest::Nearest;
use super::regions::Regions;
use std::cmp::Ordering;
use std::collections::{BTreeMap, BinaryHeap};
use std::rc::Rc;

/// A disc that fits into a hole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Its centre, from the corner of what has been drawn [m].
    pub centre: [f64; 2],
    /// Its radius [m].
    pub radius: f64,
}

/// Half of the diagonal of a square of side 1.
const HALF_DIAGONAL: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Error of a radius, in the least radius of interest.
const ACCURACY: f64 = 5e-3;

/// A square in which the centre of the largest disc may lie.
struct Square {
    centre: [f64; 2],
    side: f64,
    /// The largest disc of which the centre may lie in it has at most this radius.
    bound: f64,
    /// Pieces of fibre among which are all that may be nearest to a place in it; None where they have not
    /// been looked for.
    near: Option<Rc<[Piece]>>,
}

impl PartialEq for Square {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Square {}

impl PartialOrd for Square {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Square {
    fn cmp(&self, other: &Self) -> Ordering {
        let place = |square: &Self| square.centre.map(f64::to_bits);
        self.bound.total_cmp(&other.bound).then_with(|| place(self).cmp(&place(other)))
    }
}

/// The largest disc in each hole into which a disc of a radius fits.
///
/// The room about a place changes by no more than the place is moved, so a square needs to be looked at only
/// if the room about its centre is large enough for its size; it is divided until the largest room is known.
///
/// * `coarse` – fibres drawn wider by `least` less half the diagonal of its pixels: where it is covered,
///   there is no room
/// * `least` – the radius, at least twice the side of a pixel of `coarse` [m]
pub(super) fn largest_discs(
    (fine, coarse): (&Bitmap, &Bitmap),
    regions: &mut Regions,
    nearest: &Nearest,
    least: f64,
) -> Vec<Disc> {
    // Squares of a hole, and the largest room about their centres.
    let mut holes: BTreeMap<u32, (Vec<Square>, f64)> = BTreeMap::new();
    for row in 0..coarse.side {
        coarse.bare_runs(row, |run| {
            let mut column = run.start;
            while column < run.end {
                let centre = [column, row].map(|i| (i as f64 + 0.5) * coarse.pixel);
                let room = nearest.room(centre);
                let bound = room + HALF_DIAGONAL * coarse.pixel;
                let [x, y] = centre.map(|at| (at / fine.pixel) as usize);
                column += 1;
                let Some(region) = regions.at(y, x) else { continue };
                let (squares, largest) = holes.entry(region).or_default();
                if bound >= least {
                    let side = coarse.pixel;
                    squares.push(Square { centre, side, bound, near: None });
                    *largest = largest.max(room);
                }
                // The squares of a run are of one hole; the next of them cannot have its largest disc.
                column += ((*largest - bound) / coarse.pixel).max(0.0) as usize;
            }
        });
    }
    let discs = holes.into_values().map(|(squares, _)| largest(squares, nearest, ACCURACY * least));
    discs.filter(|disc| disc.radius >= least).collect()
}

/// The largest disc whose centre lies in some squares.
fn largest(squares: Vec<Square>, nearest: &Nearest, accuracy: f64) -> Disc {
    let mut best = Disc { centre: [0.0; 2], radius: f64::NEG_INFINITY };
    let take = |centre: [f64; 2], radius: f64, best: &mut Disc| {
        if radius > best.radius {
            *best = Disc { centre, radius };
        }
    };
    for Square { centre, side, bound, .. } in &squares {
        take(*centre, bound - HALF_DIAGONAL * side, &mut best);
    }
    let mut squares = BinaryHeap::from(squares);
    while let Some(Square { centre, side, bound, near }) = squares.pop() {
        if bound <= best.radius + accuracy {
            break;
        }
        // What is nearest to any place in the square is not farther from its middle than that.
        let reach = bound + HALF_DIAGONAL * side;
        let near: Rc<[Piece]> = match near {
            None => nearest.around(centre, reach).into(),
            Some(near) => near.iter().filter(|piece| piece.touches(centre, reach)).copied().collect(),
        };
        let side = 0.5 * side;
        for corner in [[-0.5, -0.5], [0.5, -0.5], [-0.5, 0.5], [0.5, 0.5]] {
            let centre = [0, 1].map(|axis| centre[axis] + corner[axis] * side);
            let room = nearest.room_among(&near, centre);
            take(centre, room, &mut best);
            let bound = room + HALF_DIAGONAL * side;
            squares.push(Square { centre, side, bound, near: Some(Rc::clone(&near)) });
        }
    }
    best
}
