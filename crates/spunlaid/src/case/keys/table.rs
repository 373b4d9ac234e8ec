//! The table of keys: one row for each, in the order of a case file.

use super::Key;
use super::row::{
    Access, choose, file, key, line, named, number, placed, placed_mut, quantity, text, vector, whole,
};
use super::value::{Content, FileKind, Kind, SPECTRA, Sign, Value};
use crate::air::{
    Axis, EddyModel, Flow, LENGTH_CONSTANT, PlacedField, SUTHERLAND_RANGE, SpectrumShape, TIME_CONSTANT,
    density_at, kinematic_viscosity_at,
};
use crate::case::{MOST_REPLICATES, MOST_SHAPES, whole_parts};
use crate::chain::schemes::Scheme;
use crate::drag::{FrictionLaw, NormalLaw};
use crate::error::Fault;
use crate::fibre::Root;
use crate::line::Contact;
use crate::units::Dimension;
use Sign::{Any, NotNegative, Positive};
use std::f64::consts::PI;

/// Most lines that are skipped at the start of a record.
const MOST_SKIPPED: u64 = 1_000_000;

pub(super) static KEYS: &[Key] = &[
    quantity("fibre.length", Dimension::Length, Positive, Access {
        get: |case| case.line.is_none().then_some(Value::Number(case.fibre.length)),
        set: |case, value| {
            if case.line.is_some() {
                let (other, remedy) = ("[feed]", "a fed fibre has no length of its own; leave it out, or leave out [feed] and [belt]");
                return Err(Fault::Excludes { other, remedy });
            }
            case.fibre.length = number(value)?;
            Ok(())
        },
    })
        .told(|case| case.line.is_some())
        .required("1 m")
        .meaning("Length of the fibre, from its root to its free end. A fibre that is fed on to a belt has none.")
        .label("Fibre length *L*")
        .slider(0.1, 2.0),
    quantity("fibre.diameter", Dimension::Length, Positive, number!(fibre.diameter))
        .required("50 µm")
        .meaning("Diameter of the round fibre.")
        .label("Fibre diameter *d*")
        .slider(5e-6, 2e-4)
        .in_flight(),
    quantity("fibre.density", Dimension::Density, Positive, number!(fibre.density))
        .required("950 kg/m³")
        .meaning("Density of the polymer.")
        .label("Fibre density")
        .slider(800.0, 1500.0)
        .in_flight(),
    quantity("fibre.linear_density", Dimension::LinearDensity, Positive, Access {
        get: |_| None,
        set: |case, value| {
            case.fibre.diameter = (4.0 * number(value)? / (PI * case.fibre.density)).sqrt();
            Ok(())
        },
    })
    .follows("diameter and density give it")
    .meaning("Mass per length of the fibre, which may be written instead of `fibre.diameter`; the diameter follows with the density.")
    .label("Linear density")
    .slider(1e-8, 2e-5),
    quantity("fibre.youngs_modulus", Dimension::Pressure, Positive, number!(fibre.youngs_modulus))
        .required("2 GPa")
        .meaning("Young's modulus of the polymer along the fibre. The fibre is elastic.")
        .label("Young’s modulus *E*")
        .slider(1e7, 1e10)
        .in_flight(),
    quantity(
        "fibre.bending_viscosity_time",
        Dimension::Time,
        NotNegative,
        number!(fibre.bending_viscosity_time),
    )
    .value("0 s")
    .meaning(
        "Time constant τ of the bending viscosity: the bending moment is EI (κ + τ dκ/dt), with the curvature κ. It damps the \
         bending of a polymer that is still soft.",
    )
    .label("Bending viscosity *τ*")
    .slider(0.0, 1e-3)
    .in_flight(),
    quantity("fibre.element_length", Dimension::Length, Positive, Access {
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
    .follows("the length of an eddy, or a little less so that a whole number of elements fits; of a fed fibre, 1/125 of the distance to the belt")
    .meaning("Length of the elements that the fibre is divided into. Shorter elements resolve shorter waves, and the run takes longer.")
    .label("Element length *l*")
    .slider(2e-3, 0.1)
    .counted(),
    choose("fibre.root", || Root::ALL.map(Root::name).to_vec(), choice!(fibre.root, Root::ALL))
        .value("pinned")
        .meaning(
            "How the root is held: `pinned` can turn, `clamped` keeps its direction, `free` is not held.",
        )
        .label("Root"),
    key("fibre.direction", Kind::Direction, Access {
        get: |case| Some(case.fibre.direction.into()),
        set: |case, value| {
            case.fibre.direction = vector(value)?;
            Ok(())
        },
    })
    .value("[1.0, 0.0, 0.0]")
    .meaning("Direction of the straight fibre at the start, and of a clamped root throughout. The air and gravity act along x."),
    quantity("feed.speed", Dimension::Velocity, Positive, of_line!(feed_speed))
        .follows("a fibre of fixed length")
        .meaning("Speed at which the fibre is fed at the inlet, along its direction: the spinning speed. The fibre is then laid down on a belt.")
        .label("Feed speed *v*_{f}")
        .slider(1.0, 100.0),
    quantity("belt.distance", Dimension::Length, Positive, Access {
        get: |case| Some(Value::Number(case.line?.distance)),
        set: |case, value| {
            let distance = number(value)?;
            let element_length = case.fibre.rest_length();
            line(case)?.distance = distance;
            if element_length.is_finite() {
                case.fibre.span(distance, element_length);
            } else {
                case.fibre.length = distance;
            }
            Ok(())
        },
    })
    .follows("a fibre of fixed length")
    .meaning("Distance from the inlet to the belt, along x. The belt is perpendicular to x.")
    .label("Distance to the belt *H*")
    .slider(0.1, 2.0),
    quantity("belt.speed", Dimension::Velocity, NotNegative, of_line!(belt_speed))
        .follows("a fibre of fixed length")
        .meaning("Speed of the belt, along y, the machine direction.")
        .label("Belt speed *v*_{b}")
        .slider(0.0, 10.0),
    choose("belt.contact", || Contact::ALL.map(|contact| contact.name()).to_vec(), Access {
        get: |case| Some(case.line?.contact.name().into()),
        set: |case, value| {
            let contact = named(value, &Contact::ALL, |contact| contact.name())?;
            let line = line(case)?;
            if contact.name() != line.contact.name() {
                line.contact = contact;
            }
            Ok(())
        },
    })
    .value("stick")
    .meaning("What holds the fibre on the belt: it sticks where it touches down, or it slides against friction.")
    .label("Contact with the belt"),
    quantity("belt.friction", Dimension::Ratio, NotNegative, of_friction!(coefficient))
        .value("0.3")
        .meaning("Coefficient of the friction between fibre and belt.")
        .label("Friction on the belt *μ*")
        .slider(0.0, 1.0),
    quantity("belt.suction", Dimension::Pressure, NotNegative, of_friction!(suction))
        .value("200 Pa")
        .meaning("Pressure difference that pulls the fibre on to the belt. Times the diameter, it is a force per length of fibre.")
        .label("Suction")
        .slider(0.0, 2000.0),
    quantity("belt.kept_length", Dimension::Length, Positive, of_line!(kept_length))
        .follows("6 % of the distance to the belt")
        .meaning("Length of fibre behind the newest touch-down that still moves. What comes after it is laid; arches that are still in the air stay where they are.")
        .label("Length that still moves on the belt")
        .slider(5e-3, 0.2),
    quantity("air.velocity", Dimension::Velocity, Any, Access {
        get: |case| Some(Value::Number(case.air.velocity)),
        set: |case, value| {
            let flow = match case.air.flow {
                Flow::Uniform => {
                    case.air.velocity = number(value)?;
                    return Ok(());
                }
                Flow::Profile(_) => "air.profile",
                Flow::Field(_) => "air.field",
            };
            Err(Fault::FlowTells { flow })
        },
    })
    .told(|case| !case.air.is_uniform())
    .required("10 m/s")
    .meaning("Mean velocity of the air along x. A record, a profile or a field gives it instead.")
    .label("Mean velocity *U*")
    .slider(0.0, 60.0)
    .in_flight(),
    file("air.profile", FileKind::Profile, Access {
        get: |case| match &case.air.flow {
            Flow::Profile(profile) => Some(Content::Profile(profile.clone()).into()),
            _ => None,
        },
        set: |case, value| {
            let Value::Content(Content::Profile(profile)) = value else {
                return Err(Fault::ReadWithCase);
            };
            case.air.flow = Flow::Profile(profile.clone());
            Ok(())
        },
    })
    .follows("the same air everywhere")
    .meaning("Table of the air along the fibre: velocity over the distance from the root and, if it has such columns, turbulence."),
    file("air.field", FileKind::Field, Access {
        get: |case| Some(Content::Field(placed(case)?.field.clone()).into()),
        set: |case, value| {
            let Value::Content(Content::Field(field)) = value else {
                return Err(Fault::ReadWithCase);
            };
            let (field, axis, unit) = (field.clone(), Axis::ALL[0], 1.0);
            let root = PlacedField::middle_of_inlet(&field, axis, unit);
            let (length_constant, time_constant) = (LENGTH_CONSTANT, TIME_CONSTANT);
            case.air.flow = Flow::Field(PlacedField { field, root, axis, unit, length_constant, time_constant });
            Ok(())
        },
    })
    .follows("the same air everywhere")
    .meaning("CFD solution around the fibre: VTK files or tables of points with the velocity and, if available, k with ε or ω."),
    key("air.field_root", Kind::Point, Access {
        get: |case| Some(placed(case)?.root.into()),
        set: |case, value| {
            placed_mut(case)?.root = vector(value)?;
            Ok(())
        },
    })
    .follows("the middle of the side where the air enters the box around the field")
    .meaning(
        "Position of the root in the field: three coordinates, as lengths. Choose the position of the spinneret's hole, \
         or of the slot where the fibre enters the diffuser.",
    ),
    choose("air.field_axis", || Axis::ALL.map(Axis::name).to_vec(), Access {
        get: |case| Some(placed(case)?.axis.name().into()),
        set: |case, value| {
            placed_mut(case)?.axis = named(value, &Axis::ALL, |axis| axis.name())?;
            Ok(())
        },
    })
    .value("x")
    .meaning(
        "Direction in the field that is the fibre's x, the direction of gravity. Write `-z` if the CFD model points down \
         along −z.",
    )
    .label("Direction of the fibre in the field"),
    quantity("air.field_unit", Dimension::Length, Positive, of_field!(unit))
        .value("1 m")
        .meaning(
            "Length of one unit of the field's coordinates. Write `1 mm` if the mesh was drawn in millimetres. Velocities \
             are not scaled.",
        )
        .fixed(),
    quantity("air.length_constant", Dimension::Ratio, Positive, of_field!(length_constant))
        .value("0.43")
        .meaning("Constant C_L of the eddies' length C_L k^1.5/ε in a field.")
        .label("Constant of the eddies’ length *C*_{L}")
        .slider(0.1, 1.0),
    quantity("air.time_constant", Dimension::Ratio, Positive, of_field!(time_constant))
        .value("0.3")
        .meaning("Constant C_T of the eddies' lifetime T = C_T k/ε in a field. The cut-off frequency follows as ¼ (velocity/length + 1/T).")
        .label("Constant of the eddies’ lifetime *C*_{T}")
        .slider(0.1, 1.0),
    quantity("air.speed_factor", Dimension::Ratio, Positive, Access {
        get: |case| (!case.air.is_uniform()).then_some(Value::Number(case.air.speed_factor)),
        set: |case, value| {
            if case.air.is_uniform() {
                let (needed, remedy) = ("air.profile or air.field", "change air.velocity");
                return Err(Fault::Needs { needed, remedy });
            }
            case.air.speed_factor = number(value)?;
            Ok(())
        },
    })
    .value("1")
    .meaning("Factor on all velocities of a profile or a field. It makes the same flow faster or slower.")
    .label("Factor on the velocity of the air")
    .slider(0.2, 3.0)
    .in_flight(),
    quantity("air.turbulence_intensity", Dimension::Ratio, NotNegative, of_air!(turbulence_intensity))
        .told(|case| case.air.from_flow.turbulence_intensity)
        .required("0.1")
        .meaning("Rms of each fluctuating velocity component, divided by the mean velocity. A record, a profile or a field may give it instead.")
        .label("Turbulence intensity *Tu*")
        .slider(0.0, 0.5)
        .in_flight(),
    quantity("air.length_scale", Dimension::Length, Positive, of_air!(length_scale))
        .told(|case| case.air.from_flow.length_scale)
        .required("50 mm")
        .meaning("Length of an eddy. Within this length the fluctuation is the same along the fibre. A record, a profile or a field may give it instead.")
        .label("Length of the eddies *L*_{T}")
        .slider(5e-3, 0.2),
    quantity("air.cutoff_frequency", Dimension::Frequency, Positive, of_air!(cutoff_frequency))
        .told(|case| case.air.from_flow.cutoff_frequency)
        .required("100 Hz")
        .meaning("Highest frequency of the turbulence. `taylor` stands for velocity / (4 × length scale). A record, a spectrum, a profile or a field may give it instead.")
        .label("Cut-off frequency *f*")
        .slider(10.0, 1000.0),
    quantity("air.density", Dimension::Density, NotNegative, number!(air.density))
        .value("1.204 kg/m³")
        .meaning("Density of the air. The default is for 20 °C. `0 kg/m³` is a vacuum.")
        .label("Air density")
        .slider(0.0, 2.0)
        .in_flight(),
    quantity(
        "air.kinematic_viscosity",
        Dimension::KinematicViscosity,
        Positive,
        number!(air.kinematic_viscosity),
    )
    .value("1.51e-5 m²/s")
    .meaning("Kinematic viscosity of the air. The default is for 20 °C.")
    .label("Kinematic viscosity *ν*")
    .slider(1e-5, 6e-5)
    .in_flight(),
    quantity("air.temperature", Dimension::Temperature, Any, Access {
        get: |_| None,
        set: |case, value| {
            let temperature = number(value)?;
            if !SUTHERLAND_RANGE.contains(&temperature) {
                let (least, most) = (*SUTHERLAND_RANGE.start(), *SUTHERLAND_RANGE.end());
                return Err(Fault::Temperature { least, most });
            }
            case.air.density = density_at(temperature);
            case.air.kinematic_viscosity = kinematic_viscosity_at(temperature);
            Ok(())
        },
    })
    .follows("density and viscosity as they are written, or at 20 °C")
    .meaning(
        "Temperature of the air, from 170 to 1900 K, which may be written instead of `air.density` and \
         `air.kinematic_viscosity`; both follow for dry air at 101325 Pa.",
    )
    .label("Air temperature")
    .slider(253.15, 373.15),
    file("air.spectrum", FileKind::Spectrum, Access {
        get: |case| match &case.air.spectrum {
            SpectrumShape::Measured(table) => Some(Content::Spectrum(table.clone()).into()),
            shape => Some(shape.name().into()),
        },
        set: |case, value| {
            case.air.spectrum = match value {
                Value::Content(Content::Spectrum(table)) => SpectrumShape::Measured(table.clone()),
                Value::Text(name) if name == SPECTRA[0] => SpectrumShape::Flat,
                Value::Text(name) if name == SPECTRA[1] => SpectrumShape::VonKarman,
                _ => return Err(Fault::ReadWithCase),
            };
            Ok(())
        },
    })
    .value("flat")
    .meaning("Shape of the turbulence spectrum: `flat` up to the cut-off frequency, von Kármán's, or a measured one from a CSV file.")
    .label("Shape of the spectrum")
    .varies(),
    file("air.record", FileKind::Records, Access {
        get: |case| {
            let records = &case.air.records;
            (!records.is_empty()).then(|| Content::Records(records.clone()).into())
        },
        set: |case, value| {
            let Value::Content(Content::Records(records)) = value else {
                return Err(Fault::ReadWithCase);
            };
            let rates = || records.iter().map(|record| 1.0 / record.interval);
            let first = rates().next().unwrap_or(0.0);
            if let Some(other) = rates().find(|rate| (rate / first - 1.0).abs() >= 1e-9) {
                return Err(Fault::RecordRates { first, other });
            }
            case.air.records = records.clone();
            Ok(())
        },
    })
    .follows("turbulence is made from harmonics")
    .meaning("Measured velocity record, as CSV or Parquet, whose fluctuation moves the fibre. A list gives one record for each eddy."),
    quantity("air.record_rate", Dimension::Frequency, Positive, of_record!(rate, Value::Number, number))
        .follows("the rate of the record's time column")
        .meaning("Sampling rate of a record without a time column.")
        .fixed(),
    key("air.record_skip", Kind::Whole(0, MOST_SKIPPED), of_record!(skip, Value::Whole, whole))
        .follows("the header is found by itself")
        .meaning("Number of lines to skip at the start of a record."),
    key("air.record_columns", Kind::Text("u,v"), of_record!(columns, Value::Text, text))
        .follows("the columns with the names or units of velocities")
        .meaning("Columns of velocity of a record, by name or by number from 1, with commas between them; the first is along the mean flow."),
    key("air.record_velocity_unit", Kind::Text("m/s"), of_record!(velocity_unit, Value::Text, text))
        .follows("the unit in the header of the record")
        .meaning("Unit of the velocities of a record whose header has none."),
    choose("air.eddies", || vec!["independent", "convected"], Access {
        get: |case| Some(case.air.eddies.name().into()),
        set: |case, value| {
            let models = [EddyModel::Independent, EddyModel::Convected { decay_time: f64::INFINITY }];
            let model = named(value, &models, |model| model.name())?;
            if model.name() != case.air.eddies.name() {
                case.air.eddies = model;
            }
            Ok(())
        },
    })
    .value("independent")
    .meaning("How the turbulence is correlated along the fibre: independent eddies side by side, or a pattern that the mean flow carries along. For a fed fibre, `convected` is the default.")
    .label("Eddies"),
    quantity("air.decay_time", Dimension::Time, Positive, Access {
        get: |case| match case.air.eddies {
            EddyModel::Convected { decay_time } if decay_time.is_finite() => Some(Value::Number(decay_time)),
            _ => None,
        },
        set: |case, value| match &mut case.air.eddies {
            EddyModel::Convected { decay_time } => {
                *decay_time = number(value)?;
                Ok(())
            }
            EddyModel::Independent => {
                let remedy = "leave it out, or have the eddies convected";
                Err(Fault::Needs { needed: "air.eddies = \"convected\"", remedy })
            }
        },
    })
    .follows("no decay: the pattern is frozen; of a fed fibre, the length scale divided by the rms velocity")
    .meaning("Time constant with which a convected pattern loses its correlation while it travels.")
    .label("Decay time of the eddies")
    .slider(1e-3, 0.1),
    key("air.harmonics", Kind::Whole(1, usize::MAX as u64), Access {
        get: |case| Some(Value::Whole(case.air.harmonics as u64)),
        set: |case, value| {
            case.air.harmonics = usize::try_from(whole(value)?).unwrap_or(usize::MAX);
            Ok(())
        },
    })
    .follows("the smallest power of two, at least 128, that lasts for twice the run; for long runs 1024, or what lasts for 256 integral times")
    .meaning("Number of cosine waves whose sum is the turbulence. A sum lasts for harmonics / cut-off frequency; before that, the wind changes over to a sum with other phases.")
    .label("Number of harmonics")
    .varies()
    .counted(),
    choose(
        "drag.along",
        || FrictionLaw::ALL.map(FrictionLaw::name).to_vec(),
        Access {
            get: |case| Some(case.drag.along.name().into()),
            set: |case, value| {
                let law = named(value, &FrictionLaw::ALL, |law| law.name())?;
                if law.name() != case.drag.along.name() {
                    case.drag.along = law;
                }
                Ok(())
            },
        },
    )
    .value("matsui")
    .meaning("Law of the friction along the fibre. Source and range of each law: docs/theory.md.")
    .label("Law of the friction along the fibre")
    .in_flight(),
    choose(
        "drag.across",
        || NormalLaw::ALL.map(NormalLaw::name).to_vec(),
        choice!(drag.across, NormalLaw::ALL),
    )
    .value("ju-shambaugh")
    .meaning(
        "Law of the drag across the fibre. \"marheineke-wegener\" agrees with measurements from fine fibres to thick cylinders; \
         \"ju-shambaugh\" is the paper's. Source and range of each law: docs/theory.md.",
    )
    .label("Law of the drag across the fibre")
    .in_flight(),
    quantity("drag.friction_coefficient", Dimension::Ratio, NotNegative, Access {
        get: |case| case.drag.along.factor().map(Value::Number),
        set: |case, value| match &mut case.drag.along {
            FrictionLaw::Matsui { factor } => {
                *factor = number(value)?;
                Ok(())
            }
            _ => {
                let (needed, remedy) = ("drag.along = \"matsui\"", "remove it, this law has its own");
                Err(Fault::Needs { needed, remedy })
            }
        },
    })
    .value("0.9")
    .meaning("Factor of Matsui's friction law. Values from 0.37 to 0.9 are in use.")
    .label("Friction coefficient *β*")
    .slider(0.2, 1.2)
    .in_flight(),
    quantity("run.duration", Dimension::Time, Positive, steps!(steps, duration, 1))
        .required("1 s")
        .meaning("Time that is simulated, the spin-up included.")
        .label("Simulated time")
        .slider(0.1, 10.0)
        .counted(),
    quantity("run.time_step", Dimension::Time, Positive, Access {
        get: |case| Some(Value::Number(case.run.time_step)),
        set: |case, value| {
            case.set_time_step(number(value)?);
            Ok(())
        },
    })
    .follows("the largest of 1, 2 or 5 times a power of ten that keeps the error tolerance and half the stability limit; of a fed fibre, a whole part of the time in which an element is fed, at most half of it")
    .meaning("Length of a time step. It must be below the stability limit; otherwise a message gives the limit.")
    .label("Time step *h*")
    .slider(1e-7, 1e-3)
    .counted(),
    quantity("run.error_tolerance", Dimension::Ratio, Positive, Access {
        get: |_| None,
        set: |case, value| {
            let (time_step, _) = case.suggested_time_step(number(value)?, case.run.duration());
            case.set_time_step(time_step);
            Ok(())
        },
    })
    .value("0.003")
    .meaning(
        "Largest error of the free end's path that the time step may cause, divided by its amplitude. The time step is \
         chosen from it if `run.time_step` is left out.",
    )
    .label("Error tolerance")
    .slider(1e-4, 0.03)
    .counted(),
    key("run.replicates", Kind::Whole(1, MOST_REPLICATES), Access {
        get: |case| Some(Value::Whole(case.run.replicates)),
        set: |case, value| {
            case.run.replicates = whole(value)?;
            Ok(())
        },
    })
    .value("10")
    .meaning("Number of fibres, each in its own turbulence. Means and standard errors are taken over them."),
    key("run.seed", Kind::Whole(0, u64::MAX), Access {
        get: |case| Some(Value::Whole(case.run.seed)),
        set: |case, value| {
            case.run.seed = whole(value)?;
            Ok(())
        },
    })
    .value("1")
    .meaning("Seed of the random phases. Another seed gives other turbulence; the same seed gives the same results to the last bit."),
    choose("run.scheme", || Scheme::ALL.map(Scheme::name).to_vec(), choice!(run.scheme, Scheme::ALL))
        .value("semi-implicit-euler")
        .meaning("Time integration: the paper's scheme has first order, `leapfrog` has second order, `implicit-tension` allows long steps and is the default for a fed fibre.")
        .label("Scheme"),
    quantity("run.gravity", Dimension::Acceleration, Any, number!(run.gravity))
        .value("9.81 m/s²")
        .meaning("Acceleration of gravity, along x.")
        .label("Gravity *g*")
        .slider(0.0, 20.0)
        .in_flight(),
    quantity("run.spin_up", Dimension::Time, NotNegative, steps!(spin_up_steps, spin_up, 0))
        .value("0 s")
        .meaning(
            "Time at the start that the statistics of the motion leave out; the energy errors and the time outside the flow \
             include it. The fibre starts straight and at rest, and its motion depends on this start for a fraction of a second. \
             Of a fed fibre the default is four times distance / feed speed, at most half the run: it comes down once, and \
             its length between inlet and belt is laid twice.",
        )
        .label("Spin-up")
        .slider(0.0, 1.0)
        .counted(),
    quantity("run.output_interval", Dimension::Time, Positive, steps!(output_steps, output_interval, 1))
        .value("1 ms")
        .meaning("Time from one recorded instant to the next.")
        .label("Output interval")
        .slider(1e-4, 1e-2)
        .counted(),
    key("run.shapes", Kind::Whole(0, MOST_SHAPES), Access {
        get: |case| case.run.shapes.map(Value::Whole),
        set: |case, value| {
            case.run.shapes = Some(whole(value)?);
            Ok(())
        },
    })
    .follows("every recorded instant as far as they fit into 96 MB, of which 500 go to ParaView")
    .meaning(
        "Number of shapes of a fibre that are kept for the moving picture and for ParaView, evenly over the run, at most \
         one for each recorded instant. Eight in each period of the end's motion follow it. `0` keeps none.",
    ),
    quantity("run.damping", Dimension::Rate, NotNegative, number!(run.damping))
        .value("0 1/s")
        .meaning("Rate at which the velocity of every node decays, in addition to the drag of the air.")
        .label("Damping")
        .slider(0.0, 100.0)
        .in_flight(),
];
