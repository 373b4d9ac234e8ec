//! Main effects of synthetic models: how often the 95 % intervals hold the true effect, and which designs are refused.

use crate::short;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use spunlaid_experiment::Verdict::{Fails, Holds, Open};
use spunlaid_experiment::study::{judge, rankings, results_of_point};
use spunlaid_experiment::{Journal, PointResults, Record, ReplicateOutcome, Study, Verdict};
use spunlaid_simulation::MEASURES;

/// The case is never simulated; its intensity is in the middle of the range that the studies vary.
fn study(text: &str) -> Study {
    short::study(&short::SHORT.replace("turbulence_intensity = 0.1\n", "turbulence_intensity = 0.15\n"), text)
        .study
}

/// A study of three keys; the middle of the diameters is their geometric mean.
fn three_keys(design: &str, replicates: u64, seed: u64) -> Study {
    let steps = if design.contains("points") { "" } else { ", steps = 3" };
    let text = format!(
        "case = 'case.toml'\n{design}\nreplicates = {replicates}\nseed = {seed}\n[vary]\n\
         'air.velocity' = {{ from = '5 m/s', to = '15 m/s' STEPS }}\n\
         'fibre.diameter' = {{ from = '25 µm', to = '100 µm', spacing = 'log' STEPS }}\n\
         'air.turbulence_intensity' = {{ from = 0.05, to = 0.25 STEPS }}\n"
    );
    study(&text.replace("STEPS", steps))
}

/// Pseudo-random numbers of a normal distribution.
struct Normal(ChaCha8Rng);

impl Normal {
    fn next(&mut self) -> f64 {
        let mut uniform = || ((self.0.next_u64() >> 11) as f64 + 0.5) / (1u64 << 53) as f64;
        let (u, v) = (uniform(), uniform());
        (-2.0 * u.ln()).sqrt() * (std::f64::consts::TAU * v).cos()
    }
}

/// A response over the three places −1 … 1.
type Model = fn(&[f64]) -> f64;

/// Standard deviations of the noise: of a fibre alone, of all fibres of a replicate, and of its slopes.
#[derive(Clone, Copy)]
struct Noise {
    fibre: f64,
    replicate: f64,
    slopes: f64,
}

/// The records of a study whose fibres follow the model.
fn simulated(study: &Study, replicates: u64, model: Model, noise: Noise, seed: u64) -> Journal {
    let mut normal = Normal(ChaCha8Rng::seed_from_u64(seed));
    let common: Vec<[f64; 4]> = (0..replicates).map(|_| std::array::from_fn(|_| normal.next())).collect();
    let mut journal = Journal::in_memory();
    for (index, point) in study.points.iter().enumerate() {
        let x: Vec<f64> = study.factors.iter().zip(&point.values).map(|(f, v)| f.place(*v)).collect();
        for (replicate, [all, slopes @ ..]) in (0..).zip(&common) {
            let slope: f64 = slopes.iter().zip(&x).map(|(slope, x)| slope * x).sum();
            let y = model(&x) + noise.fibre * normal.next() + noise.replicate * all + noise.slopes * slope;
            let outcome = ReplicateOutcome::Measured(vec![y; study.quantities.len()].into());
            journal.add(&[Record { point: index as u64, replicate, outcome }]).unwrap();
        }
    }
    journal
}

const STRAIGHT: Model = |x| 5.0 + 3.0 * x[0] - x[1];
const STRAIGHT_UP: Model = |x| 5.0 + 3.0 * x[0];
const BENT: Model = |x| 5.0 + 3.0 * x[0] - x[1] + 2.0 * x[0] * x[0] - 3.0 * x[1] * x[1];
const MIXED: Model = |x| BENT(x) + 1.5 * x[0] * x[1];

/// Studies of each kind.
const TRIALS: u64 = 300;

/// Fraction of intervals that hold the true effects 6, −2 and 0, their mean half-width, and the scatter of the effects.
fn coverage(design: &str, replicates: u64, model: Model, noise: Noise) -> (f64, f64, f64) {
    let mut inside = 0;
    let mut all = 0;
    let mut widths = 0.0;
    let mut errors = 0.0;
    let is_drawn = design.contains("points");
    let of_trial = |trial| {
        let mut study = three_keys(design, replicates, trial);
        // All measures are ranked alike, so one is enough.
        study.quantities.truncate(1);
        study
    };
    let mut study = of_trial(0);
    for trial in 0..TRIALS {
        if is_drawn {
            study = of_trial(trial);
        }
        let mut journal = simulated(&study, replicates, model, noise, trial);
        // A hypercube of few points may be refused for a correlation by chance.
        let rankings = rankings(&study, &mut journal).unwrap().of_measures;
        for effect in rankings.first().iter().flat_map(|ranking| &ranking.effects) {
            let error = effect.difference.value - [6.0, -2.0, 0.0][effect.of.factor];
            inside += u32::from(error.abs() <= effect.difference.known_half_width().unwrap());
            all += 1;
            widths += effect.difference.known_half_width().unwrap();
            errors += error * error;
        }
    }
    // Three effects each; at most a tenth may be refused, and none of a design that is not drawn.
    let least = if is_drawn { 0.9 } else { 1.0 } * 3.0 * TRIALS as f64;
    let all = f64::from(all);
    assert!(all >= least, "{design:?}: {all} effects");
    (f64::from(inside) / all, widths / all, (errors / all).sqrt())
}

const COMMON: Noise = Noise { fibre: 0.3, replicate: 1.0, slopes: 0.2 };
const ALONE: Noise = Noise { fibre: 1.0, replicate: 0.0, slopes: 0.0 };

#[test]
#[ignore = "slow: three hundred studies"]
fn stat_intervals_hold_the_truth_as_often_as_they_say() {
    let mut wrong = Vec::new();
    for (design, replicates, model, noise) in [
        ("design = 'grid'", 6, STRAIGHT, COMMON),
        ("design = 'grid'", 6, MIXED, COMMON),
        ("design = 'grid'\ncommon_phases = false", 3, MIXED, ALONE),
        ("design = 'one-at-a-time'", 6, MIXED, COMMON),
        ("design = 'latin-hypercube'\npoints = 24", 6, STRAIGHT, COMMON),
        ("design = 'latin-hypercube'\npoints = 24", 6, BENT, COMMON),
        ("design = 'latin-hypercube'\npoints = 24", 6, MIXED, COMMON),
        ("design = 'latin-hypercube'\npoints = 10", 6, MIXED, COMMON),
        ("design = 'latin-hypercube'\npoints = 24\ncommon_phases = false", 3, BENT, ALONE),
        ("design = 'latin-hypercube'\npoints = 40", 1, BENT, ALONE),
    ] {
        let (share, width, scatter) = coverage(design, replicates, model, noise);
        let line = format!(
            "{design:?} {replicates} replicates: {share:.3} within ± {width:.3}, scatter {scatter:.3}"
        );
        println!("{line}");
        // Four standard errors of 900 intervals, √(0.95 × 0.05/900) each.
        if !(0.92..=0.98).contains(&share) {
            wrong.push(line);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn analytic_effects_of_a_straight_line() {
    for (design, explained) in [
        ("design = 'grid'", 1.0),
        ("design = 'one-at-a-time'", 1.0),
        ("design = 'latin-hypercube'\npoints = 20", 1.0),
    ] {
        let study = three_keys(design, 6, 1);
        let none = Noise { fibre: 0.0, replicate: 0.0, slopes: 0.0 };
        let mut journal = simulated(&study, 6, STRAIGHT, none, 1);
        let rankings = rankings(&study, &mut journal).unwrap();
        assert_eq!((rankings.of_measures.len(), rankings.refusal), (MEASURES.len(), None));
        let ranking = &rankings.of_measures[0];
        let order: Vec<usize> = ranking.effects.iter().map(|effect| effect.of.factor).collect();
        assert_eq!(order, [0, 1, 2], "{design}");
        for (effect, expected) in ranking.effects.iter().zip([6.0, -2.0, 0.0]) {
            assert!((effect.difference.value - expected).abs() < 1e-12, "{design}: {effect:?}");
            assert!(effect.difference.known_half_width().unwrap() < 1e-12, "{design}: {effect:?}");
        }
        assert!((ranking.explained.unwrap() - explained).abs() < 1e-12, "{design}: {ranking:?}");
        // Without the other factors, each point lies on the line of its own.
        if !design.contains("one") {
            assert!((ranking.middle.unwrap() - 5.0).abs() < 1e-12);
            for (index, point) in study.points.iter().enumerate() {
                let x = study.factors[1].place(point.values[1]);
                let y = STRAIGHT(&[study.factors[0].place(point.values[0]), x]);
                assert!((ranking.adjusted(&study, index, 1, y) - (5.0 - x)).abs() < 1e-12);
            }
        }
    }
}

fn refusal(text: &str) -> String {
    let study = study(&format!("case = 'case.toml'\nreplicates = 3\n{text}\n"));
    let mut journal = simulated(&study, 3, |x| x[0], ALONE, 1);
    let rankings = rankings(&study, &mut journal).unwrap();
    assert_eq!(rankings.of_measures, []);
    rankings.refusal.unwrap().to_string()
}

#[test]
fn saturated_and_collinear_designs_are_refused_with_the_reason() {
    let three = "design = 'latin-hypercube'\npoints = 3\n[vary]\nair.velocity = { from = '5 m/s', to = '15 m/s' }\n\
                 air.turbulence_intensity = { from = 0.05, to = 0.25 }";
    let said = refusal(three);
    assert!(said.contains("3 points cannot rank 2 keys") && said.contains("at least 4 points"), "{said}");
    let paired = "design = 'paired'\n[vary]\nair.velocity = ['5 m/s', '10 m/s', '15 m/s', '20 m/s']\n";
    let said = refusal(&format!("{paired}air.turbulence_intensity = [0.1, 0.2, 0.3, 0.4]"));
    assert!(
        said.contains("air.velocity and air.turbulence_intensity vary together (correlation 1.00)"),
        "{said}"
    );
    // Almost together is refused as well.
    let said = refusal(&format!("{paired}air.turbulence_intensity = [0.1, 0.2, 0.3, 0.41]"));
    assert!(said.contains("vary together"), "{said}");
    let said = refusal(&format!("{paired}air.turbulence_intensity = [0.1, 0.1, 0.1, 0.1]"));
    assert!(said.contains("air.turbulence_intensity has the same value at all points"), "{said}");
    let third = "fibre.diameter = ['20 µm', '60 µm', '30 µm', '70 µm']\n\
        fibre.length = ['1.1 m', '2.1 m', '2 m', '3 m']";
    let said = refusal(&format!("{paired}{third}"));
    assert!(said.contains("cannot"), "{said}");
}

#[test]
fn the_differences_of_a_smallest_design_are_ranked_without_a_share() {
    // One other value for each key: the effects are differences from the base case.
    let study = study(
        "case = 'case.toml'\ndesign = 'one-at-a-time'\nreplicates = 4\n[vary]\nair.velocity = ['15 m/s']\n\
         air.turbulence_intensity = [0.25]\n",
    );
    assert_eq!(study.points.len(), 3);
    let mut journal = simulated(&study, 4, |_| 0.0, Noise { fibre: 0.1, ..COMMON }, 3);
    let rankings = rankings(&study, &mut journal).unwrap();
    let ranking = &rankings.of_measures[0];
    assert_eq!(ranking.explained, None);
    let mean = |point: usize, journal: &mut Journal| {
        let values = journal.records(point, 9).unwrap();
        values.iter().map(|record| record.outcome.measured().unwrap()[0]).sum::<f64>() / 4.0
    };
    let wanted = mean(1, &mut journal) - mean(0, &mut journal);
    let effect = ranking.effects.iter().find(|effect| effect.of.factor == 0).unwrap();
    assert!((effect.difference.value - wanted).abs() < 1e-12);
    assert_eq!((effect.of.from, effect.of.to), (10.0, 15.0));
}

/// Means of three words and the slope over the velocity, and the true effects: of the second and the third word against
/// the first, and of the velocity.
const WORDS: ([f64; 3], f64, [f64; 3]) = ([5.0, 7.0, 4.0], 3.0, [2.0, -1.0, 6.0]);

fn words(design: &str, replicates: u64, seed: u64) -> Study {
    let range = if design.contains("points") { "" } else { ", steps = 3" };
    study(&format!(
        "case = 'case.toml'\n{design}\nreplicates = {replicates}\nseed = {seed}\n[vary]\n\
         'drag.along' = ['matsui', 'sakiadis', 'glauert-lighthill']\n\
         'air.velocity' = {{ from = '5 m/s', to = '15 m/s'{range} }}\n"
    ))
}

/// The effects, in the order of [`WORDS`], with their intervals, and the adjusted share that is explained.
fn effects_of_words(
    design: &str,
    replicates: u64,
    noise: Noise,
    seed: u64,
) -> (Vec<(f64, Option<f64>)>, f64) {
    let mut study = words(design, replicates, seed);
    study.quantities.truncate(1);
    let [matsui, sakiadis, glauert] = ["matsui", "sakiadis", "glauert-lighthill"]
        .map(|word| study.factors[0].key.words().iter().position(|one| *one == word).unwrap() as f64);
    let mut normal = Normal(ChaCha8Rng::seed_from_u64(seed));
    let common: Vec<f64> = (0..replicates).map(|_| normal.next()).collect();
    let mut journal = Journal::in_memory();
    for (index, point) in study.points.iter().enumerate() {
        let word = [matsui, sakiadis, glauert].iter().position(|word| *word == point.values[0]).unwrap();
        let y = WORDS.0[word] + WORDS.1 * study.factors[1].place(point.values[1]);
        for (replicate, all) in (0..).zip(&common) {
            let y = y + noise.fibre * normal.next() + noise.replicate * all;
            let outcome = ReplicateOutcome::Measured(vec![y; study.quantities.len()].into());
            journal.add(&[Record { point: index as u64, replicate, outcome }]).unwrap();
        }
    }
    let rankings = rankings(&study, &mut journal).unwrap();
    let ranking = &rankings.of_measures[0];
    assert_eq!(ranking.effects.len(), 3, "{design}");
    let of = |from: f64, to: f64| {
        let effect =
            ranking.effects.iter().find(|effect| (effect.of.from, effect.of.to) == (from, to)).unwrap();
        (effect.difference.value, effect.difference.known_half_width())
    };
    (vec![of(matsui, sakiadis), of(matsui, glauert), of(5.0, 15.0)], ranking.explained.unwrap())
}

#[test]
fn analytic_effects_of_words_are_differences_from_the_first() {
    let none = Noise { fibre: 0.0, replicate: 0.0, slopes: 0.0 };
    for design in ["design = 'grid'", "design = 'one-at-a-time'", "design = 'latin-hypercube'\npoints = 20"] {
        let (effects, explained) = effects_of_words(design, 4, none, 1);
        for ((change, half), wanted) in effects.iter().zip(WORDS.2) {
            assert!((change - wanted).abs() < 1e-9 && half.unwrap() < 1e-9, "{design}: {change} {half:?}");
        }
        assert!((explained - 1.0).abs() < 1e-9, "{design}: {explained}");
    }
}

#[test]
#[ignore = "slow: three hundred studies"]
fn stat_intervals_of_words_hold_the_truth_as_often_as_they_say() {
    let mut wrong = Vec::new();
    for (design, replicates, noise) in [
        ("design = 'grid'", 6, COMMON),
        ("design = 'grid'\ncommon_phases = false", 6, ALONE),
        ("design = 'one-at-a-time'", 6, COMMON),
        ("design = 'one-at-a-time'\ncommon_phases = false", 6, ALONE),
        ("design = 'latin-hypercube'\npoints = 24", 6, COMMON),
        ("design = 'latin-hypercube'\npoints = 40", 1, ALONE),
    ] {
        let (mut inside, mut all) = (0, 0.0);
        for trial in 0..300 {
            let (effects, _) = effects_of_words(design, replicates, noise, trial);
            for ((change, half), wanted) in effects.iter().zip(WORDS.2) {
                inside += u32::from((change - wanted).abs() <= half.unwrap());
                all += 1.0;
            }
        }
        let share = f64::from(inside) / all;
        println!("{design:?} {replicates} replicates: {share:.3}");
        if !(0.92..=0.98).contains(&share) {
            wrong.push(format!("{design:?} {replicates} replicates: {share:.3}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn words_that_vary_with_another_key_are_refused_with_the_reason() {
    let paired = "design = 'paired'\n[vary]\ndrag.along = ['matsui', 'matsui', 'sakiadis', 'sakiadis']\n";
    let said = refusal(&format!(
        "{paired}drag.across = ['ju-shambaugh', 'ju-shambaugh', 'marheineke-wegener', 'marheineke-wegener']"
    ));
    assert!(said.contains("drag.along and drag.across vary together"), "{said}");
}

/// Verdicts on claims about a result that follows a model of velocity, diameter and intensity, with noise that
/// all points share and a little of their own.
fn verdicts(model: Model, own: f64, claims: &[&str]) -> Vec<Verdict> {
    let text: Vec<String> =
        (0..).zip(claims).map(|(i, claim)| format!("'{i}' = 'amplitude_y: {claim}'\n")).collect();
    let text = format!(
        "case = 'case.toml'\ndesign = 'one-at-a-time'\nreplicates = 20\n[vary]\n\
         'air.velocity' = {{ from = '5 m/s', to = '15 m/s', steps = 5 }}\n\
         'fibre.diameter' = {{ from = '25 µm', to = '100 µm', spacing = 'log', steps = 5 }}\n\
         'air.turbulence_intensity' = {{ from = 0.05, to = 0.25, steps = 5 }}\n[claims]\n{}",
        text.concat()
    );
    let study = study(&text);
    assert_eq!(study.claims.len(), claims.len());
    let noise = Noise { fibre: own, replicate: 5.0, slopes: 0.0 };
    let mut journal = simulated(&study, 20, model, noise, 7);
    let results: Vec<PointResults> =
        (0..study.points.len()).map(|point| results_of_point(&study, &mut journal, point).unwrap()).collect();
    let rankings = rankings(&study, &mut journal).unwrap().of_measures;
    let judged = judge(&study, &results, &rankings, &mut journal).unwrap();
    judged.iter().map(|claim| claim.verdict).collect()
}

/// Noise that all points share is many times larger than the steps, and does not hide them.
#[test]
fn analytic_verdicts_on_claims_about_known_results() {
    const OF_EFFECTS: [&str; 4] = [
        "air.velocity > fibre.diameter",
        "air.velocity > 2.5 * fibre.diameter",
        "air.velocity > 3.5 * fibre.diameter",
        "fibre.diameter > air.turbulence_intensity",
    ];
    assert_eq!(verdicts(STRAIGHT, 0.05, &OF_EFFECTS), [Holds, Holds, Fails, Holds]);
    assert_eq!(verdicts(STRAIGHT, 50.0, &OF_EFFECTS)[1], Open);
    const OF_WAYS: [&str; 4] =
        ["air.velocity rises", "fibre.diameter falls", "fibre.diameter rises", "air.velocity turns"];
    assert_eq!(verdicts(STRAIGHT, 0.05, &OF_WAYS), [Holds, Holds, Fails, Fails]);
    // 3 x + 2 x² has its least value at −3/4, between the first two points; −x − 3 x² its greatest at −1/6.
    assert_eq!(
        verdicts(
            |x| 3.0 * x[0] + 6.0 * x[0] * x[0] - x[1] - 3.0 * x[1] * x[1],
            0.05,
            &[
                "air.velocity turns",
                "fibre.diameter turns",
                "fibre.diameter falls",
                "air.turbulence_intensity turns",
            ]
        ),
        [Holds, Holds, Fails, Open]
    );
    assert_eq!(verdicts(STRAIGHT, 50.0, &["fibre.diameter falls"]), [Open]);
}

/// In air without turbulence a single fibre has no error, and neither has the difference of two.
#[test]
fn analytic_what_has_no_error_is_judged_by_its_values() {
    let judged = |intensity: &str, model: Model, claim: &str| {
        let case = short::SHORT.replace("turbulence_intensity = 0.1\n", intensity);
        let text = format!(
            "case = 'case.toml'\ndesign = 'grid'\nreplicates = 1\n[vary]\n\
             'air.velocity' = {{ from = '5 m/s', to = '15 m/s', steps = 5 }}\n[claims]\n\
             'It is so.' = 'amplitude_y: air.velocity {claim}'\n"
        );
        let study = short::study(&case, &text).study;
        let mut journal = simulated(&study, 1, model, Noise { fibre: 0.0, replicate: 0.0, slopes: 0.0 }, 7);
        let results: Vec<PointResults> = (0..study.points.len())
            .map(|point| results_of_point(&study, &mut journal, point).unwrap())
            .collect();
        let rankings = rankings(&study, &mut journal).unwrap().of_measures;
        let judged = judge(&study, &results, &rankings, &mut journal).unwrap().remove(0);
        assert!(!judged.evidence.contains("NaN"), "{}", judged.evidence);
        judged.verdict
    };
    const STILL: &str = "turbulence_intensity = 0\n";
    let known: [(Model, &str, Verdict); 6] = [
        (STRAIGHT_UP, "rises", Holds),
        (STRAIGHT_UP, "falls", Fails),
        (STRAIGHT_UP, "turns", Fails),
        (|x| 1.0 - x[0] * x[0], "rises", Fails),
        (|x| 1.0 - x[0] * x[0], "turns", Holds),
        (|_| 1.0, "rises", Fails),
    ];
    for (model, claim, verdict) in known {
        assert_eq!(judged(STILL, model, claim), verdict, "{claim}");
    }
    // A single fibre in turbulence reports nothing of its error.
    assert_eq!(judged("turbulence_intensity = 0.1\n", STRAIGHT_UP, "rises"), Open);
}

#[test]
fn rejects_claims_that_cannot_be_judged() {
    let refused = |claim: &str| {
        let text = format!(
            "case = 'case.toml'\ndesign = 'grid'\nreplicates = 2\n[vary]\n'air.velocity' = ['5 m/s', '6 m/s']\n\
             [claims]\n'It grows.' = '{claim}'\n"
        );
        let base = |_: &str, _| Ok((short::SHORT.to_owned(), "case.toml".to_owned()));
        spunlaid_input::parse_study(&text, "study.toml", None, base).unwrap_err().to_string()
    };
    for (claim, said) in [
        ("grows", "names no result"),
        ("amplitud_y: air.velocity rises", "did you mean amplitude_y"),
        (
            "amplitude_y: air.velocity grows",
            "contains nothing that can be judged; write `RESULT: KEY > 5 * OTHER KEY`",
        ),
        (
            "amplitude_y: fibre.diameter rises",
            "names a key that does not vary here; the keys are air.velocity",
        ),
        ("amplitude_y: air.velocity > x * air.velocity", "has no number above zero before `*`"),
    ] {
        let message = refused(claim);
        assert!(message.contains(said) && message.contains("It grows."), "{message}");
    }
}
