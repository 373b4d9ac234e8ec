//! Which arrays of a file are the velocity and the turbulence.

/// Which arrays of a file are the velocity and the turbulence. A quantity without a name here is found by its
/// usual names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct FieldLayout {
    /// Velocity: one array of three components, or two or three arrays of one, with commas between them.
    pub velocity: Option<String>,
    /// Turbulent kinetic energy `k`.
    pub k: Option<String>,
    /// Dissipation rate `ε`.
    pub epsilon: Option<String>,
    /// Specific dissipation rate `ω`.
    pub omega: Option<String>,
}
