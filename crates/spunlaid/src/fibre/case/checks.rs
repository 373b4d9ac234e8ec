//! How much a run flies again to find the error of its step and of its mesh.

/// What the checks of a run may cost.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Checks {
    /// At most a fifth of the flight.
    #[default]
    Auto,
    /// Nothing: the run is not checked.
    None,
    /// As much as the whole run takes with a finer step and with finer elements.
    Full,
}

impl Checks {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Auto, Self::None, Self::Full];

    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Auto => "auto",
            Self::None => "none",
            Self::Full => "full",
        }
    }
}
