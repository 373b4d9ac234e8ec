//! Findings of which every number follows by hand.

use super::*;
use crate::map::laid_web::ChargedCurtain;
use crate::map::{Defect, Edges, Fibres, Filaments, Row, Sheet};
use rand_xoshiro::SplitMix64;
use rand_xoshiro::rand_core::{Rng, SeedableRng};
use spunlaid_ground::Isa;
use std::sync::atomic::AtomicBool;

const PATCH: f64 = 10e-3;

fn close(found: f64, expected: f64) {
    assert!((found - expected).abs() <= 1e-12 * expected.abs().max(1e-9), "{found} {expected}");
}

fn layer(linear_density: f64) -> Layer {
    Layer {
        linear_density,
        feed_speed: 50.0,
        belt_speed: 5.0,
        filaments: Filaments::Slot { per_metre: 1000.0, depth: 5e-3 },
        defects: Vec::new(),
        fibres: Fibres::Surrogate(Surrogate { sigma_md: 9e-3, sigma_cd: 8e-3, noise: 15.0 }),
    }
}

/// Two layers of 100 filaments, of three quarters and one quarter of its mass.
fn web() -> Web {
    Web { sheet: Sheet::new(0.1, 0.2, 1e-3), layers: vec![layer(3e-7), layer(1e-7)], seed: 1 }
}

fn patch(cv: f64, standard_error: Option<f64>) -> PatchCv {
    PatchCv { patch: PATCH, cv, standard_error }
}

/// Numbers of a sample that are all different: every number of the second one is another multiple of the first.
fn sample(k: f64) -> SubsampleCv {
    SubsampleCv {
        patch: PATCH,
        cv: 0.2 * k,
        by_chance: Some(0.02 * k * k),
        by_pitch: 0.01 * k,
        of_halves: 0.04 / k,
        by_missing: 0.0,
        own: 0.004 * k,
        few: 0.22 * k,
        beyond_filling: 0.001 * k,
        beyond_sheet: 0.002 / k,
    }
}

/// Of 5 mm only the patches of 10 and 20 mm consist of whole ones, and the CV with the larger error gives way, if it is
/// of a sample.
#[test]
fn a_sample_has_no_smaller_cv_over_smaller_patches() {
    let of = |side: f64, cv: f64, by_pitch: f64, few: bool| PatchFindings {
        map: PatchCv { patch: side, cv, standard_error: Some(0.02) },
        few: few.then(|| SubsampleCv { patch: side, cv, by_pitch, ..sample(1.0) }),
        single_fibres: None,
        straight_fibres: 0.1,
        evidence: Evidence::FewInOneAir,
        warning: None,
        of_map: cv,
    };
    for (by_pitch, few, expected) in [
        (0.01, true, [0.4, 0.3, 0.3, 0.1]),
        (0.03, true, [0.4, 0.2, 0.2, 0.1]),
        (0.01, false, [0.4, 0.2, 0.3, 0.1]),
    ] {
        let mut patches = [
            of(0.012, 0.4, 0.01, few),
            of(0.005, 0.2, 0.02, few),
            of(0.01, 0.3, by_pitch, few),
            of(0.02, 0.1, 0.01, few),
        ];
        put_in_order(&mut patches);
        patches.iter().zip(expected).for_each(|(found, wanted)| close(found.map.cv, wanted));
        // The error of the square stays where it is raised, and that of a CV where it is lowered.
        if let Some(lowered) = patches[2].few {
            close(lowered.by_pitch, by_pitch);
        }
        if let Some(raised) = patches[1].few {
            close(raised.by_pitch, 0.02 * 0.2 / expected[1]);
            close(raised.by_chance.unwrap_or(0.0), 0.02 * 0.2 / expected[1]);
        }
    }
}

/// Where no error is known, the smaller patches give way.
#[test]
fn a_sample_without_errors_has_no_smaller_cv_over_smaller_patches() {
    let of = |side: f64, cv: f64| PatchFindings {
        map: PatchCv { patch: side, cv, standard_error: None },
        few: Some(SubsampleCv { patch: side, cv, by_chance: None, ..sample(1.0) }),
        single_fibres: None,
        straight_fibres: 0.1,
        evidence: Evidence::FewInOneAir,
        warning: None,
        of_map: cv,
    };
    let mut patches = [of(0.012, 0.4), of(0.005, 0.2), of(0.01, 0.3), of(0.02, 0.1)];
    put_in_order(&mut patches);
    patches.iter().zip([0.4, 0.3, 0.3, 0.1]).for_each(|(found, wanted)| close(found.map.cv, wanted));
}

/// * `cvs` – of the only sample
fn estimate(cv: SubsampleCv, sheet: [f64; 2]) -> SubsampleEstimate {
    SubsampleEstimate { sheet, area: sheet[0] * sheet[1], cvs: vec![cv], ..SubsampleEstimate::default() }
}

fn simulated(few: Option<SubsampleEstimate>) -> LayerFlown {
    LayerFlown { few, ..LayerFlown::default() }
}

fn laid(simulated: Vec<LayerFlown>) -> LaidWeb {
    let map = Map {
        columns: 100,
        rows: 200,
        cell: 1e-3,
        quantum: 1e-9,
        closed: [true, false],
        cells: vec![7; 20_000],
    };
    LaidWeb { map, cut: 0.0, simulated }
}

/// What is reported of a patch, by what is known of it.
#[test]
fn analytic_the_error_of_a_cv_has_the_causes_of_its_evidence() {
    let of =
        |evidence: Evidence, few: Option<SubsampleCv>, warning: Option<SubsampleWarning>| PatchFindings {
            map: patch(0.2, Some(0.03)),
            single_fibres: Some((0.15, Some(0.01))),
            straight_fibres: 0.1,
            evidence,
            few,
            warning,
            of_map: 0.2,
        };
    let few = |cv: f64| SubsampleCv { by_pitch: 0.04, ..SubsampleCv { cv, ..sample(1.0) } };
    let own = Some(SubsampleWarning::Own(PATCH));
    let known = of(Evidence::Known, None, None);
    let all = of(Evidence::AllInOneAir, None, None);
    let some = of(Evidence::FewInOneAir, Some(few(0.25)), None);
    let unknown = of(Evidence::FewInOneAir, Some(few(0.25)), own);
    let chance = Some(0.03);
    for (found, flight, whole, reported, independent, interval) in [
        (known, None, None, chance, None, known.map.interval()),
        (all, Some(0.0), chance, chance, Some(0.15), all.map.interval_of_few()),
        (some, Some(0.04), Some(0.05), Some(0.05), Some(0.15), patch(0.2, Some(0.05)).interval_of_few()),
        (unknown, None, None, None, Some(0.15), None),
    ] {
        assert_eq!(found.total_error(), ErrorBudget { chance, flight });
        assert_eq!(found.total_error().whole(), whole);
        assert_eq!(found.with_total_error().and_then(|cv| cv.standard_error), reported);
        assert_eq!(found.independent(), independent);
        assert_eq!(found.interval(), interval);
        assert_eq!(found.reported().is_some(), found != unknown);
    }
    assert_eq!([known, all, unknown].map(|found| found.off_of_map()), [Some(0.0), Some(0.0), None]);
    close(some.off_of_map().unwrap_or(0.0), 0.25_f64.hypot(0.16));
    let lower = of(Evidence::FewInOneAir, Some(few(0.16)), None);
    close(lower.off_of_map().unwrap_or(0.0), -0.2_f64.hypot(0.25));
}

/// Layers of three quarters and one quarter of the mass add up their variances..
#[test]
fn analytic_what_samples_of_layers_say_together() {
    let (web, map) = (web(), patch(0.3, Some(0.05)));
    let [one, two] = [sample(1.0), sample(2.0)];
    let (a, b) = (0.5625, 0.0625);
    let of = |layers: &[Option<SubsampleEstimate>]| {
        of_all_layers(&web, &laid(layers.iter().cloned().map(simulated).collect()), map)
    };
    let [piece, whole] = [[0.1, 0.1], [0.1, 0.2]].map(|sheet| [one, two].map(|cv| Some(estimate(cv, sheet))));
    let square: f64 = a * 0.04 + b * 0.16;
    let cv = square.sqrt();
    let by_pitch = (a * 0.2 * 0.01_f64).hypot(b * 0.4 * 0.02) / cv;
    let (filling, beyond) = (a * 0.001 + b * 0.002, a * 0.002 + b * 0.001);
    let check = |found: Option<SubsampleCv>, cv: f64, by_chance: f64, by_pitch: f64| {
        let found = found.unwrap_or(SubsampleCv::UNKNOWN);
        close(found.cv, cv);
        close(found.by_chance.unwrap_or(f64::NAN), by_chance);
        close(found.by_pitch, by_pitch);
        close(found.of_halves, (a * 0.04 * 0.04 + b * 0.16 * 0.02) / square);
        close(found.own, a * 0.004 + b * 0.008);
        close(found.few, (a * 0.0484 + b * 0.1936_f64).sqrt());
        close(found.beyond_filling, filling);
        close(found.beyond_sheet, beyond);
        close(found.patch, PATCH);
    };
    // On pieces their sampling errors add up; on sheets in other airs, the squares of these.
    let (first, second) = (a * 0.2 * 0.02, b * 0.4 * 0.08);
    check(of(&piece), cv, (first + second) / cv, by_pitch);
    let levels = |few: &Option<SubsampleEstimate>| {
        few.clone().map(|few| SubsampleEstimate { area: 2.0 * few.area, ..few })
    };
    check(of(&piece.each_ref().map(levels)), cv, first.hypot(second) / cv, by_pitch);
    // A map of the whole sheet has what its positions do, and lacks what is filled in.
    let of_whole = (0.09 + filling + beyond).sqrt();
    check(of(&whole), of_whole, 0.3 * 0.05 / of_whole, by_pitch * cv / of_whole);
    check(
        of(&whole.each_ref().map(levels)),
        of_whole,
        first.hypot(second) / of_whole,
        by_pitch * cv / of_whole,
    );
    // Of a layer of which all were simulated all is on the map of the whole sheet, and on pieces nothing is known.
    let alone = of(&[None, whole[1].clone()]).unwrap_or(SubsampleCv::UNKNOWN);
    close(alone.cv, (0.09 + b * 0.002 + b * 0.001_f64).sqrt());
    close(alone.own, b * 0.008);
    assert_eq!(of(&[None, piece[1].clone()]), None);
    assert_eq!(of(&[None, None]), None);
    let other = SubsampleCv { patch: 0.02, ..one };
    assert_eq!(of(&[Some(estimate(other, [0.1, 0.2])), whole[1].clone()]), None);
}

/// * `patches` – the CV of each and that of the map
fn findings(laid: LaidWeb, patches: Vec<PatchFindings>) -> Findings {
    Findings {
        laid,
        margins: [0.0; 2],
        reach: [0.0, 0.1],
        error_of_weight: None,
        patches,
        orientation: Orientation {
            cos_squared: Estimate::default(),
            directions: [0.0; Orientation::DIRECTIONS],
            stiffness_ratio: (1.0, None),
            piece: 1e-3,
        },
        clouds: None,
        autocorrelation: [Vec::new(), Vec::new()],
        fibre_length: 1.0,
        surrogate: None,
    }
}

/// * `of_map` – CV of the map, whose web has 0.2
fn found(evidence: Evidence, of_map: f64, few: Option<SubsampleCv>) -> PatchFindings {
    let map = patch(0.2, Some(0.01));
    PatchFindings { map, single_fibres: None, straight_fibres: 0.1, evidence, few, warning: None, of_map }
}

#[test]
fn findings_are_warned_of_with_their_numbers() {
    let web = web();
    let known = |laid: LaidWeb, margins: [f64; 2], map: PatchCv| {
        let patches = vec![PatchFindings { map, ..found(Evidence::Known, 0.2, None) }];
        Findings { margins, ..findings(laid, patches) }.warnings(&web)
    };
    let whole = || laid(Vec::new());
    assert_eq!(findings(whole(), Vec::new()).warnings(&web), []);
    assert_eq!(known(whole(), [0.0; 2], patch(0.2, Some(0.01))), [WebWarning::NothingFlown]);
    // 140,000 quanta of 1 µg are on the sheet, and 35 mg lie beyond it: a fifth of all.
    let cut = LaidWeb { cut: 35e-6, ..whole() };
    let said = known(cut, [0.0, 3e-3], patch(0.2, None));
    let [WebWarning::NothingFlown, WebWarning::CutOff { share }, edges, no_error] = &said[..] else {
        panic!("{said:?}")
    };
    close(*share, 0.2);
    assert_eq!(*edges, WebWarning::ThinEdges { margins: [0.0, 3e-3] });
    assert_eq!(*no_error, WebWarning::NoError { sides: vec![PATCH] });
    // Of 100 filaments of a layer two were lost; of the sample of the other 12 + 3 and on other sheets 40 + 5.
    let few = SubsampleEstimate {
        filaments: 12,
        lost: 3,
        on_other_sheets: 40,
        lost_on_other_sheets: 5,
        ..estimate(sample(1.0), [0.1, 0.2])
    };
    let of_all = LayerFlown { lost: 2, ..LayerFlown::default() };
    let of_few = LayerFlown { lost: 3, ..simulated(Some(few.clone())) };
    assert_eq!(lost(&web, &laid(vec![of_all, of_few])), [WebWarning::Lost { filaments: 10, of: 160 }]);
    assert_eq!(lost(&web, &laid(vec![simulated(None), simulated(None)])), []);
    // A sampling error of 0.016 and one of 0.012 by the pitch are a tenth of the CV.
    let reached = SubsampleCv { by_chance: Some(0.016), by_pitch: 0.012, ..sample(1.0) };
    let wanted = |wanted: f64| {
        let few = SubsampleEstimate { wanted: Some(wanted), ..estimate(reached, [0.1, 0.2]) };
        unsure(&laid(vec![simulated(Some(few))]))
    };
    let said = wanted(0.05);
    let [WebWarning::Unsure { wanted: 0.05, reached, by_sample, area }] = &said[..] else {
        panic!("{said:?}")
    };
    close(*reached, 0.1);
    close(*by_sample, 0.06);
    assert!(said[0].to_string().ends_with("which needs more filaments per metre (web.simulated)"));
    // 0.0064 by the area, which may have 0.0081 − 0.0036.
    let of_area = wanted(0.09)[0].to_string();
    assert!(of_area.contains("which needs about 1.4 times the area; raise web.time"), "{of_area}");
    // Less than half of 0.0064 is left for the area, which would be 2.3 times as large.
    assert!(wanted(0.08)[0].to_string().ends_with("(web.simulated)"));
    close(*area, 0.02);
    assert_eq!((wanted(0.1), wanted(0.2)), (Vec::new(), Vec::new()));
    let field = |edge_field: f64| {
        let charged = Some(ChargedCurtain { edge_field, heights: Vec::new() });
        charged_layers(&laid(vec![LayerFlown { charged, ..LayerFlown::default() }, LayerFlown::default()]))
    };
    assert_eq!(field(2.0 * STRONG), [WebWarning::StrongField { field: 2.0 * STRONG }]);
    assert_eq!(field(STRONG), []);
}

fn charged_layers(laid: &LaidWeb) -> Vec<WebWarning> {
    charged(laid)
}

/// Warnings of a map in which filaments are filled in: on a whole sheet, and on pieces of another one.
#[test]
fn a_map_that_is_not_as_even_as_its_web_is_warned_of() {
    let web = web();
    let warnings = |missing: f64, of_map: &[f64], sheet: [f64; 2], few: Option<SubsampleCv>| {
        let estimate =
            SubsampleEstimate { missing: [0.5 * missing, missing], ..estimate(sample(1.0), sheet) };
        let patches = of_map.iter().map(|of_map| found(Evidence::FewInOneAir, *of_map, few)).collect();
        few_filaments(&web, &findings(laid(vec![simulated(Some(estimate))]), patches))
    };
    let (few, whole, piece) = (Some(sample(1.0)), [0.1, 0.2], [0.1, 0.1]);
    assert_eq!(warnings(0.1, &[0.209, 0.191], whole, few), []);
    let said = warnings(0.1, &[0.2, 0.22, 0.17], whole, few);
    let [WebWarning::FilledIn { missing: 0.1, sides, apart }] = &said[..] else { panic!("{said:?}") };
    assert_eq!(*sides, [PATCH; 2]);
    close(*apart, -0.15);
    let filled_in = WebWarning::FilledIn { missing: 0.2, sides: Vec::new(), apart: 0.0 };
    assert_eq!(warnings(0.2, &[0.2], whole, few), std::slice::from_ref(&filled_in));
    // Pieces make clouds of their own, which are no matter of the filling.
    let said = warnings(0.2, &[0.24], piece, few);
    let [WebWarning::Pieces { sides, apart }, other] = &said[..] else { panic!("{said:?}") };
    assert_eq!((sides, other), (&vec![PATCH], &filled_in));
    close(*apart, 0.2);
    assert_eq!(warnings(0.1, &[0.2], piece, few), []);
    assert_eq!(warnings(0.1, &[0.2], piece, None), [WebWarning::SmallSheet { sides: vec![PATCH] }]);
    // Neighbours with little in common: the strongest reason, over all patches.
    let few = SubsampleEstimate {
        correlation: Some(0.6),
        pitch: 0.002,
        usual_pitch: 0.002,
        pitch_of_all: 1.0 / 6000.0,
        ..estimate(sample(1.0), whole)
    };
    let said = few_filaments(&web, &findings(laid(vec![simulated(Some(few))]), Vec::new()));
    let why = SubsampleWarning::Neighbours(0.6);
    assert_eq!(said, [WebWarning::Subsample { sides: vec![PATCH], why, pitch: 0.002, enough: Some(1000.0) }]);
}

fn find_of(web: &Web, laid: Option<LaidWeb>) -> Findings {
    let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &done };
    find_laid(web, laid, by).unwrap_or_else(|error| panic!("{error:?}"))
}

/// A row from 30 to 70 mm of a cut sheet reaches 3 σ = 15 mm farther, and as far inwards it is thin.
#[test]
fn analytic_a_web_within_its_edges() {
    let mut web = web();
    let surrogate = Surrogate { sigma_md: 9e-3, sigma_cd: 5e-3, noise: 15.0 };
    let row = Row::new(30.2e-3, 0.2e-3, 200);
    web.layers = vec![Layer {
        filaments: Filaments::Rows(vec![row]),
        fibres: Fibres::Surrogate(surrogate),
        defects: vec![Defect { share: 0.2, titre: 0.25, ..Defect::USUAL }],
        ..layer(3e-7)
    }];
    (web.sheet.edges, web.sheet.patches) = (Edges::Cut, vec![2e-3, 4e-3, 6e-3]);
    // 1, 2, 3 … mg in the columns.
    let cells = (0..20_000).map(|i| 1 + i % 100).collect();
    let closed = [false, true];
    let laid = LaidWeb { map: Map { closed, cells, ..laid(Vec::new()).map }, ..laid(Vec::new()) };
    let found = find_of(&web, Some(laid.clone()));
    // From 45.2 to 55 mm: columns 46 to 54.
    close(found.margins[0], 46e-3);
    close(found.margins[1], 45e-3);
    close(found.reach[0], 15.2e-3);
    close(found.reach[1], 85e-3);
    let within = found.within();
    assert_eq!((within.columns, within.row(0)), (9, &(47..56).collect::<Vec<u32>>()[..]));
    // Two patches of 4 mm fit beside each other, and not of 6 mm.
    assert_eq!(found.patches.iter().map(|of| of.map.patch).collect::<Vec<_>>(), [2e-3, 4e-3]);
    assert_eq!(found.seen().map(|of| of.map.patch), Some(4e-3));
    assert_eq!(found.autocorrelation.each_ref().map(Vec::len), [9, 101]);
    // 51 quanta of 1 µg on a square millimetre, with what crosses the edges and the holes that have a defect.
    let (weight, error) = found.basis_weight();
    close(weight, 51e-3);
    let crossed = {
        let mut up_to = 0.0;
        let all: Vec<f64> = (47..56)
            .map(|of| {
                up_to += (f64::from(of) / 51.0 - 1.0) / 9.0;
                up_to
            })
            .collect();
        2.0 * (all.iter().map(|x| x * x).sum::<f64>() / 9.0 - (all.iter().sum::<f64>() / 9.0).powi(2))
    };
    let by_defects = 200.0 * 0.2 * 0.8 * (0.75_f64 / 200.0 / 0.85).powi(2);
    close(error.unwrap_or(0.0), 51e-3 * (crossed + by_defects).sqrt());
    close(found.fibre_length, 200.0 * 2.0);
    // Of filaments at random positions the number varies on the 70 mm between the edges, and not on the sheet.
    let mut at_random = web.clone();
    at_random.layers[0].filaments = Filaments::AtRandom { per_metre: 1000.0 };
    at_random.layers[0].defects.clear();
    let uniform = LaidWeb { map: Map { cells: vec![9; 20_000], ..laid.map.clone() }, ..laid.clone() };
    let found = find_of(&at_random, Some(uniform));
    close(found.margins[0], 15e-3);
    close(found.error_of_weight.unwrap_or(0.0), (0.3 / 70.0_f64).sqrt());
    // Layers of 10 km of fibre on a square metre, by the squares of their fractions of the mass.
    let by_hand = ((0.5625 + 0.0625) * 0.946_41 / (1e4 * PATCH)).sqrt();
    assert!((straight(&self::web(), PATCH) / by_hand - 1.0).abs() < 1e-5);
    // A web on which no patches fit is refused.
    web.sheet.patches = vec![6e-3];
    let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &done };
    let Err(error) = find_laid(&web, Some(laid), by) else { panic!("patches that do not fit") };
    let said = format!("{error:?}");
    assert!(said.contains("take 46 mm and 45 mm of its width of 100 mm") && said.contains("6 mm"), "{said}");
}

/// The findings of a web of noise with these samples of its layers.
fn noise_with(few: Vec<Option<SubsampleEstimate>>) -> Findings {
    let mut web = web();
    web.sheet.patches = vec![PATCH];
    // Wide paths of few pieces take little time.
    let surrogate = Surrogate { sigma_md: 40e-3, sigma_cd: 8e-3, noise: 5.0 };
    web.layers.iter_mut().for_each(|layer| layer.fibres = Fibres::Surrogate(surrogate));
    let mut random = SplitMix64::seed_from_u64(3);
    let cells = (0..20_000).map(|_| 1000 + (random.next_u64() >> 54) as u32).collect();
    let all = laid(few.into_iter().map(simulated).collect());
    find_of(&web, Some(LaidWeb { map: Map { cells, ..all.map }, ..all }))
}

/// Samples of both layers whose halves agree.
fn two(sheet: [f64; 2]) -> Vec<Option<SubsampleEstimate>> {
    let sample = |k: f64| SubsampleCv { of_halves: 0.0, ..sample(k) };
    vec![Some(estimate(sample(1.0), sheet)), Some(estimate(sample(2.0), sheet))]
}

/// A sample on the whole sheet gives the CV of its map, and one on pieces its own; where it gives none, that of the
/// map is there without an error.
#[test]
fn the_cv_of_a_sample_is_that_of_its_evidence() {
    let all = noise_with(vec![None, None]).patches[0];
    assert_eq!((all.evidence, all.few, all.of_map), (Evidence::AllInOneAir, None, all.map.cv));
    let of_pieces = noise_with(two([0.1, 0.1]));
    let pieces = of_pieces.patches[0];
    assert_eq!(pieces.evidence, Evidence::FewInOneAir);
    let few = pieces.few.unwrap_or(SubsampleCv::UNKNOWN);
    assert_eq!((pieces.map.cv, pieces.map.standard_error), (few.cv, few.by_chance));
    close(few.cv, (0.5625 * 0.04 + 0.0625 * 0.16_f64).sqrt());
    assert_eq!(pieces.of_map, all.map.cv);
    let mut doubted = two([0.1, 0.1]);
    doubted[0].iter_mut().for_each(|few| few.correlation = Some(0.1));
    let found = noise_with(doubted);
    let has_error = |found: &Findings| {
        found.clouds.as_ref().and_then(|clouds| clouds.variance(4e-3, 6e-3).standard_error).is_some()
    };
    // How far off the clouds of too small a sample are is not known.
    assert!(!has_error(&found) && has_error(&of_pieces));
    let doubted = found.patches[0];
    assert_eq!(doubted.warning, Some(SubsampleWarning::Neighbours(0.1)));
    assert_eq!((doubted.map.cv, doubted.map.standard_error), (all.map.cv, None));
}

/// The worst layer by its octaves is in the errors of the clouds.
#[test]
fn analytic_what_the_worst_filling_does_to_the_clouds() {
    let error = |octaves: [f64; 2]| {
        let mut few = two([0.1, 0.2]);
        for (few, off) in few.iter_mut().flatten().zip(octaves) {
            few.octaves = vec![([2e-3, 4e-3], 0.1 * off), ([4e-3, 25e-3], off)];
        }
        let clouds = noise_with(few).clouds;
        clouds.map(|clouds| clouds.variance(4e-3, 6e-3))
    };
    let [none, one, other] = [[0.0, 0.0], [0.5, 0.2], [0.2, 0.5]].map(error).map(Option::unwrap_or_default);
    close(one.standard_error.unwrap_or(0.0), none.standard_error.unwrap_or(0.0).hypot(0.5 * none.mean));
    assert_eq!(one.standard_error, other.standard_error);
}
