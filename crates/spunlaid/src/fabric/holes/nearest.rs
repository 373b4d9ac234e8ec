//! The distance to the nearest fibre.

use super::Piece;

/// Side of a square in which pieces are looked up, in shortest distances of interest.
const SQUARE: f64 = 2.0;

/// Pieces of fibres, looked up by place.
#[derive(Debug)]
pub(super) struct Nearest {
    /// Side of what has been drawn, beyond which nothing is known [m].
    side: f64,
    square: f64,
    /// Squares each way.
    squares: usize,
    /// First piece of each square in the list of pieces.
    first: Vec<u32>,
    pieces: Vec<Piece>,
    /// Largest half width of a fibre [m].
    widest: f64,
}

impl Nearest {
    /// * `distance` – shortest distance of interest [m]
    pub(super) fn new(side: f64, pieces: &[Piece], distance: f64) -> Self {
        let square = SQUARE * distance;
        let squares = (side / square).ceil().max(1.0) as usize;
        let widest = pieces.iter().map(|piece| piece.half_width).fold(0.0, f64::max);
        let at = |place: f64| ((place / square).max(0.0) as usize).min(squares - 1);
        // Of a long piece only the parts that are shorter than a square, so that each lies in few squares.
        let mut parts: Vec<(usize, Piece)> = Vec::new();
        for piece in pieces {
            let count = (piece.length() / square).ceil().max(1.0) as usize;
            for part in 0..count {
                let [from, to] = [part, part + 1].map(|i| piece.at(i as f64 / count as f64));
                let part = Piece { from, to, ..*piece };
                let [columns, rows] =
                    [0, 1].map(|axis| at(from[axis].min(to[axis]))..=at(from[axis].max(to[axis])));
                for row in rows {
                    parts.extend(columns.clone().map(|column| (row * squares + column, part)));
                }
            }
        }
        let mut first = vec![0u32; squares * squares + 1];
        parts.iter().for_each(|(square, _)| first[square + 1] += 1);
        for i in 1..first.len() {
            first[i] += first[i - 1];
        }
        let mut next = first.clone();
        let mut pieces = vec![Piece { from: [0.0; 2], to: [0.0; 2], half_width: 0.0 }; parts.len()];
        for (square, part) in parts {
            pieces[next[square] as usize] = part;
            next[square] += 1;
        }
        Self { side, square, squares, first, pieces, widest }
    }

    /// The pieces that a disc about a place touches, some of them twice.
    pub(super) fn around(&self, place: [f64; 2], radius: f64) -> Vec<Piece> {
        let reach = radius + self.widest;
        let last = self.squares - 1;
        let [columns, rows] = place.map(|at| {
            let number = |at: f64| ((at / self.square).max(0.0) as usize).min(last);
            number(at - reach)..=number(at + reach)
        });
        let squares = rows.flat_map(|row| columns.clone().map(move |column| row * self.squares + column));
        let pieces = squares.flat_map(|number| {
            let [first, last] = [number, number + 1].map(|i| self.first[i] as usize);
            &self.pieces[first..last]
        });
        pieces.filter(|piece| piece.touches(place, radius)).copied().collect()
    }

    /// [`Nearest::room`] where it is known which pieces may be nearest.
    pub(super) fn room_among(&self, pieces: &[Piece], place: [f64; 2]) -> f64 {
        let to_piece = |piece: &Piece| piece.distance(place) - piece.half_width;
        pieces.iter().map(to_piece).fold(self.to_edge(place), f64::min)
    }

    fn to_edge(&self, [x, y]: [f64; 2]) -> f64 {
        x.min(y).min(self.side - x).min(self.side - y)
    }

    /// Radius of the largest disc about a place that touches no fibre and stays within what has been drawn.
    pub(super) fn room(&self, place: [f64; 2]) -> f64 {
        let mut room = self.to_edge(place);
        let [column, row] = place.map(|at| ((at / self.square) as i64).clamp(0, self.squares as i64 - 1));
        let squares = self.squares as i64;
        for ring in 0..squares {
            // All that is nearer has been looked at.
            if (ring - 1) as f64 * self.square - self.widest >= room {
                break;
            }
            for other in (row - ring).max(0)..=(row + ring).min(squares - 1) {
                let is_edge = (other - row).abs() == ring;
                let step = if is_edge || ring == 0 { 1 } else { 2 * ring };
                let mut at = column - ring;
                while at <= column + ring {
                    if (0..squares).contains(&at) {
                        let number = (other * squares + at) as usize;
                        let [first, last] = [number, number + 1].map(|i| self.first[i] as usize);
                        for piece in &self.pieces[first..last] {
                            room = room.min(piece.distance(place) - piece.half_width);
                        }
                    }
                    at += step;
                }
            }
        }
        room
    }
}
