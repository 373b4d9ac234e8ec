//! A case that the tests of this module share.

use spunlaid_air::Air;
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, Drag, Fibre, FrictionLaw, NormalLaw, Root, Run};
use spunlaid_ground::Vec3;

/// Table 1 of the paper, short and coarse in time.
pub(crate) fn table1() -> Case {
    Case {
        fibre: Fibre {
            length: 1.0,
            diameter: 50e-6,
            density: 950.0,
            youngs_modulus: 2e9,
            elements: 20,
            root: Root::Pinned,
            direction: Vec3::new(1.0, 0.0, 0.0),
            ..Fibre::UNKNOWN
        },
        air: Air::uniform(10.0, 0.1, 0.05, 100.0),
        drag: Drag { along: FrictionLaw::Matsui { factor: 0.9 }, across: NormalLaw::JuShambaugh },
        line: None,
        spinline: None,
        run: Run {
            time_step: 2e-5,
            steps: 1000,
            output_steps: 50,
            replicates: 10,
            seed: 1,
            scheme: Scheme::SemiImplicitEuler,
            gravity: 9.81,
            damping: 0.0,
            ..Run::UNKNOWN
        },
    }
}
