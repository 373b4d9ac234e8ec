//! Portable network graphics.

use super::{MOST_PIXELS, RawPicture, broken, luminance, within_limits};
use crate::error::Fault;
use png::{BitDepth, Decoder, Limits, Transformations, Unit};
use std::io::Cursor;

/// Keyword of the text that tells the basis weight of a black pixel of a map [kg/m²].
pub const WEIGHT_OF_BLACK: &str = "basis_weight_of_black_kg_m2";
/// Keyword of the text that tells the side of a cell of a map [m].
pub const CELL: &str = "cell_m";

pub(super) fn parse(bytes: &[u8]) -> Result<RawPicture, Fault> {
    let failed = |error: png::DecodingError| broken(&error);
    // Four channels of two bytes, and as much for decoding.
    let limits = Limits { bytes: 16 * MOST_PIXELS };
    let mut decoder = Decoder::new_with_limits(Cursor::new(bytes), limits);
    // Palettes and few bits become eight bits a channel.
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
    let (values, full_scale) = if depth == BitDepth::Sixteen {
        let level = |pair: &[u8]| f64::from(u16::from_be_bytes([pair[0], pair[1]]));
        (luminance(levels.chunks_exact(2).map(level), channels), u16::MAX.into())
    } else {
        (luminance(levels.iter().map(|level| f64::from(*level)), channels), u8::MAX.into())
    };
    if values.len() != columns * rows {
        return Err(broken(&"it has fewer pixels than it says"));
    }
    let info = reader.info();
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
        values,
        columns,
        rows,
        full_scale: Some(full_scale),
        weight_of_black: metadata(WEIGHT_OF_BLACK).filter(|_| channels == 1),
        pixel: pixel.or(per_metre.map(|sides| sides.map(|count| 1.0 / f64::from(count)))),
        colour: channels > 2,
        more: info.is_animated(),
    })
}
