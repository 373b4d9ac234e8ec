//! What a comparison shows.

use crate::output::comparison::Comparison;
use crate::report::ComparedPictures;
use spunlaid_charts::Figure;

/// Comparisons with their figures.
#[derive(Debug)]
pub(super) struct Found {
    pub(super) comparisons: Vec<Comparison>,
    pub(super) figures: Vec<Figure>,
    /// Of webs.
    pub(super) pictures: Option<ComparedPictures>,
    /// What is missing, and why.
    pub(super) notes: Vec<String>,
}
