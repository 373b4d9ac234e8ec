//! What must hold whatever the readers are given: of the fuzzers' inputs, and of their findings in the tests.

use spunlaid::air::record::parse_record;
use spunlaid::air::{Field, Hint, Layout, record};
use spunlaid::input::{read_case, read_spinline, read_web, starter_case, write_case, write_spinline};
use spunlaid::web::{Light, scan};
use std::fmt::Display;

/// A message never breaks the terminal or the log that it is written to.
///
/// * `lines` – most lines it may have
fn assert_sayable(message: &dyn Display, lines: usize) {
    let said = message.to_string();
    assert!(said.lines().count() <= lines, "{said}");
    assert!(said.chars().all(|c| c == '\n' || !c.is_control()), "{said:?}");
}

/// A case file is read or refused; what is read passes its check, and writes and reads back to the same bits.
/// Gives whether it was read.
///
/// After a first line `--set`, the lines `key=value` are overrides of the starter.
pub fn case(data: &[u8]) -> bool {
    let text = String::from_utf8_lossy(data);
    let (text, set) = match text.strip_prefix("--set\n") {
        Some(set) => (starter_case(), set),
        None => (&*text, ""),
    };
    let set: Vec<_> = (set.lines().filter_map(|line| line.split_once('=')))
        .map(|(key, value)| (key.to_owned(), value.to_owned()))
        .collect();
    match read_case((text, "fuzz.toml"), &set) {
        Ok((case, notes)) => {
            notes.iter().for_each(|note| assert_sayable(note, 1));
            if let Err(problems) = case.check() {
                panic!("{problems:?}");
            }
            let written = write_case(&case);
            match read_case((&written, "written.toml"), &[]) {
                Ok((again, _)) => {
                    assert_eq!(format!("{again:?}"), format!("{case:?}"), "{written}");
                    assert_eq!(write_case(&again), written);
                }
                Err(error) => panic!("{error}\n{written}"),
            }
            true
        }
        Err(error) => {
            // Twenty problems, and how many more there are.
            assert_sayable(&error, 21);
            false
        }
    }
}

/// A velocity record is read or refused; what is read can be analysed or is refused for a
/// reason. Gives whether it was read.
pub fn record(data: &[u8]) -> bool {
    let rate = Layout { rate: Some(1e4), velocity_unit: Some("m/s".to_owned()), ..Layout::default() };
    let mut any = false;
    for layout in [Layout::default(), rate] {
        match parse_record(data, "fuzz.csv", &layout) {
            Ok(found) => {
                for component in &found.components {
                    assert_eq!(component.values.len(), found.samples());
                    assert!(component.values.iter().all(|x| x.is_finite()));
                }
                assert!(found.interval > 0.0);
                match record::analyse(&found, &record::Settings::default()) {
                    Ok(analysis) => analysis.warnings.iter().for_each(|warning| assert_sayable(warning, 1)),
                    Err(error) => assert_sayable(&error, 1),
                }
                any = true;
            }
            Err(error) => assert_sayable(&error, 1),
        }
    }
    any
}

/// A file of air, VTK or a table, is read or refused; what is read can be asked anywhere. Gives whether it was
/// read.
pub fn field(data: &[u8]) -> bool {
    match Field::parse(data, "fuzz.vtu") {
        Ok((field, warnings)) => {
            warnings.iter().for_each(|warning| assert_sayable(warning, 1));
            let (low, high) = field.bounds();
            let mut hint = Hint::default();
            for share in [0.0, 0.1, 0.33, 0.5, 0.9, 1.0, 1.7] {
                for at in [low + (high - low) * share, low - high * share] {
                    let local = field.sample(at, &mut hint);
                    let velocity = [local.velocity.x, local.velocity.y, local.velocity.z];
                    assert!(
                        velocity.into_iter().chain([local.k, local.epsilon]).all(f64::is_finite),
                        "{local:?}"
                    );
                }
            }
            true
        }
        Err(error) => {
            assert_sayable(&error, 1);
            false
        }
    }
}

/// Pixels of a picture that is analysed, at most: larger ones take long and show nothing new.
const PIXELS: usize = 1 << 14;

/// A scan or a map of a web is read or refused, with the size of its pixels or without; what is read can be
/// analysed or is refused for a reason. Gives whether it was read.
pub fn scan(data: &[u8]) -> bool {
    let mut any = false;
    for pixel in [None, Some(1e-4)] {
        match scan::parse(data, "fuzz.png", pixel) {
            Ok(picture) => {
                any = true;
                assert_eq!(picture.values.len(), picture.columns * picture.rows);
                assert!(picture.pixel.is_finite() && picture.pixel > 0.0);
                if picture.values.len() > PIXELS {
                    continue;
                }
                let transmitted = Light::Transmitted { mean: None, white: None };
                let weight = Light::Weight { mean: None };
                for light in [transmitted, weight] {
                    match scan::analyse(&picture, &scan::Settings::new(light)) {
                        Ok(found) => {
                            found.notes.iter().for_each(|note| assert_sayable(note, 1));
                            assert!(found.patches.iter().all(|patch| patch.patch_cv.cv.is_finite()));
                        }
                        Err(error) => assert_sayable(&error, 1),
                    }
                }
            }
            Err(error) => assert_sayable(&error, 1),
        }
    }
    any
}

/// The file of a web is read or refused; what is read writes and reads back to the same bits. Gives whether
/// it was read.
pub fn web(data: &[u8]) -> bool {
    match read_web((&String::from_utf8_lossy(data), "fuzz.toml"), &[]) {
        Ok(web) => {
            web.notes.iter().for_each(|note| assert_sayable(note, 1));
            match read_web((&web.text, "written.toml"), &[]) {
                Ok(again) => {
                    assert_eq!(format!("{:?}", again.spec), format!("{:?}", web.spec), "{}", web.text);
                    assert_eq!(again.text, web.text);
                }
                Err(error) => panic!("{error}\n{}", web.text),
            }
            true
        }
        Err(error) => {
            assert_sayable(&error, 21);
            false
        }
    }
}

/// Rows of a curtain that is solved, at most: more of them take long and show nothing new.
const ROWS: u64 = 8;

/// The file of a spinline is read or refused; what is read writes and reads back to the same bits, and is
/// solved or refused for a reason. Gives whether it was read.
///
/// What stands after a line `--air` is the table of the air along the line.
pub fn spinline(data: &[u8]) -> bool {
    let text = String::from_utf8_lossy(data);
    let (text, air) = text.split_once("\n--air\n").unwrap_or((&text, ""));
    let mut set = Vec::new();
    if !air.is_empty() {
        let path = std::env::temp_dir().join(format!("spunlaid_fuzz_{}.csv", std::process::id()));
        std::fs::write(&path, air).expect("a folder for temporary files");
        set.push(("spinline.profile".to_owned(), path.display().to_string()));
    }
    match read_spinline((text, "fuzz.toml"), &set) {
        Ok(file) => {
            file.notes.iter().for_each(|note| assert_sayable(note, 1));
            let written = write_spinline(&file.spec);
            match read_spinline((&written, "written.toml"), &[]) {
                Ok(again) => {
                    assert_eq!(format!("{:?}", again.spec), format!("{:?}", file.spec), "{written}");
                    assert_eq!(write_spinline(&again.spec), written);
                }
                Err(error) => panic!("{error}\n{written}"),
            }
            if file.spec.spinline.curtain.is_some_and(|curtain| curtain.rows > ROWS) {
                return true;
            }
            match file.solve() {
                Ok(rows) => {
                    for row in &rows {
                        let end = [row.final_speed, row.final_diameter, row.linear_density];
                        assert!(end.into_iter().all(|x| x.is_finite() && x > 0.0), "{end:?}\n{written}");
                        let distances = row.stations.iter().map(|station| station.distance);
                        assert!(distances.is_sorted(), "{written}");
                    }
                }
                Err(error) => assert_sayable(&error, 21),
            }
            true
        }
        Err(error) => {
            assert_sayable(&error, 21);
            false
        }
    }
}
