//! A fibre has the same bits alone and in company: every key of the table, varied in a study of two points, gives what
//! two single runs give, in every measure.

use crate::company_cases::{CASES, FIXED, with_files};
use crate::short::case_of;
use spunlaid_air::{Air, EddyModel, Flow, FlowNumbers};
use spunlaid_experiment::study::fly_batches;
use spunlaid_experiment::{Batch, Bundles, Point};
use spunlaid_fibre::Case;
use spunlaid_fibre::case::keys::{self, Key, Kind, Omission, Value};
use spunlaid_ground::threads::par_map;
use spunlaid_ground::{Error, Isa, RunContext, Value as Measured};
use spunlaid_input::{parse_study, read_case, write_case};
use spunlaid_simulation::ensemble::{fly, fly_together};
use spunlaid_simulation::{Job, Recorded, Trajectory};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::atomic::{AtomicBool, AtomicU64};

/// Replicates of each point: both points together fill half a flight.
const REPLICATES: u64 = 2;

fn read(text: &str) -> Case {
    let replicates = [("run.replicates".to_owned(), REPLICATES.to_string())];
    read_case((text, "case.toml"), &replicates).unwrap_or_else(|error| panic!("{error}")).0
}

/// The points of a study that varies a key, or why there are none.
fn points(case: &str, key: &str, values: &[String; 2]) -> Result<Vec<Point>, String> {
    let [a, b] = values;
    let text = format!(
        "case = 'case.toml'\ndesign = 'grid'\nreplicates = {REPLICATES}\n[vary]\n{key} = [{a}, {b}]\n"
    );
    let study = parse_study(&text, "study.toml", None, |_, _| Ok((case.to_owned(), "case.toml".to_owned())));
    study.map(|file| file.study.points).map_err(|error| error.to_string())
}

/// Two values so close to each other that they share a flight if any do.
const CLOSE: usize = 0;
/// Others; words have further numbers.
pub const FAR: usize = 1;

/// Pairs of values of a key, as they are written in a study: [`CLOSE`] or [`FAR`]. Of several of a kind, the
/// first that can be run will do. They follow from the row of the table: its value in the case, its slider,
/// its words.
pub fn pairs(key: &Key, case: &Case) -> Vec<(usize, [String; 2])> {
    let written = |value: f64| match key.kind {
        Kind::Quantity(dimension, _) => format!("'{}'", dimension.exact(value)),
        _ => format!("{value:.0}"),
    };
    let there = key.get(case);
    match key.kind {
        Kind::Quantity(..) => {
            let (least, greatest) = key.slider.or(key.usual).unwrap_or((0.5, 2.0));
            let middle = 0.5 * (least + greatest);
            let centre = there.as_ref().and_then(Value::number).unwrap_or(middle);
            let at = |share: f64| least + share * (greatest - least);
            let all = [
                (CLOSE, centre, centre * (1.0 + 1.0 / 1024.0)),
                (FAR, centre, 1.5 * centre),
                (FAR, centre, 0.7 * centre),
                // Where the value is zero, or others cannot be run.
                (CLOSE, at(0.5), at(0.501)),
                (FAR, at(0.0), at(0.4)),
            ];
            let all = all.into_iter().filter(|(_, a, b)| a != b);
            all.map(|(how, a, b)| (how, [written(a), written(b)])).collect()
        }
        Kind::Whole(least, _) => {
            let centre = there.as_ref().and_then(Value::number).unwrap_or(0.0).max(least as f64 + 1.0);
            let pair = |how, other: f64| (how, [written(centre), written(other)]);
            vec![pair(CLOSE, centre + 1.0), pair(FAR, 2.0 * centre)]
        }
        _ => {
            let words = key.kind.words();
            let here = words.iter().find(|word| there == Some(Value::Text((**word).to_owned())));
            let Some(here) = here.or(words.first()) else { return Vec::new() };
            let quoted = |word: &str| format!("'{word}'");
            let others = words.iter().filter(|word| *word != here);
            others.enumerate().map(|(i, word)| (FAR + i, [quoted(here), quoted(word)])).collect()
        }
    }
}

/// All that may differ.
const KEPT: Recorded = Recorded { samples: true, ..Recorded::CURVES };

fn computing<'a>(stop: &'a AtomicBool, steps: &'a AtomicU64) -> RunContext<'a> {
    RunContext { threads: 1, isa: Isa::detect(), stop, done: steps }
}

/// What a run of a case alone gives, or why it gives nothing.
fn alone(case: &Case) -> Result<Vec<Trajectory>, String> {
    let stop = AtomicBool::new(false);
    let steps = AtomicU64::new(0);
    let mut all = Vec::new();
    let done: Result<(), Error> = fly(case, KEPT, computing(&stop, &steps), |one| {
        all.push(one);
        Ok(())
    });
    done.map(|()| all).map_err(|error| error.to_string())
}

/// What the points of a study give, by point.
fn together(points: &[Point]) -> Result<Vec<Vec<Trajectory>>, String> {
    let stop = AtomicBool::new(false);
    let steps = AtomicU64::new(0);
    let mut all = vec![Vec::new(); points.len()];
    let done: Result<(), Error> =
        fly_batches(points, &batches(points), KEPT, computing(&stop, &steps), |point, one| {
            all[point].push(one);
            Ok(())
        });
    done.map(|()| all).map_err(|error| error.to_string())
}

fn batches(points: &[Point]) -> Vec<Batch> {
    (0..points.len()).map(|point| Batch { point, replicates: 0..REPLICATES }).collect()
}

/// The bits of a measure, of its places too if it is a curve.
fn bits(value: &Measured) -> Vec<u64> {
    match value {
        Measured::Curve(places, values) => places.iter().chain(values).map(|x| x.to_bits()).collect(),
        number => vec![number.number().to_bits()],
    }
}

/// The measures of a fibre that differ in any bit, and `samples` if the energies on the way do.
fn differences(one: &Trajectory, other: &Trajectory) -> BTreeSet<&'static str> {
    let values = |of: &Trajectory| -> BTreeMap<&'static str, Vec<u64>> {
        of.values.iter().map(|(measure, value)| (measure.name, bits(value))).collect()
    };
    let (a, b) = (values(one), values(other));
    let names = a.keys().chain(b.keys()).copied();
    let mut differ: BTreeSet<_> = names.filter(|name| a.get(name) != b.get(name)).collect();
    if format!("{:?}", one.samples) != format!("{:?}", other.samples) {
        differ.insert("samples");
    }
    differ
}

/// Which measures differ between a study of these points and single runs, each with the number of fibres.
fn differing(points: &[Point], known: &mut BTreeMap<String, Result<Vec<Trajectory>, String>>) -> Vec<String> {
    let single: Vec<_> = (points.iter())
        .map(|point| known.entry(write_case(case_of(point))).or_insert_with(|| alone(case_of(point))).clone())
        .collect();
    match together(points) {
        Ok(simulated) => {
            let mut differ = BTreeSet::new();
            for (simulated, single) in simulated.iter().zip(&single) {
                match single {
                    Ok(single) if single.len() == simulated.len() => {
                        simulated.iter().zip(single).for_each(|(a, b)| differ.extend(differences(a, b)));
                    }
                    Ok(_) => drop(differ.insert("the number of replicates")),
                    Err(_) => drop(differ.insert("alone it is lost")),
                }
            }
            differ.into_iter().map(str::to_owned).collect()
        }
        Err(error) if single.iter().any(|one| one.as_ref().err() == Some(&error)) => Vec::new(),
        Err(error) => vec![format!("together: {error}")],
    }
}

/// What is found when every key of a case varies.
#[derive(Default)]
struct Found {
    wrong: Vec<String>,
    /// Keys that have varied, and those of which two values have shared a flight.
    varied: BTreeSet<&'static str>,
    shared: BTreeSet<&'static str>,
}

fn vary_every_key(name: &str, text: &str) -> Found {
    let text = &with_files(text);
    let case = read(text);
    let (mut found, mut known) = (Found::default(), BTreeMap::new());
    // Cases with a spinline differ from others in its keys only.
    let is_tested = |key: &&Key| case.spinline.is_none() || key.name.starts_with("spinline.");
    // Air that differs across the flow is coarse: the usual one takes longer than all other keys together.
    let coarse = "[air]\nlateral = 'von-karman'\nlateral_cutoff = 5\n";
    let in_coarse_air =
        if text.contains("lateral = ") { text.clone() } else { text.replace("[air]\n", coarse) };
    for key in keys::all().iter().filter(|key| key.varies).filter(is_tested) {
        let (mut refused, mut simulated) = (Vec::new(), BTreeSet::new());
        let text = if key.name == "air.lateral" { &in_coarse_air } else { text };
        for (how, values) in pairs(key, &case) {
            if simulated.contains(&how) {
                continue;
            }
            let points = match points(text, key.name, &values) {
                Ok(points) => points,
                Err(reason) => {
                    refused.push(reason);
                    continue;
                }
            };
            simulated.insert(how);
            let differ = differing(&points, &mut known);
            if !differ.is_empty() {
                found.wrong.push(format!("{name}: {} = {values:?}: {}", key.name, differ.join(", ")));
            }
            if how == CLOSE && Bundles::from_batches(&points, &batches(&points), 1).count() == 1 {
                found.shared.insert(key.name);
            }
        }
        // Some keys have no meaning for a case, some are reported by a file or by other keys.
        let is_there = key.get(&case).is_some() && !key.is_derived(&case);
        let excluded = refused.iter().all(|reason| reason.contains("cannot be combined with"));
        if is_there && !excluded && key.kind.words().is_empty() && !simulated.contains(&CLOSE) {
            found.wrong.push(format!("{name}: no two close values of {}: {refused:?}", key.name));
        }
        if simulated.iter().any(|how| *how >= FAR) {
            found.varied.insert(key.name);
        }
    }
    found
}

#[test]
#[ignore = "slow: every key of eleven cases"]
fn identical_alone_and_in_company_for_every_key() {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let cases: Vec<_> = CASES.into_iter().filter(|(name, _)| !PLAIN.contains(name)).collect();
    let found = par_map(threads, cases.len(), |i| vary_every_key(cases[i].0, cases[i].1));
    let mut wrong: Vec<String> = found.iter().flat_map(|found| found.wrong.clone()).collect();
    for key in keys::all().iter().filter(|key| key.varies) {
        if !found.iter().any(|found| found.varied.contains(key.name)) {
            wrong.push(format!("no case of this test varies {}; add one", key.name));
        }
        // What may change in flight is a number of its own lane.
        let is_number = matches!(key.kind, Kind::Quantity(..));
        if key.in_flight && is_number && !found.iter().any(|found| found.shared.contains(key.name)) {
            wrong.push(format!("no two values of {} share a flight, so that none is tested", key.name));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The plainest fibre that hangs and the plainest that is fed; other kinds of fibre and air are slow.
const PLAIN: [&str; 2] = ["fixed", "fed"];

#[test]
fn identical_alone_and_in_company_for_every_key_of_plain_fibres() {
    for (name, text) in CASES.into_iter().filter(|(name, _)| PLAIN.contains(name)) {
        let found = vary_every_key(name, text);
        assert!(found.wrong.is_empty() && found.shared.len() > 5, "{}", found.wrong.join("\n"));
    }
}

/// A study refuses the other keys, and says what to do.
#[test]
fn rejects_keys_that_a_study_cannot_vary_with_the_way_out() {
    for key in keys::all().iter().filter(|key| !key.varies) {
        let value = match key.omission {
            Omission::Value(text) if matches!(key.kind, Kind::Whole(..)) => text.to_owned(),
            _ => "'1 m'".to_owned(),
        };
        let message = points(FIXED, key.name, &[value.clone(), value]).unwrap_err();
        let way_out = message.split(" cannot be set by a study; ").nth(1);
        assert!(
            way_out.is_some_and(|way_out| way_out.len() > 20) && message.contains(key.name),
            "{}: {message}",
            key.name
        );
    }
}

/// A flow that varies from place to place, and the same air everywhere: all else is equal, so that they would
/// share a flight.
#[test]
fn identical_alone_and_in_company_of_another_kind_of_flow() {
    let cases = CASES.iter().map(|(name, text)| (name, read(&with_files(text))));
    let varied: Vec<_> = cases.filter(|(_, case)| !case.air.is_uniform()).collect();
    assert!(varied.iter().any(|(_, case)| case.line.is_some()));
    let (mut wrong, mut known) = (Vec::new(), BTreeMap::new());
    for (name, case) in varied {
        let air = Air { eddies: EddyModel::Independent, ..case.air.clone() };
        let uniform = Air { flow: Flow::Uniform, from_flow: FlowNumbers::default(), ..air.clone() };
        let cases = [air, uniform].map(|air| Case { air, ..case.clone() });
        assert!(cases.iter().all(|case| case.check().is_ok()), "{name}");
        for order in [[0, 1], [1, 0]] {
            let point = |i: usize| Point { values: Vec::new(), experiment: cases[i].clone().into() };
            let differ = differing(&order.map(point), &mut known);
            if !differ.is_empty() {
                wrong.push(format!("{name}, {order:?}: {}", differ.join(", ")));
            }
            // An error that they cannot be simulated together, or results that are bit-identical to those alone.
            let jobs = order.map(|i| Job::new(&cases[i], 0));
            let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
            match fly_together(&jobs, KEPT, computing(&stop, &steps)) {
                Err(Error::Flight(fault))
                    if fault.message.starts_with("fibre 2 cannot be simulated together with the first") => {}
                Err(other) => panic!("{other}"),
                Ok(simulated) => {
                    for (simulated, i) in simulated.iter().zip(order) {
                        let differ = differences(simulated, &alone(&cases[i]).unwrap()[0]);
                        if !differ.is_empty() {
                            wrong.push(format!("{name}, {order:?}, in one flight: {differ:?}"));
                        }
                    }
                }
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}
