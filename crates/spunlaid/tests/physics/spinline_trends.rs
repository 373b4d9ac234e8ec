//! Which way a spinline goes when something is changed, where measurements say which way. Their numbers are
//! not compared.

use spunlaid_fibre::{SolidificationCause, Solution};
use spunlaid_input::read_spinline;
use std::path::Path;

/// A spinline of a file under other settings.
fn solve(file: &str, set: &[(&str, &str)]) -> Solution {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(file);
    let set: Vec<_> = set.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
    let line = read_spinline(&path, &set).unwrap_or_else(|error| panic!("{error}"));
    line.solve().unwrap_or_else(|error| panic!("{error}")).remove(0)
}

/// Polypropylene crystallises nearer to the die, and hotter, with a faster take-up, a colder die and a lower
/// melt flow rate: F.-M. Lu and J. E. Spruiell, The influence of resin characteristics on the high speed melt
/// spinning of isotactic polypropylene, part II; the abstract, with melt flow rates of 12, 35 and 300.
#[test]
fn published_trends_of_crystallisation_on_the_line() {
    let onset = |set: &[(&str, &str)]| {
        let solidification = solve("tests/spinline_cases/pp_crystal_3000.toml", set).solidification;
        assert_eq!(solidification.by, SolidificationCause::Crystallisation, "{set:?}");
        (solidification.distance, solidification.temperature)
    };
    for (key, values) in [
        ("spinline.take_up_speed", ["4000 m/min", "3000 m/min", "2000 m/min"]),
        ("spinline.die_temperature", ["210 °C", "230 °C", "270 °C"]),
        ("spinline.melt_flow_rate", ["12", "35", "300"]),
    ] {
        let onsets = values.map(|value| onset(&[(key, value)]));
        for pair in onsets.windows(2) {
            let [(near, hot), (far, cold)] = [pair[0], pair[1]];
            // A trend, not the tolerance of the solution: by 5 % and 1 K at least.
            assert!(near < 0.95 * far && hot > cold + 1.0, "{key}: {onsets:?}");
        }
    }
}

/// A spunbond filament of polypropylene is finer with less throughput, a hotter melt, hotter air and a faster
/// suction: B. Zhao, Investigation of fiber diameter in spunbonding process via mathematical modeling; the
/// abstract.
#[test]
fn published_trends_of_the_diameter_in_a_spunbond_line() {
    let uniform = [("spinline.profile", "auto"), ("spinline.cross_velocity", "0.2 m/s")];
    let diameter = |set: &[(&str, &str)]| solve("../../cases/spinline.toml", set).final_diameter;
    let in_uniform_air = |set: &[(&str, &str)]| diameter(&[&uniform[..], set].concat());
    for diameters in [
        ["0.4 g/min", "0.5 g/min", "0.6 g/min"].map(|value| diameter(&[("spinline.throughput", value)])),
        ["240 °C", "230 °C", "220 °C"].map(|value| diameter(&[("spinline.die_temperature", value)])),
        ["60 m/s", "50 m/s", "40 m/s"].map(|value| in_uniform_air(&[("spinline.velocity", value)])),
        ["60 °C", "40 °C", "20 °C"]
            .map(|value| in_uniform_air(&[("spinline.velocity", "40 m/s"), ("spinline.temperature", value)])),
    ] {
        // A trend, not the tolerance of the solution: by 3 % at least.
        assert!(diameters.windows(2).all(|pair| pair[0] < 0.97 * pair[1]), "{diameters:?}");
    }
}

/// Polyester of `cases/melt_spinning.toml` with crystallisation, taken up at a speed [m/min].
fn polyester(speed: u32, more: &[(&str, &str)]) -> Solution {
    let speed = format!("{speed} m/min");
    let set = [("spinline.take_up_speed", &*speed), ("spinline.crystallisation", "true")];
    solve("../../cases/melt_spinning.toml", &[&set[..], more].concat())
}

/// The neck of round fibres of polyester begins at 5 km/min: W. Takarada and others, Journal of Applied
/// Polymer Science 80, 1582, 2001, the abstract. It is stretched by up to about 1000 1/s there: T. Kikutani
/// and others, Polymer Engineering & Science, 1999, the abstract.
#[test]
fn published_neck_of_polyester() {
    let necks = |found: &Solution| found.solidification.by == SolidificationCause::Crystallisation;
    for speed in [1500, 4000, 4500] {
        let found = polyester(speed, &[]);
        assert!(
            !necks(&found) && found.largest_strain_rate < 400.0,
            "{speed} m/min: {}",
            found.largest_strain_rate
        );
    }
    let found = polyester(5000, &[]);
    assert!(
        necks(&found) && (600.0..1000.0).contains(&found.largest_strain_rate),
        "{}",
        found.largest_strain_rate
    );
}

/// `Δn = 1.7e-6 K/Pa N_1/T` of polyester: T. Kikutani and others, Polymer Engineering & Science, 1999, the abstract.
#[test]
fn published_stress_optical_law_of_polyester() {
    for speed in [1500, 3000, 5000] {
        let found = polyester(speed, &[]);
        let law = 1.7e-6 * found.solidification.stress / found.solidification.temperature;
        assert!((found.birefringence / law - 1.0).abs() < 1e-9, "{} for {law}", found.birefringence);
    }
}

/// Polyamide 6 begins to crystallise on the line between 2500 and 3500 m/min, as two measurements have it.
#[test]
fn published_onset_of_polyamide() {
    let by = |speed| {
        let set = [("spinline.take_up_speed", speed), ("spinline.crystallisation", "true")];
        solve("tests/spinline_cases/pa6_4000.toml", &set).solidification.by
    };
    assert_eq!(
        ["2500 m/min", "3500 m/min"].map(by),
        [SolidificationCause::Temperature, SolidificationCause::Crystallisation]
    );
}
