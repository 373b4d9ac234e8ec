//! Air that is blown through the fabric.

use spunlaid_ground::Known;

/// Viscosity [Pa s] and density [kg/m³] of air at 20 °C and 1013 hPa, the climate of the test.
const VISCOSITY: f64 = 1.82e-5;
const DENSITY: f64 = 1.204;
/// Factor of Ergun's inertial term.
const ERGUN: f64 = 1.75;
/// Diameter of a sphere with as much surface in its volume as a long cylinder, over the diameter of that.
const SPHERE: f64 = 1.5;
/// Highest solid fraction up to which the formulas are meant.
pub(crate) const DENSEST: f64 = 0.3;
/// What the formulas are worth: beds of fibres are between a half and twice the permeability that they give.
const WORTH: f64 = 2.0;

/// Filaments of one kind in a layered fabric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Filaments {
    /// Diameter [m].
    pub diameter: f64,
    /// Density of the polymer [kg/m³].
    pub density: f64,
    /// Their mass per area [kg/m²].
    pub basis_weight: f64,
}

/// Permeability of a bed of fibres across the flow [m²].                        theory.md (106)
///
/// * `solid` – share of the volume that is fibre
///
/// Source: C. N. Davies, Proc. Inst. Mech. Eng. B 1 (1952) 185–213.
pub(crate) fn davies(diameter: f64, solid: f64) -> f64 {
    diameter * diameter / (64.0 * solid * solid.sqrt() * (1.0 + 56.0 * solid.powi(3)))
}

/// Permeability of fibres in all directions [m²].                               theory.md (107)
///
/// * `solid` – share of the volume that is fibre
///
/// Source: G. W. Jackson, D. F. James, Can. J. Chem. Eng. 64 (1986) 364–374.
pub(crate) fn jackson_james(diameter: f64, solid: f64) -> f64 {
    0.15 * (0.5 * diameter).powi(2) / solid * (-libm::log(solid) - 0.931)
}

/// Speed of the air that a pressure drives through a fabric [m/s]: the positive root of `Δp/t = ηv/K + βϱv²`,
/// with Ergun's inertial term `β = 1.75 α/((1 − α)³ D)` of spheres with the surface of the fibres,
/// `D = 1.5 d`. Layers lie one behind the other. Where there is next to no fibre, air is not faster than a
/// jet, `√(2Δp/ϱ)`.                                                                           theory.md (108)
///
/// * `weight` – at the place over the mean: so much more fibre is in the same thickness
///
/// Source: S. Ergun, Chem. Eng. Prog. 48 (1952) 89–94.
pub fn air_speed(
    filaments: &[Filaments],
    weight: f64,
    thickness: f64,
    pressure: f64,
    permeability: impl Fn(f64, f64) -> f64,
) -> f64 {
    let volume = |of: &Filaments| of.basis_weight / of.density;
    let whole: f64 = filaments.iter().map(volume).sum();
    let jet = (2.0 * pressure / DENSITY).sqrt();
    // Heavy places of a fabric that is thinner than this let hardly any air through.
    let solid = (weight * whole / thickness).min(DENSEST);
    if solid <= 0.0 {
        return jet;
    }
    let (mut viscous, mut inertial) = (0.0, 0.0);
    for of in filaments {
        let depth = thickness * volume(of) / whole;
        viscous += depth * VISCOSITY / permeability(of.diameter, solid);
        inertial += depth * DENSITY * ERGUN * solid / ((1.0 - solid).powi(3) * SPHERE * of.diameter);
    }
    jet.min(2.0 * pressure / (viscous + (viscous * viscous + 4.0 * inertial * pressure).sqrt()))
}

/// Share of the fabric's volume that is fibre.
pub(crate) fn solid_fraction(filaments: &[Filaments], thickness: f64) -> f64 {
    filaments.iter().map(|of| of.basis_weight / of.density).sum::<f64>() / thickness
}

/// Speed of the air [m/s], the mean over all places, from half of the lower one to twice the higher one of the
/// permeabilities by both formulas; none of a fabric that is denser than they are meant for.
///
/// * `local` – the weight at each place over the mean
pub(crate) fn air_permeability(
    filaments: &[Filaments],
    local: &[f64],
    thickness: f64,
    pressure: f64,
) -> Option<Known> {
    let solid = solid_fraction(filaments, thickness);
    let mean = |permeability: &dyn Fn(f64, f64) -> f64| {
        let at = |weight: &f64| air_speed(filaments, *weight, thickness, pressure, permeability);
        local.iter().map(at).sum::<f64>() / local.len() as f64
    };
    (solid > 0.0 && solid <= DENSEST && !local.is_empty()).then(|| {
        Known::Between([
            mean(&|diameter, solid| davies(diameter, solid).min(jackson_james(diameter, solid)) / WORTH),
            mean(&|diameter, solid| davies(diameter, solid).max(jackson_james(diameter, solid)) * WORTH),
        ])
    })
}

/// Relative change of the speed for that of the basis weight at the same thickness, by Davies.
pub(crate) fn sensitivity(filaments: &[Filaments], thickness: f64, pressure: f64) -> f64 {
    const STEP: f64 = 1e-3;
    let [low, high] = [1.0 - STEP, 1.0 + STEP]
        .map(|factor| libm::log(air_speed(filaments, factor, thickness, pressure, davies)));
    (high - low) / (2.0 * STEP)
}

#[cfg(test)]
mod tests {
    use super::*;

    const OF_EXAMPLE: Filaments = Filaments { diameter: 18e-6, density: 910.0, basis_weight: 17e-3 };
    const THICKNESS: f64 = 0.2e-3;

    #[test]
    fn published_permeabilities_of_a_fabric_of_17_grams() {
        let solid = solid_fraction(&[OF_EXAMPLE], THICKNESS);
        assert!((solid - 0.0934).abs() < 5e-5, "{solid}");
        for (formula, permeability, speed) in
            [(davies as fn(f64, f64) -> f64, 1.70e-10, 9.3), (jackson_james, 1.87e-10, 10.3)]
        {
            let found = formula(18e-6, solid);
            assert!((found / permeability - 1.0).abs() < 3e-3, "{found}");
            // Without inertia.
            let creeping = 200.0 * found / (VISCOSITY * THICKNESS);
            assert!((creeping / speed - 1.0).abs() < 3e-3, "{creeping}");
            let with = air_speed(&[OF_EXAMPLE], 1.0, THICKNESS, 200.0, formula);
            assert!((0.5..0.67).contains(&(with / creeping)), "{with} of {creeping}");
        }
    }

    /// At the same solid fraction the permeability is the same, and twice the weight lets half the air
    /// through at small speeds.
    #[test]
    fn analytic_twice_the_weight_at_the_same_solid_fraction() {
        let twice = Filaments { basis_weight: 2.0 * OF_EXAMPLE.basis_weight, ..OF_EXAMPLE };
        assert_eq!(
            solid_fraction(&[twice], 2.0 * THICKNESS).to_bits(),
            solid_fraction(&[OF_EXAMPLE], THICKNESS).to_bits()
        );
        let speed = |of, thickness, pressure| air_speed(&[of], 1.0, thickness, pressure, davies);
        assert_eq!(
            speed(twice, 2.0 * THICKNESS, 400.0).to_bits(),
            speed(OF_EXAMPLE, THICKNESS, 200.0).to_bits()
        );
        let ratio = speed(twice, 2.0 * THICKNESS, 1e-3) / speed(OF_EXAMPLE, THICKNESS, 1e-3);
        assert!((ratio - 0.5).abs() < 1e-4, "{ratio}");
        // Two layers of half the weight each are the same fabric.
        let half = Filaments { basis_weight: 0.5 * OF_EXAMPLE.basis_weight, ..OF_EXAMPLE };
        let layered = air_speed(&[half, half], 1.0, THICKNESS, 200.0, davies);
        assert!((layered / speed(OF_EXAMPLE, THICKNESS, 200.0) - 1.0).abs() < 1e-12);
    }

    /// Without inertia the speed changes as Davies's permeability, `1/(s^1.5 (1 + 56 s³))` of a solid fraction s.
    #[test]
    fn analytic_the_sensitivity_to_the_weight_is_that_of_the_permeability() {
        for thickness in [THICKNESS, 0.1e-3] {
            let solid = solid_fraction(&[OF_EXAMPLE], thickness);
            let wanted = -1.5 - 168.0 * solid.powi(3) / (1.0 + 56.0 * solid.powi(3));
            let found = sensitivity(&[OF_EXAMPLE], thickness, 1e-3);
            assert!((found / wanted - 1.0).abs() < 1e-4, "{found} {wanted}");
        }
    }

    #[test]
    fn rejects_a_fabric_that_is_denser_than_the_formulas() {
        assert_eq!(air_permeability(&[OF_EXAMPLE], &[1.0], 0.05e-3, 200.0), None);
        assert!(air_permeability(&[OF_EXAMPLE], &[1.0], THICKNESS, 200.0).is_some());
    }

    /// Without inertia the speed of an even fabric is between a half and twice that of a formula, however near
    /// the two formulas are to each other.
    #[test]
    fn analytic_the_range_of_an_even_fabric() {
        for weight in [0.2, 0.5, 1.0, 1.5] {
            let of = Filaments { basis_weight: weight * OF_EXAMPLE.basis_weight, ..OF_EXAMPLE };
            let solid = solid_fraction(&[of], THICKNESS);
            let Some(Known::Between([low, high])) = air_permeability(&[of], &[1.0; 3], THICKNESS, 1e-3)
            else {
                panic!("no range at {weight}")
            };
            let speeds =
                [davies, jackson_james].map(|formula| 1e-3 * formula(18e-6, solid) / (VISCOSITY * THICKNESS));
            assert!((low / (0.5 * speeds[0].min(speeds[1])) - 1.0).abs() < 1e-3, "{low} {speeds:?}");
            assert!((high / (2.0 * speeds[0].max(speeds[1])) - 1.0).abs() < 1e-3, "{high} {speeds:?}");
        }
    }

    /// Air goes through the light places of a cloudy fabric: the mean is that of the places, above the speed at
    /// the mean weight, and a bare place lets no more through than a jet of `√(2Δp/ϱ)`.
    #[test]
    fn analytic_clouds_let_more_air_through() {
        let at = |weights: &[f64]| match air_permeability(&[OF_EXAMPLE], weights, THICKNESS, 200.0) {
            Some(Known::Between(ends)) => ends,
            other => panic!("{other:?}"),
        };
        let [even, cloudy] = [at(&[1.0]), at(&[0.7, 1.3])];
        let [light, heavy] = [at(&[0.7]), at(&[1.3])];
        for end in 0..2 {
            assert!((cloudy[end] / (0.5 * (light[end] + heavy[end])) - 1.0).abs() < 1e-12);
            assert!((1.05..1.3).contains(&(cloudy[end] / even[end])), "{cloudy:?} {even:?}");
            assert!((at(&[0.0])[end] - (400.0 / DENSITY).sqrt()).abs() < 1e-9);
        }
    }
}
