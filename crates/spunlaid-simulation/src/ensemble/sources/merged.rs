//! The sums of all replicates, and the sources that follow from them.

use super::watch::CellSums;
use super::{CellSource, Fitting, HeatSums, Sources};
use crate::ensemble::LostFibre;
use spunlaid_air::Hint;
use spunlaid_fibre::Case;
use spunlaid_ground::{Estimate, Vec3};
use std::collections::HashMap;

/// The sums of all replicates.
pub(super) struct Merged<'a> {
    fitting: &'a Fitting<'a>,
    cells: Vec<CellSource>,
    /// Of each cell that was met: sums of Su, Sp, Sh, its part per kelvin and the heat over replicates, and of their
    /// squares.
    sums: HashMap<u32, [[f64; 7]; 2]>,
    /// Of each replicate, per metre of width: force in the frame of the field, outside, and above the belt by drag
    /// and by momentum [N/m]; heat in the cells and outside [W/m]; temperature at the belt [K].
    of_replicates: [Vec<f64>; 9],
    lost: Vec<LostFibre>,
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
        let cells = (0..cells.count()).map(&mut cell).collect();
        let sums = HashMap::new();
        let of_replicates = Default::default();
        let lost = Vec::new();
        Self { fitting, cells, sums, of_replicates, lost }
    }

    /// How many replicates have been added.
    pub(super) fn replicates(&self) -> u64 {
        self.of_replicates[0].len() as u64
    }

    /// Counts a replicate that was lost.
    pub(super) fn lose(&mut self, fibre: LostFibre) {
        self.lost.push(fibre);
    }

    /// Adds a replicate.
    pub(super) fn add(&mut self, sums: &CellSums, filaments_per_metre: f64) {
        let per_instant = filaments_per_metre / sums.instants as f64;
        let mut met: Vec<_> = sums.cells.iter().collect();
        // In the same order whatever the map, so that the sums have the same bits.
        met.sort_unstable_by_key(|(cell, _)| **cell);
        let of_air = self.fitting.filament.as_ref().map_or(0.0, |filament| filament.of_air);
        let (mut force, mut heat_in_cells) = ([0.0; 3], 0.0);
        for (number, ([x, y, z, per_velocity, heat, per_kelvin], hits)) in met {
            let cell = &mut self.cells[*number as usize];
            let per_volume = per_instant * self.fitting.across[1] / cell.volume;
            let sp = -per_velocity * per_volume;
            let su = |i: usize, force: f64| force * per_volume - sp * cell.velocity[i];
            let heat_per_volume = heat * per_volume;
            let sh_per_kelvin = -per_kelvin * per_volume;
            let sh = heat_per_volume - sh_per_kelvin * of_air;
            let terms = [su(0, *x), su(1, *y), su(2, *z), sp, sh, sh_per_kelvin, heat_per_volume];
            let [sum, squares] = self.sums.entry(*number).or_default();
            for (i, term) in terms.into_iter().enumerate() {
                sum[i] += term;
                squares[i] += term * term;
            }
            heat_in_cells += heat * per_instant;
            cell.hits += hits;
            force.iter_mut().zip([x, y, z]).for_each(|(sum, term)| *sum += term * per_instant);
        }
        let [outside, heat_outside] = sums.outside.map(|sum| sum * per_instant);
        let above = sums.above_belt * per_instant;
        let by_momentum = sums.by_momentum * filaments_per_metre;
        let at_belt = sums.at_belt / sums.instants as f64;
        let [x, y, z] = force;
        self.of_replicates
            .iter_mut()
            .zip([x, y, z, outside, above, by_momentum, heat_in_cells, heat_outside, at_belt])
            .for_each(|(all, term)| all.push(term));
    }

    pub(super) fn finish(mut self, filaments_per_metre: f64) -> Sources {
        let replicates = self.replicates();
        let n = replicates as f64;
        for (number, [sum, squares]) in self.sums {
            let mean = sum.map(|sum| sum / n);
            let error = |i: usize| {
                let spread = squares[i] - sum[i] * mean[i];
                if n > 1.0 { (spread.max(0.0) / (n - 1.0) / n).sqrt() } else { f64::NAN }
            };
            let cell = &mut self.cells[number as usize];
            (cell.su, cell.su_error) = ([mean[0], mean[1], mean[2]], [error(0), error(1), error(2)]);
            (cell.sp, cell.sp_error) = (mean[3], error(3));
            (cell.sh, cell.sh_error) = (mean[4], error(4));
            (cell.sh_per_kelvin, cell.sh_per_kelvin_error) = (mean[5], error(5));
            (cell.heat, cell.heat_error) = (mean[6], error(6));
        }
        let [x, y, z, outside, above, by_momentum, heat, heat_outside, at_belt] = self.of_replicates;
        let along = self.fitting.placed.turned(Vec3::new(1.0, 0.0, 0.0));
        let share = |i: usize| x[i] * along.x + y[i] * along.y + z[i] * along.z;
        let heat = self.fitting.filament.as_ref().map_err(Clone::clone).map(|filament| HeatSums {
            in_cells: Estimate::new(heat),
            outside: Estimate::new(heat_outside),
            at_inlet: filament.at_start,
            at_belt: Estimate::new(at_belt),
            of_air: filament.of_air,
        });
        Sources {
            filaments_per_metre,
            replicates,
            lost: self.lost,
            cells: self.cells,
            heat,
            along: Estimate::new((0..x.len()).map(share).collect()),
            outside: Estimate::new(outside),
            above_belt: [above, by_momentum].map(Estimate::new),
            force: [x, y, z].map(Estimate::new),
        }
    }
}
