//! Tagged image file format.

use super::{MOST_PIXELS, RawPicture, broken, luminance, unsupported, within_limits};
use crate::error::Fault;
use std::io::Cursor;
use tiff::decoder::ifd::Value;
use tiff::decoder::{Decoder, DecodingResult, Limits};
use tiff::tags::Tag;
use tiff::{ColorType, TiffError};

pub(super) fn parse(bytes: &[u8]) -> Result<RawPicture, Fault> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = 8 * MOST_PIXELS;
    limits.intermediate_buffer_size = 8 * MOST_PIXELS;
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(failed)?.with_limits(limits);
    let (columns, rows) = decoder.dimensions().map_err(failed)?;
    let [columns, rows] = within_limits(columns.into(), rows.into())?;
    let photometric = decoder.find_tag_unsigned::<u16>(Tag::PhotometricInterpretation).ok().flatten();
    if photometric == Some(PALETTE) {
        return Err(unsupported("colours from a palette", GREY));
    }
    let colour = decoder.colortype().map_err(failed)?;
    let channels = match colour {
        ColorType::Gray(8 | 16 | 32 | 64) => 1,
        ColorType::GrayA(8 | 16 | 32 | 64) => 2,
        ColorType::RGB(8 | 16 | 32 | 64) => 3,
        ColorType::RGBA(8 | 16 | 32 | 64) => 4,
        other => {
            let found = match other {
                ColorType::CMYK(_) | ColorType::CMYKA(_) => "the colours of a printer (CMYK)",
                ColorType::YCbCr(_) => "brightness and colour apart (YCbCr)",
                ColorType::Lab(_) => "colours of the kind CIE L*a*b*",
                _ => "channels or bits of a pixel of another kind",
            };
            return Err(unsupported(found, GREY));
        }
    };
    let more = decoder.more_images();
    let pixel = resolution(&mut decoder);
    let compression = decoder.find_tag_unsigned::<u16>(Tag::Compression).ok().flatten();
    let image = decoder.read_image().map_err(|error| match (error, compression) {
        (TiffError::UnsupportedError(_), Some(number)) if number > 1 => {
            unsupported(&compression_name(number), "save the scan as TIFF without compression, or as PNG")
        }
        (error, _) => failed(error),
    })?;
    let (values, full_scale) = match image {
        DecodingResult::U8(levels) => {
            (luminance(levels.into_iter().map(f64::from), channels), Some(u8::MAX.into()))
        }
        DecodingResult::U16(levels) => {
            (luminance(levels.into_iter().map(f64::from), channels), Some(u16::MAX.into()))
        }
        DecodingResult::U32(levels) => {
            (luminance(levels.into_iter().map(f64::from), channels), Some(u32::MAX.into()))
        }
        DecodingResult::F32(levels) => (luminance(levels.into_iter().map(f64::from), channels), None),
        DecodingResult::F64(levels) => (luminance(levels.into_iter(), channels), None),
        _ => {
            let found = "signed numbers, half floats or numbers of 8 bytes";
            let advice = "save it with 8, 16 or 32 bits without sign, or as floating point of 32 bits";
            return Err(unsupported(found, advice));
        }
    };
    if values.len() != columns * rows {
        let found = "each colour in a plane of its own";
        return Err(unsupported(found, "save the scan in shades of grey"));
    }
    let weight_of_black = None;
    Ok(RawPicture { values, columns, rows, full_scale, weight_of_black, pixel, colour: channels > 2, more })
}

/// How a file says that its pixels are places in a palette.
const PALETTE: u16 = 3;
/// What to do about a file whose pixels are of a kind that is not read.
const GREY: &str = "save the scan in shades of grey, with 8 or 16 bits each, without compression";

/// A file that is broken, or whole but of a kind that the decoder does not know.
fn failed(error: TiffError) -> Fault {
    match error {
        TiffError::UnsupportedError(_) => {
            unsupported("pixels of another kind than those that are known", GREY)
        }
        error => broken(&error),
    }
}

/// The name of a compression.
///
/// Source: the list of compression codes of libtiff, `tiff.h`.
fn compression_name(number: u16) -> String {
    let name = match number {
        2..=4 => "CCITT fax",
        6 | 7 => "JPEG",
        34_892 => "lossy JPEG",
        33_003 | 33_004 | 33_005 | 34_712 => "JPEG 2000",
        34_661 => "JBIG",
        34_887 => "LERC",
        34_925 => "LZMA",
        50_000 => "Zstandard",
        50_001 => "WebP",
        50_002 | 52_546 => "JPEG XL",
        other => return format!("the compression of number {other}"),
    };
    format!("{name} compression")
}

/// Width and height of a pixel [m], if the file tells its resolution.
fn resolution(decoder: &mut Decoder<Cursor<&[u8]>>) -> Option<[f64; 2]> {
    let unit = match decoder.find_tag_unsigned::<u16>(Tag::ResolutionUnit) {
        // Inches are the default.
        Ok(None | Some(2)) => 25.4e-3,
        Ok(Some(3)) => 10e-3,
        _ => return None,
    };
    let mut side = |tag| match decoder.find_tag(tag) {
        Ok(Some(Value::Rational(count, per))) => Some(unit * f64::from(per) / f64::from(count)),
        _ => None,
    };
    Some([side(Tag::XResolution)?, side(Tag::YResolution)?])
}
