//! The program in a folder of its own.
#![allow(dead_code, clippy::unwrap_used, clippy::panic)]

use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// A case that is simulated in an instant: three fibres of four elements, 500 steps.
pub const BRIEF: &str = r#"
version = 1

[fibre]
length = "0.2 m"
diameter = "50 µm"
density = "950 kg/m³"
youngs_modulus = "2 GPa"

[air]
velocity = "10 m/s"
turbulence_intensity = 0.1
length_scale = "50 mm"
cutoff_frequency = "100 Hz"

[run]
duration = "10 ms"
time_step = "20 µs"
replicates = 3
seed = 7
"#;

/// A fed fibre that is simulated in an instant.
pub const FED: &str = r#"
version = 1

[fibre]
diameter = "18 µm"
density = "910 kg/m³"
youngs_modulus = "2 GPa"
element_length = "4 mm"
root = "clamped"

[feed]
speed = "50 m/s"

[belt]
distance = "0.1 m"
speed = "3 m/s"

[air]
velocity = "45 m/s"
turbulence_intensity = 0.1
length_scale = "16 mm"
cutoff_frequency = "700 Hz"

[drag]
across = "marheineke-wegener"

[run]
duration = "40 ms"
replicates = 3
"#;

/// What a results folder holds.
pub const ENTRIES: [&str; 9] = [
    "case.toml",
    "end_node.parquet",
    "energy.parquet",
    "figures",
    "origin.toml",
    "report.html",
    "shape",
    "shape.pvd",
    "summary.json",
];

/// A folder with a case in it, `brief.toml`, where the program is called.
pub struct Desk {
    pub folder: TempDir,
}

impl Desk {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("brief.toml"), BRIEF).unwrap();
        Self { folder }
    }

    /// The same with another case.
    pub fn with_case(case: &str) -> Self {
        let desk = Self::new();
        fs::write(desk.path("brief.toml"), case).unwrap();
        desk
    }

    /// The program with arguments, as written in a shell without quotes.
    pub fn spunlaid(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_spunlaid"));
        command.current_dir(self.folder.path()).args(arguments.split_whitespace());
        command
    }

    /// The same for a case that differs from the brief one.
    pub fn with(&self, arguments: &str, changes: &[&str]) -> Command {
        let mut command = self.spunlaid(arguments);
        command.args(changes.iter().flat_map(|change| ["--set", change]));
        command
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub fn summary(&self, folder: &str) -> Value {
        serde_json::from_slice(&self.read(&format!("{folder}/summary.json"))).unwrap()
    }

    /// What lies in a folder, hidden files too, but for the list of results that each folder of results has.
    pub fn entries(&self, folder: &str) -> BTreeSet<String> {
        entries(&self.path(folder))
    }
}

/// No page and no summary that a test has written has a number that is none.
impl Drop for Desk {
    fn drop(&mut self) {
        if !std::thread::panicking() {
            files(self.folder.path()).iter().for_each(|file| assert_only_finite_numbers(file));
        }
    }
}

/// All files in a folder and in those within it.
fn files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let paths = entries.flatten().map(|entry| entry.path());
    paths
        .flat_map(|path| if path.is_dir() && !path.is_symlink() { files(&path) } else { vec![path] })
        .collect()
}

/// Panics if a report or a summary has NaN or inf where a number should stand.
fn assert_only_finite_numbers(file: &Path) {
    let name = file.file_name().unwrap().to_string_lossy();
    if !(name == "report.html" || name == "summary.json" || name == "analysis.json") {
        return;
    }
    let text = fs::read_to_string(file).unwrap_or_default();
    // What is said on a page: neither its program nor its style.
    let said = ["script", "style"].iter().fold(text, |text, tag| without(&text, tag));
    let is_word = |word: &&str| ["NaN", "inf", "-inf", "\u{2212}inf"].contains(word);
    let words = said.split(|c: char| c.is_whitespace() || "<>\"\u{2009},;()[]".contains(c));
    assert_eq!(words.into_iter().find(is_word), None, "{}", file.display());
}

/// A page without the elements of a name.
fn without(page: &str, tag: &str) -> String {
    let [begin, end] = [format!("<{tag}"), format!("</{tag}>")];
    let (first, rest) = page.split_once(&begin).unwrap_or((page, ""));
    let after = |part: &str| part.split_once(&end).map_or(String::new(), |(_, said)| said.to_owned());
    rest.split(&begin).fold(first.to_owned(), |all, part| all + &after(part))
}

pub fn entries(folder: &Path) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).unwrap();
    let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    names.filter(|name| name != ".spunlaid-files").collect()
}

pub fn names(names: &[&str]) -> BTreeSet<String> {
    names.iter().map(ToString::to_string).collect()
}

/// What the results folder of a fed fibre holds: the laid fibre instead of the free end.
pub fn entries_of_fed() -> BTreeSet<String> {
    let both = ENTRIES.into_iter().filter(|entry| *entry != "end_node.parquet");
    both.chain(["laid.parquet", "laid.vtp"]).map(str::to_owned).collect()
}

/// Standard error of a command that ends with a code and says nothing on standard output.
pub fn refusal(command: &mut Command, code: i32) -> String {
    let output = command.output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(code), "{said}");
    assert!(output.stdout.is_empty());
    said
}

/// Standard output of a command that succeeds.
pub fn success(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// All that must be the same bits when a case is run again: every table and shape, and the summary but for
/// how fast it went.
pub fn assert_identical(desk: &Desk, one: &str, other: &str) {
    let files = desk.entries(one);
    for name in
        files.iter().filter(|name| *name == "case.toml" || name.ends_with("parquet") || name.contains(".v"))
    {
        assert!(desk.read(&format!("{one}/{name}")) == desk.read(&format!("{other}/{name}")), "{name}");
    }
    let shapes = desk.entries(&format!("{one}/shape"));
    assert_eq!(shapes, desk.entries(&format!("{other}/shape")));
    for name in shapes {
        let content = |folder: &str| desk.read(&format!("{folder}/shape/{name}"));
        assert!(content(one) == content(other), "{name}");
    }
    let [a, b] = [one, other].map(|folder| {
        let mut summary = desk.summary(folder);
        assert!(summary["performance"].take().is_object());
        summary
    });
    assert_eq!(a, b);
}
