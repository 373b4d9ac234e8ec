//! What the results folder of a finished run, or of a web that was laid or scanned, says.

use super::web::files::pieces::MapFile;
use crate::Failure;
use serde_json::Value as Json;
use spunlaid_experiment::{MeasuredPatch, MeasuredWeb};
use spunlaid_ground::{Error, Fault};
use spunlaid_web::scan::ScanWarning;
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
        let reason = match summary.get("spinline") {
            Some(_) => {
                "it holds a spinline, which has no random part; compare its numbers directly".to_owned()
            }
            None => format!("{SUMMARY} is not that of a run"),
        };
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

/// Reads the map and the patches from the results of `spunlaid analyse` of a scan, or of `spunlaid web`.
///
/// # Errors
/// If the folder does not hold such results, or if a file of it cannot be read.
pub fn read_measured_web(folder: &Path) -> Result<MeasuredWeb, Error> {
    let refused = |reason: String| {
        let remedy = "name the results folder of \"spunlaid analyse\" of a scan, or of \"spunlaid web\"";
        Error::folder(folder, Fault::new(format!("holds no scanned or laid web: {reason}"), remedy))
    };
    if !folder.is_dir() {
        return Err(refused("it is not a folder".to_owned()));
    }
    let text = fs::read_to_string(folder.join("summary.json"));
    let text = text.map_err(|error| refused(format!("summary.json: {error}")))?;
    let summary: Json =
        serde_json::from_str(&text).map_err(|error| refused(format!("summary.json: {error}")))?;
    let missing = |what: &str| refused(format!("summary.json has no {what}"));
    let web = summary.get("web").ok_or_else(|| missing("web"))?;
    let all = web["patches"].as_array().ok_or_else(|| missing("patches of the web"))?;
    let scan = &summary["scan"];
    let warning = match &scan["assumed"] {
        // A laid web.
        _ if scan.is_null() => None,
        Json::Null if scan.get("assumed").is_some() => None,
        assumption => {
            let known =
                ScanWarning::ASSUMPTIONS.into_iter().find(|(name, _)| assumption.as_str() == Some(name));
            let known = known
                .ok_or_else(|| refused("it was analysed by another version; analyse it again".to_owned()));
            Some(known?.1)
        }
    };
    // A laid web has neither camera nor blur.
    let patch = |patch: &Json| {
        let number = |name: &str| patch[name].as_f64().unwrap_or(0.0);
        Some(MeasuredPatch {
            side: patch["patch_m"].as_f64()?,
            noise: number("cv_noise"),
            blur: number("blur_of_a_pixel"),
        })
    };
    let mut patches: Vec<MeasuredPatch> = all.iter().filter_map(patch).collect();
    patches.sort_by(|a, b| a.side.total_cmp(&b.side));
    let map = MapFile::new(folder, web).and_then(|map| map.piece(map.sides(), map.cell));
    let unusable = |reason: String| {
        let remedy = "analyse the scan again, or lay the web again";
        Error::folder(folder, Fault::new(format!("holds no map that can be used: {reason}"), remedy))
    };
    Ok(MeasuredWeb {
        map: map.map_err(unusable)?,
        patches,
        has_known_noise: scan["noise"].as_f64().is_some(),
        flat: scan["shading"].as_f64().is_some(),
        warning: warning.map(|warning| warning.to_string()),
    })
}
