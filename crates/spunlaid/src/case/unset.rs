//! A case of which nothing is known yet.

use super::{Case, Neighbours, Run};
use crate::air::Air;
use crate::chain::schemes::Scheme;
use crate::drag::{Drag, FrictionLaw, NormalLaw};
use crate::fibre::{Fibre, Root};
use crate::spinline::SpinSpec;
use crate::vec3::Vec3;

impl From<&SpinSpec> for Case {
    /// A case with nothing but a spinline, its drag laws and its field of air, whose keys can be read and set.
    fn from(spec: &SpinSpec) -> Self {
        let unset = Self::unset();
        let air = spec.air.as_ref().map_or_else(|| unset.air.clone(), |air| (**air).clone());
        Self { spinline: Some(Box::new(spec.spinline.clone())), drag: spec.drag, air, ..unset }
    }
}

impl Case {
    /// A case of which nothing is known yet; its keys are set one after another.
    pub(crate) fn unset() -> Self {
        let nan = f64::NAN;
        Self {
            fibre: Fibre {
                length: nan,
                diameter: nan,
                density: nan,
                youngs_modulus: nan,
                bending_viscosity_time: 0.0,
                elements: 0,
                root: Root::Pinned,
                direction: Vec3::new(1.0, 0.0, 0.0),
            },
            air: Air::uniform(nan, nan, nan, nan),
            drag: Drag { along: FrictionLaw::ALL[0], across: NormalLaw::ALL[0] },
            line: None,
            spinline: None,
            neighbours: Neighbours::default(),
            run: Run {
                time_step: nan,
                steps: 0,
                spin_up_steps: 0,
                output_steps: 0,
                replicates: 1,
                seed: 0,
                scheme: Scheme::SemiImplicitEuler,
                gravity: nan,
                damping: nan,
                shapes: None,
            },
        }
    }
}
