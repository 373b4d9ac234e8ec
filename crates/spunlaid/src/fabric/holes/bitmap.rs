//! Fibres of a window, drawn with their true width.

use super::Piece;

/// Pixels of a window, each covered by a fibre or bare: it is covered if its centre lies on a fibre.
#[derive(Debug)]
pub(super) struct Bitmap {
    /// Pixels each way.
    pub(super) side: usize,
    /// Side of a pixel [m].
    pub(super) pixel: f64,
    words: Vec<u64>,
}

const BITS: usize = 64;

impl Bitmap {
    /// Draws pieces of fibres.
    ///
    /// * `wider` – by how much the fibres are drawn wider to either side [m]
    pub(super) fn new(side: usize, pixel: f64, pieces: &[Piece], wider: f64) -> Self {
        let words = vec![0; side * side.div_ceil(BITS)];
        let mut bitmap = Self { side, pixel, words };
        for piece in pieces {
            bitmap.draw(piece, piece.half_width + wider);
        }
        bitmap
    }

    fn draw(&mut self, piece: &Piece, half: f64) {
        if half <= 0.0 {
            return;
        }
        let [x, y] = piece.from;
        let [along_x, along_y] = piece.direction();
        let ends = [y, piece.to[1]];
        let [low, high] = [ends[0].min(ends[1]) - half, ends[0].max(ends[1]) + half];
        for row in self.pixels(low, high) {
            let at = (row as f64 + 0.5) * self.pixel;
            // The edge of the outline on one side: on the straight part, or on the round one at an end.
            let edge = |sign: f64| {
                let (normal_y, foot);
                if along_y.abs() > 1e-9 {
                    normal_y = -sign * along_x * along_y.signum();
                    foot = (at - half * normal_y - y) / along_y;
                } else {
                    foot = if sign * along_x > 0.0 { f64::INFINITY } else { f64::NEG_INFINITY };
                }
                let foot = foot.clamp(0.0, piece.length());
                let beside = half * half - (at - y - foot * along_y).powi(2);
                x + foot * along_x + sign * beside.max(0.0).sqrt()
            };
            let pixels = self.pixels(edge(-1.0), edge(1.0));
            self.cover(row, pixels);
        }
    }

    /// The pixels whose centres lie between two places.
    fn pixels(&self, from: f64, to: f64) -> std::ops::Range<usize> {
        let within = |at: f64| at.clamp(0.0, self.side as f64) as usize;
        within((from / self.pixel + 0.5).floor())..within((to / self.pixel + 0.5).floor())
    }

    fn cover(&mut self, row: usize, pixels: std::ops::Range<usize>) {
        if pixels.is_empty() {
            return;
        }
        let words = &mut self.words[row * self.side.div_ceil(BITS)..];
        let (first, last) = (pixels.start / BITS, (pixels.end - 1) / BITS);
        let (from, to) =
            (u64::MAX << (pixels.start % BITS), u64::MAX >> (BITS - 1 - (pixels.end - 1) % BITS));
        if first == last {
            words[first] |= from & to;
        } else {
            words[first] |= from;
            words[first + 1..last].fill(u64::MAX);
            words[last] |= to;
        }
    }

    /// Passes on the runs of bare pixels of a row.
    pub(super) fn bare_runs(&self, row: usize, mut take: impl FnMut(std::ops::Range<usize>)) {
        let words = self.side.div_ceil(BITS);
        let row = &self.words[row * words..][..words];
        // The first pixel from one on that is covered, or that is bare.
        let next = |from: usize, is_bare: bool| {
            let flip = if is_bare { u64::MAX } else { 0 };
            let mut number = from / BITS;
            let mut word = row.get(number).map_or(0, |word| (word ^ flip) & u64::MAX << (from % BITS));
            while word == 0 {
                number += 1;
                match row.get(number) {
                    Some(next) => word = next ^ flip,
                    None => return self.side,
                }
            }
            (number * BITS + word.trailing_zeros() as usize).min(self.side)
        };
        let mut at = next(0, true);
        while at < self.side {
            let end = next(at, false);
            take(at..end);
            at = next(end, true);
        }
    }

    /// Number of bare pixels in a square in the middle.
    ///
    /// * `margin` – of the bitmap beside the square [pixels]
    pub(super) fn bare_within(&self, margin: usize) -> u64 {
        let inner = margin..self.side - margin;
        let mut bare = 0;
        for row in inner.clone() {
            self.bare_runs(row, |run| {
                bare += run.end.min(inner.end).saturating_sub(run.start.max(inner.start)) as u64;
            });
        }
        bare
    }
}
