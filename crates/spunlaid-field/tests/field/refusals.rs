//! Files that hold no field of air are refused with the place and the way out, and memory stays in proportion to the
//! file.

use crate::air::{mesh, samples, values};
use crate::meshes::{Block, Made};
use crate::vtk::{ASCII, DataPlace, Squeeze, Style, legacy, vti, vts, vtu};
use proptest::prelude::*;
use spunlaid_field::{Field, FieldLayout, Hint};
use spunlaid_ground::Vec3;
use std::path::Path;

fn refused(bytes: &[u8]) -> String {
    let said = Field::parse(bytes, "a.vtu").expect_err("this is no field").to_string();
    assert!(said.chars().all(|c| !c.is_control()), "{said:?}");
    said
}

/// Changes a file that could be read.
fn changed(text: &str, from: &str, to: &str) -> String {
    assert!(text.contains(from), "{from}\n{text}");
    refused(text.replacen(from, to, 1).as_bytes())
}

#[test]
fn rejects_meshes_with_place_and_way_out() {
    let plain = String::from_utf8(vtu(&[mesh(Made::Hexahedra, 0.0)], ASCII)).unwrap();
    let types = "Name=\"types\" NumberOfComponents=\"1\" format=\"ascii\">\n12";
    let ends = "Name=\"offsets\" NumberOfComponents=\"1\" format=\"ascii\">\n8 16";
    for (from, to, said) in [
        (
            "0 1 4 3",
            "0 1 99 3",
            "a.vtu: cell 1: names point 99 (counted from 0), but there are 27 points; is the file complete?",
        ),
        (
            "0 1 4 3",
            "0 1 27 3",
            "a.vtu: cell 1: names point 27 (counted from 0), but there are 27 points; is the file complete?",
        ),
        (
            "0 1 4 3",
            "0 1 -4 3",
            "a.vtu: cell 1: names point -4 (counted from 0), but there are 27 points; is the file complete?",
        ),
        (
            types,
            &types.replace("12", "43"),
            "a.vtu: cell 1: is of VTK type 43, which is not supported; write tetrahedra, voxels, hexahedra, \
            wedges, pyramids or polyhedra",
        ),
        (
            types,
            &types.replace("12", "13"),
            "a.vtu: cell 1: a wedge has 8 points and needs 6; is the file complete?",
        ),
        (ends, &ends.replace("16", "7"), "a.vtu: cell 2: goes from 8 to 7; it must increase"),
        (
            ends,
            &ends.replace("16", "999"),
            "a.vtu: cell 2: has 64 entries in its list and needs 999; is the file complete?",
        ),
        ("0 1 4 3", "0 1 4", "a.vtu: cell 8: has 63 entries in its list and needs 64; is the file complete?"),
        (
            "0 1 4 3",
            "0 1 4 x",
            "a.vtu:27: connectivity: \"x\" was found instead of a number; is the file complete, and is it \
            the right one?",
        ),
        ("<Points>", "<Spots>", "a.vtu:25: is not valid XML: expected 'Spots' tag, not 'Points' at 25:1"),
        (
            "Float64\" Name=\"Points",
            "Float16\" Name=\"Points",
            "a.vtu:22: Points: \"Float16\" was found instead of a type of number; is the file complete, and \
            is it the right one?",
        ),
        (
            "NumberOfPoints=\"27\"",
            "NumberOfPoints=\"1000000000000\"",
            "a.vtu:22: Points: has 81 numbers and needs 3000000000000; is the file complete?",
        ),
        (
            "NumberOfCells=\"8\"",
            "NumberOfCells=\"1000000000000\"",
            "a.vtu:33: types: has 8 numbers and needs 1000000000000; is the file complete?",
        ),
        (
            "NumberOfCells=\"8\"",
            "NumberOfCells=\"-8\"",
            "a.vtu:4: NumberOfCells: \"-8\" was found instead of a whole number; is the file complete, and \
            is it the right one?",
        ),
        (
            "type=\"UnstructuredGrid\"",
            "type=\"PUnstructuredGrid\"",
            "a.vtu: is a VTK file that lists other files; name it by its path",
        ),
        (
            "header_type",
            "compressor=\"vtkLZMADataCompressor\" header_type",
            "a.vtu: is written with the compressor vtkLZMADataCompressor, which is not supported; write it \
            with zlib, LZ4 or none",
        ),
    ] {
        assert_eq!(changed(&plain, from, to), said);
    }
    let row = vts(
        [5, 1, 1],
        &[0.0, 1.0, 2.0, 3.0, 4.0].map(|x| [x, 0.0, 0.0]),
        [&[("U", 3, vec![1.0; 15])], &[]],
        ASCII,
    );
    assert_eq!(
        refused(&row),
        "a.vtu: has no cells with a volume, only 4 points, lines and faces; write the interior of the flow as well, \
        and a plane flow one cell thick or as a table of points"
    );
    let mut lines = mesh(Made::Hexahedra, 0.0);
    lines.cells.iter_mut().for_each(|cell| *cell = (3, cell.1[..2].to_vec(), vec![]));
    let said = refused(&vtu(&[lines], ASCII));
    assert!(said.contains("has no cells with a volume, only 8 points, lines and faces"), "{said}");
    let mut flat = mesh(Made::Hexahedra, 0.0);
    flat.cells.iter_mut().for_each(|cell| *cell = (9, cell.1[..4].to_vec(), vec![]));
    assert_eq!(
        refused(&vtu(&[flat], ASCII)),
        "a.vtu: has no cells with a volume, only 8 faces, and they do not lie in one plane across x, y or z; \
        write the interior of the flow; a plane flow may be a mesh of faces in the plane of two coordinates"
    );
}

#[test]
fn rejects_grids_with_place_and_way_out() {
    let data = values(&Block::cube(1, 0.0).points);
    let image = String::from_utf8(vti([2, 2, 2], [0.0; 3], [1.0; 3], [&data, &[]], ASCII)).unwrap();
    for (extent, said) in [
        ("0 99 0 99 0 99", "a.vtu:9: U: has 24 numbers and needs 3000000; is the file complete?"),
        (
            "0 9999 0 9999 0 9999",
            "a.vtu: has more than 4294967295 points; cut out the region of the fibres, or thin it",
        ),
        (
            "0 -5 0 1 0 1",
            "a.vtu:4: WholeExtent: \"-4\" was found instead of a number of points, at least 1; is the file \
             complete, and is it the right one?",
        ),
        (
            "0 1 0 1",
            "a.vtu:4: WholeExtent: \"0 1 0 1\" was found instead of numbers separated by blanks; is the file \
            complete, and is it the right one?",
        ),
    ] {
        assert_eq!(refused(image.replace("0 1 0 1 0 1", extent).as_bytes()), said);
    }
    assert_eq!(
        changed(&image, "Spacing=\"1 1 1\"", "Spacing=\"1 -1 1\""),
        "a.vtu: y: goes from 0 to -1; it must increase"
    );
    assert_eq!(
        changed(&image, "Origin", "Direction=\"0 1 0 -1 0 0 0 0 1\" Origin"),
        "a.vtu:4: is an image whose axes are rotated; resample it along x, y and z"
    );
}

#[test]
fn rejects_bytes_that_cannot_be_decoded() {
    let mesh = mesh(Made::Hexahedra, 0.0);
    let squeezed =
        |squeeze| vtu(std::slice::from_ref(&mesh), Style { place: DataPlace::AppendedRaw, squeeze, ..ASCII });
    let plain = squeezed(Squeeze::None);
    assert_eq!(
        refused(&plain[..plain.len() - 200]),
        "a.vtu:18: offsets: ends where an array should follow; is the file cut off?"
    );
    let start = plain.windows(2).position(|pair| pair == b"_\xd8").unwrap() + 1;
    let mut promising = plain.clone();
    promising[start..start + 4].copy_from_slice(&[0xff; 4]);
    // The first array is not needed, so its fault does not matter.
    assert!(Field::parse(&promising, "a.vtu").is_ok());
    for squeeze in [Squeeze::Zlib, Squeeze::Lz4] {
        let mut bytes = squeezed(squeeze);
        // The size of the blocks of the array of velocities, after that of the pressure.
        let text = String::from_utf8_lossy(&bytes).into_owned();
        let offset = text.split("Name=\"U\"").nth(1).unwrap().split("offset=\"").nth(1).unwrap();
        let offset: usize = offset.split('"').next().unwrap().parse().unwrap();
        let start = bytes.windows(3).position(|three| three == b"\n _").unwrap() + 3 + offset;
        let said = |bytes: &[u8]| refused(bytes);
        bytes[start + 4..start + 8].copy_from_slice(&0x00ff_ffff_u32.to_le_bytes());
        assert!(said(&bytes).contains("U: cannot be decoded: "), "{}", said(&bytes));
        bytes[start + 4..start + 8].copy_from_slice(&[0xff; 4]);
        assert!(said(&bytes).starts_with("a.vtu:7: U: "), "{}", said(&bytes));
        bytes[start..start + 4].copy_from_slice(&[0xff; 4]);
        assert_eq!(
            said(&bytes),
            "a.vtu:7: U: ends where the sizes of the blocks should follow; is the file cut off?"
        );
    }
}

#[test]
fn rejects_legacy_files_with_place_and_way_out() {
    let text = |coding: &str, rest: &str| format!("# vtk DataFile Version 3.0\nair\n{coding}\n{rest}\n");
    for (coding, rest, said) in [
        (
            "ASCII",
            "DATASET UNSTRUCTURED_GRID\nPOINTS 1000000000000 double\n0 0 0",
            "a.vtu:5: POINTS: ends where more numbers should follow; is the file cut off?",
        ),
        (
            "BINARY",
            "DATASET UNSTRUCTURED_GRID\nPOINTS 18446744073709551615 double\n0 0 0",
            "a.vtu: byte 99: POINTS: ends where more numbers should follow; is the file cut off?",
        ),
        (
            "ASCII",
            "DATASET UNSTRUCTURED_GRID\nPOINTS 1 double\n0 0 0\nCELLS 1000000000000 3000000000000\n1",
            "a.vtu:7: CELLS: ends where more numbers should follow; is the file cut off?",
        ),
        (
            "ASCII",
            "DATASET UNSTRUCTURED_GRID\nFIELD a 1000000000000\n",
            "a.vtu:7: ends where a word should follow; is the file cut off?",
        ),
        (
            "ASCII",
            "DATASET UNSTRUCTURED_GRID\nFIELD a 1\nb 1 1000000000000 string\n",
            "a.vtu:8: ends where a word should follow; is the file cut off?",
        ),
        (
            "ASCII",
            "DATASET POLYGONS",
            "a.vtu:4: \"POLYGONS\" was found instead of STRUCTURED_POINTS, RECTILINEAR_GRID, \
            STRUCTURED_GRID or UNSTRUCTURED_GRID; is the file complete, and is it the right one?",
        ),
        (
            "TEXT",
            "",
            "a.vtu:3: \"TEXT\" was found instead of ASCII or BINARY; is the file complete, and is it the right one?",
        ),
        (
            "ASCII",
            "DATASET STRUCTURED_GRID\nDIMENSION 2 2 2",
            "a.vtu:5: \"DIMENSION\" was found instead of DIMENSIONS; is the file complete, and is it the right one?",
        ),
        (
            "BINARY",
            "DATASET STRUCTURED_POINTS\nFIELD a 1\nb 1 1 string\nc\nDIMENSIONS 2 2 2",
            "a.vtu: byte 87: \"string\" was found instead of a type of number; is the file complete, and is it the \
            right one?",
        ),
        (
            "ASCII",
            "DATASET STRUCTURED_POINTS\nDIMENSIONS 2 0 2",
            "a.vtu:5: \"0\" was found instead of a number of points, at least 1; is the file complete, and is it \
             the right one?",
        ),
        (
            "ASCII",
            "DATASET STRUCTURED_POINTS\nDIMENSIONS 1000000 1000000 1000000\nPOINT_DATA 1000000000000000000\n\
            VECTORS U float\n1 2 3",
            "a.vtu:7: U: ends where more numbers should follow; is the file cut off?",
        ),
    ] {
        assert_eq!(refused(text(coding, rest).as_bytes()), said);
    }
}

#[test]
fn rejects_tables_with_place_and_way_out() {
    let head = "x,y,z,u,v,w\n";
    for (text, said) in [
        ("", "a.vtu: contains no rows of numbers; is it the right file?"),
        (head, "a.vtu: contains no rows of numbers; is it the right file?"),
        (
            "1,2,3,4,5,6\n",
            "a.vtu: has no line of names above its numbers; write one, like x_m,y_m,z_m,u_m_s,v_m_s,w_m_s",
        ),
        (
            "x,z,u,v,w\n1,2,3,4,5\n",
            "a.vtu: none of the columns is a coordinate along y (x, z, u, v and w); name it like y_m",
        ),
        (
            "x,y,z,p,T\n1,2,3,4,5\n",
            "a.vtu: none of the arrays is a velocity (x, y, z, p and T); name it U or velocity, with three \
            components, or write u, v and w, or name its arrays with air.field_velocity",
        ),
        (
            "x,y,z,u,w\n1,2,3,4,5\n",
            "a.vtu: none of the arrays is a velocity (x, y, z, u and w); name it U or velocity, with three \
            components, or write u, v and w, or name its arrays with air.field_velocity",
        ),
        (
            "x [yard],y,z,u,v,w\n1,2,3,4,5,6\n",
            "a.vtu: x [yard]: has the unit \"yard\"; write the values in m, dm, cm, mm, µm, in or ft",
        ),
        (
            &format!("{head}1,2,3,4,5,6\n1,2,3,4,5\n"),
            "a.vtu:3: this row has 5 cells and needs 6; is the file cut off here?",
        ),
        (
            &format!("{head}1,2,3,4,5,6\n1,2,3,4,5,6,7\n"),
            "a.vtu:3: this row has 7 cells and needs 6; are both decimals and cells separated by commas?",
        ),
        (
            &format!("{head}1,2,3,4,5,6\n1,2,x7,4,5,6\n"),
            "a.vtu:3: column z: \"x7\" is not a number; write one, or leave the cell empty where a value is missing",
        ),
        (
            "% Length unit: yd\n% x y u v\n1 2 3 4\n",
            "a.vtu:1: has the unit \"yd\"; write the values in m, dm, cm, mm, µm, in or ft",
        ),
        (
            "% x y z u (m/s) @ t=0 v (m/s) @ t=0 w (m/s) @ t=0\n1 2 3 4 5 6\n",
            "a.vtu: has 1 point; at least 9 are needed for interpolation",
        ),
        (&format!("{head}1,2,3,4,5,6\n"), "a.vtu: has 1 point; at least 9 are needed for interpolation"),
    ] {
        assert_eq!(refused(text.as_bytes()), said);
    }
}

/// A grid of 5 × 4 × 3 points as a table, with one more column behind its own.
fn table(heads: &str, row: impl Fn([f64; 3]) -> String) -> String {
    let points = (0..60).map(|i| [i % 5, i / 5 % 4, i / 20].map(|i| f64::from(i) / 10.0));
    format!(
        "{heads}\n{}",
        points.map(|at| format!("{},{},{},{}\n", at[0], at[1], at[2], row(at))).collect::<String>()
    )
}

#[test]
fn rejects_columns_that_stand_twice_and_a_missing_component() {
    for (heads, said) in [
        ("x,y,z,u,v,w,U", "column u: occurs twice, in columns 4 and 7; leave one of them"),
        ("x,y,z,u,v,w,Z", "column z: occurs twice, in columns 3 and 7"),
    ] {
        let said_of_it = refused(table(heads, |_| "1,2,3,4".to_owned()).as_bytes());
        assert!(said_of_it.contains(said), "{said_of_it}");
    }
    // A column that nobody reads may stand twice.
    assert!(Field::parse(table("x,y,z,u,v,w,p,p", |_| "1,2,3,4,5".to_owned()).as_bytes(), "a.csv").is_ok());
    // Without w: the air of a plane flow, and that of another one.
    let plane = table("x,y,z,u,v", |[x, y, _]| format!("{},{y}", 20.0 + x));
    assert!(Field::parse(plane.as_bytes(), "a.csv").is_ok());
    // Rounding along z, and a component that is zero.
    let rounded = table("x,y,z,u,v", |[x, _, z]| format!("{},0", 20.0 + x + 1e-4 * z));
    assert!(Field::parse(rounded.as_bytes(), "a.csv").is_ok());
    let level = "x,y,z,u,v\n0,0,1,2,0\n1,0,1,2,0\n0,1,1,3,0\n1,1,1,3,0\n";
    assert!(Field::parse(level.as_bytes(), "a.csv").is_ok());
    let none_above: String = (0..20).map(|i| format!("{i},{},{},2,0\n", i % 4, i % 3)).collect();
    for text in
        [table("x,y,z,u,v", |[x, y, z]| format!("{},{y}", 20.0 + x - z)), format!("x,y,z,u,v\n{none_above}")]
    {
        let said = refused(text.as_bytes());
        assert!(said.contains("has no velocity along z, and its points lie at different z"), "{said}");
    }
}

/// A mean is zero before its averaging begins; the velocity of the time stands beside it.
#[test]
fn rejects_a_mean_that_is_zero_everywhere() {
    let heads = "x,y,z,UMean:0,UMean:1,UMean:2,U:0,U:1,U:2";
    let mean = |of: f64| table(heads, |_| format!("{of},0,0,10,0,0"));
    let said = refused(mean(0.0).as_bytes());
    assert!(
        said.contains("zero everywhere (UMean:0, UMean:1, UMean:2)") && said.contains("\"U:0, U:1, U:2\""),
        "{said}"
    );
    Field::parse(mean(9.0).as_bytes(), "a").unwrap();
    let named = |velocity: &str| {
        let layout = FieldLayout { velocity: Some(velocity.to_owned()), ..FieldLayout::default() };
        Field::parse_as(mean(0.0).as_bytes(), "a", &layout)
    };
    named("U:0, U:1, U:2").unwrap();
    // One array is not two components.
    assert!(named("U:0, U:1").is_ok() && named("U:0, U:0").is_err());
    // The ending of a component is no unit.
    let other = FieldLayout { velocity: Some("W[i],W[j],W[k]".to_owned()), ..FieldLayout::default() };
    Field::parse_as(table("x,y,z,W[i],W[j],W[k]", |_| "1,2,3".to_owned()).as_bytes(), "a", &other).unwrap();
}

/// Programs mark places without a number by one of their own, in any component; NaN is left out.
#[test]
fn rejects_velocities_that_mark_places_without_a_number() {
    for (mark, shown) in [("-9999", "-9999"), ("1e30", "1e30"), ("999", "999")] {
        let marked = |[x, y, _]: [f64; 3]| {
            let u = if y > 0.1 && x > 0.1 { mark.to_owned() } else { format!("{}", 20.0 + x) };
            format!("{u},{y},0")
        };
        let said = refused(table("x,y,z,u,v,w", marked).as_bytes());
        assert!(said.contains(&format!("of {shown} m/s at")) && said.contains("write nan there"), "{said}");
    }
    // In a component that is zero elsewhere too.
    let marked = |[x, y, _]: [f64; 3]| format!("20,{y},{}", if x > 0.3 { "-999" } else { "0" });
    assert!(refused(table("x,y,z,u,v,w", marked).as_bytes()).contains("of -999 m/s at 12 places"));
    // A jet of one speed in still air is none, nor is air that is the same everywhere.
    for jet in [
        |[x, y, _]: [f64; 3]| format!("{},0,0", if x + y > 0.5 { 140.0 } else { 0.1 }),
        |_| "10,0.1,0".to_owned(),
    ] {
        assert!(Field::parse(table("x,y,z,u,v,w", jet).as_bytes(), "a.csv").is_ok());
    }
}

#[test]
fn rejects_a_slice_of_a_flow_around_an_axis() {
    // Wedges next to the axis and hexahedra outside, about x, as OpenFOAM writes them.
    for (degrees, is_wedge) in [(2.5_f64, true), (1.0, true), (44.0, false)] {
        let half = degrees.to_radians();
        let points: Vec<[f64; 3]> = (0..3 * 4 * 2)
            .map(|i| {
                let x = f64::from(i % 3);
                let r = 0.01 * f64::from(i / 3 % 4 + 1);
                let side = f64::from(i / 12) * 2.0 - 1.0;
                [0.1 * x, r * half.cos(), side * r * half.sin()]
            })
            .collect();
        let cells: Vec<[u32; 8]> = (0..2)
            .flat_map(|x| (0..3).map(move |r| x + 3 * r))
            .map(|i| [i, i + 1, i + 4, i + 3, i + 12, i + 13, i + 16, i + 15])
            .collect();
        let mut text =
            "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 24 double\n".to_owned();
        points.iter().for_each(|[x, y, z]| text += &format!("{x} {y} {z}\n"));
        text += "CELLS 6 54\n";
        cells.iter().for_each(|cell| text += &format!("8 {}\n", cell.map(|i| i.to_string()).join(" ")));
        text += &format!("CELL_TYPES 6\n{}POINT_DATA 24\nVECTORS U double\n", "12\n".repeat(6));
        points.iter().for_each(|_| text += "20 0 0\n");
        let found = Field::parse(text.as_bytes(), "a.vtk").err().map(|error| error.to_string());
        let said = found.as_deref().unwrap_or_default();
        assert_eq!(said.contains("of a flow around x, which is not read"), is_wedge, "{degrees}: {found:?}");
    }
}

#[test]
fn rejects_entities_and_depth() {
    let bomb = "<?xml version=\"1.0\"?><!DOCTYPE a [<!ENTITY b \"bb\"><!ENTITY c \"&b;&b;\">]><VTKFile \
        type=\"ImageData\">&c;</VTKFile>";
    let latin = b"<VTKFile type=\"ImageData\">\n\xfc";
    assert_eq!(refused(latin), "a.vtu:2: is not valid XML: it is not UTF-8 text");
    assert_eq!(refused(bomb.as_bytes()), "a.vtu:1: is not valid XML: XML with DTD detected");
    for start in ["", "<VTKFile type=\"ImageData\"><ImageData>"] {
        let deep = format!("{start}{}", "<a>".repeat(100_000));
        assert!(refused(deep.as_bytes()).starts_with("a.vtu:1: is not valid XML: "));
    }
    let deep =
        format!("<VTKFile type=\"ImageData\">{}{}</VTKFile>", "<a>".repeat(100_000), "</a>".repeat(100_000));
    assert_eq!(refused(deep.as_bytes()), "a.vtu: ends where the grid should follow; is the file cut off?");
}

#[test]
fn rejects_what_is_no_file() {
    let said = |path: &Path| Field::read(path).expect_err("this is no field").to_string();
    assert_eq!(
        said(Path::new("no/a.vtu")),
        "no/a.vtu: there is no such file; name a field of air, VTK (.vtu, .vti, .vts, .vtr, .vtk), a list of \
        its files (.vtm, .pvtu) or a table (.csv)"
    );
    assert_eq!(said(Path::new("src")), "src: is a folder; name the field of air in it");
    let lzma = Path::new("tests/fixtures/lzma.refused");
    assert_eq!(
        said(lzma),
        "tests/fixtures/lzma.refused: is written with the compressor vtkLZMADataCompressor, which is \
        not supported; write it with zlib, LZ4 or none"
    );
}

#[test]
fn any_part_and_any_change_is_read_or_refused() {
    let mesh = mesh(Made::Mixed, 0.0);
    let zlib = Style { place: DataPlace::AppendedRaw, squeeze: Squeeze::Zlib, ..ASCII };
    let lz4 = Style { place: DataPlace::Inline, squeeze: Squeeze::Lz4, ..ASCII };
    let meshes = std::slice::from_ref(&mesh);
    let files = [
        vtu(meshes, ASCII),
        vtu(meshes, zlib),
        vtu(meshes, lz4),
        legacy(&mesh, "3.0", true),
        legacy(&mesh, "5.1", false),
    ];
    let check = |bytes: &[u8]| match Field::parse(bytes, "a.vtu") {
        Ok((field, _)) => assert!(samples(&field).iter().all(|local| local.velocity.norm().is_finite())),
        Err(error) => assert!(error.to_string().chars().all(|c| !c.is_control()), "{error}"),
    };
    for file in files {
        let step = file.len() / 400 + 1;
        for at in (0..file.len()).step_by(step) {
            check(&file[..at]);
            for flip in [0x01, 0x10, 0x80] {
                let mut bytes = file.clone();
                bytes[at] ^= flip;
                check(&bytes);
            }
        }
    }
}

proptest! {
    #[test]
    fn any_table_is_read_or_refused(text in "([-0-9.,;\\t e\n#xyzuvwk\"\\[\\]_]|x,y,z,u,v,w\n|nan|inf){0,200}") {
        if let Err(error) = Field::parse(text.as_bytes(), "a.csv") {
            prop_assert!(error.to_string().chars().all(|c| !c.is_control()), "{error}");
        }
    }
}

/// A table of 20 points whose velocity has these values in a component, and the largest of the others.
fn marked(component: &str, mark: f64, count: usize, others: f64) -> Result<usize, String> {
    let row = |i: usize| {
        let value = if i < count { mark } else { 0.5 * others };
        let parts = ["u", "v", "w"].map(|name| if name == component { value } else { others }.to_string());
        format!("{},{},{}\n", i % 5, i / 5, parts.join(","))
    };
    let text = format!("x,y,u,v,w\n{}", (0..20).map(row).collect::<String>());
    let read = Field::parse(text.as_bytes(), "a.csv");
    read.map(|(_, warnings)| warnings.len()).map_err(|error| error.to_string())
}

/// Beyond 300 m/s and beyond twenty times all others, at more than one place and fewer than half of them.
#[test]
fn rejects_velocities_that_mark_points_without_a_number() {
    for (mark, others, is_mark) in [
        (-9999.0, 13.0, true),
        (301.0, 13.0, true),
        (300.0, 13.0, false),
        (401.0, 20.0, true),
        (-401.0, 20.0, true),
        (400.0, 20.0, false),
        (301.0, 0.0, false),
    ] {
        for component in ["u", "v", "w"] {
            let found = marked(component, mark, 3, others);
            let said = format!("has a velocity of {mark} m/s at 3 places and no other beyond {others} m/s");
            let is_told = found.as_ref().is_err_and(|error| error.contains(&said));
            assert_eq!(
                (is_told, found.is_err()),
                (is_mark, is_mark),
                "{component} {mark} {others}: {found:?}"
            );
        }
    }
    assert_eq!(
        [1, 2, 9, 10].map(|count| marked("u", 9999.0, count, 13.0).is_err()),
        [false, true, true, false]
    );
}

/// Down to a thousandth of the largest value: zero below zero, with a warning.
#[test]
fn rejects_energies_below_zero_by_more_than_rounding() {
    let read = |least: &str| {
        let rows: String = (0..20)
            .map(|i| format!("{},{},10,0,{},5\n", i % 5, i / 5, if i == 7 { least } else { "2" }))
            .collect();
        let text = format!("x,y,u,v,k,epsilon\n{rows}");
        let read = Field::parse(text.as_bytes(), "a.csv").map_err(|error| error.to_string());
        read.map(|(field, warnings)| {
            // In the middle between that point and the next.
            let k = field.sample(Vec3::new(2.5, 1.0, 0.0), &mut Hint::default()).k;
            assert_eq!(k, 1.0, "{least}");
            warnings.into_iter().map(|warning| warning.message.into_owned()).collect::<Vec<_>>()
        })
    };
    assert_eq!(read("0"), Ok(Vec::new()));
    for least in ["-0.0000001", "-0.002"] {
        assert_eq!(
            read(least),
            Ok(vec!["k is negative at 1 point; zero is used there".to_owned()]),
            "{least}"
        );
    }
    let error = read("-0.0021").unwrap_err();
    let said = "is below zero at 1 point, and it cannot be: its smallest value is -0.0021 and its largest 2. Only \
                values down to -0.1 % of the largest count as rounding";
    assert!(error.contains(said), "{error}");
}
