//! A study in a folder of its own, and the program to fly it.
#![allow(dead_code)]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

/// A folder with `case.toml` and `study.toml`, gone when dropped.
pub struct StudyFolder {
    pub folder: tempfile::TempDir,
}

/// Table 1 of the paper, in coarse steps, for so many seconds. The law across is one that suits 20 µm as well.
pub fn case(duration: f64) -> String {
    format!(
        "[fibre]\nlength = '1 m'\ndiameter = '50 µm'\ndensity = '950 kg/m³'\nyoungs_modulus = '2 GPa'\n\
         [air]\nvelocity = '10 m/s'\nturbulence_intensity = 0.1\nlength_scale = '50 mm'\ncutoff_frequency = '100 Hz'\n\
         [drag]\nacross = 'marheineke-wegener'\n\
         [run]\nduration = '{duration} s'\ntime_step = '20 µs'\n"
    )
}

impl StudyFolder {
    pub fn new(case: &str, study: &str) -> Self {
        let place = Self { folder: tempfile::tempdir().unwrap() };
        fs::write(place.path("case.toml"), case).unwrap();
        fs::write(place.path("study.toml"), study).unwrap();
        place
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// `spunlaid sweep study.toml --out OUT …`, run in the folder.
    pub fn sweep(&self, out: &str, more: &[&str]) -> Command {
        let mut command = self.spunlaid(&["sweep", "study.toml", "--out", out]);
        command.args(more);
        command
    }

    pub fn spunlaid(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_spunlaid"));
        command.args(arguments).current_dir(self.folder.path());
        command
    }

    /// Sweeps to the end; gives what was said.
    pub fn swept(&self, out: &str, more: &[&str]) -> Output {
        let output = self.sweep(out, more).output().unwrap();
        assert!(output.status.success(), "{}", said(&output));
        output
    }

    /// The sweep is refused with exit code 1 and without a change to the folder; gives what was said.
    pub fn refused(&self, out: &str, more: &[&str]) -> String {
        let before = contents(&self.path(out));
        let output = self.sweep(out, more).output().unwrap();
        assert_eq!(output.status.code(), Some(1), "{}", said(&output));
        assert!(contents(&self.path(out)) == before, "{}", said(&output));
        said(&output)
    }

    /// A sweep that is under way, its output dropped.
    pub fn under_way(&self, out: &str, more: &[&str]) -> Child {
        self.sweep(out, more).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap()
    }
}

/// What was printed, results and errors.
pub fn said(output: &Output) -> String {
    format!("{}{}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
}

/// All files below a folder with their content.
pub fn contents(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut all = BTreeMap::new();
    let Ok(entries) = fs::read_dir(folder) else {
        return all;
    };
    for entry in entries {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(contents(&path));
        } else {
            all.insert(path.clone(), fs::read(&path).unwrap());
        }
    }
    all
}

/// All files but the journal, whose records come in the order in which fibres landed, the command that made them, and
/// their list; by name.
pub fn results(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let all = contents(folder).into_iter();
    let all = all.map(|(path, content)| (path.strip_prefix(folder).unwrap().to_owned(), content));
    all.filter(|(path, _)| {
        ["journal", "origin.toml", ".spunlaid-files"].iter().all(|name| path != Path::new(name))
    })
    .collect()
}

/// Panics naming the first file that differs.
pub fn assert_same(a: &BTreeMap<PathBuf, Vec<u8>>, b: &BTreeMap<PathBuf, Vec<u8>>) {
    assert_eq!(a.keys().collect::<Vec<_>>(), b.keys().collect::<Vec<_>>());
    for (path, content) in a {
        assert!(*content == b[path], "{} differs", path.display());
    }
}
