//! The constants of the polymer.

use super::{known, of_spinline, spinline, spun};
use crate::case::keys::Key;
use crate::case::keys::row::{Access, key, number, quantity};
use crate::case::keys::value::Kind;
use crate::case::keys::value::Sign::{Any, NotNegative, Positive, Share};
use crate::spinline::Melt;
use spunlaid_ground::Dimension;

/// A constant of the polymer.
macro_rules! constant {
    ($name:literal, $dimension:ident, $sign:ident, $($field:ident).+, $usual:expr) => {
        quantity(concat!("spinline.material.", $name), Dimension::$dimension, $sign, $usual)
        .access(of_spinline!(material.$($field).+))
        .follows("the polymer's")
    };
}

pub(super) const KEYS: &[Key] = &[
    key("spinline.material.source", Kind::Text("data sheet of the grade, 2024"))
        .access(at!(spun, spinline, source))
        .follows("the polymer's")
        .meaning("Where the constants come from. A file with a polymer needs it."),
    quantity("spinline.material.viscosity", Dimension::DynamicViscosity, Positive, (0.1, 1e5))
        .access(Access {
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
        .alternative_to(
            &["spinline.melt_flow_rate"],
            "the melt flow rate gives the viscosity; write one of the two",
        )
        .follows("that of the polymer, or that of the melt flow rate")
        .meaning(
            "Viscosity of the melt at `viscosity_temperature` and at low rates, which depends on the grade.",
        )
        .label("Viscosity *η*_{r}"),
    constant!("viscosity_temperature", Temperature, Positive, viscosity_temperature, (373.15, 723.15))
        .meaning("Temperature at which `viscosity` or the melt flow rate was measured.")
        .label("Reference temperature *T*_{r}"),
    constant!("activation_energy", MolarEnergy, NotNegative, activation_energy, (1000.0, 1e6))
        .meaning("Activation energy of the viscosity (Arrhenius).")
        .label("Activation energy *E*_{a}"),
    constant!(
        "solidification_temperature",
        Temperature,
        Positive,
        solidification_temperature,
        (200.0, 600.0)
    )
    .meaning("Temperature at which the filament is solid.")
    .label("Solidification temperature *T*_{s}"),
    constant!("solid_density", Density, Positive, solid_density, (500.0, 3000.0))
        .meaning("Density of the cold filament.")
        .label("Density of the solid"),
    constant!("surface_tension", SurfaceTension, NotNegative, surface_tension, (0.001, 0.5))
        .meaning("Surface tension of the melt; zero leaves it out.")
        .label("Surface tension *σ*"),
    constant!("modulus", Pressure, Positive, modulus, (100.0, 1e8))
        .meaning("Elastic modulus G of the melt, for the viscoelastic laws.")
        .label("Modulus of the melt *G*"),
    constant!("mobility", Ratio, Share, mobility, (0.001, 1.0))
        .meaning("Mobility α of the Giesekus law, from 0 to 1.")
        .label("Mobility *α*"),
    constant!("extensibility", Ratio, NotNegative, extensibility, (0.0001, 1.0))
        .meaning("Parameter ε of the Phan-Thien–Tanner laws.")
        .label("Extensibility *ε*"),
    constant!("heat_capacity", HeatCapacity, Positive, heat_capacity, (200.0, 1e4))
        .meaning("Heat capacity of the melt at 0 °C, extrapolated.")
        .label("Heat capacity *c*_{0}"),
    constant!("heat_capacity_slope", HeatCapacitySlope, Any, heat_capacity_slope, (0.01, 50.0))
        .meaning("Rise of the heat capacity with the temperature.")
        .label("Slope of the heat capacity *c*_{1}"),
    constant!("specific_volume", SpecificVolume, Positive, specific_volume, (0.0001, 0.01))
        .meaning("Specific volume of the melt at 0 °C, extrapolated.")
        .label("Specific volume *a*_{0}"),
    constant!("specific_volume_slope", SpecificVolumeSlope, Any, specific_volume_slope, (1e-8, 1e-5))
        .meaning("Rise of the specific volume with the temperature.")
        .label("Slope of the specific volume *a*_{1}"),
    constant!(
        "stress_optical_coefficient",
        InversePressure,
        NotNegative,
        stress_optical_coefficient,
        (1e-11, 1e-7)
    )
    .meaning("Stress-optical coefficient C of the melt: the birefringence is C times the stress.")
    .label("Stress-optical coefficient"),
    constant!(
        "stress_optical_temperature",
        Temperature,
        Positive,
        stress_optical_temperature,
        (200.0, 700.0)
    )
    .meaning(
        "Temperature of `stress_optical_coefficient`, which is proportional to 1/T, or constant without this key.",
    )
    .label("Temperature of the stress-optical coefficient"),
    constant!("full_birefringence", Ratio, Positive, full_birefringence, (0.001, 1.0))
        .meaning("Birefringence of the fully oriented polymer.")
        .label("Birefringence of full orientation"),
    constant!("unoriented_modulus", Pressure, Positive, unoriented_modulus, (1e7, 1e12))
        .meaning(
            "Young's modulus of the solid filament without orientation.",
        )
        .label("Young’s modulus without orientation *E*_{0}"),
    constant!("oriented_modulus", Pressure, Positive, oriented_modulus, (1e7, 1e12))
        .meaning("Young's modulus of the solid filament with full orientation.")
        .label("Young’s modulus with full orientation *E*_{1}"),
    constant!("avrami_exponent", Ratio, Positive, crystals.avrami_exponent, (0.5, 5.0))
        .meaning("Exponent n of Nakamura's law.")
        .label("Avrami exponent *n*"),
    constant!("crystallisation_rate", Rate, NotNegative, crystals.rate, (0.0001, 100.0))
        .meaning("Largest rate of crystallisation without orientation.")
        .label("Crystallisation rate *K*_{m}"),
    constant!("crystallisation_peak", Temperature, Positive, crystals.peak, (200.0, 600.0))
        .meaning("Temperature of the largest rate of crystallisation.")
        .label("Temperature of the largest rate *T*_{m}"),
    constant!("crystallisation_width", TemperatureDifference, Positive, crystals.width, (1.0, 300.0))
        .meaning("Half width of the rate's bell over the temperature.")
        .label("Half width *D*"),
    constant!("melting_temperature", Temperature, Positive, crystals.melting_temperature, (200.0, 700.0))
        .meaning("Melting temperature, above which nothing crystallises.")
        .label("Melting temperature *T*_{f}"),
    constant!("crystallinity", Ratio, Share, crystals.crystallinity, (0.01, 1.0))
        .meaning("Crystallinity of the fully transformed polymer.")
        .label("Crystallinity *X*_{∞}"),
    constant!("heat_of_fusion", SpecificEnergy, NotNegative, crystals.heat_of_fusion, (1000.0, 1e6))
        .meaning("Heat of fusion of the crystals.")
        .label("Heat of fusion Δ*H*"),
    constant!("orientation_enhancement", Ratio, NotNegative, crystals.orientation_enhancement, (1.0, 1e5))
        .meaning(
            "Factor C by which orientation speeds up crystallisation, exp(C f²). It was chosen, for pet by the \
             start of the neck (700 to 1500).",
        )
        .label("Enhancement by orientation *C*"),
    constant!("enhancement_limit", Ratio, Positive, crystals.enhancement_limit, (1.0, 1e8))
        .meaning("Largest enhancement by orientation. It was chosen.")
        .label("Largest enhancement *M*"),
    constant!("hardening_factor", Ratio, NotNegative, crystals.hardening_factor, (0.1, 100.0))
        .meaning("Factor a of the viscosity's rise by crystals, exp(a θ^b). It was chosen.")
        .label("Hardening *a*"),
    constant!("hardening_exponent", Ratio, Positive, crystals.hardening_exponent, (0.1, 10.0))
        .meaning("Exponent b of the viscosity's rise by crystals. It was chosen.")
        .label("Exponent of the hardening *b*"),
    constant!("solidification_fraction", Ratio, Share, crystals.solidification_fraction, (0.001, 1.0))
        .meaning("Transformed fraction at which the filament is solid. It was chosen.")
        .label("Transformed fraction at solidification *θ*_{s}"),
];
