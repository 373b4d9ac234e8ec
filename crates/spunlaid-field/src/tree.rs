//! A k-d tree that finds the nearest points.
//!
//! Points at the same distance are ordered by their numbers, so the answer does not depend on how the tree is
//! built.

use super::node::bounding_box;
use std::ops::Range;

/// A part of the list with no more points than this is searched point by point.
const LEAF: usize = 16;

#[derive(Debug)]
pub(super) struct Tree {
    /// The middle entry of each part of the list is the median along the part's longest axis. The entries before
    /// it lie below the median, those after it above.
    points: Vec<([f64; 3], u32)>,
    /// The longest axis of the part whose middle entry this is.
    axes: Vec<u8>,
}

impl Tree {
    /// * `points` – each with its number
    pub(super) fn new(mut points: Vec<([f64; 3], u32)>) -> Self {
        let mut axes = vec![0; points.len()];
        part(&mut points, &mut axes);
        Self { points, axes }
    }

    /// The memory taken [bytes].
    pub(super) fn memory(&self) -> usize {
        size_of_val(&*self.points) + self.axes.len()
    }

    /// Fills `found` with the nearest points, nearest first: the square of the distance [m²] and the number of
    /// the point. Entries left over have the distance infinity.
    pub(super) fn nearest(&self, at: [f64; 3], found: &mut [(f64, u32)]) {
        found.fill((f64::INFINITY, u32::MAX));
        self.look(0, self.points.len(), at, found);
    }

    /// Calls `with` for the number of each point in a box.
    pub(super) fn in_box(&self, low: [f64; 3], high: [f64; 3], with: &mut impl FnMut(u32)) {
        self.look_in_box(0..self.points.len(), &low, &high, with);
    }

    fn look_in_box(&self, part: Range<usize>, low: &[f64; 3], high: &[f64; 3], with: &mut impl FnMut(u32)) {
        let mut check = |(point, number): &([f64; 3], u32)| {
            if (0..3).all(|axis| low[axis] <= point[axis] && point[axis] <= high[axis]) {
                with(*number);
            }
        };
        if part.len() <= LEAF {
            self.points[part].iter().for_each(check);
            return;
        }
        let middle = part.start.midpoint(part.end);
        let (axis, at) = (usize::from(self.axes[middle]), self.points[middle].0);
        check(&self.points[middle]);
        if low[axis] <= at[axis] {
            self.look_in_box(part.start..middle, low, high, with);
        }
        if high[axis] >= at[axis] {
            self.look_in_box(middle + 1..part.end, low, high, with);
        }
    }

    fn look(&self, low: usize, high: usize, at: [f64; 3], found: &mut [(f64, u32)]) {
        if high - low <= LEAF {
            for (point, number) in &self.points[low..high] {
                insert((distance_2(*point, at), *number), found);
            }
            return;
        }
        let middle = low.midpoint(high);
        let (point, number) = self.points[middle];
        let axis = usize::from(self.axes[middle]);
        let above = at[axis] - point[axis];
        let parts = [(low, middle), (middle + 1, high)];
        let [near, far] = if above < 0.0 { parts } else { [parts[1], parts[0]] };
        self.look(near.0, near.1, at, found);
        insert((distance_2(point, at), number), found);
        if above * above <= found[found.len() - 1].0 {
            self.look(far.0, far.1, at, found);
        }
    }
}

fn part(points: &mut [([f64; 3], u32)], axes: &mut [u8]) {
    if points.len() <= LEAF {
        return;
    }
    let (low, high) = bounding_box(points.iter().map(|(point, _)| *point));
    let extent = [0, 1, 2].map(|axis| high[axis] - low[axis]);
    let axis = (0..3).fold(0, |longest, axis| if extent[axis] > extent[longest] { axis } else { longest });
    let middle = points.len() / 2;
    points.select_nth_unstable_by(middle, |a, b| a.0[axis].total_cmp(&b.0[axis]));
    axes[middle] = axis as u8;
    let (before, after) = points.split_at_mut(middle);
    let (axes_before, axes_after) = axes.split_at_mut(middle);
    part(before, axes_before);
    part(&mut after[1..], &mut axes_after[1..]);
}

/// Inserts a point into the sorted list of the nearest if it is near enough. The list has at least one entry.
#[inline]
fn insert(point: (f64, u32), found: &mut [(f64, u32)]) {
    let mut place = found.len();
    if point.0 > found[place - 1].0 {
        return;
    }
    while place > 0 && point < found[place - 1] {
        place -= 1;
    }
    if place < found.len() {
        found[place..].rotate_right(1);
        found[place] = point;
    }
}

fn distance_2(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [x, y, z] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    x * x + y * y + z * z
}
