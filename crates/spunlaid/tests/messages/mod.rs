//! Bad files and what is said of them: each file `FOLDER/NAME.toml` is rejected with the message in `FOLDER/NAME.txt`.
//! With `BLESS=1` in the environment the messages are written, to be reviewed.
#![allow(clippy::unwrap_used)]

use spunlaid_ground::Error;
use std::fs;
use std::path::{Path, PathBuf};

/// Reads every bad file of a folder of these tests and compares what is said with what is meant.
///
/// * `fewest` – the folder holds more files than this
/// * `read` – reads a file
pub fn are_as_meant<T>(folder: &str, fewest: usize, read: impl Fn(&Path) -> Result<T, Error>) {
    let entries = fs::read_dir(Path::new("tests").join(folder)).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    assert!(paths.len() > fewest);
    let mut wrong = Vec::new();
    for path in paths {
        let said = match read(&path) {
            Ok(_) => "nothing\n".to_owned(),
            Err(error) => {
                assert_eq!(error.exit_code(), 1);
                format!("{error}\n").replace(&format!("{folder}\\"), &format!("{folder}/"))
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
