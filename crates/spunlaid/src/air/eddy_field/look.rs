//! Looks at a field: cubic B-splines in label, y and z, and between two generations.

use super::EddyField;
use super::lattice::weights;
use super::tape::{BEFORE, NEEDED, REPEATED};

/// Numbers of a line around a place: four points of three components.
const NUMBERS: usize = 3 * NEEDED;

/// Which points lie around a place across, and their weights.
struct Across {
    /// Of the lines.
    y: [usize; NEEDED],
    /// Of the first point of each line.
    z: usize,
    weights: [[f32; NEEDED]; 2],
}

impl EddyField {
    /// Fluctuation of a field of rms one, x, y and z [-].
    ///
    /// * `time` – for which the field has been made [s]
    /// * `at` – place: distance from the inlet, and y and z [m]
    #[inline(always)]
    pub(crate) fn fluctuation(&self, time: f64, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let plan = &*self.plan;
        let across = self.across(y, z);
        let passage = plan.way.passage(x);
        let label = time - passage.travel;
        let last = self.tapes.len() - 1;
        if !plan.way.is_carried() || last == 0 {
            let generation = (passage.generation as usize).min(last);
            return self.sum(generation, label, &across, [0.0; NUMBERS], 1.0).1;
        }
        let generation = (passage.generation as usize).min(last - 1);
        let share = (passage.generation - generation as f64).clamp(0.0, 1.0);
        let (sums, _) = self.sum(generation, label, &across, [0.0; NUMBERS], (1.0 - share) as f32);
        let (_, value) = self.sum(generation + 1, label, &across, sums, share as f32);
        let both = 2.0 * share * (1.0 - share);
        let correlations = plan.correlations[generation];
        [0, 1, 2].map(|i| value[i] / (1.0 - both * (1.0 - correlations[i])).sqrt())
    }

    #[inline(always)]
    fn across(&self, y: f64, z: f64) -> Across {
        let lattice = &self.plan.lattice;
        let [per_y, per_z] = lattice.per_length();
        let place = |at: f64, points: usize| {
            let floor = at.floor();
            // Rounding must not put a place behind the last point.
            (((floor as i64 - BEFORE).rem_euclid(points as i64)) as usize, weights((at - floor) as f32))
        };
        let (first, of_y) = place(y * per_y, lattice.points[0]);
        let (z, of_z) = place(z * per_z, lattice.points[1]);
        let y = [0, 1, 2, 3].map(|i| (first + i) % lattice.points[0]);
        Across { y, z, weights: [of_y, of_z] }
    }

    /// Adds the samples of a generation around a place to sums over label and y; and the sums over z.
    #[inline(always)]
    fn sum(
        &self,
        generation: usize,
        label: f64,
        across: &Across,
        mut sums: [f32; NUMBERS],
        share: f32,
    ) -> ([f32; NUMBERS], [f64; 3]) {
        let samples = label * self.plan.samples_per_time(generation);
        let floor = samples.floor();
        let of_label = weights((samples - floor) as f32).map(|weight| share * weight);
        if let Some(block) = self.tapes[generation].around(floor as i64) {
            let sample = (floor as i64 - BEFORE - block.first) as usize;
            let row = 3 * (self.plan.lattice.points[1] + REPEATED);
            for (y, of_y) in across.y.into_iter().zip(across.weights[0]) {
                let line = &block.lines[y];
                for (m, of_label) in of_label.into_iter().enumerate() {
                    let weight = of_y * of_label;
                    let Some(points) = line[(sample + m) * row + 3 * across.z..].first_chunk::<NUMBERS>()
                    else {
                        break;
                    };
                    for (sum, point) in sums.iter_mut().zip(points) {
                        *sum += weight * point;
                    }
                }
            }
        }
        let of_z = across.weights[1];
        let value = [0, 1, 2].map(|i| {
            let parts = [0, 1, 2, 3].map(|point| of_z[point] * sums[3 * point + i]);
            f64::from((parts[0] + parts[1]) + (parts[2] + parts[3]))
        });
        (sums, value)
    }
}
