//! What was found of changes and guesses of a web, kept beside its folder until all is told.
//!
//! ```text
//! .<folder>.trials   of each flight a line: checksum, key, and the effects of its changes, all numbers by their bits
//! ```
//!
//! Nothing here ends a command: what cannot be kept or read is flown again.

use spunlaid::experiment::Shelf;
use spunlaid::ground::{Difference, Effect, Outcome};
use std::collections::HashMap;
use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// An effect by its bits: patch, difference, its error, degrees of freedom; own part and common clouds if known.
type Bits = ([u64; 4], [Option<u64>; 2]);

/// What earlier commands have found, and where more is kept.
#[derive(Debug)]
pub struct KeptTrials {
    file: PathBuf,
    found: HashMap<u32, Vec<Outcome<f64>>>,
    /// Lines that were torn or damaged; their flights are flown again.
    pub damaged: u64,
}

impl KeptTrials {
    /// Those of a web in a folder.
    pub fn open(folder: &Path) -> Self {
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        let file = folder.with_file_name(format!(".{name}.trials"));
        let text = fs::read(&file).unwrap_or_default();
        let (mut found, mut damaged) = (HashMap::new(), 0);
        for line in text.split(|byte| *byte == b'\n').filter(|line| !line.is_empty()) {
            match read(line) {
                Some((key, outcomes)) => drop(found.insert(key, outcomes)),
                None => damaged += 1,
            }
        }
        Self { file, found, damaged }
    }

    /// Number of flights that need not be flown again if the web is the same.
    pub fn flights(&self) -> u64 {
        self.found.len() as u64
    }

    /// Forgets all when everything is told.
    pub fn clear(&self) {
        let _ = fs::remove_file(&self.file);
    }
}

impl Shelf for KeptTrials {
    fn find(&self, key: u32) -> Option<Vec<Outcome<f64>>> {
        self.found.get(&key).cloned()
    }

    fn keep(&self, key: u32, found: &[Outcome<f64>]) {
        let bits = |effect: &Effect<f64>| -> Bits {
            let Difference { value, standard_error, degrees } = effect.difference;
            let known = [effect.own, effect.in_common].map(|part| part.map(f64::to_bits));
            ([effect.of, value, standard_error, degrees].map(f64::to_bits), known)
        };
        let all: Vec<Result<Vec<Bits>, &String>> =
            found.iter().map(|of| of.as_ref().map(|effects| effects.iter().map(bits).collect())).collect();
        let Ok(text) = serde_json::to_string(&(key, all)) else { return };
        // A torn line of before ends here.
        let line = format!("\n{:08x} {text}\n", crc32fast::hash(text.as_bytes()));
        let file = OpenOptions::new().append(true).create(true).open(&self.file);
        let _ = file.and_then(|mut file| file.write_all(line.as_bytes()));
    }
}

fn read(line: &[u8]) -> Option<(u32, Vec<Outcome<f64>>)> {
    let (sum, text) = std::str::from_utf8(line).ok()?.split_once(' ')?;
    let (key, all): (u32, Vec<Result<Vec<Bits>, String>>) = serde_json::from_str(text)
        .ok()
        .filter(|_| sum == format!("{:08x}", crc32fast::hash(text.as_bytes())))?;
    let effect = |([of, value, standard_error, degrees], known): Bits| {
        let [of, value, standard_error, degrees] = [of, value, standard_error, degrees].map(f64::from_bits);
        let [own, in_common] = known.map(|part| part.map(f64::from_bits));
        Effect { of, difference: Difference { value, standard_error, degrees }, own, in_common }
    };
    let outcome = |of: Result<Vec<Bits>, String>| of.map(|bits| bits.into_iter().map(effect).collect());
    Some((key, all.into_iter().map(outcome).collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A line that a crash has torn is told and does not hide the others.
    #[test]
    fn identical_what_was_kept_comes_back_to_the_bit() {
        let desk = tempfile::tempdir().unwrap();
        let folder = desk.path().join("w");
        let difference = Difference { value: -0.1, standard_error: 1.0 / 3.0, degrees: f64::INFINITY };
        let effects = vec![Effect { own: Some(0.2), ..Effect::new(0.01, difference) }];
        let found = vec![Ok(effects), Err("why – “so”\n".to_owned())];
        let kept = KeptTrials::open(&folder);
        kept.keep(1, &found);
        kept.keep(2, &found);
        let file = desk.path().join(".w.trials");
        let whole = fs::read(&file).unwrap();
        fs::write(&file, &whole[..whole.len() - 9]).unwrap();
        let torn = KeptTrials::open(&folder);
        assert_eq!(
            (torn.find(1), torn.find(2), torn.flights(), torn.damaged),
            (Some(found.clone()), None, 1, 1)
        );
        torn.keep(2, &found);
        assert_eq!(KeptTrials::open(&folder).find(2), Some(found));
        torn.clear();
        assert_eq!(KeptTrials::open(&folder).flights(), 0);
    }
}
