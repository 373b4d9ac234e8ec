//! Bad studies and their messages: each file `bad_studies/NAME.toml` is rejected with the message in
//! `bad_studies/NAME.txt`. With `BLESS=1` in the environment the test writes the messages, to be reviewed.

use crate::messages;
use spunlaid_ground::Error;
use spunlaid_input::read_study;
use std::fs;
use std::path::Path;

#[test]
fn rejects_every_bad_study_with_its_message() {
    messages::are_as_meant("bad_studies", 25, |path| read_study(path, None));
}

#[test]
fn rejects_unreadable_files() {
    let refusal = |path: &str| match read_study(Path::new(path), None) {
        Err(Error::File(problem)) => problem.cause.to_string(),
        other => panic!("{other:?}"),
    };
    assert_eq!(refusal("no/such/study.toml"), "there is no such file; name a study file");
    assert_eq!(refusal("tests"), "is a folder; name the study file in it");
}

#[test]
fn enormous_studies_are_read_when_requested_by_number() {
    let path = Path::new("tests/bad_studies/enormous.toml");
    assert_eq!(read_study(path, Some(40_000)).unwrap().study.points.len(), 40_000);
    let other = read_study(path, Some(40)).unwrap_err().to_string();
    assert!(other.ends_with("makes 40000 points, but 40 were requested; request 40000 points"), "{other}");
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
