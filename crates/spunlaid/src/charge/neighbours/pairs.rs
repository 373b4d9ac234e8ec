//! The mean force of each two nodes that are near each other.

use super::cells::Cells;
use super::repulsion::{MovingNode, Repulsion};
use crate::charge::PERMITTIVITY;
use crate::lanes::{Isa, Lanes, Register, Task, WIDTH, Wide};
use crate::threads::each;
use std::f64::consts::PI;
use std::ops::Range;

/// Largest half way of two nodes against each other, in their distance, for which three terms of a series are
/// the mean force, within 0.3 %.
const SLOW: f64 = 0.5;

impl Repulsion {
    /// The mean forces on all nodes while they go their ways [N], in machine and in cross direction. They do not
    /// depend on the instruction set or the number of threads.
    pub(crate) fn forces(&self, nodes: &[MovingNode], (isa, threads): (Isa, usize)) -> Vec<[f64; 2]> {
        let mut forces = vec![[0.0; 2]; nodes.len()];
        let cells = Cells::new(self, nodes);
        let found = each(threads, cells.heights(), |height| self.forces_at(&cells, height, isa));
        for (number, force) in cells.numbers().iter().zip(found.into_iter().flatten()) {
            forces[*number] = force;
        }
        forces
    }

    /// The forces on the nodes of one height of cells.
    fn forces_at(&self, cells: &Cells, height: usize, isa: Isa) -> Vec<[f64; 2]> {
        let mut forces = Vec::new();
        cells.each_at(height, |own, others| {
            isa.run(OfOthers { of: self, cells, own, others, forces: &mut forces });
        });
        forces
    }
}

/// The mean forces of other nodes on some nodes [N].
///
/// Each operation has the same bits, or the same bits with the other sign, if two nodes change places: so what
/// they do to each other is equal and opposite.
struct OfOthers<'a> {
    of: &'a Repulsion,
    cells: &'a Cells,
    own: Range<usize>,
    others: &'a [Range<usize>],
    forces: &'a mut Vec<[f64; 2]>,
}

impl Task for OfOthers<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        let Self { of, cells, own, others, forces } = self;
        // Closures would not be compiled for the registers.
        for node in own {
            forces.push(of.force_on::<S>(node, cells, others));
        }
    }
}

impl Repulsion {
    #[inline(always)]
    fn force_on<S: Register>(&self, node: usize, cells: &Cells, others: &[Range<usize>]) -> [f64; 2] {
        let splat = Wide::<S>::splat;
        let zero = Wide::zero();
        let [filament, own_x, own_y, own_z, own_way_y, own_way_z] = cells.one_of::<S>(node);
        let (per_height, reach_squared) = (splat(1.0 / self.height), splat(self.reach * self.reach));
        let background = splat(1.0 / (self.reach * self.reach));
        let least_squared = splat(self.least * self.least);
        let half = splat(self.width.map_or(f64::INFINITY, |width| 0.5 * width));
        let width = splat(self.width.unwrap_or(0.0));
        let numbers = Wide::<S>::load(&Lanes::from_fn(|lane| lane as f64));
        let mut sums = [zero; 2];
        let mut passing = [0.0; 2];
        for range in others {
            let mut first = range.start;
            while first < range.end {
                let [filaments, x, y, z, way_y, way_z] = cells.eight_from::<S>(first);
                let apart = (own_x - x).abs();
                let (y, z) = (own_y - y, own_z - z);
                let z = Wide::select_less(half, z, z - width, Wide::select_less(z, -half, z + width, z));
                let squared = y.mul_add(y, z * z);
                let share = (splat(1.0) - apart * per_height).max(zero);
                let share = Wide::select_less(squared, reach_squared, share, zero);
                let share = Wide::select_less((filament - filaments).abs(), splat(0.5), zero, share);
                let share = Wide::select_less(numbers, splat((range.end - first) as f64), share, zero);
                let ways = [own_way_y - way_y, own_way_z - way_z];
                let way_squared = ways[0].mul_add(ways[0], ways[1] * ways[1]);
                let slow = splat(SLOW * SLOW) * squared;
                let of_passing = Wide::select_less(slow, way_squared, share, zero);
                let inverse = splat(1.0).over(squared.max(least_squared));
                // The half way over the distance as complex numbers, its square, and the series.
                let part = ways[0].mul_add(y, ways[1] * z) * inverse;
                let turn = (ways[1] * y - ways[0] * z) * inverse;
                let (two, third, fifth) = (splat(2.0), splat(1.0 / 3.0), splat(0.2));
                let (part, turn) = (part.mul_add(part, -(turn * turn)), two * part * turn);
                let grown = (part.mul_add(part, -(turn * turn))).mul_add(fifth, part * third) + splat(1.0);
                let turned = (two * part * turn).mul_add(fifth, turn * third);
                let of_slow = share - of_passing;
                let force_y = grown.mul_add(y, turned * z) * inverse - background * y;
                let force_z = grown.mul_add(z, -(turned * y)) * inverse - background * z;
                sums[0] = of_slow.mul_add(force_y, sums[0]);
                sums[1] = of_slow.mul_add(force_z, sums[1]);
                if of_passing.any_above(0.0) {
                    let ways = [ways[0].store(), ways[1].store()];
                    self.add_passing(&of_passing.store(), [y.store(), z.store()], ways, &mut passing);
                }
                first += WIDTH;
            }
        }
        let strength = self.charge * self.charge / (2.0 * PI * PERMITTIVITY * self.height);
        let sums = [sums[0].store(), sums[1].store()].map(|sum| sum.0.iter().sum::<f64>());
        [0, 1].map(|axis| strength * (sums[axis] + passing[axis]))
    }

    /// Adds the mean forces of nodes that pass by, over the strength of a pair.
    #[inline(never)]
    fn add_passing(&self, share: &Lanes, at: [Lanes; 2], half_ways: [Lanes; 2], sums: &mut [f64; 2]) {
        let background = 1.0 / (self.reach * self.reach);
        for lane in (0..WIDTH).filter(|lane| share.0[*lane] > 0.0) {
            let at = at.map(|at| at.0[lane]);
            let mean = mean_on_a_way(at, half_ways.map(|way| way.0[lane]), self.least);
            for axis in [0, 1] {
                sums[axis] += share.0[lane] * (mean[axis] - background * at[axis]);
            }
        }
    }
}

/// The mean of `r/r²` over a straight way with its middle at `[y, z]`: the force of a thread, as a complex number
/// `1/ζ`, whose integral is a logarithm.                                                      theory.md (83n)
pub(super) fn mean_on_a_way([y, z]: [f64; 2], half_way: [f64; 2], least: f64) -> [f64; 2] {
    let from = [y - half_way[0], z - half_way[1]];
    let to = [y + half_way[0], z + half_way[1]];
    let bounded = |[y, z]: [f64; 2]| (y * y + z * z).max(least * least);
    let grown = 0.5 * libm::log(bounded(to) / bounded(from));
    let turned = libm::atan2(to[1] * from[0] - to[0] * from[1], to[0] * from[0] + to[1] * from[1]);
    let way = [2.0 * half_way[0], 2.0 * half_way[1]];
    let squared = way[0] * way[0] + way[1] * way[1];
    // The complex conjugate of (grown + i turned) / way.
    [(grown * way[0] + turned * way[1]) / squared, (grown * way[1] - turned * way[0]) / squared]
}
