//! The air: its flow, its turbulence and its properties.

use super::super::Key;
use super::super::row::{
    Access, change, choose, file, key, named, number, placed, placed_mut, quantity, read_with_case, text,
    vector, whole,
};
use super::super::value::Sign::{Any, NotNegative, Positive};
use super::super::value::{Content, FileKind, Kind, SPECTRA, Value};
use crate::air::{
    Axis, EddyModel, Flow, LENGTH_CONSTANT, Lateral, PlacedField, SUTHERLAND_RANGE, SpectrumShape,
    TIME_CONSTANT, Widening, density_at, kinematic_viscosity_at,
};
use crate::error::Fault;
use crate::units::Dimension;

/// Most lines that are skipped at the start of a record.
const MOST_SKIPPED: u64 = 1_000_000;
/// Largest gap of a record that may be filled in [samples].
const MOST_MISSING: u64 = 1_000_000;

pub(super) const KEYS: &[Key] = &[
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
            Err(Fault::new(
                format!("has no effect because {flow} gives the velocity"),
                "leave it out, and scale the flow with air.speed_factor",
            ))
        },
    })
    .told(|case| !case.air.is_uniform())
    .required("10 m/s")
    // Up to the speed of sound.
    .usual(1e-3, 340.0)
    .meaning("Mean velocity of the air along x. A record, a profile or a field gives it instead.")
    .synonyms(&["air speed", "wind"])
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
                return Err(read_with_case());
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
                return Err(read_with_case());
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
        .usual(1e-6, 10.0)
    .meaning(
            "Length of one unit of the field's coordinates. Write `1 mm` if the mesh was drawn in millimetres. Velocities \
             are not scaled.",
        )
        .fixed(),
    quantity("air.length_constant", Dimension::Ratio, Positive, of_field!(length_constant))
        .value("0.43")
        .usual(0.01, 10.0)
    .meaning("Constant C_L of the eddies' length C_L k^1.5/ε in a field.")
        .label("Constant of the eddies’ length *C*_{L}")
        .slider(0.1, 1.0),
    quantity("air.time_constant", Dimension::Ratio, Positive, of_field!(time_constant))
        .value("0.3")
        .usual(0.01, 10.0)
    .meaning("Constant C_T of the eddies' lifetime T = C_T k/ε in a field. The cut-off frequency follows as ¼ (velocity/length + 1/T).")
        .label("Constant of the eddies’ lifetime *C*_{T}")
        .slider(0.1, 1.0),
    quantity("air.speed_factor", Dimension::Ratio, Positive, Access {
        get: |case| (!case.air.is_uniform()).then_some(Value::Number(case.air.speed_factor)),
        set: |case, value| {
            if case.air.is_uniform() {
                let (needed, remedy) = ("air.profile or air.field", "change air.velocity");
                return Err(Fault::needs(needed, remedy));
            }
            case.air.speed_factor = number(value)?;
            Ok(())
        },
    })
    .value("1")
    .usual(0.01, 100.0)
    .meaning("Factor on all velocities of a profile or a field. It makes the same flow faster or slower.")
    .label("Factor on the velocity of the air")
    .slider(0.2, 3.0)
    .in_flight(),
    choose("air.widening", || Widening::ALL.map(Widening::name).to_vec(), Access {
        get: |case| matches!(case.air.flow, Flow::Profile(_)).then(|| case.air.widening.name().into()),
        set: |case, value| {
            let widening = named(value, &Widening::ALL, Widening::name)?;
            let remedy = match (&case.air.flow, widening) {
                (Flow::Profile(_), _) | (_, Widening::None) => {
                    case.air.widening = widening;
                    return Ok(());
                }
                (Flow::Uniform, _) => "leave it out: air that keeps its speed does not widen",
                (Flow::Field(_), _) => "leave it out: the field's own velocity across says how the flow widens",
            };
            Err(Fault::needs("air.profile", remedy))
        },
    })
    .value("none")
    .meaning(
        "Whether the mean flow of a profile widens where it slows. `md`: along y, the machine direction, as in a plane channel, \
         with the velocity `−y dU/dx` from the middle of the slot. `none`: the air only slows.",
    )
    .label("Widening of the mean flow"),
    quantity("air.turbulence_intensity", Dimension::Ratio, NotNegative, of_air!(turbulence_intensity))
        .told(|case| case.air.from_flow.turbulence_intensity)
        .required("0.1")
        .usual(1e-5, 1.0)
    .meaning("Rms of each fluctuating velocity component, divided by the mean velocity. A record, a profile or a field may give it instead.")
        .synonyms(&["turbulence level", "degree of turbulence"])
.label("Turbulence intensity *Tu*")
        .slider(0.0, 0.5)
        .in_flight(),
    quantity("air.length_scale", Dimension::Length, Positive, of_air!(length_scale))
        .told(|case| case.air.from_flow.length_scale)
        .required("50 mm")
        .usual(1e-5, 10.0)
    .meaning("Length of an eddy. Within this length the fluctuation is the same along the fibre. A record, a profile or a field may give it instead.")
        .synonyms(&["eddy size", "integral length scale"])
.label("Length of the eddies *L*_{T}")
        .slider(5e-3, 0.2),
    quantity("air.cutoff_frequency", Dimension::Frequency, Positive, of_air!(cutoff_frequency))
        .told(|case| case.air.from_flow.cutoff_frequency)
        .required("100 Hz")
        .usual(0.1, 50000.0)
    .meaning("Highest frequency of the turbulence. `taylor` stands for velocity / (4 × length scale). A record, a spectrum, a profile or a field may give it instead.")
        .label("Cut-off frequency *f*")
        .slider(10.0, 1000.0),
    quantity("air.density", Dimension::Density, NotNegative, number!(air.density))
        .value("1.204 kg/m³")
        // From a thousandth to fifty times that of the atmosphere.
    .usual(0.01, 50.0)
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
    // From compressed to hot thin air.
    .usual(5e-7, 1e-3)
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
                return Err(Fault::new(
                    format!("is not between {least} and {most} K, where the formula of the air's viscosity holds"),
                    "correct the temperature or its unit, or write air.density and air.kinematic_viscosity instead",
                ));
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
                _ => return Err(read_with_case()),
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
                return Err(read_with_case());
            };
            let rates = || records.iter().map(|record| 1.0 / record.interval);
            let first = rates().next().unwrap_or(0.0);
            if let Some(other) = rates().find(|rate| (rate / first - 1.0).abs() >= 1e-9) {
                return Err(Fault::new(
                    format!("names records of different sampling rates, {first} and {other} Hz"),
                    "resample them to the same rate",
                ));
            }
            case.air.records = records.clone();
            Ok(())
        },
    })
    .follows("turbulence is made from harmonics")
    .meaning("Measured velocity record, as CSV or Parquet, whose fluctuation moves the fibre. A list gives one record for each eddy."),
    quantity("air.record_rate", Dimension::Frequency, Positive, of_record!(rate, Value::Number, number))
        .follows("the rate of the record's time column")
        .usual(10.0, 1e6)
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
    key("air.record_max_gap", Kind::Whole(0, MOST_MISSING), of_record!(max_gap, Value::Whole, whole))
        .follows("10")
        .meaning("Largest number of missing samples in a row of a record that are interpolated."),
    choose("air.eddies", || vec!["independent", "convected"], Access {
        get: |case| Some(case.air.eddies.name().into()),
        set: |case, value| {
            let models = [EddyModel::Independent, EddyModel::Convected { decay_time: f64::INFINITY }];
            change(&mut case.air.eddies, value, &models, |model| model.name())
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
                Err(Fault::needs("air.eddies = \"convected\"", remedy))
            }
        },
    })
    .follows("no decay: the pattern is frozen; of a fed fibre, the length scale divided by the rms velocity")
    .usual(1e-6, 1000.0)
    .meaning("Time constant with which a convected pattern loses its correlation while it travels.")
    .label("Decay time of the eddies")
    .slider(1e-3, 0.1),
    choose("air.lateral", || Lateral::ALL.map(Lateral::name).to_vec(), Access {
        get: |case| Some(case.air.lateral.name().into()),
        set: |case, value| change(&mut case.air.lateral, value, &Lateral::ALL, Lateral::name),
    })
    .value("uniform")
    .meaning(
        "How the turbulence differs across the flow. `uniform`: not at all, and each fibre has turbulence of its own. \
         `von-karman`: as in isotropic turbulence, and fibres that hang side by side share their eddies.",
    )
    .label("Turbulence across the flow"),
    quantity("air.lateral_cutoff", Dimension::Ratio, Positive, Access {
        get: |case| case.air.lateral.cutoff().map(Value::Number),
        set: |case, value| match &mut case.air.lateral {
            Lateral::VonKarman { cutoff } => {
                *cutoff = number(value)?;
                Ok(())
            }
            Lateral::Uniform => {
                let remedy = "leave it out, or let the turbulence differ across the flow";
                Err(Fault::needs("air.lateral = \"von-karman\"", remedy))
            }
        },
    })
    .value("15")
    .usual(5.0, 60.0)
    .meaning(
        "Largest lateral wave number of the turbulence times its length scale. A larger one resolves smaller eddies across the \
         flow and takes more memory. Compare results of the same cut-off only.",
    )
    .label("Lateral cut-off *k*_{max}*L*_{T}")
    .slider(8.0, 25.0),
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
];
