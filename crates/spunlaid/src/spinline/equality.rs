//! When two polymers are the same.

use super::{Crystals, Material};

/// Two polymers are equal if the same constants are known of both, with the same values. A constant that is
/// not known is NaN, which is not equal to itself. So their texts are compared: that of NaN is always the
/// same, and different numbers have different texts.
impl PartialEq for Material {
    fn eq(&self, other: &Self) -> bool {
        format!("{self:?}") == format!("{other:?}")
    }
}

impl PartialEq for Crystals {
    fn eq(&self, other: &Self) -> bool {
        format!("{self:?}") == format!("{other:?}")
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
