//! `spunlaid air --at`: the air at given places, against the formulas and the files that it comes from.

use crate::desk::{BRIEF, Desk};
use spunlaid_input::read_case;
use std::fs;
use std::path::{Path, PathBuf};

const HEADER: &str = "x_m,y_m,z_m,u_m_s,v_m_s,w_m_s,speed_m_s,k_m2_s2,length_scale_m,cutoff_frequency_hz";

fn case(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name)
}

/// The rows that the program prints for places, NaN for empty cells, and what it says of them.
fn at(case: &Path, places: &str, more: &[&str]) -> (Vec<Vec<f64>>, String) {
    let desk = Desk::new();
    fs::write(desk.path("places.csv"), places).unwrap();
    let output = desk.spunlaid("air --at places.csv").arg(case).args(more).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    let table = String::from_utf8(output.stdout).unwrap();
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some(HEADER));
    let cell = |cell: &str| if cell.is_empty() { f64::NAN } else { cell.parse().unwrap() };
    (lines.map(|line| line.split(',').map(cell).collect()).collect(), said)
}

fn assert_row(found: &[f64], expected: [f64; 7], tolerance: f64) {
    for (a, b) in found[3..].iter().zip(expected) {
        assert!((a - b).abs() <= tolerance * b.abs().max(1e-6), "{found:?} {expected:?}");
    }
}

#[test]
fn analytic_uniform_air_is_the_same_everywhere() {
    let desk = Desk::new();
    let (rows, _) = at(&desk.path("brief.toml"), "z [mm],x (cm),y_m\n-30,12,4\n0,0,0\n", &[]);
    assert_eq!((&rows[0][..3], rows.len()), (&[0.12, 4.0, -0.03][..], 2));
    // k = 1.5 (0.1 × 10 m/s)².
    rows.iter().for_each(|row| assert_row(row, [10.0, 0.0, 0.0, 10.0, 1.5, 0.05, 100.0], 1e-14));
    // A spectrum changes nothing of it, and a record gives its own numbers.
    let von_karman = ["--set", "air.spectrum=von-karman"];
    assert_row(
        &at(&desk.path("brief.toml"), "x_m,y_m,z_m\n0,0,0\n", &von_karman).0[0],
        [10.0, 0.0, 0.0, 10.0, 1.5, 0.05, 100.0],
        1e-14,
    );
    let (row, _) = at(&case("record.toml"), "x_m,y_m,z_m\n0.3,0,0\n", &[]);
    let air = read_case(&case("record.toml"), &[]).unwrap().0.air;
    let k = 1.5 * (air.turbulence_intensity * air.velocity).powi(2);
    let expected = [air.velocity, 0.0, 0.0, air.velocity, k, air.length_scale, air.cutoff_frequency];
    assert_row(&row[0], expected, 1e-12);
}

/// Without turbulence there are no eddies.
#[test]
fn analytic_still_air_has_no_eddies() {
    let desk = Desk::with_case(&BRIEF.replace("turbulence_intensity = 0.1", "turbulence_intensity = 0"));
    let (rows, _) = at(&desk.path("brief.toml"), "x_m,y_m,z_m\n0,0,0\n", &[]);
    assert_eq!(rows[0][3..8], [10.0, 0.0, 0.0, 10.0, 0.0]);
    assert!(rows[0][8].is_nan() && rows[0][9].is_nan());
}

/// Between its rows a profile is linear, and air that widens has v = −y dU/dx, theory (49a).
#[test]
fn analytic_a_profile_between_its_rows() {
    let folder = tempfile::tempdir().unwrap();
    let profile = "x_mm,velocity_m_s,turbulence_intensity,length_scale_mm,cutoff_frequency_hz\n\
        0,20,0.05,10,400\n400,12,0.15,30,100\n";
    fs::write(folder.path().join("profile.csv"), profile).unwrap();
    let own = ["velocity", "turbulence", "length_scale", "cutoff", "time_step"];
    let text: String = BRIEF.lines().filter(|line| !own.iter().any(|key| line.starts_with(key))).fold(
        String::new(),
        |text, line| match line {
            "[air]" => text + "[air]\nprofile = \"profile.csv\"\nwidening = \"md\"\nspeed_factor = 2\n",
            line => text + line + "\n",
        },
    );
    let file = folder.path().join("case.toml");
    fs::write(&file, text).unwrap();
    let (rows, said) = at(&file, "x_m,y_m,z_m\n0.1,0.02,5\n0.5,0,0\n-1,0,0\n", &[]);
    // A quarter of the way, all velocities doubled: U = 36 m/s, dU/dx = −40 1/s, Tu = 0.075, L = 15 mm.
    let (u, v) = (36.0, 0.02 * 40.0);
    let k = 1.5 * (0.075_f64 * 36.0).powi(2);
    assert_row(&rows[0], [u, v, 0.0, f64::hypot(u, v), k, 0.015, 2.0 * 325.0], 1e-12);
    assert!(rows[1..].iter().flat_map(|row| &row[3..]).all(|number| number.is_nan()), "{rows:?}");
    assert!(
        said.contains(
            "2 of 3 positions are where the air is not known, the first of them in row 2 (0.5, 0, 0 m)"
        ),
        "{said}"
    );
}

/// Points of a table of a CFD field have their own values; length and cut-off of the eddies are theory (48) and (49).
#[test]
fn identical_a_field_at_its_own_points() {
    let table = fs::read_to_string(case("fields/diffuser_core.csv")).unwrap();
    let own: Vec<Vec<f64>> = table
        .lines()
        .skip(1)
        .step_by(41)
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap()).collect())
        .collect();
    let places = own.iter().map(|row| format!("{},{},{}\n", 1e3 * row[0], 1e3 * row[1], 1e3 * row[2]));
    let places = "x [mm],y [mm],z [mm]\n".to_owned() + &places.collect::<String>() + "0,1000,0\n";
    let (rows, said) = at(&case("point_table.toml"), &places, &[]);
    assert!(own.len() > 10 && rows.len() == own.len() + 1);
    for (row, own) in rows.iter().zip(&own) {
        let [u, v, w] = [own[3], own[4], own[5]];
        let k = own[6];
        let epsilon = own[7];
        let speed = u.hypot(v).hypot(w);
        let length = 0.43 * k.powf(1.5) / epsilon;
        let cutoff = 0.25 * (speed / length + epsilon / (0.3 * k));
        assert_row(row, [u, v, w, speed, k, length, cutoff], 1e-9);
    }
    assert!(rows[own.len()][3..].iter().all(|number| number.is_nan()));
    assert!(said.contains(&format!("1 of {} positions", rows.len())), "{said}");
}

/// The middle of the diffuser of `spunbond_field.toml` is 60 m/s × 15 mm / (15 mm + 0.15 x), and v = u y/b × 0.15: 1 %
/// is what its mesh leaves. The axes of the line begin at the root.
#[test]
fn analytic_the_middle_of_a_plane_diffuser() {
    let places = "x_m,y_m,z_m\n0.1,0,0\n0.25,0.005,0\n0.4,-0.008,0.01\n";
    for axes in ["line", "field"] {
        let (rows, _) = at(&case("spunbond_field.toml"), places, &["--axes", axes]);
        for row in rows {
            let half = 0.015 + 0.15 * row[0];
            let u = 60.0 * 0.015 / half;
            assert!((row[3] / u - 1.0).abs() < 0.01, "{row:?}");
            assert!((row[4] - u * row[1] / half * 0.15).abs() < 0.01 * u, "{row:?}");
        }
    }
    // With a root elsewhere the same place has other coordinates.
    let root = ["--set", "air.field_root=[\"0.1 m\", \"5 mm\", \"0 m\"]", "--axes"];
    let [line, field] =
        [("line", "x_m,y_m,z_m\n0.2,0.003,0.01\n"), ("field", "x_m,y_m,z_m\n0.3,0.008,0.01\n")]
            .map(|(axes, places)| at(&case("spunbond_field.toml"), places, &[&root[..], &[axes]].concat()).0);
    assert_row(&line[0], std::array::from_fn(|i| field[0][3 + i]), 1e-9);
}
