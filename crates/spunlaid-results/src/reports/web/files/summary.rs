//! `summary.json`: all results of a web.

use super::effects::Advised;
use super::fabric::all;
use super::{effects, fabric};
use crate::files::measured::{joined, json, known, mean, values, with_errors};
use crate::files::origin::Performance;
use crate::files::versioned_json;
use crate::reports::load;
use crate::reports::web::figures::clouds::SEEN;
use serde::{Serialize, Serializer};
use serde_json::{Value as Json, json};
use spunlaid_experiment::Advice;
use spunlaid_fibre::Load;
use spunlaid_ground::statistics::interval_of_deviation;
use spunlaid_ground::{Estimate, Measure};
use spunlaid_web::map::Findings;
use spunlaid_web::scan::ScanWarning;
use spunlaid_web::{
    ChargedCurtain, Clouds, Edges, Fabric, Map, NeighbourCorrelation, PATCH_MEASURES, SCAN_MEASURES,
    SCAN_PERIOD_MEASURES, SCAN_STREAK_MEASURES, SCANNED_PATCH_MEASURES, STREAK_LIMIT_MEASURES,
    SubsampleEstimate, WEB_MEASURES, Web, scan,
};

/// What a layer was laid from.
#[derive(Clone, Debug, Serialize)]
pub struct LayerSummary {
    /// Its name.
    pub name: String,
    /// Line density of a filament [kg/m].
    pub linear_density_kg_m: f64,
    /// Speed of the filaments [m/s].
    pub feed_speed_m_s: f64,
    /// Speed of the belt [m/s].
    pub belt_speed_m_s: f64,
    /// Number of filaments.
    pub filaments: u64,
    /// Pressure of the cabin above that under the belt, if it gives the speed of the air [Pa].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub cabin_pressure_pa: Option<f64>,
    /// Speed of the air at the slot, where a case says it [m/s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub air_at_slot_m_s: Option<f64>,
    /// Basis weight [kg/m²].
    pub basis_weight_kg_m2: f64,
    /// Of the surrogate, if the filaments were laid by one.
    pub sigma_md_m: Option<f64>,
    /// Spread in cross direction [m].
    pub sigma_cd_m: Option<f64>,
    /// The same of what was laid, whatever laid it [m].
    pub laid_sigma_cd_m: f64,
    /// Distance of the holes in each row, or in the slot; none of holes at random [m].
    pub hole_pitch_m: Vec<f64>,
    /// Noise of the surrogate [m^-½].
    pub noise_per_sqrt_m: Option<f64>,
    /// Rms difference between the autocorrelations of the simulated fibres and those of the surrogate.
    pub fit_residual: Option<f64>,
    /// What chance alone would leave of it.
    pub fit_residual_by_chance: Option<f64>,
    /// Largest lateral wave number of the air that all filaments share, times its length scale; none of
    /// filaments in independent turbulence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lateral_cutoff: Option<f64>,
    /// What its filaments do to their air, where a case says how they fly.
    #[serde(skip_serializing_if = "Option::is_none", serialize_with = "curtain")]
    pub curtain: Option<Load>,
    /// The spinline from which its filaments come, if its case has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spinline: Option<Json>,
}

fn curtain<S: Serializer>(curtain: &Option<Load>, serializer: S) -> Result<S::Ok, S::Error> {
    curtain.as_ref().map(load::summary).serialize(serializer)
}

/// The text of the file of a web.
pub fn summary_of_web(
    web: &Web,
    findings: &Findings,
    fabric: &Fabric,
    tried: Advised<'_>,
    layers: &[LayerSummary],
    performance: Performance,
    notes: &[String],
) -> String {
    let name = |layer: usize| layers.get(layer).map_or("", |layer| layer.name.as_str());
    let patches = findings.patches.iter().map(|patch| {
        let why = match patch.warning {
            None => "the map is too small",
            Some(_) => "too few filaments simulated",
        };
        let interval = patch.interval().ok_or_else(|| why.to_owned());
        let side = patch.map.patch;
        let mut numbers = numbers_of_patch(side, PATCH_MEASURES, patch, interval);
        // With half and twice of each assumed value, which the error excludes.
        let is_known = |values: &&Advice| values.tried.iter().any(|tried| tried.on(side).is_some());
        if let (Some(values), Some(cv)) = (tried.assumed_values.filter(is_known), patch.reported()) {
            numbers["cv_assumed"] = json(values.range(side).map(|ratio| ratio * cv.cv));
        }
        numbers
    });
    let simulated: Vec<Json> = findings.laid.few().map(few_flown).collect();
    let lost = findings.laid.simulated.iter().map(|layer| layer.lost);
    // Where edges cut fibre off: the strips that all but the map leaves out, and the mean basis weight between them.
    let edges = (web.sheet.edges == Edges::Cut).then(|| {
        json!({
            "margins_m": findings.margins,
            "basis_weight_sheet_kg_m2": findings.laid.map.basis_weight(),
        })
    });
    let (weight, error_of_weight) = findings.basis_weight();
    let laid = known(json!({
        "basis_weight_standard_error_kg_m2": error_of_weight,
        "fibre_length_m": findings.fibre_length,
        "cut_off_kg": findings.laid.cut,
        "lost_filaments": lost.reduce(|all, lost| all + lost),
        "simulated": (!simulated.is_empty()).then_some(simulated),
        "edges": edges,
    }));
    // The declared measures of a whole web that do not stand elsewhere in the file: with the map, or with each layer.
    let here = WEB_MEASURES.iter().filter(|measure| !measure.entry().is_empty());
    let declared = here.flat_map(|measure| with_errors(measure, findings)).collect();
    let clouds = findings.clouds.as_ref();
    let map = of_map(&findings.laid.map, weight, clouds, findings.texture_md(), patches.collect());
    let charged = charged(findings, name);
    let parts = json!({
        "layers": (!layers.is_empty()).then_some(layers),
        "web": joined([map, laid, declared]),
        "fabric": fabric::summary(fabric),
        "advice": tried.advice.map(|advice| effects::of_line(advice, findings, tried.beside)),
        "assumed_values": tried.assumed_values.map(|values| effects::of_assumed_values(values, findings, tried.beside)),
        "neighbours": neighbours(findings, name),
        "charge": charged.as_array().is_some_and(|charged| !charged.is_empty()).then_some(charged),
        "performance": performance,
        "notes": notes,
    });
    versioned_json(3, known(parts))
}

/// The text of the file of a scanned web, which was read from a file.
pub fn summary_of_scan(
    file: &str,
    findings: &scan::Findings,
    fabric: &Fabric,
    performance: Performance,
    notes: &[String],
) -> String {
    let patches = findings.patches.iter().map(|patch| {
        let interval = patch.interval.map_err(|warning| warning.to_string());
        numbers_of_patch(patch.patch_cv.patch, SCANNED_PATCH_MEASURES, patch, interval)
    });
    let (weight, clouds) = (findings.map.basis_weight(), findings.clouds.as_ref());
    let texture = clouds.map(Clouds::texture_md);
    let mut web = of_map(&findings.map, weight, clouds, texture, patches.collect());
    if let Some(assumption) = findings.assumption {
        // Chance is not all that the error of a variance is made of.
        let octaves = web["clouds"].as_array_mut().into_iter().flatten();
        octaves.for_each(|octave| octave["standard_error"] = Json::Null);
        if !web["cloudiness"].is_null() {
            web["cloudiness"]["standard_error"] = Json::Null;
            web["cloudiness"]["no_interval"] = assumption.to_string().into();
        }
    }
    if !findings.mean_known {
        web["basis_weight_kg_m2"] = Json::Null;
    }
    let assumption =
        ScanWarning::ASSUMPTIONS.into_iter().find(|(_, warning)| Some(*warning) == findings.assumption);
    let about = json!({"file": file, "assumed": assumption.map(|(name, _)| name)});
    let parts = json!({
        "web": web,
        "fabric": fabric::summary(fabric),
        "scan": joined([about, values(SCAN_MEASURES, findings), streaks(findings)]),
        "performance": performance,
        "notes": notes,
    });
    versioned_json(3, parts)
}

/// The streaks of a scan, its periods, and what it would show; null if they were not looked for.
fn streaks(findings: &scan::Findings) -> Json {
    let search = findings.streaks.as_ref();
    json!({
        "streaks": search.map(|search| all(SCAN_STREAK_MEASURES, &search.streaks)),
        "periods": search.map(|search| all(SCAN_PERIOD_MEASURES, &search.periods)),
        "streak_limits": search.map(|search| all(STREAK_LIMIT_MEASURES, &search.limits)),
    })
}

/// What any map says.
///
/// * `weight` – basis weight, which is that between the edges where a web has some [kg/m²]
/// * `texture` – share of it along the machine direction
fn of_map(map: &Map, weight: f64, clouds: Option<&Clouds>, texture: Option<Estimate>, patches: Json) -> Json {
    let cloudiness = clouds.map(|clouds| {
        let (index, standard_error) = clouds.cloudiness(SEEN[0], SEEN[1]);
        // For all such webs; null if the map is too small to say, or if too few filaments were simulated.
        let interval = standard_error.map(|error| interval_of_deviation(index, error));
        let [from_m, to_m] = SEEN;
        json!({
            "from_m": from_m, "to_m": to_m, "index": index, "standard_error": standard_error, "interval": interval
        })
    });
    let octave = |(waves, estimate): ([f64; 2], Estimate)| {
        let ([from_m, to_m], Estimate { mean, standard_error, .. }) = (waves, estimate);
        json!({"from_m": from_m, "to_m": to_m, "variance": mean, "standard_error": standard_error})
    };
    json!({
        "basis_weight_kg_m2": weight,
        // In machine and in cross direction.
        "cells": [map.rows, map.columns],
        "cell_m": map.cell,
        "patches": patches,
        // Share of the texture along the machine direction, ½ without orientation.
        "texture_md": texture.as_ref().map(mean),
        "cloudiness": cloudiness,
        "clouds": clouds.into_iter().flat_map(Clouds::octaves).map(octave).collect::<Json>(),
    })
}

/// The few filaments of a layer from which all others follow: their distance in a row, the correlation of the places
/// where two at this distance and equal depth come down, the sheet that they laid, and the part of the variance of a
/// filament between them that they do not give. The areas are those that give
/// the CV: simulated as finely as the sheet, and in all.
fn few_flown(few: &SubsampleEstimate) -> Json {
    json!({
        "filaments": few.filaments,
        "pitch_m": few.pitch,
        "neighbour_correlation": few.correlation,
        "width_m": few.sheet[0],
        "length_m": few.sheet[1],
        "fine_area_m2": few.fine_area,
        "area_m2": few.area,
        "missing_variance_md": few.missing[0],
        "missing_variance_cd": few.missing[1],
    })
}

/// The charged filaments of each layer, as they hung at the end of their flight.
///
/// * `name` – of a layer
fn charged<'a>(findings: &Findings, name: impl Fn(usize) -> &'a str) -> Json {
    let entry = |(layer, charged): (usize, &ChargedCurtain)| {
        // From the inlet to the belt: length of filament for each length of height, and places in machine direction
        // behind which 2.5, 25, 50, 75 and 97.5 % of the filament hangs.
        let heights = charged.heights.iter().map(
            |height| json!({"x_m": height.x, "length_per_height": height.length, "md_m": height.places}),
        );
        json!({
            "layer": name(layer),
            "edge_field_v_m": charged.edge_field,
            "heights": heights.collect::<Json>(),
        })
    };
    findings.laid.charged().map(entry).collect()
}

/// How filaments that hang side by side in one air come down together; none of a web of independent filaments.
fn neighbours<'a>(findings: &Findings, name: impl Fn(usize) -> &'a str) -> Option<Json> {
    let entry = |(layer, neighbour): (usize, &NeighbourCorrelation)| {
        let NeighbourCorrelation { distance, md, cd } = neighbour;
        json!({
            "layer": name(layer),
            "distance_m": distance,
            "correlation_md": md.value,
            "correlation_md_se": md.standard_error,
            "correlation_cd": cd.value,
            "correlation_cd_se": cd.standard_error,
            // By Student's t; null if too little was laid.
            "correlation_md_interval": md.interval(),
            "correlation_cd_interval": cd.interval(),
        })
    };
    let simulated = findings.laid.simulated.iter().enumerate();
    let all =
        simulated.flat_map(|(layer, simulated)| simulated.neighbours.iter().map(move |one| (layer, one)));
    let neighbours: Vec<Json> = all.map(entry).collect();
    (!neighbours.is_empty()).then(|| json!({"cd": neighbours}))
}

/// The numbers of the patches of one size. Those that are not known are left out; the CV, which is the first,
/// is null.
///
/// * `interval` – 95 % confidence interval of the CV of all such webs, or why it cannot be reported
fn numbers_of_patch<T>(
    side: f64,
    measures: &'static [Measure<T>],
    found: &T,
    interval: Result<[f64; 2], String>,
) -> Json {
    let mut all = json!({"patch_m": side});
    for (place, measure) in measures.iter().enumerate() {
        let known = with_errors(measure, found);
        if place == 0 {
            all[measure.entry()] = Json::Null;
        }
        known.into_iter().for_each(|(name, value)| all[name] = value);
        // It follows the CV.
        match &interval {
            _ if place > 0 => {}
            Ok(ends) => all["cv_interval"] = json(ends),
            Err(why) => all["no_interval"] = why.as_str().into(),
        }
    }
    all
}
