//! Nodes by their places, so that those near a node are found without a look at all others.

use super::repulsion::{MovingNode, Repulsion};
use crate::lanes::{Lanes, Register, WIDTH, Wide};
use std::ops::Range;

/// Fewest cells across a width that is closed to a ring. In fewer of them a node would be met twice.
const FEWEST: usize = 3;
/// Most cells along the machine direction, and across.
const MOST: usize = 1024;

/// Numbers that are kept of each node.
pub(super) const COLUMNS: usize = 6;

/// Nodes in the order of their cells, which are as large as the forces reach or larger.
pub(super) struct Cells {
    /// Number of cells from the inlet to the belt, along the machine direction and across.
    counts: [usize; 3],
    /// Whether the last cell across stands beside the first one.
    is_ring: bool,
    /// The first node of each cell, and the end of the last one.
    starts: Vec<usize>,
    /// Filament, place and half way of each node, and of some that are far away behind the last one.
    columns: [Vec<f64>; COLUMNS],
    /// Where each of them was before.
    numbers: Vec<usize>,
}

impl Cells {
    /// Sorts the nodes between inlet and belt.
    pub(super) fn new(of: &Repulsion, nodes: &[MovingNode]) -> Self {
        let counts = |node: &MovingNode| {
            (0.0..of.distance).contains(&node.at[0]) && node.at.iter().all(|at| at.is_finite())
        };
        let inside = || nodes.iter().enumerate().filter(|(_, node)| counts(node));
        let across = |node: &MovingNode| match of.width {
            Some(width) => node.at[2].rem_euclid(width),
            None => node.at[2],
        };
        let range = |place: &dyn Fn(&MovingNode) -> f64| {
            let all = inside().map(|(_, node)| place(node));
            all.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), at| (least.min(at), most.max(at)))
        };
        let (back, front) = range(&|node| node.at[1]);
        let (left, right) = of.width.map_or_else(|| range(&across), |width| (0.0, width));
        let cells_of = |size: f64| ((size / of.reach) as usize).clamp(1, MOST);
        let heights = ((of.distance / of.height) as usize).max(1);
        let mut counts = [heights, cells_of(front - back), cells_of(right - left)];
        let is_ring = of.width.is_some() && counts[2] >= FEWEST;
        if of.width.is_some() && !is_ring {
            counts[2] = 1;
        }
        let cell = |place: f64, (from, to): (f64, f64), count: usize| {
            let cell = (place - from) / (to - from) * count as f64;
            // All at one place are in the first cell.
            if cell > 0.0 { (cell as usize).min(count - 1) } else { 0 }
        };
        let cell_of = |node: &MovingNode| {
            let height = cell(node.at[0], (0.0, of.distance), counts[0]);
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
        Self { counts, is_ring, starts, columns, numbers }
    }

    /// Number of cells from the inlet to the belt.
    pub(super) const fn heights(&self) -> usize {
        self.counts[0]
    }

    /// Where each node was before it was sorted.
    pub(super) fn numbers(&self) -> &[usize] {
        &self.numbers
    }

    /// Passes on the nodes of each cell of a height, and those in it and beside it among which are all within the
    /// reach of the forces.
    pub(super) fn each_at(&self, height: usize, mut take: impl FnMut(Range<usize>, &[Range<usize>])) {
        let [heights, along, across] = self.counts;
        let around = |cell: usize, count: usize| cell.saturating_sub(1)..(cell + 2).min(count);
        let mut others = Vec::new();
        for row in 0..along {
            for column in 0..across {
                let own = self.nodes_in((height * along + row) * across, column..column + 1);
                if own.is_empty() {
                    continue;
                }
                others.clear();
                for height in around(height, heights) {
                    for row in around(row, along) {
                        let start = (height * along + row) * across;
                        others.push(self.nodes_in(start, around(column, across)));
                        let beyond = match column {
                            _ if !self.is_ring => continue,
                            0 => across - 1,
                            column if column + 1 == across => 0,
                            _ => continue,
                        };
                        others.push(self.nodes_in(start, beyond..beyond + 1));
                    }
                }
                take(own, &others);
            }
        }
    }

    /// The nodes of some cells across.
    fn nodes_in(&self, start: usize, cells: Range<usize>) -> Range<usize> {
        self.starts[start + cells.start]..self.starts[start + cells.end]
    }

    /// The columns of a node.
    #[inline(always)]
    pub(super) fn one_of<S: Register>(&self, node: usize) -> [Wide<S>; COLUMNS] {
        let mut values = [Wide::zero(); COLUMNS];
        for (value, column) in values.iter_mut().zip(&self.columns) {
            *value = Wide::splat(column[node]);
        }
        values
    }

    /// The columns of eight nodes.
    #[inline(always)]
    pub(super) fn eight_from<S: Register>(&self, first: usize) -> [Wide<S>; COLUMNS] {
        let mut values = [Wide::zero(); COLUMNS];
        for (value, column) in values.iter_mut().zip(&self.columns) {
            if let Some(eight) = column[first..].first_chunk::<WIDTH>() {
                *value = Wide::load(&Lanes(*eight));
            }
        }
        values
    }
}
