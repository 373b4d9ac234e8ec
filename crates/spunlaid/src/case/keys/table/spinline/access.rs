//! How keys read and change the spinline of a case.

use crate::case::Case;
use crate::case::keys::value::Value;
use crate::error::Fault;
use crate::spinline::Spinline;

/// Access to a number of the spinline: `of_spinline!(throughput)`.
macro_rules! of_spinline {
    ($($field:ident).+) => {
        $crate::case::keys::row::Access {
            get: |case| {
                use $crate::case::keys::table::spinline::access::known;
                known(case.spinline.as_ref()?.$($field).+)
            },
            set: |case, value| {
                use $crate::case::keys::table::spinline::access::spinline;
                spinline(case)?.$($field).+ = $crate::case::keys::row::number(value)?;
                Ok(())
            },
        }
    };
}

pub(super) use of_spinline;

pub(super) fn no_spinline(case: &Case) -> bool {
    case.spinline.is_none()
}

/// A number that is known.
pub(super) fn known(number: f64) -> Option<Value> {
    number.is_finite().then_some(Value::Number(number))
}

pub(super) fn spun(case: &Case) -> Option<&Spinline> {
    case.spinline.as_deref()
}

/// The spinline of a case that has one.
pub(super) fn spinline(case: &mut Case) -> Result<&mut Spinline, Fault> {
    let remedy = "leave it out, or describe the spinline";
    case.spinline.as_deref_mut().ok_or_else(|| Fault::needs("[spinline]", remedy))
}
