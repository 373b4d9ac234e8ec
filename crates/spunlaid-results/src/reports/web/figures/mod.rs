//! The figures of a web's report.

pub(crate) mod clouds;
mod curtain;
pub(crate) mod effects;
pub(crate) mod patch_cv;
mod profiles;

use spunlaid_charts::{Figure, Rose};
use spunlaid_web::map::Findings;
use spunlaid_web::{Web, scan};

pub(crate) const MM: f64 = 1e3;
pub(crate) const PER_CENT: f64 = 100.0;

/// How the basis weights of a map are shown.
#[derive(Clone, Copy, Debug)]
struct Weights {
    /// Heading of an axis.
    axis: &'static str,
    unit: &'static str,
    /// Units in a kg/m².
    factor: f64,
}

const GRAMS: Weights = Weights { axis: "Basis weight (g/m^{2})", unit: "g/m²", factor: 1e3 };
/// For a map whose mean of one stands for an unknown one.
const SHARES: Weights =
    Weights { axis: "Basis weight over its mean (%)", unit: "% of the mean", factor: 100.0 };

/// All figures, in the order of the report.
pub fn web_figures(web: &Web, findings: &Findings) -> Vec<Figure> {
    let map = &findings.laid.map;
    let mut figures = vec![
        patch_cv::over_patches(web, findings),
        patch_cv::histogram(&findings.within(), GRAMS),
        profiles::laid(web, findings),
    ];
    figures.extend(curtain::neighbours(&findings.laid.simulated));
    figures.extend(curtain::charge(&findings.laid));
    figures.extend(clouds::figures(findings.clouds.as_ref(), &findings.autocorrelation, map.cell));
    figures.push(directions(findings));
    figures
}

/// All figures of a scanned web, in the order of the report.
pub fn scan_figures(findings: &scan::Findings) -> Vec<Figure> {
    let map = &findings.map;
    let weights = if findings.mean_known { GRAMS } else { SHARES };
    let mut figures =
        vec![patch_cv::scanned(findings), patch_cv::histogram(map, weights), profiles::scanned(map, weights)];
    figures.extend(findings.streaks.as_ref().map(profiles::streaks));
    figures.extend(clouds::figures(findings.clouds.as_ref(), &findings.autocorrelation, map.cell));
    figures
}

/// Directions of the fibre.
fn directions(findings: &Findings) -> Figure {
    let found = &findings.orientation;
    let classes = found.directions.len() as f64;
    let rose = Rose {
        name: "web_directions".to_owned(),
        title: "Directions of the fibres".to_owned(),
        classes: found.directions.iter().map(|share| (share * classes, None)).collect(),
        reference: Some((1.0, "isotropic".to_owned())),
        sides: ["MD", "CD", "against MD", "CD"].map(str::to_owned),
        columns: ["direction_degrees", "share_of_mass_times_classes"].map(str::to_owned),
        series: "web".to_owned(),
    };
    let orientation = &found.cos_squared;
    rose.figure(format!(
        "Fraction of the mass by direction, in the sense in which the fibre was fed, times the number of \
        classes. The mean of the squared cosine of the angle to the machine direction is {}; without \
        orientation it is ½. MD over CD: {}.",
        crate::numbers::plus_minus(orientation.mean, orientation.standard_error),
        {
            let (ratio, error) = found.md_cd_ratio();
            crate::numbers::plus_minus(ratio, error)
        }
    ))
}
