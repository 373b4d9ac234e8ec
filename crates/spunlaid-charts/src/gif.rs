//! Moving pictures.

use crate::map::colours;
use crate::picture::{PER_INCH, Picture, PictureError};
use crate::pixels::drawn;
use gif::{Encoder, Frame, Repeat};
use std::collections::HashMap;

/// Shades of grey for lines and text.
const GREYS: usize = 64;

/// Pictures one after the other as GIF, for ever, in the colours of maps and in greys.
///
/// * `frames` – of one size
/// * `per_second` – how many of them are seen in a second
///
/// # Errors
/// No picture, one that has no pixels, or one of another size.
pub fn gif(frames: impl IntoIterator<Item = Picture>, per_second: f64) -> Result<Vec<u8>, PictureError> {
    let greys = (0..GREYS).map(|grey| [(grey * 255 / (GREYS - 1)) as u8; 3]);
    let palette: Vec<[u8; 3]> = colours().map(|colour| colour.0).chain(greys).collect();
    let failed = |error: gif::EncodingError| PictureError::Encoding(error.to_string());
    let mut nearest: HashMap<[u8; 3], u8> = HashMap::new();
    let mut encoder: Option<(Encoder<Vec<u8>>, [u16; 2])> = None;
    for picture in frames {
        let pixels = drawn(&picture, PER_INCH)?;
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
    use crate::palette::Colour;

    const BLACK: Colour = Colour([0; 3]);

    fn square(colour: Colour, side: f64) -> Picture {
        let mut picture = Picture::new(side, side, "");
        picture.rectangles(&[((0.0, 0.0), (side, side))], colour);
        picture
    }

    #[test]
    fn frames_have_the_colours_of_their_pictures() {
        let shades: Vec<Colour> = colours().collect();
        let (low, high) = (shades[0], shades[shades.len() - 1]);
        let file = gif([low, high, BLACK].map(|colour| square(colour, 20.0)), 20.0).unwrap();
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::RGBA);
        let mut decoder = options.read_info(&file[..]).unwrap();
        let mut found = Vec::new();
        while let Some(frame) = decoder.read_next_frame().unwrap() {
            assert_eq!((frame.delay, frame.width), (5, 20));
            found.push([frame.buffer[0], frame.buffer[1], frame.buffer[2]]);
        }
        assert_eq!(found, [low.0, high.0, BLACK.0]);
    }

    #[test]
    fn rejects_pictures_of_different_sizes() {
        let pictures = [20.0, 21.0].map(|side| square(BLACK, side));
        assert!(matches!(gif(pictures, 20.0), Err(PictureError::Size(21, 21))));
        assert!(gif([], 20.0).is_err());
    }
}
