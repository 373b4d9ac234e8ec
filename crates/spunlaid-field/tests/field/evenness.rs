//! Along which axes the air of a field is the same, and its numbers over all points.

use spunlaid_field::{Field, Overview, Spread, Values};
use spunlaid_ground::Vec3;

/// A lattice of the unit cube with a velocity.
fn cube(velocity: impl Fn(f64, f64, f64) -> Vec3<f64>) -> Field {
    let row: Vec<f64> = (0..9).map(|i| f64::from(i) / 8.0).collect();
    let mut values = Values::default();
    for (z, y) in row.iter().flat_map(|z| row.iter().map(move |y| (*z, *y))) {
        values.velocity.extend(row.iter().map(|x| velocity(*x, y, z)));
    }
    Field::lattice([row.clone(), row.clone(), row], &values).unwrap()
}

/// A change of less than one hundredth of the largest is none. That of a flow that is linear in x and in y² is the
/// slope times the standard deviation of the coordinate: of 0, 1/8, .. 1 that is 0.3227, of their squares 0.3354.
#[test]
fn analytic_what_changes_by_a_hundredth_is_even() {
    let even_along_x = |slope: f64| {
        let field = cube(|x, y, _| Vec3::new(10.0 + slope * x, 2.0 * y * y, 0.0));
        assert_eq!([1, 2].map(|axis| field.is_even_along(axis)), [false, true]);
        field.is_even_along(0)
    };
    let bound = 0.01 * 2.0 * 0.3354 / 0.3227;
    assert_eq!([0.9 * bound, 1.1 * bound].map(even_along_x), [true, false]);
}

#[test]
fn the_even_axis_is_the_only_one_and_bears_what_a_solver_leaves() {
    let noise = |x: f64, y: f64, z: f64| 1e-3 * (977.0 * x + 631.0 * y + 1409.0 * z).sin();
    let flow = |x: f64, y: f64| Vec3::new(10.0 - 3.0 * x, y * y, 0.0);
    let noisy = cube(|x, y, z| flow(x, z) + Vec3::new(noise(x, y, z), 0.0, 0.0));
    assert_eq!(noisy.even_axis(), Some(1));
    // In all directions, along one only, nowhere, and as between walls that are far apart.
    for field in [
        cube(|x, y, z| flow(x, y) * (1.0 + z)),
        cube(|x, _, _| flow(x, 0.0)),
        cube(|_, _, _| flow(0.0, 0.0)),
        cube(|x, y, z| flow(x, y) * if z == 0.0 || z == 1.0 { 0.0 } else { 1.0 }),
    ] {
        assert_eq!(field.even_axis(), None);
    }
}

/// Each point counts once on a lattice: u is 0, 1, 2 along x, and v is 3 everywhere.
#[test]
fn analytic_an_overview_has_the_extremes_and_the_means_of_the_points() {
    let table = "x_m,y_m,u_m_s,v_m_s,k_m2_s2,epsilon_m2_s3\n\
                 0,0,0,3,1,5\n1,0,1,3,2,5\n2,0,2,3,3,5\n0,1,0,3,1,5\n1,1,1,3,2,5\n2,1,2,3,3,5\n";
    let (field, _) = Field::parse(table.as_bytes(), "lattice.csv").unwrap();
    let Overview { velocity, speed, k, epsilon } = field.overview();
    assert_eq!([velocity.x, velocity.y, velocity.z], [1.0, 3.0, 0.0]);
    assert_eq!((speed.least, speed.largest), (3.0, 13f64.sqrt()));
    assert!((speed.mean - (3.0 + 10f64.sqrt() + 13f64.sqrt()) / 3.0).abs() < 1e-15);
    assert_eq!(k, Spread { least: 1.0, mean: 2.0, largest: 3.0 });
    assert_eq!(epsilon, Spread { least: 5.0, mean: 5.0, largest: 5.0 });
}
