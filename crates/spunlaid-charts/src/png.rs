//! From a picture to PNG: the same on every machine.

use crate::picture::{Picture, PictureError};
use crate::pixels::drawn;
use png::{BitDepth, ColorType, DeflateCompression, Encoder, Filter, PixelDimensions, Unit};

const METRES_PER_INCH: f64 = 0.0254;

/// The picture as PNG. The file says how many pixels an inch has, so that it has the size of the picture in print.
///
/// * `dpi` – pixels per inch; a screen has 96
/// * `texts` – what the file says about itself: keyword and text, as `Title` and `Software`
///
/// # Errors
/// A picture that has no pixels.
pub fn png(picture: &Picture, dpi: u32, texts: &[(&str, &str)]) -> Result<Vec<u8>, PictureError> {
    let pixels = drawn(picture, dpi)?;
    let failed = |error: png::EncodingError| PictureError::Encoding(error.to_string());
    let mut file = Vec::new();
    let mut encoder = Encoder::new(&mut file, pixels.width(), pixels.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    // An eighth of the time of the default, for files of one and a half times the size: a short run spent half its
    // time here.
    encoder.set_deflate_compression(DeflateCompression::Level(1));
    encoder.set_filter(Filter::Up);
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
    use crate::palette::INK;
    use crate::picture::{Anchor, Text};

    #[test]
    fn draws_text_in_the_embedded_font() {
        let mut picture = Picture::new(60.0, 20.0, "");
        let blank = png(&picture, 192, &[]).unwrap();
        let style = Text { size: 16.0, colour: INK, anchor: Anchor::Start, upright: true };
        picture.text((0.0, 15.0), "µ m²", style);
        let text = png(&picture, 192, &[]).unwrap();
        assert_eq!(&text[1..4], b"PNG");
        assert!(text.len() > blank.len() + 200);
    }

    #[test]
    fn has_the_pixels_of_its_size_in_print_and_says_so() {
        // 84 mm at 300 dpi are 992 pixels; 300 dpi are 11 811 pixels per metre.
        let picture = Picture::new(420.0, 210.0, "").printed(0.2);
        let file = png(&picture, 300, &[("Title", "Amplitude’s ± error")]).unwrap();
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
    fn rejects_a_picture_without_extent() {
        assert!(png(&Picture::new(0.0, 10.0, ""), 96, &[]).is_err());
    }
}
