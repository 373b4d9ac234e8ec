//! A small field of air for the tests of files, and what is asked of it.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

use crate::meshes::{Block, Made, made, noise};
use crate::vtk::{Data, Mesh};
use spunlaid_field::{Field, Hint, Local};
use spunlaid_ground::Vec3;

/// Samples in and around a unit cube.
pub fn samples(field: &Field) -> Vec<Local> {
    let mut hint = Hint::default();
    let place = |i: usize| [0, 1, 2].map(|axis| 0.5 + 0.6 * noise(3 * i + axis));
    (0..300).map(place).map(|[x, y, z]| field.sample(Vec3::new(x, y, z), &mut hint)).collect()
}

/// Rounded so that 32 bits hold it.
fn rounded(x: f64) -> f64 {
    f64::from(x as f32)
}

/// Values at points, among them one that nobody asks for.
pub fn values(points: &[[f64; 3]]) -> Vec<Data> {
    let values =
        |value: fn([f64; 3]) -> f64| points.iter().map(|point| rounded(value(*point))).collect::<Vec<_>>();
    let velocity = points.iter().flat_map(|[x, y, z]| [1.0 + x * y, y - z, x * z].map(rounded)).collect();
    vec![
        ("p", 1, values(|[x, ..]| x)),
        ("U", 3, velocity),
        ("k", 1, values(|[x, y, _]| 1.0 + x * y)),
        ("epsilon", 1, values(|[.., z]| 2.0 + z)),
    ]
}

/// A block of one or all kinds of cells with values at its points.
pub fn mesh(kind: Made, jitter: f64) -> Mesh {
    let mut block = Block::cube(2, jitter);
    block.points.iter_mut().flatten().for_each(|x| *x = rounded(*x));
    let (points, cells) = made(&block, kind);
    let points: Vec<[f64; 3]> = points.into_iter().map(|point| point.map(rounded)).collect();
    let point_data = values(&points);
    Mesh { points, cells, point_data, cell_data: Vec::new() }
}
