//! Webs of a few filaments each in the same air.

use spunlaid::advice::{Advice, Change, advise};
use spunlaid::input::{Flyer, Overrides, WebFile, parse_changes, parse_web};
use spunlaid::lanes::Isa;
use spunlaid::web::{LayControl, LayerFew};
use std::sync::atomic::{AtomicBool, AtomicU64};

/// A short line above a fast belt, so that little has to be flown.
const WEB: &str = "
[laydown]
case = \"spunbond_slot.toml\"
[line]
filaments_per_metre = 2000
depth = \"10 mm\"
[web]
width = \"0.16 m\"
length = \"0.3 m\"
cell = \"1 mm\"
patches = [\"5 mm\", \"10 mm\"]
flown = 150
";
const SHORT: [(&str, &str); 5] = [
    ("belt.distance", "0.1 m"),
    ("belt.speed", "5 m/s"),
    ("run.spin_up", "10 ms"),
    ("run.duration", "0.1 s"),
    ("air.lateral_cutoff", "5"),
];
