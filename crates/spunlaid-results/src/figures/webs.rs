//! The figures of a study of webs: the unevenness against what varies.

use super::compare::COLOURS;
use super::study::{Along, name_of_key};
use crate::numbers::significant;
use crate::webs::{PatchOfWebs, PointOfWebs};
use spunlaid::input::WebStudy;
use spunlaid::study::Design;
use spunlaid_charts::{Axis, Chart, Figure, Series};

/// Side of the patches of which a figure speaks that shows one size only [m].
const USUAL: f64 = 0.01;
const PER_CENT: f64 = 100.0;
const BARS: &str = "Markers: the maps, with bars of one standard error, from the scatter of the webs of a point or from the parts of a \
                    single one. Lines: what single fibres let expect.";

/// All figures.
pub fn figures_of_webs(study: &WebStudy, results: &[PointOfWebs]) -> Vec<Figure> {
    let alone = study.factors.len() == 1 || study.design == Design::Paired;
    if alone {
        return vec![over_one(study, results)];
    }
    (0..study.factors.len()).map(|factor| over_others(study, results, factor)).collect()
}

fn axis_of_cv() -> Axis {
    Axis::linear("Coefficient of variation CV (%)").in_column("cv_percent").zero_based()
}

fn side(patch: f64) -> String {
    format!("{} mm", significant(patch * 1e3, 3))
}

/// Draws the CV of some points: markers for the maps, a line for the expectation.
fn curve(chart: Chart, series: &Series, of: &mut [(f64, &PatchOfWebs)], joined: bool) -> Chart {
    of.sort_by(|a, b| a.0.total_cmp(&b.0));
    let spot = |(x, patch): &(f64, &PatchOfWebs)| {
        (*x, patch.cv * PER_CENT, patch.standard_error.map(|error| error * PER_CENT))
    };
    let spots: Vec<_> = of.iter().map(spot).collect();
    let expected: Vec<(f64, f64)> = of.iter().map(|(x, patch)| (*x, patch.one_fibre * PER_CENT)).collect();
    if joined {
        let line = series.clone().unlabelled().unmarked().width(1.4);
        chart.line(line, &expected).scatter(series.clone(), &spots)
    } else {
        chart.scatter(series.clone(), &spots)
    }
}

/// A curve for each size of the patches, over the only factor or over the first of paired ones.
fn over_one(study: &WebStudy, results: &[PointOfWebs]) -> Figure {
    let Some(factor) = study.factors.first() else { return Figure::of(&empty("none", Axis::linear("")), "") };
    let along = Along::new(factor, None);
    let mut chart = empty(factor.key, along.axis.clone());
    let patches: Vec<f64> =
        results.first().into_iter().flat_map(|of| &of.patches).map(|of| of.patch).collect();
    for (patch, colour) in patches.iter().zip(COLOURS) {
        let of = |(point, of): (&spunlaid::input::WebPoint, &'_ PointOfWebs)| {
            Some((
                along.place(*point.values.first()?),
                of.patches.iter().find(|of| same(of.patch, *patch))?.clone(),
            ))
        };
        let found: Vec<(f64, PatchOfWebs)> = study.points.iter().zip(results).filter_map(of).collect();
        let mut found: Vec<(f64, &PatchOfWebs)> = found.iter().map(|(x, of)| (*x, of)).collect();
        chart = curve(chart, &Series::spots(&side(*patch), colour), &mut found, along.is_joined());
    }
    let paired = if study.factors.len() > 1 { " The other keys vary with it." } else { "" };
    let caption = format!(
        "Coefficient of variation of the basis weight over square patches, a colour for each size, over the {}.{paired} {BARS}",
        name_of_key(factor.key)
    );
    Figure::of(&chart, caption)
}

/// The CV over patches of one size over a factor, with a curve for each combination of the others if these are few.
fn over_others(study: &WebStudy, results: &[PointOfWebs], factor: usize) -> Figure {
    let along = Along::new(&study.factors[factor], None);
    let key = study.factors[factor].key;
    let mut chart = empty(key, along.axis.clone());
    let usual = |of: &PointOfWebs| {
        of.patches.iter().min_by(|a, b| (a.patch - USUAL).abs().total_cmp(&(b.patch - USUAL).abs())).cloned()
    };
    let chosen: Vec<Option<PatchOfWebs>> = results.iter().map(usual).collect();
    // The values of the other factors, each combination once.
    let others = |point: usize| -> Vec<f64> {
        let values = study.points[point].values.iter().enumerate();
        values.filter(|(i, _)| *i != factor).map(|(_, value)| *value).collect()
    };
    let mut groups: Vec<(Vec<f64>, Vec<usize>)> = Vec::new();
    for point in 0..study.points.len() {
        let of = others(point);
        match groups.iter_mut().find(|(values, _)| *values == of) {
            Some((_, points)) => points.push(point),
            None => groups.push((of, vec![point])),
        }
    }
    let told = study.design == Design::Grid && groups.len() <= COLOURS.len();
    if !told {
        groups = vec![(Vec::new(), (0..study.points.len()).collect())];
    }
    for ((values, points), colour) in groups.iter().zip(COLOURS) {
        let inputs = study.factors.iter().enumerate().filter(|(i, _)| *i != factor);
        let named = inputs.zip(values).map(|((_, of), value)| of.input().pretty(*value));
        let label = named.collect::<Vec<_>>().join(", ");
        let place = |point: &usize| {
            Some((along.place(study.points[*point].values[factor]), chosen[*point].as_ref()?))
        };
        let mut found: Vec<(f64, &PatchOfWebs)> = points.iter().filter_map(place).collect();
        let series = Series::spots(&label, colour);
        let series = if told { series } else { series.unlabelled() };
        chart = curve(chart, &series, &mut found, told && along.is_joined());
    }
    let patch = chosen.iter().flatten().next().map_or_else(String::new, |of| side(of.patch));
    let how = if told {
        "a colour for each combination of the other keys"
    } else {
        "all points, whose other keys differ"
    };
    let caption = format!(
        "Coefficient of variation of the basis weight over patches of {patch}, over the {}, {how}. {BARS}",
        name_of_key(key)
    );
    Figure::of(&chart, caption)
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() < 1e-9 * b
}

fn empty(key: &str, axis: Axis) -> Chart {
    let name = format!("cv_over_{}", key.replace('.', "_"));
    Chart::new(&name, "Unevenness of the web", axis, axis_of_cv())
}
