//! Cases whose air is a field: what may be a slip is reported with the key that is to blame, and the way out.

use spunlaid_fibre::Case;
use spunlaid_input::{read_case, starter_case, write_case};
use std::fs;
use tempfile::TempDir;

/// A table of points on a lattice over a box of 1.2 by 0.2 by 0.2, and its air at a place.
fn table(names: &str, values: &str, scale: f64) -> String {
    let mut text = format!("x,y,z,{names}\n");
    for i in 0..3 * 3 * 7 {
        let x = f64::from(i % 7) * 0.2;
        let y = f64::from(i / 7 % 3) * 0.1;
        let z = f64::from(i / 21) * 0.1;
        text += &format!("{},{},{},{values}\n", scale * x, scale * y, scale * z);
    }
    text
}

/// A folder with a field of 10 m/s along x, with k and ε, as it is and in millimetres, and fields without some of them.
fn folder() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let names = "u_m_s,v_m_s,w_m_s,k,epsilon";
    for (file, text) in [
        ("metres.csv", table(names, "10,0.1,0,1.5,70", 1.0)),
        ("millimetres.csv", table(names, "10,0.1,0,1.5,70", 1000.0)),
        ("velocity.csv", table("u_m_s,v_m_s,w_m_s,p,nut", "10,0,0,3,1e-3", 1.0)),
        ("k.csv", table("u_m_s,v_m_s,w_m_s,k,nut", "10,0,0,1.5,1e-3", 1.0)),
        ("omega.csv", table("u_m_s,v_m_s,w_m_s,omega", "10,0,0,500", 1.0)),
    ] {
        fs::write(folder.path().join(file), text).unwrap();
    }
    folder
}

/// The starter case in a field, with its notes, or why it is refused.
fn read(folder: &TempDir, file: &str, more: &[(&str, &str)]) -> Result<(Case, Vec<String>), String> {
    let field = folder.path().join(file).display().to_string();
    let own = ["velocity", "turbulence_intensity", "length_scale", "cutoff_frequency"];
    let own = own.map(|key| (format!("air.{key}"), "auto".to_owned()));
    let more = more.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned()));
    let set: Vec<_> = own.into_iter().chain([("air.field".to_owned(), field)]).chain(more).collect();
    let (case, notes) = read_case((starter_case(), "a.toml"), &set).map_err(|error| error.to_string())?;
    Ok((case, notes.iter().map(ToString::to_string).collect()))
}

/// The notes that have these words.
fn with<'a>(notes: &'a [String], words: &[&str]) -> Vec<&'a String> {
    notes.iter().filter(|note| words.iter().all(|word| note.contains(word))).collect()
}

const SLIPS: [&str; 3] = ["lets the air flow along the fibre", "makes the field", "is outside of the box"];

#[test]
fn a_field_that_fits_the_fibre_is_no_slip() {
    let folder = folder();
    let (_, notes) = read(&folder, "metres.csv", &[]).unwrap();
    assert!(SLIPS.iter().all(|slip| with(&notes, &[slip]).is_empty()), "{notes:?}");
}

/// Air that turns about the line on which the fibre hangs: it moves everywhere but there.
#[test]
fn rejects_a_root_from_which_the_air_does_not_move_all_along_the_fibre() {
    let folder = folder();
    let mut text = "x,y,z,u_m_s,v_m_s,w_m_s,k,epsilon\n".to_owned();
    for i in 0..3 * 3 * 7 {
        let [x, y, z] = [0.2 * f64::from(i % 7), 0.1 * f64::from(i / 7 % 3), 0.1 * f64::from(i / 21)];
        text += &format!("{x},{y},{z},0,{},{},1.5,70\n", 100.0 * (0.1 - z), 100.0 * (y - 0.1));
    }
    fs::write(folder.path().join("turning.csv"), text).unwrap();
    let error = read(&folder, "turning.csv", &[]).unwrap_err();
    assert!(
        error.contains("air.field_root = [\"0 m\", \"100 mm\", \"100 mm\"]")
            && error.contains("does not move all along the fibre")
            && error.contains("air.field_axis")
            && !error.contains("NaN"),
        "{error}"
    );
    let aside = ("air.field_root", "['0 m', '50 mm', '100 mm']");
    let (_, notes) = read(&folder, "turning.csv", &[aside]).unwrap();
    assert_eq!(with(&notes, &["it blows across"]).len(), 1, "{notes:?}");
}

#[test]
fn warns_of_air_that_blows_up_the_fibre_or_across() {
    let folder = folder();
    for (axis, how) in [
        (
            "-x",
            "flow along the fibre with -10 m/s on average, although its speed is 10 m/s: it blows from the \
            end to the root",
        ),
        ("z", "flow along the fibre with 0 m/s on average, although its speed is 10 m/s: it blows across"),
    ] {
        let (_, notes) = read(&folder, "metres.csv", &[("air.field_axis", axis)]).unwrap();
        let slip = with(
            &notes,
            &["air.field_axis", how, "choose the direction in which the air leaves the spinneret"],
        );
        assert_eq!(slip.len(), 1, "{axis}: {notes:?}");
    }
}

#[test]
fn warns_of_a_mesh_in_other_units_and_takes_a_unit_alone() {
    let folder = folder();
    let (_, notes) = read(&folder, "millimetres.csv", &[]).unwrap();
    let expected =
        "makes the field 1200 m long, while the fibre is 1 m long; check that this is the unit of the mesh";
    assert_eq!(with(&notes, &["air.field_unit", expected]).len(), 1, "{notes:?}");
    let with_unit = |unit| read(&folder, "millimetres.csv", &[("air.field_unit", unit)]).unwrap();
    let (one, alone) = (with_unit("1 mm"), with_unit("mm"));
    assert!(with(&one.1, &["makes the field"]).is_empty(), "{:?}", one.1);
    assert_eq!(write_case(&one.0), write_case(&alone.0));
    // And too small, by a factor of a thousand.
    let (_, notes) =
        read(&folder, "metres.csv", &[("air.field_unit", "mm"), ("fibre.element_length", "50 mm")]).unwrap();
    assert_eq!(with(&notes, &["air.field_unit", "makes the field 1.2 mm long"]).len(), 1, "{notes:?}");
}

#[test]
fn rejects_a_unit_for_coordinates_that_tell_theirs() {
    let folder = folder();
    let text = table("u_m_s,v_m_s,w_m_s,k,epsilon", "10,0.1,0,1.5,70", 1000.0);
    fs::write(folder.path().join("expected.csv"), text.replacen("x,y,z", "x_mm,y_mm,z_mm", 1)).unwrap();
    let (case, notes) = read(&folder, "expected.csv", &[]).unwrap();
    assert!(with(&notes, &["makes the field"]).is_empty(), "{notes:?}");
    assert!(case.check().is_ok());
    let refused = read(&folder, "expected.csv", &[("air.field_unit", "1 mm")]).and_then(|(case, _)| {
        case.check()
            .map(|_| ())
            .map_err(|problems| problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n"))
    });
    let said = refused.unwrap_err();
    assert!(
        said.contains("air.field_unit")
            && said.contains("scales coordinates whose unit is in the file (x_mm)"),
        "{said}"
    );
}

#[test]
fn rejects_a_field_without_numbers_where_the_fibre_hangs() {
    let folder = folder();
    let whole = table("u_m_s,v_m_s,w_m_s,k,epsilon", "10,0.1,0,1.5,70", 1.0);
    let without = |place: &str, k: &str| {
        let from = format!("{place},10,0.1,0,1.5,70");
        assert!(whole.contains(&from));
        fs::write(folder.path().join("gap.csv"), whole.replace(&from, &format!("{place},10,0.1,0,{k},70")))
            .unwrap();
        read(&folder, "gap.csv", &[]).and_then(|(case, notes)| match case.check() {
            Ok(_) => Ok(notes),
            Err(problems) => Err(problems.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")),
        })
    };
    // The fibre hangs in the middle, at y = z = 0.1 m; the last corner of the box is 0.14 m away.
    let (middle, corner) = ("0.6000000000000001,0.1,0.1", "1.2000000000000002,0.2,0.2");
    for k in ["NaN", "inf", ""] {
        let said = without(middle, k).unwrap_err();
        let expected = "has no air where the fibre hangs: k has no number at 1 point; it is in line 33";
        assert!(said.contains("air.field = ") && said.contains(expected), "{said}");
    }
    let notes = without(corner, "nan").unwrap_or_default();
    assert_eq!(with(&notes, &["k has no number at 1 point; it is in line 64"]).len(), 1, "{notes:?}");
}

#[test]
fn a_root_outside_of_the_field_is_to_blame_rather_than_the_fibre() {
    let folder = folder();
    let (_, notes) =
        read(&folder, "metres.csv", &[("air.field_root", "[\"5 m\", \"0 m\", \"0 m\"]")]).unwrap();
    let expected = "is outside of the box around the field, [0 m, 0 m, 0 m] to [1.2 m, 200 mm, 200 mm]";
    assert_eq!(with(&notes, &["air.field_root", expected]).len(), 1, "{notes:?}");
    assert!(with(&notes, &["reaches out of the region"]).is_empty(), "{notes:?}");
    // A fibre that is too long for the field is to blame itself.
    let (_, notes) = read(&folder, "metres.csv", &[("fibre.length", "2 m")]).unwrap();
    let expected = "reaches out of the region where the flow is known";
    assert_eq!(with(&notes, &["fibre.length", expected]).len(), 1, "{notes:?}");
}

#[test]
fn rejects_fields_without_turbulence_with_what_is_missing_and_what_is_there() {
    let folder = folder();
    for (file, lacks) in [
        ("velocity.csv", "it has neither k nor ε nor ω among"),
        ("k.csv", "it has k but neither ε nor ω among"),
        ("omega.csv", "it has ε or ω but no k among"),
    ] {
        let said = read(&folder, file, &[]).unwrap_err();
        assert!(said.contains(lacks) && said.contains("u_m_s"), "{file}: {said}");
        assert_eq!(said.contains("nut"), file != "omega.csv", "{file}: {said}");
        for key in ["turbulence_intensity", "length_scale", "cutoff_frequency"] {
            assert!(said.contains(&format!("air.{key}")), "{file}: {said}");
        }
        // The way out: the case says what the field does not.
        let own = [
            ("air.turbulence_intensity", "10 %"),
            ("air.length_scale", "50 mm"),
            ("air.cutoff_frequency", "100 Hz"),
        ];
        assert!(read(&folder, file, &own).is_ok(), "{file}");
    }
}
