//! Rows of holes, one behind the other in the quench air.

use super::access::{known, spinline};
use crate::case::Case;
use crate::case::keys::Key;
use crate::case::keys::row::{Access, key, number, quantity, whole};
use crate::case::keys::value::Sign::Positive;
use crate::case::keys::value::{Kind, Value};
use crate::error::Fault;
use crate::spinline::Curtain;
use crate::units::Dimension;

/// Most rows of a curtain.
const MOST_ROWS: u64 = 1000;

pub(super) const KEYS: &[Key] = &[
    key("spinline.rows", Kind::Whole(1, MOST_ROWS))
        .access(Access {
            get: |case| Some(Value::Whole(case.spinline.as_ref()?.curtain?.rows)),
            set: |case, value| {
                let rows = whole(value)?;
                curtain(case)?.rows = rows;
                Ok(())
            },
        })
        .follows("one filament in the air as it is given")
        .meaning(
            "Number of rows of holes that the quench air crosses one after another: each row meets the air \
             that the one before has warmed and dragged. The first row gives the flown fibre.",
        )
        .label("Rows of holes")
        .varies(),
    quantity("spinline.filaments_per_metre_and_row", Dimension::Ratio, Positive)
        .access(Access {
            get: |case| known(case.spinline.as_ref()?.curtain?.filaments_per_metre),
            set: |case, value| {
                let filaments = number(value)?;
                curtain(case)?.filaments_per_metre = filaments;
                Ok(())
            },
        })
        .follows("one filament in the air as it is given")
        .usual(1.0, 1e5)
        .meaning("Filaments per metre of width in each row of holes.")
        .synonyms(&["holes per metre"])
        .label("Filaments per metre and row"),
];

fn curtain(case: &mut Case) -> Result<&mut Curtain, Fault> {
    let unknown = Curtain { rows: 1, filaments_per_metre: f64::NAN };
    Ok(spinline(case)?.curtain.get_or_insert(unknown))
}
