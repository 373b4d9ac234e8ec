//! Pictures from files. Memory is taken only for a picture whose size is within the limits.

mod channels;
mod npy;
mod orientation;
mod png;
mod text;
mod tiff;

pub use self::png::{CELL, WEIGHT_OF_BLACK};

use super::picture::{Format, Picture};
use spunlaid_ground::{Dimension, Fault, FileError, FileKind, file};
use std::path::Path;

/// Most pixels of a picture.
pub(crate) const MOST_PIXELS: usize = 1 << 26;
/// Least number of pixels either way.
pub(crate) const LEAST_SIDE: usize = 16;
/// Pixels of a scan as a file may give them [m]. Others are the mistake of a unit.
const SCANNED: std::ops::RangeInclusive<f64> = 0.1e-6..=5e-3;
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
    /// Width and height of a pixel, if the file reports them [m].
    pixel: Option<[f64; 2]>,
    colour: bool,
    /// By what the file says that its levels are coded, if they are not proportional to light.
    coding: Option<&'static str>,
    more: bool,
    /// Pixels that are transparent, and those of which a channel has the largest level.
    transparent: usize,
    clipped: usize,
    /// Where the first row and column belong, from 1 to 8 as TIFF numbers it.
    orientation: u16,
    /// Whether the rows, and the columns, were numbered beside the values.
    numbered: [bool; 2],
}

impl RawPicture {
    /// Plain values without a largest one.
    fn plain(values: Vec<f64>, columns: usize, rows: usize) -> Self {
        Self {
            values,
            columns,
            rows,
            full_scale: None,
            weight_of_black: None,
            pixel: None,
            colour: false,
            coding: None,
            more: false,
            transparent: 0,
            clipped: 0,
            orientation: 1,
            numbered: [false; 2],
        }
    }
}

/// Reads a picture or a map. The format is recognised from the content of the file.
///
/// * `pixel` – side of a pixel [m]; if none, PNG and TIFF give it by their resolution
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
    let raw = orientation::upright(raw);
    let RawPicture { values, columns, rows, full_scale, weight_of_black, colour, more, numbered, .. } = raw;
    let transparent = raw.transparent;
    let clipped = raw.clipped;
    let coding = raw.coding;
    if transparent == values.len() {
        let remedy = "save the scan without transparency";
        return Err(Fault::new("has no pixel that is not transparent", remedy).into());
    }
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
    let fewer_bits = full_scale.and_then(|full| fewer_bits(&values, full));
    let is_map = weight_of_black.is_some() || format == Format::Table;
    let (pixel, pixel_of_file) = side_of_a_pixel(pixel, raw.pixel, is_map)?;
    Ok(Picture {
        file,
        format,
        values,
        columns,
        rows,
        pixel,
        pixel_of_file,
        full_scale,
        fewer_bits,
        weight_of_black,
        colour,
        coding,
        more,
        transparent,
        clipped,
        numbered,
    })
}

/// The side of a pixel, as it was given or else as the file reports it, and what the file reports [m].
///
/// * `is_map` – whether the file is a map, whose cells may be of any size
fn side_of_a_pixel(
    given: Option<f64>,
    of_file: Option<[f64; 2]>,
    is_map: bool,
) -> Result<(f64, Option<f64>), Fault> {
    let ask = |message: String, remedy: &'static str| Fault::new(message, remedy).option("--pixel");
    let shown = |side: f64| Dimension::Length.pretty_to(side, 4);
    let sides = of_file.filter(|sides| sides.iter().copied().all(is_length));
    let is_square = |[width, height]: &[f64; 2]| (width / height - 1.0).abs() < SQUARE;
    let square = sides.filter(is_square).map(|[width, _]| width);
    match (given, square, sides) {
        (Some(given), _, _) => Ok((given, square)),
        (None, Some(side), _) if is_map || SCANNED.contains(&side) => Ok((side, square)),
        (None, Some(side), _) => Err(ask(
            format!("says that its pixels are {} wide, which no pixel of a scanned web is", shown(side)),
            "give the side of a pixel, as \"0.1 mm\"",
        )),
        (None, None, Some([width, height])) => Err(ask(
            format!("says that its pixels are {} wide and {} high", shown(width), shown(height)),
            "scan with the same resolution both ways, or give the side of a pixel if the file is wrong",
        )),
        (None, None, None) => Err(ask(
            "does not say how large its pixels are".to_owned(),
            "give the side of a pixel, as \"0.1 mm\"",
        )),
    }
}

/// The bits that a camera has whose levels lie in numbers of 16 bits, if the levels need no more.
fn fewer_bits(values: &[f64], full_scale: f64) -> Option<u32> {
    let largest = values.iter().copied().fold(0.0, f64::max);
    let fits = |bits: &u32| largest < f64::from(1u32 << bits);
    [10, 12].into_iter().find(fits).filter(|_| full_scale == f64::from(u16::MAX))
}

fn is_length(side: f64) -> bool {
    side.is_finite() && side > 0.0
}

/// The format, by how a file begins.
fn format(bytes: &[u8]) -> Result<Format, Fault> {
    if let Some(format) = format_read(bytes) {
        return Ok(format);
    }
    match picture_refused(bytes).or_else(|| other(bytes)) {
        Some(found) => Err(Fault::new(
            format!("is {found}"),
            "save the scan as PNG or TIFF in shades of grey, or the map as NumPy array (.npy) or CSV",
        )),
        None => Ok(Format::Table),
    }
}

/// Whether a file begins as a picture or an array of NumPy, of a format that is read or of one that is
/// refused by its name.
pub(crate) fn is_picture(head: &[u8]) -> bool {
    format_read(head).is_some() || picture_refused(head).is_some()
}

fn format_read(bytes: &[u8]) -> Option<Format> {
    const STARTS: [(&[u8], Format); 6] = [
        (b"\x89PNG\r\n\x1a\n", Format::Png),
        (b"II*\0", Format::Tiff),
        (b"MM\0*", Format::Tiff),
        (b"II+\0", Format::Tiff),
        (b"MM\0+", Format::Tiff),
        (b"\x93NUMPY", Format::Npy),
    ];
    STARTS.iter().find(|(start, _)| bytes.starts_with(start)).map(|(_, format)| *format)
}

fn picture_refused(bytes: &[u8]) -> Option<&'static str> {
    const STARTS: [(&[u8], &str); 8] = [
        (b"\xff\xd8\xff", "a JPEG image, which loses the fine structure"),
        (b"GIF87a", "a GIF image"),
        (b"GIF89a", "a GIF image"),
        (b"\0\0\0\x0cjP  ", "a JPEG 2000 image"),
        (b"\xff\x4f\xff\x51", "a JPEG 2000 image"),
        (b"\0\0\0\x0cJXL ", "a JPEG XL image"),
        (b"\xff\x0a", "a JPEG XL image"),
        (b"%PDF-", "a PDF document"),
    ];
    // These state their kind after a length. Words may begin like a BMP picture, but hold no zero bytes.
    let at = |place: usize, wanted: &[u8]| bytes.get(place..place + wanted.len()) == Some(wanted);
    let later = [
        (at(0, b"BM") && at(6, &[0; 4]), "a BMP image"),
        (at(0, b"RIFF") && at(8, b"WEBP"), "a WebP image"),
        (at(4, b"ftyp"), "a HEIC or AVIF image, or a film"),
        (is_netpbm(bytes), "a PGM or PPM image"),
    ];
    let found = STARTS.iter().find(|(start, _)| bytes.starts_with(start)).map(|(_, found)| *found);
    found.or_else(|| later.iter().find(|(is, _)| *is).map(|(_, found)| *found))
}

/// Whether a file is a picture of Netpbm: `P5`, then a comment or its width and height. A record may have a
/// column of that name.
fn is_netpbm(bytes: &[u8]) -> bool {
    let [b'P', b'1'..=b'6', b'\n', rest @ ..] = bytes else { return false };
    let line = rest.split(|byte| *byte == b'\n').next().unwrap_or_default();
    let mut words = line.split(|byte| *byte == b' ').filter(|word| !word.is_empty());
    let is_count = |word: &[u8]| word.iter().all(u8::is_ascii_digit);
    line.starts_with(b"#") || [words.next(), words.next()].iter().all(|word| word.is_some_and(is_count))
}

/// What else is not a map.
fn other(bytes: &[u8]) -> Option<&'static str> {
    const STARTS: [(&[u8], &str); 2] =
        [(b"PAR1", "a Parquet table"), (b"PK\x03\x04", "a ZIP archive (an Excel table, .npz?)")];
    STARTS.iter().find(|(start, _)| bytes.starts_with(start)).map(|(_, found)| *found)
}

/// Refuses a picture that is too large, before memory is taken for it.
fn within_limits(columns: u64, rows: u64) -> Result<[usize; 2], Fault> {
    let too_many = Fault::new(
        format!("has {columns} × {rows} pixels"),
        format!(
            "at most {} are read, so cut out a part of the image, or make its pixels larger",
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

fn broken(message: &impl ToString) -> Fault {
    Fault::new(
        format!("cannot be decoded: {}", spunlaid_ground::units::excerpt(&message.to_string(), 120)),
        "is the file complete?",
    )
}

/// The fault of a file that is written in a way that is not read.
fn unsupported(found: &str, remedy: &'static str) -> Fault {
    Fault::new(format!("has {found}, which cannot be read"), remedy)
}
