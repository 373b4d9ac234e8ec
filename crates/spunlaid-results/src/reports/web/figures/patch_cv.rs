//! How uneven the web is: over patches, and cell by cell.

use super::{MM, PER_CENT, Weights};
use crate::figures::joined;
use crate::numbers::significant;
use spunlaid_charts::palette::{BLUE, VERMILION};
use spunlaid_charts::{Axis, Chart, Figure, Series};
use spunlaid_web::map::uniformity::PatchCv;
use spunlaid_web::map::{Evidence, Findings, PatchFindings, straight_fibres};
use spunlaid_web::{Edges, Map, Web, scan};

pub(crate) fn empty_chart() -> Chart {
    Chart::new(
        "web_cv",
        "CV of basis weight over the size of the patches",
        Axis::logarithmic("Side of a patch (mm)").in_column("patch_mm"),
        Axis::logarithmic("Coefficient of variation CV (%)").in_column("cv_percent"),
    )
}

/// Side [mm], CV and its standard error [%].
fn point(patch_cv: &PatchCv) -> (f64, f64, Option<f64>) {
    (patch_cv.patch * MM, patch_cv.cv * PER_CENT, patch_cv.standard_error.map(|error| error * PER_CENT))
}

/// The coefficient of variation of a scanned web over the size of the patches.
pub(super) fn scanned(findings: &scan::Findings) -> Figure {
    let found: Vec<_> = findings.patches.iter().map(|patch| point(&patch.patch_cv)).collect();
    let noise = findings.patches.iter().map(|patch| (patch.patch_cv.patch * MM, patch.noise * PER_CENT));
    let chart = empty_chart().line(Series::reference("noise of the pixels"), noise);
    let chart = joined(chart, Series::spots("this scan", BLUE), &found);
    Figure::new(
        &chart,
        "Standard deviation of the basis weight of square patches over its mean. Bars are the sampling error of one \
         piece of web (one standard error); it is missing where it cannot be known. Dashed: the CV of the noise of \
         the pixels alone, as it was given, or its upper bound from neighbouring pixels, which includes the finest \
         structure of the web.",
    )
}

/// The coefficient of variation over the size of the patches.
pub(super) fn over_patches(web: &Web, findings: &Findings) -> Figure {
    let map = findings.patches.iter().filter_map(PatchFindings::with_total_error);
    let map: Vec<_> = map.map(|reported| point(&reported)).collect();
    let patches = || findings.patches.iter();
    let single =
        patches().filter_map(|patch| Some((patch.map.patch * MM, patch.single_fibres?.0 * PER_CENT)));
    let single: Vec<(f64, f64)> = single.collect();
    let straight = patches().map(|patch| (patch.map.patch * MM, patch.straight_fibres * PER_CENT));
    let mut chart = empty_chart().line(Series::reference("straight fibres at random"), straight);
    let is_shared = findings.laid.evidence() != Evidence::Known;
    let of_single = if is_shared {
        "the same filaments in independent turbulence"
    } else {
        "expected, from single fibres"
    };
    if !single.is_empty() {
        chart = chart.line(Series::new(of_single, VERMILION).width(1.8), &single);
    }
    let of_few = findings.patches.iter().any(|patch| patch.few.is_some());
    let spots = if of_few { "the web of all filaments, from the simulated ones" } else { "this map" };
    let spots = Series::spots(spots, BLUE);
    let chart = if is_shared { joined(chart, spots, &map) } else { chart.scatter(spots, &map) };
    let rows = web.layers.iter().any(|layer| !layer.filaments.are_at_random());
    let places = if rows { "in their rows" } else { "at random positions" };
    if is_shared {
        return Figure::new(&chart, shared_air(places, of_few));
    }
    let cut = if web.sheet.edges == Edges::Cut {
        "cut off at the edges in cross direction, and the strips at the edges, where the web is thinner, are left out"
    } else {
        "periodic in both directions"
    };
    let tau = web.basis_weight() / web.layers.first().map_or(f64::NAN, |layer| layer.linear_density);
    let tenth = straight_fibres(tau, 0.01) * PER_CENT;
    let caption = format!(
        "Standard deviation of the basis weight of square patches over its mean; the sheet is {cut}. Bars \
        are the sampling error of the map (one standard error), from its waves. The expected curve is that of \
        independent filaments {places}, from the lengths that one fibre leaves in each patch. Straight fibres of the \
        same mass in all directions would give CV² = 0.946 line density/(basis weight · side), {} % at 10 mm for the \
        first layer’s fibre. The difference between the two is due to the loops of the laydown.",
        significant(tenth, 2)
    );
    Figure::new(&chart, caption)
}

/// What is printed below the figure of a web in shared turbulence.
///
/// * `of_few` – whether a few filaments were simulated for all
fn shared_air(places: &str, of_few: bool) -> String {
    let bars = match of_few {
        true => "from the waves of the map of the simulated filaments, and from the size of this sample",
        false => "from the waves of the map",
    };
    format!(
        "Standard deviation of the basis weight of square patches over its mean, on a length of belt after the \
        start of every filament. Bars are one standard error {bars}. The curve below is what the same filaments \
        {places} would give in independent turbulence: the sum of their own variances, without the correlation of \
        neighbours. Straight fibres are those of the same mass in all directions at random."
    )
}

/// Most classes of a histogram.
const CLASSES: usize = 60;

/// How often each basis weight occurs.
pub(super) fn histogram(map: &Map, weights: Weights) -> Figure {
    let largest = map.cells.iter().copied().max().unwrap_or(0);
    let width = (largest / CLASSES as u32).max(1);
    let mut counts = vec![0u64; (largest / width) as usize + 1];
    map.cells.iter().for_each(|quanta| counts[(quanta / width) as usize] += 1);
    let grams = map.weight_of_quantum() * weights.factor;
    let scale = PER_CENT / (map.cells.len() as f64 * f64::from(width) * grams);
    // A line with a step at each end of a class.
    let steps = counts.iter().enumerate().flat_map(|(i, count)| {
        let ends = [i, i + 1].map(|end| end as f64 * f64::from(width) * grams);
        ends.map(|end| (end, *count as f64 * scale))
    });
    let steps: Vec<(f64, f64)> = steps.collect();
    let mean = map.basis_weight() * weights.factor;
    let squares = map.cells.iter().map(|quanta| (f64::from(*quanta) * grams - mean).powi(2));
    let deviation = (squares.sum::<f64>() / map.cells.len() as f64).sqrt();
    let normal = |i: usize| {
        let at = steps.last().map_or(0.0, |last| last.0) * i as f64 / 200.0;
        let height =
            (-0.5 * ((at - mean) / deviation).powi(2)).exp() / (deviation * std::f64::consts::TAU.sqrt());
        (at, PER_CENT * height)
    };
    let chart = Chart::new(
        "web_histogram",
        "Basis weight, cell by cell",
        Axis::linear(weights.axis).tight(),
        Axis::linear(&format!("Fraction of the cells (% per {})", weights.unit.replace('²', "^{2}")))
            .zero_based(),
    )
    .path(Series::reference("normal distribution").adorning(), (0..=200).map(normal))
    .path(Series::new("web", BLUE).unlabelled().width(1.8), &steps);
    let caption = format!(
        "Cells of {} mm: mean {} {unit}, standard deviation {} {unit}. Dashed: the normal distribution with both.",
        significant(map.cell * MM, 3),
        significant(mean, 3),
        significant(deviation, 3),
        unit = weights.unit
    );
    Figure::new(&chart, caption)
}
