//! What the results folder of a finished run, or of a web, says.

use crate::Failure;
use serde_json::Value as Json;
use spunlaid::error::Error;
use std::fs;
use std::path::Path;

const SUMMARY: &str = "summary.json";

/// Reads the summary of a results folder of a run.
///
/// # Errors
/// If the folder does not hold the results of a run.
pub fn read_summary_of_run(folder: &Path) -> Result<Json, Failure> {
    let summary = read_summary(folder)?;
    if summary.get("end_node").or_else(|| summary.get("laydown")).is_none() {
        let reason = format!("{SUMMARY} is not that of a run");
        return Err(Error::not_a_run(folder, &reason));
    }
    Ok(summary)
}

/// Reads the summary of a results folder of a run or of a web.
///
/// # Errors
/// If the folder has none.
pub fn read_summary(folder: &Path) -> Result<Json, Failure> {
    let not_a_run = |reason: String| Error::not_a_run(folder, &reason);
    let holds_other = ["results.csv", "analysis.json"].iter().any(|file| folder.join(file).exists());
    for (is_so, reason) in [
        (folder.is_file(), "it is a file"),
        (!folder.is_dir(), "there is no such folder"),
        (holds_other, "it holds a study or an analysis"),
    ] {
        if is_so {
            return Err(not_a_run(reason.to_owned()));
        }
    }
    let path = folder.join(SUMMARY);
    let text = fs::read_to_string(&path).map_err(|error| not_a_run(format!("{SUMMARY}: {error}")))?;
    serde_json::from_str(&text).map_err(|error| not_a_run(format!("{SUMMARY}: {error}")))
}
