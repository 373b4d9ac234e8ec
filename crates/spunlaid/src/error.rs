//! What can go wrong. (The variants below are in use by the ensemble: keep their names and fields.)

/// What can go wrong.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A fibre's positions are no longer numbers.
    #[error("replicate {replicate}: node {node} is no longer finite at {time:e} s; {cause}")]
    NotFinite {
        /// Index of the replicate.
        replicate: u64,
        /// Node, counted from 1 at the root.
        node: usize,
        /// Time [s].
        time: f64,
        /// Likely cause and remedy.
        cause: String,
    },
    /// Stopped from outside before the end.
    #[error("interrupted before the end")]
    Interrupted,
}
