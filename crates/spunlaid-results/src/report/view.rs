//! What is looked at and not read: the moving fibre, the web on its light table, webs beside each other.

use super::frames::Frames;
use super::light_table::Sheet;
use super::pictures::Beside;
use super::scale::Scale;
use askama::Template;

/// A view, by its kind: each has its template and its scripts.
#[derive(Debug, Template)]
pub(super) enum View<'a> {
    #[template(path = "fibre.html")]
    Fibre(Frames),
    #[template(path = "light_table.html")]
    LightTable(Sheet),
    #[template(path = "beside.html")]
    Beside(Beside<'a>),
    #[template(path = "scale.html")]
    Scale(Scale),
}

impl View<'_> {
    /// The scripts that it needs, in their order.
    pub(super) const fn scripts(&self) -> &'static [&'static str] {
        match self {
            Self::Fibre(_) => &[
                include_str!("../../assets/frames.js"),
                include_str!("../../assets/belt.js"),
                super::CAMERA,
                super::SCENE,
                include_str!("../../assets/player.js"),
                include_str!("../../assets/fibre.js"),
            ],
            Self::LightTable(_) => &[include_str!("../../assets/light_table.js")],
            Self::Beside(_) | Self::Scale(_) => &[],
        }
    }
}
