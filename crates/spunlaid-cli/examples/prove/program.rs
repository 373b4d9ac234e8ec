//! The program, as its user calls it.

use super::draw::Drawn;
use serde_json::Value as Json;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The program and a folder of its own.
pub struct Program {
    path: PathBuf,
    pub desk: tempfile::TempDir,
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

    /// Computes an input, with further arguments.
    pub fn computed(&self, drawn: &Drawn, more: &[&str]) -> Said {
        let set = drawn.changes.iter().map(|(key, value)| format!("--set={key}={value}"));
        let more = more.iter().map(|word| (*word).to_owned()).chain(set).collect::<Vec<_>>();
        self.computed_text(drawn.base.command, &with_folder(drawn.base.text), &more)
    }

    /// Computes the text of a file.
    pub fn computed_text(&self, command: &str, text: &str, more: &[String]) -> Said {
        let file = self.place("input.toml");
        std::fs::write(&file, text).expect("a file");
        let output = Command::new(&self.path)
            .args([command, "input.toml", "--json", "--quiet"])
            // Advice flies twice as long.
            .args((command == "web").then_some("--no-advice"))
            .args(more)
            .current_dir(self.desk.path())
            .output()
            .expect("the program");
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        match output.status.code() {
            Some(0) => match serde_json::from_slice(&output.stdout) {
                Ok(results) => Said::Results(results),
                Err(error) => Said::Failed(format!("prints no JSON: {error}")),
            },
            Some(1) => Said::Refused(words),
            // Fibres that are lost are reported, and the input is left out here.
            Some(2) if words.contains("lost") || words.contains("diverge") => Said::Refused(words),
            code => Said::Failed(format!("exit code {code:?}: {words}")),
        }
    }
}

/// The text of a base with the folder of the cases.
pub fn with_folder(text: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    text.replace("CASES", &folder.to_string_lossy())
}
