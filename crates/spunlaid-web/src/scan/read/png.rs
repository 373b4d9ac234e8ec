//! Portable network graphics.

use super::channels::{Extra, Pixels, pixels};
use super::{MOST_PIXELS, RawPicture, broken, orientation, within_limits};
use png::{BitDepth, Decoder, DecodingError, Limits, Transformations, Unit};
use spunlaid_ground::Fault;
use std::io::{Cursor, ErrorKind};

/// Keyword of the text that reports the basis weight of a black pixel of a map [kg/m²].
pub const WEIGHT_OF_BLACK: &str = "basis_weight_of_black_kg_m2";
/// Keyword of the text that reports the side of a cell of a map [m].
pub const CELL: &str = "cell_m";

pub(super) fn parse(bytes: &[u8]) -> Result<RawPicture, Fault> {
    // Four channels of two bytes, and as much for decoding.
    let limits = Limits { bytes: 16 * MOST_PIXELS };
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
    // Palettes and few bits become eight bits a channel, and a transparent colour a channel.
    decoder.set_transformations(Transformations::EXPAND);
    let info = decoder.read_header_info().map_err(failed)?;
    let [columns, rows] = within_limits(info.width.into(), info.height.into())?;
    let mut reader = decoder.read_info().map_err(failed)?;
    let (colour, depth) = reader.output_color_type();
    let size = reader.output_buffer_size().ok_or_else(|| broken(&"its size is unknown"))?;
    let mut buffer = vec![0; size];
    let frame = reader.next_frame(&mut buffer).map_err(failed)?;
    let levels = &buffer[..frame.buffer_size()];
    let channels = colour.samples();
    let (found, full_scale) = if depth == BitDepth::Sixteen {
        let level = |pair: &[u8]| f64::from(u16::from_be_bytes([pair[0], pair[1]]));
        let (levels, full) = (levels.chunks_exact(2).map(level), u16::MAX.into());
        (pixels(levels, channels, Extra::Opacity, Some(full)), full)
    } else {
        let levels = levels.iter().map(|level| f64::from(*level));
        let full = u8::MAX.into();
        (pixels(levels, channels, Extra::Opacity, Some(full)), full)
    };
    let Pixels { values, transparent, clipped } = found;
    if values.len() != columns * rows {
        return Err(broken(&"it has fewer pixels than it says"));
    }
    // Texts and Exif data may follow the pixels; what is broken there does no harm.
    let _ = reader.finish();
    let info = reader.info();
    let full_scale = match info.sbit.as_deref().and_then(|bits| bits.iter().max()) {
        Some(bits @ 8..16) if depth == BitDepth::Sixteen => scale_of_bits(&values, *bits),
        _ => full_scale,
    };
    // What this program writes beside a map; the keywords are public for that.
    let metadata = |key: &str| {
        let text = &info.uncompressed_latin1_text.iter().find(|text| text.keyword == key)?.text;
        text.parse().ok().filter(|number: &f64| number.is_finite() && *number > 0.0)
    };
    let per_metre = info
        .pixel_dims
        .filter(|density| density.unit == Unit::Meter)
        .map(|density| [density.xppu, density.yppu]);
    let pixel = metadata(CELL).map(|cell| [cell; 2]);
    Ok(RawPicture {
        full_scale: Some(full_scale),
        weight_of_black: metadata(WEIGHT_OF_BLACK).filter(|_| channels == 1),
        pixel: pixel.or(per_metre.map(|sides| sides.map(|count| 1.0 / f64::from(count)))),
        colour: channels > 2,
        coding: coding(info),
        more: info.is_animated(),
        transparent,
        clipped,
        orientation: info.exif_metadata.as_deref().map_or(1, orientation::of_exif),
        ..RawPicture::plain(values, columns, rows)
    })
}

/// By what the levels are coded for screens.
fn coding(info: &png::Info<'_>) -> Option<&'static str> {
    /// A gamma so near to one is none.
    const NONE: f32 = 0.02;
    let has_gamma = info.gama_chunk.is_some_and(|gamma| (gamma.into_value() - 1.0).abs() > NONE);
    match (info.srgb.is_some(), info.icc_profile.is_some(), has_gamma) {
        (true, ..) => Some("sRGB"),
        (_, true, _) => Some("a colour profile"),
        (.., true) => Some("a gamma"),
        _ => None,
    }
}

/// What is wrong with a file, in words. The texts of the decoder name its own types.
fn failed(error: DecodingError) -> Fault {
    broken(&match error {
        DecodingError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => {
            "it ends too early".to_owned()
        }
        DecodingError::IoError(error) => error.to_string(),
        DecodingError::LimitsExceeded => "its parts are too large".to_owned(),
        DecodingError::Format(_) | DecodingError::Parameter(_) => "its content is damaged".to_owned(),
    })
}

/// The largest level of a camera of some bits in a file of 16 bits. The standard wants the levels raised to
/// 16 bits; some programs leave them as they are.
///
/// Source: PNG specification, third edition, 11.3.2.4 (sBIT) and 13.12.
fn scale_of_bits(values: &[f64], bits: u8) -> f64 {
    let step = f64::from(1u32 << (16 - bits));
    let largest = f64::from((1u32 << bits) - 1);
    let levels = || values.iter().filter(|level| !level.is_nan());
    if levels().all(|level| level % step == 0.0) {
        largest * step
    } else if levels().all(|level| *level <= largest) {
        largest
    } else {
        u16::MAX.into()
    }
}
