//! A case of which nothing is known yet.

use super::{Case, Run};
use crate::air::Air;
use crate::drag::{Drag, FrictionLaw, NormalLaw};
use crate::fibre::Fibre;
use crate::spinline::SpinSpec;

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
            fibre: Fibre::UNKNOWN,
            air: Air::uniform(nan, nan, nan, nan),
            drag: Drag { along: FrictionLaw::ALL[0], across: NormalLaw::ALL[0] },
            line: None,
            spinline: None,
            run: Run::UNKNOWN,
        }
    }
}
