//! Webs rendered as scans, pictures for the tests, and the files of them.
#![allow(dead_code, clippy::unwrap_used, clippy::expect_used)]

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use spunlaid_ground::{Isa, RunContext};
use spunlaid_web::map::{Filaments, lay};
use spunlaid_web::{Fibres, Layer, Map, Row, Sheet, Surrogate, Web};
use std::f64::consts::PI;
use std::io::Cursor;
use std::sync::atomic::{AtomicBool, AtomicU64};
use tiff::encoder::colortype::{ColorType, Gray8, Gray16, Gray32Float};
use tiff::encoder::{Rational, TiffEncoder, TiffValue};
use tiff::tags::{ResolutionUnit, Tag};

/// Side of a cell of the web and of a pixel of its scan [m].
pub const PIXEL: f64 = 0.5e-3;
/// Mean optical density of the web.
pub const DENSITY: f64 = 0.3;

/// A spunbond web of about 19 g/m² that goes on at its edges.
///
/// * `sides` – across and along [m]
/// * `sigma` – spread of its filaments [m]
/// * `filaments` – per width [1/m], at random places or in one row
pub fn web(sides: [f64; 2], cell: f64, sigma: f64, filaments: f64, in_rows: bool, seed: u64) -> Map {
    let fibres =
        Fibres::Surrogate(Surrogate { sigma_md: sigma, sigma_cd: sigma, noise: 1.68 / sigma.sqrt() });
    let [width, length] = sides;
    let row = Row::new(0.0, 1.0 / filaments, (filaments * width).round() as u64);
    let layer = Layer {
        // 19 g/m² from whatever number of filaments.
        linear_density: 910.0 * PI * 18e-6 * 18e-6 / 4.0 * 5000.0 / filaments,
        feed_speed: 50.0,
        belt_speed: 3.0,
        filaments: if in_rows {
            Filaments::Rows(vec![row])
        } else {
            Filaments::AtRandom { per_metre: filaments }
        },
        fibres,
        defects: Vec::new(),
    };
    let sheet = Sheet::new(width, length, cell);
    let web = Web { sheet, layers: vec![layer], seed };
    let (stop, pieces) = (AtomicBool::new(false), AtomicU64::new(0));
    lay(&web, RunContext { threads: 2, isa: Isa::detect(), stop: &stop, done: &pieces })
        .expect("a web that can be laid")
        .map
}

/// A piece that is cut out of a web, as a scan is.
pub fn piece(map: &Map, [left, top]: [usize; 2], [columns, rows]: [usize; 2]) -> Map {
    let cells = (top..top + rows).flat_map(|row| map.row(row)[left..left + columns].to_vec()).collect();
    Map { columns, rows, closed: [false; 2], cells, ..map.clone() }
}

/// Light that comes through each cell, of a lamp of strength one.
pub fn light(map: &Map) -> Vec<f64> {
    let mean = map.total() as f64 / map.cells.len() as f64;
    map.cells.iter().map(|quanta| (-DENSITY * f64::from(*quanta) / mean).exp()).collect()
}

/// The lamp at a place, from −1 to 1 both ways.
pub type Lamp = fn(f64, f64) -> f64;

/// An even lamp behind a lens: light falls with the fourth power of the cosine towards the corners. From 0.85 to 1.15.
pub fn lens(u: f64, v: f64) -> f64 {
    let tangent = 0.075 * ((u - 0.1).powi(2) + (v + 0.15).powi(2));
    1.15 * (1.0 + 0.02 * u) / (1.0 + tangent).powi(2)
}

/// A lamp with a dark side and a bright spot, which no polynomial of second order follows. From 0.85 to 1.15.
pub fn spotted(u: f64, v: f64) -> f64 {
    0.88 + 0.23 * (1.3 * (u - 0.2)).cos() * (1.1 * (v + 0.1)).cos() + 0.04 * (3.0 * u).sin()
}

/// A blur by a Gaussian with a standard deviation of one pixel.
pub fn blurred(light: &[f64], columns: usize) -> Vec<f64> {
    let weights: Vec<f64> = (-4..=4).map(|i: i32| (-0.5 * f64::from(i * i)).exp()).collect();
    let whole: f64 = weights.iter().sum();
    let rows = light.len() / columns;
    let along = |light: &[f64], [right, down]: [i64; 2]| -> Vec<f64> {
        let at = |i: usize| {
            let parts = weights.iter().zip(-4i64..).map(|(weight, by)| {
                let column = ((i % columns) as i64 + by * right).clamp(0, columns as i64 - 1) as usize;
                let row = ((i / columns) as i64 + by * down).clamp(0, rows as i64 - 1) as usize;
                weight * light[row * columns + column]
            });
            parts.sum::<f64>() / whole
        };
        (0..light.len()).map(at).collect()
    };
    along(&along(light, [1, 0]), [0, 1])
}

/// What a camera makes of light: a lamp, blur, the noise of 10,000 electrons at the largest level, whole levels.
pub fn exposed(
    [columns, rows]: [usize; 2],
    light: &[f64],
    lamp: Lamp,
    full_scale: f64,
    seed: u64,
) -> Vec<u16> {
    // ChaCha would be a fifth of what the tests of scans take.
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut uniform = || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let light = blurred(light, columns);
    let place = |pixel: usize, side: usize| 2.0 * pixel as f64 / side as f64 - 1.0;
    let level = |(i, light): (usize, &f64)| {
        let electrons = 8000.0 * light * lamp(place(i % columns, columns), place(i / columns, rows));
        // The sum of twelve is near enough to a normal number.
        let normal = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
        let seen = electrons + electrons.sqrt() * normal;
        (seen / 1e4 * full_scale).round().clamp(0.0, full_scale) as u16
    };
    light.iter().enumerate().map(level).collect()
}

/// The file of a scan: PNG for 8 bits, TIFF for 16.
pub fn file(columns: usize, levels: &[u16], bits: u32) -> Vec<u8> {
    match bits {
        8 => png8(columns, &levels.iter().map(|level| *level as u8).collect::<Vec<_>>()),
        _ => tiff16(columns, levels),
    }
}

/// Pixels that are bare lamp, blots of 4 mm radius, and dust.
pub fn beside(kind: &str, [columns, rows]: [usize; 2]) -> Vec<bool> {
    let mut random = ChaCha8Rng::seed_from_u64(5);
    let mut whole = |below: usize| (random.next_u64() % below as u64) as usize;
    let spots: Vec<([usize; 2], usize)> = match kind {
        "blots" => vec![([150, 200], 8), ([420, 90], 8), ([333, 640], 8)],
        "dust" => (0..60).map(|_| ([whole(columns), whole(rows)], 1)).collect(),
        _ => Vec::new(),
    };
    let is_aside = |at: usize| {
        let (x, y) = (at % columns, at / columns);
        // Turned by one and a half degrees.
        let skewed = 0.026 * y as f64;
        let edge =
            kind == "edges" && ((x as f64) < 4.0 + skewed || x as f64 > columns as f64 - 26.0 + skewed);
        edge || spots
            .iter()
            .any(|([i, j], radius)| x.abs_diff(*i).pow(2) + y.abs_diff(*j).pow(2) <= radius * radius + 1)
    };
    (0..columns * rows).map(is_aside).collect()
}

/// The light with what is no web: bare lamp at the edges, or spots that let an eighth of the light through.
pub fn spoiled(kind: &str, light: &[f64], aside: &[bool]) -> Vec<f64> {
    let level = |(light, is): (&f64, &bool)| match (is, kind) {
        (false, _) => *light,
        (true, "edges") => 1.0,
        (true, _) => light / 8.0,
    };
    light.iter().zip(aside).map(level).collect()
}

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

/// A grey PNG of 8 bits that reports how many pixels there are to a metre across and down.
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

/// A grey TIFF of 8 bits that reports its resolution, as a fraction.
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

/// A grey TIFF of 8 bits with a description and a resolution in a unit, if it has one.
pub fn tiff_of_program(
    columns: usize,
    levels: &[u8],
    text: &[u8],
    unit: Option<u16>,
    [n, d]: [u32; 2],
) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut file).unwrap();
    let rows = (levels.len() / columns) as u32;
    let mut image = encoder.new_image::<Gray8>(columns as u32, rows).unwrap();
    let tags = image.encoder();
    tags.write_tag(Tag::ImageDescription, text).unwrap();
    for tag in [Tag::XResolution, Tag::YResolution] {
        tags.write_tag(tag, Rational { n, d }).unwrap();
    }
    if let Some(unit) = unit {
        tags.write_tag(Tag::ResolutionUnit, unit).unwrap();
    }
    image.write_data(levels).unwrap();
    file.into_inner()
}

/// A TIFF of some channels, of which the further ones are reported.
pub fn tiff_of_channels<C: ColorType>(columns: usize, levels: &[C::Inner], extra: &[u16]) -> Vec<u8>
where
    [C::Inner]: TiffValue,
{
    let mut file = Cursor::new(Vec::new());
    let rows = levels.len() / columns / C::BITS_PER_SAMPLE.len();
    let mut encoder = TiffEncoder::new(&mut file).unwrap();
    let mut image = encoder.new_image::<C>(columns as u32, rows as u32).unwrap();
    image.encoder().write_tag(Tag::ExtraSamples, extra).unwrap();
    image.write_data(levels).unwrap();
    file.into_inner()
}

/// Relative weights of a web of waves at random, with a CV of about 13 % and a mean of one.
pub fn waves(columns: usize, rows: usize, seed: u64) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut uniform = || (random.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let waves: Vec<[f64; 3]> = (0..24)
        .map(|_| {
            let (turn, length) = (2.0 * PI * uniform(), 30.0 + 60.0 * uniform());
            [2.0 * PI / length * turn.cos(), 2.0 * PI / length * turn.sin(), 2.0 * PI * uniform()]
        })
        .collect();
    let weight = |at: usize| {
        let place = [(at % columns) as f64, (at / columns) as f64];
        let sum: f64 = waves.iter().map(|[x, y, phase]| (x * place[0] + y * place[1] + phase).cos()).sum();
        1.0 + 0.13 * (2.0 / 24f64).sqrt() * sum
    };
    let weights: Vec<f64> = (0..columns * rows).map(weight).collect();
    let mean = weights.iter().sum::<f64>() / weights.len() as f64;
    weights.iter().map(|weight| weight / mean).collect()
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

/// A page of a TIFF: pixels in a row, levels of 8 or 16 bits, and tags of one number.
pub struct Page<'a> {
    pub columns: usize,
    pub levels: &'a [u16],
    pub bits: u32,
    pub tags: &'a [(Tag, u16)],
}

/// A TIFF of some pages, with pixels of 0.1 mm.
pub fn tiff_of_pages(pages: &[Page<'_>]) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut file).unwrap();
    for page in pages {
        if page.bits == 8 {
            let levels: Vec<u8> = page.levels.iter().map(|level| *level as u8).collect();
            write_page::<Gray8>(&mut encoder, page, &levels);
        } else {
            write_page::<Gray16>(&mut encoder, page, page.levels);
        }
    }
    file.into_inner()
}

fn write_page<C: ColorType>(
    encoder: &mut TiffEncoder<&mut Cursor<Vec<u8>>>,
    page: &Page<'_>,
    levels: &[C::Inner],
) where
    [C::Inner]: TiffValue,
{
    let rows = (levels.len() / page.columns) as u32;
    let mut image = encoder.new_image::<C>(page.columns as u32, rows).unwrap();
    image.resolution(ResolutionUnit::Inch, Rational { n: 254, d: 1 });
    page.tags.iter().for_each(|(tag, value)| image.encoder().write_tag(*tag, *value).unwrap());
    image.write_data(levels).unwrap();
}

/// A PNG with a further chunk in front of its pixels.
pub fn with_chunk(png: &[u8], kind: &[u8; 4], data: &[u8]) -> Vec<u8> {
    let body = [&kind[..], data].concat();
    let [length, checksum] = [data.len() as u32, crc32fast::hash(&body)].map(u32::to_be_bytes);
    // The header ends after the signature and 25 bytes.
    [&png[..33], &length, &body, &checksum, &png[33..]].concat()
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
