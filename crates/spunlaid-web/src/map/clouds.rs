//! The clouds of a web: how the variance of its basis weight divides among their sizes.

use super::basis_weight::Map;
use super::uniformity::DEGREES;
use super::waves::{Parts, Places, Powers};
use spunlaid_ground::Estimate;
use spunlaid_ground::threads::par_map;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::Arc;

/// The power spectrum of the basis weight over its mean.
///
/// The variance of the relative basis weight is a sum over waves. The size of a cloud is the length of its
/// wave; in two dimensions, the length across the crests. Long waves are those of the whole sheet, so that
/// streaks, which are longer still, do not pass for clouds; where the sheet is not closed, a Hann window
/// stands over it. Short waves are those of square tiles with a Hann window.
#[derive(Clone, Debug)]
pub struct Clouds {
    /// Side of a tile [cells], a power of two.
    side: usize,
    cell: f64,
    /// Variance of each tile by wave number, any direction; entry r holds waves from `side/(r + 1)` to `side/r` cells.
    tiles: Vec<Vec<f64>>,
    /// Of each tile that has any, its row and column among the tiles, and the part of the variance of short waves whose
    /// crests lie along the machine direction.
    along: Vec<([usize; 2], f64)>,
    /// Mean variance by wave number in cross and in machine direction, one-sided.
    directions: [Vec<f64>; 2],
    /// The waves of the whole sheet, and the shortest of them that counts [m].
    sheet: Sheet,
    from: f64,
    /// Longest wave that is reported of [m].
    longest: f64,
    /// Errors of the variance in some bands of wavelength, as a part of it.
    filling: Vec<BandError>,
    /// Error of every variance by that of the mean basis weight, as a part of it; None if nothing says how far off the
    /// variances of the map are.
    of_weight: Option<f64>,
}

/// From the shortest to the longest wave of a band [m], and how far its variance may be off, as a part of it.
pub(crate) type BandError = ([f64; 2], f64);

/// The waves of a tile.
struct Tile {
    powers: Powers,
    /// As an entry of [`Clouds::tiles`] and of [`Clouds::along`].
    radial: Vec<f64>,
    along: Option<f64>,
}

impl Tile {
    /// * `is_flat` – whether all of its cells are equal, so that its waves are those of the window and of rounding
    fn from_powers(powers: Powers, side: usize, is_flat: bool) -> Self {
        let mut radial = vec![0.0; side];
        let (mut short, mut along) = (0.0, 0.0);
        for (j, i) in powers.numbers().chain([(0, 0)]) {
            let variance = powers.at(j, i);
            let (md, cd) = (i.unsigned_abs() as usize, j.unsigned_abs() as usize);
            let squared = (md * md + cd * cd) as f64;
            radial[(squared.sqrt() as usize).min(side - 1)] += variance;
            // Waves of four to sixteen cells show the directions of fibres; shorter ones those of the lattice.
            let waves = squared.sqrt() / side as f64;
            if (1.0 / 16.0..0.25).contains(&waves) {
                short += variance;
                along += variance * (cd * cd) as f64 / squared;
            }
        }
        Self { powers, radial, along: (!is_flat && short > 0.0).then(|| along / short) }
    }
}

/// The waves of a whole sheet.
#[derive(Clone, Debug)]
struct Sheet {
    powers: Arc<Powers>,
    /// Sides of the sheet [m].
    sides: [f64; 2],
    /// Cells and parts either way.
    counts: [[usize; 2]; 2],
    open: [bool; 2],
    places: Places,
}

/// Largest side of a tile [cells], and the number of tiles along the shorter side of a sheet that is wanted.
const LARGEST: usize = 512;
const WANTED: usize = 4;
/// Smallest side of a tile [cells].
const SMALLEST: usize = 16;
/// Most tiles that are looked at.
const MOST: usize = 256;
/// Most parts of a sheet across, and in all, of which the long waves are made; a power of two.
const ACROSS: usize = 1024;
const PARTS: usize = 1 << 21;
/// Rows of cells whose parts are summed up at once, so that they take little memory.
const AT_ONCE: usize = 512;
/// Shortest long wave [parts]: where parts cut across cells, 0.1 % of the power of such a wave comes from
/// other waves of the lattice, and more of shorter ones.
const SHORT: f64 = 6.0;
/// The longest wave over the shorter side of the sheet.
const LONG: f64 = 0.25;
/// Mean square of a Hann window.
const SQUARE: f64 = 0.375;

fn hann(at: usize, length: usize) -> f64 {
    libm::sin(PI * (at as f64 + 0.5) / length as f64).powi(2) / SQUARE.sqrt()
}

impl Clouds {
    /// [`Clouds::at`] of filaments at places of which nothing is known.
    pub fn measure(map: &Map) -> Option<Self> {
        Self::at(map, &Places::Unknown, 1)
    }

    /// The spectrum of a map. None if it is smaller than 16 cells either way, or holds nothing.
    ///
    /// * `places` – what is known of the places of the filaments
    /// * `threads` – that find it; they do not change it
    pub fn at(map: &Map, places: &Places, threads: usize) -> Option<Self> {
        let shorter = map.columns.min(map.rows);
        let side = (shorter / WANTED + 1).next_power_of_two() / 2;
        let side = side.clamp(SMALLEST, LARGEST);
        let total = map.total();
        if shorter < SMALLEST || total == 0 {
            return None;
        }
        let mean = total as f64 / map.cells.len() as f64;
        let [across, along] = [map.columns / side, map.rows / side];
        let stride = (across * along).div_ceil(MOST);
        let (sheet, shortest) = Sheet::measure(map, mean, places, threads);
        // The border of a ring of the tiles, so that none is missing and none counts twice.
        let tile = side as f64 * map.cell;
        let from = tile / (tile / shortest).floor().max(1.0);
        let mut clouds = Self {
            side,
            cell: map.cell,
            tiles: Vec::new(),
            along: Vec::new(),
            directions: [vec![0.0; side / 2 + 1], vec![0.0; side / 2 + 1]],
            sheet,
            from,
            longest: LONG * shorter as f64 * map.cell,
            filling: Vec::new(),
            of_weight: Some(0.0),
        };
        let window: Vec<f64> = (0..side).map(|i| hann(i, side)).collect();
        let tiles: Vec<usize> = (0..across * along).step_by(stride).collect();
        let tile = |tile: usize| {
            let (row, column) = (tile / across * side, tile % across * side);
            let value = |i: usize, j: usize| {
                (f64::from(map.row(row + i)[column + j]) / mean - 1.0) * window[i] * window[j]
            };
            let cells = || (row..row + side).flat_map(|row| &map.row(row)[column..column + side]);
            let is_flat = cells().all(|cell| *cell == map.row(row)[column]);
            Tile::from_powers(Powers::new(side, side, 1, value), side, is_flat)
        };
        // As many at a time as there are threads, because a tile takes megabytes.
        for some in tiles.chunks(threads.max(1)) {
            for (number, tile) in some.iter().zip(par_map(threads, some.len(), |i| tile(some[i]))) {
                clouds.add([number / across, number % across], tile);
            }
        }
        let count = clouds.tiles.len() as f64;
        clouds.directions.iter_mut().flatten().for_each(|part| *part /= count);
        Some(clouds)
    }

    fn add(&mut self, place: [usize; 2], tile: Tile) {
        for (j, i) in tile.powers.numbers().chain([(0, 0)]) {
            let variance = tile.powers.at(j, i);
            self.directions[0][j.unsigned_abs() as usize] += variance;
            self.directions[1][i.unsigned_abs() as usize] += variance;
        }
        self.tiles.push(tile.radial);
        self.along.extend(tile.along.map(|along| (place, along)));
    }

    /// Longest wave that is reported of: a quarter of the sheet's shorter side [m].
    pub fn longest(&self) -> f64 {
        self.longest
    }

    /// Shortest wave of the lattice [m].
    pub fn shortest(&self) -> f64 {
        2.0 * self.cell
    }

    /// Variance of the relative basis weight in waves from one length to another, with its standard error
    /// over webs of the kind. There is no error where the sheet is too small to say. Waves longer than a side
    /// of the sheet have no part.
    pub fn variance(&self, shortest: f64, longest: f64) -> Estimate {
        let within = |r: usize| {
            let wave = self.side as f64 * self.cell / (r as f64 + 0.5);
            r > 0 && (shortest..longest.min(self.from)).contains(&wave)
        };
        let of_tile = |tile: &Vec<f64>| (0..tile.len()).filter(|r| within(*r)).map(|r| tile[r]).sum();
        let short = Estimate::new(self.tiles.iter().map(of_tile).collect());
        let long = self.sheet.parts(shortest.max(self.from), longest);
        let mean = short.mean + long.sum();
        let of_long = long.share(self.sheet.open) * long.sum().powi(2);
        let variance = short.standard_error.unwrap_or(0.0).powi(2) + of_long;
        let known =
            (short.mean == 0.0 || short.standard_error.is_some()) && 2.0 * mean * mean >= DEGREES * variance;
        let of_filling = self.error_of_filling(shortest, longest);
        let error = |of_weight: f64| variance.sqrt().hypot(mean * of_filling.hypot(of_weight));
        Estimate { mean, standard_error: self.of_weight.filter(|_| known).map(error), values: Vec::new() }
    }

    /// With what filling filaments in may have done to bands of wavelength.
    pub(crate) fn with_filling(self, filling: Vec<BandError>) -> Self {
        Self { filling, ..self }
    }

    /// With the error of the mean basis weight, as a fraction of it. Independent filaments that are one per cent more
    /// have one per cent less variance over the square of their mean. None if nothing says how far off the variances
    /// are, as where too few filaments were simulated.                                          theory.md (103b)
    pub(crate) fn with_error_of_weight(self, of_weight: Option<f64>) -> Self {
        Self { of_weight, ..self }
    }

    /// Of the bands within these waves, as they share the range in octaves.
    fn error_of_filling(&self, shortest: f64, longest: f64) -> f64 {
        let common = |([from, to], error): &BandError| {
            (libm::log(to.min(longest) / from.max(shortest)).max(0.0), error * error)
        };
        let (octaves, squares) = (self.filling.iter().map(common))
            .fold((0.0, 0.0), |(all, squares), (octaves, square)| {
                (all + octaves, squares + octaves * square)
            });
        if octaves > 0.0 { (squares / octaves).sqrt() } else { 0.0 }
    }

    /// How far another map of the same sheet is off, octave by octave.
    pub(crate) fn apart(&self, other: &Self) -> Vec<BandError> {
        let both = self.octaves().into_iter().zip(other.octaves());
        both.map(|(own, other)| (own.0, (other.1.mean / own.1.mean - 1.0).abs())).collect()
    }

    /// The variance in octaves of wavelength from the shortest wave to the longest: shortest and longest wave
    /// [m], and the variance.
    pub fn octaves(&self) -> Vec<([f64; 2], Estimate)> {
        let mut octaves = Vec::new();
        let mut from = self.shortest();
        while 2.0 * from <= self.longest() * 1.0001 {
            octaves.push(([from, 2.0 * from], self.variance(from, 2.0 * from)));
            from *= 2.0;
        }
        octaves
    }

    /// The cloudiness index: the standard deviation of the relative basis weight in waves from one length to
    /// another, with its standard error. No error where the sheet is too small to say.
    ///
    /// Source: An unambiguous cloudiness index for nonwovens, Journal of Mathematics in Industry 12 (2022),
    /// doi 10.1186/s13362-022-00124-z: the power spectrum of the relative basis weight, integrated over a band.
    pub fn cloudiness(&self, shortest: f64, longest: f64) -> (f64, Option<f64>) {
        let variance = self.variance(shortest, longest);
        let index = variance.mean.sqrt();
        (index, variance.standard_error.map(|error| error / (2.0 * index)))
    }

    /// One-sided density of the relative variance by wave number along the cross (0) or the machine direction
    /// (1): wavelength [m] and density [m], from long waves to short.
    pub fn spectrum(&self, direction: usize) -> Vec<(f64, f64)> {
        let length = self.side as f64 * self.cell;
        let parts = self.directions[direction].iter().enumerate().skip(1);
        parts.map(|(k, part)| (length / k as f64, part * length)).collect()
    }

    /// Share of the texture that lies along the machine direction: `⟨cos²⟩` of the crests of waves of four to
    /// sixteen cells, ½ without orientation. It is NaN where no part of the sheet has such waves.
    ///
    /// Streaks are longer than a tile, so that the tiles of a column, or of a row, may be alike: the error is the
    /// largest of those that tiles, columns and rows of tiles have among themselves.
    pub fn texture_md(&self) -> Estimate {
        let tiles = Estimate::new(self.along.iter().map(|(_, along)| *along).collect());
        let error_of_lines = |direction: usize| {
            let mut lines: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
            for (place, along) in &self.along {
                let (sum, count) = lines.entry(place[direction]).or_default();
                (*sum, *count) = (*sum + along, *count + 1.0);
            }
            Estimate::new(lines.into_values().map(|(sum, count)| sum / count).collect()).standard_error
        };
        let errors = [tiles.standard_error, error_of_lines(0), error_of_lines(1)];
        let standard_error = errors.into_iter().flatten().reduce(f64::max);
        Estimate { standard_error, ..tiles }
    }
}

impl Sheet {
    /// The waves of a sheet, and the shortest of them that counts [m].
    fn measure(map: &Map, mean: f64, places: &Places, threads: usize) -> (Self, f64) {
        let columns = map.columns.next_power_of_two().min(ACROSS);
        let rows = map.rows.next_power_of_two().min(PARTS / columns);
        let across = Split::new(map.columns, columns);
        let along = Split::new(map.rows, rows);
        // A part gets of each cell what lies in it.
        let mut sums = vec![0.0; columns * rows];
        let of_row = |row: usize| {
            let mut row_sums = vec![0.0; columns];
            for (column, quanta) in map.row(row).iter().enumerate() {
                across.give(column, f64::from(*quanta), |part, share| row_sums[part] += share);
            }
            row_sums
        };
        for first in (0..map.rows).step_by(AT_ONCE) {
            let rows_sums = par_map(threads, AT_ONCE.min(map.rows - first), |i| of_row(first + i));
            for (row, row_sums) in (first..).zip(rows_sums) {
                along.give(row, 1.0, |part, share| {
                    let into = &mut sums[part * columns..][..columns];
                    into.iter_mut().zip(&row_sums).for_each(|(into, sum)| *into += share * sum);
                });
            }
        }
        let of_part = mean * map.cells.len() as f64 / (columns * rows) as f64;
        let open = map.closed.map(|closed| !closed);
        let window = |open: bool, at: usize, length: usize| if open { hann(at, length) } else { 1.0 };
        let across: Vec<f64> = (0..columns).map(|column| window(open[0], column, columns)).collect();
        let powers = Powers::new(columns, rows, threads, |row, column| {
            (sums[row * columns + column] / of_part - 1.0) * across[column] * window(open[1], row, rows)
        });
        let sides = [map.columns, map.rows].map(|cells| cells as f64 * map.cell);
        let from = SHORT * (sides[0] / columns as f64).max(sides[1] / rows as f64);
        let counts = [[map.columns, columns], [map.rows, rows]];
        (Self { powers: Arc::new(powers), sides, counts, open, places: places.clone() }, from)
    }

    /// What the means over cells and over other parts have taken of the power of a wave number.
    fn gain(&self, direction: usize, number: i64) -> f64 {
        let lost = |count: f64| {
            let angle = PI * number as f64 / count;
            if number == 0 { 1.0 } else { (libm::sin(angle) / angle).powi(2) }
        };
        let [cells, parts] = self.counts[direction].map(|count| count as f64);
        if cells == parts { 1.0 } else { 1.0 / (lost(cells) * lost(parts)) }
    }

    /// The waves from one length to another.
    fn parts(&self, shortest: f64, longest: f64) -> Parts {
        let mut parts = Parts::default();
        if shortest >= longest {
            return parts;
        }
        let reach = i64::from(self.open[1]);
        let most = self.sides.map(|side| (side / shortest).ceil() as i64);
        for along in -most[1]..=most[1] {
            for across in -most[0]..=most[0] {
                let number = (across as f64 / self.sides[0]).hypot(along as f64 / self.sides[1]);
                if (shortest..longest).contains(&(1.0 / number)) {
                    let gain = self.gain(0, across) * self.gain(1, along);
                    self.powers.add((across, along), &self.places, reach, gain, &mut parts);
                }
            }
        }
        parts
    }
}

/// How cells are shared among parts of equal length.
struct Split {
    cells: usize,
    parts: usize,
}

impl Split {
    const fn new(cells: usize, parts: usize) -> Self {
        Self { cells, parts }
    }

    /// Passes on the parts in which a cell lies, and what each gets of a value.
    fn give(&self, cell: usize, value: f64, mut take: impl FnMut(usize, f64)) {
        // In units of one over both numbers.
        let (mut begin, end) = (cell * self.parts, (cell + 1) * self.parts);
        while begin < end {
            let part = begin / self.cells;
            let next = end.min((part + 1) * self.cells);
            take(part, value * (next - begin) as f64 / self.parts as f64);
            begin = next;
        }
    }
}

#[cfg(test)]
mod tests;
