//! Webs of a few filaments each in the same air.

use spunlaid_input::{Overrides, WebFile, read_web};
use spunlaid_simulation::{Compared, Flights, Flyer};
use spunlaid_web::SubsampleEstimate;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// A short line above a fast belt, so that little has to be simulated.
const WEB: &str = "
[laydown]
case = \"spunbond_slot.toml\"
[line]
filaments_per_metre = 2000
slot_gap = \"10 mm\"
[web]
width = \"0.16 m\"
length = \"0.2 m\"
cell = \"1 mm\"
patches = [\"5 mm\", \"10 mm\"]
simulated = 150
";
const SHORT: [(&str, &str); 5] = [
    ("belt.distance", "0.1 m"),
    ("belt.speed", "5 m/s"),
    ("run.spin_up", "10 ms"),
    ("run.duration", "0.1 s"),
    ("air.lateral_cutoff", "4"),
];

pub(super) fn read(set: &[(&str, &str)]) -> WebFile {
    let set: Vec<(String, String)> =
        SHORT.iter().chain(set).map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases/web_shared.toml");
    read_web((WEB, &cases.display().to_string()), Overrides::new(&set, "--set")).unwrap()
}

const ALL: Compared = Compared { area: 0.15, pitches: 1.5 };

pub(super) fn unwatched(_: Flights<'_>, work: &mut (dyn FnMut() + Send)) {
    work();
}

fn few(webs: &[&WebFile], threads: usize) -> Vec<SubsampleEstimate> {
    let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let specs: Vec<_> = webs.iter().map(|web| &web.spec).collect();
    let flyer = Flyer::new(threads, &stop, &unwatched);
    let estimates = flyer.few_in_same_air(&specs, ALL, &steps).unwrap().unwrap();
    estimates.into_iter().flat_map(|layers| layers.unwrap()).collect()
}

/// Another web beside it makes the room larger, in which both of them hang.
#[test]
fn identical_a_web_beside_itself_has_not_changed() {
    let (web, farther) = (read(&[]), read(&[("belt.distance", "0.12 m")]));
    // Sixteen filaments are too few to give the CV of all, but what they have laid is reported, block by block.
    let laid = |few: &SubsampleEstimate| {
        (few.sheet, few.blocks.clone(), few.cvs.iter().map(|cv| cv.few).collect::<Vec<_>>())
    };
    let [one, two] =
        [1, 2].map(|threads| few(&[&web, &farther, &web], threads).iter().map(laid).collect::<Vec<_>>());
    assert_eq!(one, two);
    assert_eq!(one[0], one[2]);
    assert!(one[0].2[0] > 0.1 && one[0].1 != one[1].1, "{one:?}");
}

/// theory.md (75): every point comes down at the same time and place above a slow belt. A web on another belt
/// is reported by the same flight, as if it had been simulated again.
#[test]
fn analytic_a_web_on_another_slow_belt_needs_no_flight() {
    let set: &[(&str, &str)] = &[("belt.speed", "4 m/s"), ("web.length", "0.16 m")];
    let (web, slower) = (read(&[]), read(set));
    // The belt that is named first says for how long they fly.
    let [estimates, simulated] = [few(&[&web, &slower], 2).remove(1), few(&[&slower], 2).remove(0)];
    for (estimates, simulated) in estimates.cvs.iter().zip(&simulated.cvs) {
        println!("{} {}", estimates.few, simulated.few);
        assert!((estimates.few / simulated.few - 1.0).abs() < 0.03, "{estimates:?} {simulated:?}");
    }
    assert!(estimates.sheet[1] < 0.9 * few(&[&web], 2)[0].sheet[1]);
}

/// Webs beside each other need the room of the largest; one that may not take it says how much it is.
#[test]
fn rejects_webs_whose_common_air_does_not_fit_into_the_memory() {
    let (mut web, farther) = (read(&[]), read(&[("belt.distance", "0.5 m")]));
    let (stop, steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let flyer = Flyer::new(1, &stop, &unwatched);
    web.spec.memory_limit = 1e6;
    let said = flyer.few_in_same_air(&[&web.spec, &farther.spec], ALL, &steps).unwrap_err().to_string();
    let begin = "the field of eddies in which the changed webs are simulated together takes ";
    assert!(said.starts_with(begin) && said.contains("more than web.memory_limit = 1 MB; write "), "{said}");
}
