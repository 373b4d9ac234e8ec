//! Many simulations that answer one question: what a setting does, what to change, which settings made a scan.
//!
//! ```text
//! claim, plausible → study (points of a design) → advice (what makes a web more even), fit (from a scan back)
//! ```

pub mod claim;
pub mod plausible;

pub mod study;

pub mod advice;
pub mod fit;
