use super::*;

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
    assert_eq!(Head::new("u [m/s]").unit.as_deref(), Some("m/s"));
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
    assert!(message("t,u\n0,1\n1\n").starts_with("a.csv:3: this row has 1 cell and needs 2"));
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
