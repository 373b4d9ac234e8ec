//! What every other wing stands on, and what knows nothing of fibres: numbers side by side in lanes, vectors,
//! transforms, chance; units, errors and their words; threads, tables, logs of keyed rows; statistics.
//!
//! ```text
//! lanes → vec3, fft, nodes, sort, random, place → error → units, threads, removed
//!       → company, log → file, table → statistics → effects
//! ```

// Vector instructions are unsafe to call; nothing else in the workspace is.
#[allow(unsafe_code)]
pub mod lanes;

pub(crate) mod fft;
pub mod nodes;
pub mod place;
pub(crate) mod random;
pub(crate) mod sort;
pub mod vec3;

pub mod error;

pub mod removed;
pub mod threads;
pub mod units;

pub(crate) mod company;
pub mod log;

pub(crate) mod file;
pub mod table;

pub mod statistics;

pub mod effects;
