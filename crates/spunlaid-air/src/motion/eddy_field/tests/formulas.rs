//! The closed formulas of the model.

use super::{LATERAL, LENGTH, SPEED};
use std::f64::consts::TAU;

/// `K_ν(x) = ∫₀^∞ e^(−x cosh t) cosh νt dt`, by the trapezoidal rule, which is exact to rounding here.
pub(super) fn bessel_k(order: f64, x: f64) -> f64 {
    let step = 0.01;
    let value = |t: f64| (-x * t.cosh()).exp() * (order * t).cosh();
    step * (0.5 * value(0.0) + (1..1200).map(|i| value(step * f64::from(i))).sum::<f64>())
}

/// `2^(1−a)/Γ(a) · s^a K_a(s)`
fn matern(order: f64, s: f64) -> f64 {
    if s == 0.0 {
        1.0
    } else {
        2_f64.powf(1.0 - order) / libm::tgamma(order) * s.powf(order) * bessel_k(order, s)
    }
}

/// Coherence at a frequency [Hz] and a lateral distance [m]: of x, of the component along the distance, and
/// of the other.
pub(super) fn coherence(frequency: f64, r: f64) -> [f64; 3] {
    let (k1, ke) = (TAU * frequency / SPEED, 0.746_834 / LENGTH);
    let square = k1 * k1 + ke * ke;
    let s = square.sqrt() * r;
    let (five, eleven) = (matern(5.0 / 6.0, s), matern(11.0 / 6.0, s));
    let m = 2_f64.powf(1.0 / 6.0) / libm::tgamma(5.0 / 6.0) * s.powf(11.0 / 6.0) * bessel_k(1.0 / 6.0, s);
    let whole = k1 * k1 + 0.6 * square;
    [
        11.0 / 6.0 * five - 5.0 / 6.0 * eleven,
        (k1 * k1 * eleven + 0.6 * square * five) / whole,
        (k1 * k1 * eleven + 0.6 * square * (five - m)) / whole,
    ]
}

/// Cross-spectra of the components at places that lie `apart` [m], over their spectra: the sum of (79) over
/// the waves across up to the cut-off, in polar coordinates.
pub(super) fn cross_spectra(frequency: f64, apart: [f64; 3]) -> [[f64; 3]; 3] {
    const RINGS: usize = 120;
    const ANGLES: usize = 96;
    let (k1, ke) = (-TAU * frequency / SPEED, 0.746_834 / LENGTH);
    let (mut products, mut squares) = ([[0.0; 3]; 3], [0.0; 3]);
    for ring in 0..RINGS {
        let radius = (ring as f64 + 0.5) / RINGS as f64 * LATERAL / LENGTH;
        let square = k1 * k1 + radius * radius;
        let energy = radius * square * (square + ke * ke).powf(-17.0 / 6.0);
        for angle in 0..ANGLES {
            let (sin, cos) = (TAU * angle as f64 / ANGLES as f64).sin_cos();
            let k = [k1, radius * cos, radius * sin];
            let phase = (0..3).map(|i| k[i] * apart[i]).sum::<f64>();
            for i in 0..3 {
                squares[i] += energy * (1.0 - k[i] * k[i] / square);
                for j in 0..3 {
                    let kept = if i == j { 1.0 } else { 0.0 } - k[i] * k[j] / square;
                    products[i][j] += energy * kept * phase.cos();
                }
            }
        }
    }
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| products[i][j] / (squares[i] * squares[j]).sqrt()))
}

/// Correlations in von Kármán's turbulence without a cut-off, across and along the distance `r` [m]: `g` and `f`.
pub(super) fn von_karman(r: f64) -> [f64; 2] {
    let q = 0.746_834 * r / LENGTH;
    let factor = 2_f64.powf(2.0 / 3.0) / libm::tgamma(1.0 / 3.0) * q.powf(1.0 / 3.0);
    let [one, two] = [1.0, 2.0].map(|thirds| bessel_k(thirds / 3.0, q));
    [factor * (one - 0.5 * q * two), factor * one]
}

/// Von Kármán's power of x, y and z at a frequency.                                              theory.md (46)
fn powers(frequency: f64) -> [f64; 3] {
    let square = (frequency * LENGTH / SPEED).powi(2);
    let across = 0.5 * (1.0 + 188.8 * square) * (1.0 + 70.8 * square).powf(-11.0 / 6.0);
    [(1.0 + 70.8 * square).powf(-5.0 / 6.0), across, across]
}

/// The mean over von Kármán's spectra up to a frequency [Hz] of what two components have in common at each.
pub(super) fn over_spectra(highest: f64, count: u32, common: impl Fn(f64) -> [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    let (mut products, mut squares) = ([[0.0; 3]; 3], [0.0; 3]);
    for n in 0..count {
        // Ever longer steps.
        let [start, end] = [n, n + 1].map(|n| highest * (f64::from(n) / f64::from(count)).powi(3));
        let frequency = 0.5 * (start + end);
        let (powers, common) = (powers(frequency), common(frequency));
        for i in 0..3 {
            squares[i] += (end - start) * powers[i];
            (0..3).for_each(|j| {
                products[i][j] += (end - start) * (powers[i] * powers[j]).sqrt() * common[i][j]
            });
        }
    }
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| products[i][j] / (squares[i] * squares[j]).sqrt()))
}

/// Correlation of what is looked up between generations, `walk` from one to the next: at the share `from` of
/// the way to the next generation and at the share `to` of that from the generation `later`.
///                                                                                             theory.md (82)
pub(super) fn between_generations(walk: f64, [from, to]: [f64; 2], later: i32) -> f64 {
    let square = |share: f64| (1.0 - share).powi(2) + share * share + 2.0 * share * (1.0 - share) * walk;
    let at = |steps: i32| walk.powi(steps.abs());
    let same = (1.0 - from) * (1.0 - to) + from * to;
    let products = same * at(later) + (1.0 - from) * to * at(later + 1) + from * (1.0 - to) * at(later - 1);
    products / (square(from) * square(to)).sqrt()
}
