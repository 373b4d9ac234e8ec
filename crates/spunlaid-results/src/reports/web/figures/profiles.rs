//! The basis weight across a web, with its edges, and along it.

use super::{GRAMS, MM, PER_CENT, Weights};
use crate::numbers::significant;
use spunlaid_charts::palette::{BLUE, GREY, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Series};
use spunlaid_web::map::Findings;
use spunlaid_web::scan::{StreakSearch, WIDTH};
use spunlaid_web::{Edges, Map, Web};

/// Most points of a profile; more cells are averaged.
const POINTS: usize = 1000;

/// Where a web lies across its sheet.
struct SheetPosition {
    /// Its edges [m].
    edges: [f64; 2],
    /// Widths of the strips at both sides of the sheet that do not count [m].
    margins: [f64; 2],
    /// What the legend calls the edges.
    label: &'static str,
    /// What the caption says of them.
    words: String,
}

/// The profiles of a laid web.
pub(super) fn laid(web: &Web, findings: &Findings) -> Figure {
    let (edges, margins) = (findings.reach, findings.margins);
    let millimetres = |length: f64| significant(length * MM, 4);
    let (label, words) = match web.sheet.edges {
        Edges::Periodic => (
            "edge of the sheet",
            "The dashed lines are the edges of the sheet; the web goes on beyond them (web.edges = \
            \"periodic\")."
                .to_owned(),
        ),
        Edges::Cut => (
            "edge of the web",
            format!(
                "The dashed lines are the edges of the web at {} and {} mm, 3 σ_CD beyond the outermost \
                filaments or where the sheet cuts it. It is thinner in the grey strips next to them, {} and \
                {} mm wide. These are shown here only and are in no other number.",
                millimetres(edges[0]),
                millimetres(edges[1]),
                millimetres(margins[0] - edges[0]),
                millimetres(edges[1] - (web.sheet.width - margins[1]))
            ),
        ),
    };
    let streaks = "These are streaks, which filaments at fixed positions leave in the web; they are weaker \
        where the holes have a constant pitch (line.rows).";
    profiles(&findings.laid.map, GRAMS, streaks, &SheetPosition { edges, margins, label, words })
}

/// The profiles of a scan.
pub(super) fn scanned(map: &Map, weights: Weights) -> Figure {
    let across = SheetPosition {
        edges: [0.0, map.columns as f64 * map.cell],
        margins: [0.0; 2],
        label: "edge of the scan",
        words: "The dashed lines are the edges of the scan.".to_owned(),
    };
    profiles(map, weights, "These are streaks, if the lamp was uniform.", &across)
}

/// The streaks of a scan, with the band that chance fills.
pub(super) fn streaks(search: &StreakSearch) -> Figure {
    let StreakSearch { bin, profile, limits, streaks, periods } = search;
    let width = profile.len() as f64 * bin * MM;
    let x = Axis::linear("Cross direction (mm)").including(0.0).including(width);
    let mut chart = Chart::new("web_streaks", "", x, Axis::linear("Basis weight from the mean (%)"));
    let chance = limits.first().map_or(0.0, |limit| limit.amplitude * PER_CENT);
    let band = [(0.0, -chance, chance), (width, -chance, chance)];
    chart = chart.band(Series::new("not significant, of the narrowest streaks", GREY), band);
    for (i, streak) in streaks.iter().enumerate() {
        let series = Series::new("streak", VERMILION);
        let half = WIDTH / 2.0 * streak.sigma;
        let series = if i == 0 { series } else { series.unlabelled() };
        chart = chart.stretch(series, (streak.place - half) * MM, (streak.place + half) * MM);
    }
    let points = profile.iter().enumerate().map(|(i, value)| ((i as f64 + 0.5) * bin * MM, value * PER_CENT));
    let chart = chart.line(Series::new("mean along the machine", BLUE).unlabelled().width(1.4), points);
    let waves: Vec<String> = periods.iter().map(|wave| significant(wave.period * MM, 3)).collect();
    let waves = match waves.is_empty() {
        true => String::new(),
        false => format!(" Periods: {} mm.", waves.join(", ")),
    };
    let caption = format!(
        "Basis weight at a position across the web, averaged along the machine, over the mean. A narrow streak that \
         leaves the grey band is significant at 95 %; a wider one is significant at a smaller amplitude. Red: \
         streaks, as wide as at half of their amplitude.{waves}"
    );
    Figure::new(&chart, caption)
}

/// Basis weight across the web and along it.
fn profiles(map: &Map, weights: Weights, streaks: &str, across: &SheetPosition) -> Figure {
    let [first, last] = across.margins.map(|margin| (margin / map.cell).round() as usize);
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
    let chart = |name: &str, x: Axis, points: &[(f64, f64)], line: Series| {
        let ends = [points.first(), points.last()].map(|end| (end.map_or(0.0, |end| end.0), mean));
        Chart::new(name, "", x, Axis::linear(weights.axis))
            .line(Series::new("", GREY).unlabelled().adorning().width(1.0), ends)
            .line(line.unlabelled().width(1.4), points)
    };
    let width = map.columns as f64 * map.cell;
    let axis = Axis::linear("Cross direction (mm)").including(0.0).including(width * MM);
    let profile = points(map.profile_cd());
    let above = chart("cd", axis, &profile, Series::new("mean along Cross", BLUE));
    let above = with_edges(above, across, width);
    let profile = points(between.profile_md());
    let axis = Axis::linear("Machine direction (mm)").tight();
    let below = chart("md", axis, &profile, Series::new("mean along Machine", VERMILION));
    let inner = points(between.profile_cd());
    let cv = |points: &[(f64, f64)]| {
        let squares = points.iter().map(|(_, weight)| (weight / mean - 1.0).powi(2)).sum::<f64>();
        significant(PER_CENT * (squares / points.len() as f64).sqrt(), 2)
    };
    let caption = format!(
        "Above: the basis weight at a position across the web, averaged over the whole length of the sheet; it \
        varies by {} %. {streaks} {} Below: the basis weight at a position along the web, averaged over the whole \
        width; it varies by {} %. The grey lines are the mean.",
        cv(&inner),
        across.words,
        cv(&profile)
    );
    Figure::stacked("web_profiles", "Profiles across and along the web", &[&above, &below], caption)
}

/// With lines at the edges of the web, and with the strips that do not count.
fn with_edges(chart: Chart, across: &SheetPosition, width: f64) -> Chart {
    let [first, last] = across.edges;
    let strips = [(first, across.margins[0]), (width - across.margins[1], last)];
    let strips = strips.into_iter().filter(|(from, to)| to > from).enumerate();
    let chart = strips.fold(chart, |chart, (i, (from, to))| {
        let series = Series::new("thinner, not counted", GREY);
        let series = if i == 0 { series } else { series.unlabelled() };
        chart.stretch(series, from * MM, to * MM)
    });
    let line = Series::reference(across.label);
    chart.vertical(line.clone(), first * MM).vertical(line.unlabelled(), last * MM)
}
