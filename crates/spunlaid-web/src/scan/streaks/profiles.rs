//! The profiles across a web that are fitted: polynomials, which are no streaks, and normal profiles of some widths,
//! which are.

use std::iter::successors;

/// The σ of a streak is at most this part of the width, and the next one that is looked for is wider by a factor.
const WIDEST: f64 = 1.0 / 14.0;
pub(super) const WIDER: f64 = 1.4;
/// A streak reaches so many σ to both sides.
pub(super) const REACH: f64 = 3.0;
/// A streak is looked for where the polynomial leaves at least this share of its squares.
const LEFT: f64 = 0.15;

/// All profiles that are fitted across a web.
#[derive(Debug)]
pub(super) struct Profiles {
    /// Width of a bin [m].
    pub(super) bin: f64,
    pub(super) smooth: Smooth,
    /// The normal profiles, the narrowest first.
    pub(super) scales: Vec<Scale>,
}

impl Profiles {
    /// * `bins` – number of bins across the web
    /// * `bin` – width of one [m]
    /// * `degree` – of the polynomial
    pub(super) fn new(bins: usize, bin: f64, degree: u16) -> Self {
        let smooth = Smooth::new(bins, degree);
        let sigmas = successors(Some(1.0), |sigma| Some(WIDER * sigma));
        let sigmas = sigmas.take_while(|sigma| *sigma <= WIDEST * bins as f64);
        let scales = sigmas.map(|sigma| Scale::new(sigma, &smooth)).filter(|scale| !scale.norms.is_empty());
        let scales = scales.collect();
        Self { bin, smooth, scales }
    }
}

pub(super) fn product(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Polynomials across the web, orthogonal and of unit length.
#[derive(Debug)]
pub(super) struct Smooth(Vec<Vec<f64>>);

impl Smooth {
    fn new(bins: usize, most: u16) -> Self {
        let mut all = Self(Vec::new());
        for degree in 0..=most {
            let place = |bin: usize| (2.0 * bin as f64 + 1.0) / bins as f64 - 1.0;
            let mut own: Vec<f64> = (0..bins).map(|bin| place(bin).powi(i32::from(degree))).collect();
            // Twice, for rounding.
            (0..2).for_each(|_| all.take_out(&mut own));
            let length = product(&own, &own).sqrt();
            own.iter_mut().for_each(|value| *value /= length);
            all.0.push(own);
        }
        all
    }

    pub(super) fn take_out(&self, profile: &mut [f64]) {
        for own in &self.0 {
            let part = product(own, profile);
            profile.iter_mut().zip(own).for_each(|(value, own)| *value -= part * own);
        }
    }
}

/// A width of streaks.
#[derive(Debug)]
pub(super) struct Scale {
    /// In bins.
    pub(super) sigma: f64,
    /// The normal profile.
    normal: Vec<f64>,
    /// The first place that is looked at, and from one to the next [bins].
    first: usize,
    stride: usize,
    /// For each place the squares of the normal profile without its part in the polynomials.
    pub(super) norms: Vec<f64>,
}

impl Scale {
    fn new(sigma: f64, smooth: &Smooth) -> Self {
        let half = (REACH * sigma).ceil() as i32;
        let normal = (-half..=half).map(|i| libm::exp(-0.5 * (f64::from(i) / sigma).powi(2))).collect();
        let stride = ((0.25 * sigma) as usize).max(1);
        let mut scale = Self { sigma, normal, first: 0, stride, norms: Vec::new() };
        let whole = product(&scale.normal, &scale.normal);
        let bins = smooth.0[0].len();
        let norm = |place: usize| {
            let own = scale.around(place, bins);
            let squares: f64 = own.1.iter().map(|value| value * value).sum();
            let taken = |other: &Vec<f64>| product(&other[own.0..], own.1).powi(2);
            squares - smooth.0.iter().map(taken).sum::<f64>()
        };
        let all: Vec<(usize, f64)> = (0..bins).step_by(stride).map(|place| (place, norm(place))).collect();
        let middle = |(_, norm): &&(usize, f64)| *norm >= LEFT * whole;
        let left: Vec<(usize, f64)> = all.iter().filter(middle).copied().collect();
        scale.first = left.first().map_or(0, |(place, _)| *place);
        scale.norms = left.into_iter().map(|(_, norm)| norm).collect();
        scale
    }

    /// The part of the normal profile about a bin that lies on the web, and the bin where it begins.
    fn around(&self, place: usize, bins: usize) -> (usize, &[f64]) {
        let half = self.normal.len() / 2;
        let from = place.saturating_sub(half);
        let until = (place + half + 1).min(bins);
        (from, &self.normal[from + half - place..until + half - place])
    }

    /// Amplitudes of the least squares at all places, times the roots of their norms, of a profile without polynomial.
    pub(super) fn heights(&self, profile: &[f64]) -> Vec<f64> {
        let height = |(number, norm): (usize, &f64)| {
            let (from, normal) = self.around(self.first + number * self.stride, profile.len());
            product(&profile[from..], normal) / norm.sqrt()
        };
        self.norms.iter().enumerate().map(height).collect()
    }

    /// The number of the place that is looked at nearest to one [bins].
    pub(super) fn nearest(&self, place: f64) -> usize {
        let number = (place - 0.5 - self.first as f64) / self.stride as f64;
        (number.round().max(0.0) as usize).min(self.norms.len() - 1)
    }

    /// A place that is looked at [bins].
    pub(super) fn place(&self, number: usize) -> f64 {
        (self.first + number * self.stride) as f64 + 0.5
    }
}

/// The scale at which a normal profile leaves the least squares, between the scales, and its height.
pub(super) fn best_fit(heights: &[f64]) -> (f64, f64) {
    let size = |i: usize| heights[i].abs();
    let best = (0..heights.len()).max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap_or(0);
    if best == 0 || best + 1 >= heights.len() {
        return (best as f64, heights[best]);
    }
    let [before, own, behind] = [size(best - 1), size(best), size(best + 1)];
    let (slope, bend) = (0.5 * (behind - before), before - 2.0 * own + behind);
    let by = if bend < 0.0 { (-slope / bend).clamp(-0.5, 0.5) } else { 0.0 };
    (best as f64 + by, heights[best].signum() * (own + slope * by + 0.5 * bend * by * by))
}
