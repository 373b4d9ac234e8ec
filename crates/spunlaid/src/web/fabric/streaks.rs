//! Streaks that defects of the line leave in the web, and whether they show.

use crate::ground::{Known, NORMAL_95};
use crate::web::map::Map;
use std::f64::consts::SQRT_2;

/// Width of the band over which a streak is looked for, in standard deviations of the places at which a
/// filament comes down: of a streak of a normal profile it has the largest dip over its standard error.
const BAND: f64 = 2.8;
/// Blocks of the sheet along MD whose scatter tells the chance.
const BLOCKS: usize = 8;
/// Fewest bands without a streak that tell the chance.
const FEWEST: usize = 4;
/// Bands nearer to a defect than so many standard deviations are not taken for the chance.
const NEAR: f64 = 3.0;

/// What is known of a defect before the map is looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct StreakSource {
    /// Where the filaments are fed across the sheet [m], and the mass per length of web that they do not lay [kg/m].
    pub missing: Vec<(f64, f64)>,
    /// Standard deviation of the places at which each comes down [m].
    pub spread: f64,
    /// The place along the sheet up to which it is so [m].
    pub until: f64,
}

/// A streak.
#[derive(Clone, Debug, PartialEq)]
pub struct Streak {
    /// Its middle across the sheet [m].
    pub place: f64,
    /// Number of holes that make it.
    pub holes: usize,
    /// Width of the band over which it is looked for [m].
    pub band: f64,
    /// The place along the sheet up to which it is so [m].
    pub until: f64,
    /// Share by which the band is lighter than the web beside it, from the filaments that are missing; below
    /// zero where it is heavier.
    pub dip: f64,
    /// The same in the map; None if there is too little web beside it.
    pub found: Option<Known>,
    /// Length of web over which the dip is as large as the 95 % bound of chance [m]; None where it never is,
    /// or is not known.
    pub length: Option<Known>,
}

/// Columns of a map and their sums, block by block.
struct Bands<'a> {
    map: &'a Map,
    /// Sums of each block for each column, one after another.
    columns: Vec<Vec<u64>>,
    rows_in_block: usize,
}

impl<'a> Bands<'a> {
    fn new(map: &'a Map) -> Self {
        let rows_in_block = (map.rows / BLOCKS).max(1);
        let block = |number: usize| {
            let mut sums = vec![0u64; map.columns];
            for row in number * rows_in_block..((number + 1) * rows_in_block).min(map.rows) {
                for (sum, cell) in sums.iter_mut().zip(map.row(row)) {
                    *sum += u64::from(*cell);
                }
            }
            sums
        };
        Self { map, columns: (0..BLOCKS).map(block).collect(), rows_in_block }
    }

    /// Weight of a band in each block.
    fn weights(&self, first: usize, width: usize) -> [f64; BLOCKS] {
        let weight = |block: usize| {
            let columns = self.columns.get(block).and_then(|sums| sums.get(first..first + width));
            columns.into_iter().flatten().sum::<u64>() as f64
        };
        std::array::from_fn(weight)
    }
}

/// The chance in the weights of bands, over their mean.
struct Chance {
    /// Variance of the mean of a block, and of what stays the same along the web.
    of_block: f64,
    fixed: f64,
    degrees: f64,
    bands: f64,
}

impl Chance {
    /// Each band has its weight in each block over the mean of all bands in that block. What the bands vary more than
    /// their blocks explain stays the same along the web.                        theory.md (115)
    fn new(bands: &[[f64; BLOCKS]]) -> Self {
        let (count, blocks) = (bands.len() as f64, BLOCKS as f64);
        let mean = |band: &[f64; BLOCKS]| band.iter().sum::<f64>() / blocks;
        let within: f64 = (bands.iter())
            .map(|band| band.iter().map(|weight| (weight - mean(band)).powi(2)).sum::<f64>())
            .sum();
        let degrees = (count - 1.0) * (blocks - 1.0);
        let of_block = within / degrees;
        let between = bands.iter().map(|band| (mean(band) - 1.0).powi(2)).sum::<f64>() / (count - 1.0);
        let by_chance = of_block / blocks;
        // Beyond two standard errors of the ratio of two variances.
        let is_beyond = between > by_chance * (1.0 + 2.0 * (2.0 / (count - 1.0) + 2.0 / degrees).sqrt());
        let fixed = if is_beyond { between - by_chance } else { 0.0 };
        Self { of_block, fixed, degrees, bands: count }
    }

    /// Variance of a band over so many blocks.
    fn over(&self, blocks: f64) -> f64 {
        (self.of_block / blocks + self.fixed) * (1.0 + 1.0 / self.bands)
    }
}

/// The streak of each defect, where its band lies on the map.
///
/// * `corner` – where the map begins across the sheet [m]
pub fn streaks(map: &Map, corner: f64, sources: &[StreakSource]) -> Vec<Streak> {
    if sources.is_empty() || map.total() == 0 || map.rows < BLOCKS {
        return Vec::new();
    }
    let bands = Bands::new(map);
    sources.iter().filter_map(|source| streak(&bands, corner, source, sources)).collect()
}

fn streak(bands: &Bands<'_>, corner: f64, source: &StreakSource, all: &[StreakSource]) -> Option<Streak> {
    let map = bands.map;
    let whole: f64 = source.missing.iter().map(|(_, mass)| mass).sum();
    let places = || source.missing.iter().map(|(place, _)| *place);
    let [from, to] = [places().fold(f64::INFINITY, f64::min), places().fold(f64::NEG_INFINITY, f64::max)];
    let place = match whole.abs() > 0.0 {
        true => source.missing.iter().map(|(place, mass)| place * mass).sum::<f64>() / whole,
        false => 0.5 * (from + to),
    };
    let width = (((BAND * source.spread).hypot(to - from) / map.cell).round() as usize).clamp(1, map.columns);
    let middle = (place - corner) / map.cell;
    if !(0.0..map.columns as f64).contains(&middle) {
        return None;
    }
    let first = (middle - 0.5 * width as f64).round().max(0.0) as usize;
    let first = first.min(map.columns - width);
    let ends = [first, first + width].map(|column| corner + column as f64 * map.cell);
    let missing = missing_between(source, ends, map);
    // Of the web without defects.
    let lost: f64 = all.iter().flat_map(|source| &source.missing).map(|(_, mass)| mass).sum();
    let per_width = map.basis_weight() + lost / (map.columns as f64 * map.cell);
    let dip = missing / (per_width * width as f64 * map.cell);
    let beside = beside(bands, corner, width, all);
    let rows = (source.until.clamp(0.0, map.rows as f64 * map.cell) / map.cell).round() as usize;
    let of_defect = (rows / bands.rows_in_block).min(BLOCKS);
    let (mut found, mut length) = (None, None);
    if beside.len() >= FEWEST && of_defect > 0 {
        let of_block =
            |block: usize| beside.iter().map(|band| band[block]).sum::<f64>() / beside.len() as f64;
        let means: [f64; BLOCKS] = std::array::from_fn(of_block);
        let over_mean = |band: [f64; BLOCKS]| std::array::from_fn(|block| band[block] / means[block]);
        let chance = Chance::new(&beside.iter().copied().map(over_mean).collect::<Vec<_>>());
        let own: [f64; BLOCKS] = over_mean(bands.weights(first, width));
        let measured = 1.0 - own.iter().take(of_defect).sum::<f64>() / of_defect as f64;
        found = Some(Known::Value(measured, Some(chance.over(of_defect as f64).sqrt())));
        let squared = NORMAL_95 * NORMAL_95 * (1.0 + 1.0 / chance.bands);
        let left = dip * dip - squared * chance.fixed;
        let needed = squared * chance.of_block * bands.rows_in_block as f64 * map.cell / left;
        let error = needed * (2.0 / chance.degrees).sqrt();
        length = (left > 0.0).then_some(Known::Value(needed, Some(error)));
    }
    Some(Streak {
        place,
        holes: source.missing.len(),
        band: width as f64 * map.cell,
        until: source.until.clamp(0.0, map.rows as f64 * map.cell),
        dip,
        found,
        length,
    })
}

/// Mass per length of web that is missing between two places across the sheet [kg/m].         theory.md (114)
fn missing_between(source: &StreakSource, ends: [f64; 2], map: &Map) -> f64 {
    let round = map.columns as f64 * map.cell;
    let turns: &[f64] = if map.closed[0] { &[-1.0, 0.0, 1.0] } else { &[0.0] };
    let below = |place: f64| 0.5 * (1.0 + libm::erf(place / (SQRT_2 * source.spread)));
    let share = |from: f64| below(ends[1] - from) - below(ends[0] - from);
    let of_hole = |place: f64| turns.iter().map(|turn| share(place + turn * round)).sum::<f64>();
    source.missing.iter().map(|(place, mass)| mass * of_hole(*place)).sum()
}

/// Weights of the bands side by side that no defect is near.
fn beside(bands: &Bands<'_>, corner: f64, width: usize, all: &[StreakSource]) -> Vec<[f64; BLOCKS]> {
    let map = bands.map;
    let round = map.columns as f64 * map.cell;
    let is_free = |first: &usize| {
        let [from, to] = [*first, first + width].map(|column| corner + column as f64 * map.cell);
        all.iter().all(|source| {
            source.missing.iter().all(|(place, _)| {
                let reach = NEAR * source.spread;
                let is_clear = |place: f64| place < from - reach || place > to + reach;
                is_clear(*place) && (!map.closed[0] || [-round, round].iter().all(|by| is_clear(place + by)))
            })
        })
    };
    (0..=map.columns - width)
        .step_by(width)
        .filter(is_free)
        .map(|first| bands.weights(first, width))
        .collect()
}
