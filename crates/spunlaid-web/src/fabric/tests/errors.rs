//! Errors of the numbers of a fabric: of webs with streaks, of maps that are less uniform than their webs.

use super::*;

/// A normal field of streaks and of independent cells on a sheet that is closed to a ring, 0.5 m wide and long.
fn streaky(random: &mut Random) -> Map {
    let columns = 200;
    let sigma = 18e-3;
    let width = 0.5;
    let waves: Vec<[f64; 2]> = (1..=12)
        .map(|k| {
            let wave = 2.0 * PI * f64::from(k) / width * sigma;
            [(); 2].map(|()| 0.028 * libm::exp(-0.5 * wave * wave) * random.normal())
        })
        .collect();
    let profile: Vec<f64> = (0..columns)
        .map(|column| {
            let angle = 2.0 * PI * column as f64 / columns as f64;
            let part = |(k, [a, b]): (f64, &[f64; 2])| a * libm::cos(k * angle) + b * libm::sin(k * angle);
            1.0 + (1..).map(f64::from).zip(&waves).map(part).sum::<f64>()
        })
        .collect();
    let sheet = map([columns, 200], width / columns as f64, |i| profile[i % columns] + 0.1 * random.normal());
    Map { closed: [true; 2], ..sheet }
}

/// The fabric of a web with streaks whose map is off by this.
fn streaky_fabric(seed: u64, off: Option<f64>) -> Fabric {
    streaky_fabric_of(seed, off, |found| found)
}

/// * `reported` – the CV of the web from that of the map
fn streaky_fabric_of(seed: u64, off: Option<f64>, reported: impl Fn(PatchCv) -> PatchCv) -> Fabric {
    let sheet = streaky(&mut Random::new(seed));
    let patch = |side| {
        let found = patch_cv(&sheet, side).unwrap();
        LaidPatch { patch: found.patch, reported: off.map(|_| reported(found)), off }
    };
    let laid = Laid {
        map: &sheet,
        margins: [0.0; 2],
        reach: None,
        filaments: Vec::new(),
        orientation: None,
        patches: [1, 2, 4, 8].map(patch).to_vec(),
        streaks: true,
        error_of_weight: 0.0,
        defects: Vec::new(),
    };
    estimate(&laid, &FabricKeys { measured_opacity: Some(0.35), ..FabricKeys::USUAL }, 1)
}

/// A sheet that holds too few clouds or streaks for an error of its CV has none of its thin spots and weights either:
/// on a narrow sheet of streaks the weights scattered by eight of the errors that were reported.
#[test]
fn what_follows_from_a_cv_without_an_error_has_none() {
    let fabric = streaky_fabric_of(1, Some(0.0), |found| PatchCv { standard_error: None, ..found });
    let numbers = fabric.patches.iter().flat_map(|patch| numbers_of(FABRIC_PATCH_MEASURES, patch, ""));
    let errors = numbers.filter(|(_, number)| matches!(number, Some(Known::Value(_, Some(_)))));
    assert_eq!(errors.map(|(name, _)| name).collect::<Vec<_>>(), Vec::<String>::new());
    assert!(fabric.notes.iter().any(|note| note.contains("too few clouds or streaks")), "{:?}", fabric.notes);
}

/// Over webs with random streaks the numbers of the fabric scatter by what their errors say. As if the blocks of a
/// column were independent, quantiles of weight scattered by up to four of them, strips along CD by four, the spread of
/// the opacity by twenty.
#[test]
fn stat_the_errors_of_a_fabric_with_random_streaks() {
    const SEEDS: u64 = 60;
    let mut found: std::collections::BTreeMap<String, Vec<(f64, f64)>> = std::collections::BTreeMap::new();
    for seed in 0..SEEDS {
        let fabric = streaky_fabric(1000 + seed, Some(0.0));
        let mut numbers: Vec<(String, Option<Known>)> = numbers_of(FABRIC_MEASURES, &fabric, "");
        for patch in &fabric.patches {
            let side = format!(" of {} mm", (1e3 * patch.thin.patch).round());
            numbers.extend(numbers_of(FABRIC_PATCH_MEASURES, patch, &side));
        }
        for (strips, direction) in fabric.strips.iter().flatten().zip([" along MD", " along CD"]) {
            numbers.extend(numbers_of(STRIP_MEASURES, strips, direction));
        }
        for (name, number) in numbers {
            if let Some(Known::Value(value, Some(error))) = number {
                found.entry(name).or_default().push((value, error));
            }
        }
    }
    // Numbers of rare places are not there in each web, nor what follows from a CV without an error.
    found.retain(|_, numbers| 3 * numbers.len() as u64 >= SEEDS);
    assert!(found.len() > 25, "{:?}", found.keys());
    let mut outside = Vec::new();
    for (name, numbers) in found {
        let scatter =
            Estimate::new(numbers.iter().map(|(value, _)| *value).collect()).standard_error.unwrap();
        let count = numbers.len() as f64;
        let reported = numbers.iter().map(|(_, error)| error).sum::<f64>() / count;
        let ratio = scatter * count.sqrt() / reported;
        println!("{name}: {ratio:.2}");
        if !(0.6..1.6).contains(&ratio) {
            outside.push(format!("{name}: {ratio:.2}"));
        }
    }
    assert!(outside.is_empty(), "{outside:?}");
}

fn numbers_of<T>(measures: &'static [Measure<T>], found: &T, of: &str) -> Vec<(String, Option<Known>)> {
    let number = |measure: &Measure<T>| match measure.formula {
        Formula::Reported(number) => Some((format!("{}{of}", measure.entry()), number(found))),
        _ => None,
    };
    measures.iter().filter_map(number).collect()
}

/// Where the map is less even than the web, the difference is in the errors; where it is not known how even the web
/// is, nothing has an error, and a note says over which patches.
#[test]
fn numbers_of_a_map_that_is_not_as_even_as_the_web_say_so() {
    let numbers = |of: &Fabric| {
        let thin = &of.patches[0].thin;
        let strips = of.strips[0].clone().unwrap();
        [thin.lighter[2], thin.quantiles[0], strips.weakest, strips.sections, of.opacity.unwrap().spread]
    };
    let [same, other, unknown] = [Some(0.0), Some(-0.2), None].map(|off| streaky_fabric(3, off));
    for ((same, other), unknown) in numbers(&same).into_iter().zip(numbers(&other)).zip(numbers(&unknown)) {
        let (Known::Value(value, Some(error)), Known::Value(_, Some(whole))) = (same, other) else {
            panic!("{same:?} {other:?}")
        };
        // A fifth of a deviation, or what is beyond an edge less by what a fifth takes away.
        let part =
            if value > 1.5 { 0.2 * value } else { 0.19 * if value > 0.5 { 1.0 - value } else { value } };
        assert!(whole > error.hypot(part), "{same:?} {other:?}");
        assert_eq!(unknown, Known::Value(value, None));
    }
    let said = &unknown.notes[0];
    assert!(said.contains("5 mm, 10 mm, 20 mm") && said.contains("not known"), "{said}");
    assert!(same.notes.iter().all(|note| !note.contains("may have another one")));
}

/// What has no error of its own gets none by what a map without deviations is off.
#[test]
fn a_number_without_an_error_stays_without_one() {
    let unknown = Known::Value(2.0, None);
    assert_eq!(Deviations::add(Some(Deviations::default()), unknown, |by| by), unknown);
    let of = Some(Deviations { by_chance: 0.03, of_map: 0.04 });
    assert_eq!(Deviations::add(of, unknown, |by| 2.0 * by), Known::Value(2.0, Some(0.1)));
    // A sheet without fibre has no strips and no section that is the weakest.
    let marks = Marks::new(
        &map([40, 30], 1e-3, |_| 0.0),
        0.0,
        StripSize { width: 10e-3, length: 20e-3, section: 5e-3 },
    );
    assert_eq!(marks.strips, [vec![], vec![]]);
}

/// Squares of 2 mm that are a twentieth heavier or lighter by turns: the spread of the opacity is known as well as the
/// weight is, by the spreads at three per cent more and less.
#[test]
fn analytic_the_error_of_the_spread_of_the_opacity() {
    let is_heavy = |i: usize| (i % 200 / 2 + i / 200 / 2).is_multiple_of(2);
    let map = map([200, 200], 1e-3, |i| if is_heavy(i) { 1.05 } else { 0.95 });
    let of = |error_of_weight: f64| {
        let laid = Laid {
            map: &map,
            margins: [0.0; 2],
            reach: None,
            filaments: Vec::new(),
            orientation: None,
            patches: Vec::new(),
            streaks: true,
            error_of_weight,
            defects: Vec::new(),
        };
        let weight = Some(map.basis_weight());
        let keys = FabricKeys { measured_opacity: Some(0.35), opacity_weight: weight, ..FabricKeys::USUAL };
        let Some(Opacity { spread: Known::Value(spread, Some(error)), .. }) =
            estimate(&laid, &keys, 1).opacity
        else {
            panic!("no error")
        };
        (spread, error)
    };
    let scattering = scattering(0.35);
    let spread = |weight: f64| {
        0.5 * (opacity(1.05 * weight * scattering) - opacity(0.95 * weight * scattering))
            * (1e4_f64 / 9999.0).sqrt()
    };
    let ((value, none), (_, error)) = (of(0.0), of(0.03));
    assert!((value / spread(1.0) - 1.0).abs() < 1e-9, "{value}");
    let by_weight = (error * error - none * none).sqrt() / (0.5 * (spread(1.03) - spread(0.97)).abs());
    assert!((by_weight - 1.0).abs() < 0.01, "{by_weight}");
}

/// None is found below 80 %, but half of the patches would be there if deviations of 18 % were larger by a fifth.
#[test]
fn analytic_the_bound_where_a_map_may_be_too_even() {
    let sheet = map([30, 40], 1e-3, |i| if i % 30 < 15 { 0.825 } else { 1.175 });
    let of =
        |of_map: f64| MapUncertainty { deviations: Some(Deviations { by_chance: 0.0, of_map }), ..KNOWN };
    let found = thin_places(&sheet, 1, of(0.2)).unwrap();
    let Known::AtMost(most) = found.lighter[2] else { panic!("{found:?}") };
    // Three on the whole sheet of 12 cm², and half of those of a square millimetre.
    assert!((most / (3.0 / 1.2e-3 + 0.5 / 1e-6) - 1.0).abs() < 1e-9, "{most}");
    assert_eq!(thin_places(&sheet, 1, of(0.0)).unwrap().lighter[2], Known::AtMost(3.0 / 1.2e-3));
    // Two patches fit beside each other.
    assert!(thin_places(&sheet, 15, KNOWN).is_some() && thin_places(&sheet, 16, KNOWN).is_none());
}
