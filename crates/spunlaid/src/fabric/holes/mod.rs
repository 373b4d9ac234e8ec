//! Holes of the fabric, counted in windows in which the fibres are drawn with their true width.
//!
//! ```text
//! curves of a window → bitmap: covered or bare → regions: connected bare parts, the holes ┐
//!                    → nearest: the room about a place ──────────────────────────────────┴→ largest disc of each hole
//! windows and the map → carried: holes of any radius on the whole sheet
//! ```

mod bitmap;
mod carried;
mod largest;
mod nearest;
mod regions;

pub use carried::{FabricHoles, HolesOfRadius, LocalLength, RADII, carry, expected_holes};
pub use largest::Disc;

use bitmap::Bitmap;
use largest::largest_discs;
use nearest::Nearest;
use regions::Regions;

/// The least radius of a hole that is counted [m].
pub const LEAST_RADIUS: f64 = 20e-6;
/// Pixels across the thinnest fibre, and coarse ones across the least radius.
const ACROSS_FIBRE: f64 = 8.0;
const ACROSS_RADIUS: f64 = 2.0;

/// A straight piece of a fibre in a window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    /// Its ends, from the corner of the window [m].
    pub from: [f64; 2],
    /// See `from`.
    pub to: [f64; 2],
    /// Half of its width [m].
    pub half_width: f64,
}

impl Piece {
    fn length(&self) -> f64 {
        libm::hypot(self.to[0] - self.from[0], self.to[1] - self.from[1])
    }

    /// From another corner.
    fn moved(&self, by: f64) -> Self {
        let [from, to] = [self.from, self.to].map(|end| end.map(|at| at + by));
        Self { from, to, ..*self }
    }

    /// Along the piece; along x for one without length.
    fn direction(&self) -> [f64; 2] {
        let length = self.length();
        match length > 0.0 {
            true => [0, 1].map(|axis| (self.to[axis] - self.from[axis]) / length),
            false => [1.0, 0.0],
        }
    }

    /// The place at a share of its length.
    fn at(&self, share: f64) -> [f64; 2] {
        [0, 1].map(|axis| self.from[axis] + share * (self.to[axis] - self.from[axis]))
    }

    /// Distance of a place from its axis.
    #[inline]
    fn distance(&self, [x, y]: [f64; 2]) -> f64 {
        let (along_x, along_y) = (self.to[0] - self.from[0], self.to[1] - self.from[1]);
        let (from_x, from_y) = (x - self.from[0], y - self.from[1]);
        let squared = along_x * along_x + along_y * along_y;
        let share = (from_x * along_x + from_y * along_y) / squared;
        let share = if squared > 0.0 { share.clamp(0.0, 1.0) } else { 0.0 };
        let (off_x, off_y) = (from_x - share * along_x, from_y - share * along_y);
        (off_x * off_x + off_y * off_y).sqrt()
    }

    /// Whether a disc about a place touches it.
    #[inline]
    fn touches(&self, place: [f64; 2], radius: f64) -> bool {
        self.distance(place) - self.half_width <= radius
    }
}

/// What is counted in a window.
#[derive(Clone, Debug, PartialEq)]
pub struct WindowHoles {
    /// Area of the window without its margin [m²].
    pub area: f64,
    /// Share of it that no fibre covers.
    pub bare: f64,
    /// The largest disc of each hole in which it has its place within the window; only of holes into which a
    /// disc of [`LEAST_RADIUS`] fits.
    pub holes: Vec<Disc>,
}

/// Counts the holes of a window. A hole is a connected bare part, and its place is that of the largest disc
/// that fits into it: it counts if that lies in the window, so that none is counted in parts and none twice.
///
/// * `side` – of the window [m]
/// * `margin` – about it, in which fibres are drawn too [m]
pub fn count_holes(side: f64, margin: f64, pieces: &[Piece]) -> WindowHoles {
    let thinnest = pieces.iter().map(|piece| piece.half_width).fold(f64::INFINITY, f64::min);
    let coarse_pixel = LEAST_RADIUS / ACROSS_RADIUS;
    // The window is made of whole pixels.
    let across = (side / coarse_pixel.min(2.0 * thinnest / ACROSS_FIBRE)).ceil().max(1.0);
    let pixel = side / across;
    let beside = (margin / pixel).ceil();
    let (drawn, corner) = (across + 2.0 * beside, beside * pixel);
    let moved: Vec<Piece> = pieces.iter().map(|piece| piece.moved(corner)).collect();
    let fine = Bitmap::new(drawn as usize, pixel, &moved, 0.0);
    let room = LEAST_RADIUS - std::f64::consts::FRAC_1_SQRT_2 * coarse_pixel;
    let coarse = Bitmap::new((drawn * pixel / coarse_pixel).ceil() as usize, coarse_pixel, &moved, room);
    let nearest = Nearest::new(drawn * pixel, &moved, LEAST_RADIUS);
    let mut regions = Regions::new(&fine);
    let discs = largest_discs((&fine, &coarse), &mut regions, &nearest, LEAST_RADIUS);
    let from_window = |disc: Disc| Disc { centre: disc.centre.map(|at| at - corner), ..disc };
    let within = |disc: &Disc| disc.centre.iter().all(|at| (0.0..side).contains(at));
    WindowHoles {
        area: side * side,
        bare: fine.bare_within(beside as usize) as f64 / (across * across),
        holes: discs.into_iter().map(from_window).filter(within).collect(),
    }
}
