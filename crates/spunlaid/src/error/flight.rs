//! Errors of flights: fibres that cannot fly side by side, and requests that cannot be met.

/// What is wrong with a flight or with a request to it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FlightFault {
    /// There is no fibre.
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
    /// A fibre without elements.
    #[error("a fibre needs at least one element")]
    NoElements,
    /// A repeating wind of air with a record.
    #[error("a repeating wind is made from harmonics; leave air.record out")]
    RepeatingRecord,
    /// A wind without eddies.
    #[error("a wind needs at least one eddy")]
    NoEddies,
    /// A number of harmonics or a cut-off frequency that cannot be used.
    #[error(
        "turbulence cannot be made: air.harmonics must be from 1 to 2^30 and air.cutoff_frequency above zero"
    )]
    NoHarmonics,
    /// Cases that differ in something that must be equal.
    #[error(
        "fibre {} cannot fly beside the first: they differ in {what}; fibres of one flight must agree in it",
        lane + 1
    )]
    Differ {
        /// The key or property that differs.
        what: &'static str,
        /// Index of the fibre.
        lane: usize,
    },
    /// A wind or surroundings with the wrong number of eddies or elements.
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
    /// Other positions for a fibre that is being fed.
    #[error("a fed fibre starts at its inlet; start a new flight of it")]
    Fed,
    /// A time step that is not positive and finite.
    #[error("a time step of {step:e} s cannot be taken; it must be positive and finite")]
    Step {
        /// The step [s].
        step: f64,
    },
    /// A time in the past, or NaN.
    #[error("the flight is at {now:e} s and cannot step to {time:e} s; name a later time")]
    TimePast {
        /// The requested time [s].
        time: f64,
        /// The present time of the flight [s].
        now: f64,
    },
    /// A flight without a case.
    #[error("this flight was put together without a case, so its keys cannot be set")]
    NoCase,
    /// A key that cannot change during a flight.
    #[error("{key} cannot change in flight: {reason}; start another flight with it")]
    NotInFlight {
        /// The key.
        key: &'static str,
        /// The reason.
        reason: &'static str,
    },
}
