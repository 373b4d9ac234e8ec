//! The clouds of a web: how the variance of its basis weight divides among their sizes.

use super::map::Map;
use crate::fft::{Complex, InverseTransform};
use crate::lanes::{Lanes, WIDTH};
use crate::statistics::Estimate;
use std::f64::consts::PI;

/// The power spectrum of the basis weight over its mean, from square tiles of the sheet with a Hann window.
///
/// The variance of the relative basis weight is a sum over waves. The size of a cloud is the length of its wave; in two dimensions, the
/// length across the crests.
#[derive(Clone, Debug)]
pub struct Clouds {
    /// Side of a tile [cells], a power of two.
    side: usize,
    cell: f64,
    /// Variance of each tile by wave number, any direction; entry r holds waves from `side/(r + 1)` to `side/r` cells.
    tiles: Vec<Vec<f64>>,
    /// Of each tile, the part of the variance of short waves whose crests lie along the machine direction.
    along: Vec<f64>,
    /// Mean variance by wave number in cross and in machine direction, one-sided.
    directions: [Vec<f64>; 2],
}

/// Largest side of a tile [cells], and the number of tiles along the shorter side of a sheet that is wanted.
const LARGEST: usize = 512;
const WANTED: usize = 4;
/// Smallest side of a tile [cells].
const SMALLEST: usize = 16;
/// Most tiles that are looked at.
const MOST: usize = 256;

impl Clouds {
    /// The spectrum of a map. None if it is smaller than 16 cells either way, or holds nothing.
    pub fn of(map: &Map) -> Option<Self> {
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
        let mut clouds = Self {
            side,
            cell: map.cell,
            tiles: Vec::new(),
            along: Vec::new(),
            directions: [vec![0.0; side / 2 + 1], vec![0.0; side / 2 + 1]],
        };
        let transform = Transform::new(side);
        for tile in (0..across * along).step_by(stride) {
            let (row, column) = (tile / across * side, tile % across * side);
            clouds.add(&transform.variances(|i, j| f64::from(map.row(row + i)[column + j]) / mean - 1.0));
        }
        let count = clouds.tiles.len() as f64;
        clouds.directions.iter_mut().flatten().for_each(|part| *part /= count);
        Some(clouds)
    }

    fn add(&mut self, variances: &[f64]) {
        let side = self.side;
        // Wave numbers beyond half the side are negative ones.
        let number = |of: usize| of.min(side - of);
        let mut radial = vec![0.0; side];
        let (mut short, mut along) = (0.0, 0.0);
        for (i, row) in variances.chunks_exact(side).enumerate() {
            for (j, variance) in row.iter().enumerate() {
                let (md, cd) = (number(i), number(j));
                let squared = (md * md + cd * cd) as f64;
                radial[(squared.sqrt() as usize).min(side - 1)] += variance;
                self.directions[0][cd] += variance;
                self.directions[1][md] += variance;
                // Waves of four to sixteen cells show the directions of fibres; shorter ones those of the lattice.
                let waves = squared.sqrt() / side as f64;
                if (1.0 / 16.0..0.25).contains(&waves) {
                    short += variance;
                    along += variance * (cd * cd) as f64 / squared;
                }
            }
        }
        self.tiles.push(radial);
        self.along.push(along / short);
    }

    /// Longest wave that can be told from the mean [m].
    pub fn longest(&self) -> f64 {
        0.5 * self.side as f64 * self.cell
    }

    /// Shortest wave of the lattice [m].
    pub fn shortest(&self) -> f64 {
        2.0 * self.cell
    }

    /// Variance of the relative basis weight in waves from one length to another, over the tiles.
    pub fn variance(&self, shortest: f64, longest: f64) -> Estimate {
        let within = |r: usize| {
            let wave = self.side as f64 * self.cell / (r as f64 + 0.5);
            r > 0 && (shortest..longest).contains(&wave)
        };
        let of_tile = |tile: &Vec<f64>| (0..tile.len()).filter(|r| within(*r)).map(|r| tile[r]).sum();
        Estimate::of(self.tiles.iter().map(of_tile).collect())
    }

    /// The variance in octaves of wavelength from the shortest wave to the longest: shortest and longest wave [m], and the variance.
    pub fn octaves(&self) -> Vec<([f64; 2], Estimate)> {
        let mut octaves = Vec::new();
        let mut from = self.shortest();
        while 2.0 * from <= self.longest() * 1.0001 {
            octaves.push(([from, 2.0 * from], self.variance(from, 2.0 * from)));
            from *= 2.0;
        }
        octaves
    }

    /// The cloudiness index: the standard deviation of the relative basis weight in waves from one length to another, with its
    /// standard error. None without tiles enough for an error.
    ///
    /// Source: An unambiguous cloudiness index for nonwovens, Journal of Mathematics in Industry 12 (2022),
    /// doi 10.1186/s13362-022-00124-z: the power spectrum of the relative basis weight, integrated over a band.
    pub fn cloudiness(&self, shortest: f64, longest: f64) -> (f64, Option<f64>) {
        let variance = self.variance(shortest, longest);
        let index = variance.mean.sqrt();
        (index, variance.standard_error.map(|error| error / (2.0 * index)))
    }

    /// One-sided density of the relative variance by wave number along the cross (0) or the machine direction (1): wavelength [m]
    /// and density [m], from long waves to short.
    pub fn spectrum(&self, direction: usize) -> Vec<(f64, f64)> {
        let length = self.side as f64 * self.cell;
        let parts = self.directions[direction].iter().enumerate().skip(1);
        parts.map(|(k, part)| (length / k as f64, part * length)).collect()
    }

    /// Share of the texture that lies along the machine direction: `⟨cos²⟩` of the crests of waves of four to sixteen cells, ½
    /// without orientation.
    pub fn texture_md(&self) -> Estimate {
        Estimate::of(self.along.clone())
    }
}

/// Fourier transform of a tile.
struct Transform {
    side: usize,
    along: InverseTransform,
    window: Vec<f64>,
}

impl Transform {
    fn new(side: usize) -> Self {
        let hann = |i: usize| libm::sin(PI * (i as f64 + 0.5) / side as f64).powi(2);
        // The mean square of the window is ⅜.
        let window = (0..side).map(|i| hann(i) / 0.375f64.sqrt()).collect();
        Self { side, along: InverseTransform::new(side), window }
    }

    /// The part of the variance in each wave, by wave numbers in machine and in cross direction.
    fn variances(&self, deviation: impl Fn(usize, usize) -> f64) -> Vec<f64> {
        let side = self.side;
        let groups = side / WIDTH;
        // Eight rows at a time, then eight columns.
        let rows: Vec<Vec<Complex>> = (0..groups)
            .map(|group| {
                let value = |lane: usize, j: usize| {
                    let i = group * WIDTH + lane;
                    deviation(i, j) * self.window[i] * self.window[j]
                };
                let column =
                    |j: usize| Complex { re: Lanes::from_fn(|lane| value(lane, j)), im: Lanes::ZERO };
                let mut data: Vec<Complex> = (0..side).map(column).collect();
                self.along.run(&mut data);
                data
            })
            .collect();
        let scale = 1.0 / (side as f64).powi(4);
        let mut variances = vec![0.0; side * side];
        for group in 0..groups {
            let row = |i: usize| {
                let part = |of: fn(&Complex) -> &Lanes| {
                    Lanes::from_fn(|lane| of(&rows[i / WIDTH][group * WIDTH + lane]).0[i % WIDTH])
                };
                Complex { re: part(|z| &z.re), im: part(|z| &z.im) }
            };
            let mut data: Vec<Complex> = (0..side).map(row).collect();
            self.along.run(&mut data);
            for (i, z) in data.iter().enumerate() {
                for lane in 0..WIDTH {
                    let squared = z.re.0[lane] * z.re.0[lane] + z.im.0[lane] * z.im.0[lane];
                    variances[i * side + group * WIDTH + lane] = squared * scale;
                }
            }
        }
        variances
    }
}

/// Autocorrelation coefficients of the basis weight in cross and in machine direction, from lag zero, cell by cell.
///
/// * `lags` – number of lags, lag zero included; fewer are given where the sheet is shorter
pub fn autocorrelation(map: &Map, lags: usize) -> [Vec<f64>; 2] {
    let mean = map.total() as f64 / map.cells.len() as f64;
    // About a million products for each lag say enough.
    let stride = (map.cells.len() >> 20).max(1);
    let product = |lag: usize, step: [usize; 2]| {
        let last = [map.columns - lag * step[0], map.rows - lag * step[1]];
        let (mut sum, mut count) = (0.0, 0u64);
        for row in (0..last[1]).step_by(stride) {
            let (one, other) = (map.row(row), map.row(row + lag * step[1]));
            sum += product_of_rows(&one[..last[0]], &other[lag * step[0]..][..last[0]], mean);
            count += last[0] as u64;
        }
        sum / count as f64
    };
    [([1, 0], map.columns), ([0, 1], map.rows)].map(|(step, size)| {
        let products: Vec<f64> = (0..lags.min(size)).map(|lag| product(lag, step)).collect();
        let variance = products.first().copied().unwrap_or(f64::NAN);
        products.iter().map(|product| product / variance).collect()
    })
}

/// `Σ (a − mean)(b − mean)` of two rows that are equally long.
fn product_of_rows(a: &[u32], b: &[u32], mean: f64) -> f64 {
    let product = |a: u32, b: u32| (f64::from(a) - mean) * (f64::from(b) - mean);
    let ((a, rest_a), (b, rest_b)) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    // Eight sums, so that none waits for the product before.
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for (sum, (a, b)) in sums.iter_mut().zip(a.iter().zip(b)) {
            *sum += product(*a, *b);
        }
    }
    let rest: f64 = rest_a.iter().zip(rest_b).map(|(a, b)| product(*a, *b)).sum();
    sums.iter().sum::<f64>() + rest
}
