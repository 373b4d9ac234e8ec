//! How much a run flies again to find the error of its step and of its mesh.

named! {
    /// What the checks of a run may cost.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Checks {
        /// At most a fifth of the flight.
        #[default]
        Auto = "auto",
        /// Nothing: the run is not checked.
        None = "none",
        /// As much as the whole run takes with a finer step and with finer elements.
        Full = "full",
    }
}
