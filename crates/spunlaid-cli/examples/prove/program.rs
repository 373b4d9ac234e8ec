//! The program, as its user calls it.

use super::draw::{Change, Drawn};
use super::numbers::{Numbers, numbers};
use serde_json::Value as Json;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

/// The program and a folder of its own.
pub struct Program {
    path: PathBuf,
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
    pub fn new() -> Self {
        let own = std::env::current_exe().expect("a path");
        let path = own.ancestors().nth(2).expect("a folder").join("spunlaid");
        assert!(path.exists(), "{} is not there; release/prove builds it", path.display());
        Self { path, desk: tempfile::tempdir().expect("a folder") }
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
        let set = drawn.changes.iter().map(|Change { key, value }| format!("--set={key}={value}"));
        let more = more.iter().map(|word| (*word).to_owned()).chain(set).collect::<Vec<_>>();
        self.computed_text(drawn.base.command, &with_folder(drawn.base.text), &more)
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
        let output = self.command(command).arg(file).args(more).output().expect("the program");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        match output.status.code() {
            Some(0) => match serde_json::from_slice(&output.stdout) {
                Ok(results) => Said::Results(results),
                Err(error) => Said::Failed(format!("prints no JSON: {error}")),
            },
            Some(1) => Said::Refused(said),
            // Fibres that are lost are reported, and the input is left out here.
            Some(2) if said.contains("lost") || said.contains("diverge") => Said::Refused(said),
            code => Said::Failed(format!("exit code {code:?}: {said}")),
        }
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
        if ["run", "web", "spin", "sweep", "compare"].contains(&name) {
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

/// The text of a base with the folder of the cases.
pub fn with_folder(text: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    text.replace("CASES", &folder.to_string_lossy())
}
