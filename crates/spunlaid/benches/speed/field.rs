//! Fields of air: the cost of asking one along the way of a fibre's element.

#[path = "../../../spunlaid-field/tests/field/meshes.rs"]
mod meshes;

use crate::measure::{Trial, in_rounds, processor_time};
use crate::title;
use meshes::{Block, Made, at_points, field, noise};
use spunlaid_air::{Field, Hint};
use spunlaid_ground::Vec3;
use std::hint::black_box;

/// Cells to each side of a cube, and as many points as their corners.
const CELLS: usize = 40;
/// Samples of a trial.
const SAMPLES: usize = 2000;

fn air([x, y, z]: [f64; 3]) -> [f64; 5] {
    [10.0 - x, y * z, x * z, 1.0 + x, 2.0 + y]
}

/// Places one after the other, so many cells apart, there and back through the cube.
fn way(step: f64) -> Vec<Vec3<f64>> {
    let along = |i: usize, turn: f64| {
        let s = i as f64 * step / CELLS as f64 * turn + 0.1 * turn;
        0.02 + 0.96 * (1.0 - (s % 2.0 - 1.0).abs())
    };
    (0..SAMPLES).map(|i| Vec3::new(along(i, 0.8), along(i, 0.5), along(i, 0.3))).collect()
}

/// Nanoseconds of a sample, on each kind of field.
pub fn costs() {
    title("a sample of a field of 69 000 points [ns]: steps of 1/100 cell, of a cell, without hint, outside");
    let axis: Vec<f64> = (0..=CELLS).map(|i| i as f64 / CELLS as f64).collect();
    let block = Block::cube(CELLS, 0.2);
    let corners = at_points(&Block::cube(CELLS, 0.0).points, air);
    let anywhere: Vec<[f64; 3]> =
        (0..corners.velocity.len()).map(|i| [0, 1, 2].map(|axis| 0.5 + 0.5 * noise(3 * i + axis))).collect();
    let places: Vec<Vec3<f64>> = anywhere.iter().map(|[x, y, z]| Vec3::new(*x, *y, *z)).collect();
    let fields = [
        ("lattice", Field::lattice([axis.clone(), axis.clone(), axis], &corners).unwrap()),
        ("hexahedra", field(&block, Made::Hexahedra, air)),
        ("polyhedra", field(&block, Made::Polyhedra, air)),
        ("points", Field::points(&places, &at_points(&anywhere, air)).unwrap().0),
    ];
    let [fine, coarse] = [way(0.01), way(1.0)];
    let outside: Vec<Vec3<f64>> = fine.iter().map(|at| Vec3::new(at.x, at.y, at.z + 1.0)).collect();
    let mut trials = Vec::new();
    for (_, field) in &fields {
        for (way, hinted) in [(&fine, true), (&coarse, true), (&coarse, false), (&outside, true)] {
            trials.push(Trial::new(SAMPLES as f64, move || {
                processor_time(|| {
                    let mut hint = Hint::default();
                    for at in way {
                        black_box(field.sample(*at, &mut hint));
                        if !hinted {
                            hint = Hint::default();
                        }
                    }
                })
            }));
        }
    }
    in_rounds(&mut trials, 0.2);
    for ((name, _), of_field) in fields.iter().zip(trials.chunks(4)) {
        let costs: Vec<String> =
            of_field.iter().map(|trial| format!("{:>8.1}", trial.each() * 1e9)).collect();
        println!("  {name:<10} {}", costs.join(" "));
    }
}
