//! Saving the case under a name that the user gave, into the folder where the program was started.

use super::message::Answer;
use std::fs::{self, File};
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
        || is_device(&name)
    {
        return Err(format!(
            "\"{}\" cannot be the name of the file: the case is saved into the folder where the program was \
            started. A name has no / or \\, does not begin with a full stop and is no device of Windows (NUL, \
            COM1). Write letters, digits, spaces, - and _, at most {LONGEST} in all, as my_case",
            given.chars().take(LONGEST).map(|c| if c.is_control() { '?' } else { c }).collect::<String>()
        ));
    }
    Ok(name)
}

/// Whether Windows takes a name for a device, whatever its ending.
fn is_device(name: &str) -> bool {
    let stem = name.split('.').next().unwrap_or_default().trim_end().to_ascii_uppercase();
    let is_port =
        |port: &str| stem.strip_prefix(port).is_some_and(|number| matches!(number.as_bytes(), [b'0'..=b'9']));
    ["CON", "PRN", "AUX", "NUL"].contains(&stem.as_str()) || is_port("COM") || is_port("LPT")
}

/// Writes a file into a folder. A file that is there is replaced only if `replace` says so, and only if it is a file.
///
/// # Errors
/// The answer that reports why not.
pub(super) fn save(folder: &Path, name: &str, text: &str, replace: bool) -> Result<(), Answer> {
    let path = folder.join(name);
    let metadata = fs::symlink_metadata(&path).ok();
    if metadata.as_ref().is_some_and(|metadata| !metadata.is_file()) {
        return Err(Answer::refused(format!("{name} exists and is not a plain file; give another name")));
    }
    let is_new = !replace || metadata.is_none();
    // Whole or not at all: under another name first, while a new file has its name already.
    let next = folder.join(format!(".{name}.next"));
    let written = if is_new { File::create_new(&path).map(drop) } else { Ok(()) }.and_then(|()| {
        let written = File::create(&next)
            .and_then(|mut file| file.write_all(text.as_bytes()).and_then(|()| file.sync_all()))
            .and_then(|()| fs::rename(&next, &path));
        written.inspect_err(|_| {
            let _ = fs::remove_file(&next);
            let _ = if is_new { fs::remove_file(&path) } else { Ok(()) };
        })
    });
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
            "NUL",
            "com1.old",
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
        // The place for the new text is taken: the old one stays whole, and a new name is not left empty.
        let next = |name: &str| folder.path().join(format!(".{name}.next"));
        ["a.toml", "c.toml"].iter().for_each(|name| fs::create_dir(next(name)).unwrap());
        assert!(
            save(folder.path(), "a.toml", "3", true).is_err()
                && save(folder.path(), "c.toml", "3", false).is_err()
        );
        assert!(read() == "2" && !folder.path().join("c.toml").exists());
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
