//! The web: from curves on the belt to a map of its weight, and from a map or a scan to its numbers.
//!
//! ```text
//! laydown (what one fibre lays) → surrogate (paths like it) ┐
//! curtain (flown curves and those like them) ───────────────┴→ map → fabric (in its buyer's words)
//! picture → scan ───────────────────────────────────────────────────┘
//! ```

pub mod laydown;
pub mod surrogate;

pub mod map;

pub mod curtain;
pub mod scan;

pub mod fabric;
