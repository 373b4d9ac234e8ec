//! The air of a field is that of one time: several in one file are refused, whether they say so or not.

use spunlaid_field::Field;

/// A lattice of 6 × 3 × 3 points, 0.5 m long, where the air slows down from this speed by a quarter.
fn rows(speed: f64) -> Vec<String> {
    let row = |i: usize| {
        let [x, y, z] = [i % 6, i / 6 % 3, i / 18].map(|n| n as f64);
        let y = 0.05 * (y - 1.0);
        let z = 0.05 * (z - 1.0);
        let u = speed * (1.0 - 0.05 * x);
        format!("{},{y},{z},{u},0,0", 0.1 * x)
    };
    (0..54).map(row).collect()
}

/// These rows with the name and the value of a column before them.
fn with(value: &str, rows: &[String]) -> Vec<String> {
    rows.iter().map(|row| format!("{value},{row}")).collect()
}

fn table(head: &str, rows: &[Vec<String>]) -> String {
    format!("{head}\n{}\n", rows.concat().join("\n"))
}

fn said(text: &str) -> String {
    Field::parse(text.as_bytes(), "a.csv").expect_err(text).to_string()
}

const WAY_OUT: &str = "these seem to be several times, and the mean flow of a field is that of one; write one time \
    only, or the mean over time";

#[test]
fn rejects_columns_of_several_times() {
    for (head, times) in [
        ("TimeStep", ["0", "1"]),
        ("time", ["0.5", "0.50001"]),
        ("Time [s]", ["0.0", "1e-3"]),
        ("SOLUTIONTIME", ["0", "0.1"]),
        ("Flow-Time (ms)", ["5", "10"]),
        ("t", ["0", "1"]),
        ("t_s", ["0", "1"]),
        ("T [s]", ["0", "1"]),
        ("Zeit", ["0", "1"]),
    ] {
        let [first, second] = times;
        let both = [with(first, &rows(20.0)), with(second, &rows(40.0))];
        let found = said(&table(&format!("{head},x,y,z,u,v,w"), &both));
        let wanted =
            format!("a.csv:56: column {head}: has {second} here and {first} in the first row: {WAY_OUT}");
        assert_eq!(found, wanted);
    }
    // The places of the second time are others, so that only the column reports it.
    let half = [with("0", &rows(20.0)[..27]), with("1", &rows(40.0)[27..])];
    assert!(said(&table("time,x,y,z,u,v,w", &half)).contains(WAY_OUT));
}

#[test]
fn rejects_places_that_occur_several_times_with_different_air() {
    let one = rows(20.0);
    let other = rows(40.0);
    let third = rows(30.0);
    let in_turn = || one.iter().zip(&other).map(|(a, b)| vec![a.clone(), b.clone()]).collect::<Vec<_>>();
    let mut missing = in_turn();
    missing[17].pop();
    let shuffled: Vec<String> = (0..54).map(|i| other[i * 17 % 54].clone()).collect();
    for all in [
        vec![one.clone(), other.clone()],
        vec![one.clone(), other.clone(), third],
        vec![one.clone(), shuffled],
        // Cut off while the second time was written.
        vec![one.clone(), other[..20].to_vec()],
        in_turn(),
        missing,
    ] {
        let found = said(&table("x,y,z,u,v,w", &all));
        assert!(
            found.starts_with("a.csv: has all its points several times with different air, like ("),
            "{found}"
        );
        assert!(found.ends_with(WAY_OUT), "{found}");
    }
    let found = said(&table("x,y,z,u,v,w", &[one, other]));
    assert!(
        found.contains("like (0, -0.05, -0.05) m with 20 and 40 m/s (velocities off by 20 m/s)"),
        "{found}"
    );
}

/// COMSOL writes the time behind the name of each column.
#[test]
fn rejects_columns_at_several_times() {
    let text = |second: &str| {
        let at = |time: &str| format!("u (m/s) @ t={time}   v (m/s) @ t={time}   ");
        let rows = "0 0 1 2 3 4\n1 0 1 2 3 4\n0 1 1 2 3 4\n1 1 1 2 3 4\n".replace(' ', "     ");
        format!("% Length unit: m\n% x   y   {}{}\n{rows}", at("0"), at(second))
    };
    assert_eq!(said(&text("0.1")), format!("a.csv: has columns at t=0 and at t=0.1: {WAY_OUT}"));
    let one = text("0").replace("% x   y", "% x  y");
    let twice = Field::parse(one.as_bytes(), "a.txt").unwrap_err().to_string();
    assert!(twice.contains("column u (m/s) @ t=0: occurs twice, in columns 3 and 5"), "{twice}");
}

#[test]
fn one_time_is_read_whatever_else_repeats() {
    let one = rows(20.0);
    let hot: Vec<String> = one.iter().enumerate().map(|(i, row)| format!("{},{row}", 293 + i % 6)).collect();
    // Two blocks that meet in a plane, where their values differ.
    let joint: Vec<String> = rows(21.0)
        .iter()
        .map(|row| {
            let cells: Vec<&str> = row.split(',').collect();
            let z = match cells[2] {
                "-0.05" => "0.05",
                "0" => "0.1",
                _ => "0.15",
            };
            [&[cells[0], cells[1], z], &cells[3..]].concat().join(",")
        })
        .collect();
    // Cells with corners of their own, each of which a solver extrapolated: 1 to 8 points at a place.
    let corners = |cell: usize| {
        (0..8).map(move |i| {
            let [x, y, z] = [cell % 5 + (i & 1), cell / 5 % 5 + (i >> 1 & 1), cell / 25 + (i >> 2)];
            format!("{x},{y},{z},{},0,0", 20.0 + 0.1 * (cell % 7) as f64)
        })
    };
    for (head, all) in [
        ("time,x,y,z,u,v,w", vec![with("0.25", &one)]),
        ("Time [s],x,y,z,u,v,w", vec![with("0.25", &one[..30]), with("2.5e-1", &one[30..])]),
        ("T,x,y,z,u,v,w", vec![hot.clone()]),
        ("t,x,y,z,u,v,w", vec![hot.clone()]),
        ("T [K],x,y,z,u,v,w", vec![hot]),
        // The same air twice, but for rounding.
        ("x,y,z,u,v,w", vec![one.clone(), rows(20.001)]),
        ("x,y,z,u,v,w", vec![one.clone(), joint]),
        ("x,y,z,u,v,w", vec![(0..125).flat_map(corners).collect()]),
    ] {
        let read = Field::parse(table(head, &all).as_bytes(), "a.csv");
        assert!(read.is_ok(), "{head}: {}", read.unwrap_err());
    }
}

fn vtu(times: &str, from: f64) -> String {
    let points: String =
        (0..8).map(|i| format!("{} {} {} ", from + f64::from(i & 1), i >> 1 & 1, i >> 2)).collect();
    let array = |name: &str, kind: &str, of: usize, values: &str| {
        format!(
            "<DataArray type=\"{kind}\" Name=\"{name}\" NumberOfComponents=\"{of}\" \
             format=\"ascii\">{values}</DataArray>"
        )
    };
    format!(
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"><UnstructuredGrid><FieldData><Array type=\"String\" \
        Name=\"note\"/>{}</FieldData><Piece NumberOfPoints=\"8\" NumberOfCells=\"1\"><PointData>{}</PointData><Points>\
        {}\
        </Points><Cells>{}{}{}</Cells></Piece></UnstructuredGrid></VTKFile>",
        array("TimeValue", "Float64", 1, times),
        array("U", "Float64", 3, &"10 0 0 ".repeat(8)),
        array("Points", "Float64", 3, &points),
        array("connectivity", "Int64", 1, "0 1 2 3 4 5 6 7"),
        array("offsets", "Int64", 1, "8"),
        array("types", "UInt8", 1, "11"),
    )
}

#[test]
fn rejects_vtk_files_of_several_times() {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    let read = |name: &str| Field::read(&folder.path().join(name));
    write("early.vtu", &vtu("0.1", 0.0));
    write("late.vtu", &vtu("0.2", 1.0));
    write("rounded.vtu", &vtu("0.10000000149", 1.0));
    let list = |second: &str| {
        format!(
            "<VTKFile type=\"vtkMultiBlockDataSet\" version=\"1.0\"><vtkMultiBlockDataSet><DataSet index=\"0\" \
            file=\"early.vtu\"/><DataSet index=\"1\" file=\"{second}\"/></vtkMultiBlockDataSet></VTKFile>"
        )
    };
    write("times.vtm", &list("late.vtu"));
    write("parts.vtm", &list("rounded.vtu"));
    let found = read("times.vtm").unwrap_err().to_string();
    assert!(
        found.contains("late.vtu:1: TimeValue: is 0.2 here and 0.1 before: ") && found.ends_with(WAY_OUT),
        "{found}"
    );
    assert!(read("parts.vtm").is_ok() && read("late.vtu").is_ok());
    write("two.vtu", &vtu("0.1 0.100001", 0.0));
    assert!(read("two.vtu").unwrap_err().to_string().ends_with(WAY_OUT));
    let legacy = |times: &str, count: usize| {
        format!(
            "# vtk DataFile Version 3.0\na\nASCII\nDATASET STRUCTURED_POINTS\nFIELD FieldData 1\nTIME 1 {count} float\n\
            {times}\nDIMENSIONS 2 2 2\nPOINT_DATA 8\nVECTORS U float\n{}\n",
            "1 0 0 ".repeat(8)
        )
    };
    let parse = |text: &str| Field::parse(text.as_bytes(), "a.vtk");
    let found = parse(&legacy("0.5 1.5", 2)).unwrap_err().to_string();
    assert!(found.starts_with("a.vtk:6: TIME: is 1.5 here and 0.5 before: "), "{found}");
    // Zero is a time, and other arrays of the whole file are none.
    assert!(parse(&legacy("0.5", 1)).is_ok() && parse(&legacy("0", 1)).is_ok());
    assert!(parse(&legacy("0.5 1.5", 2).replace("TIME", "CYCLE")).is_ok());
}
