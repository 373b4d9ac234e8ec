//! The identity of the turbulence of a case, against the air that is drawn: it changes if that does, and only then.

use crate::company::{FAR, pairs};
use crate::company_cases::{CASES, with_files};
use spunlaid_air::{Hint, Lateral, Wind};
use spunlaid_fibre::Case;
use spunlaid_fibre::case::keys;
use spunlaid_ground::threads::par_map;
use spunlaid_ground::{Isa, Vec3};
use spunlaid_input::read_case;
use spunlaid_simulation::Job;
use std::collections::BTreeSet;

/// Times of looks [s], within all runs.
const TIMES: [f64; 3] = [0.3e-3, 1.7e-3, 5.1e-3];

/// What the eddies of a case do to its first replicate: the fluctuation over its rms, at elements, at stations with
/// their distance, or at places of a field. Nothing where there is no turbulence.
fn drawn(case: &Case) -> Option<Vec<f64>> {
    if case.air.rms() == 0.0 {
        return None;
    }
    let mut all = Vec::new();
    if let Ok(mut air) = case.air_at_places(0, 1) {
        let along = |i: u32| Vec3::new(case.way_of_air() * f64::from(i) / 6.0, 0.01 * f64::from(i % 3), 2e-3);
        let places: Vec<Vec3<f64>> = (0..=6).map(along).collect();
        for time in TIMES {
            for (place, velocity) in places.iter().zip(air.velocities(time, &places).unwrap()) {
                let local = case.air.local(*place, &mut Hint::default());
                let Vec3 { x, y, z } = (velocity - local.velocity) * (1.0 / local.rms);
                all.extend([x, y, z]);
            }
        }
        return Some(all);
    }
    let stations = case.stations();
    all.extend(stations.as_ref().map(|stations| stations.spacing));
    let eddies = case.eddies();
    let mut stream = Job::new(case, 0).stream(&eddies);
    stream.eddies.iter_mut().for_each(|eddy| (eddy.mean, eddy.rms) = (0.0, 1.0));
    let count = stream.eddies.len() as u32;
    let horizon = case.run.duration() + case.run.time_step;
    let mut wind = Wind::along(Isa::detect(), vec![stream], horizon).unwrap();
    for time in TIMES {
        let velocities = wind.at(time);
        let felt = |eddy: u32| {
            let Vec3 { x, y, z } = velocities[eddy as usize].lane(0);
            [x, y, z]
        };
        match stations {
            Some(_) => all.extend((0..count).flat_map(felt)),
            None => all.extend(eddies.index_of_element().iter().flat_map(|eddy| felt(*eddy))),
        }
    }
    Some(all)
}

/// Whether two airs are the same but for rounding.
fn agree(one: &[f64], other: &[f64]) -> bool {
    one.len() == other.len() && one.iter().zip(other).all(|(a, b)| (a - b).abs() < 1e-9)
}

/// The keys that change the turbulence of a case, and what is wrong.
fn of_every_key(name: &str, text: &str) -> (BTreeSet<&'static str>, Vec<String>) {
    let text = with_files(text);
    let mut changing = BTreeSet::new();
    let mut wrong = Vec::new();
    let case_with = |set: &[(String, String)]| read_case((&*text, "case.toml"), set).map(|(case, _)| case);
    let case = case_with(&[]).unwrap();
    let (air, is_field) = (drawn(&case).unwrap(), case.air.lateral != Lateral::Uniform);
    for key in keys::all() {
        // One value of each kind; a field of small eddies that decay fast takes longer than all else.
        let mut done = if is_field { BTreeSet::from([FAR]) } else { BTreeSet::new() };
        for (how, [_, value]) in pairs(key, &case) {
            let to_field = key.name == "air.lateral" && !is_field;
            let Ok(changed) = case_with(&[(key.name.to_owned(), value.clone())]) else { continue };
            if key.kind.words().is_empty() && !done.insert(how) {
                continue;
            }
            let has_identity = changed.turbulence() == case.turbulence();
            if !has_identity {
                changing.insert(key.name);
            }
            let Some(of_changed) = (!to_field).then(|| drawn(&changed)).flatten() else { continue };
            let has_air = agree(&air, &of_changed);
            // The cut-off across chooses whole waves, and counts as it is written; so does how a record was read.
            let is_reported = key.name == "air.lateral_cutoff" || key.name.starts_with("air.record_");
            if has_air != has_identity && (has_identity || !is_reported) {
                wrong.push(format!(
                    "{name}: {} = {value}: same air {has_air}, identity {has_identity}",
                    key.name
                ));
            }
        }
    }
    (changing, wrong)
}

#[test]
fn the_turbulence_is_distinguished_if_and_only_if_other_air_is_drawn() {
    // Those with a spinline have no other air.
    let cases: Vec<_> = CASES.iter().filter(|(name, _)| !name.starts_with("spun")).collect();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let found = par_map(threads, cases.len(), |i| of_every_key(cases[i].0, cases[i].1));
    let wrong: Vec<&String> = found.iter().flat_map(|(_, wrong)| wrong).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    let changing: BTreeSet<&str> = found.iter().flat_map(|(changing, _)| changing).copied().collect();
    let fixed = "fibre.length belt.distance air.velocity air.speed_factor air.turbulence_intensity \
        air.intensity_factor air.length_scale air.length_factor air.cutoff_frequency air.spectrum air.eddies \
        air.decay_time air.lateral air.lateral_cutoff air.harmonics run.seed run.duration";
    for key in fixed.split_whitespace() {
        assert!(changing.contains(key), "{key} changes no turbulence: {changing:?}");
    }
}
