//! Simulator of fibres in turbulent air.
pub mod air;
pub mod case;
pub mod chain;
pub mod drag;
pub mod energy;
pub mod ensemble;
pub mod error;
pub mod fft;
pub mod fibre;
pub mod input;
pub mod lanes;
pub mod observe;
pub mod statistics;
pub mod units;
pub mod vec3;
