//! Energy spectra of the velocity fluctuation.

use super::FileContent;
use std::f64::consts::PI;

/// How the energy of the fluctuation spreads over frequency. The variance is the same whatever the shape.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum SpectrumShape {
    /// The same at all frequencies up to the cut-off.                        theory.md (15)
    #[default]
    Flat,
    /// Von Kármán's for isotropic turbulence, along and across the mean flow, up to the cut-off.
    /// theory.md (46)
    VonKarman,
    /// As measured, up to the cut-off.
    Measured(FileContent<SpectrumTable>),
}

impl SpectrumShape {
    /// Name in the case file.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::VonKarman => "von-karman",
            Self::Measured(_) => "measured",
        }
    }
}

/// A spectrum as a table. It is linear between its points and zero outside.
#[derive(Clone, Debug, PartialEq)]
pub struct SpectrumTable {
    /// Frequencies, rising [Hz].
    pub frequency: Vec<f64>,
    /// Energy at each frequency; only the shape matters.
    pub energy: Vec<f64>,
}

impl SpectrumTable {
    fn energy(&self, frequency: f64) -> f64 {
        linear(&self.frequency, &self.energy, frequency).unwrap_or(0.0)
    }

    /// The highest frequency [Hz].
    pub fn highest(&self) -> f64 {
        self.frequency.last().copied().unwrap_or(0.0)
    }
}

/// Linear interpolation at `x`; `None` outside the points.
///
/// * `xs` – rising
pub(super) fn linear(xs: &[f64], ys: &[f64], x: f64) -> Option<f64> {
    let above = xs.partition_point(|known| *known <= x);
    let upper = if above == xs.len() && xs.last() == Some(&x) { above - 1 } else { above };
    let lower = upper.checked_sub(1).or((xs.first() == Some(&x)).then_some(0))?;
    let (x0, x1) = (*xs.get(lower)?, *xs.get(upper)?);
    let (y0, y1) = (*ys.get(lower)?, *ys.get(upper)?);
    Some(if x1 > x0 { y0 + (y1 - y0) * ((x - x0) / (x1 - x0)) } else { y0 })
}

/// Number of harmonics up to a cut-off frequency; at least one.
pub(super) fn harmonics_up_to(cutoff: f64, spacing: f64) -> usize {
    ((cutoff / spacing).round() as usize).max(1)
}

/// One-sided energy spectrum `E(ω)` of a velocity component. It is zero above the cut-off frequency.
///
/// `∫ E dω = u²`; if the shape is not flat, the sum over the harmonics replaces the integral.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum<'a> {
    shape: &'a SpectrumShape,
    /// Variance of a harmonic per relative energy of the shape [(m/s)²].
    level: f64,
    cutoff: f64,
    spacing: f64,
    integral_time: f64,
    component: usize,
}

impl<'a> Spectrum<'a> {
    /// * `rms` – of the component [m/s]
    /// * `cutoff_frequency` – [Hz]
    /// * `integral_time` – of the component along the flow [s]; only the von Kármán spectrum depends on it
    /// * `component` – 0 along the mean flow, 1 and 2 across it
    /// * `spacing` – of the harmonics that the variance is divided among [Hz]
    pub(crate) fn new(
        shape: &'a SpectrumShape,
        rms: f64,
        cutoff_frequency: f64,
        integral_time: f64,
        component: usize,
        spacing: f64,
    ) -> Self {
        let mut spectrum =
            Self { shape, level: 1.0, cutoff: cutoff_frequency, spacing, integral_time, component };
        let count = spectrum.harmonics();
        let sum = match shape {
            SpectrumShape::Flat => count as f64,
            _ => (0..count).map(|n| spectrum.relative(spectrum.frequency(n))).sum(),
        };
        // A shape may have no energy below the cut-off.
        spectrum.level = if sum > 0.0 { rms * rms / sum } else { 0.0 };
        spectrum
    }

    /// Number of harmonics up to the cut-off.
    fn harmonics(&self) -> usize {
        harmonics_up_to(self.cutoff, self.spacing)
    }

    fn frequency(&self, n: usize) -> f64 {
        (n as f64 + 0.5) * self.spacing
    }

    /// Amplitudes `A_n = √(E(ω_n) Δω)` [m/s] of the harmonics up to the cut-off, `ω_n = (n+½)Δω`; their
    /// squares add up to `u²`.                                                theory.md (17)
    pub(crate) fn amplitudes(&self) -> Vec<f64> {
        (0..self.harmonics()).map(|n| (self.level * self.relative(self.frequency(n))).sqrt()).collect()
    }

    /// Energy per angular frequency `E(ω)` [(m/s)²/(rad/s)].
    pub fn energy(&self, omega: f64) -> f64 {
        let frequency = omega / (2.0 * PI);
        if frequency > self.cutoff {
            return 0.0;
        }
        self.level * self.relative(frequency) / (2.0 * PI * self.spacing)
    }

    /// The shape without the level: 1 at the plateau, or the table's value.
    fn relative(&self, frequency: f64) -> f64 {
        match self.shape {
            SpectrumShape::Flat => 1.0,
            SpectrumShape::VonKarman => {
                let squared = (frequency * self.integral_time).powi(2);
                if self.component == 0 {
                    libm::pow(1.0 + 70.8 * squared, -5.0 / 6.0)
                } else {
                    0.5 * (1.0 + 188.8 * squared) * libm::pow(1.0 + 70.8 * squared, -11.0 / 6.0)
                }
            }
            SpectrumShape::Measured(table) => table.energy(frequency),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::linear;

    #[test]
    fn analytic_straight_lines_between_points() {
        let (xs, ys) = ([1.0, 2.0, 4.0], [0.0, 10.0, 30.0]);
        for (x, y) in [
            (0.5, None),
            (1.0, Some(0.0)),
            (1.5, Some(5.0)),
            (2.0, Some(10.0)),
            (3.0, Some(20.0)),
            (4.0, Some(30.0)),
            (4.1, None),
        ] {
            assert_eq!(linear(&xs, &ys, x), y, "{x}");
        }
    }
}
