//! Fields whose arrays have names of the user's own: the keys of a case say what they are.

use crate::air::{mesh, samples, values};
use crate::meshes::Made;
use crate::vtk::{ASCII, Data, Legacy, Mesh, legacy, vti, vtu};
use spunlaid_air::Flow;
use spunlaid_fibre::Case;
use spunlaid_input::{read_case, starter_case, write_case};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The keys of a field with German names.
const GERMAN: [(&str, &str); 3] = [
    ("air.field_velocity", "Geschwindigkeit"),
    ("air.field_k", "Turbulenzenergie"),
    ("air.field_epsilon", "Dissipation"),
];

/// A case in a field, or why it is refused.
fn read(path: &Path, keys: &[(&str, &str)]) -> Result<Case, String> {
    let own = ["velocity", "turbulence_intensity", "length_scale", "cutoff_frequency"];
    let own = own.map(|key| (format!("air.{key}"), "auto".to_owned()));
    let keys = keys.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned()));
    let file = [("air.field".to_owned(), path.display().to_string())];
    let set: Vec<_> = own.into_iter().chain(file).chain(keys).collect();
    read_case((starter_case(), "a.toml"), &set).map(|(case, _)| case).map_err(|error| {
        let folder = format!("{}/", path.parent().unwrap().display());
        error.to_string().replace(&folder, "")
    })
}

/// Writes a file and reads a case in it.
fn read_bytes(folder: &TempDir, name: &str, bytes: &[u8], keys: &[(&str, &str)]) -> Result<Case, String> {
    let path = folder.path().join(name);
    fs::write(&path, bytes).unwrap();
    read(&path, keys)
}

fn air(case: &Case) -> Vec<spunlaid_air::Local> {
    let Flow::Field(placed) = &case.air.flow else { panic!("the air is a field") };
    samples(&placed.field)
}

/// What was read, and from which arrays.
fn sources(case: &Case) -> Vec<(&'static str, String)> {
    let Flow::Field(placed) = &case.air.flow else { panic!("the air is a field") };
    placed.field.sources().to_vec()
}

/// The arrays with other names.
fn renamed(data: &[Data], names: [&'static str; 4]) -> Vec<Data> {
    data.iter()
        .zip(names)
        .map(|((_, components, numbers), name)| (name, *components, numbers.clone()))
        .collect()
}

fn german(data: &[Data]) -> Vec<Data> {
    renamed(data, ["Druck", "Geschwindigkeit", "Turbulenzenergie", "Dissipation"])
}

fn with_names(mesh: &Mesh, names: impl Fn(&[Data]) -> Vec<Data>) -> Mesh {
    Mesh { point_data: names(&mesh.point_data), cell_data: names(&mesh.cell_data), ..mesh.clone() }
}

#[test]
fn identical_with_german_names_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let mesh = mesh(Made::Mixed, 0.0);
    let in_german = with_names(&mesh, german);
    let mut of_cells = Mesh { point_data: Vec::new(), ..mesh.clone() };
    of_cells.cell_data = values(&mesh.points[..mesh.cells.len()]);
    let list = |part: &str| {
        format!(
            "<VTKFile type=\"PUnstructuredGrid\"><PUnstructuredGrid><Piece \
            Source=\"{part}\"/></PUnstructuredGrid></VTKFile>"
        )
    };
    let data = values(&(0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect::<Vec<_>>());
    let image = |data: &[Data]| vti([2; 3], [0.0; 3], [1.0; 3], [data, &[]], ASCII);
    let old_image = |data: &[Data]| {
        let mut file = Legacy::new("3.0", true, "STRUCTURED_POINTS");
        file.line("DIMENSIONS 2 2 2").data("POINT_DATA", 8, data).finish()
    };
    let plain = read_bytes(&folder, "plain.vtu", &vtu(std::slice::from_ref(&mesh), ASCII), &[]).unwrap();
    assert_eq!(
        sources(&plain),
        [("velocity", "U"), ("k", "k"), ("ε", "epsilon")]
            .map(|(quantity, array)| (quantity, array.to_owned()))
    );
    for (name, english, german) in [
        ("a.vtu", vtu(std::slice::from_ref(&mesh), ASCII), vtu(std::slice::from_ref(&in_german), ASCII)),
        (
            "cells.vtu",
            vtu(std::slice::from_ref(&of_cells), ASCII),
            vtu(&[with_names(&of_cells, german)], ASCII),
        ),
        ("text.vtk", legacy(&mesh, "3.0", false), legacy(&in_german, "3.0", false)),
        ("binary.vtk", legacy(&mesh, "5.1", true), legacy(&in_german, "5.1", true)),
        ("a.vti", image(&data), image(&german(&data))),
        ("image.vtk", old_image(&data), old_image(&german(&data))),
        ("a.pvtu", list("english.vtu").into_bytes(), list("a.vtu").into_bytes()),
    ] {
        fs::write(folder.path().join("english.vtu"), vtu(std::slice::from_ref(&mesh), ASCII)).unwrap();
        let usual = read_bytes(&folder, name, &english, &[]).unwrap();
        let case =
            read_bytes(&folder, name, &german, &GERMAN).unwrap_or_else(|said| panic!("{name}: {said}"));
        assert_eq!(air(&case), air(&usual), "{name}");
        assert!(air(&case).iter().any(|local| local.k > 0.0), "{name}");
        let arrays = [("velocity", GERMAN[0].1), ("k", GERMAN[1].1), ("ε", GERMAN[2].1)];
        assert_eq!(sources(&case), arrays.map(|(quantity, array)| (quantity, array.to_owned())), "{name}");
        // The written case has the keys and reads back.
        let written = write_case(&case);
        assert!(written.contains("field_velocity = \"Geschwindigkeit\""), "{written}");
        let again = read_case((&written, "again.toml"), &[]).unwrap().0;
        assert_eq!(air(&again), air(&usual), "{name}");
    }
}

/// A table of a box of 1 m, with the values of a point for each row.
fn table(head: &str, parting: &str, values: &str) -> Vec<u8> {
    let rows = (0..8).map(|i| {
        let scale = 1.0 + f64::from(i);
        let row: Vec<String> = [i & 1, i >> 1 & 1, i >> 2].map(|x| x.to_string()).into();
        let values = values.split(' ').map(|value| (value.parse::<f64>().unwrap() * scale).to_string());
        row.into_iter().chain(values).collect::<Vec<_>>().join(parting) + "\n"
    });
    format!("{head}\n{}", rows.collect::<String>()).into_bytes()
}

#[test]
fn identical_with_german_names_in_every_table() {
    let folder = tempfile::tempdir().unwrap();
    let values = "10 2 3 1.5 70";
    let usual =
        read_bytes(&folder, "a.csv", &table("x_m,y_m,z_m,u,v,w,k,epsilon", ",", values), &[]).unwrap();
    let components = |names: &'static str| [("air.field_velocity", names), GERMAN[1], GERMAN[2]];
    for (head, parting, keys) in [
        ("x_m;y_m;z_m;Gx;Gy;Gz;Turbulenzenergie;Dissipation", ";", components("Gx, Gy, Gz")),
        // The name of the vector stands for its components, as ParaView writes them.
        (
            "\"Points:0\",\"Points:1\",\"Points:2\",\
            \"Geschwindigkeit:0\",\"Geschwindigkeit:1\",\"Geschwindigkeit:2\",Turbulenzenergie,Dissipation",
            ",",
            GERMAN,
        ),
        (
            "% Length unit: m\n% x  y  z  längs (m/s)  quer (m/s)  hoch (m/s)  Turbulenzenergie (m^2/s^2)  \
            Dissipation (m^2/s^3)",
            "   ",
            components("längs, quer, hoch (m/s)"),
        ),
    ] {
        let case = read_bytes(&folder, "a.csv", &table(head, parting, values), &keys)
            .unwrap_or_else(|said| panic!("{head}: {said}"));
        assert_eq!(air(&case), air(&usual), "{head}");
    }
    // Two components are a plane flow.
    let head = "x_m,y_m,z_m,a,b,c,Turbulenzenergie,Dissipation";
    let plane = read_bytes(&folder, "a.csv", &table(head, ",", values), &components("b,a")).unwrap();
    let first = |case: &Case| air(case)[0].velocity;
    assert_eq!([first(&plane).x, first(&plane).y, first(&plane).z], [first(&usual).y, first(&usual).x, 0.0]);
}

#[test]
fn units_are_those_of_the_names() {
    let folder = tempfile::tempdir().unwrap();
    let usual = table("x,y,z,u,v,w,k,epsilon", ",", "10 2 3 1.5 70");
    let usual = read_bytes(&folder, "a.csv", &usual, &[]).unwrap();
    let keys = |velocity| {
        [("air.field_velocity", velocity), ("air.field_k", "Energie"), ("air.field_epsilon", "Verlust")]
    };
    let values = "10000 2000 3000 1.5 70";
    for (heads, velocity) in [
        ("a_mm_s,b_mm_s,c_mm_s", "a,b,c"),
        ("a_mm_s,b_mm_s,c_mm_s", "a_mm_s, b_mm_s, c_mm_s"),
        ("a [mm/s],b [mm/s],c [mm/s]", "A, b [mm/s], c"),
    ] {
        let table = table(&format!("x,y,z,{heads},Energie,Verlust"), ",", values);
        let case = read_bytes(&folder, "a.csv", &table, &keys(velocity)).unwrap();
        for (a, b) in air(&case).iter().zip(air(&usual)) {
            // Rounding of the product with a thousandth.
            assert!((a.velocity.x / b.velocity.x - 1.0).abs() < 1e-12, "{heads}: {a:?} {b:?}");
        }
    }
    let table = table("x,y,z,a [km/h],b,c,Energie,Verlust", ",", values);
    let said = read_bytes(&folder, "a.csv", &table, &keys("a [km/h],b,c")).unwrap_err();
    assert!(said.contains("has the unit \"km/h\"; write the values in m/s, cm/s or mm/s"), "{said}");
}

#[test]
fn a_named_omega_comes_before_an_epsilon_of_the_usual_name() {
    let folder = tempfile::tempdir().unwrap();
    let table = table("x,y,z,u,v,w,k,epsilon,Frequenz", ",", "10 2 3 1.5 70 500");
    let case = read_bytes(&folder, "a.csv", &table, &[("air.field_omega", "Frequenz")]).unwrap();
    assert_eq!(sources(&case)[2], ("ω", "Frequenz".to_owned()));
    // k and ω grow with the number of the point, the first of which is 1.
    let Flow::Field(placed) = &case.air.flow else { panic!("the air is a field") };
    let origin = spunlaid_ground::Vec3::new(0.0, 0.0, 0.0);
    let epsilon = placed.field.sample(origin, &mut Default::default()).epsilon;
    assert!((epsilon - 0.09 * 1.5 * 500.0).abs() < 1e-12, "{epsilon}");
    let both = [("air.field_omega", "Frequenz"), ("air.field_epsilon", "epsilon")];
    let said = read(&folder.path().join("a.csv"), &both).unwrap_err();
    assert!(
        said.contains("air.field_omega = \"Frequenz\" cannot be combined with air.field_epsilon"),
        "{said}"
    );
}

#[test]
fn two_names_of_one_file_are_two_airs() {
    let folder = tempfile::tempdir().unwrap();
    let bytes = table("x,y,z,u,v,w,Vx,Vy,Vz,k,epsilon", ",", "10 2 3 5 1 1 1.5 70");
    let usual = read_bytes(&folder, "a.csv", &bytes, &[]).unwrap();
    let other = read(&folder.path().join("a.csv"), &[("air.field_velocity", "Vx,Vy,Vz")]).unwrap();
    assert!(usual.air.flow != other.air.flow);
    assert!(usual.air.flow == read(&folder.path().join("a.csv"), &[]).unwrap().air.flow);
}

#[test]
fn messages_offer_the_keys_with_arrays_of_the_file() {
    let folder = tempfile::tempdir().unwrap();
    let data = values(&(0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect::<Vec<_>>());
    let image = |names| vti([2; 3], [0.0; 3], [1.0; 3], [&renamed(&data, names), &[]], ASCII);
    let german = image(["Druck", "Geschwindigkeit", "Turbulenzenergie", "Dissipation"]);
    let half = image(["Druck", "U", "k", "Dissipation"]);
    let table = table("x,y,z,p,Gx,Gy,Gz", ",", "1 10 2 3");
    for (bytes, keys, wanted) in [
        (
            &german,
            &[][..],
            "none of the arrays is a velocity (Druck, Geschwindigkeit, Turbulenzenergie and Dissipation); \
            write air.field_velocity = \"Geschwindigkeit\" if this is it",
        ),
        (
            &table,
            &[],
            "none of the arrays is a velocity (x, y, z, p, Gx, Gy and Gz); write air.field_velocity = \"Gx, \
            Gy, Gz\" if this is it",
        ),
        (
            &german,
            &[("air.field_velocity", "Geschwindigkiet")],
            "a.vti: has no array \"Geschwindigkiet\", which air.field_velocity names; did you mean \
            \"Geschwindigkeit\"? The arrays are Druck, Geschwindigkeit, Turbulenzenergie and Dissipation",
        ),
        (
            &german,
            &[("air.field_velocity", "qqq")],
            "a.vti: has no array \"qqq\", which air.field_velocity names; the arrays are Druck, \
            Geschwindigkeit, Turbulenzenergie and Dissipation",
        ),
        (
            &german,
            &[("air.field_velocity", "Druck")],
            "air.field_velocity names \"Druck\" of 1 component, and it takes one array of three components, \
            or two or three arrays of one with commas between them, all at points or all in cells; the \
            arrays are",
        ),
        (
            &german,
            &[("air.field_velocity", "Geschwindigkeit"), ("air.field_k", "Geschwindigkeit")],
            "air.field_k names \"Geschwindigkeit\" of 3 components, and it takes an array of one component; \
            the arrays are",
        ),
        (
            &table,
            &[("air.field_velocity", "Gx, Gx, Gz")],
            "air.field_velocity names \"Gx\" of 1 component and \"Gx\" of 1 component and \"Gz\" of 1 \
            component, and it takes",
        ),
        (&table, &[("air.field_velocity", "Gx, Gy, Gz, p")], "and \"p\" of 1 component, and it takes"),
        (
            &half,
            &[],
            "air.length_scale is missing, and the field does not contain it: it has k but neither ε nor ω \
            among Druck, U, k and Dissipation; write these arrays too, or name those that have other names, \
            like air.field_epsilon = \"Dissipation\", or add length_scale",
        ),
        (
            &german,
            &[("air.field_velocity", "Geschwindigkeit")],
            "it has neither k nor ε nor ω among Druck, Geschwindigkeit, Turbulenzenergie and Dissipation; \
            write these arrays too, or name those that have other names, like air.field_k = ",
        ),
        (
            &german,
            &[("air.field_velocity", "Geschwindigkeit"), ("air.field_k", "Turbulenzenergie")],
            "air.field_k has no effect, because the field has k but neither ε nor ω among Druck, \
            Geschwindigkeit, Turbulenzenergie and Dissipation; write these arrays too, or name those that \
            have other names, like air.field_epsilon = \"Dissipation\", or leave air.field_k out",
        ),
    ] {
        let name = if std::ptr::eq(bytes, &table) { "a.csv" } else { "a.vti" };
        let said = read_bytes(&folder, name, bytes, keys).unwrap_err();
        assert!(said.contains(wanted), "{wanted}\n{said}");
    }
}

/// VTK writes blanks and umlauts in the names of legacy files as the numbers of their bytes.
#[test]
fn names_of_legacy_files_are_decoded() {
    let folder = tempfile::tempdir().unwrap();
    let data = values(&(0..8).map(|i| [i & 1, i >> 1 & 1, i >> 2].map(f64::from)).collect::<Vec<_>>());
    let names = ["100%", "Str%C3%B6mung%20Mittel", "turbulence%20kinetic%20energy", "epsilon"];
    let mut file = Legacy::new("3.0", true, "STRUCTURED_POINTS");
    let bytes = file.line("DIMENSIONS 2 2 2").data("POINT_DATA", 8, &renamed(&data, names)).finish();
    let case = read_bytes(&folder, "a.vtk", &bytes, &[("air.field_velocity", "Strömung Mittel")]).unwrap();
    assert_eq!(sources(&case)[0].1, "Strömung Mittel");
    assert_eq!(sources(&case)[1].1, "turbulence kinetic energy");
}
