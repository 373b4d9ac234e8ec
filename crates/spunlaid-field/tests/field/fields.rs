//! Fields of air: linear flows are exact, smooth flows are second order, neighbouring cells agree, and points outside
//! follow the documented rule.

use crate::meshes::{ALL, Block, Made, at, at_points, field, inside, linear, noise, numbers, smooth};
use proptest::prelude::*;
use spunlaid_field::{AirAround, Cells, Field, Hint, Shape, Values};
use spunlaid_ground::{Fault, Vec3};

type V = Vec3<f64>;

/// Largest difference from a function over points within.
fn error(field: &Field, exact: impl Fn([f64; 3]) -> [f64; 5], count: usize) -> f64 {
    let mut hint = Hint::default();
    let mut worst = 0.0_f64;
    for point in inside(count) {
        let local = field.sample(at(point), &mut hint);
        assert!(local.inside, "{point:?}");
        for (found, wanted) in numbers(local).into_iter().zip(exact(point)) {
            worst = worst.max((found - wanted).abs());
        }
    }
    worst
}

fn lattice(cells: usize, values: impl Fn([f64; 3]) -> [f64; 5]) -> Field {
    // Uneven steps.
    let axis: Vec<f64> = (0..=cells).map(|i| i as f64 / cells as f64).map(|s| s * (0.6 + 0.4 * s)).collect();
    let mut points = Vec::new();
    for z in &axis {
        for y in &axis {
            points.extend(axis.iter().map(|x| [*x, *y, *z]));
        }
    }
    Field::lattice([axis.clone(), axis.clone(), axis], &at_points(&points, values)).unwrap()
}

#[test]
fn analytic_linear_fields_are_exact_in_every_cell() {
    // Values up to 10, weights exact to a few roundings over the tetrahedron's least angle.
    let tolerance = 1e-12;
    for kind in ALL {
        for jitter in [0.0, 0.2] {
            if jitter > 0.0 && kind == Made::Voxels {
                continue;
            }
            let field = field(&Block::cube(4, jitter), kind, linear);
            let error = error(&field, linear, 2000);
            assert!(error < tolerance, "{kind:?}, {jitter}: {error:e}");
        }
    }
    let error_of_lattice = error(&lattice(4, linear), linear, 2000);
    assert!(error_of_lattice < tolerance, "lattice: {error_of_lattice:e}");
}

/// The kept values and their gradients are those of the field, as far as they reach.
#[test]
fn analytic_the_air_around_a_point_is_the_field_within_its_reach() {
    // The documented error, as a share of the largest value.
    let limit = 1e-3 * std::f64::consts::E;
    for field in [lattice(16, smooth), field(&Block::cube(16, 0.2), Made::Hexahedra, smooth)] {
        let mut hint = Hint::default();
        let mut used = 0;
        let mut worst = 0.0_f64;
        let mut beyond = 0;
        for point in inside(2000) {
            let here = field.around(at(point), &mut hint);
            assert!(here.inside, "{point:?}");
            used += u32::from(here.reach > 0.0);
            for corner in 0..9 {
                let by = [0, 1, 2].map(|axis| match corner {
                    8 => 0.0,
                    _ => here.reach * if corner >> axis & 1 == 0 { 0.999 } else { -0.999 },
                });
                let there = at([0, 1, 2].map(|axis| point[axis] + by[axis]));
                let exact = field.sample(there, &mut hint);
                if exact.inside {
                    let exact = [exact.velocity.x, exact.velocity.y, exact.velocity.z, exact.k.sqrt()];
                    let off = |(i, exact): (usize, f64)| {
                        let change: f64 = (0..3).map(|axis| here.gradients[axis][i] * by[axis]).sum();
                        (here.value[i] + change - exact).abs()
                    };
                    let off = exact.into_iter().enumerate().map(off).fold(0.0, f64::max);
                    worst = worst.max(off);
                    beyond += u32::from(off > limit);
                }
            }
        }
        // A brick with a share p of places that are beyond the limit passes its 24 probes with (1 − p)²⁴, so the
        // share of accepted places beyond it is p (1 − p)²⁴ at most: 0.0150 at p = 1/25.
        let most = 0.015 * f64::from(used) * 9.0;
        assert!(used > 1900 && worst < 5e-3, "{used} {worst:e}");
        assert!(f64::from(beyond) < most + 4.0 * most.sqrt(), "{beyond} of {most}");
    }
}

/// The air does not depend on who asked for it first. The cells have their faces where the kept values are taken.
#[test]
fn identical_air_whoever_asks_first() {
    let points: Vec<_> = inside(2000).collect();
    let asked = |order: &mut dyn Iterator<Item = usize>| {
        let field = field(&Block::cube(32, 0.0), Made::Hexahedra, smooth);
        let mut hint = Hint::default();
        let mut found = vec![AirAround::default(); points.len()];
        order.for_each(|i| found[i] = field.around(at(points[i]), &mut hint));
        found
    };
    let (forwards, backwards) = (asked(&mut (0..2000)), asked(&mut (0..2000).rev()));
    assert!(forwards.iter().all(|around| around.reach > 0.0));
    assert_eq!(forwards, backwards);
}

/// A jump of the flow just behind the face of a kept lattice is not simulated through unseen.
#[test]
fn the_reach_ends_where_the_flow_changes() {
    let rows = [vec![0.0, 1.0], vec![0.0, 0.5, 0.501, 1.0], vec![0.0, 1.0]];
    let points = rows[1].iter().flat_map(|y| [[0.0, *y, 0.0], [1.0, *y, 0.0]]).collect::<Vec<_>>();
    let points: Vec<_> =
        [0.0, 1.0].into_iter().flat_map(|z| points.iter().map(move |[x, y, _]| [*x, *y, z])).collect();
    let jet = |[_, y, _]: [f64; 3]| [if y > 0.5005 { 10.0 } else { 0.0 }, 0.0, 0.0, 0.0, 1.0];
    let field = Field::lattice(rows, &at_points(&points, jet)).unwrap();
    let mut hint = Hint::default();
    for i in 0..100 {
        let at = V::new(0.4, 0.5 - 1e-5 * f64::from(i), 0.3);
        let here = field.around(at, &mut hint);
        let there = field.sample(at + V::new(0.0, 0.999 * here.reach, 0.0), &mut hint);
        let continued = here.value[0] + 0.999 * here.reach * here.gradients[1][0];
        // A thousandth of the largest velocity, eight times that in the smallest bricks.
        assert!((there.velocity.x - continued).abs() < 8e-3 * 10.0, "{here:?} {there:?}");
    }
}

/// A jet that is thinner than the distance of the kept values is seen, because the field has points in it.
#[test]
fn a_thin_jet_is_not_missed() {
    let fine = |middle: f64| -> Vec<f64> {
        let mut row: Vec<f64> = (0..=32).map(|i| f64::from(i) / 32.0).collect();
        row.extend((-2..=2).map(|i| middle + 2e-4 * f64::from(i)));
        row.sort_by(f64::total_cmp);
        row.dedup();
        row
    };
    let rows = [vec![0.0, 1.0], fine(0.5137), fine(0.4829)];
    let jet = |[_, y, z]: [f64; 3]| {
        let far = (y - 0.5137).abs().max((z - 0.4829).abs());
        [if far < 1e-5 { 30.0 } else { 1.0 }, 0.0, 0.0, 0.0, 1.0]
    };
    let mut points = Vec::new();
    for z in &rows[2] {
        points.extend(rows[1].iter().flat_map(|y| [[0.0, *y, *z], [1.0, *y, *z]]));
    }
    let field = Field::lattice(rows, &at_points(&points, jet)).unwrap();
    let mut hint = Hint::default();
    let beside = field.around(V::new(0.5, 0.5137 + 5e-3, 0.4829), &mut hint);
    assert!((beside.value[0] - 1.0).abs() < 1e-3 * 30.0, "{beside:?}");
    let within = field.around(V::new(0.5, 0.5137, 0.4829), &mut hint);
    // In one of the smallest bricks.
    assert!((within.value[0] - 30.0).abs() < 8e-3 * 30.0, "{within:?}");
}

/// A jet whose edges are straight lines with kinks, askew to the lattice: walks in it take hardly more looks than in a
/// smooth one, and what they find differs from the field by little on average.
#[test]
fn kinks_cost_few_looks() {
    let axis = |points: usize, low: f64, high: f64| -> Vec<f64> {
        (0..points).map(|i| low + (high - low) * i as f64 / (points - 1) as f64).collect()
    };
    let walk = |profile: &dyn Fn([f64; 3]) -> f64| {
        let rows = [axis(61, 0.0, 0.6), axis(41, -0.1, 0.1), axis(21, -0.05, 0.05)];
        let mut points = Vec::new();
        for z in &rows[2] {
            points.extend(rows[1].iter().flat_map(|y| rows[0].iter().map(move |x| [*x, *y, *z])));
        }
        let values = at_points(&points, |at| [profile(at), 0.0, 0.0, 0.01, 1.0]);
        let field = Field::lattice(rows, &values).unwrap();
        let mut hint = Hint::default();
        let mut looks = 0u32;
        let mut off = 0.0;
        let mut number = 0;
        let mut random = || {
            number += 1;
            noise(number)
        };
        for _ in 0..40 {
            let mut at = [0.3 + 0.25 * random(), 0.08 * random(), 0.04 * random()];
            let mut from = at;
            let mut here = AirAround { reach: -1.0, ..AirAround::default() };
            for _ in 0..1000 {
                let moved = [0, 1, 2].map(|axis| at[axis] - from[axis]);
                if moved.iter().any(|by| by.abs() > here.reach) {
                    here = field.around(V::new(at[0], at[1], at[2]), &mut hint);
                    (from, looks) = (at, looks + 1);
                }
                let moved = [0, 1, 2].map(|axis| at[axis] - from[axis]);
                let found: f64 = here.value[0] + (0..3).map(|i| moved[i] * here.gradients[i][0]).sum::<f64>();
                off += (found - field.sample(V::new(at[0], at[1], at[2]), &mut hint).velocity.x).abs() / 40e3;
                at.iter_mut().for_each(|x| *x += 1e-4 * random());
            }
        }
        (looks, off / field.overview().speed.largest, field.memory())
    };
    let smooth = walk(&|[x, y, _]| 20.0 + 10.0 * (-(y / 0.05).powi(2)).exp() * (1.0 - 0.5 * x));
    let kinked = walk(&|[x, y, z]| {
        let edges = (1.0 - (y + 0.3 * z + 0.0031).abs() / 0.06).max(0.0);
        let bands = (1.0 - (x - 0.317 - 0.2 * y).abs() / 0.1).max(0.0);
        20.0 + 10.0 * (edges + 0.5 * bands) * (1.0 - 0.5 * x)
    });
    // One step in twenty, and bricks as many as three times those of a smooth jet.
    assert!(kinked.0 < 40_000 / 20 && kinked.2 < 3 * smooth.2, "{kinked:?} {smooth:?}");
    assert!(kinked.1 < 2e-4 && smooth.1 < 2e-4, "{kinked:?} {smooth:?}");
}

#[test]
fn order_of_interpolation_is_two() {
    // Halving the cells divides the error by four; the largest error of 2000 points varies by less than 20 %.
    let orders = |error: &dyn Fn(usize) -> f64| (error(8) / error(16)).log2();
    for kind in ALL {
        let order = orders(&|cells| error(&field(&Block::cube(cells, 0.0), kind, smooth), smooth, 2000));
        assert!((order - 2.0).abs() < 0.26, "{kind:?}: {order}");
    }
    let order = orders(&|cells| error(&lattice(cells, smooth), smooth, 2000));
    assert!((order - 2.0).abs() < 0.26, "lattice: {order}");
}

#[test]
fn invariant_hints_change_nothing() {
    for kind in [Made::Mixed, Made::Tetrahedra] {
        let field = field(&Block::cube(5, 0.2), kind, smooth);
        let mut walking = Hint::default();
        for point in inside(2000) {
            let by_walk = numbers(field.sample(at(point), &mut walking));
            let by_tree = numbers(field.sample(at(point), &mut Hint::default()));
            for (a, b) in by_walk.into_iter().zip(by_tree) {
                // The same tetrahedron, or one across a face that the point is on.
                assert!((a - b).abs() < 1e-8, "{point:?}: {a} {b}");
            }
        }
    }
}

#[test]
fn identical_along_one_path() {
    let field = field(&Block::cube(5, 0.2), Made::Mixed, smooth);
    let fly = || {
        let mut hint = Hint::default();
        (0..500)
            .map(|i| field.sample(at([0.002, 0.0017, 0.0013].map(|v| v * f64::from(i))), &mut hint))
            .collect::<Vec<_>>()
    };
    assert_eq!(fly(), fly());
}

#[test]
fn analytic_outside_of_a_lattice_its_nearest_point_counts() {
    let field = lattice(3, linear);
    let local = field.sample(V::new(-0.5, 0.25, 7.0), &mut Hint::default());
    assert!(!local.inside);
    for (found, wanted) in numbers(local).into_iter().zip(linear([0.0, 0.25, 1.0])) {
        assert!((found - wanted).abs() < 1e-12, "{found} {wanted}");
    }
}

#[test]
fn analytic_outside_of_a_mesh_its_surface_counts() {
    // A flow that is at rest at y = 0 and y = 1, as at walls.
    let still = |[_, y, _]: [f64; 3]| [y * (1.0 - y), 0.0, 0.0, y * (1.0 - y), 1.0];
    let field = field(&Block::cube(4, 0.0), Made::Hexahedra, still);
    for y in [-0.3, 1.001, 40.0] {
        let local = field.sample(V::new(0.4, y, 0.6), &mut Hint::default());
        assert_eq!((local.velocity, local.inside), (V::default(), false));
    }
    // Beyond an end it is as at the nearest point there.
    let local = field.sample(V::new(1.2, 0.45, 0.5), &mut Hint::default());
    assert_eq!((local.velocity.x, local.inside), (0.25, false));
}

#[test]
fn analytic_a_single_layer_is_a_plane_flow() {
    let axes = [vec![0.0, 1.0], vec![0.0, 1.0], vec![5.0]];
    let points = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(|[x, y]| [x, y, 5.0]);
    let plane = |[x, y, _]: [f64; 3]| [x, y, 0.0, 1.0, 1.0];
    let field = Field::lattice(axes, &at_points(&points, plane)).unwrap();
    let local = field.sample(V::new(0.25, 0.5, -100.0), &mut Hint::default());
    assert_eq!((local.velocity, local.inside), (V::new(0.25, 0.5, 0.0), true));
}

#[test]
fn analytic_cells_that_are_not_convex_are_exact() {
    // A corner pushed in beyond the plane of its neighbours, for one side and for the other.
    let mut block = Block::cube(2, 0.0);
    for corner in [0.2, 0.8] {
        block.points[13] = [corner; 3];
        let error = error(&field(&block, Made::Hexahedra, linear), linear, 3000);
        assert!(error < 1e-12, "{corner}: {error:e}");
    }
    // One that the corner of the smallest number does not see all of: it is cut from its centroid.
    let mut block = Block::cube(1, 0.0);
    block.points[1] = [0.4, 0.45, 0.45];
    for kind in [Made::Hexahedra, Made::Polyhedra] {
        let field = field(&block, kind, linear);
        let mut within = 0;
        for point in inside(3000) {
            let local = field.sample(at(point), &mut Hint::default());
            within += usize::from(local.inside);
            for (found, wanted) in numbers(local).into_iter().zip(linear(point)) {
                assert!(
                    !local.inside || (found - wanted).abs() < 1e-12,
                    "{kind:?}, {point:?}: {found} {wanted}"
                );
            }
        }
        // Its volume is 0.65; four standard errors of the count, and a sixtieth that folds over.
        let share = within as f64 / 3000.0;
        assert!((share - 0.65).abs() < 0.035 + 0.017, "{kind:?}: {share}");
    }
}

#[test]
fn warnings_count_cells_that_fold_over() {
    // The points of one face are not in order around it.
    let (points, _) = hexahedron();
    let mut cells = Cells::new();
    cells.push(Shape::Hexahedron, &[0, 1, 3, 2, 4, 5, 6, 7]).unwrap();
    let (_, warnings) = Field::mesh(&points, &cells, &still(8)).unwrap();
    let folded = "1 cell folds over itself, and the air within it is only roughly right";
    assert_eq!(warnings, [Fault::new(folded, "check the mesh")]);
    // A cell that is inside out as a whole is valid.
    let mut cells = Cells::new();
    cells.push(Shape::Hexahedron, &[4, 5, 7, 6, 0, 1, 3, 2]).unwrap();
    let (field, warnings) = Field::mesh(&points, &cells, &still(8)).unwrap();
    assert!(warnings.is_empty() && field.sample(V::new(0.1, 0.2, 0.9), &mut Hint::default()).inside);
}

fn hexahedron() -> (Vec<V>, Cells) {
    let block = Block::cube(1, 0.0);
    let mut cells = Cells::new();
    cells.push(Shape::Hexahedron, &block.hexahedra()[0].map(|i| i as u32)).unwrap();
    (block.points.iter().map(|point| at(*point)).collect(), cells)
}

fn still(points: usize) -> Values {
    Values { velocity: vec![V::default(); points], ..Values::default() }
}

#[test]
fn warnings_count_flat_cells_and_points_at_one_place() {
    let (mut points, mut cells) = hexahedron();
    cells.push(Shape::Tetrahedron, &[0, 1, 2, 3]).unwrap();
    cells.push(Shape::Tetrahedron, &[0, 0, 0, 0]).unwrap();
    points.push(points[7]);
    let mut values = still(9);
    values.velocity[8].x = 2.0;
    let (field, warnings) = Field::mesh(&points, &cells, &values).unwrap();
    let merged = "1 point lies exactly at the position of another point but has other values; the mean of \
        their values is used";
    assert_eq!(warnings, [merged, "2 cells have no volume and are left out"].map(Fault::plain));
    assert_eq!(field.sample(points[7], &mut Hint::default()).velocity.x, 1.0);
}

#[test]
fn rejects_what_is_no_field() {
    let (points, cells) = hexahedron();
    let said = |points: &[V], cells: &Cells, values: &Values| {
        Field::mesh(points, cells, values).unwrap_err().to_string()
    };
    assert_eq!(said(&points, &cells, &still(7)), "velocity: has 7 values and needs 8; is the file complete?");
    let mut wrong = still(8);
    wrong.velocity[3].y = f64::NAN;
    assert_eq!(
        said(&points, &cells, &wrong),
        "point 4: NaN is not a number between −1e30 and 1e30; correct the value, or leave out points without one"
    );
    let mut beyond = Cells::new();
    beyond.push(Shape::Tetrahedron, &[0, 1, 2, 8]).unwrap();
    assert_eq!(
        said(&points, &beyond, &still(8)),
        "cell 1: names point 8 (counted from 0), but there are 8 points; is the file complete?"
    );
    let mut flat = Cells::new();
    flat.push(Shape::Tetrahedron, &[0, 1, 2, 3]).unwrap();
    assert_eq!(
        said(&points, &flat, &still(8)),
        "has no cells with a volume; write the interior of the flow as well, and a plane flow one cell thick \
        or as a table of points"
    );
    assert_eq!(
        Cells::new().push(Shape::Wedge, &[1, 2]).unwrap_err().to_string(),
        "cell 1: a wedge has 2 points and needs 6; is the file complete?"
    );
    let said = |axes: [Vec<f64>; 3]| Field::lattice(axes, &still(4)).unwrap_err().to_string();
    assert_eq!(said([vec![0.0, 1.0], vec![1.0, 1.0], vec![0.0]]), "y: goes from 1 to 1; it must increase");
    assert_eq!(
        said([vec![0.0, f64::INFINITY], vec![0.0, 1.0], vec![0.0]]),
        "x: inf is not a number between −1e30 and 1e30; correct the value, or leave out points without one"
    );
    let few: Vec<V> = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(at).to_vec();
    assert_eq!(
        Field::points(&few, &still(3)).unwrap_err().to_string(),
        "has 3 points; at least 9 are needed for interpolation"
    );
}

proptest! {
    /// Steps of 1e-7 change the values by no more than the steepest slope allows, across faces as within.
    #[test]
    fn invariant_fields_are_continuous(
        start in prop::array::uniform3(0.01..0.99f64),
        step in prop::array::uniform3(-1e-7..1e-7f64),
        kind in 0..ALL.len(),
    ) {
        // Slopes of the interpolation are those of `smooth`, below 3, and 1/sin of the least angle more.
        let slope = 30.0;
        let next = [0, 1, 2].map(|axis| start[axis] + step[axis]);
        let jitter = if ALL[kind] == Made::Voxels || ALL[kind] == Made::Mixed { 0.0 } else { 0.2 };
        for field in [field(&Block::cube(3, jitter), ALL[kind], smooth), lattice(3, smooth)] {
            let [a, b] = [start, next].map(|point| numbers(field.sample(at(point), &mut Hint::default())));
            for (a, b) in a.into_iter().zip(b) {
                prop_assert!((a - b).abs() < slope * 2e-7, "{a} {b}");
            }
        }
    }

    /// Any point gives finite numbers, far away too.
    #[test]
    fn invariant_samples_are_finite(point in prop::array::uniform3(prop::num::f64::ANY)) {
        for field in [field(&Block::cube(2, 0.0), Made::Mixed, smooth), lattice(3, smooth)] {
            let mut hint = Hint::default();
            field.sample(at([0.5; 3]), &mut hint);
            let local = field.sample(at(point), &mut hint);
            prop_assert!(numbers(local).into_iter().all(f64::is_finite), "{local:?}");
        }
    }
}
