//! Fields in tables of points.

use crate::files::read;
use spunlaid_field::{Description, Field, Hint};
use spunlaid_ground::{Fault, Vec3};

/// A linear field in a table, rounded to whole metres per second and to hundredths, and air of one velocity.
#[test]
fn velocities_with_few_digits_are_reported() {
    let warnings = |decimals: usize, slope: f64| {
        let row = |i: u32| {
            let [x, y, z] = [i % 8, i / 8 % 8, i / 64].map(f64::from);
            let [u, v] = [17.0 + slope * x, slope * (y - 4.0)];
            format!("{x},{y},{z},{u:.decimals$},{v:.decimals$},0\n")
        };
        let text = format!("x,y,z,u,v,w\n{}", (0..512).map(row).collect::<String>());
        let (_, warnings) = Field::parse(text.as_bytes(), "air.csv").unwrap();
        warnings.iter().map(ToString::to_string).collect::<Vec<_>>()
    };
    let said = warnings(0, 0.37);
    assert!(
        said.len() == 1 && said[0].starts_with("has velocities in steps of 1 m/s, 5 % of the largest"),
        "{said:?}"
    );
    assert!(said[0].ends_with("write it with more digits"), "{said:?}");
    for (decimals, slope) in [(2, 0.37), (0, 0.0)] {
        assert_eq!(warnings(decimals, slope), [""; 0]);
    }
}

/// Whole steps, but for rounding, are reported if each value occurs often and a step is above a hundredth of the
/// largest.
#[test]
fn few_digits_are_whole_steps_of_values_that_occur_often() {
    let is_reported = |value: &dyn Fn(u32) -> f64| {
        let row = |i: u32| {
            let [u, v, w] = [0, 1, 2].map(|part| value(3 * i + part));
            format!("{},{},{},{u},{v},{w}\n", i % 8, i / 8 % 8, i / 64)
        };
        let text = format!("x,y,z,u,v,w\n{}", (0..512).map(row).collect::<String>());
        let (_, warnings) = Field::parse(text.as_bytes(), "air.csv").unwrap();
        warnings.iter().any(|warning| warning.message.starts_with("has velocities in steps of "))
    };
    assert!(is_reported(&|i| 0.5 * f64::from(i % 20)));
    assert!(is_reported(&|i| f64::from(i % 20) + 2e-6 * f64::from(i % 3)));
    // Each value occurs 7.96 times; steps of a hundred-and-fiftieth.
    assert!(!is_reported(&|i| f64::from(i % 193) - 96.0));
    assert!(!is_reported(&|i| f64::from(i % 151)));
}

#[test]
fn tables_of_many_programs_are_read() {
    let rows = |numbers: &str, parting: &str| -> String {
        (0..8)
            .map(|i| {
                let [x, y, z] = [i & 1, i >> 1 & 1, i >> 2];
                let row = format!("{x};{y};{z};{numbers}\n");
                row.replace(';', parting)
            })
            .collect()
    };
    let numbered =
        |text: String| -> String { text.lines().zip(1..).map(|(row, i)| format!("{i}, {row}\n")).collect() };
    for text in [
        format!("x_m,y_m,z_m,u_m_s,v_m_s,w_m_s,k_m2_s2,epsilon_m2_s3\n{}", rows("1;2;3;4;5", ",")),
        // Superscripts, as a spreadsheet writes them.
        format!(
            "x (m),y (m),z (m),u (m/s),v (m/s),w (m/s),k (m²/s²),epsilon (m²/s³)\n{}",
            rows("1;2;3;4;5", ",")
        ),
        format!(
            "nodenumber,    x-coordinate,    y-coordinate,    z-coordinate,      x-velocity,      \
            y-velocity,      z-velocity, turb-kinetic-energy,  turb-diss-rate\n{}",
            numbered(rows("1;2;3;4;5", ", "))
        ),
        format!(
            "\"Points:0\",\"Points:1\",\"Points:2\",\"U:0\",\"U:1\",\"U:2\",\"k\",\"epsilon\"\n{}",
            rows("1;2;3;4;5", ",")
        ),
        format!(
            "[Name]\nPlane 1\n\n[Data]\nX [ m ], Y [ m ], Z [ m ], Velocity u [ m s^-1 ], Velocity v [ m \
            s^-1 ], Velocity w [ m s^-1 ], Turbulence Kinetic Energy [ m^2 s^-2 ], Turbulence Eddy \
            Dissipation [ m^2 s^-3 ]\n{}",
            rows("1;2;3;4;5", ", ")
        ),
        format!(
            "X (m),Y (m),Z (m),Velocity[i] (m/s),Velocity[j] (m/s),Velocity[k] (m/s),Turbulent Kinetic \
            Energy (J/kg),Turbulent Dissipation Rate (m^2/s^3)\n{}",
            rows("1;2;3;4;5", ",")
        ),
        // The usual names come before those of other programs.
        format!("x,y,z,u,v,w,k,epsilon,Points:0,Points:1,Points:2\n{}", rows("1;2;3;4;5;7;7;7", ",")),
        format!("% x y z u v w k ep\n{}", rows("1;2;3;4;5", "   ")),
        format!(
            "% Model:              channel.mph\n% Version:            COMSOL 6.1.0.252\n\
            % Date:               May 2 2024, 10:11\n% Dimension:          3\n% Nodes:              8\n\
            % Expressions:        5\n% Description:        Velocity field, x-component, Velocity field, \
            y-component, Velocity field, z-component, Turbulent kinetic energy, Turbulent dissipation rate\n\
            % Length unit:        m\n% x                       y                        \
            z                        u (m/s)                  v (m/s)                  w \
            (m/s)                  k (m^2/s^2)              ep (m^2/s^3)\n{}",
            rows("1;2;3;4;5", "                       ")
        ),
        // Exponents of Fortran’s double precision.
        format!("x y z u v w k epsilon\n{}", rows("1.000000D+00;2.0D0;0.3D+01;4;5", " ")),
        format!("x;y;z;u;v;w;k;epsilon;\r\n{}", rows("1,0;2,0;3,0;4,0;5,0;", ";")),
        format!("x\ty\tz\tu\tv\tw\ttke\tomega\n{}", rows("100e-2;2;3;4;13.888888888888889", "\t")),
        format!(
            "\u{feff}# made by hand\nx [m],y [m],z [m],T [K],w [m/s],v [m/s],u [m/s],k,epsilon\n{}",
            rows("293;3;2;1;4;5", ",")
        ),
    ] {
        let (field, warnings) = read(text.as_bytes(), "a.csv");
        assert!(warnings.is_empty(), "{text}: {warnings:?}");
        let local = field.sample(Vec3::new(0.5, 0.25, 0.5), &mut Hint::default());
        assert_eq!(local.velocity, Vec3::new(1.0, 2.0, 3.0), "{text}");
        assert!((local.k - 4.0).abs() < 1e-12 && (local.epsilon - 5.0).abs() < 1e-12, "{text}: {local:?}");
    }
    // COMSOL's unit of length.
    let (field, _) =
        read(b"% Length unit: mm\n% x y u (m/s) v (m/s)\n0 0 1 2\n10 0 1 2\n0 10 3 2\n10 10 3 2\n", "a.txt");
    assert_eq!(field.bounds().1, Vec3::new(0.01, 0.01, 0.0));
    for (line, metres) in [
        ("% Length unit,mm", 0.01),
        ("% Length unit,cm,,", 0.1),
        ("% Length unit,dm", 1.0),
        ("% Length unit:  in", 0.254),
    ] {
        let rows = "x,y,u (m/s),v (m/s)\n0,0,1,2\n10,0,1,2\n0,10,3,2\n10,10,3,2\n";
        let (field, _) = read(format!("% Model,slot.mph\n{line}\n% {rows}").as_bytes(), "a.csv");
        assert!(
            (field.bounds().1 - Vec3::new(metres, metres, 0.0)).x.abs() < 1e-15,
            "{line}: {:?}",
            field.bounds()
        );
    }
    // A plane flow needs neither z nor w.
    let (field, _) = read(b"x,y,u,v\n0,0,1,2\n1,0,1,2\n0,1,3,2\n1,1,3,2\n", "a.csv");
    let local = field.sample(Vec3::new(0.5, 0.5, 9.0), &mut Hint::default());
    assert_eq!((local.velocity, local.inside), (Vec3::new(2.0, 2.0, 0.0), true));
    // Rows that lack any number are left out.
    let (field, warnings) =
        read(b"x,y,u,v\n0,0,1,2\n1,0,1,2\n5,5,nan,2\n0,1,3,2\n7,7,,1\n1,1,3,2\n8,8,1,\n", "a.csv");
    let without_place = |rows: &str| {
        let text = format!("x,y,u,v\n0,0,1,2\n1,0,1,2\n{rows}0,1,3,2\n1,1,3,2\n");
        let (field, warnings) = read(text.as_bytes(), "a.csv");
        assert_eq!(field.describe(), Description::Lattice { points: [2, 2, 1] });
        warnings
    };
    for (rows, said) in [
        ("nan,0,9,9\n", "the row in line 4 lacks a coordinate and is left out"),
        ("nan,0,9,9\n5,,9,9\n", "2 rows lack a coordinate and are left out; the first is in line 4"),
    ] {
        assert_eq!(without_place(rows), [Fault::plain(said)]);
    }
    let dropped = [
        "u has no number at 2 points; the first is in line 4",
        "v has no number at 1 point; it is in line 8",
    ];
    let dropped = dropped.map(|said| {
        Fault::new(
            format!("{said}. There is no air there: these points are left out"),
            "write numbers there if fibres come near",
        )
    });
    assert_eq!(warnings, dropped);
    assert_eq!(field.describe(), Description::Lattice { points: [2, 2, 1] });
}
