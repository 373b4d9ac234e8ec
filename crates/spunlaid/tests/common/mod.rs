//! What the tests share: still air, a flight to start from, a plain scalar force model.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used, clippy::panic)]

pub mod beams;
pub mod coiling;
pub mod laying;
pub mod modes;
pub mod reference;

use spunlaid_air::{Air, Eddies, StreamKey, Wind};
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{
    Case, Drag, ElementDrag, Fibre, FibreParameters, Flight, FrictionLaw, Growth, NormalLaw, Root, Run, Share,
};
use spunlaid_ground::{Isa, Lanes, Vec3};

pub type V = Vec3<f64>;

pub const X: V = V::new(1.0, 0.0, 0.0);
pub const Y: V = V::new(0.0, 1.0, 0.0);
pub const NO_DRAG: ElementDrag = {
    let none = Share { factor: 0.0, growth: Growth::Power(0.5) };
    ElementDrag { along: none, across: none }
};

/// The fibre of the paper's Table 1.
pub fn table1_fibre() -> Fibre {
    Fibre {
        length: 1.0,
        diameter: 50e-6,
        density: 950.0,
        youngs_modulus: 2e9,
        elements: 20,
        root: Root::Pinned,
        direction: X,
        ..Fibre::UNKNOWN
    }
}

/// The air of the paper's Table 1.
pub fn table1_air() -> Air {
    Air::uniform(10.0, 0.1, 0.05, 100.0)
}

pub fn paper_drag() -> Drag {
    Drag { along: FrictionLaw::Matsui { factor: 0.9 }, across: NormalLaw::JuShambaugh }
}

/// Table 1 of the paper, seed 1 and no spin-up, recorded every millisecond or, if this is longer, every step.
pub fn table1(scheme: Scheme, time_step: f64, duration: f64, replicates: u64) -> Case {
    let run = Run {
        time_step,
        steps: (duration / time_step).round() as u64,
        output_steps: ((1e-3 / time_step).round() as u64).max(1),
        replicates,
        seed: 1,
        scheme,
        gravity: 9.81,
        damping: 0.0,
        ..Run::UNKNOWN
    };
    Case { fibre: table1_fibre(), air: table1_air(), drag: paper_drag(), line: None, spinline: None, run }
}

/// A fibre in a vacuum.
pub fn in_vacuum(fibre: Fibre, gravity: f64) -> FibreParameters {
    FibreParameters { fibre, drag: NO_DRAG, gravity, damping: 0.0 }
}

/// Air of a steady velocity along x, without turbulence.
pub fn steady_air(velocity: f64, elements: usize, duration: f64) -> (Eddies, Wind) {
    let air = Air { velocity, turbulence_intensity: 0.0, harmonics: 8, ..table1_air() };
    let eddies = Eddies::along(1.0, elements, 2.0);
    let key = StreamKey { seed: 0, replicate: 0 };
    let turbulence =
        Wind::uniform(Isa::detect(), &[(air, key)], eddies.count(), duration).expect("fibres that agree");
    (eddies, turbulence)
}

/// Copies one lane's vectors into all lanes.
pub fn in_all_lanes(vectors: &[V]) -> Vec<Vec3<Lanes>> {
    vectors.iter().map(|&v| Vec3::splat(v)).collect()
}

/// The kernel's forces on the nodes of a chain at given positions and velocities [N], gravity included:
/// the momentum one kick of semi-implicit Euler gives, by the kick's length.
///
/// The root must be free, or its force is not seen.
pub fn kernel_forces(strand: &FibreParameters, air_velocity: f64, position: &[V], velocity: &[V]) -> Vec<V> {
    let h = 1e-3;
    let (eddies, turbulence) = steady_air(air_velocity, strand.fibre.elements, 2.0 * h);
    let mut flight =
        Flight::assembled(Isa::detect(), &[*strand], (&eddies, &turbulence), Scheme::SemiImplicitEuler, h)
            .expect("fibres that agree");
    flight.restart_from(in_all_lanes(position), in_all_lanes(velocity)).expect("as many as nodes");
    flight.advance(1);
    let after = &flight.chain().velocity;
    (0..position.len()).map(|i| (after[i].lane(0) - velocity[i]) * (strand.fibre.node_mass(i) / h)).collect()
}

/// Numbers that look random and never change.
pub fn scatter(i: usize) -> f64 {
    let x = (i as f64 * 12.9898 + 0.5).sin() * 43758.5453;
    2.0 * (x - x.floor()) - 1.0
}

pub fn scattered_vector(i: usize) -> V {
    V::new(scatter(3 * i), scatter(3 * i + 1), scatter(3 * i + 2))
}
