//! Fields from files: the field does not depend on the encoding or on the program that wrote it.

use crate::air::{mesh, samples, values};
use crate::meshes;
use crate::meshes::Made;
use crate::vtk::{ASCII, Data, DataPlace, Legacy, Mesh, Squeeze, Style, legacy, vti, vtr, vts, vtu};
use spunlaid_field::{Description, Field, Hint, Local};
use spunlaid_ground::{Fault, Vec3};
use std::path::Path;

pub fn read(bytes: &[u8], name: &str) -> (Field, Vec<Fault>) {
    Field::parse(bytes, name).unwrap_or_else(|error| panic!("{error}"))
}

fn styles() -> Vec<Style> {
    let mut styles = Vec::new();
    for place in [DataPlace::Ascii, DataPlace::Inline, DataPlace::AppendedRaw, DataPlace::AppendedBase64] {
        for squeeze in [Squeeze::None, Squeeze::Zlib, Squeeze::Lz4] {
            for (big_endian, wide_header, float, integer) in [
                (false, false, "Float64", "Int64"),
                (true, true, "Float32", "Int32"),
                (false, true, "Float32", "UInt8"),
            ] {
                styles.push(Style { place, squeeze, big_endian, wide_header, float, integer, ..ASCII });
            }
        }
    }
    styles
}

#[test]
fn identical_in_every_encoding_of_an_unstructured_grid() {
    for kind in [Made::Mixed, Made::Wedges, Made::Tetrahedra] {
        let mesh = mesh(kind, 0.0);
        let (plain, warnings) = read(&vtu(std::slice::from_ref(&mesh), ASCII), "a.vtu");
        assert!(warnings.is_empty() && plain.has_turbulence(), "{warnings:?}");
        assert!(samples(&plain).iter().any(|local| local.inside));
        for style in styles() {
            let (field, _) = read(&vtu(std::slice::from_ref(&mesh), style), "a.vtu");
            assert_eq!(samples(&field), samples(&plain), "{style:?}");
        }
        for integer in ["Int16", "UInt16", "UInt32", "UInt64", "Float64"] {
            let style = Style { place: DataPlace::Inline, integer, ..ASCII };
            let (field, _) = read(&vtu(std::slice::from_ref(&mesh), style), "a.vtu");
            assert_eq!(samples(&field), samples(&plain), "{style:?}");
        }
        for version in ["2.0", "3.0", "5.1"] {
            for binary in [false, true] {
                let (field, _) = read(&legacy(&mesh, version, binary), "a.vtk");
                assert_eq!(samples(&field), samples(&plain), "{version}, {binary}");
            }
        }
    }
}

#[test]
fn identical_in_every_encoding_of_a_grid() {
    let axes = [vec![0.0, 0.25, 0.5, 0.75, 1.0], vec![0.0, 0.5, 1.0], vec![-0.5, 0.5]];
    let mut points = Vec::new();
    for z in &axes[2] {
        for y in &axes[1] {
            points.extend(axes[0].iter().map(|x| [*x, *y, *z]));
        }
    }
    let data = values(&points);
    let size = [5, 3, 2];
    let origin = [0.0, 0.0, -0.5];
    let spacing = [0.25, 0.5, 1.0];
    let (plain, _) = read(&vtr(&axes, [&data, &[]], ASCII), "a.vtr");
    assert_eq!(plain.describe(), Description::Lattice { points: size });
    for style in styles() {
        let image = vti(size, origin, spacing, [&data, &[]], style);
        for bytes in [vtr(&axes, [&data, &[]], style), image] {
            assert_eq!(samples(&read(&bytes, "a.vti").0), samples(&plain), "{style:?}");
        }
    }
    // The same as a table, its rows in any order and in millimetres.
    let mut rows: Vec<String> = (0..points.len())
        .map(|i| {
            let numbers: Vec<String> = data[1].2[3 * i..3 * i + 3].iter().map(ToString::to_string).collect();
            let [x, y, z] = points[i].map(|x| 1e3 * x);
            format!("{x},{y},{z},{},{},{}\n", numbers.join(","), data[2].2[i], data[3].2[i])
        })
        .collect();
    rows.reverse();
    rows.swap(3, 17);
    let table = format!("x_mm,y_mm,z_mm,u_m_s,v_m_s,w_m_s,k_m2_s2,epsilon_m2_s3\n{}", rows.concat());
    assert_eq!(samples(&read(table.as_bytes(), "a.csv").0), samples(&plain));
    for binary in [false, true] {
        let mut image = Legacy::new("3.0", binary, "STRUCTURED_POINTS");
        image.line("DIMENSIONS 5 3 2").line("ORIGIN 0 0 -0.5").line("ASPECT_RATIO 0.25 0.5 1");
        let mut rectilinear = Legacy::new("3.0", binary, "RECTILINEAR_GRID");
        rectilinear.line("DIMENSIONS 5 3 2");
        for (axis, name) in axes.iter().zip(["X", "Y", "Z"]) {
            rectilinear.line(&format!("{name}_COORDINATES {} float", axis.len())).numbers(axis, "Float32");
        }
        for file in [&mut image, &mut rectilinear] {
            let bytes = file.data("POINT_DATA", points.len(), &data).finish();
            assert_eq!(samples(&read(&bytes, "a.vtk").0), samples(&plain), "{binary}");
        }
    }
    // Curved grids are meshes, of hexahedra.
    let (plain, _) = read(&vts(size, &points, [&data, &[]], ASCII), "a.vts");
    assert_eq!(plain.describe(), Description::Mesh { points: 30, cells: 8 });
    for style in styles() {
        assert_eq!(
            samples(&read(&vts(size, &points, [&data, &[]], style), "a.vts").0),
            samples(&plain),
            "{style:?}"
        );
    }
    for binary in [false, true] {
        let mut file = Legacy::new("4.2", binary, "STRUCTURED_GRID");
        file.line("DIMENSIONS 5 3 2").line("POINTS 30 double").numbers(points.as_flattened(), "Float64");
        let bytes = file.data("POINT_DATA", 30, &data).finish();
        assert_eq!(samples(&read(&bytes, "a.vtk").0), samples(&plain));
    }
}

#[test]
fn identical_in_pieces() {
    let whole = mesh(Made::Hexahedra, 0.0);
    // Each cell as a piece of its own, with its own copy of its points.
    let pieces: Vec<Mesh> = whole
        .cells
        .iter()
        .map(|(kind, corners, _)| Mesh {
            points: corners.iter().map(|i| whole.points[*i]).collect(),
            cells: vec![(*kind, (0..8).collect(), vec![])],
            point_data: (whole.point_data.iter())
                .map(|(name, n, all)| {
                    (*name, *n, corners.iter().flat_map(|i| all[i * n..i * n + n].to_vec()).collect())
                })
                .collect(),
            cell_data: Vec::new(),
        })
        .collect();
    let (one, _) = read(&vtu(&[whole], ASCII), "a.vtu");
    let (many, warnings) = read(&vtu(&pieces, ASCII), "a.vtu");
    assert!(warnings.is_empty(), "{warnings:?}");
    for (a, b) in samples(&one).into_iter().zip(samples(&many)).filter(|(a, _)| a.inside) {
        // Cells are cut by the numbers of their points, which are others: linear parts agree.
        assert!((a.velocity.y - b.velocity.y).abs() < 1e-12 && (a.epsilon - b.epsilon).abs() < 1e-12);
    }
}

/// A plane image or rectilinear grid of 5 by 3 points, as a whole or in pieces of these columns of points.
fn plane(image: bool, pieces: &[[usize; 2]]) -> String {
    // Steps whose multiples are rounded.
    let at = |i: usize| 0.3 + 0.1 * i as f64;
    let part = |[from, to]: [usize; 2]| {
        let axes = [(from..=to).map(at).collect(), vec![0.0, 0.7, 1.4], vec![0.0]];
        let points: Vec<[f64; 3]> =
            axes[1].iter().flat_map(|y| axes[0].iter().map(move |x| [*x, *y, 0.0])).collect();
        let data = values(&points);
        let size = [to - from + 1, 3, 1];
        let bytes = if image {
            vti(size, [0.3, 0.0, 0.0], [0.1, 0.7, 1.0], [&data, &[]], ASCII)
        } else {
            vtr(&axes, [&data, &[]], ASCII)
        };
        let text = String::from_utf8(bytes).unwrap();
        let extent = format!("Piece Extent=\"{from} {to} 0 2 0 0\"");
        text.replace(&format!("Piece Extent=\"0 {} 0 2 0 0\"", to - from), &extent)
    };
    let whole = part([0, 4]);
    let (head, rest) = whole.split_once("<Piece").unwrap();
    let (_, tail) = rest.split_once("</Piece>").unwrap();
    let body = |columns: &[usize; 2]| {
        let text = part(*columns);
        let (_, rest) = text.split_once("<Piece").unwrap();
        format!("<Piece{}</Piece>", rest.split_once("</Piece>").unwrap().0)
    };
    format!("{head}{}{tail}", pieces.iter().map(body).collect::<String>())
}

#[test]
fn identical_plane_flows_in_pieces_without_gaps() {
    for image in [true, false] {
        let (one, _) = read(plane(image, &[[0, 4]]).as_bytes(), "a.vti");
        assert_eq!(one.describe(), Description::Lattice { points: [5, 3, 1] });
        for pieces in [&[[0, 2], [2, 4]][..], &[[3, 4], [0, 1], [1, 3]], &[[0, 3], [1, 4]]] {
            let (many, warnings) = read(plane(image, pieces).as_bytes(), "a.vti");
            assert!(warnings.is_empty(), "{warnings:?}");
            assert_eq!(many.describe(), one.describe());
            assert_eq!(samples(&many), samples(&one), "{pieces:?}");
        }
        // Between the second and the fourth column of points is no cell.
        let (gap, _) = read(plane(image, &[[0, 1], [3, 4]]).as_bytes(), "a.vti");
        assert_eq!(gap.describe(), Description::Mesh { points: 12, cells: 4 });
        assert_eq!(gap.plane_axis(), Some(2));
    }
}

/// Structured grids of one point along each of the axes: u = 2 + x + 3 y + 5 z.
#[test]
fn analytic_grids_of_one_point_along_an_axis_are_plane_flows() {
    for axis in 0..3 {
        let (mut size, mut at) = ([3, 4, 5], [0.75, 1.25, 2.5]);
        (size[axis], at[axis]) = (1, 0.0);
        let place = |i: usize| [i % size[0], i / size[0] % size[1], i / size[0] / size[1]];
        let points: Vec<[f64; 3]> = (0..size.iter().product()).map(|i| place(i).map(|i| i as f64)).collect();
        let speed = |[x, y, z]: [f64; 3]| 2.0 + x + 3.0 * y + 5.0 * z;
        let data = [("U", 3, points.iter().flat_map(|at| [speed(*at), 0.0, 0.0]).collect())];
        let (field, _) = read(&vts(size, &points, [&data, &[]], ASCII), "a.vts");
        assert_eq!(field.plane_axis(), Some(axis));
        let local = field.sample(Vec3::new(at[0], at[1], at[2]), &mut Hint::default());
        assert!(local.inside && (local.velocity.x - speed(at)).abs() < 1e-12, "{axis}: {local:?}");
    }
}

#[test]
fn analytic_values_of_cells_are_the_mean_at_points() {
    // Two cubes side by side with 1 and 3 m/s: 2 m/s between them.
    let points: Vec<[f64; 3]> =
        (0..12).map(|i| [(i % 3) as f64, (i / 3 % 2) as f64, (i / 6) as f64]).collect();
    let cell = |x: usize| (12, [0, 1, 4, 3, 6, 7, 10, 9].map(|i| i + x).to_vec(), vec![]);
    let mesh = Mesh {
        points: points.clone(),
        // A face of the boundary between them, whose value is ignored.
        cells: vec![cell(0), (9, vec![0, 3, 9, 6], vec![]), cell(1)],
        point_data: Vec::new(),
        cell_data: vec![("U", 3, vec![1.0, 0.0, 0.0, 99.0, 99.0, 99.0, 3.0, 0.0, 0.0])],
    };
    let check = |field: &Field| {
        for (x, u) in [(0.0, 1.0), (0.5, 1.5), (1.0, 2.0), (2.0, 3.0)] {
            let local = field.sample(Vec3::new(x, 0.5, 0.5), &mut Hint::default());
            assert!((local.velocity.x - u).abs() < 1e-12 && local.inside, "{x}: {local:?}");
        }
    };
    for bytes in [vtu(std::slice::from_ref(&mesh), ASCII), legacy(&mesh, "3.0", true)] {
        let (field, warnings) = read(&bytes, "a.vtu");
        check(&field);
        let [of_cells, flat] = warnings.as_slice() else { panic!("{warnings:?}") };
        assert!(of_cells.to_string().contains("the values are given at cells; each point gets the mean"));
        assert_eq!(
            flat.message,
            "1 cell is a point, a line or a face, perhaps of the boundary; it is left out"
        );
    }
    let data = [("U", 3, vec![1.0, 0.0, 0.0, 3.0, 0.0, 0.0])];
    check(&read(&vti([3, 2, 2], [0.0; 3], [1.0; 3], [&[], &data], ASCII), "a.vti").0);
    check(&read(&vts([3, 2, 2], &points, [&[], &data], ASCII), "a.vts").0);
    // A plane image has cells too.
    check(&read(&vti([3, 2, 1], [0.0; 3], [1.0; 3], [&[], &data], ASCII), "a.vti").0);
}

#[test]
fn analytic_epsilon_is_from_omega() {
    let ones = |x: f64| vec![x; 8];
    let data = [("velocity", 3, vec![0.0; 24]), ("TKE", 1, ones(2.0)), ("Omega", 1, ones(100.0))];
    let (field, _) = read(&vti([2, 2, 2], [0.0; 3], [1.0; 3], [&data, &[]], ASCII), "a.vti");
    let local = field.sample(Vec3::new(0.5, 0.5, 0.5), &mut Hint::default());
    assert!(field.has_turbulence());
    assert_eq!((local.k, local.epsilon), (2.0, 0.09 * 2.0 * 100.0));
    // k alone does not make turbulence.
    let (field, _) = read(&vti([2, 2, 2], [0.0; 3], [1.0; 3], [&data[..2], &[]], ASCII), "a.vti");
    assert_eq!(field.sources(), [("velocity", "velocity".to_owned())]);
    assert!(!field.has_turbulence() && field.sample(Vec3::default(), &mut Hint::default()).k == 0.0);
    // Negative values become zero, with a warning.
    let data = [
        ("U", 3, vec![0.0; 24]),
        ("k", 1, [vec![-1e-9], ones(1.0)[1..].to_vec()].concat()),
        ("epsilon", 1, ones(1.0)),
    ];
    let (field, warnings) = read(&vti([2, 2, 2], [0.0; 3], [1.0; 3], [&data, &[]], ASCII), "a.vti");
    assert_eq!(warnings, [Fault::plain("k is negative at 1 point; zero is used there")]);
    assert_eq!(field.sample(Vec3::default(), &mut Hint::default()).k, 0.0);
}

/// The velocity and turbulence at the middle of a cube, from arrays of eight equal values.
fn by_names(names: &[(&'static str, usize)]) -> Result<Local, String> {
    let data: Vec<Data> = (names.iter().zip(1..))
        .map(|((name, n), i)| (*name, *n, (0..8 * n).map(|j| f64::from(i) + (j % n) as f64 / 8.0).collect()))
        .collect();
    let bytes = vti([2, 2, 2], [0.0; 3], [1.0; 3], [&data, &[]], ASCII);
    let (field, _) = Field::parse(&bytes, "a.vti").map_err(|error| error.to_string())?;
    Ok(field.sample(Vec3::new(0.5, 0.5, 0.5), &mut Hint::default()))
}

#[test]
fn names_of_many_programs_are_known() {
    let vector = |i: f64| Vec3::new(i, i + 0.125, i + 0.25);
    for (names, velocity, k, epsilon) in [
        (&[("p", 1), ("U", 3), ("k", 1), ("epsilon", 1)][..], vector(2.0), 3.0, 4.0),
        (&[("Velocity", 3), ("TKE", 1), ("turb-diss-rate", 1)][..], vector(1.0), 2.0, 3.0),
        // The mean comes before the instantaneous velocity, in any order.
        (&[("U", 3), ("UMean", 3)][..], vector(2.0), 0.0, 0.0),
        (&[("x-velocity", 1), ("y-velocity", 1), ("z-velocity", 1)][..], Vec3::new(1.0, 2.0, 3.0), 0.0, 0.0),
        (&[("Velocity_Z", 1), ("Velocity_X", 1), ("Velocity_Y", 1)][..], Vec3::new(2.0, 3.0, 1.0), 0.0, 0.0),
        (&[("u", 1), ("v", 1), ("w", 1), ("k", 1)][..], Vec3::new(1.0, 2.0, 3.0), 0.0, 0.0),
        (&[("Ux", 1), ("Uy", 1), ("Uz", 1)][..], Vec3::new(1.0, 2.0, 3.0), 0.0, 0.0),
        (
            &[("Velocity[i] (m/s)", 1), ("Velocity[j] (m/s)", 1), ("Velocity[k] (m/s)", 1)][..],
            Vec3::new(1.0, 2.0, 3.0),
            0.0,
            0.0,
        ),
        (&[("Velocity [cm s^-1]", 3)][..], vector(1.0) * 0.01, 0.0, 0.0),
        // An array of three components is the vorticity, not ω.
        (&[("U", 3), ("omega", 3), ("k", 1)][..], vector(1.0), 0.0, 0.0),
    ] {
        let local = by_names(names).unwrap();
        assert_eq!((local.velocity, local.k, local.epsilon), (velocity, k, epsilon), "{names:?}");
    }
    assert_eq!(
        by_names(&[("p", 1), ("T", 1), ("uU", 3)]).unwrap_err(),
        "a.vti: none of the arrays is a velocity (p, T and uU); write air.field_velocity = \"uU\" if this is it"
    );
    assert_eq!(
        by_names(&[("U [furlong]", 3)]).unwrap_err(),
        "a.vti: U [furlong]: has the unit \"furlong\"; write the values in m/s, cm/s or mm/s"
    );
}

#[test]
fn real_files_are_read() {
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures");
    let mut count = 0;
    let mut names: Vec<_> =
        std::fs::read_dir(&fixtures).unwrap().map(|entry| entry.unwrap().path()).collect();
    names.sort();
    for path in names {
        let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
        if !matches!(extension, "vtu" | "vti" | "vts" | "vtr" | "vtk") {
            continue;
        }
        let (field, _) = Field::read(&path).unwrap_or_else(|error| panic!("{error}"));
        assert!(field.has_turbulence(), "{path:?}");
        // All hold the same linear field on or around a unit cube, in 32 bits at the least.
        let mut hint = Hint::default();
        for i in 0..100 {
            let [x, y, z] = [0, 1, 2].map(|axis| 0.5 + 0.4 * meshes::noise(3 * i + axis));
            let local = field.sample(Vec3::new(x, y, z), &mut hint);
            let wanted = Vec3::new(1.0 + x, 2.0 * y - z, x + y + z);
            assert!(local.inside, "{path:?}");
            assert!((local.velocity - wanted).norm() < 1e-5, "{path:?}: {local:?} {wanted:?}");
            assert!(
                (local.k - (1.0 + z)).abs() < 1e-5 && (local.epsilon - (2.0 + y)).abs() < 1e-5,
                "{path:?}"
            );
        }
        count += 1;
    }
    assert!(count >= 12, "only {count} files were found");
}

/// Air through the section of a diffuser at `x` [m³/s], of midpoints of small squares.
fn flow(field: &Field, x: f64, half_height: f64) -> f64 {
    let mut hint = Hint::default();
    let along = |i: usize, half: f64| half * ((2 * i + 1) as f64 / 200.0 - 1.0);
    let mut sum = 0.0;
    for i in 0..200 {
        for j in 0..200 {
            let local = field.sample(Vec3::new(x, along(i, half_height), along(j, 0.1)), &mut hint);
            assert!(local.inside && local.k >= 0.0 && local.epsilon > 0.0, "{x}: {local:?}");
            sum += local.velocity.x;
        }
    }
    sum * 4.0 * half_height * 0.1 / 40_000.0
}

#[test]
fn analytic_as_much_air_through_every_section_of_the_diffusers() {
    let fields = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/fields");
    // By the trapezoidal rule over points at −cos(πi/n), 1 − η⁸ loses 0.50 % of its mean with 19 of them, 1.12 % with
    // 13: diagonals change that by little. The table has 13 and 9 of them, of which gradients make more or less than
    // the 3.6 % that straight lines would lose. The wall function leaves the air between a wall and the first
    // point, a fiftieth of the height on each side, at half of its velocity: 2 %.
    for (file, flow_kept, tolerance) in [
        ("diffuser.vtu", 0.98382, 0.001),
        ("diffuser.csv", 1.0, 0.036),
        ("openfoam_diffuser.vtu", 0.99, 0.011),
    ] {
        let (field, warnings) = Field::read(&fields.join(file)).unwrap();
        assert!(warnings.is_empty() && field.has_turbulence(), "{file}: {warnings:?}");
        for x in [0.1, 0.4, 0.7, 1.0, 1.19] {
            // Flat facets lie within curved walls, and rounded ones too.
            let half_height = 0.9999 * (0.05 + x * 3.5_f64.to_radians().tan());
            let flow = flow(&field, x, half_height);
            let share = flow / 0.2;
            assert!((share - flow_kept).abs() < tolerance, "{file} at {x}: {share}");
        }
        // At rest at the walls, and beyond.
        for y in [0.13, -5.0] {
            let local = field.sample(Vec3::new(0.6, y, 0.05), &mut Hint::default());
            assert!(!local.inside && local.velocity.norm() < 1e-6, "{file}: {local:?}");
        }
    }
}

/// An unstructured grid of cells given by type and number of points, one after the other, with
/// u = 2 + 3 x + 5 y.
fn of_cells(points: &[[f64; 3]], cells: &[(u8, usize)]) -> (Field, Vec<Fault>) {
    let lines = |values: &dyn Fn(&[f64; 3]) -> String| points.iter().map(values).collect::<String>();
    let places = lines(&|[x, y, z]| format!("{x} {y} {z}\n"));
    let velocities = lines(&|[x, y, _]| format!("{} 0 0\n", 2.0 + 3.0 * x + 5.0 * y));
    let mut next = 0;
    let mut rows = String::new();
    for (_, count) in cells {
        let corners: Vec<String> = (next..next + count).map(|point| point.to_string()).collect();
        rows += &format!("{count} {}\n", corners.join(" "));
        next += count;
    }
    let types: String = cells.iter().map(|(kind, _)| format!("{kind}\n")).collect();
    let text = format!(
        "# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {count} double\n{places}\
        CELLS {} {}\n{rows}CELL_TYPES {}\n{types}POINT_DATA {count}\nVECTORS U double\n{velocities}",
        cells.len(),
        next + cells.len(),
        cells.len(),
        count = points.len(),
    );
    read(text.as_bytes(), "a.vtk")
}

/// Types of cells by `vtkCellType.h` of VTK 9; of curved ones the corners come first.
#[test]
fn published_types_of_cells_of_vtk_are_read() {
    let ring = |corners: usize, z: f64| {
        let angle = |i: usize| 2.0 * std::f64::consts::PI * i as f64 / corners as f64;
        (0..corners).map(move |i| [f64::cos(angle(i)), f64::sin(angle(i)), z]).collect::<Vec<_>>()
    };
    let cone = |corners: usize| [ring(corners, 0.0), vec![[0.0, 0.0, 1.0]]].concat();
    let prism = |corners: usize| [ring(corners, 0.0), ring(corners, 1.0)].concat();
    let in_rows = |z: f64| vec![[-1.0, -1.0, z], [1.0, -1.0, z], [-1.0, 1.0, z], [1.0, 1.0, z]];
    for (types, corners, more) in [
        (&[10][..], cone(3), 0),
        (&[11], [in_rows(0.0), in_rows(1.0)].concat(), 0),
        (&[12], prism(4), 0),
        (&[13], prism(3), 0),
        (&[14], cone(4), 0),
        (&[15], prism(5), 0),
        (&[16], prism(6), 0),
        (&[24, 71, 78], cone(3), 6),
        (&[25, 29, 33, 72, 79], prism(4), 12),
        (&[26, 31, 32, 73, 80], prism(3), 9),
        (&[27, 37, 74, 81], cone(4), 8),
        (&[5, 7], ring(3, 0.0), 0),
        (&[7, 9], ring(4, 0.0), 0),
        (&[7], ring(5, 0.0), 0),
        (&[8], in_rows(0.0), 0),
        (&[22, 34, 69, 76], ring(3, 0.0), 3),
        (&[23, 28, 30, 70, 77], ring(4, 0.0), 4),
        (&[36], ring(5, 0.0), 5),
    ] {
        let is_solid = corners.iter().any(|at| at[2] > 0.0);
        let points = [corners, vec![[0.1, 0.1, 0.0]; more]].concat();
        for kind in types {
            let (field, warnings) = of_cells(&points, &[(*kind, points.len())]);
            let Description::Mesh { cells, .. } = field.describe() else { panic!("{kind} is no mesh") };
            let is_curved =
                warnings.iter().any(|warning| warning.message.contains("1 cell has curved edges"));
            assert_eq!((cells, is_curved, warnings.len()), (1, more > 0, usize::from(more > 0)), "{kind}");
            let at = Vec3::new(0.05, -0.1, if is_solid { 0.3 } else { 0.0 });
            let local = field.sample(at, &mut Hint::default());
            assert!(local.inside && (local.velocity.x - 1.65).abs() < 1e-12, "{kind}: {local:?}");
        }
    }
    // Each point of a strip makes a triangle with the two before it.
    let (strip, _) = of_cells(&in_rows(0.0), &[(6, 4)]);
    assert_eq!(strip.describe(), Description::Mesh { points: 4, cells: 2 });
    // Polygons of two points are none, and points without a face need not lie in the plane.
    let points = [ring(3, 0.0), vec![[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, 0.0, 9.0]]].concat();
    let (face, _) = of_cells(&points, &[(5, 3), (7, 2)]);
    assert_eq!((face.describe(), face.plane_axis()), (Description::Mesh { points: 3, cells: 1 }, Some(2)));
    // Points, lines and faces next to cells with a volume are left out.
    let points = [cone(3), ring(3, 0.0)].concat();
    for (kind, count) in [(0, 0), (1, 1), (2, 3), (3, 2), (4, 3), (5, 3), (21, 3), (35, 3), (68, 3), (75, 3)]
    {
        let (field, warnings) = of_cells(&points, &[(10, 4), (kind, count)]);
        assert!(matches!(field.describe(), Description::Mesh { cells: 1, .. }), "{kind}");
        assert!(
            warnings[0].message.starts_with("1 cell is a point, a line or a face"),
            "{kind}: {warnings:?}"
        );
    }
}

/// Types of numbers in the words of VTK's legacy files.
#[test]
fn published_types_of_numbers_of_legacy_files_are_read() {
    for word in [
        "char",
        "signed_char",
        "unsigned_char",
        "short",
        "unsigned_short",
        "int",
        "unsigned_int",
        "long",
        "unsigned_long",
        "float",
        "double",
        "vtkIdType",
        "vtktypeint8",
        "vtktypeuint8",
        "vtktypeint16",
        "vtktypeuint16",
        "vtktypeint32",
        "vtktypeuint32",
        "vtktypeint64",
        "vtktypeuint64",
    ] {
        // VTK writes each component of a text on a line.
        let text = format!(
            "# vtk DataFile Version 3.0\na\nASCII\nDATASET STRUCTURED_POINTS\nFIELD FieldData 1\n\
            note 2 2 string\na%20b\nORIGIN 9\nc\n\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\n\
            SPACING 1 1 1\nPOINT_DATA 8\nVECTORS U {word}\n{}",
            "7 0 1\n".repeat(8)
        );
        let (field, _) = read(text.as_bytes(), "a.vtk");
        assert_eq!(field.overview().speed.mean, f64::sqrt(50.0), "{word}");
    }
}
