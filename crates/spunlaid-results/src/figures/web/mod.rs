//! The figures of a web's report.

mod clouds;
mod neighbours;
mod overlaid;
mod unevenness;

pub use clouds::SEEN;
pub use overlaid::{ComparedPatch, ComparedSpectrum, overlaid_spectra, overlaid_webs};

use spunlaid::scan;
use spunlaid::web::{Findings, Map, Web};
use spunlaid_charts::{
    Axis, Chart, Figure, Rose, Series,
    palette::{BLUE, GREY, VERMILION},
};

const MM: f64 = 1e3;
const PER_CENT: f64 = 100.0;

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
        unevenness::over_patches(web, findings),
        unevenness::histogram(&findings.within(), GRAMS),
        profiles(map, GRAMS, STREAKS, findings.margins),
    ];
    let together = findings.laid.together.as_ref();
    figures.extend(together.and_then(|together| neighbours::figure(&together.neighbours)));
    figures.extend(clouds::figures(findings.clouds.as_ref(), &findings.autocorrelation, map.cell));
    figures.push(directions(findings));
    figures
}

/// All figures of a scanned web, in the order of the report.
pub fn scan_figures(findings: &scan::Findings) -> Vec<Figure> {
    let map = &findings.map;
    let weights = if findings.mean_known { GRAMS } else { SHARES };
    let streaks = "These are streaks, as far as the lamp was even.";
    let mut figures = vec![
        unevenness::scanned(findings),
        unevenness::histogram(map, weights),
        profiles(map, weights, streaks, [0.0; 2]),
    ];
    figures.extend(clouds::figures(findings.clouds.as_ref(), &findings.autocorrelation, map.cell));
    figures
}

/// What the profile across a laid web shows.
const STREAKS: &str = "These are streaks, which filaments at fixed places leave in the web; they are weaker where nozzles stand at an even \
                       pitch (line.rows).";
/// Most points of a profile; more cells are averaged.
const POINTS: usize = 1000;

/// Basis weight across the web and along it.
///
/// * `margins` – widths of the strips at both edges that do not count [m]
fn profiles(map: &Map, weights: Weights, streaks: &str, margins: [f64; 2]) -> Figure {
    let [first, last] = margins.map(|margin| (margin / map.cell).round() as usize);
    let between = map.between(first..map.columns - last);
    let mean = between.basis_weight() * weights.factor;
    let points = |profile: Vec<f64>| -> Vec<(f64, f64)> {
        let each = profile.len().div_ceil(POINTS).max(1);
        let parts = profile.chunks(each).enumerate();
        let value = |part: &[f64]| part.iter().sum::<f64>() / part.len() as f64 * weights.factor;
        parts
            .map(|(i, part)| (((i * each) as f64 + 0.5 * part.len() as f64) * map.cell * MM, value(part)))
            .collect()
    };
    let chart = |name: &str, direction: &str, points: &[(f64, f64)], colour| {
        let x = Axis::linear(&format!("{direction} direction (mm)")).tight();
        let ends = [points.first(), points.last()].map(|end| (end.map_or(0.0, |end| end.0), mean));
        Chart::new(name, "", x, Axis::linear(weights.axis))
            .line(Series::new("", GREY).unlabelled().adorning().width(1.0), &ends)
            .line(Series::new(&format!("mean along {direction}"), colour).unlabelled().width(1.4), points)
    };
    let (across, along) = (points(map.profile_cd()), points(between.profile_md()));
    let inner = points(between.profile_cd());
    let cv = |points: &[(f64, f64)]| {
        let squares = points.iter().map(|(_, weight)| (weight / mean - 1.0).powi(2)).sum::<f64>();
        crate::numbers::significant(PER_CENT * (squares / points.len() as f64).sqrt(), 2)
    };
    let caption = format!(
        "Above: the basis weight at a place across the web, averaged over the whole length of the sheet; it varies by {} %. \
         {streaks} Below: the basis weight at a place along the web, \
         averaged over the whole width; it varies by {} %. The grey lines are the mean.",
        cv(&inner),
        cv(&along)
    );
    let caption = if margins == [0.0; 2] {
        caption
    } else {
        format!(
            "{caption} The web is thinner at its edges, beyond the dashed lines: these strips of {} and {} mm show here only, and no other number holds them.",
            crate::numbers::significant(margins[0] * MM, 3),
            crate::numbers::significant(margins[1] * MM, 3)
        )
    };
    let highest = across.iter().map(|(_, weight)| *weight).fold(mean, f64::max);
    let marks = [first, map.columns - last].map(|column| column as f64 * map.cell * MM);
    let marked = |chart: Chart| {
        let marks = marks.into_iter().zip(margins).filter(|(_, margin)| *margin > 0.0);
        marks.fold(chart, |chart, (at, _)| {
            let line = Series::new("", GREY).unlabelled().adorning().dashed("6 4");
            chart.path(line, &[(at, 0.0), (at, highest)])
        })
    };
    let (above, below) =
        (marked(chart("cd", "Cross", &across, BLUE)), chart("md", "Machine", &along, VERMILION));
    Figure::stacked("web_profiles", "Profiles across and along the web", &[&above, &below], caption)
}

/// Directions of the fibre.
fn directions(findings: &Findings) -> Figure {
    let found = &findings.orientation;
    let classes = found.directions.len() as f64;
    let rose = Rose {
        name: "web_directions".to_owned(),
        title: "Directions of the fibres".to_owned(),
        classes: found.directions.iter().map(|share| (share * classes, None)).collect(),
        reference: Some((1.0, "as often in all directions".to_owned())),
        sides: ["MD", "CD", "against MD", "CD"].map(str::to_owned),
        columns: ["direction_degrees", "share_of_mass_times_classes"].map(str::to_owned),
        series: "web".to_owned(),
    };
    let orientation = &found.cos_squared;
    rose.figure(format!(
        "Share of the mass by direction, in the sense in which the fibre was fed, times the number of classes. The mean of the \
         squared cosine of the angle to the machine direction is {}; without orientation it is ½. MD over CD: {}.",
        crate::numbers::plus_minus(orientation.mean, orientation.standard_error),
        crate::numbers::significant(found.md_cd_ratio(), 3)
    ))
}
