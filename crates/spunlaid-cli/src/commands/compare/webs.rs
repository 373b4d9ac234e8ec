//! Webs side by side, laid or scanned: their CV at the patches that they have in common.

use super::super::finished::any_summary;
use crate::failure::Failure;
use serde_json::Value as Json;
use spunlaid::statistics::{Difference, Estimate, difference_of_deviations};
use spunlaid_charts::Figure;
use spunlaid_results::figures::{Unevenness, overlaid_webs};
use spunlaid_results::numbers::significant;
use spunlaid_results::output::comparison::{Compared, Comparison};
use std::path::PathBuf;

/// The results of a web.
#[derive(Clone, Debug)]
pub(super) struct Web {
    folder: PathBuf,
    name: String,
    /// Mean basis weight, if it is known [kg/m²].
    weight: Option<f64>,
    /// By the side of the patches; with the error by all causes where it is known.
    patches: Vec<Unevenness>,
    /// What the flown curves let expect, if there were some.
    flown: Vec<Unevenness>,
    /// Cloudiness index and share of the texture along the machine direction, with their standard errors.
    clouds: [Option<(f64, Option<f64>)>; 2],
}

/// Patches whose sides differ by no more than this share are compared.
const ALIKE: f64 = 0.05;

/// Reads the folders if the first holds a web.
///
/// # Errors
/// If a folder cannot be read, or not all hold webs.
pub(super) fn read(folders: &[PathBuf], names: &[String]) -> Result<Option<Vec<Web>>, Failure> {
    let mut webs = Vec::new();
    for (folder, name) in folders.iter().zip(names) {
        match web(folder, name, &any_summary(folder)?) {
            Some(web) => webs.push(web),
            None if webs.is_empty() => return Ok(None),
            None => {
                let reason =
                    format!("it holds no web, and {} does; compare webs with webs", folders[0].display());
                return Err(Failure::NotCompared { folder: folder.clone(), reason });
            }
        }
    }
    Ok(Some(webs))
}

fn web(folder: &std::path::Path, name: &str, summary: &Json) -> Option<Web> {
    let web = summary.get("web")?;
    let all = web["patches"].as_array()?;
    let patches = |name: &str, errors: &[&str]| -> Vec<Unevenness> {
        let patch = |of: &Json| {
            let number = |name: &str| of[name].as_f64();
            let standard_error = errors.iter().find_map(|name| number(name));
            Some(Unevenness { patch: number("patch_m")?, cv: number(name)?, standard_error })
        };
        all.iter().filter_map(patch).collect()
    };
    // Older folders and scans have no error but that by chance.
    let flown = patches("cv_flown", &["cv_flown_standard_error"]);
    let patches = patches("cv", &["cv_whole_error", "cv_standard_error"]);
    let clouds = [("cloudiness", "index"), ("texture_md", "mean")]
        .map(|(group, value)| Some((web[group][value].as_f64()?, web[group]["standard_error"].as_f64())));
    let weight = web["basis_weight_kg_m2"].as_f64();
    Some(Web { folder: folder.to_owned(), name: name.to_owned(), weight, patches, flown, clouds })
}

/// Every web against the first, and all curves in one picture.
///
/// # Errors
/// If a web has no patches like those of the first.
pub(super) fn compared(webs: &[Web]) -> Result<(Vec<Comparison>, Vec<Figure>), Failure> {
    let comparisons = webs.iter().skip(1).map(|other| against(&webs[0], other)).collect::<Result<_, _>>()?;
    let curves: Vec<_> = webs.iter().map(|web| (web.name.clone(), web.patches.clone())).collect();
    Ok((comparisons, vec![overlaid_webs(&curves)]))
}

fn against(first: &Web, other: &Web) -> Result<Comparison, Failure> {
    let of_patch = |of: &Unevenness, others: &[Unevenness], [whose, end]: [&str; 2]| {
        let found = at(others, of.patch)?;
        let side = significant(of.patch * 1e3, 3);
        let values = [(of.cv, of.standard_error), (found.cv, found.standard_error)];
        let (label, column) = (format!("{whose} over patches of {side} mm"), format!("cv_{side}_mm{end}"));
        Some(measure(label, column, ("%", 100.0), values, of_deviations))
    };
    let of_map = |of: &Unevenness| of_patch(of, &other.patches, ["CV", ""]);
    let mut measures: Vec<Compared> = first.patches.iter().filter_map(of_map).collect();
    if measures.is_empty() {
        let sides = |web: &Web| {
            let sides: Vec<String> = web.patches.iter().map(|of| significant(of.patch * 1e3, 3)).collect();
            format!("{} mm", sides.join(", "))
        };
        let reason = format!(
            "it has no patches of the same size as {}: {} there, {} here; name the same with web.patches or --patches",
            first.name,
            sides(first),
            sides(other)
        );
        return Err(Failure::NotCompared { folder: other.folder.clone(), reason });
    }
    let of_flown = |of: &Unevenness| of_patch(of, &other.flown, ["CV of the flown curves", "_flown"]);
    measures.extend(first.flown.iter().filter_map(of_flown));
    let names =
        [("cloudiness index", "cloudiness", ("%", 100.0)), ("texture along MD", "texture_md", ("", 1.0))];
    for (i, (label, column, unit)) in names.into_iter().enumerate() {
        if let (Some(a), Some(b)) = (first.clouds[i], other.clouds[i]) {
            // The cloudiness is the deviation of a part of the waves.
            let how = if column == "cloudiness" { of_deviations } else { of_means };
            measures.push(measure(label.to_owned(), column.to_owned(), unit, [a, b], how));
        }
    }
    let weight = |web: &Web| {
        web.weight
            .map_or_else(|| "unknown".to_owned(), |weight| format!("{} g/m²", significant(weight * 1e3, 3)))
    };
    Ok(Comparison {
        run: other.name.clone(),
        against: first.name.clone(),
        pairs: None,
        reason: format!(
            "as independent pieces of web; basis weight {} against {}",
            weight(other),
            weight(first)
        ),
        errors: "CV of the basis weight over square patches, ± one standard error: from the waves of each piece of web, and, where fibres were \
                 flown, from their small number and from the difference of the surrogate from them. CV of the flown curves: as they let expect.",
        measures,
    })
}

fn measure(
    label: String,
    column: String,
    (unit, per_si): (&'static str, f64),
    values: [(f64, Option<f64>); 2],
    difference: fn([(f64, f64); 2]) -> Difference,
) -> Compared {
    let [a, b] = values;
    let difference = a.1.zip(b.1).map(|(one, other)| difference([(a.0, one), (b.0, other)]));
    let means = values.map(|(mean, standard_error)| Estimate { mean, standard_error, values: Vec::new() });
    Compared { label, column, unit, per_si, means, difference }
}

fn of_deviations(of: [(f64, f64); 2]) -> Difference {
    difference_of_deviations(of)
}

/// Each error is from dozens of tiles: a normal distribution serves.
fn of_means([(first, one), (second, other)]: [(f64, f64); 2]) -> Difference {
    Difference { value: second - first, standard_error: one.hypot(other), degrees: f64::INFINITY }
}

/// The unevenness at a patch of nearly the same size, moved to that size along the slope to its neighbour.
fn at(patches: &[Unevenness], side: f64) -> Option<Unevenness> {
    let far = |of: &Unevenness| (of.patch / side).ln().abs();
    let (i, nearest) = patches.iter().enumerate().min_by(|a, b| far(a.1).total_cmp(&far(b.1)))?;
    if far(nearest) > ALIKE {
        return None;
    }
    let next =
        if i + 1 < patches.len() { Some(&patches[i + 1]) } else { i.checked_sub(1).map(|i| &patches[i]) };
    let slope = next.map_or(0.0, |next| (next.cv / nearest.cv).ln() / (next.patch / nearest.patch).ln());
    let factor = (slope * (side / nearest.patch).ln()).exp();
    let factor = if factor.is_finite() { factor } else { 1.0 };
    Some(Unevenness {
        patch: side,
        cv: nearest.cv * factor,
        standard_error: nearest.standard_error.map(|error| error * factor),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_law_is_moved_to_the_other_size_of_patch() {
        let law = |patch: f64| Unevenness { patch, cv: 0.1 * patch.powf(-0.4), standard_error: Some(0.01) };
        let patches = [0.0051, 0.0102, 0.0204].map(law);
        for side in [0.005, 0.010, 0.020] {
            let found = at(&patches, side).unwrap();
            assert!((found.cv / law(side).cv - 1.0).abs() < 1e-12, "{found:?}");
        }
        assert_eq!(at(&patches, 0.0075), None);
        assert_eq!(at(&[], 0.01), None);
    }
}
