//! The taper that interpolates the samples.

use std::f64::consts::PI;

/// Number of samples that an interpolated value is computed from.
pub(super) const SPREAD: usize = 8;

/// The Kaiser-Bessel taper `φ(x) = I₀(β √(1−(2x/w)²))/I₀(β)`, |x| ≤ w/2 = SPREAD/2 sample spacings.
///
/// The sum over the eight nearest samples restores a signal with frequencies up to a quarter of the sampling rate to
/// 1e-7 of its rms, if each frequency was divided by the taper's transform. theory.md (19)
pub(super) struct Taper {
    beta: f64,
}

impl Taper {
    pub(super) fn new() -> Self {
        // The widest main lobe that still ends before the first image, at ¾ of the sampling rate.
        Self { beta: PI * SPREAD as f64 * 0.75 }
    }

    /// Fourier transform at a frequency in turns per sample, `w sinh(s)/(s I₀(β))`, `s² = β²−(πwν)²`.
    pub(super) fn transform(&self, frequency: f64) -> f64 {
        let w = SPREAD as f64;
        let a = PI * w * frequency;
        let s = (self.beta * self.beta - a * a).sqrt();
        w * libm::sinh(s) / (s * bessel_i0_and_slope(self.beta).0)
    }

    /// `φ` and `dφ/dx` at `x` sample spacings.
    pub(super) fn value_and_slope(&self, x: f64) -> (f64, f64) {
        let w = SPREAD as f64;
        let inside = 1.0 - (2.0 * x / w).powi(2);
        if inside < 0.0 {
            return (0.0, 0.0);
        }
        let scale = bessel_i0_and_slope(self.beta).0;
        let (value, slope_over_z) = bessel_i0_and_slope(self.beta * inside.sqrt());
        // dφ/dx = I₁(z) dz/dx with z = β√inside: dz/dx = −β² 4x/(w² z).
        let slope = -slope_over_z * self.beta * self.beta * 4.0 * x / (w * w);
        (value / scale, slope / scale)
    }
}

/// Modified Bessel function `I₀(z)` and `I₁(z)/z`, by their series.
fn bessel_i0_and_slope(z: f64) -> (f64, f64) {
    let quarter = z * z / 4.0;
    let (mut i0, mut i1_over_z) = (0.0, 0.0);
    let mut term = 1.0;
    let mut k = 0.0;
    while term > 1e-20 * i0 {
        i0 += term;
        i1_over_z += 0.5 * term / (k + 1.0);
        k += 1.0;
        term *= quarter / (k * k);
    }
    (i0, i1_over_z)
}
