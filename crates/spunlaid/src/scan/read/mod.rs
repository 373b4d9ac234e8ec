//! Pictures from files. Memory is taken only for a picture whose size is within the limits.

mod npy;
mod png;
mod text;
mod tiff;

pub use self::png::{CELL, WEIGHT_OF_BLACK};

use super::picture::{Format, Picture};
use crate::error::{Fault, FileError, FileKind};
use crate::file;
use crate::units::Dimension;
use std::path::Path;

/// Most pixels of a picture.
pub const MOST_PIXELS: usize = 1 << 26;
/// Least number of pixels either way.
pub const LEAST_SIDE: usize = 16;
/// The sides of a square pixel differ by less than this share.
const SQUARE: f64 = 1e-3;
/// Largest file [bytes]: 32 bytes of text for each pixel.
const MOST_BYTES: u64 = 32 * MOST_PIXELS as u64;

/// What a reader finds in a file.
struct RawPicture {
    values: Vec<f64>,
    columns: usize,
    rows: usize,
    full_scale: Option<f64>,
    weight_of_black: Option<f64>,
    /// Width and height of a pixel, if the file tells them [m].
    pixel: Option<[f64; 2]>,
    colour: bool,
    more: bool,
}

impl RawPicture {
    /// Plain values without a largest one.
    fn plain(values: Vec<f64>, columns: usize, rows: usize) -> Self {
        let (full_scale, weight_of_black, pixel) = (None, None, None);
        Self { values, columns, rows, full_scale, weight_of_black, pixel, colour: false, more: false }
    }
}

/// Reads a picture or a map. The format is recognised from the content of the file.
///
/// * `pixel` – side of a pixel [m]; if none, PNG and TIFF tell it by their resolution
///
/// # Errors
/// When the file cannot be read or holds no picture within the limits; the message says where and why.
pub fn read(path: &Path, pixel: impl Into<Option<f64>>) -> Result<Picture, FileError> {
    let bytes = file::read(path, FileKind::Scan, MOST_BYTES)?;
    parse(&bytes, &path.display().to_string(), pixel)
}

/// Reads the bytes of a file; messages call it `name`.
///
/// # Errors
/// The errors of [`read`].
pub fn parse(bytes: &[u8], name: &str, pixel: impl Into<Option<f64>>) -> Result<Picture, FileError> {
    parsed(bytes, name, pixel.into()).map_err(|error| error.file(name))
}

fn parsed(bytes: &[u8], name: &str, pixel: Option<f64>) -> Result<Picture, FileError> {
    if let Some(pixel) = pixel.filter(|pixel| !is_length(*pixel)) {
        return Err(Fault::new(
            format!("cannot have pixels of {}", Dimension::Length.pretty(pixel)),
            "give the side of a pixel, a length above zero",
        )
        .into());
    }
    let format = format(bytes)?;
    let raw = match format {
        Format::Png => png::parse(bytes)?,
        Format::Tiff => tiff::parse(bytes)?,
        Format::Npy => npy::parse(bytes)?,
        Format::Table => text::parse(bytes)?,
    };
    let RawPicture { values, columns, rows, full_scale, weight_of_black, colour, more, .. } = raw;
    if columns.min(rows) < LEAST_SIDE {
        return Err(Fault::new(
            format!("has {columns} × {rows} pixels"),
            format!(
                "at least {} are needed in each direction, so scan a larger piece of the web",
                LEAST_SIDE
            ),
        )
        .into());
    }
    let file = name.to_owned();
    let sides_of_file = raw.pixel.filter(|sides| sides.iter().copied().all(is_length));
    let square = |[width, height]: [f64; 2]| (width / height - 1.0).abs() < SQUARE;
    let pixel_of_file = sides_of_file.filter(|sides| square(*sides)).map(|[width, _]| width);
    let pixel =
        match (pixel.or(pixel_of_file), sides_of_file) {
            (Some(pixel), _) => pixel,
            (None, Some([width, height])) => return Err(Fault::new(
                format!(
                    "says that its pixels are {} wide and {} high",
                    Dimension::Length.pretty_to(width, 4),
                    Dimension::Length.pretty_to(height, 4)
                ),
                "scan with the same resolution both ways, or give the side of a pixel if the file is wrong",
            )
            .option("--pixel")
            .into()),
            (None, None) => {
                return Err(Fault::new(
                    "does not say how large its pixels are",
                    "give the side of a pixel, as \"0.1 mm\"",
                )
                .option("--pixel")
                .into());
            }
        };
    Ok(Picture {
        file,
        format,
        values,
        columns,
        rows,
        pixel,
        pixel_of_file,
        full_scale,
        weight_of_black,
        colour,
        more,
    })
}

fn is_length(side: f64) -> bool {
    side.is_finite() && side > 0.0
}

/// The format, by how a file begins.
fn format(bytes: &[u8]) -> Result<Format, Fault> {
    const OTHERS: [(&[u8], &str); 11] = [
        (b"\xff\xd8\xff", "a JPEG picture, which loses the fine structure"),
        (b"GIF8", "a GIF picture"),
        (b"BM", "a BMP picture"),
        (b"RIFF", "a WebP picture"),
        (b"\0\0\0\x0cjP  ", "a JPEG 2000 picture"),
        (b"\xff\x4f\xff\x51", "a JPEG 2000 picture"),
        (b"\0\0\0\x0cJXL ", "a JPEG XL picture"),
        (b"\xff\x0a", "a JPEG XL picture"),
        (b"%PDF", "a PDF document"),
        (b"PAR1", "a Parquet table"),
        (b"PK", "a ZIP archive (an Excel table, .npz?)"),
    ];
    // HEIC and AVIF tell their kind after the length of their first box.
    let brand = bytes.get(4..8) == Some(b"ftyp");
    let other = |bytes: &[u8]| match OTHERS.iter().find(|(start, _)| bytes.starts_with(start)) {
        Some((_, found)) => Some(*found),
        None => brand.then_some("a HEIC or AVIF picture, or a film"),
    };
    if bytes.starts_with(b"\x89PNG\r\n\x1a\n") {
        Ok(Format::Png)
    } else if [&b"II*\0"[..], b"MM\0*", b"II+\0", b"MM\0+"].iter().any(|start| bytes.starts_with(start)) {
        Ok(Format::Tiff)
    } else if bytes.starts_with(b"\x93NUMPY") {
        Ok(Format::Npy)
    } else if let Some(found) = other(bytes) {
        Err(Fault::new(
            format!("is {found}"),
            "save the scan as PNG or TIFF in shades of grey, or the map as NumPy array (.npy) or CSV",
        ))
    } else {
        Ok(Format::Table)
    }
}

/// Refuses a picture that is too large, before memory is taken for it.
fn within_limits(columns: u64, rows: u64) -> Result<[usize; 2], Fault> {
    let too_many = Fault::new(
        format!("has {columns} × {rows} pixels"),
        format!(
            "at most {} are read, so cut out a part of the picture, or make its pixels larger",
            MOST_PIXELS
        ),
    );
    let sides = [columns, rows].map(|side| usize::try_from(side).ok());
    match sides {
        [Some(columns), Some(rows)]
            if columns.checked_mul(rows).is_some_and(|pixels| pixels <= MOST_PIXELS) =>
        {
            Ok([columns, rows])
        }
        _ => Err(too_many),
    }
}

/// The luminance of pixels of some channels: one is grey, two are grey and transparency, three and four colours without and with it.
///
/// Source: Recommendation ITU-R BT.709, 3.2.
fn luminance(values: impl Iterator<Item = f64>, channels: usize) -> Vec<f64> {
    let weights: &[f64] = match channels {
        1 => &[1.0],
        2 => &[1.0, 0.0],
        3 => &[0.2126, 0.7152, 0.0722],
        _ => &[0.2126, 0.7152, 0.0722, 0.0],
    };
    let (mut pixels, mut sum) = (Vec::new(), 0.0);
    for (value, channel) in values.zip((0..weights.len()).cycle()) {
        sum += weights[channel] * value;
        if channel + 1 == weights.len() {
            pixels.push(sum);
            sum = 0.0;
        }
    }
    pixels
}

fn broken(message: &impl ToString) -> Fault {
    Fault::new(
        format!("cannot be decoded: {}", crate::units::excerpt(&message.to_string(), 120)),
        "is the file complete?",
    )
}

/// The fault of a file that is written in a way that is not read.
fn unsupported(found: &str, remedy: &'static str) -> Fault {
    Fault::new(format!("has {found}, which cannot be read"), remedy)
}
