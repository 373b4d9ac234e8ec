//! `spunlaid compare`: the results of several runs, or of several webs, side by side.

use super::stem;
use crate::args::{Compare, Invocation, Threads};
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::perform_words;
use spunlaid::ground::FileKind;
use spunlaid::input::kind_of;
use spunlaid_results::reports::comparison::{ComparedFolders, Folders};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

pub(crate) fn compare(compare: &Compare, invocation: &Invocation) -> Result<(), Failure> {
    let runs: Vec<PathBuf> =
        compare.runs.iter().map(|run| results_of(run, compare)).collect::<Result<_, _>>()?;
    let folders = Folders::new(&runs)?;
    let figures = compare.figures.files();
    let delivery =
        Delivery::open::<ComparedFolders>(invocation, &runs, folders.joined(), &compare.output, figures)?;
    delivery.deliver(&folders.compare()?, Threads::default(), &[])
}

/// The results folder that is named; of a file, one that is made now: a web is laid, a case simulated, anything else
/// analysed as a scan, a map or a record.
fn results_of(run: &Path, compare: &Compare) -> Result<PathBuf, Failure> {
    if !run.is_file() {
        return Ok(run.to_path_buf());
    }
    let is_toml = run.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
    let options: &[&str] = match is_toml.then(|| kind_of(run)) {
        Some(FileKind::Web) => &["web", "--no-advice", "--set", "web.assumed=none"],
        Some(_) => &["run"],
        None => &["analyse"],
    };
    let made = if is_toml { "simulated" } else { "analysed" };
    let folder = Path::new("results").join(format!("{}_{made}", stem(run, "results")));
    let mut words: Vec<OsString> = ["spunlaid"].iter().chain(options).map(OsString::from).collect();
    words.extend([run.into(), "--out".into(), folder.clone().into()]);
    // With --json, standard output is for the comparison alone.
    if compare.output.quiet || compare.output.json {
        words.push("--quiet".into());
    }
    perform_words(&words)?;
    Ok(folder)
}
