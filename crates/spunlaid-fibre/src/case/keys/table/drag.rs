//! The drag laws.

use super::super::Key;
use super::super::row::{Access, KeyField, change, file, quantity};
use super::super::value::Sign::NotNegative;
use super::super::value::{Content, DataFile, Value};
use crate::drag::{FrictionLaw, NormalLaw, TableLaw};
use spunlaid_ground::{Dimension, Fault};

/// Laws that have a name or come from a file.
macro_rules! laws {
    ($($Law:ident),+) => {
        $(impl KeyField for $Law {
            fn report(&self) -> Option<Value> {
                Some(match self {
                    Self::Table(law) => Content::DragLaw(law.file().clone()).into(),
                    law => law.name().into(),
                })
            }

            fn take(&mut self, value: &Value) -> Result<(), Fault> {
                if let Value::Content(Content::DragLaw(file)) = value {
                    *self = Self::Table(TableLaw::new(file.clone()));
                    return Ok(());
                }
                change(self, value, &Self::ALL, Self::name)
            }
        })+
    };
}

laws!(FrictionLaw, NormalLaw);

pub(super) const KEYS: &[Key] = &[
    file("drag.along", DataFile::FrictionLaw)
        .access(at!(drag.along))
        .value("matsui")
        .gives("drag.friction_coefficient")
        .meaning(
            "Law of the friction along the fibre: a name, or a CSV file with the columns `reynolds` and \
             `coefficient`. Sources and ranges: docs/theory.md.",
        )
        .label("Law of the friction along the fibre")
        .varies()
        .in_flight(),
    file("drag.across", DataFile::NormalLaw)
        .access(at!(drag.across))
        .value("ju-shambaugh")
        .meaning(
            "Law of the drag across the fibre: \"marheineke-wegener\" agrees with measurements, \"ju-shambaugh\" is \
             the paper's; or a CSV file with the columns `reynolds` and `coefficient`. Sources and ranges: \
             docs/theory.md.",
        )
        .gives("drag.across")
        .varies()
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
