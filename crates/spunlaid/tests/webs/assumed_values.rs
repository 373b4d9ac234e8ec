//! AssumedValues: what half and twice of a number that nobody has measured does to the CV.

use crate::advice::cases;
use spunlaid_experiment::Change;
use spunlaid_experiment::advice::{advise, are_tried, steps};
use spunlaid_ground::{Isa, RunContext};
use spunlaid_input::{Changes, Overrides, read_changes, read_web};
use spunlaid_simulation::shared_turbulence::steps_in_same_air;
use spunlaid_simulation::{Compared, Flyer, WebSpec};
use std::sync::atomic::{AtomicBool, AtomicU64};

fn read(text: &str, set: &[(&str, &str)]) -> Vec<Change> {
    let set: Vec<(String, String)> =
        set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    read_changes((text, &cases()), Overrides::new(&set, "--set"), Changes::OfAssumedValues).unwrap()
}

/// What each web changes: the keys, and their factors.
fn factors(changes: &[Change]) -> Vec<(&str, f64)> {
    changes.iter().flat_map(|change| &change.keys).map(|key| (&*key.key, key.to / key.from)).collect()
}

/// Two beams with slots, in air from a table.
const BEAMS: &str = "
[[layer]]
[layer.laydown]
case = \"spunbond_slot.toml\"
[layer.line]
filaments_per_metre = 3000
slot_gap = \"20 mm\"
[[layer]]
[layer.laydown]
case = \"spunbond_slot.toml\"
[layer.line]
filaments_per_metre = 2000
slot_gap = \"20 mm\"
[web]
width = \"250 mm\"
length = \"250 mm\"
";

/// Eddies that are twice as long have as many clouds on four times the area, and shorter ones need no less of it.
#[test]
fn longer_eddies_are_simulated_on_a_larger_area() {
    let spec = read_web((BEAMS, &cases()), &[]).unwrap().spec;
    let changes = read(BEAMS, &[("web.assumed", "air.length_factor")]);
    assert_eq!(factors(&changes), [("air.length_factor", 0.5), ("air.length_factor", 2.0)]);
    let on = |spec: &WebSpec, area: f64| steps_in_same_air(&[spec], Compared { area, pitches: 2.0 });
    for (change, area) in changes.iter().zip([0.045, 0.18]) {
        let expected = on(&spec, 0.045) + on(&change.experiment.spec, area);
        assert_eq!(steps(&spec, std::slice::from_ref(change)), expected, "{:?}", change.keys);
    }
}

/// What each says to set makes the very web that is tried, also beside what was set before.
#[test]
fn identical_what_an_assumed_value_says_to_set_is_the_web_that_is_tried() {
    let assumed = "line.slot_gap, air.length_factor, air.intensity_factor";
    let mut set = vec![("web.assumed", assumed), ("air.intensity_factor", "0.9")];
    let changes = read(BEAMS, &set);
    let keys = ["line.slot_gap", "air.length_factor", "air.intensity_factor"];
    let wanted: Vec<(&str, f64)> = keys.iter().flat_map(|key| [(*key, 0.5), (*key, 2.0)]).collect();
    assert_eq!(factors(&changes), wanted);
    for change in &changes {
        let set = Overrides::new(&change.experiment.set, "--set");
        let pasted = read_web((BEAMS, &cases()), set).unwrap().spec;
        assert_eq!(
            format!("{pasted:?}"),
            format!("{:?}", change.experiment.spec),
            "{:?}",
            change.experiment.set
        );
    }
    // Both slots become deeper together; eddies half as long keep the smallest waves.
    let both = changes[1]
        .experiment
        .set
        .iter()
        .filter(|(key, value)| key.ends_with(".slot_gap") && value == "40 mm");
    assert_eq!(both.count(), 2, "{:?}", changes[1].experiment.set);
    let cutoffs: Vec<f64> =
        changes.iter().map(|change| change.experiment.spec.lateral_cutoff(0).unwrap()).collect();
    assert!(
        cutoffs.iter().enumerate().all(|(i, cutoff)| *cutoff == cutoffs[0] * if i == 2 { 0.5 } else { 1.0 })
    );
    // Nothing is an assumed value once it has been measured.
    set[0].1 = "none";
    assert!(read(BEAMS, &set).is_empty());
}

/// A number that was set before is replaced, and stands once in what is to be pasted.
#[test]
fn identical_an_assumed_value_replaces_what_was_set_before() {
    let one = BEAMS.split("[[layer]]").nth(1).unwrap().replace("[layer.", "[");
    let text = format!("{one}[web]\nwidth = \"250 mm\"\nlength = \"250 mm\"\n");
    let changes = read(&text, &[("line.slot_gap", "30 mm"), ("web.assumed", "line.slot_gap")]);
    assert_eq!(factors(&changes), [("line.slot_gap", 0.5), ("line.slot_gap", 2.0)]);
    for (change, depth) in changes.iter().zip(["15 mm", "60 mm"]) {
        let depths: Vec<&str> = change
            .experiment
            .set
            .iter()
            .filter(|(key, _)| key == "line.slot_gap")
            .map(|(_, value)| &**value)
            .collect();
        assert_eq!(depths, [depth], "{:?}", change.experiment.set);
        let set = Overrides::new(&change.experiment.set, "--set");
        let pasted = read_web((&text, &cases()), set).unwrap().spec;
        assert_eq!(format!("{pasted:?}"), format!("{:?}", change.experiment.spec));
    }
}

/// Independent filaments at random places on a belt of the same speed have CV² ∝ 1/number.
#[test]
fn analytic_the_cv_of_half_and_twice_of_the_filaments() {
    let text = "
[fibre]
linear_density = \"2 dtex\"
density = \"910 kg/m³\"
[laydown]
sigma_md = \"9 mm\"
sigma_cd = \"8 mm\"
noise = \"15 m^-0.5\"
[line]
throughput = \"0.6 g/min\"
belt_speed = \"1 m/s\"
filaments_per_metre = 2000
[web]
width = \"150 mm\"
length = \"150 mm\"
cell = \"1 mm\"
patches = [\"2 mm\", \"10 mm\"]
assumed = \"line.filaments_per_metre\"
";
    let spec = read_web((text, &cases()), &[]).unwrap().spec;
    let changes = read(text, &[]);
    assert_eq!(factors(&changes), [("line.filaments_per_metre", 0.5), ("line.filaments_per_metre", 2.0)]);
    let (laid, stop) = (AtomicU64::new(0), AtomicBool::new(false));
    let by = RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &laid };
    let mut simulated = Flyer::new(2, &stop, &|_, work| work()).web(&spec).unwrap();
    let findings = simulated.find(by).unwrap();
    assert!(are_tried(&spec, &findings, &changes));
    let assumed_values = advise(&spec, &simulated.web, &findings, changes, None, None, by).unwrap();
    let ends = assumed_values.range(10e-3);
    for (found, wanted) in ends.iter().zip([0.5_f64.sqrt(), 2.0_f64.sqrt()]) {
        assert!((found / wanted - 1.0).abs() < 1e-6, "{ends:?}");
    }
    assert_eq!(assumed_values.range(7e-3), [1.0, 1.0]);
}
