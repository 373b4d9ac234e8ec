//! Webs side by side, laid or scanned: their CV at the patches that they have in common.

use super::super::finished::any_summary;
use crate::failure::Failure;
use serde_json::Value as Json;
use spunlaid::error::{Error, Fault};
use spunlaid::statistics::{Difference, Estimate, NORMAL_95};
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
    /// By the side of the patches.
    patches: Vec<Patch>,
    /// The CV expected from the flown curves, if there were some.
    flown: Vec<Patch>,
    /// Cloudiness index and share of the texture along the machine direction.
    clouds: [Option<WebNumber>; 2],
}

/// A number of a web.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct WebNumber {
    value: f64,
    standard_error: Option<f64>,
    /// Ends of its 95 % interval, if they are known.
    ends: Option<[f64; 2]>,
    /// Why it is not to be had.
    doubt: Option<String>,
}

/// The unevenness over patches of one size.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Patch {
    side: f64,
    cv: WebNumber,
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
                let message =
                    format!("cannot be compared: it holds no web, and {} does", folders[0].display());
                return Err(Error::folder(folder, Fault::new(message, "compare webs with webs")).into());
            }
        }
    }
    Ok(Some(webs))
}

fn web(folder: &std::path::Path, name: &str, summary: &Json) -> Option<Web> {
    let web = summary.get("web")?;
    let number = |json: &Json, [value, error, ends]: [&str; 3]| {
        let end = |i: usize| json[ends][i].as_f64();
        Some(WebNumber {
            value: json[value].as_f64()?,
            standard_error: json[error].as_f64(),
            ends: end(0).zip(end(1)).map(|(low, high)| [low, high]),
            doubt: json["no_interval"].as_str().map(|doubt| format!("{doubt} ({name})")),
        })
    };
    let all = web["patches"].as_array()?;
    let patches = |names: [&str; 3]| -> Vec<Patch> {
        let patch = |json: &Json| {
            let cv = number(json, names)?.with_all_causes(&json["cv_whole_error"], names[0] == "cv");
            Some(Patch { side: json["patch_m"].as_f64()?, cv })
        };
        all.iter().filter_map(patch).collect()
    };
    // Older folders have no error but that by chance.
    let flown = patches(["cv_flown", "cv_flown_standard_error", ""]);
    let patches = patches(["cv", "cv_standard_error", "cv_interval"]);
    let clouds = [("cloudiness", "index"), ("texture_md", "mean")]
        .map(|(group, value)| number(&web[group], [value, "standard_error", "interval"]));
    let weight = web["basis_weight_kg_m2"].as_f64();
    Some(Web { folder: folder.to_owned(), name: name.to_owned(), weight, patches, flown, clouds })
}

/// Every web against the first, and all curves in one picture.
///
/// # Errors
/// If a web has no patches like those of the first.
pub(super) fn compared(webs: &[Web]) -> Result<(Vec<Comparison>, Vec<Figure>), Failure> {
    let comparisons = webs.iter().skip(1).map(|other| against(&webs[0], other)).collect::<Result<_, _>>()?;
    let drawn = |patch: &Patch| Unevenness {
        patch: patch.side,
        cv: patch.cv.value,
        standard_error: patch.cv.standard_error,
    };
    let curves: Vec<_> =
        webs.iter().map(|web| (web.name.clone(), web.patches.iter().map(drawn).collect())).collect();
    Ok((comparisons, vec![overlaid_webs(&curves)]))
}

fn against(first: &Web, other: &Web) -> Result<Comparison, Failure> {
    let of_patch = |patch: &Patch, others: &[Patch], [whose, end]: [&str; 2]| {
        let found = at(others, patch.side)?;
        let side = significant(patch.side * 1e3, 3);
        let values = [patch.cv.clone(), found];
        let (label, column) = (format!("{whose} over patches of {side} mm"), format!("cv_{side}_mm{end}"));
        Some(measure(label, column, ("%", 100.0), values))
    };
    let of_map = |patch: &Patch| of_patch(patch, &other.patches, ["CV", ""]);
    let mut measures: Vec<Compared> = first.patches.iter().filter_map(of_map).collect();
    if measures.is_empty() {
        let sides = |web: &Web| {
            let sides: Vec<String> =
                web.patches.iter().map(|patch| significant(patch.side * 1e3, 3)).collect();
            format!("{} mm", sides.join(", "))
        };
        let message = format!(
            "cannot be compared: it has no patches of the same size as {}, which has {}; this one has {}",
            first.name,
            sides(first),
            sides(other)
        );
        let fault = Fault::new(message, "give both the same sizes with web.patches or --patches");
        return Err(Error::folder(&other.folder, fault).into());
    }
    let of_flown = |patch: &Patch| of_patch(patch, &other.flown, ["CV of the flown curves", "_flown"]);
    measures.extend(first.flown.iter().filter_map(of_flown));
    let names =
        [("cloudiness index", "cloudiness", ("%", 100.0)), ("texture along MD", "texture_md", ("", 1.0))];
    for (i, (label, column, unit)) in names.into_iter().enumerate() {
        if let (Some(a), Some(b)) = (first.clouds[i].clone(), other.clouds[i].clone()) {
            measures.push(measure(label.to_owned(), column.to_owned(), unit, [a, b]));
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
        errors: "CV of the basis weight over square patches, ± one standard error: from the waves of each piece of \
            web, and, where fibres were flown, from their small number and from the difference of the surrogate \
            from them. The CV of the flown curves is the one expected from them.",
        measures,
    })
}

fn measure(
    label: String,
    column: String,
    (unit, per_si): (&'static str, f64),
    values: [WebNumber; 2],
) -> Compared {
    let [a, b] = &values;
    let doubts: Vec<&str> = values.iter().filter_map(|value| value.doubt.as_deref()).collect();
    let doubt = (!doubts.is_empty()).then(|| doubts.join("; "));
    // The ends of both intervals that face each other make that of the difference: Zou and Donner, Statistics in Medicine 27 (2008)
    // 1693–1702. A standard error is from many parts of a web, and a normal distribution serves.
    let ups = if b.value > a.value { [true, false] } else { [false, true] };
    let error = a.error_towards(ups[0]).zip(b.error_towards(ups[1])).filter(|_| doubt.is_none());
    let difference = error.map(|(one, other)| Difference {
        value: b.value - a.value,
        standard_error: one.hypot(other),
        degrees: f64::INFINITY,
    });
    let means = values.map(|number| Estimate {
        mean: number.value,
        standard_error: number.standard_error,
        values: Vec::new(),
    });
    Compared { label, column, unit, per_si, means, difference, doubt }
}

impl WebNumber {
    /// With the error by all causes in place of that by chance alone, if it is known: what is not chance makes the interval
    /// wider on both sides.
    ///
    /// * `is_of_map` – whether the number is that of the map, which has this error
    fn with_all_causes(self, whole: &Json, is_of_map: bool) -> Self {
        let (Some(whole), Some(chance)) = (whole.as_f64().filter(|_| is_of_map), self.standard_error) else {
            return self;
        };
        let others = NORMAL_95 * (whole * whole - chance * chance).max(0.0).sqrt();
        let value = self.value;
        let ends = self
            .ends
            .map(|[low, high]| [value - (value - low).hypot(others), value + (high - value).hypot(others)]);
        Self { standard_error: Some(whole), ends, ..self }
    }

    /// The error upwards or downwards, so that 1.96 of it reach to the end of the interval.
    fn error_towards(&self, up: bool) -> Option<f64> {
        match self.ends {
            Some(ends) => Some((ends[usize::from(up)] - self.value).abs() / NORMAL_95),
            None => self.standard_error,
        }
    }
}

/// The CV at a patch of nearly the same size, moved to that size along the slope to its neighbour.
fn at(patches: &[Patch], side: f64) -> Option<WebNumber> {
    let far = |patch: &Patch| (side / patch.side).ln().abs();
    let (i, nearest) = patches.iter().enumerate().min_by(|a, b| far(a.1).total_cmp(&far(b.1)))?;
    if far(nearest) > ALIKE {
        return None;
    }
    let next =
        if i + 1 < patches.len() { Some(&patches[i + 1]) } else { i.checked_sub(1).map(|i| &patches[i]) };
    let slope =
        next.map_or(0.0, |next| (next.cv.value / nearest.cv.value).ln() / (next.side / nearest.side).ln());
    let factor = (slope * (side / nearest.side).ln()).exp();
    let factor = if factor.is_finite() { factor } else { 1.0 };
    let number = &nearest.cv;
    Some(WebNumber {
        value: number.value * factor,
        standard_error: number.standard_error.map(|error| error * factor),
        ends: number.ends.map(|ends| ends.map(|end| end * factor)),
        doubt: number.doubt.clone(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const fn number(value: f64, ends: Option<[f64; 2]>) -> WebNumber {
        WebNumber { value, standard_error: Some(0.01), ends, doubt: None }
    }

    #[test]
    fn a_power_law_is_moved_to_the_other_size_of_patch() {
        let law = |side: f64| Patch { side, cv: number(0.1 * side.powf(-0.4), None) };
        let patches = [0.0051, 0.0102, 0.0204].map(law);
        for side in [0.005, 0.010, 0.020] {
            let found = at(&patches, side).unwrap();
            assert!((found.value / law(side).cv.value - 1.0).abs() < 1e-12, "{found:?}");
        }
        assert_eq!(at(&patches, 0.0075), None);
        assert_eq!(at(&[], 0.01), None);
    }

    #[test]
    fn the_ends_that_face_each_other_decide_and_a_doubt_leaves_no_verdict() {
        let compared = |values| measure(String::new(), String::new(), ("", 1.0), values);
        // Upwards the first reaches 3, downwards the second 4: together 5.
        let [a, b] = [number(10.0, Some([9.9, 13.0])), number(15.1, Some([11.1, 30.0]))];
        let difference = compared([a.clone(), b.clone()]).difference.unwrap();
        assert!((difference.half_width() - 5.0).abs() < 1e-6 && difference.is_beyond_chance());
        // The other way round as well.
        let difference = compared([b.clone(), a.clone()]).difference.unwrap();
        assert!((difference.half_width() - 5.0).abs() < 1e-6 && difference.is_beyond_chance());
        let doubtful = WebNumber { doubt: Some("below the blur".to_owned()), ..a };
        let found = compared([doubtful, b]);
        assert_eq!((found.difference, found.cells()[3].as_str()), (None, "below the blur"));
    }
}
