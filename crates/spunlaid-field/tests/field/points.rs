//! Fields of points without cells: linear flows are exact, smooth flows are second order, and the field is continuous.

use crate::meshes::{Block, Made, at, at_points, field, inside, linear, noise, numbers, smooth};
use proptest::prelude::*;
use spunlaid_field::{Description, Field, Hint};
use spunlaid_ground::Vec3;

type V = Vec3<f64>;

fn scattered(count: usize, values: impl Fn([f64; 3]) -> [f64; 5]) -> Field {
    let corners = (0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from));
    let anywhere = (0..count).map(|i| [0, 1, 2].map(|axis| 0.5 + 0.5 * noise(3 * i + axis)));
    let points: Vec<[f64; 3]> = corners.chain(anywhere).collect();
    let places: Vec<V> = points.iter().map(|point| at(*point)).collect();
    let (field, warnings) = Field::points(&places, &at_points(&points, values)).unwrap();
    assert!(warnings.is_empty() && matches!(field.describe(), Description::Points { .. }));
    field
}

#[test]
fn analytic_linear_fields_are_exact_between_points() {
    // The ridge of the fit and the condition number of the neighbours, at worst 1e2, limit the accuracy.
    let field = scattered(3000, linear);
    let mut hint = Hint::default();
    for point in inside(2000) {
        let local = field.sample(at(point), &mut hint);
        for (found, wanted) in numbers(local).into_iter().zip(linear(point)) {
            assert!(!local.inside || (found - wanted).abs() < 1e-10, "{point:?}: {found} {wanted}");
        }
    }
}

/// Nodes of a plane mesh that is stretched along the flow: hundreds of them are nearer than the next column.
#[test]
fn analytic_linear_fields_are_exact_between_columns_far_apart() {
    for (columns, rows, growth) in [(12, 400, 2.5_f64), (30, 201, 0.0), (6, 1500, 3.0)] {
        let points: Vec<[f64; 3]> = (0..columns * rows)
            .map(|i| {
                let x = (i / rows) as f64 / (columns - 1) as f64;
                let s = 2.0 * (i % rows) as f64 / (rows - 1) as f64 - 1.0;
                let y = if growth > 0.0 { (growth * s).tanh() / growth.tanh() } else { s };
                [x, (0.02 + 0.01 * x) * y, 0.0]
            })
            .collect();
        let places: Vec<V> = points.iter().map(|point| at(*point)).collect();
        let (field, _) = Field::points(&places, &at_points(&points, linear)).unwrap();
        let mut between = 0;
        for [x, y, _] in inside(1000) {
            let point = [x, (0.02 + 0.01 * x) * (1.9 * y - 0.95), 0.0];
            let local = field.sample(at(point), &mut Hint::default());
            between += usize::from(local.inside);
            for (found, wanted) in numbers(local).into_iter().zip(linear(point)) {
                assert!(!local.inside || (found - wanted).abs() < 1e-9, "{point:?}: {found} {wanted}");
            }
        }
        assert!(between > 950, "{columns} x {rows}: {between}");
    }
}

/// A flow in a diffuser with a layer at its walls, and places in it.
#[derive(Clone, Copy)]
struct Diffuser {
    /// Nodes along it, across it and in depth; one node in depth is a plane flow.
    size: [usize; 3],
    /// Power of the profile across it: small next to walls, 2 in a jet that fills it.
    power: f64,
    /// How much closer the nodes stand at the walls.
    growth: f64,
}

impl Diffuser {
    fn half(x: f64) -> f64 {
        0.05 + 0.04 * x
    }

    fn place(self, [x, s, t]: [f64; 3]) -> [f64; 3] {
        let closer = |s: f64| (self.growth * (2.0 * s - 1.0)).tanh() / self.growth.tanh();
        [x, Self::half(x) * closer(s), if self.size[2] > 1 { 0.05 * closer(t) } else { 0.0 }]
    }

    /// Nodes, x first.
    fn nodes(self) -> Vec<[f64; 3]> {
        let [nx, ny, nz] = self.size;
        let share = |i: usize, n: usize| i as f64 / (n.max(2) - 1) as f64;
        let node = |i: usize| self.place([share(i % nx, nx), share(i / nx % ny, ny), share(i / nx / ny, nz)]);
        (0..nx * ny * nz).map(node).collect()
    }

    fn air(self, [x, y, z]: [f64; 3]) -> [f64; 5] {
        let across = |s: f64| (1.0 - s.abs().min(1.0)).powf(self.power);
        let u = across(y / Self::half(x)) * across(z / 0.05) * 0.05 / Self::half(x);
        [u, u * 0.04 * y / Self::half(x), 0.0, 1.0 + u, 2.0 - u]
    }

    /// Root mean square of the error of the velocity, over the largest velocity.
    fn error(self, field: &Field) -> f64 {
        let wrong = inside(4000).map(|[x, s, t]| {
            let place = self.place([x, 0.01 + 0.98 * s, 0.01 + 0.98 * t]);
            let local = field.sample(at(place), &mut Hint::default());
            assert!(local.inside, "{place:?}");
            (local.velocity.x - self.air(place)[0]).powi(2)
        });
        (wrong.sum::<f64>() / 4000.0).sqrt()
    }
}

/// The table of the nodes of a mesh is about as exact as the mesh: a plane flow in triangles, a flow in space with
/// neighbours on all sides.
#[test]
fn analytic_tables_of_stretched_nodes_are_as_exact_as_their_meshes() {
    let cases = [
        ([60, 41, 1], 1.0 / 7.0, 0.1, 1.02),
        ([60, 41, 1], 1.0 / 7.0, 1.0, 1.02),
        ([30, 201, 1], 2.0, 1.5, 1.0),
        ([12, 201, 1], 2.0, 1.5, 1.0),
        ([10, 31, 31], 2.0, 1.5, 2.5),
        ([20, 31, 31], 1.0 / 7.0, 0.1, 1.0),
    ];
    for (size, power, growth, most) in cases {
        let flow = Diffuser { size, power, growth };
        let nodes = flow.nodes();
        let places: Vec<V> = nodes.iter().map(|node| at(*node)).collect();
        let (table, _) = Field::points(&places, &at_points(&nodes, |place| flow.air(place))).unwrap();
        let is_plane = size[2] == 1;
        let points = match is_plane {
            true => {
                [-1.0, 1.0].iter().flat_map(|z| nodes.iter().map(move |[x, y, _]| [*x, *y, *z])).collect()
            }
            false => nodes,
        };
        let block = Block { size: [size[0], size[1], size[2].max(2)], points };
        let in_plane = |[x, y, z]: [f64; 3]| flow.air([x, y, if is_plane { 0.0 } else { z }]);
        let mesh = field(&block, Made::Hexahedra, in_plane);
        let [of_table, of_mesh] = [&table, &mesh].map(|field| flow.error(field));
        assert!(of_table < most * of_mesh, "{size:?}: table {of_table}, mesh {of_mesh}");
    }
}

#[test]
fn analytic_linear_fields_are_exact_between_points_in_columns() {
    // As in a boundary layer: the nearest neighbours of a point all stand in one column, 100 times as close.
    let points: Vec<[f64; 3]> = (0..8 * 8 * 40)
        .map(|i| {
            let column = [0, 1].map(|axis| 0.02 * noise(2 * (i / 40) + axis));
            [
                (i / 40 % 8) as f64 / 7.0 + column[0],
                (i % 40) as f64 / 1000.0,
                (i / 320) as f64 / 7.0 + column[1],
            ]
        })
        .collect();
    let places: Vec<V> = points.iter().map(|point| at(*point)).collect();
    let (field, _) = Field::points(&places, &at_points(&points, linear)).unwrap();
    let mut between = 0;
    for [x, y, z] in inside(1000) {
        let point = [0.1 + 0.8 * x, 0.039 * y, 0.1 + 0.8 * z];
        let local = field.sample(at(point), &mut Hint::default());
        between += usize::from(local.inside);
        for (found, wanted) in numbers(local).into_iter().zip(linear(point)) {
            // The ridge matters more in a direction with few neighbours: 1e-13 over 1e-2, times 10.
            assert!(!local.inside || (found - wanted).abs() < 1e-9, "{point:?}: {found} {wanted}");
        }
    }
    assert!(between > 900, "{between}");
}

#[test]
fn order_between_points_is_two() {
    // Eight times as many points are twice as close. Mean errors, because the gaps between random points vary.
    let mean = |count: usize| {
        let field = scattered(count, smooth);
        let mut hint = Hint::default();
        // Away from the edge, where neighbours are on one side only.
        let within = inside(4000).filter(|point| point.iter().all(|x| (0.2..0.8).contains(x)));
        let errors: Vec<f64> = within
            .map(|point| (numbers(field.sample(at(point), &mut hint))[0] - smooth(point)[0]).abs())
            .collect();
        errors.iter().sum::<f64>() / errors.len() as f64
    };
    let order = (mean(2000) / mean(16000)).log2();
    assert!((order - 2.0).abs() < 0.3, "{order}");
}

#[test]
fn analytic_outside_of_points_the_nearest_counts() {
    let field = scattered(500, linear);
    let local = field.sample(V::new(2.0, 3.0, 2.0), &mut Hint::default());
    assert_eq!((numbers(local), local.inside), (linear([1.0; 3]), false));
    // An empty ball among the points.
    let hollow = inside(3000).filter(|point| (at(*point) - at([0.5; 3])).norm() > 0.4);
    let points: Vec<[f64; 3]> = hollow.collect();
    let places: Vec<V> = points.iter().map(|point| at(*point)).collect();
    let (field, _) = Field::points(&places, &at_points(&points, linear)).unwrap();
    let centre = at([0.5; 3]);
    let nearest =
        places.iter().min_by(|a, b| (**a - centre).norm().total_cmp(&(**b - centre).norm())).unwrap();
    let local = field.sample(centre, &mut Hint::default());
    assert_eq!((numbers(local), local.inside), (linear([nearest.x, nearest.y, nearest.z]), false));
}

#[test]
fn identical_points_in_any_order_are_a_lattice() {
    let axes = [vec![0.0, 0.1, 0.5, 1.0], vec![-1.0, 2.0, 2.5], vec![0.0, 1.0]];
    let mut points = Vec::new();
    for z in &axes[2] {
        for y in &axes[1] {
            points.extend(axes[0].iter().map(|x| [*x, *y, *z]));
        }
    }
    let lattice = Field::lattice(axes, &at_points(&points, smooth)).unwrap();
    points.sort_by(|a, b| {
        noise((a[0] * 640.0 + a[1] * 10.0 + a[2]) as usize)
            .total_cmp(&noise((b[0] * 640.0 + b[1] * 10.0 + b[2]) as usize))
    });
    let places: Vec<V> = points.iter().map(|point| at(*point)).collect();
    let (found, _) = Field::points(&places, &at_points(&points, smooth)).unwrap();
    assert_eq!(found.describe(), lattice.describe());
    for point in inside(200) {
        let a = found.sample(at(point), &mut Hint::default());
        let b = lattice.sample(at(point), &mut Hint::default());
        assert_eq!(a, b);
    }
}

#[test]
fn invariant_fields_between_points_are_continuous() {
    let field = scattered(300, smooth);
    let mut hint = Hint::default();
    // Along a line, finer and finer: the largest jump falls with the step.
    let jump = |steps: usize| {
        let along = (0..=steps).map(|i| 0.2 + 0.6 * i as f64 / steps as f64);
        let values: Vec<f64> =
            along.map(|s| field.sample(V::new(s, 0.5, 1.0 - s), &mut Hint::default()).velocity.x).collect();
        values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max)
    };
    field.sample(V::default(), &mut hint);
    assert!(jump(100_000) < 0.02 * jump(1000), "{} {}", jump(100_000), jump(1000));
}

#[test]
fn analytic_points_in_a_plane_are_a_plane_flow() {
    let plane = |[x, y, _]: [f64; 3]| [x, y, 0.0, 1.0, 1.0];
    let points: Vec<[f64; 3]> = (0..400).map(|i| [0.5 * noise(2 * i), 0.5 * noise(2 * i + 1), 5.0]).collect();
    let places: Vec<V> = points.iter().map(|point| at(*point)).collect();
    let (field, _) = Field::points(&places, &at_points(&points, plane)).unwrap();
    let local = field.sample(V::new(0.25, 0.125, 0.0), &mut Hint::default());
    assert!(local.inside && (local.velocity - V::new(0.25, 0.125, 0.0)).norm() < 1e-10, "{local:?}");
}

proptest! {
    /// Any place gives finite numbers, also far away.
    #[test]
    fn invariant_samples_are_finite(place in prop::array::uniform3(prop::num::f64::ANY)) {
        let local = scattered(50, smooth).sample(at(place), &mut Hint::default());
        prop_assert!(numbers(local).into_iter().all(f64::is_finite), "{local:?}");
    }
}
