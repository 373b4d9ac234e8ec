//! From SVG to PNG, with the embedded fonts: the same on every machine.

use crate::picture::{PER_INCH, PictureError, drawn};
use png::{BitDepth, ColorType, Encoder, PixelDimensions, Unit};

const METRES_PER_INCH: f64 = 0.0254;

/// The picture as PNG on white. The file says how many pixels an inch has, so that it has the size of the SVG in print.
///
/// * `dpi` – pixels per inch; an SVG has 96 units in an inch
/// * `texts` – what the file says about itself: keyword and text, as `Title` and `Software`
///
/// # Errors
/// A string that is not an SVG picture or has no size.
pub fn png(svg: &str, dpi: u32, texts: &[(&str, &str)]) -> Result<Vec<u8>, PictureError> {
    let pixels = drawn(svg, dpi as f32 / PER_INCH)?;
    let failed = |error: png::EncodingError| PictureError::Encoding(error.to_string());
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, pixels.width(), pixels.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    let per_metre = (f64::from(dpi) / METRES_PER_INCH).round() as u32;
    encoder.set_pixel_dims(Some(PixelDimensions { xppu: per_metre, yppu: per_metre, unit: Unit::Meter }));
    for (keyword, text) in texts {
        encoder.add_itxt_chunk((*keyword).to_owned(), (*text).to_owned()).map_err(failed)?;
    }
    // The paper is opaque, so that no colour is multiplied by its opacity.
    let colours: Vec<u8> =
        pixels.data().chunks_exact(4).flat_map(|pixel| [pixel[0], pixel[1], pixel[2]]).collect();
    let mut writer = encoder.write_header().map_err(failed)?;
    writer.write_image_data(&colours).and_then(|()| writer.finish()).map_err(failed)?;
    Ok(file)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draws_text_in_the_embedded_font() {
        let blank = r##"<svg xmlns="http://www.w3.org/2000/svg" width="60" height="20"></svg>"##;
        let text = blank.replace("></svg>", r##" font-family="Nowhere"><text y="15">µ m²</text></svg>"##);
        let (blank, text) = (png(blank, 192, &[]).unwrap(), png(&text, 192, &[]).unwrap());
        assert_eq!(&text[1..4], b"PNG");
        assert!(text.len() > blank.len() + 200);
    }

    #[test]
    fn has_the_pixels_of_its_size_in_print_and_says_so() {
        // 84 mm at 300 dpi are 992 pixels; 300 dpi are 11 811 pixels per metre.
        let svg = r##"<svg xmlns="http://www.w3.org/2000/svg" width="84mm" height="42mm" viewBox="0 0 2 1"></svg>"##;
        let file = png(svg, 300, &[("Title", "Amplitude’s ± error")]).unwrap();
        let reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
        let info = reader.info();
        assert_eq!((info.width, info.height), (992, 496));
        let dims = info.pixel_dims.unwrap();
        assert_eq!((dims.xppu, dims.yppu, dims.unit), (11_811, 11_811, Unit::Meter));
        let title = &info.utf8_text[0];
        assert_eq!(
            (title.keyword.as_str(), title.get_text().unwrap()),
            ("Title", "Amplitude’s ± error".into())
        );
    }

    #[test]
    fn rejects_what_is_no_picture() {
        assert!(png("<html></html>", 96, &[]).is_err());
    }
}
