//! How many filaments of a web in one air are flown for all of them.

use spunlaid::ground::{Control, Isa};
use spunlaid::input::read_web;
use spunlaid::simulation::{Flyer, WebSpec};
use spunlaid::web::{FewDoubt, LayerFew};
use std::sync::atomic::{AtomicBool, AtomicU64};

/// A row on so short a way that neighbours hardly know of each other.
const WEB: &str = "
version = 1
[fibre]
diameter = \"18 µm\"
density = \"910 kg/m³\"
youngs_modulus = \"2 GPa\"
element_length = \"3 mm\"
root = \"clamped\"
[feed]
speed = \"50 m/s\"
[belt]
distance = \"30 mm\"
speed = \"3 m/s\"
[air]
velocity = \"45 m/s\"
turbulence_intensity = 0.1
length_scale = \"16 mm\"
cutoff_frequency = \"700 Hz\"
[drag]
across = \"marheineke-wegener\"
[run]
duration = \"40 ms\"
replicates = 3
[line]
rows = [{ pitch = \"0.16 mm\", filaments = 1000 }]
[web]
width = \"160 mm\"
length = \"20 mm\"
cell = \"1 mm\"
";

/// What the filaments say that are flown for all.
fn told(flown: &str) -> LayerFew {
    let text = format!("{WEB}flown = {flown}\n");
    let spec: WebSpec = read_web((&text, "web.toml"), &[]).unwrap_or_else(|_| panic!("it is read")).spec;
    let (laid, stop) = (AtomicU64::new(0), AtomicBool::new(false));
    let by = Control { threads: 2, isa: Isa::detect(), stop: &stop, done: &laid };
    let mut web = Flyer::new(2, &stop, &|_, work| work()).web(&spec).unwrap();
    let findings = web.find(by).unwrap();
    findings.laid.flown[0].few.clone().unwrap()
}

/// Eight filaments in a length scale of 16 mm do not tell what those between them do, so that twice and then
/// four times as many are flown, as a number would say; a number is flown as it is.
#[test]
fn identical_the_usual_web_flies_four_times_as_many_where_the_first_do_not_tell() {
    let [usual, fine, first] = ["\"auto\"", "2000", "500"].map(told);
    assert_eq!([&usual, &first].map(|few| few.filaments + few.lost), [320, 80]);
    assert!(matches!(first.doubt(), Some(FewDoubt::Neighbours(_))), "{}", first.correlation);
    assert_eq!(format!("{usual:?}"), format!("{fine:?}"));
    assert!((usual.pitch - 0.5e-3).abs() < 1e-12 && (first.pitch - 2e-3).abs() < 1e-12);
}
