//! Points and cells of a field that hold no air, and plane flows on meshes of faces.

use crate::air::mesh;
use crate::meshes::Made;
use crate::vtk::{ASCII, vtu};
use spunlaid_field::{Description, Field, Hint};
use spunlaid_ground::{Fault, Vec3};
use std::path::Path;

/// 8 m/s at x = −0.2 m and 14 m/s at 1.2 m if the air of the files is whole: their formula, with the mean
/// over y of 11 m/s.
///
/// The hidden points and cells hold 0 or 999 m/s, the cells that another piece has too hold 0.
#[test]
fn analytic_hidden_points_and_cells_of_files_of_vtk_are_no_air() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/blanks");
    for (file, hidden) in [
        ("resamp_real.vti", "1740 points and 1344 cells are hidden"),
        ("hidcell.vts", "112 cells are hidden"),
        ("hidcell.vtu", "112 cells are hidden"),
        ("hidpt.vts", "300 points are hidden"),
        ("pg.pvtu", ""),
    ] {
        let (field, warnings) = Field::read(&folder.join(file)).unwrap();
        let speed = field.overview().speed;
        assert!(speed.least > 7.79 && speed.largest < 14.21, "{file}: {speed:?}");
        assert!((speed.mean - 11.0).abs() < 0.02, "{file}: {speed:?}");
        let reported = warnings.iter().any(|warning| warning.message.contains("hidden"));
        assert_eq!(reported, !hidden.is_empty(), "{file}: {warnings:?}");
        assert!(warnings.iter().any(|warning| warning.message.starts_with(hidden)), "{file}: {warnings:?}");
        // Each file has this air: U = 10 + 2 (x − 0.5) + … along the axis, 11 m/s in its middle.
        let local = field.sample(Vec3::new(0.5, 0.0, 0.0), &mut Hint::default());
        assert!(local.inside && (local.velocity.norm() - 11.0).abs() < 0.02, "{file}: {local:?}");
    }
}

/// 5 by 4 points with u = 10 + y and k = 1, the last of which is not air.
fn table(names: &str, last: &str) -> String {
    let mut text = format!("x,y,u,v,k,epsilon{names}\n");
    for i in 0..20 {
        let (x, y) = (i % 5, i / 5);
        let row = if i == 19 {
            last.to_owned()
        } else {
            format!("{},0,1,5{}", 10 + y, &",1"[..if names.is_empty() { 0 } else { 2 }])
        };
        text += &format!("{x},{y},{row}\n");
    }
    text
}

#[test]
fn analytic_rows_that_are_hidden_or_lack_a_number_end_the_air() {
    let missing = |array: &str| {
        format!(
            "{array} has no number at 1 point; it is in line 21. There is no air there: these points are left out"
        )
    };
    let hidden =
        "1 point is hidden (vtkGhostType or vtkValidPointMask); there is no air there, and it is left out";
    for (names, last, said) in [
        (",vtkValidPointMask", "0,0,0,0,0", hidden.to_owned()),
        (",vtkGhostType", "900,0,-9,5,2", "no ghost".to_owned()),
        ("", "nan,0,1,5", missing("u")),
        ("", "13,0,inf,5", missing("k")),
        ("", "13,0,1,", missing("epsilon")),
    ] {
        let text = table(names, last).replace(",vtkGhostType", ",vtkGhostLevelsOff");
        let ghost = names == ",vtkGhostType";
        // Ones in a column of ghosts are copies, which are air.
        let text = if ghost { table(names, last) } else { text };
        let (field, warnings) = Field::parse(text.as_bytes(), "a.csv").unwrap();
        let said = if ghost { hidden.to_owned() } else { said };
        let messages: Vec<&str> = warnings.iter().map(|warning: &Fault| &*warning.message).collect();
        assert_eq!(messages, [said.as_str()], "{last}");
        assert_eq!(field.overview().speed.largest, 13.0, "{last}");
        assert_eq!(field.describe(), Description::Mesh { points: 19, cells: 11 });
        let at = |x: f64, y: f64| field.sample(Vec3::new(x, y, 7.0), &mut Hint::default());
        let local = at(1.5, 1.25);
        assert!(local.inside && (local.velocity.x - 11.25).abs() < 1e-12, "{local:?}");
        assert!(!at(3.75, 2.75).inside);
        assert_eq!(field.plane_axis(), Some(2));
        // A fibre needs the numbers that are missing, not what is hidden.
        let near = Vec3::new(3.75, 2.75, 0.0);
        assert_eq!(field.why_no_air(near).is_some(), names.is_empty(), "{last}");
        assert!(field.why_no_air(Vec3::new(1.5, 1.25, 0.0)).is_none());
    }
}

/// Bits by `vtkDataSetAttributes.h` of VTK 9: 2 hides a point, and says of a cell that it has many
/// neighbours; 8 and 32 hide a cell.
#[test]
fn published_ghost_bits_of_a_table_of_centres_are_those_of_cells() {
    let of_marks = |marks: &dyn Fn(usize) -> u32| {
        let rows = (0..20).map(|i| format!("{},{},10,0,{}\n", i % 5, i / 5, marks(i))).collect::<String>();
        let text = format!("x,y,u,v,vtkGhostType\n{rows}");
        let (field, warnings) = Field::parse(text.as_bytes(), "a.csv").unwrap();
        let hidden = warnings.iter().find(|warning| warning.message.contains("hidden"));
        (
            field.describe(),
            hidden.map(|warning| warning.message.split(" hidden").next().unwrap_or_default().to_owned()),
        )
    };
    let all = Description::Lattice { points: [5, 4, 1] };
    // Many neighbours, few, on the outside; of which none hides.
    assert_eq!(of_marks(&|i| [2, 4, 16, 0][i % 4]), (all, None));
    // One beneath finer cells and one hidden.
    let (found, said) = of_marks(&|i| [8, 0, 2, 2, 32].get(i).copied().unwrap_or(2));
    assert_eq!(said.as_deref(), Some("2 points are"));
    assert_eq!(found, Description::Mesh { points: 18, cells: 10 });
    // Points only.
    assert_eq!(of_marks(&|i| if i == 0 { 2 } else { 1 }).1.as_deref(), Some("1 point is"));
}

/// Quads of 6 by 5 points in each plane of two coordinates, in legacy files: u = 2 + 3 a + 5 b.
#[test]
fn analytic_meshes_of_faces_in_a_plane_are_plane_flows() {
    let place = |axis: usize, a: f64, b: f64| {
        let mut at = [0.25; 3];
        (at[(axis + 1) % 3], at[(axis + 2) % 3]) = (a, b);
        at
    };
    let corner = |i: usize, j: usize| i + 6 * j;
    for (axis, triangles) in [(0, false), (1, true), (2, false), (0, true)] {
        let mut points = String::new();
        let mut values = String::new();
        let mut cells = Vec::new();
        for (i, j) in (0..5).flat_map(|j| (0..6).map(move |i| (i, j))) {
            let (a, b) = (i as f64 * 0.5, j as f64 * 0.25);
            let [x, y, z] = place(axis, a, b);
            points += &format!("{x} {y} {z}\n");
            values += &format!("{} 0 1\n", 2.0 + 3.0 * a + 5.0 * b);
            if i < 5 && j < 4 {
                let [p, q, r, s] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
                match triangles {
                    true => cells.extend([format!("3 {p} {q} {r}"), format!("3 {p} {r} {s}")]),
                    false => cells.push(format!("4 {p} {q} {r} {s}")),
                }
            }
        }
        let count = cells.len();
        let entries = cells.len() * if triangles { 4 } else { 5 };
        let mut text = format!(
            "# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 30 double\n\
            {points}CELLS {count} {entries}\n{}\n",
            cells.join("\n")
        );
        text += &format!("CELL_TYPES {count}\n{}", if triangles { "5\n" } else { "9\n" }.repeat(count));
        text += &format!("POINT_DATA 30\nVECTORS U double\n{values}");
        let (field, warnings) = Field::parse(text.as_bytes(), "a.vtk").unwrap();
        assert!(warnings.is_empty(), "{warnings:?}");
        assert_eq!(field.plane_axis(), Some(axis));
        assert_eq!(field.describe(), Description::Mesh { points: 30, cells: count });
        for (a, b, off) in [(0.0, 0.0, 0.0), (1.3, 0.77, 0.0), (2.5, 1.0, 40.0), (0.9, 0.1, -3.0)] {
            let mut at = place(axis, a, b);
            at[axis] += off;
            let at = Vec3::new(at[0], at[1], at[2]);
            let local = field.sample(at, &mut Hint::default());
            let meant = 2.0 + 3.0 * a + 5.0 * b;
            assert!(local.inside && (local.velocity.x - meant).abs() < 1e-12, "{axis} {local:?} {meant}");
            let around = field.around(at, &mut Hint::default());
            // What a kink may be wrong by, as the edge of the field is one, of 14.5 m/s.
            assert!(around.inside && (around.value[0] - meant).abs() < 8e-3 * 14.5, "{around:?} {meant}");
        }
        // Beyond its edge the air is that of the edge’s nearest point, and not of the inside.
        let beyond = place(axis, 2.6, 0.5);
        let local = field.sample(Vec3::new(beyond[0], beyond[1], beyond[2]), &mut Hint::default());
        assert!(!local.inside && (local.velocity.x - 12.0).abs() < 1e-12, "{local:?}");
    }
}

/// Two cubes and their faces at x = 0, which have points of their own there with the velocity of a wall.
#[test]
fn analytic_points_of_faces_that_are_left_out_are_no_air() {
    let corners = |x: f64| [[x, 0.0, 0.0], [x, 1.0, 0.0], [x, 0.0, 1.0], [x, 1.0, 1.0]];
    let of_cells: Vec<[f64; 3]> = (0..3).flat_map(|i| corners(f64::from(i))).collect();
    for (wall, own_points) in [(0.0, true), (-7.0, true), (f64::NAN, true), (0.0, false)] {
        let mut points = of_cells.clone();
        let face: Vec<usize> = if own_points { (12..16).collect() } else { (0..4).collect() };
        points.extend(corners(0.0).into_iter().filter(|_| own_points));
        let mut text = format!(
            "# vtk DataFile Version 3.0\na\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS {} double\n",
            points.len()
        );
        points.iter().for_each(|[x, y, z]| text += &format!("{x} {y} {z}\n"));
        text += "CELLS 3 23\n8 0 4 5 1 2 6 7 3\n8 4 8 9 5 6 10 11 7\n";
        text += &format!("4 {} {} {} {}\n", face[0], face[1], face[3], face[2]);
        text += &format!("CELL_TYPES 3\n12\n12\n9\nPOINT_DATA {}\nVECTORS U double\n", points.len());
        for (i, [x, y, _]) in points.iter().enumerate() {
            text += &if i < 12 {
                format!("{} 1 0\n", 20.0 - 2.0 * x + 3.0 * y)
            } else {
                format!("{wall} {wall} {wall}\n")
            };
        }
        let (field, warnings) = Field::parse(text.as_bytes(), "a.vtk").unwrap();
        let is_reported =
            |warning: &Fault| warning.to_string().starts_with("1 cell is a point, a line or a face");
        assert!(warnings.iter().any(is_reported), "{warnings:?}");
        for [x, y, z] in [[0.0, 0.5, 0.5], [0.01, 0.2, 0.9], [1.7, 0.5, 0.1]] {
            let local = field.sample(Vec3::new(x, y, z), &mut Hint::default());
            let meant = 20.0 - 2.0 * x + 3.0 * y;
            assert!(local.inside && (local.velocity.x - meant).abs() < 1e-12, "{wall}: {local:?} {meant}");
        }
    }
}

/// 5 × 3 × 2 points with u = 10 + x, in legacy files of each kind of grid. The last column of cells is
/// hidden, by its cells or by its points, which hold 999 m/s.
#[test]
fn analytic_hidden_columns_of_legacy_grids_are_no_air() {
    let places: Vec<[usize; 3]> = (0..30).map(|i| [i % 5, i / 5 % 3, i / 15]).collect();
    let points: String = places.iter().map(|[x, y, z]| format!("{x} {y} {z}\n")).collect();
    let speed = |x: usize| if x == 4 { 999 } else { 10 + x };
    let velocities: String = places.iter().map(|[x, ..]| format!("{} 0 0\n", speed(*x))).collect();
    let of_points: String = places.iter().map(|[x, ..]| if *x == 4 { "2 " } else { "0 " }).collect();
    let of_cells: String = (0..8).map(|i| if i % 4 == 3 { "32 " } else { "0 " }).collect();
    let axes =
        "X_COORDINATES 5 double\n0 1 2 3 4\nY_COORDINATES 3 double\n0 1 2\nZ_COORDINATES 2 double\n0 1\n";
    for (kind, shape) in [
        ("STRUCTURED_POINTS", "ORIGIN 0 0 0\nSPACING 1 1 1\n".to_owned()),
        ("RECTILINEAR_GRID", axes.to_owned()),
        ("STRUCTURED_GRID", format!("POINTS 30 double\n{points}")),
    ] {
        for (marks, hidden) in [
            (
                format!("SCALARS vtkGhostType unsigned_char 1\nLOOKUP_TABLE default\n{of_points}\n"),
                "6 points are hidden",
            ),
            (
                format!(
                    "CELL_DATA 8\nSCALARS vtkGhostType unsigned_char\nLOOKUP_TABLE default\n{of_cells}\n"
                ),
                "2 cells are hidden",
            ),
            (
                format!("CELL_DATA 8\nFIELD FieldData 1\nvtkGhostType 1 8 unsigned_char\n{of_cells}\n"),
                "2 cells are hidden",
            ),
        ] {
            let text = format!(
                "# vtk DataFile Version 3.0\na\nASCII\nDATASET {kind}\nDIMENSIONS 5 3 2\n\
                {shape}POINT_DATA 30\nVECTORS U double\n{velocities}{marks}"
            );
            let (field, warnings) = Field::parse(text.as_bytes(), "a.vtk").unwrap();
            assert!(
                warnings.iter().any(|warning| warning.message.starts_with(hidden)),
                "{kind}: {warnings:?}"
            );
            assert_eq!(field.overview().speed.largest, 13.0, "{kind} {hidden}");
            let at = |x: f64| field.sample(Vec3::new(x, 1.25, 0.5), &mut Hint::default());
            assert!(at(2.5).inside && (at(2.5).velocity.x - 12.5).abs() < 1e-12, "{kind}: {:?}", at(2.5));
            assert!(!at(3.5).inside, "{kind}");
        }
    }
}

/// A piece of a grid of 5 × 3 × 2 points with u = 10 + x at points or in cells, from one place along x to
/// another. The cells from `own` on are those of the next piece; what they alone have is wrong.
fn piece(is_image: bool, in_cells: bool, [from, to, own]: [usize; 3]) -> String {
    let extent = format!("{from} {to} 0 2 0 1");
    let cells = to - from;
    let columns = |last: usize| (0..last).flat_map(move |_| from..to).collect::<Vec<_>>();
    let ghosts: String = columns(2).iter().map(|x| if *x >= own { "1 " } else { "0 " }).collect();
    let of_cells: String = columns(2)
        .iter()
        .map(|x| if *x >= own { "999 0 0 ".to_owned() } else { format!("{} 0 0 ", 10.5 + *x as f64) })
        .collect();
    let of_points: String = (0..6 * (cells + 1))
        .map(|i| from + i % (cells + 1))
        .map(|x| if x > own { "999 0 0 ".to_owned() } else { format!("{} 0 0 ", 10 + x) })
        .collect();
    let velocity = |values: &str| {
        format!(
            "<DataArray type=\"Float64\" Name=\"U\" NumberOfComponents=\"3\" format=\"ascii\">{values}</DataArray>\n"
        )
    };
    // Rectilinear grids have the older name.
    let name = if is_image { "vtkGhostType" } else { "vtkGhostLevels" };
    let marks = format!("<DataArray type=\"UInt8\" Name=\"{name}\" format=\"ascii\">{ghosts}</DataArray>\n");
    let (point_data, cell_data) = match in_cells {
        true => (String::new(), velocity(&of_cells) + &marks),
        false => (velocity(&of_points), marks),
    };
    let (kind, shape, axes) = match is_image {
        true => ("ImageData", " Origin=\"0 0 0\" Spacing=\"1 1 1\"", String::new()),
        false => {
            let axis = |from: usize, to: usize| {
                let places: String = (from..=to).map(|place| format!("{place} ")).collect();
                format!("<DataArray type=\"Float64\" format=\"ascii\">{places}</DataArray>\n")
            };
            let axes = axis(from, to) + &axis(0, 2) + &axis(0, 1);
            ("RectilinearGrid", "", format!("<Coordinates>\n{axes}</Coordinates>\n"))
        }
    };
    format!(
        "<VTKFile type=\"{kind}\" version=\"1.0\" byte_order=\"LittleEndian\">\n\
        <{kind} WholeExtent=\"{extent}\"{shape}>\n<Piece Extent=\"{extent}\">\n<PointData>\n\
        {point_data}</PointData>\n<CellData>\n{cell_data}</CellData>\n{axes}</Piece>\n</{kind}>\n</VTKFile>\n"
    )
}

/// Pieces of parallel grids overlap by a layer of cells, which counts once: the air is that of the piece
/// whose own it is.
#[test]
fn analytic_cells_that_another_piece_of_a_grid_has_too_count_once() {
    for (is_image, in_cells) in [(true, false), (true, true), (false, false), (false, true)] {
        let (kind, end) = if is_image { ("ImageData", "vti") } else { ("RectilinearGrid", "vtr") };
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, text: String| std::fs::write(folder.path().join(name), text).unwrap();
        write(&format!("left.{end}"), piece(is_image, in_cells, [0, 3, 2]));
        write(&format!("right.{end}"), piece(is_image, in_cells, [2, 4, 4]));
        for parts in [["left", "right"], ["right", "left"]] {
            let sources: String =
                parts.iter().map(|part| format!("<Piece Source=\"{part}.{end}\"/>\n")).collect();
            let list = format!(
                "<VTKFile type=\"P{kind}\" version=\"1.0\">\n<P{kind} GhostLevel=\"1\">\n\
                {sources}</P{kind}>\n</VTKFile>\n"
            );
            write(&format!("list.p{end}"), list);
            let (field, warnings) = Field::read(&folder.path().join(format!("list.p{end}"))).unwrap();
            assert!(!warnings.iter().any(|warning| warning.message.contains("hidden")), "{warnings:?}");
            let speed = field.overview().speed;
            let ends = if in_cells { [10.5, 13.5] } else { [10.0, 14.0] };
            assert!(
                (speed.least - ends[0]).abs() < 1e-9 && (speed.largest - ends[1]).abs() < 1e-9,
                "{kind} {in_cells}: {speed:?}"
            );
            // Values of cells are means at points, so that at the ends they are those of the cells there.
            let inner = if in_cells { 1.0..3.0 } else { 0.0..4.0 };
            for x in [0.75, 1.5, 2.25, 2.75, 3.25].into_iter().filter(|x| inner.contains(x)) {
                let local = field.sample(Vec3::new(x, 0.75, 0.5), &mut Hint::default());
                assert!(
                    local.inside && (local.velocity.x - 10.0 - x).abs() < 1e-9,
                    "{kind} {in_cells} {x}: {local:?}"
                );
            }
        }
    }
}

/// The hole around a point without a number goes as far as the diagonal of its cells, and between points without cells
/// as far as twice their usual distance.
#[test]
fn analytic_holes_go_as_far_as_their_cells() {
    // Cells of 2 × 0.5, and of 3 × 1 at the hole; points off their rows by turns, in a box of 9 × 2.
    let bent = |i: usize| if i % 2 == 1 && i < 15 { 0.1 } else { 0.0 };
    let of_cells = 10.0_f64.sqrt();
    let of_points = 2.0 * (9.0 * 2.0 / 20.0_f64).sqrt();
    for (off, reach) in [(0.0, of_cells), (1.0, of_points)] {
        let row = |i: usize| {
            let (x, y) = ([0, 2, 4, 6, 9][i % 5], [0.0, 0.5, 1.0, 2.0][i / 5] + off * bent(i));
            let speed = if i == 19 { "nan".to_owned() } else { (10 + x).to_string() };
            format!("{x},{y},{speed},0\n")
        };
        let text = format!("x,y,u,v\n{}", (0..20).map(row).collect::<String>());
        let (field, _) = Field::parse(text.as_bytes(), "a.csv").unwrap();
        let why = |share: f64| field.why_no_air(Vec3::new(9.0 + share * reach, 2.0, 0.0)).is_some();
        assert_eq!([0.5, 0.999, 1.001].map(why), [true, true, false], "{off}");
    }
}

/// The first place without a number is said, in its own kind: points by their coordinates, cells by their middle.
#[test]
fn analytic_the_first_point_or_cell_without_a_number_is_where_it_is_said_to_be() {
    for (kind, count, missing, said) in [
        ("POINT_DATA", 30, vec![6], "U has no number at 1 point; it is point 7, at (1.123457, 1, 0)"),
        (
            "POINT_DATA",
            30,
            vec![24, 29],
            "U has no number at 2 points; the first is point 25, at (4.123457, 1, 2)",
        ),
        ("CELL_DATA", 8, vec![5], "U has no number at 1 cell; it is cell 6, at (1.623457, 1.5, 1)"),
    ] {
        let value = |i: usize| if missing.contains(&i) { "nan 0 0\n" } else { "5 0 0\n" };
        let text = format!(
            "# vtk DataFile Version 3.0\na\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 5 3 2\n\
            ORIGIN 0.1234567 0 0\nSPACING 1 1 2\n{kind} {count}\nVECTORS U double\n{}",
            (0..count).map(value).collect::<String>()
        );
        let (_, warnings) = Field::parse(text.as_bytes(), "a.vtk").unwrap();
        assert!(warnings.iter().any(|warning| warning.message.starts_with(said)), "{said}: {warnings:?}");
    }
}

/// Missing numbers are counted over all pieces.
#[test]
fn analytic_missing_numbers_of_all_pieces_are_counted() {
    let halves = [0.0, 1.0].map(|shift| {
        let mut half = mesh(Made::Hexahedra, 0.0);
        half.points.iter_mut().for_each(|point| point[0] += shift);
        half.point_data[1].2[0] = f64::NAN;
        half
    });
    let (_, warnings) = Field::parse(&vtu(&halves, ASCII), "a.vtu").unwrap();
    let said = "U has no number at 2 points; the first is point 1, at (0, 0, 0)";
    assert!(warnings.iter().any(|warning| warning.message.starts_with(said)), "{warnings:?}");
}

/// Two cells in two pieces, of which one has the points between them too, with other values: those of their owner hold.
#[test]
fn analytic_points_that_another_piece_of_a_mesh_has_too_have_its_values() {
    let numbers = |name: &str, kind: &str, components: usize, values: &[f64]| {
        let values: String = values.iter().map(|value| format!("{value} ")).collect();
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{components}\" \
            format=\"ascii\">{values}</DataArray>\n"
        )
    };
    let piece = |from: usize, copies: Option<usize>| {
        let corners =
            [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
        let is_copy = corners.map(|[x, ..]| copies == Some(from + x));
        // The points that both have are at x = 0. The copies write −0 there, and for y and z.
        let points: [[f64; 3]; 8] = std::array::from_fn(|i| {
            let [x, y, z] = corners[i].map(|at| at as f64);
            [from as f64 + x - 1.0, y, z].map(|at| if is_copy[i] && at == 0.0 { -0.0 } else { at })
        });
        let of = |middle: f64| -> [f64; 8] {
            let own = points.map(|[x, y, z]| middle + x + 2.0 * y + 4.0 * z);
            std::array::from_fn(|i| if is_copy[i] { 999.0 } else { own[i] })
        };
        let velocity = of(10.0).map(|u| [u, 0.0, 0.0]);
        format!(
            "<Piece NumberOfPoints=\"8\" NumberOfCells=\"1\">\n<PointData>\n{}{}{}{}</PointData>\n\
            <Points>\n{}</Points>\n<Cells>\n{}{}{}</Cells>\n</Piece>\n",
            numbers("U", "Float64", 3, velocity.as_flattened()),
            numbers("k", "Float64", 1, &of(2.0)),
            numbers("epsilon", "Float64", 1, &of(3.0)),
            numbers("vtkGhostType", "UInt8", 1, &is_copy.map(f64::from)),
            numbers("Points", "Float64", 3, points.as_flattened()),
            numbers("connectivity", "Int64", 1, &[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0]),
            numbers("offsets", "Int64", 1, &[8.0]),
            numbers("types", "UInt8", 1, &[12.0]),
        )
    };
    for (left, right) in [(None, Some(1)), (Some(1), None)] {
        for is_turned in [false, true] {
            let mut pieces = [piece(0, left), piece(1, right)];
            if is_turned {
                pieces.reverse();
            }
            let text = format!(
                "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n\
                <UnstructuredGrid>\n{}</UnstructuredGrid>\n</VTKFile>\n",
                pieces.concat()
            );
            let (field, _) = Field::parse(text.as_bytes(), "a.vtu").unwrap();
            for x in [-0.75, -0.25, 0.25, 0.75] {
                let local = field.sample(Vec3::new(x, 0.5, 0.25), &mut Hint::default());
                let found = [local.velocity.x - 10.0, local.k - 2.0, local.epsilon - 3.0];
                assert!(
                    local.inside && found.iter().all(|off| (off - x - 2.0).abs() < 1e-9),
                    "{left:?} {x}: {local:?}"
                );
            }
        }
    }
}
