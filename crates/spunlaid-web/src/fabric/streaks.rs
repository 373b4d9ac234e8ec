//! Streaks that defects of the line leave in the web, and whether they show.

use crate::map::Map;
use spunlaid_ground::{Known, NORMAL_95};
use std::f64::consts::SQRT_2;

/// Width of the band over which a streak is looked for, in standard deviations of the places at which a
/// filament comes down: of a streak of a normal profile it has the largest dip over its standard error.
const BAND: f64 = 2.8;
/// Blocks of the sheet along MD whose scatter reports the chance.
const BLOCKS: usize = 8;
/// Fewest bands without a streak that give the chance.
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

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::*;

    /// Bands of alternating blocks whose means are one apart from ± `off`.
    fn bands(step: f64, off: f64) -> Vec<[f64; BLOCKS]> {
        let sign = |i: usize| if i.is_multiple_of(2) { 1.0 } else { -1.0 };
        let band =
            |band: usize| std::array::from_fn(|block| 1.0 + off * sign(band / 2) + step * sign(band + block));
        (0..4).map(band).collect()
    }

    /// Blocks scatter by 32 a² over 21 degrees of freedom, and the means of four bands by 4 b²/3.
    #[test]
    fn analytic_what_bands_vary_beyond_their_blocks_is_fixed() {
        let (a, b) = (0.1, 0.2);
        let of_block = 32.0 * a * a / 21.0;
        let is_near = |found: f64, wanted: f64| (found / wanted - 1.0).abs() < 1e-9;
        let varied = Chance::new(&bands(a, b));
        assert!(is_near(varied.of_block, of_block) && is_near(varied.degrees, 21.0) && varied.bands == 4.0);
        assert!(is_near(varied.fixed, 4.0 * b * b / 3.0 - of_block / 8.0), "{}", varied.fixed);
        assert!(is_near(varied.over(2.0), (of_block / 2.0 + varied.fixed) * 1.25));
        // The ratio of two variances has the error √(2/3 + 2/21), of which two are 1.75.
        for (ratio, is_fixed) in [(2.7, false), (2.8, true)] {
            let off = (0.75 * ratio * of_block / 8.0).sqrt();
            assert_eq!(Chance::new(&bands(a, off)).fixed > 0.0, is_fixed, "{ratio}");
        }
    }

    const CELL: f64 = 1e-3;
    /// So that a band is 14 columns wide.
    const SPREAD: f64 = 5e-3;
    const COLUMNS: usize = 19 * 14;
    const STEP: f64 = 0.03;

    /// Of 19 bands, each in eight blocks of ten rows that are heavier or lighter by turns.
    fn map() -> Map {
        let is_heavy = |i: usize| (i % COLUMNS / 14 + i / COLUMNS / 10).is_multiple_of(2);
        let cell = |i: usize| 1e6 * (1.0 + if is_heavy(i) { STEP } else { -STEP });
        let cells = (0..COLUMNS * 80).map(|i| cell(i) as u32).collect();
        Map { columns: COLUMNS, rows: 80, cell: CELL, quantum: 1e-14, closed: [false; 2], cells }
    }

    fn source(place: f64, mass: f64, until: f64) -> StreakSource {
        StreakSource { missing: vec![(place, mass)], spread: SPREAD, until }
    }

    /// A streak in the middle band: the bands that are farther than three standard deviations, eight on
    /// either side, have the mean one in each block.
    #[test]
    fn analytic_the_length_at_which_a_streak_shows_follows_from_the_blocks_beside_it() {
        let map = map();
        let corner = 0.4;
        let mass = 1e-5;
        let place = corner + 9.5 * 14.0 * CELL;
        let of_block = 16.0 * 8.0 * STEP * STEP / (15.0 * 7.0);
        for (until, blocks, measured) in [(0.03, 3, STEP / 3.0), (0.029, 2, 0.0), (9.0, 8, 0.0)] {
            let found = streaks(&map, corner, &[source(place, mass, until)]).remove(0);
            let weight = map.basis_weight() + mass / (COLUMNS as f64 * CELL);
            let dip = mass * libm::erf(7e-3 / (SQRT_2 * SPREAD)) / (weight * 14e-3);
            assert!((found.place - place).abs() < 1e-12 && found.holes == 1, "{found:?}");
            assert!((found.band - 14e-3).abs() < 1e-12 && found.until == until.min(80.0 * CELL));
            assert!((found.dip / dip - 1.0).abs() < 1e-9, "{} {dip}", found.dip);
            let Some(Known::Value(value, Some(error))) = found.found else { panic!("{found:?}") };
            let wanted = (of_block / f64::from(blocks) * (1.0 + 1.0 / 16.0)).sqrt();
            assert!(
                (value - measured).abs() < 1e-9 && (error / wanted - 1.0).abs() < 1e-6,
                "{value} {error}"
            );
            let Some(Known::Value(length, Some(error))) = found.length else { panic!("{found:?}") };
            let wanted = NORMAL_95 * NORMAL_95 * (1.0 + 1.0 / 16.0) * of_block * 10.0 * CELL / (dip * dip);
            assert!((length / wanted - 1.0).abs() < 1e-6, "{length} {wanted}");
            assert!((error / length / f64::sqrt(2.0 / 105.0) - 1.0).abs() < 1e-9);
        }
        // Too short for a block.
        let short = streaks(&map, corner, &[source(place, mass, 0.009)]).remove(0);
        assert_eq!((short.found, short.length), (None, None));
    }

    #[test]
    fn streaks_lie_where_their_mass_is_missing_and_none_lies_beyond_the_map() {
        let (map, corner) = (map(), 0.4);
        let width = COLUMNS as f64 * CELL;
        let at = |missing: &[(f64, f64)]| {
            let source = StreakSource { missing: missing.to_vec(), spread: SPREAD, until: 1.0 };
            streaks(&map, corner, &[source]).first().map(|streak| (streak.place, streak.band))
        };
        let is_at = |found: Option<(f64, f64)>, place: f64, cells: f64| {
            found.is_some_and(|(at, band)| (at - place).abs() < 1e-12 && (band - cells * CELL).abs() < 1e-12)
        };
        assert!(is_at(at(&[(0.45, 1e-5), (0.46, 3e-5)]), 0.4575, 17.0));
        // What one lacks and another has more of is between them.
        assert!(is_at(at(&[(0.45, 1e-5), (0.47, -1e-5)]), 0.46, 24.0));
        assert!(is_at(at(&[(corner, 1e-5)]), corner, 14.0));
        assert!(is_at(at(&[(corner + width - 1e-4, 1e-5)]), corner + width - 1e-4, 14.0));
        assert_eq!([at(&[(corner - 1e-4, 1e-5)]), at(&[(corner + width, 1e-5)])], [None, None]);
        let few_rows =
            Map { rows: BLOCKS - 1, cells: map.cells[..COLUMNS * (BLOCKS - 1)].to_vec(), ..map.clone() };
        assert_eq!(streaks(&few_rows, corner, &[source(0.5, 1e-5, 1.0)]), []);
        let empty = Map { cells: vec![0; map.cells.len()], ..map.clone() };
        assert_eq!(streaks(&empty, corner, &[source(0.5, 1e-5, 1.0)]), []);
    }

    /// On a sheet that is closed across, a streak at its edge lacks its mass at the other edge too.
    #[test]
    fn analytic_a_streak_over_the_edges_of_a_closed_sheet() {
        let [open, closed] = [false, true].map(|closed| Map { closed: [closed, false], ..map() });
        let round = COLUMNS as f64 * CELL;
        let of = |map: &Map, place: f64, ends: [f64; 2]| missing_between(&source(place, 2.0, 1.0), ends, map);
        let half = libm::erf(7e-3 / (SQRT_2 * SPREAD));
        assert!((of(&open, 0.0, [0.0, 7e-3]) - half).abs() < 1e-12);
        for place in [0.0, round] {
            assert!((of(&closed, place, [0.0, 7e-3]) - half).abs() < 1e-12);
            assert!((of(&closed, place, [round - 7e-3, round]) - half).abs() < 1e-12);
        }
        // Bands near either edge are not taken for sampling error, of 19 the first two and the last two.
        for place in [0.0, round] {
            let near = |map: &Map| beside(&Bands::new(map), 0.0, 14, &[source(place, 1.0, 1.0)]).len();
            assert_eq!([near(&open), near(&closed)], [17, 15]);
        }
    }

    /// Bands that are a tenth heavier or lighter along the whole web, two of each by turns: a dip must exceed 1.96
    /// of their deviations too, and a smaller one never shows.
    #[test]
    fn analytic_the_length_at_which_a_streak_shows_beside_others_that_stay() {
        const OFF: f64 = 0.1;
        let even = map();
        let is_heavy = |i: usize| (i % COLUMNS / 14 / 2).is_multiple_of(2);
        let cell = |(i, cell): (usize, &u32)| if is_heavy(i) { cell + 100_000 } else { cell - 100_000 };
        let map = Map { cells: even.cells.iter().enumerate().map(cell).collect(), ..even };
        let of_block = 16.0 * 8.0 * STEP * STEP / (15.0 * 7.0);
        let fixed = 16.0 * OFF * OFF / 15.0 - of_block / 8.0;
        let squared = NORMAL_95 * NORMAL_95 * (1.0 + 1.0 / 16.0);
        for (mass, shows) in [(6e-5, true), (2e-5, false)] {
            let found = streaks(&map, 0.0, &[source(9.5 * 14.0 * CELL, mass, 9.0)]).remove(0);
            let Some(Known::Value(_, Some(error))) = found.found else { panic!("{found:?}") };
            let wanted = ((of_block / 8.0 + fixed) * (1.0 + 1.0 / 16.0)).sqrt();
            assert!((error / wanted - 1.0).abs() < 1e-6, "{error} {wanted}");
            assert_eq!(found.length.is_some(), shows, "{found:?}");
            let left = found.dip * found.dip - squared * fixed;
            let wanted = squared * of_block * 10.0 * CELL / left;
            let length = found.length.map_or(wanted, Known::value);
            assert!((length / wanted - 1.0).abs() < 1e-6 && (left > 0.0) == shows, "{length} {wanted}");
        }
    }
}
