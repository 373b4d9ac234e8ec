//! The spinline and the constants of its polymer.

mod air;
mod filament;
mod material;

use crate::case::Case;
use crate::case::keys::Key;
use crate::case::keys::row::{Access, file, key, named, number, quantity, read_with_case};
use crate::case::keys::value::Sign::Positive;
use crate::case::keys::value::{Content, DataFile, Kind, Value};
use crate::spinline::{HoleRows, Melt, Polymer, PolymerSource, Spinline};
use spunlaid_ground::{Dimension, Fault};

/// Access to a number of the spinline: `of_spinline!(throughput)`.
macro_rules! of_spinline {
    ($($field:ident).+) => {
        $crate::case::keys::row::Access {
            get: |case| {
                use $crate::case::keys::table::spinline::known;
                known(case.spinline.as_ref()?.$($field).+)
            },
            set: |case, value| {
                use $crate::case::keys::table::spinline::spinline;
                spinline(case)?.$($field).+ = $crate::case::keys::row::number(value)?;
                Ok(())
            },
        }
    };
}

pub(super) fn no_spinline(case: &Case) -> bool {
    case.spinline.is_none()
}

/// A number that is known.
pub(super) fn known(number: f64) -> Option<Value> {
    number.is_finite().then_some(Value::Number(number))
}

pub(super) fn spun(case: &Case) -> Option<&Spinline> {
    case.spinline.as_deref()
}

/// The spinline of a case that has one.
pub(super) fn spinline(case: &mut Case) -> Result<&mut Spinline, Fault> {
    let remedy = "leave it out, or describe the spinline";
    case.spinline.as_deref_mut().ok_or_else(|| Fault::needs("[spinline]", remedy))
}

use of_spinline;

/// The keys of the spinline, concern by concern.
pub(super) const KEYS: &[&[Key]] = &[LINE, air::KEYS, filament::END_KEYS, filament::KEYS, CURTAIN];
/// The constants of the polymer.
pub(super) const MATERIAL: &[&[Key]] = &[material::KEYS];

const LINE: &[Key] = &[
    file("spinline.polymer", DataFile::Polymer)
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
            "A name, or a file with all constants in a table [spinline.material]. The same table of the case sets \
             single constants.",
        )
        .label("Polymer")
        .varies(),
    quantity("spinline.melt_flow_rate", Dimension::MeltFlowRate, Positive, (0.5, 3000.0))
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
        .meaning(
            "Melt flow rate of the grade in g/10 min, with 2.16 kg at `spinline.material.viscosity_temperature`. It \
             gives the viscosity within about 20 %, instead of `spinline.material.viscosity`.",
        )
        .synonyms(&["MFR", "MFI", "melt flow index"])
        .label("Melt flow rate [g/10 min]")
        .slider(5.0, 100.0),
    quantity("spinline.die_temperature", Dimension::Temperature, Positive, (373.15, 723.15))
        .access(of_spinline!(die_temperature))
        .required("230 °C")
        .derived(no_spinline)
        .meaning("Temperature of the melt in the hole.")
        .label("Die temperature")
        .slider(453.15, 573.15),
    quantity("spinline.hole_diameter", Dimension::Length, Positive, (5e-5, 3e-3))
        .access(of_spinline!(hole_diameter))
        .required("0.6 mm")
        .derived(no_spinline)
        .meaning("Diameter of the hole of the spinneret.")
        .synonyms(&["capillary", "nozzle diameter"])
        .label("Hole diameter"),
    quantity("spinline.die_swell", Dimension::Ratio, Positive, (0.8, 3.0))
        .access(of_spinline!(die_swell))
        .value("1.0")
        .meaning("Diameter of the filament below the die over that of the hole.")
        .label("Die swell"),
    quantity("spinline.throughput", Dimension::MassFlow, Positive, (1e-8, 1e-3))
        .access(of_spinline!(throughput))
        .required("0.5 g/min")
        .derived(no_spinline)
        .meaning("Mass flow of melt through a hole.")
        .synonyms(&["output per hole", "mass flow", "grams per minute"])
        .label("Throughput of a hole")
        .slider(1e-6, 3e-5),
    quantity("spinline.length", Dimension::Length, Positive, (0.02, 30.0))
        .access(of_spinline!(length))
        .required("1.6 m")
        .derived(no_spinline)
        .meaning("Length from the die to the inlet of the simulated fibre, or to the take-up.")
        .label("Length of the spinline"),
];

/// Most rows of a curtain.
const MOST_ROWS: u64 = 1000;

const CURTAIN: &[Key] = &[
    key("spinline.rows", Kind::Whole(1, MOST_ROWS))
        .access(at!(curtain_of, curtain, rows))
        .follows("one filament in the air as it is given")
        .meaning(
            "Rows of holes, each of which warms and drags the quench air. The simulated fibre belongs to the first \
             row.",
        )
        .label("Rows of holes")
        .varies(),
    quantity("spinline.filaments_per_metre_and_row", Dimension::Ratio, Positive, (1.0, 1e5))
        .access(Access {
            get: |case| known(case.spinline.as_ref()?.curtain?.filaments_per_metre),
            set: |case, value| {
                let filaments = number(value)?;
                curtain(case)?.filaments_per_metre = filaments;
                Ok(())
            },
        })
        .follows("one filament in the air as it is given")
        .meaning("Filaments per metre of width in each row.")
        .synonyms(&["holes per metre"])
        .label("Filaments per metre and row"),
];

fn curtain_of(case: &Case) -> Option<&HoleRows> {
    case.spinline.as_ref()?.curtain.as_ref()
}

fn curtain(case: &mut Case) -> Result<&mut HoleRows, Fault> {
    let unknown = HoleRows { rows: 1, filaments_per_metre: f64::NAN };
    Ok(spinline(case)?.curtain.get_or_insert(unknown))
}
