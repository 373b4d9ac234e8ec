//! The study to start from, beside every file of the repository that can be varied.

use spunlaid_ground::FileKind;
use spunlaid_input::{kind_of, parse_study, read_text, starter_study};
use std::path::{Path, PathBuf};

#[test]
fn every_case_web_and_spinline_has_a_study_to_start_from() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let mut counts = [0; 3];
    for entry in cases.read_dir().unwrap() {
        let path: PathBuf = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let text = starter_study(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let read = |named: &str, kind| {
            assert_eq!(cases.join(named), path);
            Ok((read_text(&path, kind)?, path.display().to_string()))
        };
        let file = parse_study(&text, "study.toml", None, read).unwrap();
        let study = &file.study;
        assert_eq!(study.points.len(), 3usize.pow(study.factors.len() as u32), "{}", path.display());
        assert_eq!(study.factors.len(), 2, "{}: {text}", path.display());
        // The middle point is the file itself.
        let base = |key: &str| study.factors.iter().position(|factor| factor.key.name == key);
        if let (Some(factor), "table1.toml") =
            (base("air.velocity"), &*path.file_name().unwrap().to_string_lossy())
        {
            assert_eq!(study.points[4].values[factor], 10.0);
        }
        counts[match kind_of(&path) {
            FileKind::Web => 1,
            FileKind::Spinline => 2,
            _ => 0,
        }] += 1;
    }
    assert!(counts.iter().all(|count| *count > 0), "{counts:?}");
}
