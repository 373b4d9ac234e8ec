//! Simulator of fibres in turbulent air.
pub mod air;
pub mod chain;
pub mod drag;
pub mod energy;
pub mod ensemble;
pub mod fibre;
pub mod lanes;
pub mod observe;
pub mod vec3;
pub mod case;
pub mod fft;
pub mod statistics;
pub mod error;
pub mod units;
pub mod input;
