//! Feed and belt.

use super::super::Key;
use super::super::row::{Access, FED, choose, fed, line, number, quantity, without_spinline};
use super::super::value::Sign::{NotNegative, Positive};
use super::super::value::Value;
use crate::line::Contact;
use spunlaid_ground::{Dimension, Fault};

named_fields!(Contact);

/// Access to a number of the friction on the belt.
macro_rules! of_friction {
    ($field:ident) => {
        within!(
            |case| &case.line.as_ref()?.contact,
            &mut line(case)?.contact,
            Contact::Friction { $field, .. } => $field,
            Fault::needs(
                "belt.contact = \"friction\"",
                "leave it out, or write this line, with which the fibre slides on the belt"
            )
        )
    };
}

pub(super) const KEYS: &[Key] = &[
    quantity("belt.distance", Dimension::Length, Positive, (0.001, 10.0))
        .access(Access {
            get: |case| Some(Value::Number(case.line?.distance)),
            set: |case, value| {
                let distance = number(value)?;
                let element_length = case.fibre.rest_length();
                line(case)?.distance = distance;
                if element_length.is_finite() {
                    case.fibre.span(distance, element_length);
                } else {
                    case.fibre.length = distance;
                }
                Ok(())
            },
        })
        .needed_if(FED, "0.5 m")
        .follows("a fibre of fixed length")
        .meaning("Distance from the inlet to the belt, along x. The belt lies across x.")
        .synonyms(&["DCD", "die-to-collector distance"])
        .label("Distance to the belt *H*")
        .slider(0.1, 2.0),
    quantity("belt.speed", Dimension::Velocity, NotNegative, (0.0001, 50.0))
        .access(at!(fed, line, belt_speed))
        .needed_if(FED, "3 m/s")
        .follows("a fibre of fixed length")
        .meaning("Speed of the belt, along y, the machine direction.")
        .synonyms(&["line speed", "conveyor speed"])
        .label("Belt speed *v*_{b}")
        .slider(0.0, 10.0),
    choose("belt.contact", || Contact::ALL.map(|contact| contact.name()).to_vec())
        .access(at!(fed, line, contact))
        .value("stick")
        .meaning("Whether the fibre sticks where it touches down, or slides against friction.")
        .label("Contact with the belt"),
    quantity("belt.friction", Dimension::Ratio, NotNegative, (0.001, 3.0))
        .access(of_friction!(coefficient))
        .value("0.3")
        .meaning("Coefficient of the friction between fibre and belt.")
        .label("Friction on the belt *μ*")
        .slider(0.0, 1.0),
    // Up to an atmosphere.
    quantity("belt.suction", Dimension::Pressure, NotNegative, (0.1, 1e5))
        .access(of_friction!(suction))
        .value("200 Pa")
        .meaning(
            "Pressure difference that pulls the fibre onto the belt; times the diameter, a force per length.",
        )
        .label("Suction")
        .slider(0.0, 2000.0),
    quantity("belt.kept_length", Dimension::Length, Positive, (1e-7, 2.0))
        .access(at!(fed, line, kept_length))
        .follows("a quarter of the distance to the belt")
        .meaning("Length of fibre behind the newest touch-down that still moves. Arches behind it stay.")
        .label("Length that still moves on the belt")
        .slider(5e-3, 0.2),
];

// From coiling threads to the fastest spinning.
pub(super) const FEED: &[Key] = &[quantity("feed.speed", Dimension::Velocity, Positive, (1e-3, 200.0))
    .access(Access {
        get: |case| Some(Value::Number(case.line?.feed_speed)),
        set: |case, value| {
            without_spinline(case)?;
            line(case)?.feed_speed = number(value)?;
            Ok(())
        },
    })
    .derived(|case| case.spinline.is_some())
    .needed_if(FED, "50 m/s")
    .follows("a fibre of fixed length")
    .meaning(
        "Speed at which the fibre is fed at the inlet, the spinning speed. The fibre is then laid on a belt.",
    )
    .synonyms(&["filament speed", "draw-off speed"])
    .label("Feed speed *v*_{f}")
    .slider(1.0, 100.0)];
