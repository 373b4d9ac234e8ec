//! What to know before trusting the numbers of a record.

use super::{Analysis, Component, Interval, Record};
use crate::statistics::student_t_95;
use crate::units::{Dimension, shortest};
use std::fmt;

/// Blocks a record should have, each of 25 integral times or more.
pub(super) const BLOCKS: (usize, usize) = (8, 64);
/// Integral times a block should last.
pub(super) const BLOCK_TIMES: f64 = 40.0;

/// Change of a quantity over the record, from a straight line through its blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trend {
    /// From the start of the record to its end, with its 95 % interval [m/s].
    pub change: Interval,
    /// Whether it is beyond what the scatter of the blocks explains: 3.5 standard errors.
    pub significant: bool,
}

impl Trend {
    /// Of a quantity in evenly spaced blocks.
    pub(super) fn of(values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let place = |i: usize| (i as f64 + 0.5) / count - 0.5;
        let spread: f64 = (0..values.len()).map(|i| place(i) * place(i)).sum();
        let change = values.iter().enumerate().map(|(i, y)| place(i) * y).sum::<f64>() / spread;
        let residual = |(i, y): (usize, &f64)| y - mean - change * place(i);
        let squares: f64 = values.iter().enumerate().map(|pair| residual(pair).powi(2)).sum();
        let error = (squares / (count - 2.0) / spread).sqrt();
        let half = student_t_95((values.len() as u64).saturating_sub(2)) * error;
        Self {
            change: Interval { value: change, low: change - half, high: change + half },
            significant: change.abs() > 3.5 * error,
        }
    }
}

/// Something about a record that the reader of its numbers should know.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// Missing samples were filled in.
    Filled {
        /// Share of all samples.
        share: f64,
    },
    /// Only a few integral times.
    TooShort {
        /// How many the record lasts.
        integral_times: f64,
        /// Length that would do [s].
        wanted: f64,
    },
    /// The autocorrelation stays above the rule's level.
    NoLimit {
        /// Component.
        component: String,
        /// Longest lag looked at [s].
        lag: f64,
    },
    /// The mean drifts.
    MeanDrifts {
        /// Component.
        component: String,
        /// Change over the record and its error [m/s].
        change: Interval,
        /// Rms of the fluctuation [m/s].
        rms: f64,
    },
    /// The rms drifts.
    RmsDrifts {
        /// Component.
        component: String,
        /// Change over the record and its error [m/s].
        change: Interval,
        /// Rms of the fluctuation [m/s].
        rms: f64,
    },
    /// Samples pile up at an extreme value.
    Clipped {
        /// Component.
        component: String,
        /// How many.
        samples: usize,
        /// Where [m/s].
        at: f64,
    },
    /// The spectrum has not fallen at half the sampling rate.
    Aliased {
        /// Component.
        component: String,
        /// Density there over the plateau.
        share: f64,
        /// Half the sampling rate [Hz].
        highest: f64,
    },
    /// The integral time is no longer than two samples.
    Unresolved {
        /// Component.
        component: String,
        /// [s]
        integral_time: f64,
        /// [s]
        interval: f64,
    },
    /// One frequency holds much of the energy.
    Periodic {
        /// Component.
        component: String,
        /// [Hz]
        frequency: f64,
        /// Share of the variance.
        share: f64,
    },
    /// The spectrum is too coarse to tell where it is flat.
    CoarseSpectrum {
        /// Component.
        component: String,
        /// Where the part averaged ends [Hz].
        until: f64,
        /// Cut-off [Hz].
        cutoff: f64,
    },
    /// The two integral times differ beyond their errors.
    TimesDiffer {
        /// Component.
        component: String,
        /// From the autocorrelation [s].
        autocorrelation: f64,
        /// From the plateau of the spectrum [s].
        plateau: f64,
    },
    /// Too turbulent for Taylor's hypothesis.
    Turbulent {
        /// Turbulence intensity.
        intensity: f64,
    },
    /// A cross component has a mean.
    Misaligned {
        /// Component.
        component: String,
        /// Angle to the flow [°].
        degrees: f64,
    },
    /// The components differ in rms.
    Anisotropic {
        /// Smallest rms over largest.
        ratio: f64,
    },
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let time = |s: f64| Dimension::Time.pretty_to(s, 3);
        let hertz = |s: f64| Dimension::Frequency.pretty_to(s, 3);
        let number = |x: f64| shortest(format!("{x:.2e}").parse().unwrap_or(x));
        match self {
            Self::Filled { share } => {
                write!(
                    f,
                    "{} % of the samples were missing and lie on straight lines between their neighbours",
                    number(100.0 * share)
                )
            }
            Self::TooShort { integral_times, wanted } => write!(
                f,
                "the record lasts {} integral times only: the intervals themselves are uncertain; measure for {} or longer",
                number(*integral_times),
                time(*wanted)
            ),
            Self::NoLimit { component, lag } => write!(
                f,
                "{component}: the autocorrelation does not fall far enough within {}, a quarter of the record at most: \
                 the integral time is a lower bound; take off the drift or measure for longer",
                time(*lag)
            ),
            Self::MeanDrifts { component, change, rms } => write!(
                f,
                "{component}: the mean drifts by {} ± {} m/s over the record ({} of the rms), which lengthens the \
                 integral time and lifts the plateau; take the drift off or cut the record",
                number(change.value),
                number(0.5 * (change.high - change.low)),
                number(change.value.abs() / rms)
            ),
            Self::RmsDrifts { component, change, rms } => write!(
                f,
                "{component}: the rms drifts by {} ± {} m/s over the record, from {} m/s on average: the flow was not steady",
                number(change.value),
                number(0.5 * (change.high - change.low)),
                number(*rms)
            ),
            Self::Clipped { component, samples, at } => write!(
                f,
                "{component}: {samples} samples are all {} m/s, the extreme of the record: the instrument seems to \
                 clip there, and the rms is too small; measure with a wider range",
                number(*at)
            ),
            Self::Aliased { component, share, highest } => write!(
                f,
                "{component}: at half the sampling rate, {}, the spectrum is still {} of its plateau: what is faster \
                 is folded back into it; sample faster, or with a low-pass filter before",
                hertz(*highest),
                number(*share)
            ),
            Self::Unresolved { component, integral_time, interval } => write!(
                f,
                "{component}: the integral time of {} is hardly longer than the {} between samples: one sample knows \
                 little of the next; sample faster",
                time(*integral_time),
                time(*interval)
            ),
            Self::Periodic { component, frequency, share } => write!(
                f,
                "{component}: {} % of the variance is at one frequency, {}: a tone, shed vortices or the mains, not \
                 turbulence",
                number(100.0 * share),
                hertz(*frequency)
            ),
            Self::CoarseSpectrum { component, until, cutoff } => write!(
                f,
                "{component}: the spectrum is averaged up to {} for a cut-off of {}, too coarse to be sure that it is \
                 flat so far; measure for longer, or give longer segments",
                hertz(*until),
                hertz(*cutoff)
            ),
            Self::TimesDiffer { component, autocorrelation, plateau } => write!(
                f,
                "{component}: the integral time is {} by the autocorrelation and {} by the plateau of the spectrum: \
                 the autocorrelation has more than one sign, or the record drifts; look at both figures",
                time(*autocorrelation),
                time(*plateau)
            ),
            Self::Turbulent { intensity } => write!(
                f,
                "with a turbulence intensity of {} the length scale by Taylor’s hypothesis is an estimate only, and a \
                 single hot wire does not see reversed flow",
                number(*intensity)
            ),
            Self::Misaligned { component, degrees } => write!(
                f,
                "{component}: the mean flow is turned by {}° into this direction; is the probe aligned?",
                number(*degrees)
            ),
            Self::Anisotropic { ratio } => write!(
                f,
                "the smallest rms of the components is {} of the largest; the simulated turbulence is isotropic, with \
                 the mean of their energies",
                number(*ratio)
            ),
        }
    }
}

/// Everything there is to say about a record and its analysis.
pub(super) fn warnings(record: &Record, analysis: &Analysis) -> Vec<Warning> {
    let mut found = Vec::new();
    let numbers = (record.samples() * record.components.len()) as f64;
    let share = record.reading.filled as f64 / numbers;
    if share > 0.001 {
        found.push(Warning::Filled { share });
    }
    let longest = analysis.components.iter().map(Component::block_time).fold(0.0, f64::max);
    if analysis.duration < BLOCKS.0 as f64 * longest {
        let integral_time = analysis.integral_time.value;
        let (integral_times, wanted) = (analysis.duration / integral_time, BLOCKS.0 as f64 * longest);
        found.push(Warning::TooShort { integral_times, wanted });
    }
    for (component, samples) in analysis.components.iter().zip(&record.components) {
        of_component(component, &samples.values, analysis.interval, &mut found);
    }
    let intensity = analysis.turbulence_intensity.value;
    if intensity > 0.3 {
        found.push(Warning::Turbulent { intensity });
    }
    for component in analysis.components.iter().skip(1) {
        let slope = component.mean.value.abs() / analysis.mean_velocity.value.abs();
        if slope > 0.05 {
            let degrees = libm::atan(slope).to_degrees();
            found.push(Warning::Misaligned { component: component.name.clone(), degrees });
        }
    }
    let rms = || analysis.components.iter().map(|c| c.rms.value);
    let ratio = rms().fold(f64::INFINITY, f64::min) / rms().fold(0.0, f64::max);
    if ratio < 0.8 {
        found.push(Warning::Anisotropic { ratio });
    }
    found
}

fn of_component(of: &Component, values: &[f64], interval: f64, found: &mut Vec<Warning>) {
    let component = || of.name.clone();
    if !of.autocorrelation.limit_found {
        found.push(Warning::NoLimit { component: component(), lag: of.autocorrelation.limit });
    }
    let rms = of.rms.value;
    if of.mean_trend.significant && of.mean_trend.change.value.abs() > 0.1 * rms {
        found.push(Warning::MeanDrifts { component: component(), change: of.mean_trend.change, rms });
    }
    if of.rms_trend.significant && of.rms_trend.change.value.abs() > 0.1 * rms {
        found.push(Warning::RmsDrifts { component: component(), change: of.rms_trend.change, rms });
    }
    for sign in [1.0, -1.0] {
        if let Some((samples, at)) = clipped(values, sign) {
            found.push(Warning::Clipped { component: component(), samples, at });
        }
    }
    let top = of.spectrum.density.len().div_ceil(10);
    let end = &of.spectrum.density[of.spectrum.density.len() - top..];
    let share = end.iter().sum::<f64>() / top as f64 / of.flat.density.value;
    if share > 0.05 {
        found.push(Warning::Aliased { component: component(), share, highest: of.spectrum.highest() });
    }
    let integral_time = of.integral_time.value;
    if integral_time < 2.0 * interval {
        found.push(Warning::Unresolved { component: component(), integral_time, interval });
    }
    let tone = tone(&of.spectrum.density);
    if let Some((entry, share)) = tone {
        let frequency = of.spectrum.frequency(entry);
        found.push(Warning::Periodic { component: component(), frequency, share });
    }
    if of.flat.coarse {
        let (until, cutoff) = (of.flat.until, of.flat.cutoff.value);
        found.push(Warning::CoarseSpectrum { component: component(), until, cutoff });
    }
    // Both errors at once, and what the rule is known to leave out.
    let plateau = of.flat.integral_time();
    let apart = libm::log(plateau / integral_time).abs();
    let either = of.flat.cutoff.relative().hypot(of.integral_time.relative());
    if tone.is_none() && !of.flat.coarse && apart > 1.5 * either && apart > 0.1 {
        found.push(Warning::TimesDiffer { component: component(), autocorrelation: integral_time, plateau });
    }
}

/// Samples at the extreme value, if far more than at the next one to it.
fn clipped(values: &[f64], sign: f64) -> Option<(usize, f64)> {
    let (mut first, mut second) = ((f64::NEG_INFINITY, 0), (f64::NEG_INFINITY, 0));
    for value in values.iter().map(|x| sign * x) {
        if value > first.0 {
            (second, first) = (first, (value, 1));
        } else if value == first.0 {
            first.1 += 1;
        } else if value > second.0 {
            second = (value, 1);
        } else if value == second.0 {
            second.1 += 1;
        }
    }
    (first.1 >= 5 && first.1 > 4 * second.1).then_some((first.1, sign * first.0))
}

/// The entry of the highest peak and its share of the variance, if it stands out of its surroundings.
fn tone(density: &[f64]) -> Option<(usize, f64)> {
    let peak = (0..density.len()).max_by(|a, b| density[*a].total_cmp(&density[*b]))?;
    let near = |from: usize, to: usize| density.iter().skip(from).take(to.saturating_sub(from));
    let around: Vec<f64> = near(peak.saturating_sub(10), peak.saturating_sub(3))
        .chain(near(peak + 4, peak + 11))
        .copied()
        .collect();
    let level = around.iter().sum::<f64>() / around.len() as f64;
    let line: f64 = near(peak.saturating_sub(2), peak + 3).sum();
    let share = line / density.iter().sum::<f64>();
    (!around.is_empty() && density[peak] > 20.0 * level && share > 0.1).then_some((peak, share))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_trend_of_a_straight_line() {
        let values: Vec<f64> = (0..10).map(|i| 3.0 + 0.2 * f64::from(i)).collect();
        let trend = Trend::of(&values);
        assert!((trend.change.value - 2.0).abs() < 1e-12 && trend.significant);
        assert!(!Trend::of(&[1.0, 2.0, 1.0, 2.0, 1.0, 2.0, 1.0, 2.0]).significant);
    }

    #[test]
    fn piles_at_an_extreme_are_clipping() {
        let swing = |i: u32| 3.0 * f64::from(i * i % 997) / 997.0;
        let whole: Vec<f64> = (0..3000).map(swing).collect();
        assert_eq!(
            clipped(&whole.iter().map(|x| x.min(2.5)).collect::<Vec<_>>(), 1.0).map(|c| c.1),
            Some(2.5)
        );
        assert_eq!(
            clipped(&whole.iter().map(|x| x.max(0.5)).collect::<Vec<_>>(), -1.0).map(|c| c.1),
            Some(0.5)
        );
    }
}
