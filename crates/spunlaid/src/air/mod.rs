//! The air that fibres fly in: from files of CFD or of a hot wire to the velocity at any place and time.
//!
//! ```text
//! file of CFD → field ┐
//! case, spectrum ─────┴→ motion → velocity at a place and time
//! hot-wire record → record → mean, turbulence, lengths
//! ```

pub mod field;

pub mod motion;

pub mod record;
