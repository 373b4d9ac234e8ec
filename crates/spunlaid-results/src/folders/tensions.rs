//! The tensions at the ends of spinlines that flights have found for a study. They are kept in its folder
//! from before there is a journal, so that an interrupted study goes on with them.
//!
//! ```text
//! tensions    a line for each: identity of the case, tension [N], change of the speed [-], version of the program, checksum
//! ```

use super::study::{TENSIONS, refuse_others};
use crate::Failure;
use spunlaid::error::Error;
use spunlaid::input::{FlownTension, KeptTensions};
use spunlaid::threads::lock;
use std::collections::BTreeMap;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// The tensions of a study that are kept.
#[derive(Debug)]
pub struct StudyTensions {
    folder: PathBuf,
    found: BTreeMap<u64, FlownTension>,
    /// Held while a line is written.
    writing: Mutex<()>,
}

impl StudyTensions {
    /// Finds what an earlier process has kept. What it left half written is flown again.
    ///
    /// * `force` – whether what the folder holds is replaced
    ///
    /// # Errors
    /// If the folder holds something else than a study.
    pub fn open(folder: &Path, force: bool) -> Result<Self, Failure> {
        refuse_others(folder, force)?;
        let text = fs::read(folder.join(TENSIONS)).unwrap_or_default();
        let found = String::from_utf8_lossy(&text).lines().filter_map(read_line).collect();
        Ok(Self { folder: folder.to_owned(), found, writing: Mutex::default() })
    }
}

impl KeptTensions for StudyTensions {
    fn recall(&self, identity: u64) -> Option<FlownTension> {
        self.found.get(&identity).copied()
    }

    fn keep(&self, identity: u64, found: FlownTension) -> Result<(), Error> {
        let file = self.folder.join(TENSIONS);
        let _one_after_the_other = lock(&self.writing);
        // A line that a killed process has left half written ends here.
        let line = format!("\n{}\n", line(identity, found));
        fs::create_dir_all(&self.folder)
            .and_then(|()| OpenOptions::new().create(true).append(true).open(&file))
            .and_then(|mut open| open.write_all(line.as_bytes()).and_then(|()| open.sync_data()))
            .map_err(Error::unwritable(&file))
    }
}

fn line(identity: u64, FlownTension { tension, change }: FlownTension) -> String {
    let text = format!("{identity:016x},{tension},{change},{}", env!("CARGO_PKG_VERSION"));
    let sum = checksum(&text);
    format!("{text},{sum:08x}")
}

/// What a line says, if it is whole and of this version, whose tensions have the same bits.
fn read_line(text: &str) -> Option<(u64, FlownTension)> {
    let mut parts = text.split(',');
    let identity = u64::from_str_radix(parts.next()?, 16).ok()?;
    let [tension, change] = [parts.next()?, parts.next()?].map(|number| number.parse().ok());
    let found = FlownTension { tension: tension?, change: change? };
    (line(identity, found) == text).then_some((identity, found))
}

/// The checksum FNV-1a.
fn checksum(text: &str) -> u32 {
    text.bytes().fold(0x811c_9dc5, |sum, byte| (sum ^ u32::from(byte)).wrapping_mul(0x0100_0193))
}

#[cfg(test)]
mod tests {
    use super::*;

    const FOUND: FlownTension = FlownTension { tension: 2.1e-4 / 3.0, change: 1.5e-4 };

    #[test]
    fn identical_tensions_are_recalled_and_damaged_lines_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let study = folder.path().join("study");
        let kept = StudyTensions::open(&study, false).unwrap();
        assert_eq!(kept.recall(7), None);
        kept.keep(7, FOUND).unwrap();
        let file = study.join(TENSIONS);
        // A process was killed while it wrote.
        let torn = fs::read_to_string(&file).unwrap() + &line(8, FOUND)[..30];
        fs::write(&file, torn).unwrap();
        let other = FlownTension { tension: -1e-6, ..FOUND };
        kept.keep(9, other).unwrap();
        let again = StudyTensions::open(&study, false).unwrap();
        assert_eq!([7, 8, 9].map(|identity| again.recall(identity)), [Some(FOUND), None, Some(other)]);
        let damaged = fs::read_to_string(&file).unwrap().replace("-0.000001", "-0.000002");
        fs::write(&file, damaged).unwrap();
        let again = StudyTensions::open(&study, false).unwrap();
        assert_eq!([7, 9].map(|identity| again.recall(identity)), [Some(FOUND), None]);
    }

    #[test]
    fn rejects_the_folder_of_a_run_before_anything_flies() {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("summary.json"), "{}").unwrap();
        let refused = StudyTensions::open(folder.path(), false).unwrap_err().to_string();
        assert!(refused.contains("holds results already (summary.json)"), "{refused}");
        assert!(StudyTensions::open(folder.path(), true).is_ok());
    }
}
