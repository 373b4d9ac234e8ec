//! The mean flow of the air: a number, a profile or a CFD field.

use crate::Case;
use crate::case::keys::Key;
use crate::case::keys::row::{
    Access, choose, file, key, named, number, placed, placed_mut, quantity, read_with_case, take, text,
};
use crate::case::keys::value::Sign::{Any, Positive};
use crate::case::keys::value::{Content, DataFile, Kind, Value};
use spunlaid_air::{Air, Axis, Cabin, Flow, LENGTH_CONSTANT, PlacedField, TIME_CONSTANT, Widening};
use spunlaid_ground::{Dimension, Fault};

named_fields!(Axis);

/// Largest Mach number of the air at the slot.
const FASTEST: f64 = 0.9;

pub(in super::super) const KEYS: &[Key] = &[
    // Up to the speed of sound.
    quantity("air.velocity", Dimension::Velocity, Any, (1e-3, 340.0))
        .access(Access {
            get: |case| case.air.cabin_pressure.is_none().then_some(Value::Number(case.air.velocity)),
            set: |case, value| {
                let flow = match case.air.flow {
                    Flow::Uniform => {
                        (case.air.velocity, case.air.cabin_pressure) = (number(value)?, None);
                        return Ok(());
                    }
                    Flow::Profile(_) => "air.profile",
                    Flow::Field(_) => "air.field",
                };
                Err(Fault::new(
                    format!("has no effect because {flow} gives the velocity"),
                    "leave it out, and scale the flow with air.speed_factor",
                ))
            },
        })
        .in_other_words(|case| Some(Value::Number(case.air.velocity)))
        .derived(|case| !case.air.is_uniform())
        .inferred(|case| {
            let of_record = case.air.records.first().and_then(|record| record.says.velocity);
            take(&mut case.air.velocity, of_record)
        })
        .required("10 m/s")
        .meaning("Mean velocity of the air along x. A record, a profile or a field gives it too.")
        .synonyms(&["air speed", "wind"])
        .label("Mean velocity *U*")
        .slider(0.0, 60.0)
        .in_flight(),
    file("air.profile", DataFile::Profile)
        .access(Access {
            get: |case| match &case.air.flow {
                Flow::Profile(profile) => Some(Content::Profile(profile.clone()).into()),
                _ => None,
            },
            set: |case, value| {
                let Value::Content(Content::Profile(profile)) = value else {
                    return Err(read_with_case());
                };
                case.air.flow = Flow::Profile(profile.clone());
                Ok(())
            },
        })
        .alternative_to(&["air.field"], "the air is one or the other; leave one out")
        .gives("air.")
        .follows("the same air everywhere")
        .meaning(
            "Table of the air along the fibre: velocity over the distance from the root and, if it has \
             such columns, turbulence.",
        ),
    file("air.field", DataFile::Field)
        .access(Access {
            get: |case| Some(Content::Field(placed(case)?.field.clone()).into()),
            set: |case, value| {
                let Value::Content(Content::Field(field)) = value else {
                    return Err(read_with_case());
                };
                let field = field.clone();
                let axis = Axis::ALL[0];
                let unit = 1.0;
                let root = PlacedField::middle_of_inlet(&field, axis, unit);
                let (length_constant, time_constant) = (LENGTH_CONSTANT, TIME_CONSTANT);
                let machine_direction = Axis::ALL[1];
                let placed = PlacedField {
                    field,
                    root,
                    axis,
                    machine_direction,
                    unit,
                    length_constant,
                    time_constant,
                };
                case.air.flow = Flow::Field(Box::new(placed));
                Ok(())
            },
        })
        .gives("air.")
        .follows("the same air everywhere")
        .meaning(
            "CFD solution around the fibre: VTK files or tables of points with the velocity and, if \
             there are, k with ε or ω.",
        ),
    key("air.field_root", Kind::Point)
        .access(at!(placed, placed_mut, root))
        .read_after(&["air.field_axis", "air.field_unit"])
        .inferred(|case| {
            let Ok(placed) = placed_mut(case) else { return false };
            placed.root = PlacedField::middle_of_inlet(&placed.field, placed.axis, placed.unit);
            true
        })
        .follows("the middle of the side where the air enters the box around the field")
        .meaning(
            "Position of the root in the field: the spinneret's hole, or where the fibre enters the \
             diffuser.",
        ),
    choose("air.field_axis", || Axis::ALL.map(Axis::name).to_vec())
        .access(at!(placed, placed_mut, axis))
        .value("x")
        .meaning(
            "Direction in the field that is the fibre's x, along gravity: `-z` if the CFD model \
             points down along −z.",
        )
        .label("Direction of the fibre in the field"),
    choose("air.field_machine_direction", || Axis::ALL.map(Axis::name).to_vec())
        .access(at!(placed, placed_mut, machine_direction))
        .read_after(&["air.field_axis"])
        .inferred(|case| {
            let Ok(placed) = placed_mut(case) else { return false };
            placed.machine_direction = PlacedField::usual_machine_direction(&placed.field, placed.axis);
            true
        })
        .follows("in the plane of a plane flow, so that the air is the same along the cross direction")
        .meaning(
            "Direction in the field that is the fibre's y, the machine direction of the belt, at a \
             right angle to `air.field_axis`. The cross direction, z, follows.",
        )
        .synonyms(&["MD", "belt"])
        .label("Machine direction in the field"),
    quantity("air.field_unit", Dimension::Length, Positive, (1e-6, 10.0))
        .access(at!(placed, placed_mut, unit))
        .or_unit()
        .value("1 m")
        .meaning(
            "Length of one unit of the field's coordinates: `1 mm` if the mesh is in millimetres. \
             Velocities are not scaled.",
        )
        .fixed(),
    key("air.field_velocity", Kind::Text("U"))
        .access(of_field_layout!(velocity))
        .follows("the array with a usual name of the velocity")
        .meaning(
            "Array of the velocity in a field, by name: one of three components, or one for each, \
             `Ux, Uy, Uz`.",
        ),
    key("air.field_k", Kind::Text("k"))
        .access(of_field_layout!(k))
        .follows("the array with a usual name of k")
        .meaning("Array of the turbulent kinetic energy k in a field.")
        .synonyms(&["TKE"]),
    key("air.field_epsilon", Kind::Text("epsilon"))
        .access(of_field_layout!(epsilon))
        .follows("the array with a usual name of ε")
        .meaning("Array of the dissipation rate ε of k in a field."),
    key("air.field_omega", Kind::Text("omega"))
        .access(of_field_layout!(omega))
        .alternative_to(&["air.field_epsilon"], "either gives ε; write one of the two")
        .follows("the array with a usual name of ω, if there is none of ε")
        .meaning("Array of the specific dissipation rate ω in a field, instead of ε."),
    quantity("air.length_constant", Dimension::Ratio, Positive, (0.01, 10.0))
        .access(at!(placed, placed_mut, length_constant))
        .value("0.43")
        .meaning("Constant C_L of the length scale C_L k^1.5/ε in a field.")
        .label("Constant of the length scale *C*_{L}")
        .slider(0.1, 1.0),
    quantity("air.time_constant", Dimension::Ratio, Positive, (0.01, 10.0))
        .access(at!(placed, placed_mut, time_constant))
        .value("0.3")
        .meaning(
            "Constant C_T of the eddies' lifetime T = C_T k/ε in a field. The cut-off frequency is ¼ \
             (velocity/length + 1/T).",
        )
        .label("Constant of the eddy lifetime *C*_{T}")
        .slider(0.1, 1.0),
    quantity("air.speed_factor", Dimension::Ratio, Positive, (0.01, 100.0))
        .access(Access {
            get: |case| speed_factor(case).filter(|_| case.air.cabin_pressure.is_none()),
            set: |case, value| {
                if case.air.is_uniform() {
                    let needed = "air.profile or air.field";
                    let remedy = "change air.velocity";
                    return Err(Fault::needs(needed, remedy));
                }
                (case.air.speed_factor, case.air.cabin_pressure) = (number(value)?, None);
                Ok(())
            },
        })
        .in_other_words(speed_factor)
        .value("1")
        .meaning("Factor on all velocities of a profile or a field.")
        .label("Factor on the velocity of the air")
        .slider(0.2, 3.0)
        .in_flight(),
    quantity("air.cabin_pressure", Dimension::Pressure, Positive, (100.0, 3e4))
        .access(Access {
            get: |case| case.air.cabin_pressure.map(Value::Number),
            set: |case, value| {
                case.air.cabin_pressure = Some(number(value)?);
                blow(case)
            },
        })
        .alternative_to_one_of(
            &["air.velocity", "air.speed_factor"],
            "the pressure of the cabin gives the velocity at the slot; keep one of them",
        )
        .read_after(&["air.density", "air.temperature", "air.profile", "air.speed_factor"])
        .follows("`velocity` gives the speed of the air")
        .meaning(
            "Pressure of the cabin above that under the belt, which blows the air through the slot. It gives \
             `velocity`, or the factor on a profile, at the root: isentropic flow, times `speed_coefficient`.",
        )
        .synonyms(&["cabin", "blower", "fan", "plenum", "chamber", "process air"])
        .label("Cabin pressure"),
    quantity("air.speed_coefficient", Dimension::Ratio, Positive, (0.5, 1.0))
        .access(Access {
            get: |case| {
                let Air { cabin_pressure, speed_coefficient, .. } = case.air;
                let is_written = cabin_pressure.is_some() || speed_coefficient != Cabin::COEFFICIENT;
                is_written.then_some(Value::Number(speed_coefficient))
            },
            set: |case, value| {
                case.air.speed_coefficient = number(value)?;
                blow(case)
            },
        })
        .value("0.9")
        .read_after(&["air.cabin_pressure"])
        .meaning(
            "Speed of the air at the slot over that of frictionless air at the same `cabin_pressure`. Measured \
             values of both give it: `spunlaid new --web --cabin-pressure … --air-speed …`.",
        )
        .label("Coefficient of speed of the slot"),
    choose("air.widening", || Widening::ALL.map(Widening::name).to_vec())
        .access(Access {
            get: |case| {
                let widening = case.air.widening.filter(|_| matches!(case.air.flow, Flow::Profile(_)))?;
                Some(widening.name().into())
            },
            set: |case, value| {
                let widening = named(value, &Widening::ALL, Widening::name)?;
                let remedy = match (&case.air.flow, widening) {
                    (Flow::Profile(_), _) | (_, Widening::None) => {
                        case.air.widening = Some(widening);
                        return Ok(());
                    }
                    (Flow::Uniform, _) => "leave it out: air that keeps its speed does not widen",
                    (Flow::Field(_), _) => {
                        "leave it out: the field's own velocity across gives the widening of the flow"
                    }
                };
                Err(Fault::needs("air.profile", remedy))
            },
        })
        .follows("the air only slows, with a warning of a web")
        .meaning(
            "Whether the mean flow of a profile widens where it slows. `md`: along the machine direction, with the \
             velocity `−y dU/dx` from the middle of the slot. `none`: the air only slows, without a warning.",
        )
        .label("Widening of the mean flow"),
];

fn speed_factor(case: &Case) -> Option<Value> {
    (!case.air.is_uniform()).then_some(Value::Number(case.air.speed_factor))
}

/// Sets the velocity of the air that a cabin blows through the slot, if one does.
fn blow(case: &mut Case) -> Result<(), Fault> {
    let Some(cabin) = case.air.cabin() else { return Ok(()) };
    if cabin.mach() > FASTEST {
        let what = format!("makes air of Mach {:.2}, and the flow is known up to {FASTEST}", cabin.mach());
        let remedy = "write a lower pressure, above that under the belt, or the velocity itself";
        return Err(Fault::new(what, remedy));
    }
    let speed = cabin.speed(case.air.density);
    if !speed.is_finite() {
        return Err(Fault::new("has no effect in a vacuum", "give the air its density"));
    }
    match &case.air.flow {
        Flow::Uniform => case.air.velocity = speed,
        Flow::Profile(profile) => match profile.velocity_at_root() {
            Some(at_root) if at_root > 0.0 => case.air.speed_factor = speed / at_root,
            _ => {
                let remedy = "begin the table at the slot, with the velocity there";
                return Err(Fault::new("has no velocity of air.profile at the root to scale", remedy));
            }
        },
        Flow::Field(_) => {
            let remedy = "scale the field with air.speed_factor: the slot may be outside of it";
            return Err(Fault::new("has no effect because air.field gives the velocity", remedy));
        }
    }
    Ok(())
}
