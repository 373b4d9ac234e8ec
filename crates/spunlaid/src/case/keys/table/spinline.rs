//! The spinline and the constants of its polymer.

use super::super::row::{
    Access, change, choose, file, key, named, number, quantity, read_with_case, switch, text, whole,
};
use super::super::value::Sign::{Any, NotNegative, Positive, Share};
use super::super::value::{Content, FileKind, Kind, Value};
use super::super::{FLOWN, Key};
use crate::case::Case;
use crate::error::Fault;
use crate::spinline::{Curtain, End, Law, Melt, Polymer, PolymerSource, Spinline, Surroundings};
use crate::units::Dimension;

/// Most rows of a curtain.
const MOST_ROWS: u64 = 1000;

/// Access to a number of the spinline: `of_spinline!(throughput)`.
macro_rules! of_spinline {
    ($($field:ident).+) => {
        Access {
            get: |case| known(case.spinline.as_ref()?.$($field).+),
            set: |case, value| {
                spinline(case)?.$($field).+ = number(value)?;
                Ok(())
            },
        }
    };
}

/// Access to a switch of the spinline.
macro_rules! spinline_switch {
    ($field:ident) => {
        Access {
            get: |case| Some(Value::from_switch(case.spinline.as_ref()?.$field)),
            set: |case, value| {
                spinline(case)?.$field = switch(value)?;
                Ok(())
            },
        }
    };
}

/// Access to a number of the air that is the same along the whole line.
macro_rules! of_air {
    ($field:ident) => {
        Access {
            get: |case| match &case.spinline.as_ref()?.air {
                Surroundings::Uniform(air) => Some(Value::Number(air.$field)),
                _ => None,
            },
            set: |case, value| match &mut spinline(case)?.air {
                Surroundings::Uniform(air) => {
                    air.$field = number(value)?;
                    Ok(())
                }
                _ => Err(Fault::excludes(
                    "spinline.profile or spinline.field",
                    "these give the air; leave it out",
                )),
            },
        }
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

/// A constant of the polymer.
macro_rules! constant {
    ($name:literal, $dimension:ident, $sign:ident, $($field:ident).+) => {
        quantity(
            concat!("spinline.material.", $name),
            Dimension::$dimension,
            $sign,
            of_spinline!(material.$($field).+),
        )
        .follows("that of the polymer")
    };
}

pub(super) const KEYS: &[Key] = &[
    file("spinline.polymer", FileKind::Polymer, Access {
        get: |case| {
            Some(match &case.spinline.as_ref()?.polymer {
                PolymerSource::Known(polymer) => polymer.name().into(),
                PolymerSource::File(file) => Content::Polymer(file.clone()).into(),
            })
        },
        set: |case, value| {
            let line = spinline(case)?;
            if let Value::Content(Content::Polymer(file)) = value {
                (line.material, line.polymer) = (file.material, PolymerSource::File(file.clone()));
                return Ok(());
            }
            let polymer = named(value, &Polymer::ALL, |one| one.name()).map_err(|_| read_with_case())?;
            line.material = polymer.material(line.crystallisation);
            line.polymer = PolymerSource::Known(polymer);
            Ok(())
        },
    })
    .required("\"pp\"")
    .told(no_spinline)
    .meaning(
        "The polymer: one of these, or a file with the table [spinline.material] and all of its constants. Each constant can \
         be given in [spinline.material] too.",
    )
    .label("Polymer")
    .varies(),
    quantity("spinline.melt_flow_rate", Dimension::Ratio, Positive, Access {
        get: |case| match case.spinline.as_ref()?.melt {
            Melt::FlowRate(rate) => Some(Value::Number(rate)),
            Melt::Viscosity => None,
        },
        set: |case, value| {
            spinline(case)?.melt = Melt::FlowRate(number(value)?);
            Ok(())
        },
    })
    .follows("the viscosity of the polymer")
    .usual(0.5, 3000.0)
    .meaning(
        "Melt flow rate of the grade in g/10 min, load 2.16 kg, at `spinline.material.viscosity_temperature`. It gives the \
         viscosity, within some 20 %; `spinline.material.viscosity` may be written instead.",
    )
    .label("Melt flow rate [g/10 min]")
    .slider(5.0, 100.0),
    quantity("spinline.die_temperature", Dimension::Temperature, Positive, of_spinline!(die_temperature))
        .required("230 °C")
        .told(no_spinline)
        .usual(373.15, 723.15)
        .meaning("Temperature of the melt in the hole.")
        .label("Die temperature")
        .slider(453.15, 573.15),
    quantity("spinline.hole_diameter", Dimension::Length, Positive, of_spinline!(hole_diameter))
        .required("0.6 mm")
        .told(no_spinline)
        .usual(5e-5, 3e-3)
        .meaning("Diameter of the hole of the spinneret.")
        .label("Hole diameter"),
    quantity("spinline.die_swell", Dimension::Ratio, Positive, of_spinline!(die_swell))
        .value("1.0")
        .usual(0.8, 3.0)
        .meaning("Diameter of the thread below the die over that of the hole.")
        .label("Die swell"),
    quantity("spinline.throughput", Dimension::MassFlow, Positive, of_spinline!(throughput))
        .required("0.5 g/min")
        .told(no_spinline)
        .usual(1e-8, 1e-3)
        .meaning("Mass flow of a hole: g/min, kg/h, g/s or kg/s.")
        .label("Throughput of a hole")
        .slider(1e-6, 3e-5),
    quantity("spinline.length", Dimension::Length, Positive, of_spinline!(length))
        .required("1.6 m")
        .told(no_spinline)
        .usual(0.02, 30.0)
        .meaning("Length of the spinline, from the die to the inlet at which the flown fibre begins, or to the take-up.")
        .label("Length of the spinline"),
    file("spinline.profile", FileKind::SpinlineAir, Access {
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
    .follows("the same air everywhere")
    .meaning(
        "Table of the air over the distance from the die: `z_mm`, `velocity_m_s` along the thread, `cross_velocity_m_s`, \
         `temperature_c`.",
    ),
    key("spinline.field", Kind::Switch, Access {
        get: |case| Some(Value::from_switch(matches!(case.spinline.as_ref()?.air, Surroundings::Field { .. }))),
        set: |case, value| {
            let line = spinline(case)?;
            match (switch(value)?, &line.air) {
                (true, Surroundings::Uniform(air)) => {
                    line.air = Surroundings::Field { temperature: air.temperature, table: Default::default() };
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
        "Whether the velocity along the line is that of `air.field`, upstream of the inlet. The temperature is \
         `spinline.temperature`.",
    ),
    quantity("spinline.velocity", Dimension::Velocity, Any, of_air!(velocity))
        .value("0 m/s")
        .usual(1e-3, 340.0)
        .meaning("Velocity of the air along the thread, downwards, if it is the same everywhere.")
        .label("Air velocity along the thread *u*")
        .slider(0.0, 100.0),
    quantity("spinline.cross_velocity", Dimension::Velocity, NotNegative, of_air!(cross_velocity))
        .value("0 m/s")
        .usual(1e-3, 50.0)
        .meaning("Velocity of the quench air across the thread, if it is the same everywhere.")
        .label("Quench velocity *v*_{c}")
        .slider(0.0, 3.0),
    quantity("spinline.temperature", Dimension::Temperature, Positive, Access {
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
                    let remedy = "the table gives the air; leave it out, or write spinline.temperature_offset";
                    return Err(Fault::excludes("spinline.profile", remedy));
                }
            }
            Ok(())
        },
    })
    .value("20 °C")
    .usual(233.15, 673.15)
    .meaning("Temperature of the air, if it is the same everywhere.")
    .label("Air temperature *T*_{a}")
    .slider(273.15, 373.15),
    quantity("spinline.velocity_factor", Dimension::Ratio, NotNegative, of_air_change!(
        velocity_factor,
        Surroundings::Table(_) | Surroundings::Field { .. },
        "spinline.profile or spinline.field",
        "spinline.velocity"
    ))
    .value("1.0")
    .usual(0.1, 10.0)
    .meaning("Factor on the velocity along the thread of `spinline.profile` or of the field: more or less drawing air.")
    .label("Air velocity *u*, factor")
    .slider(0.2, 2.0),
    quantity("spinline.cross_velocity_factor", Dimension::Ratio, NotNegative, of_air_change!(
        cross_velocity_factor,
        Surroundings::Table(_) | Surroundings::Field { .. },
        "spinline.profile or spinline.field",
        "spinline.cross_velocity"
    ))
    .value("1.0")
    .usual(0.1, 10.0)
    .meaning("Factor on the velocity across the thread of `spinline.profile` or of the field: more or less quench air.")
    .label("Quench velocity *v*_{c}, factor")
    .slider(0.2, 3.0),
    quantity("spinline.temperature_offset", Dimension::TemperatureDifference, Any, of_air_change!(
        temperature_offset,
        Surroundings::Table(_),
        "spinline.profile",
        "spinline.temperature"
    ))
    .value("0 K")
    .usual(0.1, 200.0)
    .meaning("Added to the temperatures of `spinline.profile`: warmer or colder air.")
    .label("Air temperature *T*_{a}, change")
    .slider(0.0, 60.0),
    choose("spinline.end", || END.to_vec(), Access {
        get: |case| {
            Some(match case.spinline.as_ref()?.end {
                End::Tension(_) | End::Flown(_) => END[0].into(),
                End::TakeUp(_) => END[1].into(),
            })
        },
        set: |case, value| {
            change(&mut spinline(case)?.end, value, &[End::Tension(0.0), End::TakeUp(f64::NAN)], |end| match end {
                End::Tension(_) | End::Flown(_) => END[0],
                End::TakeUp(_) => END[1],
            })
        },
    })
    .value("free")
    .meaning(
        "What is known at the end of the line: `free`, the tension (that of a fibre which flies on in the air), or `take-up`, \
         the speed of a godet.",
    )
    .label("End of the spinline"),
    quantity("spinline.take_up_speed", Dimension::Velocity, Positive, Access {
        get: |case| match case.spinline.as_ref()?.end {
            End::TakeUp(speed) => known(speed),
            End::Tension(_) | End::Flown(_) => None,
        },
        set: |case, value| match &mut spinline(case)?.end {
            End::TakeUp(speed) => {
                *speed = number(value)?;
                Ok(())
            }
            End::Tension(_) | End::Flown(_) => Err(Fault::needs("spinline.end = \"take-up\"", "leave it out, or write this line too")),
        },
    })
    .follows("a free end")
    .usual(0.1, 200.0)
    .meaning("Speed at which a godet takes the filament up.")
    .label("Take-up speed")
    .slider(1.0, 100.0),
    quantity("spinline.end_tension", Dimension::Force, Any, Access {
        get: |case| match case.spinline.as_ref()?.end {
            End::Tension(tension) | End::Flown(tension) => Some(Value::Number(tension)),
            End::TakeUp(_) => None,
        },
        set: |case, value| {
            let line = spinline(case)?;
            if let End::TakeUp(_) = line.end {
                return Err(Fault::excludes("spinline.end = \"take-up\"", "the speed is given; leave it out"));
            }
            line.end = match value {
                Value::Text(word) if word == FLOWN => End::Flown(0.0),
                value => End::Tension(number(value)?),
            };
            Ok(())
        },
    })
    .value("0 N")
    .usual(1e-9, 1.0)
    .meaning(
        "Tension at a free end: the pull of the fibre that flies on below the line. With \"flown\" some fibres fly, their mean tension at \
         the root is fed back, and they fly again until the speed stands within 0.1 %; the result says which tension it was.",
    )
    .label("Tension at the end"),
    choose("spinline.law", || Law::ALL.map(Law::name).to_vec(), Access {
        get: |case| Some(case.spinline.as_ref()?.law.name().into()),
        set: |case, value| {
            spinline(case)?.law = named(value, &Law::ALL, |law| law.name())?;
            Ok(())
        },
    })
    .value("newtonian")
    .meaning(
        "How the melt resists stretching: as a Newtonian liquid, or viscoelastic by Giesekus (with `modulus` and `mobility` of \
         [spinline.material]) or Phan-Thien–Tanner (with `modulus` and `extensibility`).",
    )
    .label("Law of the melt"),
    key("spinline.crystallisation", Kind::Switch, Access {
        get: |case| Some(Value::from_switch(case.spinline.as_ref()?.crystallisation)),
        set: |case, value| {
            let (line, crystallises) = (spinline(case)?, switch(value)?);
            if crystallises != line.crystallisation
                && let PolymerSource::Known(polymer) = line.polymer
            {
                let [before, after] =
                    [line.crystallisation, crystallises].map(|flag| polymer.material(flag).freezing_temperature);
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
        "Whether crystallisation on the way is computed. Its enhancement by orientation was chosen and not measured, so that \
         places of crystallisation are no predictions.",
    )
    .label("Crystallisation")
    .varies(),
    quantity("spinline.emissivity", Dimension::Ratio, Share, of_spinline!(emissivity))
        .value("0.0")
        .usual(0.01, 1.0)
        .meaning("Emissivity of the thread, from 0, which leaves radiation out, to 1.")
        .label("Emissivity *ε*"),
    key("spinline.dissipation", Kind::Switch, spinline_switch!(dissipation))
        .value("false")
        .meaning("Whether the work of stretching heats the thread.")
        .label("Dissipation")
        .varies(),
    quantity("spinline.nusselt_factor", Dimension::Ratio, Positive, of_spinline!(nusselt_factor))
        .value("1.0")
        .usual(0.2, 5.0)
        .meaning("Factor on the Nusselt number of Kase and Matsuo. Measurements leave a doubt of some 20 %.")
        .label("Factor on the Nusselt number")
        .slider(0.5, 1.5),
    quantity("spinline.break_stress", Dimension::Pressure, Positive, of_spinline!(break_stress))
        .follows("no limit, because none is known well enough")
        .usual(1e5, 1e9)
        .meaning("Stress at which the thread breaks. A line in which it is reached is refused.")
        .label("Stress at break"),
    key("spinline.rows", Kind::Whole(1, MOST_ROWS), Access {
        get: |case| Some(Value::Whole(case.spinline.as_ref()?.curtain?.rows)),
        set: |case, value| {
            let rows = whole(value)?;
            curtain(case)?.rows = rows;
            Ok(())
        },
    })
    .follows("one filament in the air as it is given")
    .meaning(
        "Number of rows of holes that the quench air crosses one after another: each row meets the air that the one before has \
         warmed and dragged. The first row gives the flown fibre.",
    )
    .label("Rows of holes")
    .varies(),
    quantity("spinline.filaments_per_metre_and_row", Dimension::Ratio, Positive, Access {
        get: |case| known(case.spinline.as_ref()?.curtain?.filaments_per_metre),
        set: |case, value| {
            let filaments = number(value)?;
            curtain(case)?.filaments_per_metre = filaments;
            Ok(())
        },
    })
    .follows("one filament in the air as it is given")
    .usual(1.0, 1e5)
    .meaning("Filaments per metre of width in each row of holes.")
    .label("Filaments per metre and row"),
];

/// The constants of the polymer.
pub(super) const MATERIAL: &[Key] = &[
    key("spinline.material.source", Kind::Text("data sheet of the grade, 2024"), Access {
        get: |case| case.spinline.as_ref()?.source.clone().map(Value::Text),
        set: |case, value| {
            spinline(case)?.source = Some(text(value)?);
            Ok(())
        },
    })
    .follows("that of the polymer")
    .meaning("Where the constants come from, in your words. A file with a polymer needs it."),
    quantity("spinline.material.viscosity", Dimension::DynamicViscosity, Positive, Access {
        get: |case| {
            let line = case.spinline.as_ref()?;
            if line.melt == Melt::Viscosity { known(line.material.viscosity) } else { None }
        },
        set: |case, value| {
            let line = spinline(case)?;
            (line.material.viscosity, line.melt) = (number(value)?, Melt::Viscosity);
            Ok(())
        },
    })
        .follows("that of the polymer, or that of the melt flow rate")
        .usual(0.1, 100000.0)
        .meaning("Viscosity of the melt at `viscosity_temperature` and at low rates. It depends on the grade.")
        .label("Viscosity *η*_{r}"),
    constant!("viscosity_temperature", Temperature, Positive, viscosity_temperature)
        .usual(373.15, 723.15)
        .meaning("Temperature at which `viscosity` or the melt flow rate was measured.")
        .label("Reference temperature *T*_{r}"),
    constant!("activation_energy", MolarEnergy, NotNegative, activation_energy)
        .usual(1000.0, 1000000.0)
        .meaning("Activation energy of the viscosity, by which it changes with the temperature (Arrhenius).")
        .label("Activation energy *E*_{a}"),
    constant!("freezing_temperature", Temperature, Positive, freezing_temperature)
        .usual(200.0, 600.0)
        .meaning("Temperature at which the thread is solid.")
        .label("Freezing temperature *T*_{s}"),
    constant!("solid_density", Density, Positive, solid_density)
        .usual(500.0, 3000.0)
        .meaning("Density of the cold filament.")
        .label("Density of the solid"),
    constant!("surface_tension", SurfaceTension, NotNegative, surface_tension)
        .usual(0.001, 0.5)
        .meaning("Surface tension of the melt; zero leaves it out.")
        .label("Surface tension *σ*"),
    constant!("modulus", Pressure, Positive, modulus)
        .usual(100.0, 100000000.0)
        .meaning("Elastic modulus G of the melt, for the viscoelastic laws.")
        .label("Modulus of the melt *G*"),
    constant!("mobility", Ratio, Share, mobility)
        .usual(0.001, 1.0)
        .meaning("Mobility α of the Giesekus law, from 0 to 1.")
        .label("Mobility *α*"),
    constant!("extensibility", Ratio, NotNegative, extensibility)
        .usual(0.0001, 1.0)
        .meaning("Parameter ε of the Phan-Thien–Tanner laws.")
        .label("Extensibility *ε*"),
    constant!("heat_capacity", HeatCapacity, Positive, heat_capacity)
        .usual(200.0, 10000.0)
        .meaning("Heat capacity of the melt at 0 °C, extrapolated.")
        .label("Heat capacity *c*_{0}"),
    constant!("heat_capacity_slope", HeatCapacitySlope, Any, heat_capacity_slope)
        .usual(0.01, 50.0)
        .meaning("Rise of the heat capacity with the temperature.")
        .label("Slope of the heat capacity *c*_{1}"),
    constant!("specific_volume", SpecificVolume, Positive, specific_volume)
        .usual(0.0001, 0.01)
        .meaning("Specific volume of the melt at 0 °C, extrapolated.")
        .label("Specific volume *a*_{0}"),
    constant!("specific_volume_slope", SpecificVolumeSlope, Any, specific_volume_slope)
        .usual(1e-08, 1e-05)
        .meaning("Rise of the specific volume with the temperature.")
        .label("Slope of the specific volume *a*_{1}"),
    constant!("stress_optical_coefficient", InversePressure, NotNegative, stress_optical_coefficient)
        .usual(1e-11, 1e-07)
        .meaning("Stress-optical coefficient C of the melt: the birefringence is C times the stress.")
        .label("Stress-optical coefficient"),
    constant!("full_birefringence", Ratio, Positive, full_birefringence)
        .usual(0.001, 1.0)
        .meaning("Birefringence of the fully oriented polymer.")
        .label("Birefringence of full orientation"),
    constant!("unoriented_modulus", Pressure, Positive, unoriented_modulus)
        .usual(10000000.0, 1000000000000.0)
        .meaning("Young's modulus of the solid filament without orientation, from which the modulus is estimated.")
        .label("Young’s modulus without orientation *E*_{0}"),
    constant!("oriented_modulus", Pressure, Positive, oriented_modulus)
        .usual(10000000.0, 1000000000000.0)
        .meaning("Young's modulus of the solid filament with full orientation.")
        .label("Young’s modulus with full orientation *E*_{1}"),
    constant!("avrami_exponent", Ratio, Positive, crystals.avrami_exponent)
        .usual(0.5, 5.0)
        .meaning("Exponent n of Nakamura's law.")
        .label("Avrami exponent *n*"),
    constant!("crystallisation_rate", Rate, NotNegative, crystals.rate)
        .usual(0.0001, 100.0)
        .meaning("Largest rate of crystallisation without orientation.")
        .label("Crystallisation rate *K*_{m}"),
    constant!("crystallisation_peak", Temperature, Positive, crystals.peak)
        .usual(200.0, 600.0)
        .meaning("Temperature of the largest rate of crystallisation.")
        .label("Temperature of the largest rate *T*_{m}"),
    constant!("crystallisation_width", TemperatureDifference, Positive, crystals.width)
        .usual(1.0, 300.0)
        .meaning("Half width of the rate's bell over the temperature.")
        .label("Half width *D*"),
    constant!("melting_temperature", Temperature, Positive, crystals.melting_temperature)
        .usual(200.0, 700.0)
        .meaning("Melting temperature, above which nothing crystallises.")
        .label("Melting temperature *T*_{f}"),
    constant!("crystallinity", Ratio, Share, crystals.crystallinity)
        .usual(0.01, 1.0)
        .meaning("Crystallinity of the fully transformed polymer.")
        .label("Crystallinity *X*_{∞}"),
    constant!("heat_of_fusion", SpecificEnergy, NotNegative, crystals.heat_of_fusion)
        .usual(1000.0, 1000000.0)
        .meaning("Heat of fusion of the crystals.")
        .label("Heat of fusion Δ*H*"),
    constant!("orientation_enhancement", Ratio, NotNegative, crystals.orientation_enhancement)
        .usual(1.0, 100000.0)
        .meaning("Factor C by which orientation speeds crystallisation up, exp(C f²). It was chosen; no measured value is known.")
        .label("Enhancement by orientation *C*"),
    constant!("enhancement_limit", Ratio, Positive, crystals.enhancement_limit)
        .usual(1.0, 100000000.0)
        .meaning("Largest enhancement by orientation. It was chosen.")
        .label("Largest enhancement *M*"),
    constant!("hardening_factor", Ratio, NotNegative, crystals.hardening_factor)
        .usual(0.1, 100.0)
        .meaning("Factor a of the viscosity's rise by crystals, exp(a θ^b). It was chosen.")
        .label("Hardening *a*"),
    constant!("hardening_exponent", Ratio, Positive, crystals.hardening_exponent)
        .usual(0.1, 10.0)
        .meaning("Exponent b of the viscosity's rise by crystals. It was chosen.")
        .label("Exponent of the hardening *b*"),
    constant!("freezing_share", Ratio, Share, crystals.freezing_share)
        .usual(0.001, 1.0)
        .meaning("Transformed share at which the thread is solid. It was chosen.")
        .label("Share at freezing *θ*_{s}"),
];

/// The words of `spinline.end`.
const END: [&str; 2] = ["free", "take-up"];

fn no_spinline(case: &Case) -> bool {
    case.spinline.is_none()
}

/// A number that is known.
fn known(number: f64) -> Option<Value> {
    number.is_finite().then_some(Value::Number(number))
}

fn spinline(case: &mut Case) -> Result<&mut Spinline, Fault> {
    let remedy = "leave it out, or describe the spinline";
    case.spinline.as_deref_mut().ok_or_else(|| Fault::needs("[spinline]", remedy))
}

fn curtain(case: &mut Case) -> Result<&mut Curtain, Fault> {
    let unknown = Curtain { rows: 1, filaments_per_metre: f64::NAN };
    Ok(spinline(case)?.curtain.get_or_insert(unknown))
}
