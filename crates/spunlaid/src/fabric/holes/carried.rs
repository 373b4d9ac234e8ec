//! From the holes that are counted in windows to those of the whole sheet.

use super::super::Known;
use super::super::patches::weights;
use super::{LEAST_RADIUS, WindowHoles};
use crate::statistics::Estimate;
use crate::web::{Map, straight_fibres};
use std::f64::consts::PI;

/// Radii of the holes that are told [m].
pub const RADII: [f64; 7] = [20e-6, 30e-6, 50e-6, 70e-6, 100e-6, 150e-6, 200e-6];
/// Side of the patches over which the length of fibre is local [m].
const LOCAL: f64 = 1.5e-3;
/// Fewest holes in all windows from which others are told, and fewest that are as large as the largest ones
/// that are told from counts alone.
const FEWEST: usize = 100;
const FEWEST_LARGE: usize = 25;
/// Standard errors to either side of a range.
const WIDE: f64 = 2.0;
/// Classes of the local length of fibre over its mean, and their number for the mean.
const CLASSES_PER_MEAN: f64 = 200.0;
const CLASSES: usize = 2000;
/// The largest hole is searched up to this radius [m].
const LARGEST: f64 = 5e-3;
const HALVINGS: usize = 60;

/// Holes per area into which a disc fits, of straight fibres at random [1/m²]: the in-radius of a cell
/// between random lines has an exponential distribution, and there are `τ²/π` cells per area.
///                                                                                            theory.md (110)
///
/// * `length` – of fibre per area [1/m]
/// * `diameter` – of the fibres [m]
/// * `radius` – of the disc [m]
///
/// Source: R. E. Miles, Proc. Natl. Acad. Sci. 52 (1964) 901–907.
pub fn expected_holes(length: f64, diameter: f64, radius: f64) -> f64 {
    length * length / PI * libm::exp(-length * (2.0 * radius + diameter))
}

/// The length of fibre per area, place by place, without the chance of single fibres.
#[derive(Clone, Debug)]
pub struct LocalLength {
    /// Patches in cross and in machine direction.
    patches: [usize; 2],
    /// Side of a patch [m].
    side: f64,
    /// Length of fibre per area of each patch [1/m].
    lengths: Vec<f64>,
    /// The same in classes: the mean of a class, and its share of the patches.
    classes: Vec<(f64, f64)>,
}

impl LocalLength {
    /// Over patches of one to two millimetres, or of a cell where that is larger. Straight fibres at random
    /// have as many in one patch as in another but for chance, which the count of holes already knows; so the
    /// deviations from the mean are lowered until they vary by as much as the web varies more than straight
    /// fibres do.                                                                             theory.md (111)
    ///
    /// * `mean` – length of fibre per area of the sheet [1/m]
    pub fn new(map: &Map, mean: f64) -> Self {
        let side = ((LOCAL / map.cell).round().max(1.0) as usize).min(map.columns.min(map.rows));
        let patches = [map.columns / side, map.rows / side];
        let weights = weights(map, LOCAL);
        let count = weights.len() as f64;
        let variance = weights.iter().map(|weight| (weight - 1.0).powi(2)).sum::<f64>() / count;
        let size = side as f64 * map.cell;
        let by_chance = straight_fibres(mean, size).powi(2);
        let lower = if variance > by_chance { (1.0 - by_chance / variance).sqrt() } else { 0.0 };
        let lengths: Vec<f64> =
            weights.iter().map(|weight| mean * (1.0 + lower * (weight - 1.0)).max(0.0)).collect();
        let mut classes = vec![(0.0, 0.0); CLASSES];
        for length in &lengths {
            let class = &mut classes[((length / mean * CLASSES_PER_MEAN) as usize).min(CLASSES - 1)];
            *class = (class.0 + length, class.1 + 1.0);
        }
        classes.retain(|(_, number)| *number > 0.0);
        let classes = classes.into_iter().map(|(sum, number)| (sum / number, number / count)).collect();
        Self { patches, side: size, lengths, classes }
    }

    /// The mean over the sheet of something that depends on the length of fibre.
    fn mean(&self, of: impl Fn(f64) -> f64) -> f64 {
        self.classes.iter().map(|(length, share)| share * of(*length)).sum()
    }

    /// The lengths of the patches whose middles lie in a square of the map.
    fn within(&self, corner: [f64; 2], side: f64) -> Vec<f64> {
        let numbers = |axis: usize| {
            let first = |at: f64| ((at / self.side - 0.5).ceil().max(0.0) as usize).min(self.patches[axis]);
            first(corner[axis])..first(corner[axis] + side)
        };
        let columns = numbers(0);
        numbers(1)
            .flat_map(|row| columns.clone().map(move |column| (row, column)))
            .map(|(row, column)| self.lengths[row * self.patches[0] + column])
            .collect()
    }
}

/// The holes of the fabric.
#[derive(Clone, Debug, PartialEq)]
pub struct FabricHoles {
    /// Number of windows in which fibres were drawn, and their area together [m²].
    pub windows: usize,
    /// See [`FabricHoles::windows`].
    pub area: f64,
    /// Share of the sheet that no fibre covers.
    pub bare: Known,
    /// Holes by their radius.
    pub radii: Vec<HolesOfRadius>,
    /// Radius of the largest hole in the area of a test: half of all such areas have a larger one [m].
    pub largest: Known,
}

/// Holes into which a disc of one radius fits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HolesOfRadius {
    /// The radius [m].
    pub radius: f64,
    /// Those that were counted in all windows.
    pub counted: usize,
    /// Whether so few were counted that their number follows from smaller ones.
    pub is_carried: bool,
    /// Their number on the sheet [1/m²].
    pub per_area: Known,
    /// Their number over that of straight fibres with the local length of the map, κ; none where too few were counted.
    pub over_straight: Option<Known>,
}

/// A window, with what is expected there.
struct Counted {
    area: f64,
    bare: f64,
    /// Radii of its holes, the largest first [m].
    radii: Vec<f64>,
    /// Length of fibre per area of its patches [1/m].
    lengths: Vec<f64>,
}

/// The ratio of the holes that were counted and those of straight fibres.
struct Ratio {
    windows: Vec<Counted>,
    diameter: f64,
    /// The largest radius whose number follows from counts alone [m]; none if too few were counted for any.
    largest: Option<f64>,
    /// `ln κ` at the least radius and at the largest one, of all windows and without each of them.
    ends: Vec<[f64; 2]>,
}

impl Ratio {
    fn new(windows: Vec<Counted>, diameter: f64) -> Self {
        let mut radii: Vec<f64> = windows.iter().flat_map(|window| window.radii.iter().copied()).collect();
        radii.sort_by(|a, b| b.total_cmp(a));
        let largest = (radii.len() >= FEWEST).then(|| radii[FEWEST_LARGE - 1]);
        let mut ratio = Self { windows, diameter, largest, ends: Vec::new() };
        if let Some(largest) = largest {
            let without = (0..ratio.windows.len()).map(Some);
            let ends = std::iter::once(None).chain(without);
            ratio.ends =
                ends.map(|without| [LEAST_RADIUS, largest].map(|r| ratio.logarithm(r, without))).collect();
        }
        ratio
    }

    fn count(&self, radius: f64) -> usize {
        self.windows.iter().map(|window| window.radii.partition_point(|other| *other >= radius)).sum()
    }

    /// `ln κ` from counts, without one of the windows.
    fn logarithm(&self, radius: f64, without: Option<usize>) -> f64 {
        let (mut counted, mut expected) = (0.0, 0.0);
        for (_, window) in self.windows.iter().enumerate().filter(|(i, _)| Some(*i) != without) {
            counted += window.radii.partition_point(|other| *other >= radius) as f64;
            let each = |length: &f64| expected_holes(*length, self.diameter, radius);
            let sum: f64 = window.lengths.iter().map(each).sum();
            expected += window.area * sum / window.lengths.len() as f64;
        }
        libm::log(counted / expected)
    }

    /// `ln κ` and its standard error, by leaving out one window after another; beyond the counts both with κ
    /// as it is at their end, and as it goes on.
    fn at(&self, radius: f64) -> Option<[(f64, f64); 2]> {
        let largest = self.largest?;
        let spread = |values: Vec<f64>, least: f64| {
            let (whole, count) = (values[0], values.len() as f64 - 1.0);
            let squares: f64 = values[1..].iter().map(|value| (value - whole).powi(2)).sum();
            let error = (squares * (count - 1.0) / count).sqrt();
            // Not below the chance of a count.
            (whole, if error.is_finite() { error.max(least) } else { f64::INFINITY })
        };
        if radius <= largest {
            let without = (0..self.windows.len()).map(Some);
            let all = std::iter::once(None).chain(without).map(|without| self.logarithm(radius, without));
            let found = spread(all.collect(), 1.0 / (self.count(radius) as f64).sqrt());
            return Some([found; 2]);
        }
        let further = (radius - largest) / (largest - LEAST_RADIUS).max(f64::MIN_POSITIVE);
        let least = 1.0 / (FEWEST_LARGE as f64).sqrt();
        let kept = spread(self.ends.iter().map(|ends| ends[1]).collect(), least);
        let going_on = self.ends.iter().map(|ends| ends[1] + further * (ends[1] - ends[0]));
        Some([kept, spread(going_on.collect(), least)])
    }

    /// Ends of the range of `κ`.
    fn range(&self, radius: f64) -> Option<[f64; 2]> {
        let [a, b] = self.at(radius)?;
        let low = (a.0 - WIDE * a.1).min(b.0 - WIDE * b.1);
        let high = (a.0 + WIDE * a.1).max(b.0 + WIDE * b.1);
        Some([libm::exp(low), libm::exp(high)])
    }
}

/// Carries what was counted in windows over to the whole sheet, and to radii that no window shows: their
/// ratio κ to the holes of straight fibres with the local length of fibre is found in the windows and holds
/// for the sheet.                                                                             theory.md (112)
///
/// * `windows` – each with the place of its corner on the map [m]
/// * `diameter` – of the fibres, the mean over their length [m]
/// * `test_area` – in which the largest hole is told [m²]
///
/// None without a window.
pub fn carry(
    windows: &[([f64; 2], WindowHoles)],
    local: &LocalLength,
    diameter: f64,
    test_area: f64,
) -> Option<FabricHoles> {
    let counted = |(corner, window): &([f64; 2], WindowHoles)| {
        let mut radii: Vec<f64> = window.holes.iter().map(|disc| disc.radius).collect();
        radii.sort_by(|a, b| b.total_cmp(a));
        let lengths = local.within(*corner, window.area.sqrt());
        (!lengths.is_empty()).then_some(Counted { area: window.area, bare: window.bare, radii, lengths })
    };
    let windows: Vec<Counted> = windows.iter().filter_map(counted).collect();
    if windows.is_empty() {
        return None;
    }
    let bare = bare(&windows, local, diameter);
    let (count, area) = (windows.len(), windows.iter().map(|window| window.area).sum());
    let ratio = Ratio::new(windows, diameter);
    let straight = |radius: f64| local.mean(|length| expected_holes(length, diameter, radius));
    let of_radius = |radius: f64| {
        let is_carried = ratio.largest.is_none_or(|largest| radius > largest);
        let over_straight = ratio.at(radius).zip(ratio.range(radius)).map(|([(log, error), _], range)| {
            let value = libm::exp(log);
            if is_carried { Known::Between(range) } else { Known::Value(value, Some(value * error)) }
        });
        let straight = straight(radius);
        let per_area = over_straight.map_or(Known::AtLeast(straight), |ratio| ratio.times(straight));
        HolesOfRadius { radius, counted: ratio.count(radius), is_carried, per_area, over_straight }
    };
    Some(FabricHoles {
        windows: count,
        area,
        bare,
        radii: RADII.iter().map(|radius| of_radius(*radius)).collect(),
        largest: largest(&ratio, straight, test_area),
    })
}

/// The bare share of the sheet: that of the windows, over what straight fibres with their local length leave
/// bare, times what these leave bare on the sheet.
fn bare(windows: &[Counted], local: &LocalLength, diameter: f64) -> Known {
    let straight = |length: f64| libm::exp(-length * diameter);
    let expected = |window: &Counted| {
        window.lengths.iter().map(|length| straight(*length)).sum::<f64>() / window.lengths.len() as f64
    };
    // Of a ratio of two means: each window by what it lies off.
    let sums = windows.iter().fold([0.0; 2], |sum, window| [sum[0] + window.bare, sum[1] + expected(window)]);
    let ratio = sums[0] / sums[1];
    let off = windows.iter().map(|window| window.bare - ratio * expected(window)).collect();
    let error = Estimate::new(off).standard_error;
    let (sheet, mean) = (local.mean(straight), sums[1] / windows.len() as f64);
    Known::Value(ratio * sheet, error.map(|error| error * sheet / mean))
}

/// The radius above which half of all areas have a hole. Without enough counts it is that of straight fibres,
/// whose holes are smaller.
fn largest(ratio: &Ratio, straight: impl Fn(f64) -> f64, area: f64) -> Known {
    let wanted = std::f64::consts::LN_2 / area;
    let radius = |end: Option<usize>| {
        let number = |radius: f64| {
            let ratio = end.and_then(|end| Some(ratio.range(radius)?[end])).unwrap_or(1.0);
            ratio * straight(radius)
        };
        if number(LEAST_RADIUS) < wanted {
            return LEAST_RADIUS;
        }
        let (mut low, mut high) = (LEAST_RADIUS, LARGEST);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if number(middle) >= wanted { low = middle } else { high = middle }
        }
        low
    };
    if ratio.largest.is_none() {
        return Known::AtLeast(radius(None));
    }
    match [0, 1].map(|end| radius(Some(end))) {
        [_, high] if high <= LEAST_RADIUS => Known::AtMost(LEAST_RADIUS),
        ends => Known::Between(ends),
    }
}
