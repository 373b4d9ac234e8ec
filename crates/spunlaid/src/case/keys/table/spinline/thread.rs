//! What the thread does on its way: how the melt stretches, freezes, cools and breaks.

use super::access::{of_spinline, spinline, spun};
use crate::case::keys::Key;
use crate::case::keys::row::{Access, choose, key, quantity, switch};
use crate::case::keys::value::Sign::{Positive, Share};
use crate::case::keys::value::{Kind, Value};
use crate::spinline::{Law, PolymerSource};
use crate::units::Dimension;

named_fields!(Law);

pub(super) const KEYS: &[Key] = &[
    choose("spinline.law", || Law::ALL.map(Law::name).to_vec())
        .access(at!(spun, spinline, law))
        .value("newtonian")
        .meaning(
            "How the melt resists stretching: as a Newtonian liquid, or viscoelastic by Giesekus (with \
             `modulus` and `mobility` of [spinline.material]) or Phan-Thien–Tanner (with `modulus` and \
             `extensibility`).",
        )
        .label("Law of the melt"),
    key("spinline.crystallisation", Kind::Switch)
        .access(Access {
            get: |case| Some(Value::from_switch(case.spinline.as_ref()?.crystallisation)),
            set: |case, value| {
                let (line, crystallises) = (spinline(case)?, switch(value)?);
                if crystallises != line.crystallisation
                    && let PolymerSource::Known(polymer) = line.polymer
                {
                    let [before, after] = [line.crystallisation, crystallises]
                        .map(|flag| polymer.material(flag).freezing_temperature);
                    if line.material.freezing_temperature == before {
                        line.material.freezing_temperature = after;
                    }
                }
                line.crystallisation = crystallises;
                Ok(())
            },
        })
        .value("false")
        .meaning(
            "Whether crystallisation on the way is computed. Its enhancement by orientation was chosen and \
             not measured, so that places of crystallisation are no predictions.",
        )
        .label("Crystallisation")
        .varies(),
    quantity("spinline.emissivity", Dimension::Ratio, Share)
        .access(of_spinline!(emissivity))
        .value("0.0")
        .usual(0.01, 1.0)
        .meaning("Emissivity of the thread, from 0, which leaves radiation out, to 1.")
        .label("Emissivity *ε*"),
    key("spinline.dissipation", Kind::Switch)
        .access(at!(spun, spinline, dissipation))
        .value("false")
        .meaning("Whether the work of stretching heats the thread.")
        .label("Dissipation")
        .varies(),
    quantity("spinline.nusselt_factor", Dimension::Ratio, Positive)
        .access(of_spinline!(nusselt_factor))
        .value("1.0")
        .usual(0.2, 5.0)
        .meaning("Factor on the Nusselt number of Kase and Matsuo. Measurements leave a doubt of some 20 %.")
        .label("Factor on the Nusselt number")
        .slider(0.5, 1.5),
    quantity("spinline.break_stress", Dimension::Pressure, Positive)
        .access(of_spinline!(break_stress))
        .follows("no limit, because none is known well enough")
        .usual(1e5, 1e9)
        .meaning("Stress at which the thread breaks. A line in which it is reached is refused.")
        .label("Stress at break"),
];
