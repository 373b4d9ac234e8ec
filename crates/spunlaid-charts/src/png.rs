//! From SVG to PNG, with the embedded fonts: the same on every machine.

use crate::glyphs::outlined;
use resvg::{tiny_skia, usvg};

/// Pixels of the PNG per pixel of the SVG.
const SCALE: f32 = 2.0;

/// A figure that could not be drawn.
#[derive(Debug, thiserror::Error)]
pub enum PngError {
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

/// The picture as PNG on white, twice as many pixels as the SVG has units.
///
/// # Errors
/// A string that is not an SVG picture or has no size.
pub fn png(svg: &str) -> Result<Vec<u8>, PngError> {
    drawn(svg, SCALE)?.encode_png().map_err(|e| PngError::Encoding(e.to_string()))
}

/// The picture on white.
///
/// * `scale` – pixels per pixel of the SVG
pub(crate) fn drawn(svg: &str, scale: f32) -> Result<tiny_skia::Pixmap, PngError> {
    let svg = outlined(svg).map_err(usvg::Error::ParsingFailed)?;
    let tree = usvg::Tree::from_str(&svg, &usvg::Options::default())?;
    let pixels = |length: f32| (length * scale).round() as u32;
    let (width, height) = (pixels(tree.size().width()), pixels(tree.size().height()));
    let mut pixmap = tiny_skia::Pixmap::new(width, height).ok_or(PngError::Size(width, height))?;
    pixmap.fill(tiny_skia::Color::WHITE);
    resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixmap.as_mut());
    Ok(pixmap)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_text_in_the_embedded_font() {
        let blank = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="20"></svg>"##;
        let text = blank.replace("></svg>", r##" font-family="Nowhere"><text y="15">µ m²</text></svg>"##);
        let (blank, text) = (png(blank).unwrap(), png(&text).unwrap());
        assert_eq!(&text[1..4], b"PNG");
        assert!(text.len() > blank.len() + 200);
    }

    #[test]
    fn rejects_what_is_no_picture() {
        assert!(png("<html></html>").is_err());
    }
}
