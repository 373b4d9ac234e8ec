//! The polymer, what flows through a hole, and how far.

use super::access::{no_spinline, of_spinline, spinline};
use crate::case::keys::Key;
use crate::case::keys::row::{Access, file, named, number, quantity, read_with_case};
use crate::case::keys::value::Sign::Positive;
use crate::case::keys::value::{Content, FileKind, Value};
use crate::spinline::{Melt, Polymer, PolymerSource};
use crate::units::Dimension;

pub(super) const KEYS: &[Key] = &[
    file("spinline.polymer", FileKind::Polymer)
        .access(Access {
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
        .gives("spinline.")
        .required("\"pp\"")
        .derived(no_spinline)
        .meaning(
            "The polymer: one of these, or a file with the table [spinline.material] and all of its \
             constants. Each constant can be given in [spinline.material] too.",
        )
        .label("Polymer")
        .varies(),
    quantity("spinline.melt_flow_rate", Dimension::Ratio, Positive)
        .access(Access {
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
            "Melt flow rate of the grade in g/10 min, load 2.16 kg, at \
             `spinline.material.viscosity_temperature`. It gives the viscosity, within some 20 %; \
             `spinline.material.viscosity` may be written instead.",
        )
        .synonyms(&["MFR", "MFI", "melt flow index"])
        .label("Melt flow rate [g/10 min]")
        .slider(5.0, 100.0),
    quantity("spinline.die_temperature", Dimension::Temperature, Positive)
        .access(of_spinline!(die_temperature))
        .required("230 °C")
        .derived(no_spinline)
        .usual(373.15, 723.15)
        .meaning("Temperature of the melt in the hole.")
        .label("Die temperature")
        .slider(453.15, 573.15),
    quantity("spinline.hole_diameter", Dimension::Length, Positive)
        .access(of_spinline!(hole_diameter))
        .required("0.6 mm")
        .derived(no_spinline)
        .usual(5e-5, 3e-3)
        .meaning("Diameter of the hole of the spinneret.")
        .synonyms(&["capillary", "nozzle diameter"])
        .label("Hole diameter"),
    quantity("spinline.die_swell", Dimension::Ratio, Positive)
        .access(of_spinline!(die_swell))
        .value("1.0")
        .usual(0.8, 3.0)
        .meaning("Diameter of the thread below the die over that of the hole.")
        .label("Die swell"),
    quantity("spinline.throughput", Dimension::MassFlow, Positive)
        .access(of_spinline!(throughput))
        .required("0.5 g/min")
        .derived(no_spinline)
        .usual(1e-8, 1e-3)
        .meaning("Mass flow of a hole: g/min, kg/h, g/s or kg/s.")
        .synonyms(&["output per hole", "mass flow", "grams per minute"])
        .label("Throughput of a hole")
        .slider(1e-6, 3e-5),
    quantity("spinline.length", Dimension::Length, Positive)
        .access(of_spinline!(length))
        .required("1.6 m")
        .derived(no_spinline)
        .usual(0.02, 30.0)
        .meaning(
            "Length of the spinline, from the die to the inlet at which the flown fibre begins, or to the \
             take-up.",
        )
        .label("Length of the spinline"),
];
