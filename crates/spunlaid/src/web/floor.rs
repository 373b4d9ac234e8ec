//! Whole numbers of places.

/// The largest whole number that is not above, without a call.
#[inline(always)]
pub(super) fn floor(at: f64) -> i64 {
    let whole = at as i64;
    whole - i64::from(whole as f64 > at)
}
