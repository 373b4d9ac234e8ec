//! What PNG, GIF and PDF are made from: the SVG with its texts as outlines, read and drawn.

use crate::glyphs::outlined;
use resvg::{tiny_skia, usvg};

/// Pixels of an SVG in an inch, as CSS has it.
pub(crate) const PER_INCH: f32 = 96.0;

/// A figure that could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum PictureError {
    /// Not an SVG picture.
    #[error("the figure is not a valid SVG picture: {0}")]
    Svg(#[from] usvg::Error),
    /// No pixels, or more than fit.
    #[error("a picture of {0} × {1} pixels cannot be drawn")]
    Size(u32, u32),
    /// The pixels could not be written.
    #[error("the figure cannot be written as PNG or GIF: {0}")]
    Encoding(String),
}

/// The shapes of a picture. Texts are outlines of the crate's own fonts.
pub(crate) fn shapes(svg: &str) -> Result<usvg::Tree, PictureError> {
    let svg = outlined(svg).map_err(usvg::Error::ParsingFailed)?;
    Ok(usvg::Tree::from_str(&svg, &usvg::Options { dpi: PER_INCH, ..usvg::Options::default() })?)
}

/// The picture on white.
///
/// * `scale` – pixels per pixel of the SVG
pub(crate) fn drawn(svg: &str, scale: f32) -> Result<tiny_skia::Pixmap, PictureError> {
    let tree = shapes(svg)?;
    let pixels = |length: f32| (length * scale).round() as u32;
    let (width, height) = (pixels(tree.size().width()), pixels(tree.size().height()));
    let mut pixmap = tiny_skia::Pixmap::new(width, height).ok_or(PictureError::Size(width, height))?;
    pixmap.fill(tiny_skia::Color::WHITE);
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    Ok(pixmap)
}
