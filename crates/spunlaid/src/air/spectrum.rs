//! Energy spectra of the velocity fluctuation.

use std::f64::consts::PI;

/// One-sided energy spectrum `E(ω)` of a velocity component, flat up to the cut-off, nothing above.
///
/// `∫ E dω = u²`.                                                             theory.md (15)
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spectrum {
    rms: f64,
    cutoff: f64,
}

impl Spectrum {
    /// Flat: `E = u²/ω_c` for `ω ≤ ω_c`, from the rms `u` [m/s] and the cut-off frequency [Hz].
    pub const fn flat(rms: f64, cutoff_frequency: f64) -> Self {
        Self { rms, cutoff: cutoff_frequency }
    }

    /// Cut-off frequency [Hz].
    pub const fn cutoff_frequency(&self) -> f64 {
        self.cutoff
    }

    /// Energy per angular frequency `E(ω)` [(m/s)²/(rad/s)].
    pub fn energy(&self, omega: f64) -> f64 {
        let cutoff = 2.0 * PI * self.cutoff;
        if omega <= cutoff { self.rms * self.rms / cutoff } else { 0.0 }
    }

    /// Amplitude `A_n = √(E(ω_n) Δω)` [m/s] of harmonic `n` of `count`, `ω_n = (n+½)Δω`.  theory.md (17)
    pub fn amplitude(&self, n: usize, count: usize) -> f64 {
        let step = 2.0 * PI * self.cutoff / count as f64;
        (self.energy((n as f64 + 0.5) * step) * step).sqrt()
    }

    /// Integral time of the fluctuation, `¼/f` for the flat spectrum [s].    theory.md (20)
    pub fn integral_time(&self) -> f64 {
        0.25 / self.cutoff
    }
}
