//! Moving pictures.

use crate::map::{colours, parts};
use crate::picture::{PictureError, drawn};
use gif::{Encoder, Frame, Repeat};
use std::collections::HashMap;

/// Shades of grey for lines and text.
const GREYS: usize = 64;

/// Pictures one after the other as GIF, for ever, in the colours of maps and in greys.
///
/// * `frames` – SVG pictures of one size
/// * `per_second` – how many of them are seen in a second
///
/// # Errors
/// A string that is not an SVG picture, or one of another size.
pub fn gif<S: AsRef<str>>(
    frames: impl IntoIterator<Item = S>,
    per_second: f64,
) -> Result<Vec<u8>, PictureError> {
    let greys = (0..GREYS).map(|grey| [(grey * 255 / (GREYS - 1)) as u8; 3]);
    let palette: Vec<[u8; 3]> = colours().map(|colour| parts(&colour)).chain(greys).collect();
    let failed = |error: gif::EncodingError| PictureError::Encoding(error.to_string());
    let mut nearest: HashMap<[u8; 3], u8> = HashMap::new();
    let mut encoder: Option<(Encoder<Vec<u8>>, [u16; 2])> = None;
    for svg in frames {
        let pixels = drawn(svg.as_ref(), 1.0)?;
        let size = match [pixels.width(), pixels.height()].map(u16::try_from) {
            [Ok(width), Ok(height)] => [width, height],
            _ => return Err(PictureError::Size(pixels.width(), pixels.height())),
        };
        let (into, expected) = match &mut encoder {
            Some((into, size)) => (into, *size),
            none => {
                let mut new =
                    Encoder::new(Vec::new(), size[0], size[1], palette.as_flattened()).map_err(failed)?;
                new.set_repeat(Repeat::Infinite).map_err(failed)?;
                let (into, _) = none.insert((new, size));
                (into, size)
            }
        };
        if size != expected {
            return Err(PictureError::Size(pixels.width(), pixels.height()));
        }
        let number = |pixel: &[u8]| {
            let colour = [pixel[0], pixel[1], pixel[2]];
            *nearest.entry(colour).or_insert_with(|| number_of_nearest(&palette, colour))
        };
        let buffer: Vec<u8> = pixels.data().chunks_exact(4).map(number).collect();
        let delay = (100.0 / per_second).round().clamp(1.0, 1000.0) as u16;
        let [width, height] = size;
        into.write_frame(&Frame { width, height, delay, buffer: buffer.into(), ..Frame::default() })
            .map_err(failed)?;
    }
    let Some((encoder, _)) = encoder else { return Err(PictureError::Size(0, 0)) };
    encoder.into_inner().map_err(|error| PictureError::Encoding(error.to_string()))
}

fn number_of_nearest(palette: &[[u8; 3]], colour: [u8; 3]) -> u8 {
    let off = |other: &[u8; 3]| -> u32 {
        colour.iter().zip(other).map(|(a, b)| u32::from(a.abs_diff(*b)).pow(2)).sum()
    };
    let nearest = (0..palette.len()).min_by_key(|i| off(&palette[*i])).unwrap_or(0);
    nearest as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(colour: &str, side: u32) -> String {
        format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="{side}" height="{side}"><rect width="100" height="100" fill="{colour}"/></svg>"#
        )
    }

    #[test]
    fn frames_have_the_colours_of_their_pictures() {
        let shades: Vec<String> = colours().collect();
        let (low, high) = (&shades[0], &shades[shades.len() - 1]);
        let pictures = [square(low, 20), square(high, 20), square("#000000", 20)];
        let file = gif(pictures.iter().map(String::as_str), 20.0).unwrap();
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(&file[..]).unwrap();
        let mut found = Vec::new();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            assert_eq!((frame.delay, frame.width), (5, 20));
            found.push([frame.buffer[0], frame.buffer[1], frame.buffer[2]]);
        }
        assert_eq!(found, [parts(low), parts(high), [0, 0, 0]]);
    }

    #[test]
    fn rejects_pictures_of_different_sizes() {
        let pictures = [square("#000000", 20), square("#000000", 21)];
        assert!(matches!(gif(pictures.iter().map(String::as_str), 20.0), Err(PictureError::Size(21, 21))));
        assert!(gif([""; 0], 20.0).is_err());
    }
}
