//! The bytes of what pages see of a line: points of filaments that fall, and maps of webs.
//!
//! All is little-endian. A message begins with
//!
//! ```text
//!  0  u32     generation: counts the changes of the knobs
//!  4  u8      kind: 0 points, 1 a map
//!  5  u8      points: number of the layer; a map: 0 of the web of comparison, 1 of the present one
//!  6  u16     points: number of filaments; a map: columns
//! ```
//!
//! and goes on, of points that filaments have laid since the last message,
//!
//! ```text
//!  8  f32     width of the sheet [m]
//! 12  f32     how far the belt has moved [m]; less than in the message before: a new web begins
//! 16  u16     number of points of each filament, then zeros up to a multiple of four bytes
//!     f32     across and along the belt [m] of each point, filament after filament
//! ```
//!
//! or of a map
//!
//! ```text
//!  8  u32     rows
//! 12  f32     side of a pixel [m]
//! 16  f32     mass per area of grey 255 over the mean; zero is grey 0
//! 20  u8      greys, row after row, the first one laid first
//! ```

use crate::board::Picture;
use spunlaid::experiment::advice::LaidStretch;
use spunlaid::web::Map;
use std::collections::VecDeque;
use std::sync::Arc;

/// Most columns and rows of a map.
const MOST_PIXELS: [usize; 2] = [400, 2000];
/// Most messages of points that a page can lag behind.
const STRETCHES: usize = 256;
/// Standard deviations above the mean that grey 255 stands for.
const DEVIATIONS: f64 = 4.0;

/// A map without the head of its message.
#[derive(Debug)]
pub(crate) struct MapBody {
    columns: u16,
    /// Rows, side of a pixel, scale, greys.
    bytes: Vec<u8>,
}

impl MapBody {
    pub(super) fn new(map: &Map) -> Self {
        let [across, along] = MOST_PIXELS;
        let side =
            map.columns.div_ceil(across).max(map.rows.div_ceil(along)).clamp(1, map.columns.min(map.rows));
        let ([columns, rows], sums) = map.squares(side);
        let count = sums.len() as f64;
        let mean = sums.iter().map(|sum| *sum as f64).sum::<f64>() / count;
        let variance = sums.iter().map(|sum| (*sum as f64 / mean - 1.0).powi(2)).sum::<f64>() / count;
        let most = 1.0 + DEVIATIONS * variance.sqrt();
        let mut bytes = (rows as u32).to_le_bytes().to_vec();
        bytes.extend(((side as f64 * map.cell) as f32).to_le_bytes());
        bytes.extend((most as f32).to_le_bytes());
        bytes.extend(sums.iter().map(|sum| (255.0 * *sum as f64 / (mean * most)).round() as u8));
        Self { columns: columns as u16, bytes }
    }

    fn message(&self, generation: u32, which: u8) -> Vec<u8> {
        let mut bytes = head(generation, [1, which], self.columns);
        bytes.extend(&self.bytes);
        bytes
    }
}

fn head(generation: u32, kind: [u8; 2], count: u16) -> Vec<u8> {
    let mut bytes = generation.to_le_bytes().to_vec();
    bytes.extend(kind);
    bytes.extend(count.to_le_bytes());
    bytes
}

/// The message of points that were laid.
fn points(generation: u32, stretch: &LaidStretch) -> Vec<u8> {
    let filaments = &stretch.filaments[..stretch.filaments.len().min(usize::from(u16::MAX))];
    let mut bytes = head(generation, [0, stretch.layer as u8], filaments.len() as u16);
    bytes.extend([stretch.width, stretch.belt].iter().flat_map(|length| (*length as f32).to_le_bytes()));
    let of_each = |filament: &Vec<[f32; 2]>| filament.len().min(usize::from(u16::MAX));
    bytes.extend(filaments.iter().flat_map(|filament| (of_each(filament) as u16).to_le_bytes()));
    bytes.resize(bytes.len().next_multiple_of(4), 0);
    let all = filaments.iter().flat_map(|filament| &filament[..of_each(filament)]).flatten();
    bytes.extend(all.flat_map(|length| length.to_le_bytes()));
    bytes
}

/// What pages see of a line. It is cheap to clone.
#[derive(Clone, Debug, Default)]
pub(crate) struct BeltPicture {
    pub(super) generation: u32,
    /// The maps of the web of comparison and of the present one, with the numbers of the webs.
    pub(super) maps: [Option<(u32, Arc<MapBody>)>; 2],
    /// The last messages of points.
    stretches: VecDeque<Arc<[u8]>>,
    /// How many there were.
    count: u64,
}

impl BeltPicture {
    /// Adds what filaments have laid.
    pub(super) fn add(&mut self, stretch: &LaidStretch) {
        if self.stretches.len() == STRETCHES {
            self.stretches.pop_front();
        }
        self.stretches.push_back(points(self.generation, stretch).into());
        self.count += 1;
    }

    /// Forgets what has fallen: another web begins.
    pub(super) fn clear_belt(&mut self) {
        self.stretches.clear();
    }
}

/// How far a page is.
#[derive(Debug, Default)]
pub(crate) struct Had {
    /// Web of the map of comparison; generation and web of the present one.
    maps: [Option<(u32, u32)>; 2],
    /// Messages of points; none of a page that has just connected, which gets those from now on.
    count: Option<u64>,
}

impl Picture for BeltPicture {
    type Had = Had;

    fn messages(&self, had: &mut Had) -> Vec<Vec<u8>> {
        let mut all = Vec::new();
        for (which, map) in self.maps.iter().enumerate() {
            // A page forgets the map of the present web when a knob is turned.
            let has = map.as_ref().map(|(web, _)| (*web, if which == 0 { 0 } else { self.generation }));
            if let Some((_, map)) = map.as_ref().filter(|_| has != had.maps[which]) {
                all.push(map.message(self.generation, which as u8));
            }
            had.maps[which] = has;
        }
        let missing = (self.count - had.count.unwrap_or(self.count)) as usize;
        let skipped = self.stretches.len().saturating_sub(missing);
        all.extend(self.stretches.iter().skip(skipped).map(|message| message.to_vec()));
        had.count = Some(self.count);
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn map(columns: usize, rows: usize) -> Map {
        let cells = (0..columns * rows).map(|i| if i % columns == 0 { 3000 } else { 1000 }).collect();
        Map { columns, rows, cell: 1e-3, quantum: 1e-9, closed: [false; 2], cells }
    }

    fn f32_at(bytes: &[u8], at: usize) -> f32 {
        f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
    }

    #[test]
    fn a_map_is_laid_out_as_described_and_its_greys_are_its_weights() {
        let message = MapBody::new(&map(4, 3)).message(7, 1);
        assert_eq!(message[..8], [7, 0, 0, 0, 1, 1, 4, 0]);
        assert_eq!((message[8..12].to_vec(), f32_at(&message, 12)), (vec![3, 0, 0, 0], 1e-3));
        // The mean is 1500 quanta, the standard deviation 866.
        let most = f32_at(&message, 16);
        assert!((most - (1.0 + 4.0 * 866.0254 / 1500.0)).abs() < 1e-5, "{most}");
        for (grey, weight) in message[20..].iter().zip([3000.0, 1000.0, 1000.0, 1000.0].iter().cycle()) {
            assert!((f32::from(*grey) / 255.0 * most - weight / 1500.0).abs() < 0.5 * most / 255.0 + 1e-6);
        }
        assert_eq!(message.len(), 20 + 12);
        let large = MapBody::new(&map(1000, 20)).message(0, 0);
        assert_eq!((u16::from_le_bytes([large[6], large[7]]), f32_at(&large, 12)), (333, 3e-3));
    }

    #[test]
    fn points_are_laid_out_as_described() {
        let filaments = vec![vec![[0.1, 0.2], [0.3, 0.4]], vec![], vec![[0.5, 0.6]]];
        let stretch = LaidStretch { layer: 2, width: 0.25, belt: 0.5, filaments };
        let message = points(258, &stretch);
        assert_eq!(message[..8], [2, 1, 0, 0, 0, 2, 3, 0]);
        assert_eq!((f32_at(&message, 8), f32_at(&message, 12)), (0.25, 0.5));
        assert_eq!(message[16..24], [2, 0, 0, 0, 1, 0, 0, 0]);
        let all: Vec<f32> = (24..message.len()).step_by(4).map(|at| f32_at(&message, at)).collect();
        assert_eq!(all, [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]);
    }

    #[test]
    fn a_page_gets_the_last_maps_and_points_from_then_on() {
        let mut picture = BeltPicture::default();
        let stretch = LaidStretch { width: 1.0, ..LaidStretch::default() };
        picture.add(&stretch);
        let body = Arc::new(MapBody::new(&map(4, 3)));
        picture.maps = [Some((1, Arc::clone(&body))), Some((2, body))];
        let kinds = |picture: &BeltPicture, had: &mut Had| -> Vec<[u8; 2]> {
            picture.messages(had).iter().map(|bytes| [bytes[4], bytes[5]]).collect()
        };
        let (mut had, mut other) = (Had::default(), Had::default());
        assert_eq!(kinds(&picture, &mut had), [[1, 0], [1, 1]]);
        picture.add(&stretch);
        assert_eq!(kinds(&picture, &mut had), [[0, 0]]);
        assert_eq!(kinds(&picture, &mut had), [[0; 2]; 0]);
        // A new generation of the same webs, as after going back: the page has forgotten the present one.
        picture.generation = 1;
        assert_eq!(kinds(&picture, &mut had), [[1, 1]]);
        // One that lags far behind gets what is left.
        kinds(&picture, &mut other);
        (0..2 * STRETCHES).for_each(|_| picture.add(&stretch));
        assert_eq!(kinds(&picture, &mut other).len(), STRETCHES);
    }
}
