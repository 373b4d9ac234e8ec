//! The numbers of the air: strength and size of its turbulence, density and viscosity.

use crate::case::keys::row::{Access, number, of_any_size, quantity, take};
use crate::case::keys::value::Sign::{Any, NotNegative, Positive};
use crate::case::keys::value::Value;
use crate::case::keys::{Key, TAYLOR};
use spunlaid_air::USUAL_LENGTH_SCALE;
use spunlaid_air::motion::{density_at, kinematic_viscosity_at};
use spunlaid_air::{Air, RecordNumbers, SUTHERLAND_RANGE, SpectrumShape};
use spunlaid_ground::{Dimension, Fault};

/// Takes a number of the air from the flow, which is asked for it when the air is settled, or from a file.
macro_rules! from_air {
    ($field:ident, $of_file:expr) => {
        |case| {
            let of_file: fn(&Air) -> Option<f64> = $of_file;
            let of_file = of_file(&case.air);
            case.air.from_flow.$field = case.air.flow.numbers().$field;
            case.air.from_flow.$field || take(&mut case.air.$field, of_file)
        }
    };
}

/// What the first record says of the air.
fn said(air: &Air) -> Option<RecordNumbers> {
    Some(air.records.first()?.says)
}

/// The highest frequency of a measured spectrum or of a record.
fn highest(air: &Air) -> Option<f64> {
    match &air.spectrum {
        SpectrumShape::Measured(table) => Some(table.highest()),
        _ => Some(said(air)?.cutoff_frequency),
    }
}

/// Sets the cut-off frequency by Taylor's hypothesis: eddies of length `L` that pass at velocity `U` make
/// `U/(4 L)`.
fn by_taylor(air: &mut Air) -> Result<(), Fault> {
    if !air.is_uniform() || air.from_flow.length_scale {
        let needed = "air.velocity and air.length_scale";
        let remedy = "write a frequency, or leave it out";
        return Err(Fault::needs(needed, remedy));
    }
    // NaN where either is missing, which has been reported.
    air.cutoff_frequency = air.velocity.abs() / (4.0 * air.length_scale);
    Ok(())
}

/// The fault of a temperature for which the formula of the viscosity does not hold.
fn beyond_sutherland() -> Fault {
    let (least, most) = (*SUTHERLAND_RANGE.start(), *SUTHERLAND_RANGE.end());
    Fault::new(
        format!("is not between {least} and {most} K, where the formula of the air's viscosity holds"),
        "correct the temperature or its unit, or write air.density and air.kinematic_viscosity instead",
    )
}

pub(in super::super) const KEYS: &[Key] = &[
    quantity("air.turbulence_intensity", Dimension::Ratio, NotNegative, (1e-5, 1.0))
        .access(of_air!(turbulence_intensity))
        .derived(|case| case.air.from_flow.turbulence_intensity)
        .inferred(from_air!(turbulence_intensity, |air| said(air)?.turbulence_intensity))
        .required("0.1")
        .meaning(
            "Rms of each fluctuating velocity component over the mean velocity. A record, a profile \
             or a field may give it.",
        )
        .synonyms(&["turbulence level", "degree of turbulence"])
        .label("Turbulence intensity *Tu*")
        .slider(0.0, 0.5)
        .in_flight(),
    quantity("air.length_scale", Dimension::Length, Positive, USUAL_LENGTH_SCALE)
        .access(of_air!(length_scale))
        .derived(|case| case.air.from_flow.length_scale)
        .inferred(from_air!(length_scale, |air| said(air)?.length_scale))
        .required("50 mm")
        .meaning(
            "Integral length scale of the turbulence: the length of an eddy. A record, a profile or a field may \
             give it.",
        )
        .synonyms(&["eddy size", "integral length scale"])
        .label("Integral length scale *L*_{T}")
        .slider(5e-3, 0.2),
    quantity("air.cutoff_frequency", Dimension::Frequency, Positive, (0.1, 5e4))
        .access(Access {
            get: |case| Some(Value::Number(case.air.cutoff_frequency)),
            set: |case, value| {
                if matches!(value, Value::Text(word) if word == TAYLOR) {
                    return by_taylor(&mut case.air);
                }
                case.air.cutoff_frequency = number(value)?;
                case.air.from_flow.cutoff_frequency = false;
                Ok(())
            },
        })
        .read_after(&["air.velocity", "air.length_scale"])
        .derived(|case| case.air.from_flow.cutoff_frequency)
        .inferred(from_air!(cutoff_frequency, highest))
        .required("100 Hz")
        .or_words(&[TAYLOR])
        .meaning(
            "Highest frequency of the turbulence. `taylor` means velocity / (4 × length scale). A record, \
             a spectrum, a profile or a field may give it.",
        )
        .label("Cut-off frequency *f*")
        .slider(10.0, 1000.0),
    quantity("air.intensity_factor", Dimension::Ratio, NotNegative, (0.01, 100.0))
        .access(of_flow!(turbulence_intensity, intensity_factor))
        .value("1")
        .meaning("Factor on the turbulence intensity of a profile or a field.")
        .label("Factor on the turbulence intensity")
        .slider(0.2, 3.0),
    quantity("air.length_factor", Dimension::Ratio, Positive, (0.01, 100.0))
        .access(of_flow!(length_scale, length_factor))
        .value("1")
        .meaning(
            "Factor on the length scale of a profile or a field; the cut-off frequency is divided by it.",
        )
        .synonyms(&["eddy size"])
        .label("Factor on the length scale")
        .slider(0.2, 3.0),
    // From a thousandth to fifty times that of the atmosphere.
    quantity("air.density", Dimension::Density, NotNegative, (0.01, 50.0))
        .access(at!(air.density))
        .value("1.204 kg/m³")
        .meaning("Density of the air, by default at 20 °C. `0 kg/m³` is a vacuum.")
        .label("Air density")
        .slider(0.0, 2.0)
        .in_flight(),
    // From compressed to hot thin air.
    quantity("air.kinematic_viscosity", Dimension::KinematicViscosity, Positive, (5e-7, 1e-3))
        .access(at!(air.kinematic_viscosity))
        .value("1.51e-5 m²/s")
        .meaning("Kinematic viscosity of the air, by default at 20 °C.")
        .label("Kinematic viscosity *ν*")
        .slider(1e-5, 6e-5)
        .in_flight(),
    of_any_size("air.temperature", Dimension::Temperature, Any)
        .access(Access {
            get: |_| None,
            set: |case, value| {
                let temperature = number(value)?;
                if !SUTHERLAND_RANGE.contains(&temperature) {
                    return Err(beyond_sutherland());
                }
                case.air.density = density_at(temperature);
                case.air.kinematic_viscosity = kinematic_viscosity_at(temperature);
                Ok(())
            },
        })
        .alternative_to(
            &["air.density", "air.kinematic_viscosity"],
            "the temperature gives density and viscosity; leave it out, or leave out both of these",
        )
        .follows("density and viscosity as they are written, or at 20 °C")
        .meaning(
            "Temperature of the air, from 170 to 1900 K, instead of `air.density` and \
             `air.kinematic_viscosity`, which follow for dry air at 101325 Pa.",
        )
        .label("Air temperature")
        .slider(253.15, 373.15),
];
