//! What chance alone makes of a web: straight fibres of the same mass, thrown at random.

use super::{DepositionGrid, Edges, Map, Sheet, Web};
use spunlaid_ground::random::{stream, uniform};
use spunlaid_ground::{Fault, Isa, WIDTH};
use std::f64::consts::PI;

/// Length of a fibre: long beside any patch, so that its CV is that of endless ones but for a hundredth [m].
const LENGTH: f64 = 0.25;
/// Length of a piece: as many are drawn at once as there are lanes [m].
const PIECE: f64 = LENGTH / WIDTH as f64;
/// Of all random numbers of a web, those of its straight fibres.
const STRAIGHT: u64 = 0x5354_5241_4947_4854;

impl Web {
    /// A piece of a web of the same layers whose fibres are straight, point in all directions and lie at random. It
    /// goes on at all of its edges, and its CV is that of [`straight_fibres`](super::straight_fibres).
    ///
    /// * `size` – its columns and rows of cells
    /// * `cell` – side of a cell [m]
    ///
    /// # Errors
    /// If the cells are too large for the fibre that they would hold.
    pub fn at_random(&self, size: [usize; 2], cell: f64) -> Result<Map, Fault> {
        let sides = size.map(|cells| cells as f64 * cell);
        let [width, length] = sides;
        let sheet = Sheet { width, length, cell, patches: Vec::new(), edges: Edges::Periodic };
        let pieces: Vec<f64> = self.layers.iter().map(|layer| layer.linear_density * PIECE).collect();
        let mut canvas = DepositionGrid::new(&sheet, &pieces, self.basis_weight())?.ring(Isa::detect());
        for (number, (layer, piece)) in (0..).zip(self.layers.iter().zip(pieces)) {
            let mut random = stream([self.seed, STRAIGHT, number, 0]);
            let quanta = canvas.quanta(piece);
            let fibre = layer.linear_density * LENGTH;
            let count = (layer.basis_weight(&self.sheet) * width * length / fibre).round() as u64;
            for _ in 0..count {
                let from = sides.map(|side| side * uniform(&mut random));
                let (sin, cos) = libm::sincos(PI * uniform(&mut random));
                let point = |i: usize| [from[0] + PIECE * cos * i as f64, from[1] + PIECE * sin * i as f64];
                canvas.draw_alone(&std::array::from_fn::<_, { WIDTH + 1 }, _>(point), PIECE, quanta);
            }
        }
        Ok(canvas.finish()?.map)
    }
}
