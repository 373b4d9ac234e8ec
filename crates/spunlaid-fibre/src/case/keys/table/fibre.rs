//! The fibre.

use super::super::Key;
use super::super::row::{Access, choose, key, number, quantity, without_spinline};
use super::super::value::Sign::{NotNegative, Positive};
use super::super::value::{Kind, Value};
use crate::body::{Root, diameter_of};
use crate::case::whole_parts;
use spunlaid_ground::{Dimension, Fault};

/// Access to a number of the fibre that a spinline gives.
macro_rules! from_spinline {
    ($field:ident) => {
        Access {
            get: |case| Some(Value::Number(case.fibre.$field)),
            set: |case, value| {
                without_spinline(case)?;
                case.fibre.$field = number(value)?;
                Ok(())
            },
        }
    };
}

named_fields!(Root);

pub(super) const KEYS: &[Key] = &[
    quantity("fibre.length", Dimension::Length, Positive, (0.001, 30.0))
        .access(Access {
            get: |case| case.line.is_none().then_some(Value::Number(case.fibre.length)),
            set: |case, value| {
                if case.line.is_some() {
                    let other = "[feed]";
                    let remedy = "a fed fibre has no length of its own; leave it out, or leave out [feed] and [belt]";
                    return Err(Fault::excludes(other, remedy));
                }
                case.fibre.length = number(value)?;
                Ok(())
            },
        })
        .derived(|case| case.line.is_some())
        .required("1 m")
        .meaning("Length of the fibre from its root to its free end. A fed fibre has none.")
        .label("Fibre length *L*")
        .slider(0.1, 2.0),
    // From nanofibres to thick threads.
    quantity("fibre.diameter", Dimension::Length, Positive, (1e-7, 2e-3))
        .access(from_spinline!(diameter))
        .derived(|case| case.spinline.is_some())
        .required("50 µm")
        .meaning("Diameter of the round fibre.")
        .label("Fibre diameter *d*")
        .slider(5e-6, 2e-4)
        .in_flight(),
    // From foams to the heaviest metals.
    quantity("fibre.density", Dimension::Density, Positive, (100.0, 2.5e4))
        .access(from_spinline!(density))
        .derived(|case| case.spinline.is_some())
        .required("950 kg/m³")
        .meaning("Density of the polymer.")
        .label("Fibre density")
        .slider(800.0, 1500.0)
        .in_flight(),
    quantity("fibre.linear_density", Dimension::LinearDensity, Positive, (1e-11, 0.03))
        .access(Access {
            get: |_| None,
            set: |case, value| {
                without_spinline(case)?;
                case.fibre.diameter = diameter_of(number(value)?, case.fibre.density);
                Ok(())
            },
        })
        .alternative_to(&["fibre.diameter"], "either gives the other; write one of the two")
        .in_other_words(|case| Some(case.linear_density().into()))
        .follows("diameter and density give it")
        .meaning("Mass per length, instead of `fibre.diameter`, which follows with the density.")
        .synonyms(&["titre", "titer", "denier", "count of the yarn", "fineness"])
        .label("Linear density")
        .slider(1e-8, 2e-5),
    // From rubber to the stiffest carbon fibres.
    quantity("fibre.youngs_modulus", Dimension::Pressure, Positive, (1e7, 9e11))
        .access(Access {
            get: |case| Some(Value::Number(case.fibre.youngs_modulus)),
            set: |case, value| {
                case.fibre.youngs_modulus = number(value)?;
                if let Some(line) = &mut case.spinline {
                    line.gives_modulus = false;
                }
                Ok(())
            },
        })
        .derived(|case| case.spinline.as_ref().is_some_and(|line| line.gives_modulus))
        .required("2 GPa")
        .meaning("Young's modulus of the polymer along the fibre, which is elastic.")
        .synonyms(&["stiffness", "E modulus"])
        .label("Young’s modulus *E*")
        .slider(1e7, 1e10)
        .in_flight(),
    quantity("fibre.bending_viscosity_time", Dimension::Time, NotNegative, (1e-7, 0.1))
        .access(at!(fibre.bending_viscosity_time))
        .value("0 s")
        .meaning(
            "Time constant τ of the bending viscosity of a soft polymer: the bending moment is EI (κ + τ dκ/dt), \
             with the curvature κ.",
        )
        .label("Bending viscosity *τ*")
        .slider(0.0, 1e-3)
        .in_flight(),
    quantity("fibre.element_length", Dimension::Length, Positive, (1e-6, 1.0))
        .access(Access {
            get: |case| {
                let length = case.fibre.rest_length();
                (length > 0.0 && length.is_finite()).then_some(Value::Number(length))
            },
            set: |case, value| {
                let elements = whole_parts(case.fibre.length, number(value)?).0.max(1);
                case.fibre.elements = usize::try_from(elements).unwrap_or(usize::MAX);
                Ok(())
            },
        })
        .follows(
            "the length of an eddy, or a little less so that a whole number of elements fits; for a fed \
             fibre, 1/125 of the distance to the belt",
        )
        .meaning("Length of the elements of the fibre. Shorter ones resolve shorter waves and take longer.")
        .label("Element length *l*")
        .slider(2e-3, 0.1)
        .read_last(),
    choose("fibre.root", || Root::ALL.map(Root::name).to_vec())
        .access(at!(fibre.root))
        .value("pinned")
        .meaning(
            "How the root is held: `pinned` can turn, `clamped` keeps its direction, `free` is not held.",
        )
        .label("Root"),
    key("fibre.direction", Kind::Direction).access(at!(fibre.direction)).value("[1.0, 0.0, 0.0]").meaning(
        "Direction of the straight fibre at the start, and of a clamped root throughout. Air and \
         gravity act along x.",
    ),
];
