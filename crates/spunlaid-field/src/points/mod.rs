//! Values at points without cells.
//!
//! In a plane flow the points are joined to triangles, and the values are linear in each.
//!
//! In space each point has gradients that are fitted to its neighbours. The value anywhere is a weighted mean: each of
//! the nearest points extrapolates its own value along its gradients. The weight of a point falls to zero with
//! distance before another point replaces it among the nearest, so the field is continuous. The weights are those
//! of Franke & Little, in Franke 1982. No point extrapolates `k` and `ε` to less than half of its own values.

mod triangles;

use super::mean;
use super::node::{Node, Quantities, bounding_box};
use super::tree::Tree;
use spunlaid_ground::error::counted;
use spunlaid_ground::{Fault, FileError};

/// Number of points on average. The distance of the next one is where the weights become zero.
const NEAREST: usize = 8;
/// Number of neighbours that gradients are fitted to. It is doubled until there are some in all directions.
const NEIGHBOURS: [usize; 4] = [16, 32, 64, 128];

/// Neighbours that are looked for on each side where there are none among the nearest, and the square of the cosine of
/// the angle within which they lie. They are looked for in a beam, so many times as long as it is thick.
const EACH_SIDE: usize = 4;
const SLANT: f64 = 0.5;
const SLENDER: f64 = 64.0;

#[derive(Debug)]
pub(super) struct Points {
    sites: Vec<Site>,
    tree: Tree,
    /// Axes along which all points have the same coordinate, as in a plane flow.
    plane: [bool; 3],
    bounds: ([f64; 3], [f64; 3]),
}

/// A point.
#[derive(Debug)]
struct Site {
    node: Node,
    /// Change of the values along x, y and z [per m].
    gradients: [Quantities; 3],
    /// Square of the distance to the farthest neighbour that the gradients are fitted to [m²].
    reach_2: f64,
}

impl Points {
    /// * `nodes` – no two of them at the same place
    pub(super) fn new(nodes: Vec<Node>) -> Result<Self, FileError> {
        if nodes.len() <= NEAREST {
            return Err(Fault::new(
                format!("has {}", counted(nodes.len() as u64, "point")),
                format!("at least {} are needed for interpolation", NEAREST + 1),
            )
            .into());
        }
        let bounds = bounding_box(nodes.iter().map(|node| node.at));
        let plane = [0, 1, 2].map(|axis| bounds.0[axis] == bounds.1[axis]);
        let tree = Tree::new(nodes.iter().map(|node| node.at).zip(0..).collect());
        let mut points = Self { sites: Vec::new(), tree, plane, bounds };
        points.sites = nodes.iter().map(|node| points.site(*node, &nodes)).collect();
        Ok(points)
    }

    fn site(&self, node: Node, nodes: &[Node]) -> Site {
        let mut nearest = [(0.0, 0); NEIGHBOURS[NEIGHBOURS.len() - 1] + 1];
        for wanted in NEIGHBOURS {
            let mut fit = GradientFit::new(self.plane, wanted);
            let mut reach_2 = 0.0;
            let nearest = &mut nearest[..=wanted];
            self.tree.nearest(node.at, nearest);
            for (distance_2, neighbour) in nearest.iter().filter(|(far, _)| *far > 0.0 && far.is_finite()) {
                let other = &nodes[*neighbour as usize];
                let to = [0, 1, 2].map(|axis| other.at[axis] - node.at[axis]);
                fit.add(to, *distance_2, [0, 1, 2, 3, 4].map(|i| other.values[i] - node.values[i]));
                reach_2 = *distance_2;
            }
            if fit.is_spread() {
                return Site { node, gradients: fit.gradients(), reach_2 };
            }
            if wanted == NEIGHBOURS[NEIGHBOURS.len() - 1] {
                reach_2 = self.look_farther(&mut fit, node, nodes, reach_2);
                return Site { node, gradients: fit.gradients(), reach_2 };
            }
        }
        Site { node, gradients: Default::default(), reach_2: 0.0 }
    }

    /// Adds neighbours in the directions in which there are none among the nearest, as of nodes of a mesh that is
    /// stretched along the flow: the nearest ones on either side, so that as many count there as elsewhere. Returns the
    /// square of the distance to the farthest [m²].
    fn look_farther(&self, fit: &mut GradientFit, node: Node, nodes: &[Node], mut reach_2: f64) -> f64 {
        let seen_2 = reach_2;
        for _ in (0..3).filter(|axis| !self.plane[*axis]) {
            if fit.is_spread() {
                break;
            }
            for mut side in self.on_both_sides(node.at, nodes, fit.sparsest(self.plane), seen_2) {
                side.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
                for (distance_2, neighbour) in side.into_iter().take(EACH_SIDE) {
                    let other = &nodes[neighbour as usize];
                    let to = [0, 1, 2].map(|axis| other.at[axis] - node.at[axis]);
                    fit.add(to, distance_2, [0, 1, 2, 3, 4].map(|i| other.values[i] - node.values[i]));
                    reach_2 = reach_2.max(distance_2);
                }
            }
        }
        reach_2
    }

    /// Points in a beam through a place, at least [`EACH_SIDE`] before it and behind it unless the field ends there:
    /// the squares of their distances [m²] and their numbers.
    ///
    /// * `towards` – the direction of the beam
    /// * `seen_2` – square of the distance from which on points count [m²]
    fn on_both_sides(
        &self,
        at: [f64; 3],
        nodes: &[Node],
        towards: [f64; 3],
        seen_2: f64,
    ) -> [Vec<(f64, u32)>; 2] {
        let (low, high) = self.bounds;
        let main = (0..3).fold(0, |main, i| if towards[i].abs() > towards[main].abs() { i } else { main });
        let whole: f64 = (0..3).map(|axis| high[axis] - low[axis]).sum();
        let mut half = 2.0 * seen_2.sqrt();
        loop {
            let reach = towards.map(|part| half * (part.abs() + 1.0 / SLENDER));
            let corner = |sign: f64| [0, 1, 2].map(|axis| at[axis] + sign * reach[axis]);
            let mut sides: [Vec<(f64, u32)>; 2] = Default::default();
            self.tree.in_box(corner(-1.0), corner(1.0), &mut |number| {
                let to = [0, 1, 2].map(|axis| nodes[number as usize].at[axis] - at[axis]);
                let distance_2: f64 = to.iter().map(|to| to * to).sum();
                let along: f64 = to.iter().zip(towards).map(|(to, towards)| to * towards).sum();
                if distance_2 > seen_2 && along * along > SLANT * distance_2 {
                    sides[usize::from(along > 0.0)].push((distance_2, number));
                }
            });
            let is_beyond = |sign: f64| {
                let end = at[main] + sign * half * towards[main];
                end < low[main] || end > high[main] || half > whole
            };
            let is_enough = |(side, sign): (&Vec<_>, f64)| side.len() >= EACH_SIDE || is_beyond(sign);
            if sides.iter().zip([-1.0, 1.0]).all(is_enough) {
                return sides;
            }
            half *= 2.0;
        }
    }

    /// The direction along which the air is the same in a plane flow: 0, 1, 2 for x, y, z.
    pub(super) fn plane_axis(&self) -> Option<usize> {
        (0..3).find(|axis| self.plane[*axis])
    }

    pub(super) fn points(&self) -> usize {
        self.sites.len()
    }

    /// The memory taken [bytes].
    pub(super) fn memory(&self) -> usize {
        size_of_val(&*self.sites) + self.tree.memory()
    }

    pub(super) fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        self.bounds
    }

    /// Calls `with` for the points in a box.
    pub(super) fn points_in_box(
        &self,
        low: [f64; 3],
        high: [f64; 3],
        mut with: impl FnMut([f64; 3], &Quantities),
    ) {
        self.tree.in_box(low, high, &mut |number| {
            let node = &self.sites[number as usize].node;
            with(node.at, &node.values);
        });
    }

    pub(super) fn sample(&self, at: [f64; 3]) -> (Quantities, bool) {
        let (low, high) = self.bounds;
        let at = [0, 1, 2].map(|axis| if self.plane[axis] { low[axis] } else { at[axis] });
        let mut nearest = [(0.0, 0); NEAREST + 1];
        self.tree.nearest(at, &mut nearest);
        let (least_2, first) = nearest[0];
        let site = &self.sites[first as usize];
        let inside =
            (0..3).all(|axis| low[axis] <= at[axis] && at[axis] <= high[axis]) && least_2 <= site.reach_2;
        let (least, reach) = (least_2.sqrt(), nearest[NEAREST].0.sqrt());
        if !inside || least_2 == 0.0 || least == reach {
            return (site.node.values, inside);
        }
        let weights = nearest.map(|(distance_2, _)| {
            let distance = distance_2.sqrt();
            // Relative to the nearest point's weight 1/d².
            let weight = (1.0 - distance / reach) * (least / distance);
            weight * weight
        });
        let total: f64 = weights.iter().sum();
        let parts = nearest.map(|(_, i)| self.sites[i as usize].continued(at));
        (mean(weights.map(|weight| weight / total).into_iter().zip(&parts)), true)
    }
}

impl Site {
    /// Extrapolates the values of this point along its gradients.
    fn continued(&self, at: [f64; 3]) -> Quantities {
        let mut values = self.node.values;
        for (axis, gradient) in self.gradients.iter().enumerate() {
            let along = at[axis] - self.node.at[axis];
            values.iter_mut().zip(gradient).for_each(|(value, change)| *value += along * change);
        }
        // Next to walls k and ε are so steep that extrapolation would make them negative.
        for (value, nearest) in values.iter_mut().zip(self.node.values).skip(3) {
            *value = value.max(0.5 * nearest);
        }
        values
    }
}

/// Least share of the neighbours that must lie in each direction.
const SPREAD: f64 = 0.01;
/// Share that is added to the diagonal, so that a gradient without neighbours in its direction is zero.
const RIDGE: f64 = 1e-13;

/// A weighted least-squares fit. The weight of a neighbour is its distance to the power −2, so that only its
/// direction counts.
#[derive(Clone, Copy)]
struct GradientFit {
    /// Sum of products of directions.
    normal: [[f64; 3]; 3],
    /// Sum of products of a direction and the change per distance.
    right: [Quantities; 3],
    neighbours: f64,
}

impl GradientFit {
    /// * `plane` – axes along which nothing changes
    /// * `most` – largest number of neighbours that will be added
    fn new(plane: [bool; 3], most: usize) -> Self {
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
    fn add(&mut self, to: [f64; 3], distance_2: f64, change: Quantities) {
        for (axis, along) in to.into_iter().enumerate() {
            let along = along / distance_2;
            self.normal[axis].iter_mut().zip(to).for_each(|(sum, to)| *sum += along * to);
            self.right[axis].iter_mut().zip(change).for_each(|(sum, change)| *sum += along * change);
        }
        self.neighbours += 1.0;
    }

    /// Whether there are neighbours in all directions.
    fn is_spread(&self) -> bool {
        let (normal, _) = self.eliminated();
        (0..3).all(|axis| normal[axis][axis] > SPREAD * self.neighbours)
    }

    /// The direction in which there are the fewest neighbours.
    ///
    /// * `plane` – axes along which nothing changes
    fn sparsest(&self, plane: [bool; 3]) -> [f64; 3] {
        /// Steps of the iteration by powers; directions that it does not distinguish lack neighbours alike.
        const STEPS: usize = 64;
        let trace: f64 = (0..3).filter(|axis| !plane[*axis]).map(|axis| self.normal[axis][axis]).sum();
        let mut towards = [0, 1, 2].map(|axis| if plane[axis] { 0.0 } else { 1.0 - 0.1 * axis as f64 });
        for _ in 0..STEPS {
            let next = [0, 1, 2].map(|row| {
                let along: f64 = self.normal[row].iter().zip(towards).map(|(entry, part)| entry * part).sum();
                if plane[row] { 0.0 } else { trace * towards[row] - along }
            });
            let length = next.iter().map(|part| part * part).sum::<f64>().sqrt();
            towards = if length > 0.0 { next.map(|part| part / length) } else { towards };
        }
        towards
    }

    /// Change of the values along x, y and z [per m].
    fn gradients(mut self) -> [Quantities; 3] {
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
