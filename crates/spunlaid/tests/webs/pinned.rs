//! A web that others are compared with in the same turbulence, one after another.

use crate::same_air::read;
use spunlaid_experiment::advice::{LOOKS, Look, PinnedWeb, Seen};
use spunlaid_ground::{Error, Isa, RunContext};
use spunlaid_input::WebFile;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// Enough filaments that half of them stand for all.
fn line(set: &[(&str, &str)]) -> WebFile {
    read(&[&[("web.simulated", "1000"), ("belt.speed", "10 m/s")], set].concat())
}

/// What is seen of a web, and of changed ones in its turbulence: looks, and the number of points that were shown.
fn looks(threads: usize, webs: &[&WebFile]) -> Vec<(Vec<Look>, usize)> {
    let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = RunContext { threads, isa: Isa::detect(), stop: &stop, done: &done };
    let mut all = Vec::new();
    let mut pinned = None;
    for web in webs {
        let (mut looks, mut points) = (Vec::new(), 0);
        let mut see = |seen| match seen {
            Seen::Laid(stretch) => points += stretch.filaments.iter().map(Vec::len).sum::<usize>(),
            Seen::Look(look) => looks.push(look),
        };
        match &pinned {
            None => pinned = Some(PinnedWeb::fly(&web.spec, &mut see, by).unwrap()),
            Some(pinned) => pinned.compare(&web.spec, &mut see, by).unwrap(),
        }
        all.push((looks, points));
    }
    all
}

#[test]
fn identical_looks_at_a_web_and_a_changed_one_whatever_the_threads() {
    let (web, farther) = (line(&[]), line(&[("belt.distance", "0.11 m")]));
    let [one, two] = [1, 2].map(|threads| format!("{:?}", looks(threads, &[&web, &farther])));
    assert_eq!(one, two);
}

/// Its error is that of the coarse mesh, 1.5 % of the CV.
#[test]
fn limit_a_web_in_its_own_turbulence_has_not_changed() {
    let web = line(&[]);
    // A stiffness that does not matter makes the flight another one.
    let other = line(&[("fibre.youngs_modulus", "2.0000001 GPa")]);
    let seen = looks(2, &[&web, &web, &other]);
    for (looks, _) in &seen[1..2] {
        assert_eq!(looks.iter().map(|look| look.area).collect::<Vec<_>>(), LOOKS);
        for change in looks.iter().flat_map(|look| &look.changes) {
            assert_eq!((change.difference.value, change.difference.standard_error), (0.0, 0.015));
        }
    }
    assert!(seen[1].0.iter().all(|look| look.changes.len() == 2), "{seen:?}");
    // One that has to be simulated begins and ends with the same air.
    for change in seen[2].0.iter().flat_map(|look| &look.changes) {
        assert!(change.difference.value.abs() < 0.03 && change.in_common.unwrap() > 0.9, "{change:?}");
    }
    assert_eq!(seen[1].1, 0);
    assert!(seen[2].1 > 0);
}

/// A web that needs a larger room is simulated beside the pinned one; the two ways to compare agree where both can be
/// gone.
#[test]
#[ignore = "slow: three webs in shared turbulence"]
fn stat_a_changed_web_alone_in_the_room_and_beside_the_pinned_one_agree() {
    let web = line(&[]);
    let farther = line(&[("belt.distance", "0.115 m")]);
    let far = line(&[("belt.distance", "0.13 m")]);
    let seen = looks(2, &[&web, &farther, &far]);
    // Beside the pinned one nothing is shown of a flight.
    assert!(seen[1].1 > 0 && seen[2].1 == 0);
    for ((alone, _), (beside, _)) in seen[1..2].iter().zip(&seen[2..]) {
        let [alone, beside] = [alone, beside].map(|looks| looks.last().unwrap().changes[1]);
        // Twice the change of the distance changes the CV about twice as much.
        let half = 0.5 * beside.difference.value;
        let error = 0.5 * beside.difference.standard_error;
        let off = (alone.difference.value - half) / alone.difference.standard_error.hypot(error);
        assert!(off.abs() < 3.0 && alone.in_common.unwrap() > 0.5, "{alone:?} {beside:?}");
    }
}

/// Half of 64 filaments leave open what those between them do, so the flight begins again with all of them.
#[test]
fn filaments_that_are_too_few_are_doubled() {
    let web = read(&[("web.simulated", "400"), ("belt.speed", "10 m/s")]);
    let seen = looks(2, &[&web, &web]);
    assert_eq!(seen[0].0.len(), LOOKS.len());
    assert!(seen[1].0.iter().all(|look| look.changes.len() == 2), "{seen:?}");
}

/// What passes of the air during a block is the same above both belts, although the sheets have other lengths. Blocks
/// of 50 mm of each sheet by itself would have nothing in common (0.01).
#[test]
#[ignore = "slow: two webs in shared turbulence"]
fn stat_a_web_on_a_slower_belt_has_the_clouds_of_the_pinned_one() {
    let seen = looks(2, &[&line(&[]), &line(&[("belt.speed", "8 m/s")])]);
    for change in &seen[1].0.last().unwrap().changes {
        assert!(change.in_common.unwrap() > 0.5, "{change:?}");
    }
}

#[test]
fn a_flight_that_is_stopped_ends_between_two_blocks() {
    let (stop, done) = (AtomicBool::new(false), AtomicU64::new(0));
    let by = RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &done };
    let mut blocks = 0;
    let mut see = |_: Seen| {
        blocks += 1;
        stop.store(true, std::sync::atomic::Ordering::Relaxed);
    };
    let found = PinnedWeb::fly(&line(&[]).spec, &mut see, by);
    assert!(matches!(found, Err(Error::Interrupted)) && blocks == 1);
}
