//! Values that are changes of those before: `+20 %`, `-0.2 dtex`.

use super::{Kind, Sign, Value};
use spunlaid_ground::Fault;
use spunlaid_ground::units::rounded;

/// A change of a number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Relative {
    /// By this share of it.
    Share(f64),
    /// By this amount, in SI units.
    Amount(f64),
}

impl Relative {
    /// The change that a text says; None if it is a value. A minus sign without a percent sign is that of a value where
    /// the key takes negative ones.
    ///
    /// # Errors
    /// If it cannot be read.
    pub fn read(kind: &Kind, text: &str) -> Result<Option<Self>, Fault> {
        let text = text.trim().replace('−', "-");
        let share = text.strip_suffix('%').map(str::trim_end);
        let is_negative_value = share.is_none() && matches!(kind, Kind::Quantity(_, Sign::Any));
        if !text.starts_with('+') && (!text.starts_with('-') || is_negative_value) {
            return Ok(None);
        }
        match (share, kind) {
            (Some(share), Kind::Quantity(..) | Kind::Whole(..)) => match share.parse::<f64>() {
                Ok(percent) if percent.is_finite() => Ok(Some(Self::Share(0.01 * percent))),
                _ => Err(Fault::new("is not a relative change", "write one like \"+20 %\" or \"-5 %\"")),
            },
            (None, Kind::Quantity(dimension, _)) => Ok(Some(Self::Amount(dimension.parse(&text)?))),
            _ => Ok(None),
        }
    }

    /// The changed value.
    ///
    /// * `remedy` – what to write in its place
    ///
    /// # Errors
    /// If there is no number before, or if the key does not take the new one.
    pub fn of(self, before: Option<f64>, kind: &Kind, remedy: String) -> Result<Value, Fault> {
        let Some(before) = before.filter(|before| before.is_finite()) else {
            return Err(Fault::new("is a change of a value that is not given", remedy));
        };
        let after = match self {
            Self::Share(share) => before * (1.0 + share),
            Self::Amount(amount) => before + amount,
        };
        // 0.2 m and a half of it are 0.3 m, not 0.30000000000000004 m.
        let after = rounded(after, 14);
        kind.accept(match kind {
            Kind::Whole(..) => Value::Whole(after.round().max(0.0) as u64),
            _ => Value::Number(after),
        })
    }
}
