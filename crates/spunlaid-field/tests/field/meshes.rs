//! Meshes of every kind of cell on one block of points, and air to put there, shared by the tests of fields.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use spunlaid_field::{Cells, Field, Local, Shape, Values};
use spunlaid_ground::Vec3;

/// Rows of points with rows of cells between them.
#[derive(Clone, Debug)]
pub struct Block {
    pub size: [usize; 3],
    pub points: Vec<[f64; 3]>,
}

/// A number between −1 and 1 that looks random.
pub fn noise(seed: usize) -> f64 {
    let mixed = (seed as u64 + 1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    let mixed = (mixed ^ (mixed >> 29)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    ((mixed ^ (mixed >> 32)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

impl Block {
    /// `cells` to each side of a unit cube; inner points moved at random by `jitter` of a cell.
    pub fn cube(cells: usize, jitter: f64) -> Self {
        let n = cells + 1;
        let mut points = Vec::new();
        for place in 0..n * n * n {
            let index = [place % n, place / n % n, place / n / n];
            points.push([0, 1, 2].map(|axis| {
                let moved = if index[axis] == 0 || index[axis] == cells { 0.0 } else { jitter };
                (index[axis] as f64 + moved * noise(3 * place + axis)) / cells as f64
            }));
        }
        Self { size: [n; 3], points }
    }

    /// The corners of the hexahedra.
    pub fn hexahedra(&self) -> Vec<[usize; 8]> {
        let [nx, ny, nz] = self.size;
        let mut cells = Vec::new();
        for z in 0..nz - 1 {
            for y in 0..ny - 1 {
                for x in 0..nx - 1 {
                    let at = |i: usize, j: usize, k: usize| x + i + nx * (y + j + ny * (z + k));
                    cells.push([
                        at(0, 0, 0),
                        at(1, 0, 0),
                        at(1, 1, 0),
                        at(0, 1, 0),
                        at(0, 0, 1),
                        at(1, 0, 1),
                        at(1, 1, 1),
                        at(0, 1, 1),
                    ]);
                }
            }
        }
        cells
    }
}

/// VTK type, points and, of a polyhedron, faces of a cell.
pub type Cell = (u8, Vec<usize>, Vec<Vec<usize>>);

/// What the cells of a block are made into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Made {
    Hexahedra,
    Voxels,
    Wedges,
    Pyramids,
    Tetrahedra,
    Polyhedra,
    /// By turns.
    Mixed,
}

pub const ALL: [Made; 7] = [
    Made::Hexahedra,
    Made::Voxels,
    Made::Wedges,
    Made::Pyramids,
    Made::Tetrahedra,
    Made::Polyhedra,
    Made::Mixed,
];

/// The six faces of a hexahedron.
pub fn faces(c: [usize; 8]) -> [[usize; 4]; 6] {
    [
        [c[0], c[3], c[2], c[1]],
        [c[4], c[5], c[6], c[7]],
        [c[0], c[1], c[5], c[4]],
        [c[1], c[2], c[6], c[5]],
        [c[2], c[3], c[7], c[6]],
        [c[3], c[0], c[4], c[7]],
    ]
}

/// The cells, and the points, to which centres may have been added.
pub fn made(block: &Block, kind: Made) -> (Vec<[f64; 3]>, Vec<Cell>) {
    let mut points = block.points.clone();
    let mut cells = Vec::new();
    for (number, c) in block.hexahedra().into_iter().enumerate() {
        let chosen = |corners: &[usize]| corners.iter().map(|i| c[*i]).collect::<Vec<_>>();
        let kind = match (kind, number % 4) {
            (Made::Mixed, 0) => Made::Hexahedra,
            (Made::Mixed, 1) => Made::Pyramids,
            (Made::Mixed, 2) => Made::Polyhedra,
            (Made::Mixed, _) => Made::Voxels,
            _ => kind,
        };
        match kind {
            Made::Hexahedra | Made::Mixed => cells.push((12, c.to_vec(), vec![])),
            Made::Voxels => cells.push((11, chosen(&[0, 1, 3, 2, 4, 5, 7, 6]), vec![])),
            Made::Wedges => {
                cells.push((13, chosen(&[0, 1, 2, 4, 5, 6]), vec![]));
                cells.push((13, chosen(&[0, 2, 3, 4, 6, 7]), vec![]));
            }
            Made::Pyramids => {
                let centre = [0, 1, 2].map(|axis| c.iter().map(|i| points[*i][axis]).sum::<f64>() / 8.0);
                points.push(centre);
                for face in faces(c) {
                    cells.push((14, [face.to_vec(), vec![points.len() - 1]].concat(), vec![]));
                }
            }
            Made::Tetrahedra => {
                // Six along the diagonal, one for each order of the axes.
                for [a, b] in [[1, 2], [2, 3], [3, 7], [7, 4], [4, 5], [5, 1]] {
                    cells.push((10, chosen(&[0, a, b, 6]), vec![]));
                }
            }
            Made::Polyhedra => {
                // Sides in whichever sense.
                let mut faces: Vec<Vec<usize>> = faces(c).iter().map(|face| face.to_vec()).collect();
                faces.iter_mut().step_by(2).for_each(|face| face.reverse());
                cells.push((42, c.to_vec(), faces));
            }
        }
    }
    (points, cells)
}

/// A field on a block, of values given by a function of place.
pub fn field(block: &Block, kind: Made, values: impl Fn([f64; 3]) -> [f64; 5]) -> Field {
    let (points, cells) = made(block, kind);
    let mut list = Cells::new();
    for (kind, corners, faces) in cells {
        let corners: Vec<u32> = corners.into_iter().map(|i| i as u32).collect();
        match kind {
            10 => list.push(Shape::Tetrahedron, &corners).unwrap(),
            11 => {
                let c = &corners;
                list.push(Shape::Hexahedron, &[c[0], c[1], c[3], c[2], c[4], c[5], c[7], c[6]]).unwrap();
            }
            12 => list.push(Shape::Hexahedron, &corners).unwrap(),
            13 => list.push(Shape::Wedge, &corners).unwrap(),
            14 => list.push(Shape::Pyramid, &corners).unwrap(),
            _ => {
                let faces: Vec<Vec<u32>> =
                    faces.into_iter().map(|face| face.into_iter().map(|i| i as u32).collect()).collect();
                list.push_polyhedron(faces.iter().map(Vec::as_slice));
            }
        }
    }
    let at: Vec<Vec3<f64>> = points.iter().map(|p| Vec3::new(p[0], p[1], p[2])).collect();
    let (field, warnings) = Field::mesh(&at, &list, &at_points(&points, values)).unwrap();
    assert!(warnings.is_empty(), "{warnings:?}");
    field
}

/// Values at points by a function of place.
pub fn at_points(points: &[[f64; 3]], values: impl Fn([f64; 3]) -> [f64; 5]) -> Values {
    let all: Vec<[f64; 5]> = points.iter().map(|point| values(*point)).collect();
    Values {
        velocity: all.iter().map(|v| Vec3::new(v[0], v[1], v[2])).collect(),
        k: all.iter().map(|v| v[3]).collect(),
        epsilon: all.iter().map(|v| v[4]).collect(),
    }
}

/// Something linear, with `k` and `ε` above one.
pub fn linear([x, y, z]: [f64; 3]) -> [f64; 5] {
    [1.0 + 2.0 * x - y, 0.5 * z - 3.0 * y, x + y + z, 4.0 + x - 2.0 * z, 3.0 - y]
}

/// Something smooth.
pub fn smooth([x, y, z]: [f64; 3]) -> [f64; 5] {
    let wave = (2.0 * x + y).sin() * (1.5 * z).cos();
    [wave, x * y * z, (x - z).exp(), 1.0 + x * x, 2.0 + (y * z).sin()]
}

/// What a field says, as a list.
pub fn numbers(local: Local) -> [f64; 5] {
    let Local { velocity: v, k, epsilon, .. } = local;
    [v.x, v.y, v.z, k, epsilon]
}

/// Points within a unit cube.
pub fn inside(count: usize) -> impl Iterator<Item = [f64; 3]> {
    (0..count).map(|i| [0, 1, 2].map(|axis| 0.5 + 0.5 * noise(7000 + 3 * i + axis)))
}

pub fn at([x, y, z]: [f64; 3]) -> Vec3<f64> {
    Vec3::new(x, y, z)
}
