//! What flies together: fibres in airs of their own, or all filaments of a line in one air, and what is measured.
//!
//! ```text
//! observe (what is measured) → ensemble (fibres in airs of their own)
//!                            → beam (filaments in one air) → layers (the webs of a line)
//! ```

pub mod observe;

pub mod ensemble;

pub mod beam;

pub mod layers;
