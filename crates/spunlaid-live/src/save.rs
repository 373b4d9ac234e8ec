//! Saving the case under a name that the user gave, into the folder where the program was started.

use super::message::Answer;
use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::Path;

/// Longest name of a file [bytes].
const LONGEST: usize = 80;

/// The name of the file for a name that was given, with its extension.
///
/// # Errors
/// Says why it is not a plain name of a case.
pub(super) fn plain_name(given: &str) -> Result<String, String> {
    let given = given.trim();
    let name = if given.ends_with(".toml") { given.to_owned() } else { format!("{given}.toml") };
    let plain = |c: char| c.is_alphanumeric() || "-_ .".contains(c);
    if given.is_empty()
        || given == ".toml"
        || name.starts_with('.')
        || name.len() > LONGEST
        || !name.chars().all(plain)
    {
        return Err(format!(
            "\"{}\" cannot be the name of the file: the case is saved into the folder where the program was \
            started, so a name has no / or \\ and does not begin with a full stop. Write letters, digits, \
            spaces, - and _, at most {LONGEST} in all, as my_case",
            given.chars().take(LONGEST).map(|c| if c.is_control() { '?' } else { c }).collect::<String>()
        ));
    }
    Ok(name)
}

/// Writes a file into a folder. A file that is there is replaced only if `replace` says so, and only if it is a file.
///
/// # Errors
/// The answer that tells why not.
pub(super) fn save(folder: &Path, name: &str, text: &str, replace: bool) -> Result<(), Answer> {
    let path = folder.join(name);
    let metadata = fs::symlink_metadata(&path).ok();
    if metadata.as_ref().is_some_and(|metadata| !metadata.is_file()) {
        return Err(Answer::refused(format!("{name} exists and is not a plain file; give another name")));
    }
    let mut options = OpenOptions::new();
    options.write(true);
    if replace && metadata.is_some() {
        options.truncate(true);
    } else {
        options.create_new(true);
    }
    let written = options.open(&path).and_then(|mut file| file.write_all(text.as_bytes()));
    written.map_err(|error| match error.kind() {
        ErrorKind::AlreadyExists => Answer::Exists { name: name.to_owned() },
        _ => Answer::refused(format!("{name} cannot be written: {error}")),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_plain() {
        assert_eq!(plain_name(" my fibre").as_deref(), Ok("my fibre.toml"));
        assert_eq!(plain_name("größer_2.toml").as_deref(), Ok("größer_2.toml"));
        let long = "a".repeat(100);
        for wrong in [
            "",
            ".toml",
            "..",
            "../a",
            "a/b",
            "a\\b",
            "/etc/passwd",
            ".bashrc",
            "c:a",
            "a\0",
            "a\n.toml",
            &long,
        ] {
            assert!(plain_name(wrong).is_err(), "{wrong:?}");
        }
    }

    #[test]
    fn a_file_is_replaced_only_if_asked() {
        let folder = tempfile::tempdir().unwrap();
        let read = || fs::read_to_string(folder.path().join("a.toml")).unwrap();
        assert_eq!(save(folder.path(), "a.toml", "long text", false), Ok(()));
        assert_eq!(
            save(folder.path(), "a.toml", "2", false),
            Err(Answer::Exists { name: "a.toml".to_owned() })
        );
        assert_eq!(read(), "long text");
        assert_eq!(save(folder.path(), "a.toml", "2", true), Ok(()));
        assert_eq!(read(), "2");
        fs::create_dir(folder.path().join("b.toml")).unwrap();
        assert!(matches!(save(folder.path(), "b.toml", "2", true), Err(Answer::Refused { .. })));
    }

    #[cfg(unix)]
    #[test]
    fn links_to_elsewhere_are_not_followed() {
        let folder = tempfile::tempdir().unwrap();
        let elsewhere = tempfile::tempdir().unwrap();
        let other = elsewhere.path().join("other");
        fs::write(&other, "kept").unwrap();
        std::os::unix::fs::symlink(&other, folder.path().join("a.toml")).unwrap();
        for replace in [false, true] {
            assert!(save(folder.path(), "a.toml", "2", replace).is_err());
        }
        assert_eq!(fs::read_to_string(other).unwrap(), "kept");
    }
}
