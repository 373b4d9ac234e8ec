//! Each element feels the velocity of its own eddy, on meshes finer than, as fine as and coarser than the eddies.

use crate::common::reference::{ReferenceDrag, forces};
use crate::common::*;
use spunlaid_air::{Air, Eddies, StreamKey, Wind};
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Fibre, FibreParameters, Flight, Root};
use spunlaid_ground::Isa;

#[test]
fn analytic_every_element_feels_its_own_eddy() {
    // Straight and unstretched, so that the drag is the only force.
    let fibre = Fibre { elements: 30, root: Root::Free, ..table1_fibre() };
    let air = Air { turbulence_intensity: 0.5, ..table1_air() };
    let drag = paper_drag().element_drag(&fibre, air.density, air.kinematic_viscosity);
    let strand = FibreParameters { fibre, drag, gravity: 0.0, damping: 0.0 };
    let law = ReferenceDrag { air_density: air.density, viscosity: air.kinematic_viscosity, beta: 0.9 };
    let l = fibre.rest_length();
    let r: Vec<V> = (0..=fibre.elements).map(|i| X * (l * i as f64)).collect();
    let still = vec![V::default(); r.len()];
    for length_scale in [0.07, l, 0.019, 2.0] {
        let eddies = Eddies::along(fibre.length, fibre.elements, length_scale);
        let key = StreamKey { seed: 2, replicate: 0 };
        let turbulence = Wind::uniform(Isa::detect(), &[(air.clone(), key)], eddies.count(), 0.1)
            .expect("fibres that agree");
        let wind = turbulence.clone().at(0.0);
        // theory.md (23), with a nudge against rounding where a centre lies on a border.
        let eddy = |j: usize| ((j as f64 + 0.5) * l / length_scale + 1e-9) as usize;
        let felt: Vec<V> = (0..fibre.elements).map(|j| wind[eddy(j)].lane(0)).collect();
        let expected = forces(&strand, Some(&law), &felt, &r, &still);

        let h = 1e-6;
        let scheme = Scheme::SemiImplicitEuler;
        let mut flight = Flight::assembled(Isa::detect(), &[strand], (&eddies, &turbulence), scheme, h)
            .expect("fibres that agree");
        flight.advance(1);
        // The axial stiffness times the rounding of positions.
        let rounding = fibre.axial_stiffness() * 4.0 * f64::EPSILON;
        for (i, &f) in expected.iter().enumerate() {
            let found = flight.chain().velocity[i].lane(0) * (fibre.node_mass(i) / h);
            // The kernel's powers are good to 1e-7.
            let bound = 1e-7 * f.norm() + rounding;
            assert!((found - f).norm() < bound, "eddies of {length_scale} m, node {i}: {found:?}, not {f:?}");
        }
    }
}
