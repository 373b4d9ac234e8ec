//! What the thread does on its way, how the melt stretches, solidifies, cools and breaks; and what is known at its end.

use super::{known, of_spinline, spinline, spun};
use crate::case::keys::row::{Access, change, choose, key, number, quantity, switch};
use crate::case::keys::value::Sign::{Any, Positive, Share};
use crate::case::keys::value::{Kind, Value};
use crate::case::keys::{FLOWN, Key};
use crate::spinline::{End, Law, PolymerSource};
use spunlaid_ground::{Dimension, Fault};

named_fields!(Law);

pub(super) const KEYS: &[Key] = &[
    choose("spinline.law", || Law::ALL.map(Law::name).to_vec())
        .access(at!(spun, spinline, law))
        .value("newtonian")
        .meaning(
            "Law of the melt: Newtonian, or viscoelastic after Giesekus (`modulus` and `mobility` of \
             [spinline.material]) or Phan-Thien–Tanner (`modulus` and `extensibility`).",
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
                        .map(|flag| polymer.material(flag).solidification_temperature);
                    if line.material.solidification_temperature == before {
                        line.material.solidification_temperature = after;
                    }
                }
                line.crystallisation = crystallises;
                Ok(())
            },
        })
        .value("false")
        .meaning(
            "Whether crystallisation is computed. Its factor for orientation was chosen, not measured, so positions \
             are not predictions.",
        )
        .label("Crystallisation")
        .varies(),
    quantity("spinline.emissivity", Dimension::Ratio, Share, (0.01, 1.0))
        .access(of_spinline!(emissivity))
        .value("0.0")
        .meaning("Emissivity of the filament, from 0, which leaves radiation out, to 1.")
        .label("Emissivity *ε*"),
    key("spinline.dissipation", Kind::Switch)
        .access(at!(spun, spinline, dissipation))
        .value("false")
        .meaning("Whether the work of stretching heats the filament.")
        .label("Dissipation")
        .varies(),
    quantity("spinline.nusselt_factor", Dimension::Ratio, Positive, (0.2, 5.0))
        .access(of_spinline!(nusselt_factor))
        .value("1.0")
        .meaning(
            "Factor on the Nusselt number of Kase and Matsuo. Measurements leave an uncertainty of about 20 %.",
        )
        .label("Factor on the Nusselt number")
        .slider(0.5, 1.5),
    quantity("spinline.drag_factor", Dimension::Ratio, Positive, (0.3, 3.0))
        .access(of_spinline!(drag_factor))
        .value("1.0")
        .meaning(
            "Factor on the drag of the air along the filament, not known for any line: the laws of `drag.along` \
             differ by a factor of 2.4. `spunlaid new --web --die-temperature …` finds it from the measured titre.",
        )
        .synonyms(&["calibration", "titre"])
        .label("Factor on the drag of the spinline")
        .slider(0.3, 3.0),
    quantity("spinline.break_stress", Dimension::Pressure, Positive, (1e5, 1e9))
        .access(of_spinline!(break_stress))
        .follows("no limit, because none is known well enough")
        .meaning("Stress at which the filament breaks; a line that reaches it is rejected.")
        .label("Stress at break"),
];

/// The words of `spinline.end`.
const END: [&str; 2] = ["free", "take-up"];

pub(super) const END_KEYS: &[Key] = &[
    choose("spinline.end", || END.to_vec())
        .access(Access {
            get: |case| {
                Some(match case.spinline.as_ref()?.end {
                    End::Tension(_) | End::Flown(_) => END[0].into(),
                    End::TakeUp(_) => END[1].into(),
                })
            },
            set: |case, value| {
                change(&mut spinline(case)?.end, value, &[End::Tension(0.0), End::TakeUp(f64::NAN)], |end| {
                    match end {
                        End::Tension(_) | End::Flown(_) => END[0],
                        End::TakeUp(_) => END[1],
                    }
                })
            },
        })
        .value("free")
        .meaning("What is given at the end: `free`, the tension, or `take-up`, the speed of a godet.")
        .label("End of the spinline"),
    quantity("spinline.take_up_speed", Dimension::Velocity, Positive, (0.1, 200.0))
        .access(Access {
            get: |case| match case.spinline.as_ref()?.end {
                End::TakeUp(speed) => known(speed),
                End::Tension(_) | End::Flown(_) => None,
            },
            set: |case, value| match &mut spinline(case)?.end {
                End::TakeUp(speed) => {
                    *speed = number(value)?;
                    Ok(())
                }
                End::Tension(_) | End::Flown(_) => {
                    Err(Fault::needs("spinline.end = \"take-up\"", "leave it out, or write this line too"))
                }
            },
        })
        .follows("a free end")
        .meaning("Speed at which a godet takes the filament up.")
        .label("Take-up speed")
        .slider(1.0, 100.0),
    quantity("spinline.end_tension", Dimension::Force, Any, (1e-9, 1.0))
        .access(Access {
            get: |case| match case.spinline.as_ref()?.end {
                End::Tension(tension) => Some(Value::Number(tension)),
                End::Flown(_) => Some(FLOWN.into()),
                End::TakeUp(_) => None,
            },
            set: |case, value| {
                let line = spinline(case)?;
                if let End::TakeUp(_) = line.end {
                    return Err(Fault::excludes(
                        "spinline.end = \"take-up\"",
                        "the speed is given; leave it out",
                    ));
                }
                line.end = match value {
                    Value::Text(word) if word == FLOWN => End::Flown(0.0),
                    value => End::Tension(number(value)?),
                };
                Ok(())
            },
        })
        .value("0 N")
        .or_words(&[FLOWN])
        .meaning(
            "Tension at a free end: the pull of the fibre below it. `\"simulated\"` is the mean tension at the root \
             of simulated fibres, iterated until the speed changes by less than 0.1 %.",
        )
        .label("Tension at the end"),
];
