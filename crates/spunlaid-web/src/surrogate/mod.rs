//! The surrogate: a stochastic model that lays a fibre without flying it.
//!
//! On the belt a fibre goes on in the direction α at the rate at which it is fed, wanders, and is drawn back
//! to the place under its root. With `τ = (cos α, sin α)`, `τ^⊥ = (−sin α, cos α)` and s the length of fibre,
//!
//! ```text
//! dξ = τ(α) ds
//! dα = −(ξ₁/σ₁², ξ₂/σ₂²)·τ^⊥(α) ds + A dW
//! ```
//!
//! ξ is the position relative to the straight trace that a fibre without lateral motion leaves on the moving
//! belt: ξ₁ in machine direction, ξ₂ in cross direction. In the stationary state ξ₁ and ξ₂ are independent
//! and normal with the standard deviations σ₁ and σ₂, and α is uniform.
//!
//! Source: T. Götz, A. Klar, N. Marheineke, R. Wegener, SIAM Journal on Applied Mathematics 67 (2007) 1704–1717;
//! A. Klar, N. Marheineke, R. Wegener, ZAMM 89 (2009) 941–961.

mod generator;
mod paths;

use generator::{Correlations, Size};
pub(crate) use paths::BLOCK as PATH_POINTS;
pub use paths::{PathKey, Paths};
use spunlaid_ground::{Estimate, WIDTH};
use std::array::from_fn;

/// The stochastic model of a laid fibre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surrogate {
    /// Standard deviation of ξ₁, in machine direction [m].
    pub sigma_md: f64,
    /// Standard deviation of ξ₂, in cross direction [m].
    pub sigma_cd: f64,
    /// Strength A of the noise of the direction [m^-½].
    pub noise: f64,
}

/// Largest ratio of the two standard deviations for which autocorrelations are computed.
const LARGEST_RATIO: f64 = 5.0;

/// Smallest and largest `A²√(σ₁σ₂)` for which autocorrelations are computed. A curve with less noise
/// remembers where it was for many turns, and more and more functions would be needed; one with more changes
/// its place so slowly that lags of 12σ say little about A.
const NOISES: [f64; 2] = [0.25, 60.0];

impl Surrogate {
    /// `A²√(σ₁σ₂)`: the noise without a unit. Below 1 the fibre lays loops, far above 1 it wanders.
    pub fn relative_noise(&self) -> f64 {
        self.noise * self.noise * (self.sigma_md * self.sigma_cd).sqrt()
    }

    /// Exact autocorrelation coefficients of ξ₁ and ξ₂ in the stationary state at evenly spaced lags, from lag zero.
    ///
    /// The error is 2e-3 at a relative noise of 0.25, 3e-4 at 0.4, and below 1e-4 above 0.8, at lags up to 12σ.
    /// None if the standard deviations differ by more than a factor of 5, if the relative noise is not between 0.25
    /// and 60, or if the lags are not between zero and 200 standard deviations.
    ///
    /// * `step` – step of the lag [m]
    /// * `lags` – number of lags, lag zero included
    pub fn autocorrelation(&self, step: f64, lags: usize) -> Option<[Vec<f64>; 2]> {
        let sigmas = [self.sigma_md, self.sigma_cd];
        let noise = self.relative_noise();
        let largest = step * lags.saturating_sub(1) as f64 / sigmas[0].min(sigmas[1]);
        let known = sigmas.iter().all(|sigma| *sigma > 0.0 && sigma.is_finite())
            && ratio(sigmas) <= LARGEST_RATIO
            && (NOISES[0]..=NOISES[1]).contains(&noise)
            && step > 0.0
            && (0.0..=200.0).contains(&largest);
        known.then(|| {
            [sigmas, [sigmas[1], sigmas[0]]].map(|[own, other]| {
                let reach = largest * sigmas[0].min(sigmas[1]) / own;
                let squared = self.noise * self.noise * own;
                let curves = Correlations::new(other / own, [squared; 8], reach, Size::for_noise(noise));
                (0..lags).map(|lag| curves.at(lag as f64 * step / own)[0]).collect()
            })
        })
    }
}

/// The larger over the smaller standard deviation.
fn ratio([a, b]: [f64; 2]) -> f64 {
    (a / b).max(b / a)
}

/// A surrogate that was found, and how well it fits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Identification {
    /// The surrogate.
    pub surrogate: Surrogate,
    /// Rms difference between the measured autocorrelations and those of the surrogate, over the lags of the fit.
    pub residual: f64,
}

/// How far the autocorrelations of laid fibres are from those of a surrogate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residual {
    /// Rms difference between the mean autocorrelations of the fibres and those of the surrogate, over the
    /// lags of the fit.
    pub rms: f64,
    /// Rms standard error of the mean autocorrelations over these lags: the residual that chance alone would
    /// leave. None for a single fibre.
    pub by_chance: Option<f64>,
}

/// Range of lags of the fit [σ]. Shorter lags hold the texture of the curve, which the surrogate does not describe.
const LAGS: [f64; 2] = [0.5, 12.0];
/// The fit needs lags up to here at least [σ].
const LEAST_REACH: f64 = 3.0;
/// The fit needs so many lags of each coordinate at least.
const LEAST_LAGS: usize = 5;
/// An autocorrelation that still goes beyond this, up or down, in the last quarter of the lags does not decay.
const NOT_DECAYED: f64 = 0.9;

/// Finds A by least squares of both autocorrelations over lags from 0.5σ to 12σ, each coordinate with its own σ and the
/// same weight. The quadratic variation of the direction would give another A at every spacing of the points.
///
/// * `sigmas` – standard deviations of ξ₁ and ξ₂ [m]
/// * `step` – step of the lag [m]
/// * `correlations` – autocorrelation coefficients of ξ₁ and ξ₂ from lag zero
///
/// None if the curves cannot be those of a surrogate, or do not say which: without a spread, with standard deviations
/// that differ too much, if an autocorrelation does not reach far enough or does not decay, and where the best noise
/// would be at an end of the range of noises.
pub fn identify(sigmas: [f64; 2], step: f64, correlations: [&[f64]; 2]) -> Option<Identification> {
    let is_known = sigmas.iter().chain([&step]).all(|x| *x > 0.0 && x.is_finite());
    if !is_known || ratio(sigmas) > LARGEST_RATIO {
        return None;
    }
    let wanted = [
        FitTarget::new(sigmas[0], sigmas[1], step, correlations[0])?,
        FitTarget::new(sigmas[1], sigmas[0], step, correlations[1])?,
    ];
    if wanted.iter().any(FitTarget::goes_on) {
        return None;
    }
    let middle = (sigmas[0] * sigmas[1]).sqrt();
    let noise = |x: f64| (libm::exp(x) / middle).sqrt();
    // First the order of magnitude, then eight curves near it, between which the residuals are interpolated.
    let ends = NOISES.map(libm::log);
    let rough: [f64; WIDTH] = from_fn(|i| ends[0] + (ends[1] - ends[0]) * i as f64 / (WIDTH - 1) as f64);
    let products = products(&wanted, middle, &rough, Size::COARSE);
    let best = (0..WIDTH).min_by(|a, b| products[*a][*a].total_cmp(&products[*b][*b])).unwrap_or(0);
    let (low, high) = (rough[best.saturating_sub(1)], rough[(best + 1).min(WIDTH - 1)]);
    let fit = NoiseMisfit::between(low, high, &wanted, middle);
    let (found, mean_square) = fit.least();
    let near = |end: f64| (found - end).abs() < 1e-6;
    if ends.into_iter().any(near) {
        return None;
    }
    let surrogate = Surrogate { sigma_md: sigmas[0], sigma_cd: sigmas[1], noise: noise(found) };
    Some(Identification { surrogate, residual: mean_square.max(0.0).sqrt() })
}

impl Surrogate {
    /// How far the autocorrelations of laid fibres are from those of this surrogate, over the lags from which
    /// [`identify`] finds it. The mean over the fibres is taken first: a single one has too much chance in
    /// its autocorrelation.
    ///
    /// None if the surrogate has [no autocorrelation](Surrogate::autocorrelation) that can be computed, or
    /// the lags of the fibres do not reach far enough.
    ///
    /// * `step` – step of the lag [m]
    /// * `fibres` – of each the autocorrelation coefficients of ξ₁ and ξ₂ from lag zero; those that are not
    ///   finite are left out
    pub fn residual(&self, step: f64, fibres: &[[&[f64]; 2]]) -> Option<Residual> {
        let lags = fibres.iter().flatten().map(|correlation| correlation.len()).min()?;
        let own = self.autocorrelation(step, lags)?;
        let sigmas = [self.sigma_md, self.sigma_cd];
        let mut residual = 0.0;
        let mut chance = 0.0;
        let mut single = false;
        for (axis, own) in own.iter().enumerate() {
            let within = |lag: &usize| (LAGS[0]..=LAGS[1]).contains(&(*lag as f64 * step / sigmas[axis]));
            let mut squares = [0.0; 3];
            for lag in (0..lags).filter(within) {
                let values = fibres.iter().map(|fibre| fibre[axis][lag]).filter(|c| c.is_finite());
                let found = Estimate::new(values.collect());
                if !found.mean.is_finite() {
                    continue;
                }
                single |= found.standard_error.is_none();
                let error = found.standard_error.unwrap_or(0.0);
                for (sum, square) in
                    squares.iter_mut().zip([1.0, (found.mean - own[lag]).powi(2), error * error])
                {
                    *sum += square;
                }
            }
            let [count, differences, errors] = squares;
            if count < LEAST_LAGS as f64 {
                return None;
            }
            // Each coordinate has the same weight, as in the fit.
            residual += 0.5 * differences / count;
            chance += 0.5 * errors / count;
        }
        Some(Residual { rms: residual.sqrt(), by_chance: (!single).then(|| chance.sqrt()) })
    }
}

/// The measured autocorrelation of one coordinate within the range of the fit.
struct FitTarget {
    /// σ of the coordinate [m].
    own: f64,
    /// σ of the other coordinate divided by that of this one.
    other: f64,
    /// Lags [own σ] and coefficients.
    coefficients: Vec<(f64, f64)>,
}

impl FitTarget {
    fn new(own: f64, other: f64, step: f64, correlation: &[f64]) -> Option<Self> {
        let lags = correlation.iter().enumerate().map(|(lag, c)| (lag as f64 * step / own, *c));
        let coefficients: Vec<(f64, f64)> =
            lags.filter(|(lag, _)| (LAGS[0]..=LAGS[1]).contains(lag)).collect();
        let known = coefficients.len() >= LEAST_LAGS
            && coefficients.last().is_some_and(|(lag, _)| *lag >= LEAST_REACH)
            && coefficients.iter().all(|(_, c)| c.is_finite());
        known.then(|| Self { own, other: other / own, coefficients })
    }

    fn goes_on(&self) -> bool {
        let last = self.coefficients.len() / 4;
        self.coefficients.iter().rev().take(last.max(1)).any(|(_, c)| c.abs() > NOT_DECAYED)
    }

    /// Differences of the autocorrelations with eight noises from the measured one, lag by lag.
    fn residuals(&self, noises: [f64; WIDTH], size: Size) -> impl Iterator<Item = [f64; WIDTH]> {
        let reach = self.coefficients.last().map_or(0.0, |(lag, _)| *lag);
        let curves = Correlations::new(self.other, noises.map(|squared| squared * self.own), reach, size);
        self.coefficients.iter().map(move |(lag, c)| curves.at(*lag).map(|model| model - c))
    }
}

/// Mean products of the residuals of eight noises, over both coordinates.
///
/// * `logarithms` – of the relative noises
fn products(
    wanted: &[FitTarget; 2],
    middle: f64,
    logarithms: &[f64; WIDTH],
    size: Size,
) -> [[f64; WIDTH]; WIDTH] {
    let noises = logarithms.map(|x| libm::exp(x) / middle);
    let mut products = [[0.0; WIDTH]; WIDTH];
    for target in wanted {
        let weight = 0.5 / target.coefficients.len() as f64;
        for residuals in target.residuals(noises, size) {
            for (row, a) in products.iter_mut().zip(residuals) {
                for (product, b) in row.iter_mut().zip(residuals) {
                    *product += weight * a * b;
                }
            }
        }
    }
    products
}

/// The mean square of the residuals as a function of the logarithm of the relative noise within a range: the
/// residuals are interpolated by the polynomial through eight Chebyshev points.
struct NoiseMisfit {
    low: f64,
    high: f64,
    points: [f64; WIDTH],
    products: [[f64; WIDTH]; WIDTH],
}

impl NoiseMisfit {
    fn between(low: f64, high: f64, wanted: &[FitTarget; 2], middle: f64) -> Self {
        let angle = |i: usize| std::f64::consts::PI * (i as f64 + 0.5) / WIDTH as f64;
        let points = from_fn(|i| 0.5 * (low + high) - 0.5 * (high - low) * libm::cos(angle(i)));
        let products = products(wanted, middle, &points, Size::for_noise(libm::exp(low)));
        Self { low, high, points, products }
    }

    fn mean_square(&self, x: f64) -> f64 {
        let weights: [f64; WIDTH] = from_fn(|i| {
            let others = (0..WIDTH).filter(|j| *j != i);
            others.map(|j| (x - self.points[j]) / (self.points[i] - self.points[j])).product()
        });
        let row = |i: usize| (0..WIDTH).map(|j| weights[j] * self.products[i][j]).sum::<f64>();
        (0..WIDTH).map(|i| weights[i] * row(i)).sum()
    }

    /// Where it is least, and its value there.
    fn least(&self) -> (f64, f64) {
        const PARTS: usize = 16;
        let (mut low, mut high) = (self.low, self.high);
        // Each round leaves an eighth of the range; ten reach the rounding.
        for _ in 0..10 {
            let at = |i: usize| low + (high - low) * i as f64 / PARTS as f64;
            let best = (0..=PARTS).map(|i| (i, self.mean_square(at(i)))).min_by(|a, b| a.1.total_cmp(&b.1));
            let best = best.map_or(0, |(i, _)| i);
            (low, high) = (at(best.saturating_sub(1)), at((best + 1).min(PARTS)));
        }
        let x = 0.5 * (low + high);
        (x, self.mean_square(x))
    }
}
