//! Spinlines for tests, as a user would write them.

use spunlaid::drag::FrictionLaw;
use spunlaid::input::{Change, Influence};
use spunlaid::spinline::{AirTable, Curtain, Melt, Polymer, Solution, Spinline, Surroundings};

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
    Spinline { curtain: Some(Curtain { rows: 10, filaments_per_metre: 250.0 }), ..spinline() }
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
    let one = |key, label: &'static str, change, diameter: f64| Influence {
        key,
        label,
        change,
        diameter,
        speed: -2.0 * diameter,
    };
    vec![
        one(
            "spinline.velocity_factor",
            "Air velocity along the thread, from 10 m/s",
            Change::Relative,
            -0.78,
        ),
        one("spinline.throughput", "Throughput", Change::Relative, 0.43),
        one("drag.friction_coefficient", "Friction coefficient *β*", Change::Relative, -0.30),
        one("spinline.melt_flow_rate", "Melt flow rate", Change::Relative, -0.27),
        one("spinline.die_temperature", "Die temperature", Change::TenKelvin, -0.057),
        one("spinline.temperature_offset", "Air temperature", Change::TenKelvin, -0.018),
        one("spinline.material.freezing_temperature", "Freezing temperature", Change::TenKelvin, 0.006),
        one("spinline.hole_diameter", "Hole diameter", Change::Relative, 0.14),
    ]
}
