//! Dry air at atmospheric pressure: what its temperature says about it.

use std::ops::RangeInclusive;

/// Pressure of one atmosphere [Pa].
pub(super) const PRESSURE: f64 = 101_325.0;
/// Gas constant of dry air [J/(kg K)].
const GAS_CONSTANT: f64 = 287.05;
/// Temperature at which the viscosity is known [K].
const REFERENCE: f64 = 273.15;
/// Viscosity at that temperature [Pa s].
const VISCOSITY: f64 = 1.716e-5;
/// Sutherland's temperature of air [K].
const SUTHERLAND: f64 = 110.4;

/// Heat capacity of air `c_pa` [J/(kg K)].
pub const HEAT_CAPACITY_OF_AIR: f64 = 1006.0;

/// Temperatures for which Sutherland's formula keeps within 2 % of measured viscosities [K], after F. M. White,
/// Viscous Fluid Flow.
pub const SUTHERLAND_RANGE: RangeInclusive<f64> = 170.0..=1900.0;

/// Density [kg/m³] of dry air as an ideal gas at 101,325 Pa.
///
/// * `temperature` – [K]
pub fn density_at(temperature: f64) -> f64 {
    PRESSURE / (GAS_CONSTANT * temperature)
}

/// Temperature [K] of dry air as an ideal gas at 101,325 Pa; None of a density that such air does not have.
///
/// * `density` – [kg/m³]
pub fn temperature_of(density: f64) -> Option<f64> {
    Some(PRESSURE / (GAS_CONSTANT * density)).filter(|temperature| SUTHERLAND_RANGE.contains(temperature))
}

/// Kinematic viscosity [m²/s] of dry air at 101,325 Pa: Sutherland's formula, with the constants of the U.S. Standard
/// Atmosphere 1976, over the density.
///
/// * `temperature` – [K]
pub fn kinematic_viscosity_at(temperature: f64) -> f64 {
    let ratio = temperature / REFERENCE;
    let viscosity = VISCOSITY * ratio * ratio.sqrt() * (REFERENCE + SUTHERLAND) / (temperature + SUTHERLAND);
    viscosity / density_at(temperature)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_air_of_the_standard_atmosphere() {
        // U.S. Standard Atmosphere 1976 at sea level, 15 °C: 1.2250 kg/m³ and 1.4607e-5 m²/s, of five digits. It has
        // the same formulas; its constants are rounded to 5e-5 here.
        assert!((density_at(288.15) / 1.2250 - 1.0).abs() < 1e-4);
        assert!((kinematic_viscosity_at(288.15) / 1.4607e-5 - 1.0).abs() < 2e-4);
    }

    #[test]
    fn published_air_at_one_atmosphere() {
        // Çengel, Heat and Mass Transfer, Table A-15, "Properties of air at 1 atm pressure". Density has four digits.
        // Tables of the viscosity differ by 1 % among themselves: at 20 °C this one has 1.825e-5 Pa s, the standard
        // atmosphere 1.813e-5.
        for (celsius, density, viscosity) in [
            (-20.0, 1.394, 1.169e-5),
            (0.0, 1.292, 1.338e-5),
            (20.0, 1.204, 1.516e-5),
            (60.0, 1.059, 1.896e-5),
            (100.0, 0.9458, 2.306e-5),
        ] {
            let kelvin = celsius + 273.15;
            let of_density = density_at(kelvin) / density - 1.0;
            let of_viscosity = kinematic_viscosity_at(kelvin) / viscosity - 1.0;
            assert!(of_density.abs() < 1e-3, "{celsius} °C: {of_density}");
            assert!(of_viscosity.abs() < 0.01, "{celsius} °C: {of_viscosity}");
        }
    }
}
