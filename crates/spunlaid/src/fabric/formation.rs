//! How cloudy a fabric looks beside one of straight fibres at random.

use super::Known;
use crate::web::uniformity::Unevenness;

/// The formation number: CV² over that of straight fibres at random of the same mass, which have 1.   theory.md (102)
///
/// Source: C. T. J. Dodson, J. R. Stat. Soc. B 33 (1971) 88–94, as W. W. Sampson, Modelling Stochastic
/// Fibrous Materials (2009), uses it for paper.
pub fn formation(found: &Unevenness, straight_fibres: f64) -> Known {
    let number = (found.cv / straight_fibres).powi(2);
    Known::Value(number, found.standard_error.map(|error| 2.0 * number * error / found.cv))
}
