use super::*;
use crate::units::Dimension;

/// The names of the columns and the numbers in these of them.
fn read(text: &str, columns: &[usize]) -> (Vec<String>, Vec<Vec<f64>>) {
    let mut table = Table::open(text.as_bytes(), FileKind::Table, 0).unwrap();
    let names = table.heads().iter().map(|head| head.name.clone()).collect();
    let mut rows = Vec::new();
    while table.next_row().unwrap() {
        rows.push(columns.iter().map(|column| table.number(*column).unwrap()).collect());
    }
    (names, rows)
}

#[test]
fn headers_are_taken_apart_however_they_are_spelt() {
    for (text, name, unit) in [
        ("u_m_s", "u", Some("m_s")),
        ("time_ms", "time", Some("ms")),
        ("U [m/s]", "U", Some("m/s")),
        ("Zeit (µs)", "Zeit", Some("µs")),
        ("t/s", "t", Some("s")),
        ("v m/s", "v", Some("m/s")),
        ("mean_u_cm_s", "mean_u", Some("cm_s")),
        ("velocity_x", "velocity_x", None),
        ("intensity [-]", "intensity", None),
        ("ratio (1)", "ratio", None),
        ("cutoff_frequency_hz", "cutoff_frequency", Some("hz")),
        ("", "", None),
        ("_", "", None),
    ] {
        let head = Head::new(text);
        assert_eq!((head.name.as_str(), head.unit.as_deref()), (name, unit), "{text}");
    }
}

#[test]
fn rows_begin_below_the_names_whatever_is_above_them() {
    let rows = vec![vec![0.0, 1.5], vec![1.0, 2.5]];
    for text in [
        "t_s,u_m_s\n0,1.5\n1,2.5\n",
        "Made;today\nRate;10\nChannels;2\n\nt_s;u_m_s\n0;1,5\n1;2,5\n",
        "20000\nt_s,u_m_s\n0,1.5\n1,2.5\n",
        "a file of mine\n# t_s u_m_s\n0 1.5\n# a word\n1 2.5",
        "t [s] u [m/s]\n0,0 1,5\n1,0 2,5\n",
        "t s u m/s\n0 1.5\n1 2.5\n".replace("t s", "t_s").as_str(),
        "t\tu\ns\tm/s\n0\t1.5\n1\t2.5\n",
        "\"t_s\",\"u_m_s\"\n\"0\",\"1.5\"\n\"1\",\"2.5\",,\n",
        "t_s,u_m_s\r0,1.5\r1,2.5\r",
        "t_s,u_m_s\r\n0,1.5\r\n1,2.5\r\n",
        "first,second\nt_s,u_m_s\n0,1.5\n1,2.5\n",
        // Decimal commas in quotation marks, and characters that take no room.
        "\"t_s\",\"u_m_s\"\n\"0,0\",\"1,5\"\n\"1,0\",\"2,5\"\n",
        "\u{feff}t_s\u{200b},u\u{ad}_m_s\n0,1.5\u{2060}\n\u{200e}1,2.5\n",
        // The faces between points that CFX-Post writes below them.
        "[Name]\nPlane 1\n\n[Data]\nt [ s ], u [ m s^-1 ]\n0, 1.5\n1, 2.5\n\n[Faces]\n0, 1, 2\n1, 2, 3, 4\n",
    ] {
        let (names, read) = read(text, &[0, 1]);
        assert_eq!((names, &read), (vec!["t".to_owned(), "u".to_owned()], &rows), "{text}");
    }
}

#[test]
fn columns_of_text_do_no_harm() {
    let toa5 = "\"TOA5\",\"mast\",\"CR1000\",\"12345\",\"CR1000.Std.27\",\"CPU:a.CR1\",\"9\",\"ten\"\n\
        \"TIMESTAMP\",\"RECORD\",\"u\",\"state\"\n\"TS\",\"RN\",\"m/s\",\"\"\n\"\",\"\",\"Smp\",\"Smp\"\n\
        \"2024-05-01 10:00:00\",1,10.5,\"on, still\"\n\"2024-05-01 10:00:00.1\",2,\"NAN\",\"on\"\n";
    let (names, rows) = read(toa5, &[1, 2]);
    assert_eq!(names, ["TIMESTAMP", "RECORD", "u", "state"]);
    assert_eq!(rows[0], [1.0, 10.5]);
    assert!(rows[1][1].is_nan());
    let table = Table::open(toa5.as_bytes(), FileKind::Table, 0).unwrap();
    let units: Vec<_> = table.heads().iter().map(|head| head.unit.as_deref()).collect();
    assert_eq!((units, table.header()), (vec![Some("TS"), Some("RN"), Some("m/s"), None], Position::Line(2)));
    assert_eq!(
        table.first_row(),
        [FirstCell::Stamp, FirstCell::Number, FirstCell::Number, FirstCell::Text("on, still".to_owned())]
    );
    // Two lines above the header look alike too, but fewer than the rows.
    let log = "Rate;20\nGain;7\nstamp;u_m_s;state\n10:00;1,5;on\n10:01;2,5;off\n10:02;;off\n";
    let (names, rows) = read(log, &[1]);
    assert_eq!(names, ["stamp", "u", "state"]);
    assert_eq!(rows[..2], [[1.5], [2.5]]);
}

#[test]
fn faults_name_line_and_column() {
    let message = |text: &str| {
        let mut table = Table::open(text.as_bytes(), FileKind::Table, 0).unwrap();
        loop {
            let read = table.next_row().and_then(|more| {
                Ok(more && {
                    table.number(1)?;
                    true
                })
            });
            match read {
                Ok(true) => {}
                Ok(false) => return String::new(),
                Err(error) => return error.file("a.csv").to_string(),
            }
        }
    };
    assert_eq!(
        message("t,u\n0,1\n\n1,x7\n"),
        "a.csv:4: column u: \"x7\" is not a number; write one, or leave the cell empty where a value is missing"
    );
    // In the first row too, which is not taken for words.
    assert_eq!(
        message("t,u\n0,x7\n1,2\n"),
        "a.csv:2: column u: \"x7\" is not a number; write one, or leave the cell empty where a value is missing"
    );
    for (row, said) in
        [("1", "1 cell and needs 2; is the file cut off"), ("1,2,3", "3 cells and needs 2; are both")]
    {
        let found = message(&format!("t,u\n0,1\n{row}\n"));
        assert!(found.starts_with(&format!("a.csv:3: this row has {said}")), "{found}");
    }
    assert_eq!(message("t,u\n0,1\n1,\n"), "");
}

#[test]
fn rejects_a_comma_in_quotation_marks_that_may_be_either_sign_and_a_further_block() {
    let refused = |text: &str| {
        let mut table = Table::open(text.as_bytes(), FileKind::Table, 0).unwrap();
        loop {
            match table.next_row() {
                Ok(true) => table.number(1).map(drop).unwrap(),
                Ok(false) => return String::new(),
                Err(error) => return error.to_string(),
            }
        }
    };
    let said = refused("t_s,u\n0,\"1,234\"\n1,\"2,345\"\n");
    assert!(said.contains("may be 1.234 or 1234"), "{said}");
    assert_eq!(refused("t_s,u\n0,\"1,234\"\n1,\"2,34\"\n"), "");
    let said = refused("[Data]\nt_s,u\n0,1\n1,2\n[Faces]\n0,1,2\n[Name]\nPlane 2\n[Data]\nt_s,u\n0,1\n");
    assert!(said.contains("another block of data begins here"), "{said}");
}

#[test]
fn messages_show_control_characters() {
    let error = FileError::from(Fault::no_rows()).file("t\u{8}les/\u{1b}[2J.csv").column("u\u{7}");
    assert!(error.to_string().chars().all(|c| !c.is_control()), "{error}");
}

#[test]
fn probes_of_openfoam_have_names_and_units() {
    let one = "# Probe 0 (0.1 0 0)\n#       Probe             0\n#        Time\n0 (10.0 0.5 0)\n0.001 (9 -1e-3 0)\n";
    let mut table = Table::open(one.as_bytes(), FileKind::Record, 0).unwrap();
    let heads: Vec<&str> = table.heads().iter().map(|head| head.text.as_str()).collect();
    assert_eq!(heads, ["Time [s]", "Ux [m/s]", "Uy [m/s]", "Uz [m/s]"]);
    assert!(table.next_row().unwrap() && table.next_row().unwrap());
    assert_eq!((table.number(0), table.number(2)), (Ok(0.001), Ok(-1e-3)));
    let two = "# Probe 0 (0.1 0 0)\n# Probe 4 (0.2 0 0)\n# Probe 0 4\n# Time\n0 (10 1 0) (11 2 0)\n";
    let table = Table::open(two.as_bytes(), FileKind::Record, 0).unwrap();
    let names: Vec<&str> = table.heads().iter().map(|head| head.name.as_str()).collect();
    assert_eq!(names[4..], ["Ux at probe 4", "Uy at probe 4", "Uz at probe 4"]);
    let unknown = Table::open(&b"# Time\n0 (10 1 0)\n1 (11 2 0)\n"[..], FileKind::Record, 0).unwrap();
    assert_eq!((unknown.named(), unknown.heads().len()), (false, 4));
}

#[test]
fn rejects_columns_with_one_name_also_in_other_spellings() {
    let refused = |heads: [&str; 4], read: &[usize]| {
        refuse_twice(&heads.map(Head::new), read).map_err(|error| error.to_string()).err().unwrap_or_default()
    };
    for heads in [["t_s", "u_m_s", "u [m/s]", "v_m_s"], ["t_s", "U (mm/s)", "u_m_s", "v_m_s"]] {
        assert!(refused(heads, &[1, 2]).contains("occurs twice, in columns 2 and 3"), "{heads:?}");
        // One of them alone is read.
        assert_eq!(refused(heads, &[0, 1]), "", "{heads:?}");
    }
    assert!(refused(["t", "u", "v", "U"], &[1]).contains("occurs twice, in columns 2 and 4"));
    assert_eq!(refused(["t", "U [i]", "U [j]", "w"], &[1, 2]), "");
}

#[test]
fn limit_a_line_has_so_many_bytes() {
    for (length, kind, said) in [
        (LONGEST_LINE, FileKind::Table, ""),
        (LONGEST_LINE + 1, FileKind::Table, "end each row with a line break"),
        (LONGEST_LINE + 1, FileKind::Scan, ".npy"),
    ] {
        let row = format!("0,{}", "0".repeat(length - 3));
        let read = Table::open(format!("t,u\n{row}\n1,2\n").as_bytes(), kind, 0).and_then(|mut table| {
            assert!(table.next_row()?);
            table.next_row()?;
            Ok(table.line())
        });
        match read {
            Ok(line) => assert_eq!((line, said), (3, "")),
            Err(error) => assert!(!said.is_empty() && error.to_string().contains(said), "{error}"),
        }
    }
}

#[test]
fn empty_lines_above_a_row_are_counted_and_rows_of_empty_cells_are_rows_between_tabs() {
    let read = |text: &str| {
        let mut table = Table::open(text.as_bytes(), FileKind::Table, 0).unwrap();
        let mut rows = Vec::new();
        while table.next_row().unwrap() {
            rows.push((table.number(1).unwrap().is_nan(), table.blank_lines()));
        }
        rows
    };
    let [full, empty] = [|blank: u64| (false, blank), |blank: u64| (true, blank)];
    assert_eq!(read("t,u\n0,1\n\n\n1,2\n\n# word\n\n2,3\n\t\n3,4\n"), [full(0), full(2), full(2), full(1)]);
    assert_eq!(read("t\tu\tv\n0\t1\t2\n\t\t\n\t\n1\t2\t3\n"), [full(0), empty(0), full(1)]);
}

#[test]
fn rejects_what_is_no_text() {
    let is_refused = |bytes: &[u8]| Table::open(bytes, FileKind::Table, 0).is_err();
    assert!(is_refused(b"\xff\xfet,u\n0,1\n") && is_refused(b"\xfe\xfft,u\n0,1\n"));
    assert!(is_refused(b"t,u\n0,1\n\0,2\n"));
    // In Latin-1 the same signs are letters.
    let mut table = Table::open(&b"name;u\n\xff\xfe;1\n\xfe\xff;2\n"[..], FileKind::Table, 0).unwrap();
    assert!(table.next_row().unwrap());
    assert_eq!((table.number(1), table.text(0)), (Ok(1.0), "\u{ff}\u{fe}"));
}

#[test]
fn a_remark_may_be_left_out_with_its_separator_and_quotation_marks_may_be_inches() {
    let (names, rows) = read("t,u,Remark\n0,1\n1,2,wind\n", &[0, 1]);
    assert_eq!((names.len(), rows), (3, vec![vec![0.0, 1.0], vec![1.0, 2.0]]));
    let mut cut_off = Table::open(&b"t,u,v,remark\n0,1,2\n1,2\n"[..], FileKind::Table, 0).unwrap();
    assert!(cut_off.next_row().unwrap() && cut_off.next_row().is_err());
    let (_, rows) = read("name,u\n1\" pipe,1.5\n2\" pipe,2.5\n", &[1]);
    assert_eq!(rows, [[1.5], [2.5]]);
    // Below a single name a comma is that of decimals; of two columns it is not.
    assert_eq!(read("u_m_s\n1,5\n2,5\n", &[0]).1, [[1.5], [2.5]]);
    assert_eq!(read("t_s,u_m_s\n1,5\n2,5\n", &[0, 1]).1, [[1.0, 5.0], [2.0, 5.0]]);
}

#[test]
fn rejects_numbers_with_another_decimal_sign_than_those_above() {
    let mut table = Table::open(&b"t;u\n0;1,5\n1;1.#QNAN\n2;2.5\n"[..], FileKind::Table, 0).unwrap();
    assert!(table.next_row().unwrap());
    assert_eq!((table.number(1), table.is_number(1), table.last_place(1)), (Ok(1.5), true, 0.1));
    assert!(table.next_row().unwrap() && table.number(1).unwrap().is_nan() && table.is_number(1));
    assert!(table.next_row().unwrap() && table.number(1).is_err());
    let mut text = Table::open(&b"t;u\n10:00:00;inf\n10:00:01;1\n"[..], FileKind::Table, 0).unwrap();
    assert!(text.next_row().unwrap() && text.stamp(0).is_some() && text.stamp(1).is_none());
    assert!(!text.is_number(0) && !text.is_number(1));
}

#[test]
fn headers_are_compared_with_names_and_give_factors_to_si() {
    let named = |text: &str, names: &[&str]| Head::new(text).named(names).map(|unit| unit.map(str::to_owned));
    let unit = |unit: &str| Some(Some(unit.to_owned()));
    assert_eq!(named("U Mean [m/s]", &["u_mean"]), unit("m/s"));
    assert_eq!(named("u-mean", &["u", "u_mean"]), Some(None));
    assert_eq!(named("velocity_x_foo", &["velocity", "velocity_x"]), unit("foo"));
    assert_eq!(named("w", &["u"]), None);
    let factor = |text: &str| Head::new(text).factor(Dimension::Velocity, "u_m_s");
    assert_eq!((factor("u [cm/s]"), factor("u_m_min")), (Ok(0.01), Ok(1.0 / 60.0)));
    assert!(factor("u").is_err() && factor("u [s]").is_err());
    for (unit, dimension, wanted) in [
        ("sec", Dimension::Time, Some(1.0)),
        ("ms^-1", Dimension::Velocity, Some(1.0)),
        ("KHZ", Dimension::Frequency, Some(1000.0)),
        ("percent", Dimension::Ratio, Some(0.01)),
        ("", Dimension::Ratio, Some(1.0)),
        ("sec", Dimension::Velocity, None),
    ] {
        assert_eq!(scale(unit, dimension), wanted, "{unit}");
    }
}

/// The longest list of lines that look alike holds the rows; a missing number looks like any other cell.
#[test]
fn rows_with_words_are_the_longest_list_of_lines_that_look_alike() {
    for (above, rows) in [
        ("Rate;20\nGain;7\n", "10:00;1,5;on\n10:01;;off\n10:02;2,5;off\n"),
        ("Rate;20\nGain;7;dB\n", "10:00;1,5;on\n"),
        ("Rate;20\nGain\t7\n", "10:00;1,5;on\n"),
    ] {
        let text = format!("{above}stamp;u_m_s;state\n{rows}");
        let (names, rows) = read(&text, &[1]);
        assert_eq!((names, rows[0][0]), (["stamp", "u", "state"].map(str::to_owned).to_vec(), 1.5), "{text}");
    }
    let (names, rows) = read("Rate;20;a\nGain;7;b\nn;u_m_s;state\n1;;on\n2;1,5;on\n3;2,5;on\n", &[0, 1]);
    assert_eq!((names[1].as_str(), rows.len(), rows[1].clone()), ("u", 3, vec![2.0, 1.5]));
}

#[test]
fn a_comment_or_a_title_above_the_rows_is_no_column() {
    let table = Table::open(&b"a file of mine\n# t_s u_m_s\n0 1.5\n1 2.5\n"[..], FileKind::Table, 0).unwrap();
    assert_eq!((table.header(), table.heads().len()), (Position::Line(2), 2));
    // A single name above two columns is too few, unless a comma may be that of decimals.
    for text in ["Title\n0\t1.5\n1\t2.5\n", "Title\n0;1.5\n1;2.5\n"] {
        let mut table = Table::open(text.as_bytes(), FileKind::Table, 0).unwrap();
        assert!(table.next_row().is_err(), "{text}");
    }
    // A line of blanks is no row of a single column.
    assert_eq!(read("u_m_s\n1.5\n\t\n2.5\n", &[0]).1, [[1.5], [2.5]]);
}
