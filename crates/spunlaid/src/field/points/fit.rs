//! Least-squares gradients from the differences to the neighbours.

use crate::field::values::Quantities;

/// Least share of the neighbours that must lie in each direction.
const SPREAD: f64 = 0.01;
/// Share that is added to the diagonal, so that a gradient without neighbours in its direction is zero.
const RIDGE: f64 = 1e-13;

/// A weighted least-squares fit. The weight of a neighbour is its distance to the power −2, so that only its
/// direction counts.
#[derive(Clone, Copy)]
pub(super) struct Fit {
    /// Sum of products of directions.
    normal: [[f64; 3]; 3],
    /// Sum of products of a direction and the change per distance.
    right: [Quantities; 3],
    neighbours: f64,
}

impl Fit {
    /// * `plane` – axes along which nothing changes
    /// * `most` – largest number of neighbours that will be added
    pub(super) fn new(plane: [bool; 3], most: usize) -> Self {
        let mut normal = [[0.0; 3]; 3];
        for axis in (0..3).filter(|axis| plane[*axis]) {
            normal[axis][axis] = most as f64;
        }
        Self { normal, right: Default::default(), neighbours: 0.0 }
    }

    /// Adds a neighbour.
    ///
    /// * `to` – the vector to it [m]
    /// * `distance_2` – the square of its length [m²], above zero
    /// * `change` – of the values
    pub(super) fn add(&mut self, to: [f64; 3], distance_2: f64, change: Quantities) {
        for (axis, along) in to.into_iter().enumerate() {
            let along = along / distance_2;
            self.normal[axis].iter_mut().zip(to).for_each(|(sum, to)| *sum += along * to);
            self.right[axis].iter_mut().zip(change).for_each(|(sum, change)| *sum += along * change);
        }
        self.neighbours += 1.0;
    }

    /// Whether there are neighbours in all directions.
    pub(super) fn is_spread(&self) -> bool {
        let (normal, _) = self.eliminated();
        (0..3).all(|axis| normal[axis][axis] > SPREAD * self.neighbours)
    }

    /// Change of the values along x, y and z [per m].
    pub(super) fn gradients(mut self) -> [Quantities; 3] {
        let trace = self.normal[0][0] + self.normal[1][1] + self.normal[2][2];
        (0..3).for_each(|axis| self.normal[axis][axis] += RIDGE * trace);
        let (normal, mut gradients) = self.eliminated();
        for row in (0..3).rev() {
            for known in row + 1..3 {
                gradients[row] = less(gradients[row], normal[row][known], gradients[known]);
            }
            gradients[row] = gradients[row].map(|x| x / normal[row][row]);
        }
        gradients
    }

    /// With the entries below the diagonal eliminated.
    fn eliminated(&self) -> ([[f64; 3]; 3], [Quantities; 3]) {
        let (mut normal, mut right) = (self.normal, self.right);
        for pivot in 0..2 {
            for row in pivot + 1..3 {
                let factor = normal[row][pivot] / normal[pivot][pivot];
                normal[row] = less(normal[row], factor, normal[pivot]);
                right[row] = less(right[row], factor, right[pivot]);
            }
        }
        (normal, right)
    }
}

/// `row − factor · other`
fn less<const N: usize>(mut row: [f64; N], factor: f64, other: [f64; N]) -> [f64; N] {
    row.iter_mut().zip(other).for_each(|(entry, other)| *entry -= factor * other);
    row
}
