//! One fibre: from the melt that it is drawn from to its flight in the air.
//!
//! ```text
//! body, line, drag → spinline (speed and diameter of what comes down)
//!                  → chain (forces and steps; charge, energy) → case (all that is asked of a fibre, checked)
//!                  → flight (up to eight fibres, step by step), load (what they do to their air)
//! ```

pub mod body;
pub mod line;

pub mod drag;

pub mod charge;
pub mod spinline;

pub mod chain;

pub mod energy;

pub mod case;

pub mod flight;
pub mod load;
