//! The drag laws.

use super::super::Key;
use super::super::row::{Access, choose, quantity};
use super::super::value::Sign::NotNegative;
use crate::fibre::drag::{FrictionLaw, NormalLaw};
use crate::ground::{Dimension, Fault};

named_fields!(FrictionLaw, NormalLaw);

pub(super) const KEYS: &[Key] = &[
    choose("drag.along", || FrictionLaw::ALL.map(FrictionLaw::name).to_vec())
        .access(at!(drag.along))
        .value("matsui")
        .meaning("Law of the friction along the fibre. Sources and ranges: docs/theory.md.")
        .label("Law of the friction along the fibre")
        .in_flight(),
    choose("drag.across", || NormalLaw::ALL.map(NormalLaw::name).to_vec())
        .access(at!(drag.across))
        .value("ju-shambaugh")
        .meaning(
            "Law of the drag across the fibre. \"marheineke-wegener\" agrees with measurements from \
             fine fibres to thick cylinders; \"ju-shambaugh\" is the paper's. Sources and ranges: \
             docs/theory.md.",
        )
        .synonyms(&["drag law", "drag coefficient"])
        .label("Law of the drag across the fibre")
        .in_flight(),
    quantity("drag.friction_coefficient", Dimension::Ratio, NotNegative, (0.01, 10.0))
        .access(within!(
            |case| &case.drag.along,
            &mut case.drag.along,
            FrictionLaw::Matsui { factor } => factor,
            Fault::needs("drag.along = \"matsui\"", "remove it, this law has its own")
        ))
        .value("0.9")
        .meaning(
            "Factor of Matsui's friction law. Values from 0.37 to 0.9 are in use; two sources support 0.9.",
        )
        .label("Friction coefficient *β*")
        .slider(0.2, 1.2)
        .in_flight(),
];
