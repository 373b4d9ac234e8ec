//! Spinlines that others have computed and published: `cases/published`.

use spunlaid_fibre::{Solution, Station};
use spunlaid_input::read_spinline;
use std::path::Path;

/// The steady state of a file under other settings, or the message.
fn solve(file: &str, set: &[(&str, &str)]) -> Result<Solution, String> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(file);
    let set: Vec<_> = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let line = read_spinline(&path, &set).map_err(|error| error.to_string())?;
    Ok(line.solve().map_err(|error| error.to_string())?.remove(0))
}

/// The speed at a distance from the die [m/s], linear between stations.
fn speed_at(found: &Solution, distance: f64) -> f64 {
    let above = found.stations.partition_point(|station| station.distance < distance);
    let [a, b]: [&Station; 2] = [&found.stations[above - 1], &found.stations[above]];
    a.speed + (b.speed - a.speed) * (distance - a.distance) / (b.distance - a.distance)
}

/// Each number over the published one, within a tolerance.
fn ratios(what: &str, numbers: &[(f64, f64)], tolerance: f64) {
    for (ours, theirs) in numbers {
        assert!((ours / theirs - 1.0).abs() < tolerance, "{what}: {ours} for {theirs}");
    }
}

/// A visualisation by Fraunhofer ITWM. Theirs has no friction of the air, and their speeds have four digits.
#[test]
fn published_isothermal_line_of_itwm() {
    let found = solve("published/isothermal.toml", &[]).unwrap();
    assert!((found.final_speed / 10.2 - 1.0).abs() < 1e-6);
    let end = found.solidification.distance;
    assert!((end / 1.4783 - 1.0).abs() < 1e-3, "{end}");
    let theirs = [1.076, 1.864, 2.472, 2.977, 3.415, 3.807, 4.164, 4.494, 4.802];
    let numbers: Vec<_> = (1..)
        .zip(theirs)
        .map(|(tenth, speed)| (speed_at(&found, 0.1 * f64::from(tenth) * end), speed))
        .collect();
    ratios("speed", &numbers, 1e-3);
}

/// Polyester at three godet speeds, by the equations of another group. Ours have other constants of air:
/// docs/validation.md.
#[test]
fn published_polyester_at_three_godet_speeds() {
    for (speed, die, godet, distance, stress) in [
        ("3480 m/min", 0.896, 5.28, 208.0, 15.3),
        ("3730 m/min", 0.906, 5.66, 206.0, 17.0),
        ("3980 m/min", 0.916, 6.05, 204.0, 18.9),
    ] {
        let found = solve("published/polyester.toml", &[("spinline.take_up_speed", speed)]).unwrap();
        let [die, godet] =
            [(found.force_at_die, die), (found.force_at_end, godet)].map(|(n, mn)| (n * 1e3, mn));
        let solidification = &found.solidification;
        let solid = [(solidification.distance * 1e3, distance), (solidification.stress * 1e-6, stress)];
        ratios(speed, &[die, godet, solid[0], solid[1]], 0.035);
        if speed == "3480 m/min" {
            let theirs = [(0.02, 3.21), (0.05, 22.8), (0.08, 45.1), (0.1, 52.4)];
            ratios("speed", &theirs.map(|(z, theirs)| (speed_at(&found, z), theirs)), 0.06);
        }
    }
}

/// Lines that no single tension at the die leads to: inertia outweighs viscosity, or the melt relaxes much faster
/// than it flows.
#[test]
fn invariant_lines_of_fast_growth_get_the_speed_that_is_asked_for() {
    let fast = |length, solidification, speed| {
        let set = [
            ("spinline.length", length),
            ("spinline.material.solidification_temperature", solidification),
            ("spinline.take_up_speed", speed),
            ("spinline.material.activation_energy", "1 kJ/mol"),
        ];
        solve("published/isothermal.toml", &set)
    };
    for (length, solidification, speed, value) in [
        ("1.9 m", "226.9 °C", "10.2 m/s", 10.2),
        ("2.5 m", "227 °C", "12 m/s", 12.0),
        ("1.9 m", "225 °C", "30 m/s", 30.0),
    ] {
        let found = fast(length, solidification, speed).unwrap();
        assert!((found.final_speed / value - 1.0).abs() < 1e-6, "{} for {speed}", found.final_speed);
        assert!(found.momentum_residual.abs() < 1e-6, "{}", found.momentum_residual);
    }
    // A steady state in which the thread is a melt still.
    let message = fast("1.4783 m", "200 °C", "10.2 m/s").unwrap_err();
    assert!(message.contains("still at 223 °C"), "{message}");
    let stiff = [
        ("spinline.law", "giesekus"),
        ("spinline.material.modulus", "100 MPa"),
        ("spinline.material.mobility", "0.001"),
    ];
    let [found, newtonian] = [&stiff[..], &[]].map(|set| solve("published/polyester.toml", set).unwrap());
    assert!((found.final_speed / 58.0 - 1.0).abs() < 1e-6);
    // Relaxation times of 10⁻⁵ s beside some 0.01 s of drawing: nearly Newtonian.
    assert!((found.force_at_die / newtonian.force_at_die - 1.0).abs() < 0.01);
}

#[test]
fn rejects_a_godet_that_pushes_with_the_free_speed() {
    let godet =
        |speed| solve("spinline.toml", &[("spinline.end", "take-up"), ("spinline.take_up_speed", speed)]);
    for speed in ["15 m/s", "5 m/s", "18.9 m/s"] {
        let message = godet(speed).unwrap_err();
        assert!(message.contains("without a godet it runs at 18.92 m/s"), "{message}");
    }
    assert!(godet("18.93 m/s").unwrap().force_at_end > 0.0);
}
