//! Ensembles.
pub mod bundle;
