//! Cantilevers at rest, under a load at the tip and their weight.

use super::*;
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Fibre, FibreParameters, Flight, Root};
use spunlaid_ground::{Isa, Lanes, Vec3, WIDTH};

/// A beam along y, so slender that it bends and hardly stretches: `(d/L)² α/16` is a strain of 1e-5 at most.
pub fn slender_beam(elements: usize) -> Fibre {
    Fibre {
        length: 1.0,
        diameter: 2e-3,
        density: 1000.0,
        youngs_modulus: 1e9,
        elements,
        root: Root::Clamped,
        direction: Y,
        ..Fibre::UNKNOWN
    }
}

/// Tip deflection along x and shortening along y, by the length, of each lane's beam under a load at its
/// tip (lane by lane) and its own weight, once all motion has died out.
pub fn at_rest(elements: usize, tip_load: [f64; WIDTH], gravity: [f64; WIDTH]) -> Vec<(f64, f64)> {
    let fibre = slender_beam(elements);
    // First mode: 3.516 √(EI/ρA)/L² = 0.88 rad/s; damping near critical for it stops everything.
    let stiffness = fibre.youngs_modulus * fibre.second_moment();
    let w1 = 3.516 * (stiffness / (fibre.density * fibre.cross_section())).sqrt();
    let strands: Vec<FibreParameters> = gravity
        .iter()
        .map(|&g| FibreParameters { fibre, drag: NO_DRAG, gravity: g, damping: 2.0 * w1 })
        .collect();
    let h = 0.6 * fibre.axial_step_limit().min(fibre.bending_step_limit());
    let duration = 25.0 / w1;
    let (eddies, turbulence) = steady_air(0.0, elements, duration);
    let mut flight =
        Flight::assembled(Isa::detect(), &strands, (&eddies, &turbulence), Scheme::SemiImplicitEuler, h)
            .expect("fibres that agree");
    // The tip load as a kick of the tip's momentum before every step.
    let kick =
        Vec3::new(Lanes(tip_load), Lanes::ZERO, Lanes::ZERO) * Lanes::splat(h / fibre.node_mass(elements));
    for _ in 0..(duration / h) as u64 {
        flight.push(elements, kick);
        flight.advance(1);
    }
    let tip = flight.chain().position[elements];
    (0..WIDTH).map(|i| (tip.x.0[i], 1.0 - tip.y.0[i])).collect()
}
