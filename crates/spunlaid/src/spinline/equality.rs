//! When two polymers are the same.

use super::{Crystals, Material};

/// Two polymers are equal if the same constants are known of both, with the same values. A constant that is not known is NaN,
/// which is not equal to itself.
impl PartialEq for Material {
    fn eq(&self, other: &Self) -> bool {
        self.bits() == other.bits() && self.crystals == other.crystals
    }
}

impl PartialEq for Crystals {
    fn eq(&self, other: &Self) -> bool {
        self.bits() == other.bits()
    }
}

impl Material {
    fn bits(&self) -> [u64; 17] {
        let Self {
            specific_volume,
            specific_volume_slope,
            heat_capacity,
            heat_capacity_slope,
            viscosity,
            viscosity_temperature,
            activation_energy,
            freezing_temperature,
            solid_density,
            surface_tension,
            modulus,
            mobility,
            extensibility,
            stress_optical_coefficient,
            full_birefringence,
            unoriented_modulus,
            oriented_modulus,
            crystals: _,
        } = *self;
        [
            specific_volume,
            specific_volume_slope,
            heat_capacity,
            heat_capacity_slope,
            viscosity,
            viscosity_temperature,
            activation_energy,
            freezing_temperature,
            solid_density,
            surface_tension,
            modulus,
            mobility,
            extensibility,
            stress_optical_coefficient,
            full_birefringence,
            unoriented_modulus,
            oriented_modulus,
        ]
        .map(f64::to_bits)
    }
}

impl Crystals {
    fn bits(&self) -> [u64; 12] {
        let Self {
            avrami_exponent,
            rate,
            peak,
            width,
            melting_temperature,
            crystallinity,
            heat_of_fusion,
            orientation_enhancement,
            enhancement_limit,
            hardening_factor,
            hardening_exponent,
            freezing_share,
        } = *self;
        [
            avrami_exponent,
            rate,
            peak,
            width,
            melting_temperature,
            crystallinity,
            heat_of_fusion,
            orientation_enhancement,
            enhancement_limit,
            hardening_factor,
            hardening_exponent,
            freezing_share,
        ]
        .map(f64::to_bits)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Polymer;
    use super::*;

    #[test]
    fn polymers_are_equal_also_where_a_constant_is_not_known() {
        for polymer in Polymer::ALL {
            let material = polymer.material(false);
            assert_eq!(material, polymer.material(false));
            assert_ne!(material, Material { viscosity: 123.0, ..material });
            let crystals = Crystals { rate: 123.0, ..material.crystals };
            assert_ne!(material, Material { crystals, ..material });
        }
        assert!(
            Polymer::Pp.material(false).viscosity.is_nan()
                && Polymer::Pla.material(false).crystals.rate.is_nan()
        );
    }
}
