//! Values on a mesh of cells. Each cell is cut into tetrahedra, and the values are linear in each of them.

pub(super) mod cells;
mod cut;
mod plane;

use super::cells_of_file::{BlockKind, Blocks};
use super::node::{self, Node, Quantities, bounding_box, merge};
use super::tree::Tree;
use super::{Hint, fault, mean, vector};
use cells::Cells;
use cut::Cut;
use plane::{Plane, plane_of, wedge};
use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree, RTreeNode};
use spunlaid_ground::{Fault, FileError, Position, Vec3};

/// Most tetrahedra that are kept; they take 32 bytes each.
pub(super) const MOST_TETRAHEDRA: usize = 1 << 26;
/// How far outside a face a point still counts as inside because of rounding, as a share of the height.
const EDGE: f64 = 1e-9;
/// The same when no tetrahedron contains the point, which happens in very flat ones.
const GAP: f64 = 1e-6;
/// Steps from tetrahedron to tetrahedron before the tree of boxes is searched instead.
const LONGEST_WALK: usize = 64;
/// Marks a face without a neighbour.
const NOTHING: u32 = u32::MAX;

#[derive(Debug)]
pub(super) struct Mesh {
    nodes: Vec<Node>,
    tetrahedra: Vec<Tetrahedron>,
    cells: RTree<CellBox>,
    /// Nodes of the surface.
    surface: Tree,
    /// Number of points given.
    points: usize,
    bounds: ([f64; 3], [f64; 3]),
    /// Of a plane flow.
    plane: Option<Plane>,
}

/// The box around a cell, with the first and the end of its tetrahedra.
type CellBox = GeomWithData<Rectangle<[f64; 3]>, [u32; 2]>;

#[derive(Debug)]
struct Tetrahedron {
    /// Nodes, ordered so that the volume is positive.
    nodes: [u32; 4],
    /// The neighbour behind the face opposite to each node, or [`NOTHING`].
    beyond: [u32; 4],
}

impl Mesh {
    pub(super) fn new(
        points: &[Vec3<f64>],
        cells: &Cells,
        values: Vec<Quantities>,
    ) -> Result<(Self, Vec<Fault>), FileError> {
        Self::cut(points, cells, values, None)
    }

    /// * `plane` – of a plane flow; if it is not known, it is looked for
    fn cut(
        points: &[Vec3<f64>],
        cells: &Cells,
        values: Vec<Quantities>,
        plane: Option<Plane>,
    ) -> Result<(Self, Vec<Fault>), FileError> {
        if let Some((cell, point)) = cells.beyond(points.len()) {
            let fault = fault::no_point(point.into(), points.len());
            return Err(FileError::from(fault).at(Position::Cell(cell as u64 + 1)));
        }
        let mut nodes = node::nodes(points, values)?;
        let (place_of, merged) = merge(&mut nodes)?;
        let mut warnings = Vec::from_iter(merged);
        if let Some(fault) = wedge(&nodes) {
            return Err(fault.into());
        }
        let plane = plane.or_else(|| plane_of(&nodes));
        let mut cut = Cut::default();
        for cell in 0..cells.len() {
            cut.add(cells, cell, &place_of, &mut nodes);
            if cut.tetrahedra.len().max(nodes.len()) > MOST_TETRAHEDRA {
                let fault = fault::too_many(MOST_TETRAHEDRA as u64, "tetrahedra");
                return Err(fault.into());
            }
        }
        if cut.flat > 0 {
            let message = match cut.flat {
                1 => "1 cell has no volume and is left out".to_owned(),
                flat => format!("{flat} cells have no volume and are left out"),
            };
            warnings.push(Fault::plain(message));
        }
        if cut.folded > 0 {
            warnings.push(Fault::new(
                match cut.folded {
                    1 => "1 cell folds over itself, and the air within it is only roughly right".to_owned(),
                    folded => format!(
                        "{folded} cells fold over themselves, and the air within them is only roughly right"
                    ),
                },
                "check the mesh",
            ));
        }
        if cut.tetrahedra.is_empty() {
            return Err(fault::no_volume(0).into());
        }
        Ok((Self::from_tetrahedra(nodes, cut, points.len(), plane), warnings))
    }

    fn from_tetrahedra(nodes: Vec<Node>, cut: Cut, points: usize, plane: Option<Plane>) -> Self {
        let surface = surface(&cut.triangles, &nodes, plane);
        let cells = boxes(&cut, &nodes);
        let tetrahedra = with_adjacent(&cut.tetrahedra, nodes.len());
        let corners =
            tetrahedra.iter().flat_map(|tetrahedron| tetrahedron.nodes).map(|node| nodes[node as usize].at);
        let bounds = bounding_box(corners);
        let mut mesh = Self { nodes, tetrahedra, cells, surface, points, bounds, plane };
        mesh.bounds = (mesh.in_plane(bounds.0), mesh.in_plane(bounds.1));
        mesh
    }

    pub(super) fn points(&self) -> usize {
        self.points
    }

    pub(super) fn cells(&self) -> usize {
        self.cells.size()
    }

    /// The memory taken [bytes].
    pub(super) fn memory(&self) -> usize {
        // The tree of boxes groups up to six: with the groups it has eight entries for five cells, measured.
        let boxes = self.cells.size() * size_of::<RTreeNode<CellBox>>() * 8 / 5;
        size_of_val(&*self.nodes) + size_of_val(&*self.tetrahedra) + boxes + self.surface.memory()
    }

    pub(super) fn bounds(&self) -> ([f64; 3], [f64; 3]) {
        self.bounds
    }

    /// Calls `with` for the points of the cells whose boxes meet a box.
    pub(super) fn points_in_box(
        &self,
        low: [f64; 3],
        high: [f64; 3],
        mut with: impl FnMut([f64; 3], &Quantities),
    ) {
        for cell in self.cells.locate_in_envelope_intersecting(AABB::from_corners(low, high)) {
            for tetrahedron in &self.tetrahedra[cell.data[0] as usize..cell.data[1] as usize] {
                for node in tetrahedron.nodes.map(|node| &self.nodes[node as usize]) {
                    with(self.in_plane(node.at), &node.values);
                }
            }
        }
    }

    /// The direction along which the air is the same in a plane flow: 0, 1, 2 for x, y, z.
    pub(super) fn plane_axis(&self) -> Option<usize> {
        self.plane.map(|plane| plane.axis)
    }

    /// The place in the plane of a plane flow where the air is that of another place.
    pub(super) fn in_plane(&self, mut at: [f64; 3]) -> [f64; 3] {
        if let Some(Plane { axis, level }) = self.plane {
            at[axis] = level;
        }
        at
    }

    pub(super) fn sample(&self, at: [f64; 3], hint: &mut Hint) -> (Quantities, bool) {
        let at = self.in_plane(at);
        if let Some((found, weights)) = self.locate(at, hint) {
            let nodes = self.tetrahedra[found as usize].nodes;
            let values = nodes.map(|node| &self.nodes[node as usize].values);
            return (mean(weights.into_iter().zip(values)), true);
        }
        (self.nearest(at), false)
    }

    /// The tetrahedron around a place in the plane, and the weights of its nodes there; None outside.
    pub(super) fn locate(&self, at: [f64; 3], hint: &mut Hint) -> Option<(u32, [f64; 4])> {
        let (low, high) = self.bounds;
        let within = (0..3).all(|axis| low[axis] <= at[axis] && at[axis] <= high[axis]);
        let found = if within { self.walk(at, *hint).or_else(|| self.search(at)) } else { None };
        if let Some((found, _)) = found {
            *hint = Hint(found + 1);
        }
        found
    }

    /// The tetrahedra of the cells, in the order of the file.
    pub(super) fn blocks(&self) -> Blocks {
        let mut ends: Vec<u32> = self.cells.iter().map(|cell| cell.data[1]).collect();
        ends.sort_unstable();
        let mut start = 0;
        let mut volumes = Vec::new();
        let mut centres = Vec::new();
        for end in &ends {
            let (mut sum, mut moment) = (0.0, Vec3::default());
            for tetrahedron in &self.tetrahedra[start..*end as usize] {
                let [o, a, b, c] = tetrahedron.nodes.map(|node| vector(self.nodes[node as usize].at));
                let volume = (a - o).dot((b - o).cross(c - o)) / 6.0;
                sum += volume;
                moment += (o + a + b + c) * (0.25 * volume);
            }
            volumes.push(sum);
            centres.push(self.in_plane([moment.x / sum, moment.y / sum, moment.z / sum]));
            start = *end as usize;
        }
        let (low, high) = bounding_box(self.nodes.iter().map(|node| node.at));
        Blocks {
            kind: BlockKind::Tetrahedron,
            points: self.nodes.iter().map(|node| node.at).collect(),
            corners: self.tetrahedra.iter().flat_map(|tetrahedron| tetrahedron.nodes).collect(),
            ends,
            volumes,
            centres,
            depth: self.plane.map(|Plane { axis, .. }| high[axis] - low[axis]),
        }
    }

    /// Starts at the tetrahedron of the hint and moves on through the face that the point lies farthest outside of.
    fn walk(&self, at: [f64; 3], hint: Hint) -> Option<(u32, [f64; 4])> {
        let mut index = hint.0.checked_sub(1)?;
        for _ in 0..LONGEST_WALK {
            let tetrahedron = self.tetrahedra.get(index as usize)?;
            let weights = self.weights(tetrahedron, at);
            let (mut face, mut least) = (0, weights[0]);
            for (i, weight) in weights.into_iter().enumerate().skip(1) {
                if weight < least {
                    (face, least) = (i, weight);
                }
            }
            if least >= -EDGE {
                return Some((index, weights));
            }
            index = tetrahedron.beyond[face];
        }
        None
    }

    /// Of all cells whose box contains the point, takes the tetrahedron that the point lies deepest in.
    fn search(&self, at: [f64; 3]) -> Option<(u32, [f64; 4])> {
        let mut best = None;
        let mut deepest = -GAP;
        for cell in self.cells.locate_in_envelope_intersecting(AABB::from_point(at)) {
            for i in cell.data[0]..cell.data[1] {
                let weights = self.weights(&self.tetrahedra[i as usize], at);
                let least = weights.into_iter().fold(f64::INFINITY, f64::min);
                if least >= deepest {
                    deepest = least;
                    best = Some((i, weights));
                }
            }
        }
        best
    }

    /// The values at the nearest node of the surface.
    fn nearest(&self, at: [f64; 3]) -> Quantities {
        let mut found = [(0.0, 0)];
        self.surface.nearest(at, &mut found);
        self.nodes.get(found[0].1 as usize).map(|node| node.values).unwrap_or_default()
    }

    /// Barycentric coordinates: the weights of the four nodes, whose sum is one.
    #[inline]
    fn weights(&self, tetrahedron: &Tetrahedron, at: [f64; 3]) -> [f64; 4] {
        let [o, a, b, c] = tetrahedron.nodes.map(|node| vector(self.nodes[node as usize].at));
        let a = a - o;
        let b = b - o;
        let c = c - o;
        let p = vector(at) - o;
        let face = b.cross(c);
        let turned = a.cross(p);
        let per_volume = 1.0 / a.dot(face);
        let [of_a, of_b, of_c] = [p.dot(face), c.dot(turned), -b.dot(turned)].map(|part| part * per_volume);
        [1.0 - of_a - of_b - of_c, of_a, of_b, of_c]
    }
}

/// The nodes of the triangles that belong to one cell only, without the two sides of a plane flow.
fn surface(triangles: &[[u32; 3]], nodes: &[Node], plane: Option<Plane>) -> Tree {
    let mut corners = Vec::new();
    let is_side = |triangle: &[u32; 3]| {
        plane.is_some_and(|Plane { axis, level }| {
            let above = triangle.map(|node| nodes[node as usize].at[axis] > level);
            above == [true; 3] || above == [false; 3]
        })
    };
    let alone = |i: u32| {
        let triangle = &triangles[i as usize];
        if !is_side(triangle) {
            corners.extend_from_slice(triangle);
        }
    };
    cells::match_up(nodes.len(), triangles.iter().copied(), |_, _| {}, alone);
    corners.sort_unstable();
    corners.dedup();
    let at = |i: u32| {
        let mut at = nodes[i as usize].at;
        if let Some(Plane { axis, level }) = plane {
            at[axis] = level;
        }
        at
    };
    Tree::new(corners.into_iter().map(|i| (at(i), i)).collect())
}

fn boxes(cut: &Cut, nodes: &[Node]) -> RTree<CellBox> {
    let mut start = 0;
    let boxes = cut.ends.iter().map(|&end| {
        let own = cut.tetrahedra[start as usize..end as usize].iter().flatten();
        let (low, high) = bounding_box(own.map(|node| nodes[*node as usize].at));
        let cell = CellBox::new(Rectangle::from_corners(low, high), [start, end]);
        start = end;
        cell
    });
    RTree::bulk_load(boxes.collect())
}

/// Tetrahedra with their neighbours.
fn with_adjacent(tetrahedra: &[[u32; 4]], nodes: usize) -> Vec<Tetrahedron> {
    let across = |[a, b, c, d]: [u32; 4]| [[b, c, d], [a, c, d], [a, b, d], [a, b, c]];
    let faces = tetrahedra.iter().flat_map(|nodes| across(*nodes));
    let alone = |nodes: &[u32; 4]| Tetrahedron { nodes: *nodes, beyond: [NOTHING; 4] };
    let mut tetrahedra: Vec<Tetrahedron> = tetrahedra.iter().map(alone).collect();
    let pair = |one: u32, other: u32| {
        tetrahedra[one as usize / 4].beyond[one as usize % 4] = other / 4;
        tetrahedra[other as usize / 4].beyond[other as usize % 4] = one / 4;
    };
    cells::match_up(nodes, faces, pair, |_| {});
    tetrahedra
}
