//! The weakest section of a strip, where a strip that is pulled would tear if its strength were that of its
//! lightest section.

use super::{Deviations, MapUncertainty, Marked};
use crate::map::Map;
use crate::map::lattice::Lattice;
use spunlaid_ground::Known;
use spunlaid_ground::statistics::quantile;

/// Share of the strips that are weaker than the quantile that is reported, and the fewest strips that have one.
pub(crate) const WEAK: f64 = 0.05;
const FEWEST: f64 = 20.0;
/// Fewest strips that have a CV.
const FEWEST_OF_CV: usize = 3;

/// Sizes of a strip and of a section of it [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripSize {
    /// Across the strip.
    pub width: f64,
    /// Between the jaws.
    pub length: f64,
    /// Length of a section.
    pub section: f64,
}

/// The strips of one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Strips {
    /// Their sizes, in whole cells [m].
    pub size: StripSize,
    /// Number of strips side by side and one behind the other on the sheet.
    pub count: usize,
    /// Weight of the lightest section of a strip over the mean of its sections, over all strips.
    pub weakest: Known,
    /// Standard deviation of that over strips, over its mean; none of two strips.
    pub scatter: Option<Known>,
    /// What 5 % of the strips are below; none of fewer than 20.
    pub low: Option<Known>,
    /// Standard deviation of a section about the mean of its strip, over that mean.
    pub sections: Known,
}

/// All strips of the sheet along MD and along CD, side by side without overlap; none where no strip of two
/// sections fits.                                                                             theory.md (104)
///
/// * `of` – what is known of the map
pub fn strips(map: &Map, size: StripSize, of: MapUncertainty) -> [Option<Strips>; 2] {
    [true, false].map(|is_along_md| along(map, size, is_along_md, of))
}

/// Where a strip lies, and its weakest section.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StripPlace {
    /// Its corner in cross and in machine direction [m].
    pub corner: [f64; 2],
    /// Its sides [m].
    pub sides: [f64; 2],
    /// The lightest section, with its weight over the mean of the strip.
    pub weakest: Marked,
}

/// The strips of the sheet along MD and along CD; see [`strips`].
pub(super) fn places(map: &Map, size: StripSize) -> [Vec<StripPlace>; 2] {
    [true, false].map(|is_along_md| {
        let Some(cut) = cut(map, size, is_along_md) else { return Vec::new() };
        let turned = |[across, along]: [f64; 2]| if is_along_md { [across, along] } else { [along, across] };
        let StripSize { width, section, .. } = cut.size;
        let sides = turned([width, section * cut.in_strip as f64]);
        let mut all = Vec::new();
        for (column, sums) in cut.sums.iter().enumerate() {
            for (row, strip) in sums.chunks_exact(cut.in_strip).enumerate() {
                let mean = strip.iter().sum::<u64>() as f64 / cut.in_strip as f64;
                let lightest = strip.iter().enumerate().min_by_key(|(_, sum)| **sum);
                let Some((number, sum)) = lightest.filter(|_| mean > 0.0) else { continue };
                let at = [column as f64 * width, (row * cut.in_strip) as f64 * section];
                let weakest = Marked {
                    corner: turned([at[0], at[1] + number as f64 * section]),
                    sides: turned([width, section]),
                    weight: *sum as f64 / mean,
                };
                all.push(StripPlace { corner: turned(at), sides, weakest });
            }
        }
        all
    })
}

/// A sheet that is cut into strips of one direction.
struct Cut {
    /// Weights of the sections of each strip and of those behind it.
    sums: Vec<Vec<u64>>,
    /// Sections of a strip.
    in_strip: usize,
    size: StripSize,
}

/// Cuts the sheet; none where no strip of two sections fits.
fn cut(map: &Map, size: StripSize, is_along_md: bool) -> Option<Cut> {
    let cells = |length: f64| (length / map.cell).round() as usize;
    let (width, section) = (cells(size.width), cells(size.section));
    let (across, deep) = if is_along_md { (map.columns, map.rows) } else { (map.rows, map.columns) };
    if width == 0 || section == 0 {
        return None;
    }
    let in_strip = cells(size.length) / section;
    let (side_by_side, sections) = (across / width, deep / section);
    if in_strip < 2 || side_by_side == 0 || sections < in_strip {
        return None;
    }
    let mut sums = vec![vec![0u64; sections]; side_by_side];
    for row in 0..map.rows {
        // Across the row lie strips, or the sections of one.
        let (part, number) = if is_along_md { (width, row / section) } else { (section, row / width) };
        for (i, cells) in map.row(row).chunks_exact(part).enumerate() {
            let (strip, section) = if is_along_md { (i, number) } else { (number, i) };
            if let Some(sum) = sums.get_mut(strip).and_then(|sections| sections.get_mut(section)) {
                *sum += cells.iter().map(|cell| u64::from(*cell)).sum::<u64>();
            }
        }
    }
    let length = |cells: usize| cells as f64 * map.cell;
    let size =
        StripSize { width: length(width), length: length(in_strip * section), section: length(section) };
    Some(Cut { sums, in_strip, size })
}

fn along(
    map: &Map,
    size: StripSize,
    is_along_md: bool,
    MapUncertainty { chance, deviations }: MapUncertainty,
) -> Option<Strips> {
    let Cut { sums, in_strip, size } = cut(map, size, is_along_md)?;
    // Of each section: its weight over the mean of its strip.
    let (mut weakest, mut shares) = (Vec::new(), Vec::new());
    for strip in sums.iter().flat_map(|sections| sections.chunks_exact(in_strip)) {
        let mean = (strip.iter().sum::<u64>() as f64 / in_strip as f64).max(f64::MIN_POSITIVE);
        shares.extend(strip.iter().map(|sum| *sum as f64 / mean));
        weakest.push(shares[shares.len() - in_strip..].iter().copied().fold(f64::INFINITY, f64::min));
    }
    let lattice = |numbers: &[f64]| {
        let (beside, behind) = (sums.len(), numbers.len() / sums.len());
        // Row by row of the sheet.
        let turned = |i: usize| numbers[i % beside * behind + i / beside];
        match is_along_md {
            true => (Lattice { sides: [beside, behind], chance }, (0..numbers.len()).map(turned).collect()),
            false => (Lattice { sides: [behind, beside], chance }, numbers.to_vec()),
        }
    };
    let per_square = 1.0 / (1.0 - 1.0 / in_strip as f64);
    let squares: Vec<f64> = shares.iter().map(|share| per_square * (share - 1.0).powi(2)).collect();
    let square = squares.iter().sum::<f64>() / squares.len() as f64;
    let deviation = square.sqrt();
    let influence: Vec<f64> = squares.iter().map(|found| found - square).collect();
    let (of_sections, influence) = lattice(&influence);
    let error = of_sections.error_of_mean(&influence, &[]);
    let relative = error.map(|error| if square > 0.0 { 0.5 * error / square } else { 0.0 });
    // The strips themselves may be few; and where the sections vary more, the weakest ones do.
    let of = deviations.zip(relative).map(|(of, by_chance)| Deviations { by_chance, ..of });
    let with = |number: Known, deviation: f64| Deviations::add(of, number, |by| deviation * by);
    let (of_strips, weakest) = lattice(&weakest);
    let [mean, scatter] = [of_strips.mean(&weakest, &[]), of_strips.cv(&weakest, &[])];
    Some(Strips {
        size,
        count: weakest.len(),
        weakest: with(mean, mean.value() - 1.0),
        scatter: (weakest.len() >= FEWEST_OF_CV).then(|| with(scatter, scatter.value())),
        low: low(&weakest, &of_strips).map(|low| with(low, low.value() - 1.0)),
        sections: with(Known::Value(deviation, None), deviation),
    })
}

/// The 5 % quantile, between the quantiles whose shares are an error of the share away.
fn low(weakest: &[f64], lattice: &Lattice) -> Option<Known> {
    let value = quantile(weakest, WEAK);
    let is_below = |weight: &f64| f64::from(u8::from(*weight <= value)) - WEAK;
    let off = lattice.error_of_mean(&weakest.iter().map(is_below).collect::<Vec<_>>(), &[]);
    let error = off.map(|off| {
        let [below, above] = [WEAK - off, WEAK + off].map(|share| quantile(weakest, share));
        0.5 * (above - below)
    });
    (weakest.len() as f64 >= FEWEST).then_some(Known::Value(value, error))
}
