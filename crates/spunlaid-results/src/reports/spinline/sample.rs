//! Spinlines for tests, as a user would write them.

use spunlaid_fibre::spinline::HoleRows;
use spunlaid_fibre::{AirTable, FrictionLaw, Melt, Polymer, Solution, Spinline, Surroundings};
use spunlaid_ground::{Change, ChangedKey, Difference, Dimension, Effect, SensitivityRun, Setting, Turned};
use spunlaid_input::{Influence, OfFilament};

/// Friction between thread and air.
pub const FRICTION: FrictionLaw = FrictionLaw::Matsui { factor: 0.37 };

/// Polypropylene with a free end: quenched from the side, then drawn by air of 70 m/s.
pub fn spinline() -> Spinline {
    let table = AirTable {
        distance: vec![0.0, 0.8, 0.85, 1.0],
        velocity: vec![2.0, 2.0, 2.0, 70.0],
        cross_velocity: vec![1.0, 1.0, 0.0, 0.0],
        temperature: vec![293.15; 4],
    };
    Spinline {
        material: Polymer::Pp.material(false),
        melt: Melt::FlowRate(35.0),
        die_temperature: 503.15,
        hole_diameter: 0.6e-3,
        throughput: 0.5e-3 / 60.0,
        length: 1.6,
        air: Surroundings::Behind(table),
        ..Spinline::UNKNOWN
    }
}

/// The same with ten rows of filaments.
pub fn curtain() -> Spinline {
    Spinline { curtain: Some(HoleRows { rows: 10, filaments_per_metre: 250.0 }), ..spinline() }
}

/// The same with crystals.
pub fn crystallising() -> Spinline {
    Spinline { crystallisation: true, material: Polymer::Pp.material(true), ..spinline() }
}

/// The solution of each row.
pub fn rows(spinline: &Spinline) -> Vec<Solution> {
    spinline.solve_rows(FRICTION).unwrap()
}

/// Influences of both kinds.
pub fn influences() -> Vec<Influence> {
    let one = |name: &'static str, words, by_kelvin, diameter: f64| {
        let (dimension, key) = (Dimension::Ratio, name.to_owned());
        let keys = vec![ChangedKey { key, dimension, whole: false, by_kelvin, from: 1.0, to: 1.1 }];
        let setting = Setting { name, words, turned: Turned::Running };
        let change = Change { setting, layers: Vec::new(), keys, experiment: (), refusal: None };
        let effects = [(OfFilament::Diameter, diameter), (OfFilament::Speed, -2.0 * diameter)]
            .map(|(of, value)| Effect::new(of, Difference::exact(value)));
        SensitivityRun { change, effects: effects.to_vec(), at_first: Vec::new() }
    };
    vec![
        one("spinline.velocity_factor", "Air velocity along the filament, from 10 m/s", false, -0.78),
        one("spinline.throughput", "Throughput", false, 0.43),
        one("drag.friction_coefficient", "Friction coefficient *β*", false, -0.30),
        one("spinline.melt_flow_rate", "Melt flow rate", false, -0.27),
        one("spinline.die_temperature", "Die temperature", true, -0.057),
        one("spinline.temperature_offset", "Air temperature", true, -0.018),
        one("spinline.material.solidification_temperature", "Solidification temperature", true, 0.006),
        one("spinline.hole_diameter", "Hole diameter", false, 0.14),
    ]
}
