//! What neighbours do to each other: the force between nodes of different filaments that are near each other,
//! which the sheets, a mean over the width, do not know.
//!
//! ```text
//! nodes and their ways in a block → cells of the height and the plane → for each node all others within the reach
//!       → the mean force during the block, equal and opposite for the two nodes of a pair
//! ```
//!
//! A node is a part of a thread that reaches an element up and down. Within the reach the force is `1/r − r/r_c²`;
//! what this is in the mean over the width is taken off the sheets.                theory.md (83m) to (83p)

use super::PERMITTIVITY;
use crate::lanes::{Isa, Lanes, Register, Task, WIDTH, Wide};
use crate::threads::each;
use std::f64::consts::PI;
use std::ops::Range;

/// Largest half way of two nodes against each other, in their distance, for which three terms of a series are
/// the mean force, within 0.3 %.
const SLOW: f64 = 0.5;
/// Fewest cells across a width that is closed to a ring. In fewer of them a node would be met twice.
const FEWEST: usize = 3;
/// Most cells along the machine direction.
const MOST: usize = 1024;

/// Numbers that are kept of each node.
const COLUMNS: usize = 6;

/// A node of a charged filament while a force is held.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MovingNode {
    /// Number of its filament.
    pub(crate) filament: usize,
    /// Place in the middle of the time [m]: below the inlet, in machine and in cross direction.
    pub(crate) at: [f64; 3],
    /// Half of its way in machine and in cross direction during this time [m].
    pub(crate) half_way: [f64; 2],
}

/// The forces between neighbours.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Repulsion {
    /// Charge of a node [C].
    pub(crate) charge: f64,
    /// Distance `r_c` in the horizontal plane beyond which there is no force [m].
    pub(crate) reach: f64,
    /// How far a node reaches up and down as a part of a thread, a whole number of elements [m].
    pub(crate) height: f64,
    /// Distance within which the force grows no more, the diameter of the filaments [m].
    pub(crate) least: f64,
    /// Distance from inlet to belt; there are no forces outside [m].
    pub(crate) distance: f64,
    /// Width after which the filaments repeat themselves, if they do [m].
    pub(crate) width: Option<f64>,
}

/// Nodes in the order of their cells.
struct Cells {
    counts: [usize; 3],
    /// The first node of each cell, and the end of the last one.
    starts: Vec<usize>,
    /// Filament, place and half way of each node, and of some that are far away behind the last one.
    columns: [Vec<f64>; COLUMNS],
    /// Where each of them was before.
    numbers: Vec<usize>,
}

impl Repulsion {
    /// The mean forces on all nodes while they go their ways [N], in machine and in cross direction. They do not
    /// depend on the instruction set or the number of threads.
    pub(crate) fn forces(&self, nodes: &[MovingNode], (isa, threads): (Isa, usize)) -> Vec<[f64; 2]> {
        let mut forces = vec![[0.0; 2]; nodes.len()];
        let cells = self.cells(nodes);
        let found = each(threads, cells.counts[0], |height| self.forces_at(&cells, height, isa));
        for (number, force) in cells.numbers.iter().zip(found.into_iter().flatten()) {
            forces[*number] = force;
        }
        forces
    }

    fn cells(&self, nodes: &[MovingNode]) -> Cells {
        let counts = |node: &MovingNode| {
            (0.0..self.distance).contains(&node.at[0]) && node.at.iter().all(|at| at.is_finite())
        };
        let inside = || nodes.iter().enumerate().filter(|(_, node)| counts(node));
        let across = |node: &MovingNode| match self.width {
            Some(width) => node.at[2].rem_euclid(width),
            None => node.at[2],
        };
        let range = |of: &dyn Fn(&MovingNode) -> f64| {
            let all = inside().map(|(_, node)| of(node));
            all.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), at| (least.min(at), most.max(at)))
        };
        let (back, front) = range(&|node| node.at[1]);
        let (left, right) = self.width.map_or_else(|| range(&across), |width| (0.0, width));
        let cells_of = |size: f64, cell: f64| ((size / cell) as usize).clamp(1, MOST);
        let heights = ((self.distance / self.height) as usize).max(1);
        let mut counts = [heights, cells_of(front - back, self.reach), cells_of(right - left, self.reach)];
        if self.width.is_some() && counts[2] < FEWEST {
            counts[2] = 1;
        }
        let cell = |place: f64, (from, to): (f64, f64), count: usize| {
            let cell = (place - from) / (to - from) * count as f64;
            // All at one place are in the first cell.
            if cell > 0.0 { (cell as usize).min(count - 1) } else { 0 }
        };
        let cell_of = |node: &MovingNode| {
            let height = cell(node.at[0], (0.0, self.distance), counts[0]);
            let along = cell(node.at[1], (back, front), counts[1]);
            (height * counts[1] + along) * counts[2] + cell(across(node), (left, right), counts[2])
        };
        let mut starts = vec![0; counts.iter().product::<usize>() + 1];
        inside().for_each(|(_, node)| starts[cell_of(node) + 1] += 1);
        for cell in 1..starts.len() {
            starts[cell] += starts[cell - 1];
        }
        let mut next = starts.clone();
        let count = starts.last().copied().unwrap_or(0);
        let mut numbers = vec![0; count];
        for (number, node) in inside() {
            let place = &mut next[cell_of(node)];
            numbers[*place] = number;
            *place += 1;
        }
        let mut columns = [const { Vec::new() }; COLUMNS];
        for number in &numbers {
            let node = &nodes[*number];
            let ([x, y, _], [way_y, way_z]) = (node.at, node.half_way);
            let values = [node.filament as f64, x, y, across(node), way_y, way_z];
            columns.iter_mut().zip(values).for_each(|(column, value)| column.push(value));
        }
        // Eight nodes are looked at together.
        columns.iter_mut().for_each(|column| column.resize(count + WIDTH, 0.0));
        Cells { counts, starts, columns, numbers }
    }

    /// The forces on the nodes of one height of cells.
    fn forces_at(&self, cells: &Cells, height: usize, isa: Isa) -> Vec<[f64; 2]> {
        let [heights, along, across] = cells.counts;
        let around = |cell: usize, count: usize| cell.saturating_sub(1)..(cell + 2).min(count);
        let (mut forces, mut others) = (Vec::new(), Vec::new());
        for row in 0..along {
            for column in 0..across {
                let own = cells.nodes_in((height * along + row) * across, column..column + 1);
                if own.is_empty() {
                    continue;
                }
                others.clear();
                for height in around(height, heights) {
                    for row in around(row, along) {
                        let start = (height * along + row) * across;
                        others.push(cells.nodes_in(start, around(column, across)));
                        // The last cell of a ring stands beside the first one.
                        let beyond = match column {
                            _ if self.width.is_none() || across < FEWEST => continue,
                            0 => across - 1,
                            column if column + 1 == across => 0,
                            _ => continue,
                        };
                        others.push(cells.nodes_in(start, beyond..beyond + 1));
                    }
                }
                isa.run(OfOthers { of: self, cells, own, others: &others, forces: &mut forces });
            }
        }
        forces
    }

    /// The part of the field of a sheet, at a distance from it along the machine direction, which is in the
    /// forces of its filaments as neighbours, from 0 to 1.                                  theory.md (83o)
    pub(super) fn share_of_sheet(reach: f64, distance: f64) -> f64 {
        let half_chord = (reach * reach - distance * distance).max(0.0).sqrt();
        let mean = libm::atan2(half_chord, distance) - half_chord * distance / (reach * reach);
        2.0 / PI * mean
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

impl Cells {
    /// The nodes of some cells across.
    fn nodes_in(&self, start: usize, cells: Range<usize>) -> Range<usize> {
        self.starts[start + cells.start]..self.starts[start + cells.end]
    }

    /// The columns of a node.
    #[inline(always)]
    fn one_of<S: Register>(&self, node: usize) -> [Wide<S>; COLUMNS] {
        let mut values = [Wide::zero(); COLUMNS];
        for (value, column) in values.iter_mut().zip(&self.columns) {
            *value = Wide::splat(column[node]);
        }
        values
    }

    /// The columns of eight nodes.
    #[inline(always)]
    fn eight_from<S: Register>(&self, first: usize) -> [Wide<S>; COLUMNS] {
        let mut values = [Wide::zero(); COLUMNS];
        for (value, column) in values.iter_mut().zip(&self.columns) {
            if let Some(eight) = column[first..].first_chunk::<WIDTH>() {
                *value = Wide::load(&Lanes(*eight));
            }
        }
        values
    }
}

/// The mean of `r/r²` over a straight way with its middle at `[y, z]`: the force of a thread, as a complex number
/// `1/ζ`, whose integral is a logarithm.                                                      theory.md (83n)
fn mean_on_a_way([y, z]: [f64; 2], half_way: [f64; 2], least: f64) -> [f64; 2] {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::charge::{Charge, ChargedNode, Curtain, Sheets};

    const ELEMENT: f64 = 2e-3;
    const DISTANCE: f64 = 64e-3;
    const OPEN: Repulsion = Repulsion {
        charge: 1e-12,
        reach: 8e-3,
        height: ELEMENT,
        least: 18e-6,
        distance: DISTANCE,
        width: None,
    };

    fn by(threads: usize) -> (Isa, usize) {
        (Isa::detect(), threads)
    }

    /// A straight thread, whose nodes are as far from the inlet as the others and `off` more.
    fn thread(filament: usize, [y, z]: [f64; 2], off: f64) -> impl Iterator<Item = MovingNode> {
        let nodes = (DISTANCE / ELEMENT) as usize;
        let at = move |j: usize| [(j as f64 + 0.25) * ELEMENT + off, y, z];
        (0..nodes).map(move |j| MovingNode { filament, at: at(j), half_way: [0.0; 2] })
    }

    /// Numbers from 0 to 1 that look like chance.
    fn chance(i: usize, of: f64) -> f64 {
        (i as f64 * of + 0.5).fract()
    }

    /// Filaments at places and with ways of chance, 20 mm wide and deep.
    fn crowd() -> Vec<MovingNode> {
        let node = |i: usize| MovingNode {
            filament: i % 50,
            at: [
                DISTANCE * chance(i, 0.618_033_988_75),
                20e-3 * chance(i, 0.754_877_666_25),
                20e-3 * chance(i, 0.569_840_290_99),
            ],
            half_way: [chance(i, 0.819_172_513_4), chance(i, 0.671_043_606_7)]
                .map(|share| 1e-3 * (share - 0.5)),
        };
        (0..5000).map(node).collect()
    }

    #[test]
    fn analytic_two_parallel_threads() {
        for (height, off, distance) in [(1.0, 0.0, 1e-3), (1.0, 0.7e-3, 2e-3), (3.0, 1.1e-3, 5e-3)] {
            let place = [0.6 * distance, -0.8 * distance];
            let nodes: Vec<MovingNode> = thread(0, [0.0; 2], 0.0).chain(thread(1, place, off)).collect();
            let of = Repulsion { height: height * ELEMENT, ..OPEN };
            let forces = of.forces(&nodes, by(1));
            let line = OPEN.charge / ELEMENT;
            let exact = line * line * ELEMENT / (2.0 * PI * PERMITTIVITY)
                * (1.0 / distance - distance / (OPEN.reach * OPEN.reach));
            let node = 16;
            let [y, z] = forces[node].map(|force| force / exact);
            assert!((y + 0.6).abs() < 1e-6 && (z - 0.8).abs() < 1e-6, "{height}: {y} {z}");
            // Beyond the reach there is none, nor from its own filament.
            let far: Vec<MovingNode> = thread(0, [0.0; 2], 0.0)
                .chain(thread(0, place, off))
                .chain(thread(1, [-8.1e-3, 0.0], 0.0))
                .collect();
            assert!(of.forces(&far, by(1)).iter().all(|force| *force == [0.0; 2]));
        }
    }

    #[test]
    fn invariant_forces_of_neighbours_add_up_to_nothing() {
        for width in [None, Some(20e-3), Some(17e-3)] {
            let of = Repulsion { width, ..OPEN };
            let nodes = crowd();
            let forces = of.forces(&nodes, by(2));
            for axis in [0, 1] {
                let sum: f64 = forces.iter().map(|force| force[axis]).sum();
                let all: f64 = forces.iter().map(|force| force[axis].abs()).sum();
                assert!(all > 0.0 && sum.abs() < 1e-13 * all, "{sum:e} {all:e}");
            }
            // A pair alone to the last bit, wherever it is on the ring.
            for pair in nodes.chunks_exact(2) {
                let [one, other] =
                    [0, 1].map(|i| MovingNode { at: [0.03, pair[i].at[1], pair[i].at[2]], ..pair[i] });
                let forces = of.forces(&[one, other], by(1));
                assert_eq!(forces[0], forces[1].map(|force| -force));
            }
        }
    }

    /// Cells find all neighbours: as when all nodes are looked at.
    #[test]
    fn invariant_cells_leave_no_neighbour_out() {
        for width in [None, Some(20e-3), Some(50e-3)] {
            let of = Repulsion { width, reach: 3e-3, ..OPEN };
            let nodes = crowd();
            for (node, force) in nodes.iter().zip(of.forces(&nodes, by(1))).step_by(1000) {
                let mut sum = [0.0; 2];
                for other in &nodes {
                    let pair = of.forces(&[*node, *other], by(1))[0];
                    (0..2).for_each(|axis| sum[axis] += pair[axis]);
                }
                for axis in [0, 1] {
                    let exact = sum[axis];
                    assert!((force[axis] - exact).abs() <= 1e-9 * exact.abs(), "{force:?} {exact:e}");
                }
            }
        }
    }

    #[test]
    fn identical_forces_of_neighbours_on_any_threads_and_registers() {
        let nodes = crowd();
        let of = Repulsion { width: Some(20e-3), ..OPEN };
        let one = of.forces(&nodes, by(1));
        for isa in Isa::available() {
            assert!((1..4).all(|threads| of.forces(&nodes, (isa, threads)) == one), "{isa:?}");
        }
    }

    /// The mean on a straight way is that of many places of it, near by and far.
    #[test]
    fn analytic_the_mean_force_on_a_way() {
        let half_way = [0.3e-3, 0.4e-3];
        for place in [[0.1e-3, -0.05e-3], [0.5e-3, 0.2e-3], [-2e-3, 1e-3]] {
            let found = mean_on_a_way(place, half_way, 0.0);
            let places = 100_000;
            let mut sum = [0.0; 2];
            for i in 0..places {
                let part = 2.0 * (i as f64 + 0.5) / f64::from(places) - 1.0;
                let at = [0, 1].map(|axis| place[axis] + part * half_way[axis]);
                let squared = at[0] * at[0] + at[1] * at[1];
                (0..2).for_each(|axis| sum[axis] += at[axis] / squared / f64::from(places));
            }
            for axis in [0, 1] {
                assert!((found[axis] / sum[axis] - 1.0).abs() < 1e-6, "{found:?} {sum:?}");
            }
        }
    }

    /// The series for slow nodes is the mean on their way, up to where the logarithm takes its place.
    #[test]
    fn analytic_the_series_of_slow_nodes() {
        for [way_y, way_z] in [[0.49, 0.0], [0.0, -0.49], [0.3, 0.35], [-0.2, 0.1], [0.0, 0.0], [0.4, 0.4]] {
            let distance = 2e-3;
            let node = |filament: usize, y: f64, half_way: [f64; 2]| MovingNode {
                filament,
                at: [0.03, y, 0.0],
                half_way,
            };
            let half_way = [way_y, way_z].map(|way| way * distance);
            let force = OPEN.forces(&[node(0, distance, half_way), node(1, 0.0, [0.0; 2])], by(1))[0];
            let strength = OPEN.charge * OPEN.charge / (2.0 * PI * PERMITTIVITY * OPEN.height);
            let mut exact = match half_way {
                [0.0, 0.0] => [1.0 / distance, 0.0],
                _ => mean_on_a_way([distance, 0.0], half_way, 0.0),
            };
            exact[0] -= distance / (OPEN.reach * OPEN.reach);
            for axis in [0, 1] {
                let off = (force[axis] / strength - exact[axis]) * distance;
                assert!(off.abs() < 3e-3, "{way_y} {way_z}: {off}");
            }
        }
    }

    /// Neighbours and the rest of the field are together the field of sheets, where filaments are even across:
    /// in a slab as at its edges, whatever the reach.
    #[test]
    fn analytic_neighbours_take_nothing_twice() {
        const ROWS: usize = 12;
        const ACROSS: usize = 60;
        let (pitch, width) = (0.4e-3, 0.4e-3 * ACROSS as f64);
        let y = |row: usize| 0.8e-3 * (row as f64 - 0.5 * (ROWS - 1) as f64);
        let mut nodes: Vec<MovingNode> = Vec::new();
        for i in 0..ROWS * ACROSS {
            let z = (i / ROWS) as f64 * pitch;
            nodes.extend(thread(i, [y(i % ROWS), z], 0.0));
        }
        let (per_mass, node_mass) = (1e-3, OPEN.charge / 1e-3);
        let count = (ROWS * ACROSS) as u64;
        let (per_metre, element, distance) = (count as f64 / width, ELEMENT, DISTANCE);
        let curtain = Curtain { per_metre, node_mass, element, distance, weights: count };
        let charge = Charge { per_mass, walls: None, pairs: true };
        let charged = |node: &MovingNode| ChargedNode { x: node.at[0], y: node.at[1], weight: 1 };
        let charged: Vec<ChargedNode> = nodes.iter().map(charged).collect();
        let field = |reach: f64| {
            let mut sheets = Sheets::new(&charge, &curtain).without_neighbours(reach);
            sheets.renew(&charged, 1.0);
            sheets.field()
        };
        let all = field(0.0);
        let edge = all.at(nodes[16].at[0], 20e-3);
        for reach in [2e-3, 4e-3, 8e-3] {
            let rest = field(reach);
            let forces = Repulsion { width: Some(width), reach, ..OPEN }.forces(&nodes, by(2));
            for row in 0..ROWS {
                let at = row * (DISTANCE / ELEMENT) as usize + 16;
                let (x, y) = (nodes[at].at[0], nodes[at].at[1]);
                let of_neighbours = forces[at][0] / OPEN.charge;
                let found = rest.at(x, y) + of_neighbours;
                assert!(
                    (found - all.at(x, y)).abs() < 0.01 * edge,
                    "{reach} {row}: {found} {}",
                    all.at(x, y)
                );
                assert!(row > 0 || of_neighbours.abs() > 0.04 * edge, "they are a part of it");
                assert!(forces[at][1].abs() < 1e-9 * OPEN.charge * edge);
            }
        }
    }
}
