//! The sums of all replicates, and the sources that follow from them.

use super::fitting::Fitting;
use super::watch::CellSums;
use super::{CellSource, Sources};
use crate::case::Case;
use crate::field::Hint;
use crate::statistics::Estimate;
use crate::vec3::Vec3;
use std::collections::HashMap;

/// The sums of all replicates.
pub(super) struct Merged<'a> {
    fitting: &'a Fitting<'a>,
    cells: Vec<CellSource>,
    /// Of each cell that was met: sums of Su and Sp over replicates, and of their squares.
    sums: HashMap<u32, [[f64; 4]; 2]>,
    /// Of each replicate, per metre of width: force in the frame of the field, outside, and above the belt by drag and by momentum
    /// [N/m].
    forces: [Vec<f64>; 6],
}

impl<'a> Merged<'a> {
    pub(super) fn new(case: &Case, fitting: &'a Fitting<'a>) -> Self {
        let (cells, unit) = (&fitting.cells, fitting.placed.unit);
        let mut hint = Hint::default();
        let of_case = case.air.speed_factor;
        let mut cell = |cell: usize| {
            let Vec3 { x, y, z } =
                fitting.placed.field.sample(cells.centre(cell), &mut hint).velocity * of_case;
            CellSource {
                velocity: [x, y, z],
                volume: cells.volume(cell) * unit.powi(3),
                ..CellSource::default()
            }
        };
        let cells = (0..cells.len()).map(&mut cell).collect();
        Self { fitting, cells, sums: HashMap::new(), forces: Default::default() }
    }

    /// Adds a replicate.
    pub(super) fn add(&mut self, sums: &CellSums, filaments_per_metre: f64) {
        let per_instant = filaments_per_metre / sums.instants as f64;
        let mut met: Vec<_> = sums.cells.iter().collect();
        // In the same order whatever the map, so that the sums have the same bits.
        met.sort_unstable_by_key(|(cell, _)| **cell);
        let mut force = [0.0; 3];
        for (number, ([x, y, z, per_velocity], hits)) in met {
            let cell = &mut self.cells[*number as usize];
            let per_volume = per_instant * self.fitting.across[1] / cell.volume;
            let sp = -per_velocity * per_volume;
            let su = |i: usize, force: f64| force * per_volume - sp * cell.velocity[i];
            let terms = [su(0, *x), su(1, *y), su(2, *z), sp];
            let [sum, squares] = self.sums.entry(*number).or_default();
            for i in 0..4 {
                sum[i] += terms[i];
                squares[i] += terms[i] * terms[i];
            }
            cell.hits += hits;
            force.iter_mut().zip([x, y, z]).for_each(|(sum, term)| *sum += term * per_instant);
        }
        let [outside, above] = [sums.outside, sums.above_belt].map(|sum| sum * per_instant);
        let by_momentum = sums.by_momentum * filaments_per_metre;
        let [x, y, z] = force;
        self.forces
            .iter_mut()
            .zip([x, y, z, outside, above, by_momentum])
            .for_each(|(all, term)| all.push(term));
    }

    pub(super) fn finish(mut self, filaments_per_metre: f64) -> Sources {
        let n = self.forces[0].len() as f64;
        for (number, [sum, squares]) in self.sums {
            let mean = sum.map(|sum| sum / n);
            let error = |i: usize| {
                let spread = squares[i] - sum[i] * mean[i];
                if n > 1.0 { (spread.max(0.0) / (n - 1.0) / n).sqrt() } else { f64::NAN }
            };
            let cell = &mut self.cells[number as usize];
            (cell.su, cell.su_error) = ([mean[0], mean[1], mean[2]], [error(0), error(1), error(2)]);
            (cell.sp, cell.sp_error) = (mean[3], error(3));
        }
        let [x, y, z, outside, above, by_momentum] = self.forces;
        let along = self.fitting.placed.turned(Vec3::new(1.0, 0.0, 0.0));
        let share = |i: usize| x[i] * along.x + y[i] * along.y + z[i] * along.z;
        Sources {
            filaments_per_metre,
            replicates: n as u64,
            cells: self.cells,
            along: Estimate::new((0..x.len()).map(share).collect()),
            outside: Estimate::new(outside),
            above_belt: [above, by_momentum].map(Estimate::new),
            force: [x, y, z].map(Estimate::new),
        }
    }
}
