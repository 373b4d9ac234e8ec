//! Bad studies and their messages: each file `bad_studies/NAME.toml` is rejected with the message in
//! `bad_studies/NAME.txt`. With `BLESS=1` in the environment the test writes the messages, to be reviewed.
#![allow(clippy::panic)]
#![allow(clippy::unwrap_used)]

use spunlaid::error::{Error, FileFault, FileKind};
use spunlaid::input::read_study;
use std::fs;
use std::path::{Path, PathBuf};

#[test]
fn rejects_every_bad_study_with_its_message() {
    let entries = fs::read_dir("tests/bad_studies").unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    assert!(paths.len() > 25);
    let mut wrong = Vec::new();
    for path in paths {
        let said = match read_study(&path, None) {
            Ok(_) => "nothing\n".to_owned(),
            Err(error) => {
                assert_eq!(error.exit_code(), 1);
                format!("{error}\n").replace("bad_studies\\", "bad_studies/")
            }
        };
        let kept = path.with_extension("txt");
        if std::env::var_os("BLESS").is_some() {
            fs::write(&kept, &said).unwrap();
        }
        let meant = fs::read_to_string(&kept).unwrap_or_default();
        if said != meant {
            wrong.push(format!("{} says\n{said}and should say\n{meant}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn rejects_unreadable_files() {
    let refusal = |path: &str| match read_study(Path::new(path), None) {
        Err(Error::File(error)) => error.fault,
        other => panic!("{other:?}"),
    };
    assert_eq!(refusal("no/such/study.toml"), FileFault::NotThere(FileKind::Study));
    assert_eq!(refusal("tests"), FileFault::IsFolder(FileKind::Study));
}

#[test]
fn enormous_studies_are_read_when_requested_by_number() {
    let path = Path::new("tests/bad_studies/enormous.toml");
    assert_eq!(read_study(path, Some(40_000)).unwrap().study.points.len(), 40_000);
    let other = read_study(path, Some(40)).unwrap_err().to_string();
    assert!(other.ends_with("makes 40000 points, but 40 were requested"), "{other}");
}

#[test]
fn every_study_in_cases_is_valid() {
    let mut count = 0;
    for entry in
        ["studies", "paper"].iter().flat_map(|folder| fs::read_dir(format!("../../cases/{folder}")).unwrap())
    {
        read_study(&entry.unwrap().path(), None).unwrap();
        count += 1;
    }
    assert!(count >= 11);
}
