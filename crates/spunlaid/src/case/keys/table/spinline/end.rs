//! What is known at the end of the spinline.

use super::access::{known, spinline};
use crate::case::keys::row::{Access, change, choose, number, quantity};
use crate::case::keys::value::Sign::{Any, Positive};
use crate::case::keys::value::Value;
use crate::case::keys::{FLOWN, Key};
use crate::error::Fault;
use crate::spinline::End;
use crate::units::Dimension;

/// The words of `spinline.end`.
const END: [&str; 2] = ["free", "take-up"];

pub(super) const KEYS: &[Key] = &[
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
        .meaning(
            "What is known at the end of the line: `free`, the tension (that of a fibre which flies on in \
             the air), or `take-up`, the speed of a godet.",
        )
        .label("End of the spinline"),
    quantity("spinline.take_up_speed", Dimension::Velocity, Positive)
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
        .usual(0.1, 200.0)
        .meaning("Speed at which a godet takes the filament up.")
        .label("Take-up speed")
        .slider(1.0, 100.0),
    quantity("spinline.end_tension", Dimension::Force, Any)
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
        .usual(1e-9, 1.0)
        .meaning(
            "Tension at a free end: the pull of the fibre that flies on below the line. With \"flown\" \
             some fibres fly, their mean tension at the root is fed back, and they fly again until the \
             speed stands within 0.1 %; the result says which tension it was.",
        )
        .label("Tension at the end"),
];
