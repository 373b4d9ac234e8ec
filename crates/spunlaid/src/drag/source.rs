//! Where a law was published.

/// The publication of a law.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    /// How a text names it: `Matsui 1976`.
    pub short: &'static str,
    /// Its entry in a list of references.
    pub full: &'static str,
}
