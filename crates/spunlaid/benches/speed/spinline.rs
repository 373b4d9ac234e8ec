//! The spinline: from the die to the solid filament, a solve by each law of the melt.

use crate::measure::{Trial, in_rounds, processor_time};
use crate::title;
use spunlaid_input::{SpinFile, read_spinline};
use std::hint::black_box;
use std::path::Path;

/// Processor time for a solve.
pub fn costs() {
    title("spinline: a solve to a tolerance of 1e-8 of each step, one core");
    println!("  file                   change                                 solve [ms]");
    let lines = [
        ("spinline.toml", None),
        ("spinline.toml", Some(("spinline.law", "giesekus"))),
        ("spinline.toml", Some(("spinline.law", "ptt"))),
        ("spinline.toml", Some(("spinline.law", "ptt-exponential"))),
        ("spinline.toml", Some(("spinline.crystallisation", "true"))),
        ("spinline.toml", Some(("spinline.dissipation", "true"))),
        ("melt_spinning.toml", None),
    ];
    let files = lines.map(|(name, change)| read(name, change));
    let mut trials = files.each_ref().map(|file| {
        Trial::new(1.0, move || {
            processor_time(|| drop(black_box(file.solve().expect("a line with a steady state"))))
        })
    });
    in_rounds(&mut trials, 0.5);
    for ((name, change), trial) in lines.iter().zip(&trials) {
        let change = change.map_or(String::new(), |(key, value)| format!("{key} = {value}"));
        println!("  {name:<20}   {change:<36}   {:>10.2}", trial.each() * 1e3);
    }
}

fn read(name: &str, change: Option<(&str, &str)>) -> SpinFile {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../cases").join(name);
    let set: Vec<_> = change.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    read_spinline(&path, &set).expect("a spinline that can be read")
}
