//! The air along the spinline: a table, a field, or numbers.

use super::{spinline, spun};
use crate::case::keys::Key;
use crate::case::keys::row::{Access, file, key, number, quantity, read_with_case, switch};
use crate::case::keys::value::Sign::{Any, NotNegative, Positive};
use crate::case::keys::value::{Content, DataFile, Kind, Value};
use crate::spinline::Surroundings;
use spunlaid_ground::{Dimension, Fault};

/// Access to a number of the air that is the same along the whole line.
macro_rules! of_air {
    ($field:ident) => {
        within!(
            |case| &case.spinline.as_ref()?.air,
            &mut spinline(case)?.air,
            Surroundings::Uniform(air) => air.$field,
            Fault::excludes("spinline.profile or spinline.field", "these give the air; leave it out")
        )
    };
}

/// Access to a change of the air of a table or a field.
macro_rules! of_air_change {
    ($field:ident, $pattern:pat, $needed:literal, $instead:literal) => {
        Access {
            get: |case| {
                let line = case.spinline.as_ref()?;
                matches!(line.air, $pattern).then_some(Value::Number(line.air_change.$field))
            },
            set: |case, value| {
                let line = spinline(case)?;
                if !matches!(line.air, $pattern) {
                    return Err(Fault::needs($needed, concat!("change ", $instead)));
                }
                line.air_change.$field = number(value)?;
                Ok(())
            },
        }
    };
}

pub(super) const KEYS: &[Key] = &[
    file("spinline.profile", DataFile::SpinlineAir)
        .access(Access {
            get: |case| match &case.spinline.as_ref()?.air {
                Surroundings::Table(table) => Some(Content::SpinlineAir(table.clone()).into()),
                _ => None,
            },
            set: |case, value| {
                let Value::Content(Content::SpinlineAir(table)) = value else {
                    return Err(read_with_case());
                };
                spinline(case)?.air = Surroundings::Table(table.clone());
                Ok(())
            },
        })
        .gives("spinline.")
        .follows("the same air everywhere")
        .meaning(
            "Table of the air over the distance from the die: `z_mm`, `velocity_m_s` along the filament, \
             `cross_velocity_m_s`, `temperature_c`.",
        ),
    key("spinline.field", Kind::Switch)
        .access(Access {
            get: |case| {
                Some(Value::from_switch(matches!(case.spinline.as_ref()?.air, Surroundings::Field { .. })))
            },
            set: |case, value| {
                let line = spinline(case)?;
                match (switch(value)?, &line.air) {
                    (true, Surroundings::Uniform(air)) => {
                        line.air =
                            Surroundings::Field { temperature: air.temperature, table: Default::default() };
                    }
                    (true, Surroundings::Table(_)) => {
                        let remedy = "both give the air along the line; leave one out";
                        return Err(Fault::excludes("spinline.profile", remedy));
                    }
                    _ => {}
                }
                Ok(())
            },
        })
        .value("false")
        .meaning(
            "Whether the velocity along the line is that of `air.field`, upstream of the inlet. The \
             temperature is `spinline.temperature`.",
        ),
    quantity("spinline.velocity", Dimension::Velocity, Any, (1e-3, 340.0))
        .access(of_air!(velocity))
        .value("0 m/s")
        .meaning("Velocity of the air along the filament, downwards, if it is the same everywhere.")
        .label("Air velocity along the filament *u*")
        .slider(0.0, 100.0),
    quantity("spinline.cross_velocity", Dimension::Velocity, NotNegative, (1e-3, 50.0))
        .access(of_air!(cross_velocity))
        .value("0 m/s")
        .meaning("Velocity of the quench air across the filament, if it is the same everywhere.")
        .label("Quench velocity *v*_{c}")
        .slider(0.0, 3.0),
    quantity("spinline.temperature", Dimension::Temperature, Positive, (233.15, 673.15))
        .access(Access {
            get: |case| match &case.spinline.as_ref()?.air {
                Surroundings::Uniform(air) => Some(Value::Number(air.temperature)),
                Surroundings::Field { temperature, .. } => Some(Value::Number(*temperature)),
                _ => None,
            },
            set: |case, value| {
                match &mut spinline(case)?.air {
                    Surroundings::Uniform(air) => air.temperature = number(value)?,
                    Surroundings::Field { temperature, table } => {
                        *temperature = number(value)?;
                        table.temperature.fill(*temperature);
                    }
                    _ => {
                        let remedy =
                            "the table gives the air; leave it out, or write spinline.temperature_offset";
                        return Err(Fault::excludes("spinline.profile", remedy));
                    }
                }
                Ok(())
            },
        })
        .value("20 °C")
        .meaning("Temperature of the air, if it is the same everywhere.")
        .label("Air temperature *T*_{a}")
        .slider(273.15, 373.15),
    key("spinline.follows_air", Kind::Switch)
        .access(at!(spun, spinline, air_change.follows_air))
        .value("false")
        .meaning(
            "Whether a factor on the profile, instead of `velocity_factor`, makes it end with the velocity of `air` \
             at the simulated fibre. Cabin pressure and air speed then change the whole spinline.",
        ),
    quantity("spinline.velocity_factor", Dimension::Ratio, NotNegative, (0.1, 10.0))
        .access(Access {
            get: |case| {
                let line = case.spinline.as_ref()?;
                let has_one = matches!(line.air, Surroundings::Table(_) | Surroundings::Field { .. });
                let is_own = has_one && !line.air_change.follows_air;
                is_own.then_some(Value::Number(line.air_change.velocity_factor))
            },
            set: |case, value| {
                let line = spinline(case)?;
                if line.air_change.follows_air {
                    let remedy =
                        "the air at the slot gives it; change air.cabin_pressure or air.speed_factor";
                    return Err(Fault::excludes("spinline.follows_air = true", remedy));
                }
                if !matches!(line.air, Surroundings::Table(_) | Surroundings::Field { .. }) {
                    let needed = "spinline.profile or spinline.field";
                    return Err(Fault::needs(needed, "change spinline.velocity"));
                }
                line.air_change.velocity_factor = number(value)?;
                Ok(())
            },
        })
        .read_after(&["spinline.follows_air"])
        .value("1.0")
        .meaning(
            "Factor on the velocity along the filament of a profile or a field: more or less drawing air.",
        )
        .label("Air velocity along the filament *u*, factor")
        .slider(0.2, 2.0),
    quantity("spinline.cross_velocity_factor", Dimension::Ratio, NotNegative, (0.1, 10.0))
        .access(of_air_change!(
            cross_velocity_factor,
            Surroundings::Table(_) | Surroundings::Field { .. },
            "spinline.profile or spinline.field",
            "spinline.cross_velocity"
        ))
        .value("1.0")
        .meaning(
            "Factor on the velocity across the filament of a profile or a field: more or less quench air.",
        )
        .label("Quench velocity *v*_{c}, factor")
        .slider(0.2, 3.0),
    quantity("spinline.temperature_offset", Dimension::TemperatureDifference, Any, (0.1, 200.0))
        .access(of_air_change!(
            temperature_offset,
            Surroundings::Table(_),
            "spinline.profile",
            "spinline.temperature"
        ))
        .value("0 K")
        .meaning("Added to the temperatures of `spinline.profile`: warmer or colder air.")
        .label("Air temperature *T*_{a}, change")
        .slider(0.0, 60.0),
];
