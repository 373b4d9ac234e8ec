//! Pictures for the tests, and the files of them.
#![allow(dead_code, clippy::unwrap_used)]

use std::io::Cursor;
use tiff::encoder::colortype::{ColorType, Gray8, Gray16, Gray32Float};
use tiff::encoder::{Rational, TiffEncoder, TiffValue};
use tiff::tags::ResolutionUnit;

/// A grey PNG of 8 bits.
pub fn png8(columns: usize, levels: &[u8]) -> Vec<u8> {
    png(columns, png::ColorType::Grayscale, png::BitDepth::Eight, levels)
}

/// A grey PNG of 16 bits.
pub fn png16(columns: usize, levels: &[u16]) -> Vec<u8> {
    let bytes: Vec<u8> = levels.iter().flat_map(|level| level.to_be_bytes()).collect();
    png(columns, png::ColorType::Grayscale, png::BitDepth::Sixteen, &bytes)
}

/// Any PNG.
pub fn png(columns: usize, colour: png::ColorType, depth: png::BitDepth, bytes: &[u8]) -> Vec<u8> {
    let row = columns * colour.samples() * if depth == png::BitDepth::Sixteen { 2 } else { 1 };
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, columns as u32, (bytes.len() / row) as u32);
    encoder.set_color(colour);
    encoder.set_depth(depth);
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(bytes).unwrap();
    writer.finish().unwrap();
    file
}

/// A grey PNG of 8 bits that tells how many pixels there are to a metre across and down.
pub fn png_of_resolution(columns: usize, levels: &[u8], [xppu, yppu]: [u32; 2], unit: png::Unit) -> Vec<u8> {
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, columns as u32, (levels.len() / columns) as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_pixel_dims(Some(png::PixelDimensions { xppu, yppu, unit }));
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(levels).unwrap();
    writer.finish().unwrap();
    file
}

/// A grey TIFF of 8 bits that tells its resolution, as a fraction.
pub fn tiff_of_resolution(columns: usize, levels: &[u8], unit: ResolutionUnit, [n, d]: [u32; 2]) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut file).unwrap();
    let rows = (levels.len() / columns) as u32;
    let mut image = encoder.new_image::<Gray8>(columns as u32, rows).unwrap();
    image.resolution(unit, Rational { n, d });
    image.write_data(levels).unwrap();
    file.into_inner()
}

pub fn tiff8(columns: usize, levels: &[u8]) -> Vec<u8> {
    tiff::<Gray8>(columns, levels)
}

pub fn tiff16(columns: usize, levels: &[u16]) -> Vec<u8> {
    tiff::<Gray16>(columns, levels)
}

pub fn tiff_f32(columns: usize, levels: &[f32]) -> Vec<u8> {
    tiff::<Gray32Float>(columns, levels)
}

/// Any TIFF.
pub fn tiff<C: ColorType>(columns: usize, levels: &[C::Inner]) -> Vec<u8>
where
    [C::Inner]: TiffValue,
{
    let mut file = Cursor::new(Vec::new());
    let rows = levels.len() / columns / C::BITS_PER_SAMPLE.len();
    let mut encoder = TiffEncoder::new(&mut file).unwrap();
    encoder.write_image::<C>(columns as u32, rows as u32, levels).unwrap();
    file.into_inner()
}

/// An array of NumPy.
pub fn npy(kind: &str, order: &str, shape: &str, data: &[u8]) -> Vec<u8> {
    let mut head = format!("{{'descr': '{kind}', 'fortran_order': {order}, 'shape': {shape}, }}");
    while !(head.len() + 11).is_multiple_of(64) {
        head.push(' ');
    }
    head.push('\n');
    let length = (head.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\x00", &length[..], head.as_bytes(), data].concat()
}

/// An array of 64-bit numbers.
pub fn npy_f64(columns: usize, values: &[f64]) -> Vec<u8> {
    let data: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    npy("<f8", "False", &format!("({}, {columns})", values.len() / columns), &data)
}
