//! Cuts cells into tetrahedra so that neighbours agree on how the face between them is cut.
//!
//! The diagonals from the point with the smallest number divide each face into triangles. Both cells of a face
//! find the same triangles in this way. The point with the smallest number of the whole cell then forms a
//! tetrahedron with each triangle that it is not a corner of; together these fill the cell. This is the pulling
//! triangulation of a convex polyhedron; Dompierre et al. 1999 use it for hexahedra, wedges and pyramids. A cell
//! that is not convex is cut from its centroid, which gets the mean of the values at the cell's points.

use super::cells::Cells;
use crate::node::{Node, bounding_box};
use crate::{mean, vector};
use spunlaid_ground::Vec3;

/// Smallest volume of a tetrahedron or a cell, divided by the cube of the cell's diagonal. Less is rounding.
const FLAT: f64 = 1e-12;
/// Share of a cell's volume that may be folded over before it is cut from its centroid.
const BENT: f64 = 1e-3;
/// Share above which the cell is counted in a warning. Meshers often leave cells that are folded by 1 or 2 %.
const FOLDED: f64 = 0.05;

/// The result of cutting cells.
#[derive(Default)]
pub(super) struct Cut {
    /// The nodes of each tetrahedron, ordered so that its volume is positive.
    pub(super) tetrahedra: Vec<[u32; 4]>,
    /// For each cell with a volume, the end of its tetrahedra in the list.
    pub(super) ends: Vec<u32>,
    /// The triangles of the faces of all cells with a volume.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Number of cells without volume.
    pub(super) flat: u64,
    /// Number of cells that fold over themselves.
    pub(super) folded: u64,
}

impl Cut {
    /// Cuts a cell and adds a centroid to the nodes if one is needed.
    ///
    /// * `place_of` – for each point, the first point at its place
    pub(super) fn add(&mut self, cells: &Cells, cell: usize, place_of: &[u32], nodes: &mut Vec<Node>) {
        let triangles = triangles(cells, cell, place_of, nodes);
        let Some(tip) = triangles.iter().flatten().copied().min() else {
            self.flat += 1;
            return;
        };
        let least = FLAT * cube_of_diagonal(&triangles, nodes);
        let mut cone = Cone::new(tip, nodes[tip as usize].at, &triangles, nodes);
        if cone.volume() <= least {
            self.flat += 1;
            return;
        }
        if cone.folded() > BENT {
            let centroid = centroid(&triangles, nodes);
            let from_centroid = Cone::new(nodes.len() as u32, centroid.at, &triangles, nodes);
            if from_centroid.folded() < cone.folded() {
                cone = from_centroid;
                nodes.push(centroid);
            }
            self.folded += u64::from(cone.folded() > FOLDED);
        }
        self.tetrahedra.extend(cone.tetrahedra(least));
        self.ends.push(self.tetrahedra.len() as u32);
        self.triangles.extend_from_slice(&triangles);
    }
}

/// The triangles of a cell's faces, all seen from the same side.
fn triangles(cells: &Cells, cell: usize, place_of: &[u32], nodes: &[Node]) -> Vec<[u32; 3]> {
    let mut triangles = Vec::with_capacity(12);
    let mut face = Vec::with_capacity(8);
    let mut ends = Vec::new();
    cells.each_face(cell, |points| {
        face.clear();
        face.extend(points.iter().map(|point| place_of[*point as usize]));
        // A collapsed face names the same point twice in a row.
        face.dedup();
        while face.len() > 1 && face.first() == face.last() {
            face.pop();
        }
        let first = (0..face.len()).min_by_key(|i| face[*i]).unwrap_or(0);
        face.rotate_left(first);
        triangles.extend(face.windows(2).skip(1).map(|pair| [face[0], pair[0], pair[1]]));
        ends.push(triangles.len());
    });
    if cells.is_polyhedron(cell) {
        face_outwards(&mut triangles, &ends, nodes);
    }
    triangles
}

/// Turns the faces of a polyhedron outwards, away from its centroid. Files do not say which side is outside.
fn face_outwards(triangles: &mut [[u32; 3]], ends: &[usize], nodes: &[Node]) {
    let centre = centroid(triangles, nodes).at;
    let mut start = 0;
    for &end in ends {
        let face = &mut triangles[start..end];
        let volume: f64 = face.iter().map(|triangle| volume(centre, triangle, nodes)).sum();
        if volume < 0.0 {
            face.iter_mut().for_each(|[_, b, c]| std::mem::swap(b, c));
        }
        start = end;
    }
}

/// The tetrahedra between a tip and triangles.
struct Cone<'a> {
    tip: u32,
    triangles: &'a [[u32; 3]],
    /// Six times the volume of each, with its sign.
    volumes: Vec<f64>,
}

impl<'a> Cone<'a> {
    fn new(tip: u32, at: [f64; 3], triangles: &'a [[u32; 3]], nodes: &[Node]) -> Self {
        let volume_of_triangle =
            |triangle: &[u32; 3]| if triangle.contains(&tip) { 0.0 } else { volume(at, triangle, nodes) };
        Self { tip, triangles, volumes: triangles.iter().map(volume_of_triangle).collect() }
    }

    /// Six times the volume of the cell.
    fn volume(&self) -> f64 {
        self.volumes.iter().sum::<f64>().abs()
    }

    /// The volume of the tetrahedra with the opposite sign, as a share of the cell's volume.
    fn folded(&self) -> f64 {
        let whole: f64 = self.volumes.iter().map(|volume| volume.abs()).sum();
        0.5 * (whole / self.volume() - 1.0)
    }

    /// The tetrahedra with a volume above `least`.
    fn tetrahedra(&self, least: f64) -> impl Iterator<Item = [u32; 4]> {
        let sign = self.volumes.iter().sum::<f64>().signum();
        let tip = self.tip;
        let larger =
            self.triangles.iter().zip(&self.volumes).filter(move |(_, volume)| **volume * sign > least);
        larger.map(move |(&[a, b, c], _)| if sign > 0.0 { [tip, a, b, c] } else { [tip, a, c, b] })
    }
}

/// Six times the volume of the tetrahedron between a point and a triangle.
fn volume(tip: [f64; 3], triangle: &[u32; 3], nodes: &[Node]) -> f64 {
    let [a, b, c] = triangle.map(|node| vector(nodes[node as usize].at) - vector(tip));
    a.dot(b.cross(c))
}

/// The mean of the corners and of their values. It is exact for values that are linear in space.
fn centroid(triangles: &[[u32; 3]], nodes: &[Node]) -> Node {
    let mut corners: Vec<u32> = triangles.iter().flatten().copied().collect();
    corners.sort_unstable();
    corners.dedup();
    let share = 1.0 / corners.len() as f64;
    let corners = || corners.iter().map(|corner| (share, &nodes[*corner as usize]));
    let at = corners().fold(Vec3::default(), |sum, (share, node)| sum + vector(node.at) * share);
    let values = mean(corners().map(|(share, node)| (share, &node.values)));
    Node { at: [at.x, at.y, at.z], values }
}

fn cube_of_diagonal(triangles: &[[u32; 3]], nodes: &[Node]) -> f64 {
    let corners = triangles.iter().flatten().map(|corner| nodes[*corner as usize].at);
    let (low, high) = bounding_box(corners);
    let diagonal = (vector(high) - vector(low)).norm();
    diagonal * diagonal * diagonal
}
