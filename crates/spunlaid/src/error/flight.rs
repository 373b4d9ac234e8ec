//! Why fibres cannot fly side by side, or a flight cannot do what is asked of it.

/// What is wrong with a flight that was asked for.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FlightFault {
    /// No fibre.
    #[error("a flight needs at least one fibre")]
    Empty,
    /// More fibres than lanes.
    #[error("{fibres} fibres cannot fly in one flight; it takes at most {most}")]
    TooMany {
        /// Fibres asked for.
        fibres: usize,
        /// Most that fly side by side.
        most: usize,
    },
    /// A wind without eddies.
    #[error("a wind needs at least one eddy")]
    NoEddies,
    /// Turbulence of nothing.
    #[error(
        "air.harmonics and air.cutoff_frequency must be positive, and there may be at most 2^30 harmonics, for turbulence to be made"
    )]
    NoHarmonics,
    /// A case that differs where it must not.
    #[error(
        "fibre {} cannot fly beside the first: they differ in {what}; fibres of one flight must agree in it",
        lane + 1
    )]
    Differ {
        /// What they differ in.
        what: &'static str,
        /// Index of the fibre.
        lane: usize,
    },
    /// A wind for another number of eddies, or surroundings for another number of elements.
    #[error("the {what} is for {found} {of}, the fibres have {wanted}")]
    Size {
        /// What does not fit.
        what: &'static str,
        /// What it counts.
        of: &'static str,
        /// How many it has.
        found: usize,
        /// How many there must be.
        wanted: usize,
    },
    /// A time step that is no step.
    #[error("a time step of {step:e} s cannot be taken; it must be positive and finite")]
    Step {
        /// The step [s].
        step: f64,
    },
    /// A time that has passed, or is no time.
    #[error("the flight is at {now:e} s and cannot step to {time:e} s; name a later time")]
    TimePast {
        /// Where it was to go [s].
        time: f64,
        /// Where it is [s].
        now: f64,
    },
    /// A flight that was put together from parts.
    #[error("this flight was put together without a case, so its keys cannot be set")]
    NoCase,
    /// A key that cannot change in flight.
    #[error("{key} cannot change in flight: {reason}; start another flight with it")]
    NotInFlight {
        /// The key.
        key: &'static str,
        /// Why.
        reason: &'static str,
    },
}
