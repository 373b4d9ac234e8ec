//! Looks at a field: cubic B-splines in label, y and z, and between two generations.

use super::EddyField;
use super::lattice::weights;
use super::tape::{BEFORE, NEEDED, REPEATED};
use crate::lanes::{Register, Singles};

/// The points around a place across, and their weights.
struct Across {
    /// Of the lines.
    y: [usize; NEEDED],
    /// Of the first point of each line.
    z: usize,
    /// Along y and z.
    weights: [[f32; NEEDED]; 2],
}

/// Sums over label and y of what lies around a place: for each of four samples, of three components at four points.
type Sums<S> = [<S as Register>::Singles; NEEDED];

impl EddyField {
    /// Fluctuation of a field of rms one, x, y and z [-].
    ///
    /// * `time` – for which the field has been made [s]
    /// * `at` – place: distance from the inlet, and y and z [m]
    #[inline(always)]
    pub(crate) fn fluctuation<S: Register>(&self, time: f64, [x, y, z]: [f64; 3]) -> [f64; 3] {
        let plan = &*self.plan;
        let across = self.across(y, z);
        let passage = plan.way.passage(x);
        let label = time - passage.travel;
        let last = self.tapes.len() - 1;
        let nothing = [S::Singles::zero(); NEEDED];
        if !plan.way.is_carried() || last == 0 {
            let generation = (passage.generation as usize).min(last);
            return total::<S>(self.add::<S>(nothing, generation, label, &across, 1.0), across.weights[1]);
        }
        let generation = (passage.generation as usize).min(last - 1);
        let share = (passage.generation - generation as f64).clamp(0.0, 1.0);
        let sums = self.add::<S>(nothing, generation, label, &across, (1.0 - share) as f32);
        let sums = self.add::<S>(sums, generation + 1, label, &across, share as f32);
        let value = total::<S>(sums, across.weights[1]);
        let both = 2.0 * share * (1.0 - share);
        let correlations = &plan.correlations[generation];
        [0, 1, 2].map(|i| value[i] / (1.0 - both * (1.0 - correlations[i])).sqrt())
    }

    #[inline(always)]
    fn across(&self, y: f64, z: f64) -> Across {
        let ([points_y, points_z], extent) = (self.plan.lattice.points, self.plan.lattice.extent);
        let (y, of_y) = around(y / extent.y, points_y);
        let (z, of_z) = around(z / extent.z, points_z);
        let mut lines = [y; NEEDED];
        for i in 1..NEEDED {
            lines[i] = if lines[i - 1] + 1 == points_y { 0 } else { lines[i - 1] + 1 };
        }
        Across { y: lines, z, weights: [of_y, of_z] }
    }

    /// Adds what lies around a place in a generation.
    #[inline(always)]
    fn add<S: Register>(
        &self,
        mut sums: Sums<S>,
        generation: usize,
        label: f64,
        across: &Across,
        share: f32,
    ) -> Sums<S> {
        let samples = label * self.plan.samples_per_time(generation);
        let floor = samples.floor();
        let of_label = weights((samples - floor) as f32).map(|weight| share * weight);
        let Some(block) = self.tapes[generation].around(floor as i64) else { return sums };
        let row = 3 * (self.plan.lattice.points[1] + REPEATED);
        let start = (floor as i64 - BEFORE - block.first) as usize * row + 3 * across.z;
        for (y, of_y) in across.y.into_iter().zip(across.weights[0]) {
            // All rows of a line at once, so that its end is looked at once.
            let Some(rows) = block.lines[y].get(start..start + (NEEDED - 1) * row + 3 * NEEDED) else {
                break;
            };
            for (m, sum) in sums.iter_mut().enumerate() {
                if let Some(points) = rows[m * row..].first_chunk() {
                    *sum = sum.add_weighted(points, of_y * of_label[m]);
                }
            }
        }
        sums
    }
}

/// The number of the first of four points around a place, and their weights.
///
/// * `turns` – place over the extent [-]
#[inline(always)]
fn around(turns: f64, points: usize) -> (usize, [f32; NEEDED]) {
    let place = (turns - turns.floor()) * points as f64;
    // Rounding may put a place behind the last point.
    let before = (place as usize).min(points - 1);
    (if before == 0 { points - 1 } else { before - 1 }, weights((place - before as f64) as f32))
}

/// The sum over the samples and the points.
#[inline(always)]
fn total<S: Register>(sums: Sums<S>, of_z: [f32; NEEDED]) -> [f64; 3] {
    let all = sums[0].add(sums[1]).add(sums[2].add(sums[3])).store();
    [0, 1, 2].map(|i| {
        let parts = [0, 1, 2, 3].map(|point| of_z[point] * all[3 * point + i]);
        f64::from((parts[0] + parts[1]) + (parts[2] + parts[3]))
    })
}
