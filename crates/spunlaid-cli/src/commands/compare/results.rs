//! What a comparison shows.

use spunlaid_charts::Figure;
use spunlaid_results::output::comparison::Comparison;
use spunlaid_results::report::ComparedPictures;

/// Comparisons with their figures.
#[derive(Debug)]
pub(super) struct Results {
    pub(super) comparisons: Vec<Comparison>,
    pub(super) figures: Vec<Figure>,
    /// Of webs.
    pub(super) pictures: Option<ComparedPictures>,
    /// What is missing, and why.
    pub(super) notes: Vec<String>,
}
