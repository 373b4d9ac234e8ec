//! Reads a web that has been scanned or laid from its results folder.

use serde_json::Value as Json;
use spunlaid::error::{Error, Fault};
use spunlaid::fit::{MeasuredPatch, MeasuredWeb};
use spunlaid::scan::{Doubt, Light, Settings, analyse, read};
use spunlaid::web::Map;
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
    let cell = web["cell_m"].as_f64().ok_or_else(|| missing("cell_m of the web"))?;
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
    let knows_noise = scan["noise"].as_f64().is_some();
    // A laid web has neither camera nor blur.
    let patch = |patch: &Json| {
        let number = |name: &str| patch[name].as_f64().unwrap_or(0.0);
        Some(MeasuredPatch {
            side: patch["patch_m"].as_f64()?,
            noise: number("cv_noise"),
            knows_noise,
            blur: number("blur_of_a_pixel"),
        })
    };
    let mut patches: Vec<MeasuredPatch> = all.iter().filter_map(patch).collect();
    patches.sort_by(|a, b| a.side.total_cmp(&b.side));
    let map = folder.join("map.npy");
    if !map.exists() {
        return Err(refused("map.npy is missing".to_owned()));
    }
    let sides: Vec<f64> = patches.iter().map(|patch| patch.side).take(1).collect();
    let settings = Settings { patches: sides, ..Settings::new(Light::Weight { mean: None }) };
    let found = analyse(&read(&map, Some(cell)).map_err(Error::File)?, &settings).map_err(Error::File)?;
    Ok(MeasuredWeb {
        map: within(found.map, web),
        patches,
        flat: scan["shading"].as_f64().is_some(),
        doubt: doubt.map(|doubt| doubt.to_string()),
    })
}

/// The map without the strips at the edges of a laid web, which count as no web.
fn within(map: Map, web: &Json) -> Map {
    let margin =
        |i: usize| (web["edges"]["margins_m"][i].as_f64().unwrap_or(0.0) / map.cell).round() as usize;
    let inner = margin(0)..map.columns.saturating_sub(margin(1));
    if inner.is_empty() { map } else { map.between(inner).into_owned() }
}
