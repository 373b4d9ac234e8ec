//! How large the pixels of a TIFF are: by its description, as programs for microscopes write it, or by its tags.

use crate::units::Dimension;
use std::io::{Read, Seek};
use tiff::decoder::Decoder;
use tiff::decoder::ifd::Value;
use tiff::tags::Tag;

/// Bytes of a description in which the scale is looked for.
const BEGINNING: usize = 1 << 16;
const INCH: f64 = 25.4e-3;

/// Width and height of a pixel [m], if the file tells them.
pub(super) fn sides<R: Read + Seek>(decoder: &mut Decoder<R>) -> Option<[f64; 2]> {
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

/// Sides by the attributes of OME-XML; their unit is a micrometre where none is told.
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
