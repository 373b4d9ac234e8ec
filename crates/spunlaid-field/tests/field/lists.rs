//! Lists of files are the field that their parts are together, and a list that cannot be read says which part
//! is to blame.

use crate::air::{mesh, samples, values};
use crate::meshes::{Made, noise};
use crate::vtk::{ASCII, DataPlace, Mesh, Squeeze, Style, vti, vtu};
use spunlaid_field::{Description, Field, Hint};
use spunlaid_ground::{Fault, Vec3};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const SURFACES: &str = "the list names surfaces too (.vtp: 1), perhaps the boundary; they are left out";

const ZLIB: Style = Style { place: DataPlace::AppendedRaw, squeeze: Squeeze::Zlib, ..ASCII };

/// A folder of files.
fn folder(files: &[(&str, &[u8])]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    folder
}

/// A list of pieces of a kind of grid.
fn pieces(kind: &str, parts: &[&str]) -> String {
    let parts: String = parts.iter().map(|part| format!("<Piece Source=\"{part}\"/>\n")).collect();
    format!(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"P{kind}\" version=\"0.1\">\n<P{kind} GhostLevel=\"0\">\n\
        {parts}</P{kind}>\n</VTKFile>\n"
    )
}

/// A list of blocks, the first of which is within another block.
fn blocks(parts: &[&str]) -> String {
    let (first, others) = parts.split_first().unwrap();
    let block = |part: &&str| format!("<DataSet index=\"0\" file=\"{part}\"/>\n");
    let others: String = others.iter().map(block).collect();
    let kind = "vtkMultiBlockDataSet";
    format!(
        "<VTKFile type=\"{kind}\" version=\"1.0\">\n<{kind}>\n<Block index=\"0\">\n{}</Block>\n\
        <DataSet index=\"9\"/>\n{others}</{kind}>\n</VTKFile>\n",
        block(first)
    )
}

fn said(folder: &TempDir, name: &str) -> String {
    let error = Field::read(&folder.path().join(name)).expect_err("this is no field");
    let said = error.to_string().replace(&format!("{}/", folder.path().display()), "");
    assert!(said.chars().all(|c| !c.is_control()), "{said:?}");
    said
}

#[test]
fn identical_in_one_file_and_in_a_list_of_files() {
    let halves: Vec<Mesh> = [0.0, 1.0]
        .map(|shift| {
            let mut half = mesh(Made::Mixed, 0.0);
            half.points.iter_mut().for_each(|point| point[0] = 0.5 * (point[0] + shift));
            half.point_data = values(&half.points);
            half
        })
        .into();
    let [first, second] = [&halves[..1], &halves[1..]].map(|half| vtu(half, ZLIB));
    let folder = folder(&[
        ("whole.vtu", &vtu(&halves, ASCII)),
        ("parts/first.vtu", &first),
        ("parts/second.vtu", &second),
        ("a.pvtu", pieces("UnstructuredGrid", &["parts/first.vtu", "parts/second.vtu"]).as_bytes()),
        ("b.vtm", blocks(&["./parts/first.vtu", "parts/../parts/second.vtu"]).as_bytes()),
        ("walls.vtm", blocks(&["parts/first.vtu", "no/walls.vtp", "parts/second.vtu"]).as_bytes()),
        ("parts/both.pvtu", pieces("UnstructuredGrid", &["first.vtu", "second.vtu"]).as_bytes()),
        ("nested.vtm", blocks(&["parts/both.pvtu"]).as_bytes()),
    ]);
    let (whole, _) = Field::read(&folder.path().join("whole.vtu")).unwrap();
    assert!(samples(&whole).iter().filter(|local| local.inside).count() > 100);
    for name in ["a.pvtu", "b.vtm", "nested.vtm", "walls.vtm"] {
        let (field, warnings) = Field::read(&folder.path().join(name)).unwrap();
        assert_eq!(samples(&field), samples(&whole), "{name}");
        let surfaces = if name == "walls.vtm" { vec![Fault::plain(SURFACES)] } else { Vec::new() };
        assert_eq!(warnings, surfaces, "{name}");
    }
}

#[test]
fn identical_image_in_one_file_and_in_a_list() {
    // Three points along x, in two files of two columns each.
    let image = |columns: &[f64], origin: f64| {
        let points: Vec<[f64; 3]> = (0..6)
            .flat_map(|i| columns.iter().map(move |x| [*x, f64::from(i % 2), f64::from(i / 2)]))
            .collect();
        vti([columns.len(), 2, 3], [origin, 0.0, 0.0], [0.5, 1.0, 1.0], [&values(&points), &[]], ASCII)
    };
    let folder = folder(&[
        ("whole.vti", &image(&[0.0, 0.5, 1.0], 0.0)),
        ("left.vti", &image(&[0.0, 0.5], 0.0)),
        ("right.vti", &image(&[0.5, 1.0], 0.5)),
        ("list.pvti", pieces("ImageData", &["right.vti", "left.vti"]).as_bytes()),
    ]);
    let read = |name: &str| Field::read(&folder.path().join(name)).unwrap().0;
    let (whole, list) = (read("whole.vti"), read("list.pvti"));
    assert_eq!(list.describe(), Description::Lattice { points: [3, 2, 3] });
    assert_eq!(samples(&list), samples(&whole));
}

#[test]
fn lists_of_vtk_itself_are_read() {
    let lists = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/lists");
    for name in ["blocks.vtm", "parallel.pvtu", "image.pvti", "rectilinear.pvtr", "structured.pvts"] {
        let (field, warnings) = Field::read(&lists.join(name)).unwrap_or_else(|error| panic!("{error}"));
        let surfaces = warnings.contains(&Fault::plain(SURFACES));
        assert_eq!(surfaces, name == "blocks.vtm", "{warnings:?}");
        // All hold the same linear field on or around a unit cube, in 32 bits at the least.
        let mut hint = Hint::default();
        for i in 0..100 {
            let [x, y, z] = [0, 1, 2].map(|axis| 0.5 + 0.4 * noise(3 * i + axis));
            let local = field.sample(Vec3::new(x, y, z), &mut hint);
            let wanted = Vec3::new(1.0 + x, 2.0 * y - z, x + y + z);
            assert!(local.inside, "{name}");
            assert!((local.velocity - wanted).norm() < 1e-5, "{name}: {local:?} {wanted:?}");
            assert!((local.k - (1.0 + z)).abs() < 1e-5 && (local.epsilon - (2.0 + y)).abs() < 1e-5, "{name}");
        }
    }
}

#[test]
fn rejects_lists_with_the_part_that_is_to_blame() {
    let whole = mesh(Made::Hexahedra, 0.0);
    let laminar = Mesh { point_data: whole.point_data[..2].to_vec(), ..whole.clone() };
    let pressure = Mesh { point_data: whole.point_data[..1].to_vec(), ..whole.clone() };
    let grid = vtu(std::slice::from_ref(&whole), ASCII);
    let outside = folder(&[("a.vtu", &grid)]);
    let absolute = outside.path().join("a.vtu");
    let image = vti([2, 2, 2], [0.0; 3], [1.0; 3], [&[("U", 3, vec![0.0; 24])], &[]], ASCII);
    let list = |parts: &[&str]| pieces("UnstructuredGrid", parts);
    let folder = folder(&[
        ("a.vtu", &grid),
        ("laminar.vtu", &vtu(&[laminar], ASCII)),
        ("pressure.vtu", &vtu(&[pressure], ASCII)),
        ("image.vti", &image),
        ("table.csv", b"x,y,u,v\n0,0,1,2\n"),
        ("cut.vtu", &grid[..grid.len() / 2]),
        ("missing.pvtu", list(&["a.vtu", "b.vtu"]).as_bytes()),
        ("itself.pvtu", list(&["itself.pvtu"]).as_bytes()),
        ("one.vtm", blocks(&["two.vtm"]).as_bytes()),
        ("two.vtm", blocks(&["a.vtu", "one.vtm"]).as_bytes()),
        ("above.vtm", blocks(&["x/../../a.vtu"]).as_bytes()),
        ("absolute.vtm", blocks(&[absolute.to_str().unwrap()]).as_bytes()),
        ("mixed.pvtu", list(&["a.vtu", "image.vti"]).as_bytes()),
        ("twice.pvtu", list(&["a.vtu", "./a.vtu"]).as_bytes()),
        ("walls.pvtu", list(&["a.vtu", "walls.vtp"]).as_bytes()),
        ("surfaces.vtm", blocks(&["walls.vtp", "outlet.vtp"]).as_bytes()),
        ("empty.pvtu", list(&[]).as_bytes()),
        ("some.vtm", blocks(&["a.vtu", "laminar.vtu"]).as_bytes()),
        ("no_velocity.pvtu", list(&["a.vtu", "pressure.vtu"]).as_bytes()),
        ("table.vtm", blocks(&["table.csv"]).as_bytes()),
        ("cut.vtm", blocks(&["cut.vtu"]).as_bytes()),
        ("folder.vtm", blocks(&["."]).as_bytes()),
        ("latin.pvtu", b"<VTKFile type=\"PImageData\">\n\xfc"),
        ("broken.pvtu", &list(&["a.vtu"]).as_bytes()[..100]),
    ]);
    for (name, wanted) in [
        (
            "missing.pvtu",
            "missing.pvtu:5: names the part \"b.vtu\", which is not there; copy it to that path next to the list",
        ),
        ("walls.pvtu", "walls.pvtu:5: names the part \"walls.vtp\", which is not there;"),
        (
            "itself.pvtu",
            "itself.pvtu:4: names the part \"itself.pvtu\", which is this list itself or a list that names it;",
        ),
        (
            "one.vtm",
            "two.vtm:7: names the part \"one.vtm\", which is this list itself or a list that names it;",
        ),
        (
            "above.vtm",
            "above.vtm:4: names the part \"x/../../a.vtu\", which is outside of the list’s own folder;",
        ),
        ("absolute.vtm", "which is outside of the list’s own folder; put it into that folder or one below"),
        ("mixed.pvtu", "image.vti: is a VTK file of ImageData; its list names parts of another kind of grid"),
        ("twice.pvtu", "twice.pvtu:5: names the part \"./a.vtu\", which it has named before; name it once"),
        (
            "surfaces.vtm",
            "surfaces.vtm: is a list that names no file with a volume, only 2 with surfaces (.vtp);",
        ),
        ("empty.pvtu", "empty.pvtu: is a list that names no file with a volume; name the file"),
        (
            "some.vtm",
            "some.vtm: has k and ε (or ω) in some of its parts only; write them in all parts, or in none",
        ),
        ("no_velocity.pvtu", "pressure.vtu: none of the arrays is a velocity (p); name it U"),
        ("table.vtm", "table.csv: is not a VTK file; write this part as one"),
        ("cut.vtm", "cut.vtu:"),
        ("folder.vtm", "is a folder; name the field of air in it"),
        ("latin.pvtu", "latin.pvtu:2: is not valid XML: it is not UTF-8 text"),
        ("broken.pvtu", "broken.pvtu:"),
    ] {
        let said = said(&folder, name);
        assert!(said.contains(wanted), "{name}: {said}");
    }
    // Thousands of lists, each in the next, overflowed the stack.
    let chain: Vec<(String, String)> =
        (0..40).map(|i| (format!("{i}.vtm"), blocks(&[&format!("{}.vtm", i + 1)]))).collect();
    let chain: Vec<(&str, &[u8])> = chain.iter().map(|(name, text)| (&**name, text.as_bytes())).collect();
    let deep = said(&self::folder(&chain), "0.vtm");
    assert!(deep.contains("31.vtm:") && deep.contains("at most 32 may lie in each other"), "{deep}");
    // Bytes alone have no folder.
    let error =
        Field::parse(list(&["a.vtu"]).as_bytes(), "a.pvtu").expect_err("this is no field").to_string();
    assert_eq!(error, "a.pvtu: is a VTK file that lists other files; name it by its path");
}
