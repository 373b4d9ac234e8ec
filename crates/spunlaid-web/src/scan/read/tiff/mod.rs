//! Tagged image file format.

use super::channels::{Extra, Pixels, pixels};
use super::{MOST_PIXELS, RawPicture, broken, unsupported, within_limits};
use spunlaid_ground::{Dimension, Fault};
use std::io::{Cursor, ErrorKind, Read, Seek};
use tiff::decoder::ifd::Value;
use tiff::decoder::{ChunkType, Decoder, DecodingResult, Limits};
use tiff::tags::{PhotometricInterpretation, Tag};
use tiff::{ColorType, TiffError, TiffFormatError, TiffUnsupportedError};

pub(super) fn parse(bytes: &[u8]) -> Result<RawPicture, Fault> {
    let mut limits = Limits::default();
    limits.decoding_buffer_size = 8 * MOST_PIXELS;
    limits.intermediate_buffer_size = 8 * MOST_PIXELS;
    let mut decoder = Decoder::new(Cursor::new(bytes)).map_err(failed)?.with_limits(limits);
    let more = seek_full(&mut decoder)?;
    let (columns, rows) = decoder.dimensions().map_err(failed)?;
    let [columns, rows] = within_limits(columns.into(), rows.into())?;
    let photometric = small_tag(&mut decoder, Tag::PhotometricInterpretation);
    let compression = small_tag(&mut decoder, Tag::Compression).filter(|number| *number > 1);
    if photometric == Some(PALETTE) {
        return Err(unsupported("colours from a palette", GREY));
    }
    let channels = channels(&mut decoder).map_err(|fault| match compression {
        // A fax has a bit for each pixel, and its name says more.
        Some(number @ 2..=4) => compressed(number),
        _ => fault,
    })?;
    let is_tiled = decoder.get_chunk_type() == ChunkType::Tile;
    let image = decoder.read_image().map_err(|error| match (error, compression) {
        (TiffError::UnsupportedError(_), Some(number)) => compressed(number),
        // The decoder fails in some tiles that reach beyond the picture (image-tiff, issue 395).
        (TiffError::IoError(_), Some(LZW)) if is_tiled => unsupported(
            "tiles with LZW compression",
            "save it in strips, or without compression, or with Deflate",
        ),
        (error, _) => failed(error),
    })?;
    let extra = extra(&mut decoder);
    let of = |full: u32| Some(f64::from(full));
    let read = |levels: &mut dyn Iterator<Item = f64>, full| (pixels(levels, channels, extra, full), full);
    let (found, full_scale) = match image {
        DecodingResult::U8(levels) => read(&mut levels.into_iter().map(f64::from), of(u8::MAX.into())),
        DecodingResult::U16(levels) => read(&mut levels.into_iter().map(f64::from), of(u16::MAX.into())),
        DecodingResult::U32(levels) => read(&mut levels.into_iter().map(f64::from), of(u32::MAX)),
        DecodingResult::F32(levels) => read(&mut levels.into_iter().map(f64::from), None),
        DecodingResult::F64(levels) => read(&mut levels.into_iter(), None),
        other => {
            let found = match other {
                DecodingResult::F16(_) => "half floats",
                DecodingResult::U64(_) => "numbers of 8 bytes",
                _ => "signed numbers",
            };
            let advice = "save it with 8, 16 or 32 bits without sign, or as floating point of 32 bits";
            return Err(unsupported(found, advice));
        }
    };
    let Pixels { mut values, transparent, clipped } = found;
    if values.len() != columns * rows {
        let found = "each colour in a plane of its own";
        return Err(unsupported(found, "save the scan in shades of grey"));
    }
    let is_negative = photometric == Some(WHITE_IS_ZERO);
    let full_scale = full_scale.map(|full| scale_down(&mut decoder, &mut values, full, is_negative));
    let orientation = small_tag(&mut decoder, Tag::Orientation).unwrap_or(1);
    let (pixel, colour) = (sides(&mut decoder), channels > 2);
    let has_profile = decoder.find_tag(Tag::Unknown(COLOUR_PROFILE)).ok().flatten().is_some();
    leave_out_missing(&mut decoder, &mut values);
    Ok(RawPicture {
        full_scale,
        pixel,
        colour,
        coding: has_profile.then_some("a colour profile"),
        more,
        transparent,
        clipped,
        orientation,
        ..RawPicture::plain(values, columns, rows)
    })
}

/// The tag of a colour profile.
const COLOUR_PROFILE: u16 = 34675;
/// How a file says that zero is white. The decoder then subtracts the levels from the largest that their bits can hold.
const WHITE_IS_ZERO: u16 = 0;
/// How a file says that its pixels are places in a palette.
const PALETTE: u16 = 3;
/// The tag of compression by LZW.
const LZW: u16 = 5;
/// What to do about a file whose pixels are of a kind that is not read.
const GREY: &str = "save the scan in shades of grey, with 8 or 16 bits each, without compression";

fn small_tag(decoder: &mut Decoder<Cursor<&[u8]>>, tag: Tag) -> Option<u16> {
    decoder.find_tag_unsigned(tag).ok().flatten()
}

fn compressed(number: u16) -> Fault {
    unsupported(&compression_name(number), "save the scan as TIFF without compression, or as PNG")
}

/// The number of channels, of which the first one or three are read.
fn channels(decoder: &mut Decoder<Cursor<&[u8]>>) -> Result<usize, Fault> {
    let found = match decoder.colortype().map_err(failed)? {
        ColorType::Gray(8 | 16 | 32 | 64) => return Ok(1),
        ColorType::GrayA(8 | 16 | 32 | 64)
        | ColorType::Multiband { bit_depth: 8 | 16 | 32 | 64, num_samples: 2 } => return Ok(2),
        ColorType::RGB(8 | 16 | 32 | 64) => return Ok(3),
        ColorType::RGBA(8 | 16 | 32 | 64) => return Ok(4),
        ColorType::CMYK(_) | ColorType::CMYKA(_) => "the colours of a printer (CMYK)".to_owned(),
        ColorType::YCbCr(_) => "brightness and colour apart (YCbCr)".to_owned(),
        ColorType::Lab(_) => "colours of the kind CIE L*a*b*".to_owned(),
        ColorType::Multiband { num_samples, .. } if num_samples > 1 => {
            format!("{num_samples} shades of grey for each pixel")
        }
        ColorType::Gray(bits) | ColorType::RGB(bits) | ColorType::RGBA(bits) => {
            format!("{bits} {} for each level", if bits == 1 { "bit" } else { "bits" })
        }
        _ => "channels or bits of a pixel of another kind".to_owned(),
    };
    Err(unsupported(&found, GREY))
}

/// The largest level of a camera with fewer bits than the numbers of the file, if the file reports it. Other
/// values of the tag are the largest level that was found, which says nothing of the camera.
///
/// * `is_negative` – whether the decoder has subtracted the levels from `full`
///
/// Source: TIFF 6.0, section 8, MaxSampleValue.
fn scale_down(decoder: &mut Decoder<Cursor<&[u8]>>, values: &mut [f64], full: f64, is_negative: bool) -> f64 {
    let mut largest = |tag| match decoder.find_tag(tag).ok().flatten()? {
        Value::List(values) => values.first()?.clone().into_u32().ok(),
        Value::Float(value) => Some(value as u32),
        Value::Double(value) => Some(value as u32),
        value => value.into_u32().ok(),
    };
    let tags = [Tag::MaxSampleValue, Tag::SMaxSampleValue];
    let is_depth = |largest: &u32| *largest >= 255 && (u64::from(*largest) + 1).is_power_of_two();
    let Some(largest) = tags.into_iter().filter_map(&mut largest).find(is_depth).map(f64::from) else {
        return full;
    };
    let lift = if is_negative { full - largest } else { 0.0 };
    let is_beyond = |level: &f64| *level < lift || *level > lift + largest;
    if largest >= full || values.iter().any(is_beyond) {
        return full;
    }
    values.iter_mut().for_each(|level| *level -= lift);
    largest
}

/// What the last channel is, if there are more than those of the colours.
///
/// Source: TIFF 6.0, section 18, ExtraSamples.
fn extra(decoder: &mut Decoder<Cursor<&[u8]>>) -> Extra {
    match decoder.find_tag_unsigned_vec::<u16>(Tag::ExtraSamples).ok().flatten().as_deref() {
        Some([1, ..]) => Extra::Multiplied,
        Some([2, ..]) => Extra::Opacity,
        _ => Extra::Unknown,
    }
}

/// Leaves out the number that stands for missing ones, as GDAL and programs of geography give it.
fn leave_out_missing(decoder: &mut Decoder<Cursor<&[u8]>>, values: &mut [f64]) {
    let Ok(Some(Value::Ascii(text))) = decoder.find_tag(Tag::GdalNodata) else { return };
    if let Ok(missing) = text.trim().parse::<f64>() {
        values.iter_mut().filter(|value| **value == missing).for_each(|value| *value = f64::NAN);
    }
}

/// The bits of NewSubfileType of a page that is a smaller copy of another one, or its mask.
const COPY_OR_MASK: u32 = 1 | 4;
/// The value of the older SubfileType of a smaller copy.
const OLD_COPY: u16 = 2;

/// Goes to the first of the largest pages, and says whether the file has further pictures. A thumbnail is none.
fn seek_full<R: Read + Seek>(decoder: &mut Decoder<R>) -> Result<bool, Fault> {
    let mut pages = vec![Page::new(decoder)];
    while decoder.more_images() {
        // A page that cannot be read is not the scan; the places of the others must stay right.
        pages.push(if decoder.next_image().is_ok() { Page::new(decoder) } else { Page::default() });
    }
    let whole = |page: &Page| page.pixels > 0 && !page.is_copy;
    let among = |page: &&Page| !pages.iter().any(whole) || whole(page);
    let largest = pages.iter().filter(among).map(|page| page.pixels).max().unwrap_or(0);
    let best = pages.iter().position(|page| among(&page) && page.pixels == largest).unwrap_or(0);
    if pages.len() > 1 {
        decoder.seek_to_image(best).map_err(failed)?;
    }
    // Raw files of cameras keep the scan behind the thumbnail.
    if pages[best].is_copy && pages[best].has_parts {
        return Err(unsupported("a thumbnail in front and the image itself in a part behind it", GREY));
    }
    Ok(pages.iter().filter(|page| whole(page)).count() > 1)
}

/// What distinguishes the pages of a file.
#[derive(Clone, Copy, Debug, Default)]
struct Page {
    /// Their number; zero if the page cannot be read.
    pixels: u64,
    /// Whether it is a smaller copy of another page, or its mask.
    is_copy: bool,
    /// Whether it has pages of its own.
    has_parts: bool,
}

impl Page {
    fn new<R: Read + Seek>(decoder: &mut Decoder<R>) -> Self {
        let (columns, rows) = decoder.dimensions().unwrap_or_default();
        let kind = decoder.find_tag_unsigned::<u32>(Tag::NewSubfileType).ok().flatten();
        let old = decoder.find_tag_unsigned::<u16>(Tag::SubfileType).ok().flatten();
        Self {
            pixels: u64::from(columns) * u64::from(rows),
            is_copy: kind.map_or(old == Some(OLD_COPY), |kind| kind & COPY_OR_MASK != 0),
            has_parts: decoder.image_ifd().directory().contains(Tag::SubIfd),
        }
    }
}

/// A file that is broken, or whole but of a kind that the decoder does not know.
fn failed(error: TiffError) -> Fault {
    match error {
        TiffError::UnsupportedError(kind) => unsupported(other_kind(&kind), GREY),
        TiffError::UsageError(_) => unsupported("a predictor that does not fit its numbers", GREY),
        TiffError::FormatError(
            TiffFormatError::InvalidTagValueType(tag)
            | TiffFormatError::RequiredTagNotFound(tag)
            | TiffFormatError::InvalidCountForTag(tag, _),
        ) => broken(&format!("its tag {} is missing or of a wrong kind", tag.to_u16())),
        TiffError::FormatError(TiffFormatError::UnknownPredictor(number)) => {
            unsupported(&format!("the predictor of number {number}"), GREY)
        }
        TiffError::FormatError(TiffFormatError::CompressedDataCorrupt(_)) => {
            broken(&"its compressed data are damaged")
        }
        TiffError::FormatError(error) => broken(&error),
        TiffError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => broken(&"it ends too early"),
        TiffError::LimitsExceeded | TiffError::IntSizeError => {
            broken(&"its strips, its tiles or their places are too large")
        }
        error => broken(&error),
    }
}

fn other_kind(kind: &TiffUnsupportedError) -> &'static str {
    use TiffUnsupportedError as Kind;
    match kind {
        Kind::FloatingPointPredictor(_) | Kind::HorizontalPredictor(_) => {
            "a predictor that does not fit its numbers"
        }
        Kind::InconsistentBitsPerSample(_) => "channels of different numbers of bits",
        Kind::UnsupportedSampleFormat(_) => "channels of different kinds of numbers",
        Kind::ChromaSubsampling => "colours at fewer places than the brightness",
        Kind::MisalignedTileBoundaries => "tiles that do not end at whole bytes",
        Kind::InterpretationWithBits(PhotometricInterpretation::CIELab, _) => {
            "colours of the kind CIE L*a*b*"
        }
        Kind::UnknownInterpretation => "colours of a kind that is not known (PhotometricInterpretation)",
        _ => "pixels of another kind than those that are known",
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

/// Bytes of a description in which the scale is looked for.
const BEGINNING: usize = 1 << 16;
const INCH: f64 = 25.4e-3;

/// Width and height of a pixel [m], if the file reports them.
fn sides<R: Read + Seek>(decoder: &mut Decoder<R>) -> Option<[f64; 2]> {
    let text = description(decoder).unwrap_or_default();
    if text.contains("<OME") && text.contains("PhysicalSizeX=") {
        return of_ome(&text);
    }
    let units = if text.starts_with("ImageJ=") { units_of_imagej(&text) } else { None };
    let units = match units {
        Some(units) => [units[0]?, units[1]?],
        None => match decoder.find_tag_unsigned::<u16>(Tag::ResolutionUnit) {
            // Inches are the default.
            Ok(None | Some(2)) => [INCH; 2],
            Ok(Some(3)) => [10e-3; 2],
            _ => return None,
        },
    };
    let mut side = |tag, unit: f64| match decoder.find_tag(tag) {
        Ok(Some(Value::Rational(count, per))) => Some(unit * f64::from(per) / f64::from(count)),
        _ => None,
    };
    Some([side(Tag::XResolution, units[0])?, side(Tag::YResolution, units[1])?])
}

/// The text of the tag ImageDescription, in UTF-8 or Latin-1.
fn description<R: Read + Seek>(decoder: &mut Decoder<R>) -> Option<String> {
    let mut bytes = vec![0; BEGINNING];
    let count = decoder.image_ifd().find_tag_bytes(Tag::ImageDescription, &mut bytes, 0).ok()??;
    bytes.truncate(count.min(BEGINNING));
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    bytes.truncate(end);
    Some(match String::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => error.into_bytes().iter().map(|byte| char::from(*byte)).collect(),
    })
}

/// The units of the resolution across and down in the description of ImageJ, each of them none if it is no
/// length. None if the description has no unit: then the tags have it.
///
/// Source: ImageJ, `ij/io/TiffDecoder.java` and `ij/io/FileSaver.java`.
fn units_of_imagej(text: &str) -> Option<[Option<f64>; 2]> {
    let value = |key: &str| {
        let line = text.lines().find_map(|line| line.trim().strip_prefix(key)?.strip_prefix('='));
        line.map(str::trim).filter(|unit| !unit.is_empty())
    };
    let across = value("unit")?;
    Some([metres(across), metres(value("yunit").unwrap_or(across))])
}

/// Sides by the attributes of OME-XML; their unit is a micrometre where none is reported.
///
/// Source: OME data model 2016-06, `Pixels`.
fn of_ome(text: &str) -> Option<[f64; 2]> {
    let attribute = |name: &str| {
        let rest = text.split_once(&format!("{name}=\""))?.1;
        rest.split_once('"').map(|(value, _)| value.trim())
    };
    let side = |axis: &str| {
        let number: f64 = attribute(&format!("PhysicalSize{axis}"))?.parse().ok()?;
        Some(number * metres(attribute(&format!("PhysicalSize{axis}Unit")).unwrap_or("µm"))?)
    };
    Some([side("X")?, side("Y")?])
}

/// A unit of length by its sign or its name, in whatever spelling; none of another unit, as pixels are.
fn metres(unit: &str) -> Option<f64> {
    let name = unit.replace("\\u00B5", "µ").replace("\\u00b5", "µ").replace("&#181;", "µ").to_lowercase();
    let name = name.trim_end_matches('.').replace("metre", "meter");
    let name = match name.strip_suffix('s') {
        Some(one) if one.len() > 1 => one,
        _ => &name,
    };
    let sign = match name {
        "inch" | "in" | "inche" | "\"" => return Some(INCH),
        "meter" => "m",
        "centimeter" => "cm",
        "millimeter" => "mm",
        "micron" | "micrometer" => "µm",
        "nanometer" => "nm",
        sign => sign,
    };
    Dimension::Length.parse(&format!("1 {sign}")).ok().filter(|_| sign.chars().all(|c| !c.is_ascii_digit()))
}
