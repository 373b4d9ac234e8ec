//! Reads a web that has been scanned or laid from its results folder.

use crate::output::web::MapFile;
use serde_json::Value as Json;
use spunlaid::error::{Error, Fault};
use spunlaid::fit::{MeasuredPatch, MeasuredWeb};
use spunlaid::scan::Doubt;
use std::fs;
use std::path::Path;

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
    let doubt = match &scan["guess"] {
        // A laid web.
        _ if scan.is_null() => None,
        Json::Null if scan.get("guess").is_some() => None,
        guess => {
            let known = Doubt::GUESSES.into_iter().find(|(name, _)| guess.as_str() == Some(name));
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
        knows_noise: scan["noise"].as_f64().is_some(),
        flat: scan["shading"].as_f64().is_some(),
        doubt: doubt.map(|doubt| doubt.to_string()),
    })
}
