//! Transcripts of a shell, `tests/cmd/*.txt`: what the program prints and with which code it ends.
//!
//! `$ ` begins a command for `sh`, `> ` continues it, and `? 1` is its exit code if this is not 0. Each transcript runs
//! in a folder of its own with `brief.toml` and `fed.toml`; `$CASES` is the folder `cases` of the repository. In the
//! output, a line `...` matches any lines, and `[..]` any part of a line. After a change of the program, renew all
//! transcripts and read what has changed with `git diff`:
//!
//!     SNAPSHOTS=overwrite cargo test --release -p spunlaid-cli --test program transcripts

use crate::common::contents;
use crate::desk::{Desk, FED};
use snapbox::data::DataFormat;
use snapbox::{Assert, Data};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Runs a command of a shell in a folder, with standard error in standard output.
fn shell(desk: &Desk, command: &str) -> Output {
    let program = Path::new(env!("CARGO_BIN_EXE_spunlaid")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases");
    let mut shell = Command::new("sh");
    shell.current_dir(desk.path("")).env("PATH", path).env("CASES", cases);
    shell.args(["-c", &format!("exec 2>&1\n{command}")]).output().unwrap()
}

/// Runs the commands of a transcript and returns theirs.
///
/// # Panics
/// If a command that ends with 1 has changed a file.
fn replayed(transcript: &str) -> String {
    let desk = Desk::new();
    fs::write(desk.path("fed.toml"), FED).unwrap();
    let (title, commands) = transcript.split_once("\n$ ").unwrap();
    let mut replayed = format!("{title}\n");
    for command in commands.split("\n$ ") {
        let mut lines = command.lines();
        let first = lines.next().unwrap();
        let more =
            lines.map_while(|line| line.strip_prefix('>')).map(|line| line.strip_prefix(' ').unwrap_or(line));
        let command = std::iter::once(first).chain(more).collect::<Vec<_>>();
        let before = contents(desk.folder.path());
        let output = shell(&desk, &command.join("\n"));
        let code = output.status.code().unwrap();
        assert!(code != 1 || contents(desk.folder.path()) == before, "files have changed: {first}");
        writeln!(replayed, "$ {}", command.join("\n> ")).unwrap();
        if code != 0 {
            writeln!(replayed, "? {code}").unwrap();
        }
        replayed += std::str::from_utf8(&output.stdout).unwrap();
    }
    replayed.replace("\n> \n", "\n>\n")
}

#[test]
fn every_transcript_is_what_the_program_prints() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cmd");
    let assert = Assert::new().action_env("SNAPSHOTS").normalize_paths(false);
    let files = fs::read_dir(folder).unwrap().map(|file| file.unwrap().path());
    let differs = files.filter_map(|file| {
        let actual = Data::text(replayed(&fs::read_to_string(&file).unwrap()));
        assert.try_eq(None, actual, Data::read_from(&file, Some(DataFormat::Text))).err()
    });
    let differs: Vec<String> = differs.map(|differs| differs.to_string()).collect();
    assert!(differs.is_empty(), "{}", differs.join("\n"));
}
