//! The feed.

use super::super::Key;
use super::super::row::{Access, FED, line, number, quantity, without_spinline};
use super::super::value::Sign::Positive;
use super::super::value::Value;
use crate::units::Dimension;

pub(super) const KEYS: &[Key] = &[quantity("feed.speed", Dimension::Velocity, Positive)
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
    // From coiling threads to the fastest spinning.
    .usual(1e-3, 200.0)
    .meaning(
        "Speed at which the fibre is fed at the inlet, along its direction: the spinning speed. The fibre \
         is then laid down on a belt.",
    )
    .synonyms(&["filament speed", "draw-off speed"])
    .label("Feed speed *v*_{f}")
    .slider(1.0, 100.0)];
