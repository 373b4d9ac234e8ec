//! The map of the basis weight as array and picture.

use super::MOST_CELLS;
use crate::Failure;
use crate::failure::undrawable;
use crate::files::folder::Staging;
use spunlaid_web::{CELL, Map, WEIGHT_OF_BLACK};
use std::fs::File;
use std::io;
use std::io::{BufWriter, Write};
use std::panic::resume_unwind;

/// Longest side of a picture that browsers show [px].
const LONGEST_SIDE: usize = 16_000;

/// Writes the map as array and picture, each on a thread.
pub fn write(staging: &Staging<'_>, map: &Map) -> Result<(), Failure> {
    if map.cells.len() > MOST_CELLS {
        return write_array(staging, map);
    }
    std::thread::scope(|scope| {
        let array = scope.spawn(|| write_array(staging, map));
        let picture = picture(map).map_err(|reason| undrawable("map", &reason));
        let pictured = picture.and_then(|picture| staging.write("map.png", picture));
        array.join().unwrap_or_else(|panic| resume_unwind(panic)).and(pictured)
    })
}

/// Writes the map as array only, `map.npy`.
pub fn write_array(staging: &Staging<'_>, map: &Map) -> Result<(), Failure> {
    let (now, later) = staging.place("map.npy");
    File::create(now).and_then(|file| array(map, BufWriter::new(file))).map_err(Failure::unwritable(&later))
}

/// What stands before the numbers of `map.npy`.
pub(super) fn array_head([columns, rows]: [usize; 2]) -> Vec<u8> {
    let mut words = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
    // The numbers begin at a multiple of 64 bytes.
    while !(10 + words.len() + 1).is_multiple_of(64) {
        words.push(' ');
    }
    words.push('\n');
    let mut head = b"\x93NUMPY\x01\x00".to_vec();
    head.extend((words.len() as u16).to_le_bytes());
    head.extend(words.into_bytes());
    head
}

/// A NumPy array of 32-bit numbers, a row of the web after the other [kg/m²].
pub(super) fn array(map: &Map, mut to: impl Write) -> io::Result<()> {
    to.write_all(&array_head([map.columns, map.rows]))?;
    let weight = map.weight_of_quantum();
    for row in 0..map.rows {
        let numbers = map.row(row).iter().map(|quanta| (f64::from(*quanta) * weight) as f32);
        to.write_all(&numbers.flat_map(f32::to_le_bytes).collect::<Vec<u8>>())?;
    }
    to.flush()
}

/// A 16-bit grey picture of the web, lighter where there is less; the file reports the basis weight of black and white.
fn picture(map: &Map) -> Result<Vec<u8>, String> {
    let most = map.cells.iter().copied().max().unwrap_or(0).max(1);
    let level = |quanta: u32| 65535 - (f64::from(quanta) / f64::from(most) * 65535.0).round() as u16;
    let levels: Vec<u8> = map.cells.iter().flat_map(|quanta| level(*quanta).to_be_bytes()).collect();
    let black = f64::from(most) * map.weight_of_quantum();
    let words = [
        (
            "Description",
            "Basis weight of a web; white is zero, black the value given, linear between".to_owned(),
        ),
        (WEIGHT_OF_BLACK, format!("{black:e}")),
        (CELL, format!("{:e}", map.cell)),
    ];
    let per_metre = (1.0 / map.cell).round() as u32;
    png([map.columns, map.rows], png::BitDepth::Sixteen, &levels, &words, Some(per_metre))
}

/// A web as on a light table: shades of grey.
#[derive(Clone, Debug)]
pub(crate) struct Shades {
    /// Columns and rows of pixels.
    pub(crate) size: [usize; 2],
    /// A row after the other.
    pub(crate) levels: Vec<u8>,
    /// Side of a pixel [m].
    pub(crate) pixel: f64,
    /// Standard deviation of the basis weight over its mean that the shades stand for.
    pub(crate) deviation: f64,
}

impl Shades {
    /// The web in at most so many pixels, in shades that suit it.
    pub(crate) fn new(map: &Map, most: usize) -> Self {
        let each = (map.cells.len() as f64 / most as f64).sqrt().ceil() as usize;
        let each =
            each.max(map.columns.max(map.rows).div_ceil(LONGEST_SIDE)).clamp(1, map.columns.min(map.rows));
        let (size, sums) = map.squares(each);
        let count = sums.len() as f64;
        let mean = sums.iter().map(|sum| *sum as f64).sum::<f64>() / count;
        let variance = sums.iter().map(|sum| (*sum as f64 - mean).powi(2)).sum::<f64>() / count;
        let deviation = variance.sqrt().max(1e-9 * mean).max(f64::MIN_POSITIVE);
        let levels = sums.into_iter().map(|sum| grey((sum as f64 - mean) / deviation)).collect();
        Self { size, levels, pixel: each as f64 * map.cell, deviation: deviation / mean }
    }

    /// A pixel for each cell, in given shades.
    pub(crate) fn of(map: &Map, deviation: f64) -> Self {
        let mean = map.total() as f64 / map.cells.len() as f64;
        let level = |quanta: &u32| grey((f64::from(*quanta) / mean - 1.0) / deviation);
        let levels = map.cells.iter().map(level).collect();
        Self { size: [map.columns, map.rows], levels, pixel: map.cell, deviation }
    }

    pub(crate) fn png(&self) -> Result<Vec<u8>, String> {
        let per_metre = (1.0 / self.pixel).round() as u32;
        png(self.size, png::BitDepth::Eight, &self.levels, &[], Some(per_metre))
    }
}

/// The map as on a light table, a pixel for each cell.
///
/// * `deviation` – standard deviation of the basis weight over its mean that the shades stand for
pub(crate) fn light_table_of(map: &Map, deviation: f64) -> Result<Vec<u8>, String> {
    Shades::of(map, deviation).png()
}

/// The shade of a place so many standard deviations heavier than the mean: three either way are black and white.
fn grey(deviations: f64) -> u8 {
    (128.0 - 42.0 * deviations).round().clamp(0.0, 255.0) as u8
}

/// A picture of 8-bit greys, with what the file says of itself.
pub(crate) fn grey_png(size: [usize; 2], levels: &[u8], words: &[(&str, String)]) -> Result<Vec<u8>, String> {
    png(size, png::BitDepth::Eight, levels, words, None)
}

/// A grey picture.
fn png(
    [width, height]: [usize; 2],
    depth: png::BitDepth,
    levels: &[u8],
    words: &[(&str, String)],
    per_metre: Option<u32>,
) -> Result<Vec<u8>, String> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, height as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::Fast);
    if let Some(density) = per_metre {
        encoder.set_pixel_dims(Some(png::PixelDimensions {
            xppu: density,
            yppu: density,
            unit: png::Unit::Meter,
        }));
    }
    let message = |error: png::EncodingError| error.to_string();
    for (key, text) in words {
        encoder.add_text_chunk((*key).to_owned(), text.clone()).map_err(message)?;
    }
    let mut writer = encoder.write_header().map_err(message)?;
    writer.write_image_data(levels).map_err(message)?;
    writer.finish().map_err(message)?;
    Ok(bytes)
}
