//! The program, as its user calls it.

use super::draw::{Change, Drawn};
use super::numbers::{Numbers, numbers};
use serde_json::Value as Json;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

/// The program and a folder of its own.
pub struct Program {
    path: PathBuf,
    /// A Python that has the package `spunlaid`; empty without one.
    python: String,
    desk: tempfile::TempDir,
}

/// What the program has said of an input.
pub enum Said {
    Results(Json),
    /// The input is refused, with the message.
    Refused(String),
    /// It has failed otherwise.
    Failed(String),
}

impl Said {
    /// Why there are no results.
    pub fn words(&self) -> &str {
        match self {
            Self::Results(_) => "",
            Self::Refused(words) | Self::Failed(words) => words,
        }
    }

    pub fn results(self) -> Option<Json> {
        match self {
            Self::Results(results) => Some(results),
            _ => None,
        }
    }
}

impl Program {
    /// * `python` – a Python that has the package `spunlaid`, or an empty text
    pub fn new(python: &str) -> Self {
        let own = std::env::current_exe().expect("a path");
        let path = own.ancestors().nth(2).expect("a folder").join("spunlaid");
        assert!(path.exists(), "{} is not there; release/prove builds it", path.display());
        Self { path, python: python.to_owned(), desk: tempfile::tempdir().expect("a folder") }
    }

    /// Where files of this program are.
    pub fn place(&self, name: &str) -> PathBuf {
        self.desk.path().join(name)
    }

    /// The same without what was there before.
    pub fn new_place(&self, name: &str) -> PathBuf {
        let place = self.place(name);
        let _ = std::fs::remove_dir_all(&place);
        place
    }

    /// Computes an input, with further arguments.
    pub fn computed(&self, drawn: &Drawn, more: &[&str]) -> Said {
        self.computed_as(drawn.base.command, drawn, more)
    }

    /// Computes an input by another command than its own.
    pub fn computed_as(&self, command: &str, drawn: &Drawn, more: &[&str]) -> Said {
        let set = drawn.changes.iter().map(|Change { key, value }| format!("--set={key}={value}"));
        let more = more.iter().map(|word| (*word).to_owned()).chain(set).collect::<Vec<_>>();
        self.computed_text(command, &with_folder(drawn.base.text), &more)
    }

    /// What the terminal shows of an input; none if it has no results.
    pub fn printed(&self, drawn: &Drawn, more: &str) -> Option<String> {
        std::fs::write(self.place("input.toml"), with_folder(drawn.base.text)).expect("a file");
        let set = drawn.changes.iter().map(|Change { key, value }| format!("--set={key}={value}"));
        let mut command = Command::new(&self.path);
        command.args([drawn.base.command, "input.toml", more]).args(set).current_dir(self.desk.path());
        if drawn.base.command == "web" {
            command.arg("--no-advice");
        }
        let output = command.output().expect("the program");
        output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
    }

    /// What `same.py` finds of an input, of which there is a folder.
    pub fn computed_by_python(&self, drawn: &Drawn, folder: &str) -> Said {
        std::fs::write(self.place("input.toml"), with_folder(drawn.base.text)).expect("a file");
        let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/prove/same.py");
        let set = drawn.changes.iter().map(|Change { key, value }| format!("{key}={value}"));
        let mut command = Command::new(&self.python);
        command.arg(script).args([drawn.base.command, "input.toml", folder]).args(set);
        read(&command.current_dir(self.desk.path()).output().expect("Python"))
    }

    /// The numbers of an input that have an error; none if it has no results.
    pub fn numbers(&self, drawn: &Drawn) -> Option<Numbers> {
        self.computed(drawn, &[]).results().map(|results| numbers(&results))
    }

    /// Computes the text of a file.
    pub fn computed_text(&self, command: &str, text: &str, more: &[String]) -> Said {
        std::fs::write(self.place("input.toml"), text).expect("a file");
        self.computed_file(command, "input.toml", more)
    }

    /// Computes a file.
    pub fn computed_file(&self, command: &str, file: &str, more: &[String]) -> Said {
        read(&self.command(command).arg(file).args(more).output().expect("the program"))
    }

    /// Computes an input of which results are kept, and kills the program after a while.
    pub fn killed(&self, command: &str, text: &str, more: &[&str], after: Duration) {
        std::fs::write(self.place("input.toml"), text).expect("a file");
        let mut command = self.command(command);
        let command = command.args(["input.toml"]).args(more).stdout(Stdio::null()).stderr(Stdio::null());
        let mut running = command.spawn().expect("the program");
        std::thread::sleep(after);
        let _ = running.kill();
        let _ = running.wait();
    }

    fn command(&self, name: &str) -> Command {
        let mut command = Command::new(&self.path);
        command.arg(name).current_dir(self.desk.path());
        if name != "compare" {
            command.arg("--quiet");
        }
        if ["run", "web", "spin", "air", "sweep", "compare"].contains(&name) {
            command.arg("--json");
        }
        if name == "web" {
            // Advice flies twice as long.
            command.arg("--no-advice");
        }
        command
    }

    /// Compares two kept results.
    pub fn compared(&self, one: &str, other: &str) -> Option<Json> {
        let output = self.command("compare").args([one, other]).output().expect("the program");
        serde_json::from_slice(&output.stdout).ok()
    }
}

fn read(output: &Output) -> Said {
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    match output.status.code() {
        Some(0) => match serde_json::from_slice(&output.stdout) {
            Ok(results) => Said::Results(results),
            Err(error) => Said::Failed(format!("prints no JSON: {error}")),
        },
        Some(1) => Said::Refused(said),
        // Fibres that are lost or not steady are reported, and the input is left out here.
        Some(2)
            if ["lost", "diverge", "lower run.time_step", "not steady"]
                .iter()
                .any(|word| said.contains(word)) =>
        {
            Said::Refused(said)
        }
        code => Said::Failed(format!("exit code {code:?}: {said}")),
    }
}

/// The text of a base with the folder of the cases.
pub fn with_folder(text: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    text.replace("CASES", &folder.to_string_lossy())
}
