//! Cells cut into tetrahedra, so that neighbours agree on the face between them.
//!
//! Every face is parted into triangles by the diagonals from its point of the smallest number, which both of
//! its cells know. A cell is then the tetrahedra that its own point of the smallest number makes with the
//! triangles it is no corner of: all faces around that point are parted from it, so nothing is left over. That
//! is the pulling triangulation of a convex polyhedron; Dompierre et al. 1999 use it for hexahedra, wedges and
//! pyramids. A cell that is not convex is cut from its centroid, where the mean of its points' values is put.

use super::cells::Cells;
use crate::field::node::{Node, bounding_box};
use crate::field::{mean, vector};
use crate::vec3::Vec3;

/// Least volume of a tetrahedron or a cell, by the third power of the cell's diagonal: less is rounding.
const FLAT: f64 = 1e-12;
/// Share of a cell's volume that may be folded over before it is cut from its centroid.
const BENT: f64 = 1e-3;
/// And before it is counted: meshers leave cells behind that are folded over by a hundredth or two.
const FOLDED: f64 = 0.05;

/// What cells are cut into.
#[derive(Default)]
pub(super) struct Cut {
    /// The nodes of each tetrahedron, so that its volume is positive.
    pub(super) tetrahedra: Vec<[u32; 4]>,
    /// Where the tetrahedra of each cell with a volume end.
    pub(super) ends: Vec<u32>,
    /// All triangles of all these cells' faces.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Cells without volume.
    pub(super) flat: u64,
    /// Cells that fold over themselves.
    pub(super) folded: u64,
}

impl Cut {
    /// Cuts a cell; a centroid is added to the nodes where one is needed.
    ///
    /// * `place_of` – for each point, the first one at its place
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
        // A face that has collapsed names a point twice in a row.
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

/// Turns the faces of a polyhedron, of which files say no side, so that they look away from its centroid.
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

/// The tetrahedra that a tip makes with triangles.
struct Cone<'a> {
    tip: u32,
    triangles: &'a [[u32; 3]],
    /// Six times the volume of each, of either sign.
    volumes: Vec<f64>,
}

impl<'a> Cone<'a> {
    fn new(tip: u32, at: [f64; 3], triangles: &'a [[u32; 3]], nodes: &[Node]) -> Self {
        let of =
            |triangle: &[u32; 3]| if triangle.contains(&tip) { 0.0 } else { volume(at, triangle, nodes) };
        Self { tip, triangles, volumes: triangles.iter().map(of).collect() }
    }

    /// Six times the volume of the cell.
    fn volume(&self) -> f64 {
        self.volumes.iter().sum::<f64>().abs()
    }

    /// The part that has the other sign, as a share of the volume.
    fn folded(&self) -> f64 {
        let whole: f64 = self.volumes.iter().map(|volume| volume.abs()).sum();
        0.5 * (whole / self.volume() - 1.0)
    }

    /// Those with a volume above `least`, in order.
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

/// The mean of the corners and of their values; what is linear has its right value there.
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
