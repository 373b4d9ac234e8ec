//! All kinds of studies give figures.

use super::*;
use crate::reports::run::sample;
use crate::reports::study::figures::quantity::name_of_key;
use spunlaid_charts::png;
use spunlaid_experiment::{Contrast, Factor, Levels, Point, Replicates, Spacing};
use spunlaid_fibre::case::keys::{Kind, Sign, VariedKey};
use spunlaid_ground::{Difference, Dimension, Effect};
use spunlaid_simulation::MEASURES;

/// A study with synthetic factors and results.
fn study(design: Design, counts: &[usize]) -> (Study, Vec<PointResults>) {
    let keys = [
        ("air.velocity", Dimension::Velocity),
        ("fibre.diameter", Dimension::Length),
        ("air.turbulence_intensity", Dimension::Ratio),
    ];
    let factors: Vec<Factor> = (keys.iter().zip(counts))
        .map(|(&(key, dimension), &steps)| {
            let spacing = if key == "fibre.diameter" { Spacing::Logarithmic } else { Spacing::Linear };
            let steps = (!design.draws()).then_some(steps as u64);
            let levels = Levels::Range { from: 1e-3, to: 1e-1, steps, spacing };
            Factor { key: VariedKey::new(key, Kind::Quantity(dimension, Sign::Any)), levels }
        })
        .collect();
    let rows = design.rows(&factors, &vec![1e-3; factors.len()], 1);
    let case = sample::case(2, 2, 1);
    let point = |values| Point { values, experiment: case.clone().into() };
    let points: Vec<Point> = rows.into_iter().map(point).collect();
    let results = (points.iter().enumerate())
        .map(|(i, point)| {
            let mean = |m: usize| if i == 1 { f64::NAN } else { point.values[0] * (m + 1) as f64 };
            let mean: Vec<f64> = (0..MEASURES.len()).map(mean).collect();
            PointResults::new(10, 0, &mean, &vec![1e-3; MEASURES.len()])
        })
        .collect();
    let of_fibres = Study::from_cases([case], Replicates::fixed(10));
    (Study { factors, design, seed: 1, points, ..of_fibres }, results)
}

fn rankings(study: &Study) -> Vec<Ranking> {
    let effect = |factor: usize| {
        let standard_error = if factor > 0 { 0.003 } else { f64::NAN };
        let value = -0.01 / (factor + 1) as f64;
        let contrast = Contrast { factor, from: 1e-3, to: 1e-1 };
        Effect::new(contrast, Difference { value, standard_error, degrees: f64::INFINITY })
    };
    let effects: Vec<Effect<Contrast>> = (0..study.factors.len()).map(effect).collect();
    let ranking = |measure| Ranking {
        measure,
        middle: Some(0.1),
        explained: Some(0.9),
        effects: effects.clone(),
        terms: Vec::new(),
    };
    (0..MEASURES.len()).map(ranking).collect()
}

#[test]
fn draws_every_kind_of_study() {
    let declared = MEASURES.iter().map(|measure| measure.figure.name);
    let n = declared.collect::<std::collections::BTreeSet<_>>().len();
    for (design, counts, expected) in [
        (Design::Grid, &[5][..], n),
        (Design::Grid, &[1], n),
        (Design::Grid, &[5, 3], n + 2),
        // A map for each measure.
        (Design::Grid, &[9, 30], MEASURES.len() + 2),
        (Design::Grid, &[3, 4, 2], 6 + 2),
        (Design::OneAtATime, &[3, 4, 2], 6 + 2),
        (Design::Paired, &[3, 3], n + 2),
        (Design::LatinHypercube(64), &[0, 0, 0], 6 + 2),
        (Design::LatinHypercube(2000), &[0, 0], 4 + 2),
    ] {
        let (study, results) = study(design, counts);
        let figures = study_figures(&study, &results, &rankings(&study));
        let names: std::collections::BTreeSet<&str> = figures.iter().map(|f| f.name.as_str()).collect();
        assert_eq!((figures.len(), names.len()), (expected, expected), "{design:?} {counts:?} {names:?}");
        for figure in &figures {
            let svg = &figure.svg();
            assert!(!svg.contains("NaN") && !svg.contains("inf"), "{}:\n{svg}", figure.name);
            assert!(svg.len() < 400_000 && !figure.caption.contains("NaN"), "{}", figure.name);
            assert!(png(&figure.picture(), 192, &[]).unwrap().len() > 1000, "{}", figure.name);
        }
    }
}

#[test]
fn a_result_that_applies_to_no_point_is_not_drawn() {
    let (study, results) = study(Design::Grid, &[5]);
    let names = |results: &[PointResults]| -> Vec<String> {
        let figures = study_figures(&study, results, &rankings(&study));
        let with =
            |figure: &&Figure| figure.svg().contains("work check") || figure.caption.contains("work check");
        figures.iter().filter(with).map(|figure| figure.name.clone()).collect()
    };
    assert_eq!(names(&results), ["energy_error_over_air_velocity", "energy_error_at_end_over_air_velocity"]);
    // Implicit tension has no work check.
    let without = |point: &PointResults| {
        let mean = |m: usize| {
            if MEASURES[m].name.starts_with("work_error") { f64::NAN } else { point.mean(m) }
        };
        let [mean, errors] = [&mean as &dyn Fn(usize) -> f64, &|m| point.error(m)]
            .map(|of| (0..MEASURES.len()).map(of).collect::<Vec<_>>());
        PointResults::new(point.n, point.lost, &mean, &errors)
    };
    let results: Vec<PointResults> = results.iter().map(without).collect();
    assert!(names(&results).is_empty());
}

#[test]
fn keys_are_named_in_words() {
    assert_eq!(name_of_key("air.velocity"), "mean velocity");
    assert_eq!(name_of_key("fibre.youngs_modulus"), "Young’s modulus");
    assert_eq!(name_of_key("air.length_scale"), "integral length scale");
    assert_eq!(name_of_key("air.harmonics"), "number of harmonics");
}
