//! Values on a lattice, linear in each coordinate between the points.

use super::cells_of_file::{BlockKind, Blocks};
use super::fault;
use super::node::{Node, Quantities, check_range};
use spunlaid_ground::{Fault, FileError};

/// Coordinates that differ by less than this share of the extent count as equal.
const ROUNDING: f64 = 1e-9;

#[derive(Debug)]
pub(super) struct Lattice {
    axes: [Axis; 3],
    /// The values along x come first, then y, then z.
    values: Vec<Quantities>,
}

/// The coordinates of the points along an axis.
#[derive(Debug)]
struct Axis {
    /// Increasing [m].
    at: Vec<f64>,
    /// Points per length, on average [1/m].
    density: f64,
}

impl Lattice {
    pub(super) fn new(axes: [Vec<f64>; 3], values: Vec<Quantities>) -> Result<Self, FileError> {
        for (axis, name) in axes.iter().zip(["x", "y", "z"]) {
            check_range(axis).map_err(|fault| FileError::from(fault).array(name))?;
            if axis.is_empty() {
                return Err(FileError::from(fault::empty()).array(name));
            }
            if let Some(pair) = axis.windows(2).find(|pair| pair[0] >= pair[1]) {
                let fault = Fault::not_increasing(pair[0], pair[1]);
                return Err(FileError::from(fault).array(name));
            }
        }
        Ok(Self { axes: axes.map(Axis::new), values })
    }

    /// The lattice that the points form, in any order. `None` unless they are all combinations of three rows
    /// of coordinates, each of them once.
    pub(super) fn from_points(nodes: &[Node]) -> Option<Self> {
        let points: Vec<[f64; 3]> = nodes.iter().map(|node| node.at).collect();
        let (axes, places) = order(&points)?;
        let mut values = vec![Quantities::default(); nodes.len()];
        places.into_iter().zip(nodes).for_each(|(place, node)| values[place] = node.values);
        Some(Self { axes: axes.map(Axis::new), values })
    }

    /// The lattice of a plane flow with one layer of points, if it has two that are alike and more along the
    /// other axes.
    pub(super) fn thinned(mut self) -> Self {
        const FEWEST: usize = 3;
        let size = self.points();
        let Some(axis) = (0..3).find(|axis| size[*axis] == 2) else {
            return self;
        };
        let others = size.into_iter().filter(|size| *size >= FEWEST).count();
        let stride = size[..axis].iter().product::<usize>();
        let second = |i: usize| i / stride % 2 == 1;
        let is_alike = (0..self.values.len()).all(|i| second(i) || self.values[i] == self.values[i + stride]);
        if others == 2 && is_alike {
            let mut number = 0..;
            self.values.retain(|_| number.next().is_some_and(|i| !second(i)));
            let middle = 0.5 * (self.axes[axis].at[0] + self.axes[axis].at[1]);
            self.axes[axis] = Axis::new(vec![middle]);
        }
        self
    }

    /// The direction along which the air is the same in a plane flow: 0, 1, 2 for x, y, z.
    pub(super) fn plane_axis(&self) -> Option<usize> {
        (0..3).find(|axis| self.axes[*axis].at.len() == 1)
    }

    pub(super) fn points(&self) -> [usize; 3] {
        [0, 1, 2].map(|i| self.axes[i].at.len())
    }

    /// The memory taken [bytes].
    pub(super) fn memory(&self) -> usize {
        size_of_val(&*self.values)
    }

    pub(super) fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        ([0, 1, 2].map(|i| self.axes[i].at[0]), [0, 1, 2].map(|i| self.axes[i].at[self.axes[i].at.len() - 1]))
    }

    /// The boxes between the points, x first; rectangles if the lattice is one point thick. None of a row of points.
    pub(super) fn blocks(&self) -> Option<Blocks> {
        let thick: Vec<usize> = (0..3).filter(|axis| self.axes[*axis].at.len() > 1).collect();
        let kind = match thick.len() {
            2 => BlockKind::Pixel,
            3 => BlockKind::Voxel,
            _ => return None,
        };
        let [xs, ys, zs] = self.points();
        let sides = [0, 1, 2].map(|axis| self.axes[axis].sides());
        let mut blocks = Blocks {
            kind,
            points: Vec::with_capacity(xs * ys * zs),
            corners: Vec::new(),
            ends: Vec::new(),
            volumes: Vec::new(),
            centres: Vec::new(),
            depth: (thick.len() == 2).then_some(1.0),
        };
        for z in &self.axes[2].at {
            for y in &self.axes[1].at {
                blocks.points.extend(self.axes[0].at.iter().map(|x| [*x, *y, *z]));
            }
        }
        let strides = [1, xs, xs * ys];
        let of_corner = |corner: usize| -> usize {
            thick.iter().enumerate().map(|(bit, axis)| (corner >> bit & 1) * strides[*axis]).sum()
        };
        for (k, (z, of_z)) in sides[2].iter().enumerate() {
            for (j, (y, of_y)) in sides[1].iter().enumerate() {
                for (i, (x, of_x)) in sides[0].iter().enumerate() {
                    let first = i + xs * (j + ys * k);
                    blocks
                        .corners
                        .extend((0..kind.corners()).map(|corner| (first + of_corner(corner)) as u32));
                    blocks.ends.push(blocks.ends.len() as u32 + 1);
                    blocks.volumes.push(of_x * of_y * of_z);
                    blocks.centres.push([*x, *y, *z]);
                }
            }
        }
        Some(blocks)
    }

    /// The number of the box in which a place lies; None outside.
    pub(super) fn cell(&self, at: [f64; 3]) -> Option<usize> {
        let [x, y, z] = [0, 1, 2].map(|i| self.axes[i].locate(at[i]));
        let [across, up] = [0, 1].map(|i| self.axes[i].at.len().saturating_sub(1).max(1));
        (x.inside && y.inside && z.inside).then(|| x.before + across * (y.before + up * z.before))
    }

    /// Calls `with` for the points in a box, and where the planes through them meet its edges and faces.
    pub(super) fn points_in_box(
        &self,
        low: [f64; 3],
        high: [f64; 3],
        mut with: impl FnMut([f64; 3], &Quantities),
    ) {
        let [x, y, z] = [0, 1, 2].map(|i| self.axes[i].between(low[i], high[i]));
        for at in z.flat_map(|z| y.clone().map(move |y| (y, z))) {
            for x in x.clone() {
                let at = [x, at.0, at.1];
                with(at, &self.sample(at).0);
            }
        }
    }

    #[inline]
    pub(super) fn sample(&self, at: [f64; 3]) -> (Quantities, bool) {
        let [x, y, z] = [0, 1, 2].map(|i| self.axes[i].locate(at[i]));
        let [across, up] = [self.axes[0].at.len(), self.axes[0].at.len() * self.axes[1].at.len()];
        let first = x.before + across * y.before + up * z.before;
        let [back, front] = [1.0 - z.share, z.share].map(|of_z| [of_z * (1.0 - y.share), of_z * y.share]);
        let rows = [
            (back[0], first),
            (back[1], first + across * y.step),
            (front[0], first + up * z.step),
            (front[1], first + up * z.step + across * y.step),
        ];
        let mut values = Quantities::default();
        for (weight, row) in rows {
            let (low, high) = (&self.values[row], &self.values[row + x.step]);
            let (of_low, of_high) = (weight * (1.0 - x.share), weight * x.share);
            for i in 0..values.len() {
                values[i] += of_low * low[i] + of_high * high[i];
            }
        }
        (values, x.inside && y.inside && z.inside)
    }
}

/// The axes of the lattice that some points form, and the place of each point in its list of values. `None`
/// unless they are all combinations of three rows of coordinates, each of them once.
pub(super) fn order(points: &[[f64; 3]]) -> Option<([Vec<f64>; 3], Vec<usize>)> {
    let axes = [0, 1, 2].map(|axis| levels(points.iter().map(|at| at[axis]).collect()));
    let size = axes.each_ref().map(Vec::len);
    let count = size.iter().try_fold(1usize, |product, n| product.checked_mul(*n))?;
    if count != points.len() || count < 2 {
        return None;
    }
    let mut taken = vec![false; count];
    let place = |at: &[f64; 3]| {
        let [x, y, z] =
            [0, 1, 2].map(|axis| axes[axis].partition_point(|level| *level <= at[axis]).saturating_sub(1));
        let place = x + size[0] * (y + size[1] * z);
        (!std::mem::replace(&mut taken[place], true)).then_some(place)
    };
    let places = points.iter().map(place).collect::<Option<Vec<_>>>()?;
    Some((axes, places))
}

/// The different coordinates in increasing order. Of those that differ only by rounding, the smallest is kept.
fn levels(mut coordinates: Vec<f64>) -> Vec<f64> {
    coordinates.sort_unstable_by(f64::total_cmp);
    let extent = coordinates.first().zip(coordinates.last()).map_or(0.0, |(low, high)| high - low);
    coordinates.dedup_by(|next, level| *next - *level <= ROUNDING * extent);
    coordinates
}

/// Where a coordinate lies on an axis.
struct PlaceOnAxis {
    /// The point before it.
    before: usize,
    /// Number of points from there to the next one: 1, or 0 on an axis with a single point.
    step: usize,
    /// Distance from the point before it as a share of the spacing, 0 to 1.
    share: f64,
    inside: bool,
}

impl Axis {
    fn new(at: Vec<f64>) -> Self {
        let length = at[at.len() - 1] - at[0];
        let density = if length > 0.0 { (at.len() - 1) as f64 / length } else { 0.0 };
        Self { at, density }
    }

    /// The middle and the length of each piece between two points; of a single point itself, with a length of one.
    fn sides(&self) -> Vec<(f64, f64)> {
        match &*self.at {
            [only] => vec![(*only, 1.0)],
            all => all.windows(2).map(|pair| (0.5 * (pair[0] + pair[1]), pair[1] - pair[0])).collect(),
        }
    }

    /// Two coordinates, and those of the points between them.
    fn between(&self, low: f64, high: f64) -> impl Iterator<Item = f64> + Clone {
        let first = self.at.partition_point(|x| *x <= low);
        let inner = self.at[first..].iter().copied().take_while(move |x| *x < high);
        [low].into_iter().chain(inner).chain((low < high).then_some(high))
    }

    #[inline]
    fn locate(&self, x: f64) -> PlaceOnAxis {
        let last = self.at.len() - 1;
        if last == 0 {
            return PlaceOnAxis { before: 0, step: 0, share: 0.0, inside: true };
        }
        // First try the place it has if the points are evenly spaced, because they often are.
        let mut before = (((x - self.at[0]) * self.density) as usize).min(last - 1);
        if x < self.at[before] || x > self.at[before + 1] {
            before = self.at.partition_point(|point| *point <= x).saturating_sub(1).min(last - 1);
        }
        let (low, high) = (self.at[before], self.at[before + 1]);
        let share = ((x - low) / (high - low)).clamp(0.0, 1.0);
        PlaceOnAxis { before, step: 1, share, inside: x >= low && x <= high }
    }
}
