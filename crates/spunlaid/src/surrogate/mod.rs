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
mod identify;
mod paths;

pub use identify::{Identification, IdentificationFailure, Residual, identify};
pub(crate) use paths::BLOCK as PATH_POINTS;
pub use paths::{PathKey, Paths};

use generator::{Correlations, Size};

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
