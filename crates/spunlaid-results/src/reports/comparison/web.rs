//! The results of a web, laid or scanned, as far as they are compared.

use super::files::ComparedMeasure;
use crate::numbers::significant;
use crate::reports::web::files::pieces::MapFile;
use serde_json::Value as Json;
use spunlaid_ground::statistics::difference_of_logarithms;
use spunlaid_ground::{Difference, Estimate, NORMAL_95, Unit};
use spunlaid_web::FEWEST;
use spunlaid_web::scan::ScanWarning;
use std::path::{Path, PathBuf};

/// The results of a web.
#[derive(Clone, Debug)]
pub(super) struct Web {
    pub(super) folder: PathBuf,
    pub(super) name: String,
    /// Mean basis weight, if it is known [kg/m²].
    pub(super) weight: Option<f64>,
    /// By the side of the patches.
    pub(super) patches: Vec<Patch>,
    /// Sides of the patches whose CV is not reported, each with the reason.
    pub(super) not_reported: Vec<(f64, String)>,
    /// Cloudiness index and share of the texture along the machine direction.
    pub(super) clouds: [Option<WebNumber>; 2],
    /// Whether it comes from a camera, which blurs.
    pub(super) has_camera: bool,
    /// Side of a cell of its map, if it is known [m].
    pub(super) cell: Option<f64>,
    /// What is reported of its fabric; nothing in an older folder.
    pub(super) fabric: Json,
    /// What is said of the scan, and of the layers of the line.
    pub(super) scan: Json,
    pub(super) layers: Json,
    /// Its width, if it is known [m].
    pub(super) width: Option<f64>,
    /// Its map, or why there is none.
    pub(super) map: Result<MapFile, String>,
}

/// A number of a web.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct WebNumber {
    pub(super) value: f64,
    pub(super) standard_error: Option<f64>,
    /// Ends of its 95 % interval, if they are known.
    pub(super) ends: Option<[f64; 2]>,
    /// Why it is not to be had.
    pub(super) doubt: Option<String>,
}

/// The CV over patches of one size.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Patch {
    pub(super) side: f64,
    pub(super) cv: WebNumber,
}

/// Patches whose sides differ by no more than this share are compared.
const ALIKE: f64 = 0.05;

/// Whether two lengths are nearly the same.
pub(super) fn are_alike(a: f64, b: f64) -> bool {
    (a / b).ln().abs() <= ALIKE
}

impl Web {
    /// The web of a folder; none if `summary.json` is not that of a web.
    pub(super) fn new(folder: &Path, name: &str, summary: &Json) -> Option<Self> {
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
        let patch = |json: &Json| {
            let cv = number(json, ["cv", "cv_standard_error", "cv_interval"])?;
            Some(Patch { side: json["patch_m"].as_f64()?, cv: cv.with_all_causes(&json["cv_total_error"]) })
        };
        let is_null = |json: &&Json| json.get("cv").is_some_and(Json::is_null);
        let not_reported = all.iter().filter(is_null).filter_map(|json| {
            Some((json["patch_m"].as_f64()?, json["no_interval"].as_str().unwrap_or_default().to_owned()))
        });
        let clouds = [("cloudiness", "index"), ("texture_md", "mean")]
            .map(|(group, value)| number(&web[group], [value, "standard_error", "interval"]));
        Some(Self {
            folder: folder.to_owned(),
            name: name.to_owned(),
            weight: web["basis_weight_kg_m2"].as_f64(),
            // Older folders have no error but that by chance.
            patches: all.iter().filter_map(patch).collect(),
            not_reported: not_reported.collect(),
            clouds,
            // A map of basis weight has no blur of a camera.
            has_camera: all.iter().any(|patch| patch["blur_of_a_pixel"].is_number()),
            cell: web["cell_m"].as_f64(),
            fabric: summary["fabric"].clone(),
            scan: summary["scan"].clone(),
            layers: summary["layers"].clone(),
            width: web["cells"][1].as_f64().zip(web["cell_m"].as_f64()).map(|(cells, cell)| cells * cell),
            map: MapFile::new(folder, web),
        })
    }

    /// Sides of its patches [m], of those without a CV too.
    pub(super) fn sides(&self) -> impl Iterator<Item = f64> {
        self.patches.iter().map(|patch| patch.side).chain(self.not_reported.iter().map(|(side, _)| *side))
    }

    /// The CV over patches of a size, or why there is none.
    pub(super) fn cv(&self, side: f64) -> Result<WebNumber, String> {
        at(&self.patches, side).ok_or_else(|| self.missing(side))
    }

    /// A number that goes with the square of the CV over patches, as the formation number does: it is as well known as
    /// that, so that both say the same of a difference.
    pub(super) fn squared(&self, side: f64, number: WebNumber) -> WebNumber {
        let Ok(cv) = self.cv(side) else { return number };
        let square = |end: f64| number.value * (end / cv.value).powi(2);
        WebNumber {
            value: number.value,
            standard_error: cv.standard_error.map(|error| 2.0 * number.value * error / cv.value),
            ends: cv.ends.map(|ends| ends.map(square)),
            doubt: number.doubt.or(cv.doubt),
        }
    }

    /// Why there is no CV over patches of a size.
    fn missing(&self, side: f64) -> String {
        let shorter = |map: &MapFile| map.sides().into_iter().fold(f64::INFINITY, f64::min);
        let name = &self.name;
        if let Some((_, why)) = self.not_reported.iter().find(|(patch, _)| are_alike(*patch, side)) {
            return format!("{why} ({name})");
        }
        match &self.map {
            Ok(map) if side < map.cell && !are_alike(side, map.cell) => {
                format!("smaller than a cell of the map ({name})")
            }
            Ok(map) if FEWEST as f64 * side > shorter(map) => format!("{} ({name})", ScanWarning::Few),
            _ => format!("no such patches ({name}): give both the same with web.patches or --patches"),
        }
    }
}

/// How many standard errors an end of an interval is away, over 1.96, where the standard error alone would mislead.
const FAR: f64 = 1.5;
/// Part of a number below which its standard error is a share of it.
const SMALL: f64 = 1.0 / 3.0;

impl WebNumber {
    /// A value with its standard error.
    pub(super) const fn known(value: f64, standard_error: f64) -> Self {
        Self { value, standard_error: Some(standard_error), ends: None, doubt: None }
    }

    /// A value that is not to be believed as it stands.
    pub(super) const fn doubtful(value: f64, doubt: String) -> Self {
        Self { value, standard_error: None, ends: None, doubt: Some(doubt) }
    }

    /// With the error by all causes in place of that by chance alone, if it is known: what is not chance
    /// makes the interval wider on both sides, by the same share of the number.
    fn with_all_causes(self, whole: &Json) -> Self {
        let Some((whole, chance)) = whole.as_f64().zip(self.standard_error) else { return self };
        let value = self.value;
        let others = NORMAL_95 * (whole * whole - chance * chance).max(0.0).sqrt() / value;
        let end = |end: f64| {
            let log = (end / value).ln();
            value * (log.signum() * log.hypot(others)).exp()
        };
        Self { standard_error: Some(whole), ends: self.ends.map(|ends| ends.map(end)), ..self }
    }

    /// The error upwards or downwards, so that 1.96 of it reach to the end of the interval.
    pub(super) fn error_towards(&self, up: bool) -> Option<f64> {
        match self.ends {
            Some(ends) => Some((ends[usize::from(up)] - self.value).abs() / NORMAL_95),
            None => self.standard_error,
        }
    }

    /// The same of its logarithm.
    pub(super) fn log_error_towards(&self, up: bool) -> Option<f64> {
        match self.ends {
            Some(ends) => Some((ends[usize::from(up)] / self.value).ln().abs() / NORMAL_95),
            None => self.standard_error.map(|error| error / self.value),
        }
    }

    /// Whether its errors are shares of it: with an interval, which is that of a deviation, or with an error that is
    /// small beside it.
    pub(super) fn is_of_shares(&self) -> bool {
        let is_small = |error: f64| error < SMALL * self.value;
        self.value > 0.0
            && (self.ends.map_or(self.standard_error.is_some_and(is_small), |[low, _]| low > 0.0))
    }

    /// Its 95 % interval, unless there is a doubt.
    pub(super) fn interval(&self) -> Option<[f64; 2]> {
        let end = |up: bool| Some(NORMAL_95 * self.error_towards(up)?);
        let [below, above] = [end(false)?, end(true)?];
        self.doubt.is_none().then_some([self.value - below, self.value + above])
    }
}

/// A number of two webs, or why one has none.
///
/// * `objection` – why nothing is said of such numbers
pub(super) fn measure(
    label: String,
    column: String,
    unit: Unit,
    values: [Result<WebNumber, String>; 2],
    objection: Option<String>,
) -> ComparedMeasure {
    let doubt_of = |value: &Result<WebNumber, String>| match value {
        Ok(number) => number.doubt.clone(),
        Err(reason) => Some(reason.clone()),
    };
    let doubts: Vec<String> = values.iter().filter_map(doubt_of).collect();
    let doubt = objection.or_else(|| (!doubts.is_empty()).then(|| doubts.join("; ")));
    // The ends of both intervals that face each other make that of the difference: Zou and Donner, Statistics
    // in Medicine 27 (2008) 1693–1702. A standard error is from many parts of a web, and a normal
    // distribution serves. Errors that are shares of their numbers are those of logarithms: a CV and its square then
    // have one verdict.
    let difference = |a: &WebNumber, b: &WebNumber| {
        let up = b.value > a.value;
        if a.is_of_shares() && b.is_of_shares() {
            let errors = [a.log_error_towards(up)?, b.log_error_towards(!up)?];
            return Some(difference_of_logarithms([a.value, b.value], errors));
        }
        let standard_error = a.error_towards(up)?.hypot(b.error_towards(!up)?);
        Some(Difference { value: b.value - a.value, standard_error, degrees: f64::INFINITY })
    };
    let difference = match (&values, &doubt) {
        ([Ok(a), Ok(b)], None) => difference(a, b),
        _ => None,
    };
    let remark = match (&values, &difference) {
        ([Ok(a), Ok(b)], Some(difference)) if !difference.is_significant() => {
            let up = b.value > a.value;
            let far =
                [(a, up), (b, !up)].into_iter().filter_map(|(number, up)| far_end(number, up, unit.per_si));
            far.reduce(|a, b| format!("{a}; {b}"))
        }
        _ => None,
    };
    let means = values.map(|number| {
        let (mean, standard_error) =
            number.map_or((f64::NAN, None), |number| (number.value, number.standard_error));
        Estimate { mean, standard_error, values: Vec::new() }
    });
    ComparedMeasure { label, column, unit, means, difference, remark, doubt }
}

/// That the interval of a number reaches far further to one side than its standard error reports.
fn far_end(number: &WebNumber, up: bool, per_si: f64) -> Option<String> {
    let ([low, high], error) = (number.interval()?, number.standard_error?);
    let is_far = number.error_towards(up)? > FAR * error;
    let [value, low, high] = [number.value, low, high].map(|value| significant(value * per_si, 3));
    is_far.then(|| format!("{value} has the 95 % interval {low} to {high}"))
}

/// The CV at a patch of nearly the same size, moved to that size along the slope to its neighbour.
fn at(patches: &[Patch], side: f64) -> Option<WebNumber> {
    let far = |patch: &Patch| (side / patch.side).ln().abs();
    let (i, nearest) = patches.iter().enumerate().min_by(|a, b| far(a.1).total_cmp(&far(b.1)))?;
    if !are_alike(side, nearest.side) {
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
pub(super) mod tests {
    use super::*;

    pub(in super::super) const fn number(value: f64, ends: Option<[f64; 2]>) -> WebNumber {
        WebNumber { value, standard_error: Some(0.01), ends, doubt: None }
    }

    impl WebNumber {
        /// The error of a power of it, and the ends of its interval.
        pub(in super::super) fn error_of_power(&self, power: i32) -> Option<f64> {
            let slope = f64::from(power).abs() * self.value.powi(power - 1);
            self.standard_error.map(|error| slope * error)
        }

        pub(in super::super) fn ends_of_power(&self, power: i32) -> Option<[f64; 2]> {
            let ends = self.ends.map(|ends| ends.map(|end| end.powi(power)))?;
            Some(if power < 0 { [ends[1], ends[0]] } else { ends })
        }
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
}
