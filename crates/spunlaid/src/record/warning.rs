//! Warnings about a record and its results.

use super::Interval;
use crate::statistics::student_t_95;
use crate::units::{Dimension, shortest};
use std::fmt;

/// Change of a quantity over the record, by a straight line through its values in the blocks.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Trend {
    /// From the start of the record to its end, with its 95 % interval [m/s].
    pub change: Interval,
    /// Whether the change is more than 3.5 standard errors.
    pub significant: bool,
}

impl Trend {
    /// The trend of a quantity, given its value in each block.
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

/// Something that the reader of the results should know.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Warning {
    /// Missing samples were interpolated.
    Filled {
        /// Share of all samples.
        share: f64,
    },
    /// The record lasts only a few integral times.
    TooShort {
        /// Length of the record in integral times.
        integral_times: f64,
        /// Length that is enough [s].
        wanted: f64,
    },
    /// The autocorrelation does not reach the level of the rule.
    NoLimit {
        /// Component.
        component: String,
        /// Longest lag computed [s].
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
    /// Samples that are far from all others, and from their neighbours.
    Outlier {
        /// Component.
        component: String,
        /// Row of the data of the one farthest off, from 1.
        row: usize,
        /// Time since the first sample [s].
        time: f64,
        /// Its value [m/s].
        value: f64,
        /// Distance from the median in standard deviations, these estimated without the outliers.
        deviations: f64,
        /// Number of such samples.
        samples: usize,
    },
    /// Many samples have the same extreme value.
    Clipped {
        /// Component.
        component: String,
        /// Number of such samples.
        samples: usize,
        /// The value [m/s].
        at: f64,
    },
    /// The spectrum is still high at half the sampling rate.
    Aliased {
        /// Component.
        component: String,
        /// Density at that frequency over the plateau.
        share: f64,
        /// Half the sampling rate [Hz].
        highest: f64,
    },
    /// The integral time is shorter than two sampling intervals.
    Unresolved {
        /// Component.
        component: String,
        /// [s]
        integral_time: f64,
        /// [s]
        interval: f64,
    },
    /// One frequency has a large share of the energy.
    Periodic {
        /// Component.
        component: String,
        /// [Hz]
        frequency: f64,
        /// Share of the variance.
        share: f64,
    },
    /// The steps of frequency are too coarse to find the flat part of the spectrum.
    CoarseSpectrum {
        /// Component.
        component: String,
        /// End of the part averaged [Hz].
        until: f64,
        /// Cut-off [Hz].
        cutoff: f64,
    },
    /// The two integral times differ by more than their errors.
    TimesDiffer {
        /// Component.
        component: String,
        /// From the autocorrelation [s].
        autocorrelation: f64,
        /// From the plateau of the spectrum [s].
        plateau: f64,
    },
    /// The turbulence intensity is too high for Taylor's hypothesis.
    Turbulent {
        /// Turbulence intensity.
        intensity: f64,
    },
    /// A component across the flow has a mean.
    Misaligned {
        /// Component.
        component: String,
        /// Angle to the flow [°].
        degrees: f64,
    },
    /// The components have different rms.
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
                    "{} % of the samples were missing; they were interpolated linearly",
                    number(100.0 * share)
                )
            }
            Self::TooShort { integral_times, wanted } => write!(
                f,
                "the record lasts only {} integral times, so that the confidence intervals are uncertain; measure for {} or longer",
                number(*integral_times),
                time(*wanted)
            ),
            Self::NoLimit { component, lag } => write!(
                f,
                "{component}: the autocorrelation does not fall far enough within {}, so that the integral time is a \
                 lower bound; remove the drift or measure for longer",
                time(*lag)
            ),
            Self::MeanDrifts { component, change, rms } => write!(
                f,
                "{component}: the mean drifts by {} ± {} m/s over the record ({} of the rms), which makes the \
                 integral time and the plateau too large; remove the drift or cut the record",
                number(change.value),
                number(0.5 * (change.high - change.low)),
                number(change.value.abs() / rms)
            ),
            Self::RmsDrifts { component, change, rms } => write!(
                f,
                "{component}: the rms drifts by {} ± {} m/s over the record (mean {} m/s): the flow was not steady",
                number(change.value),
                number(0.5 * (change.high - change.low)),
                number(*rms)
            ),
            Self::Outlier { component, row, time: at, value, deviations, samples } => write!(
                f,
                "{component}: {} in data row {row} (at {}) is {} standard deviations from the median{}; such a spike is \
                 not turbulence and spoils every result: leave the cell empty and run the analysis again",
                format_args!("{} m/s", number(*value)),
                time(*at),
                number(*deviations),
                if *samples > 1 { format!(", the farthest of {samples} outliers") } else { String::new() }
            ),
            Self::Clipped { component, samples, at } => write!(
                f,
                "{component}: {samples} samples are all {} m/s, the extreme of the record: the instrument seems to \
                 clip at this value, which makes the rms too small; measure with a wider range",
                number(*at)
            ),
            Self::Aliased { component, share, highest } => write!(
                f,
                "{component}: at half the sampling rate, {}, the spectrum is still {} of its plateau: higher \
                 frequencies are aliased into it; sample faster, or use a low-pass filter before sampling",
                hertz(*highest),
                number(*share)
            ),
            Self::Unresolved { component, integral_time, interval } => write!(
                f,
                "{component}: the integral time of {} is hardly longer than the {} between samples, so that the samples \
                 are nearly uncorrelated; sample faster",
                time(*integral_time),
                time(*interval)
            ),
            Self::Periodic { component, frequency, share } => write!(
                f,
                "{component}: {} % of the variance is at one frequency, {}: this is a tone (shed vortices, a fan, the \
                 mains) and not turbulence",
                number(100.0 * share),
                hertz(*frequency)
            ),
            Self::CoarseSpectrum { component, until, cutoff } => write!(
                f,
                "{component}: the plateau is the mean of the spectrum up to {}, but the cut-off is {}; the spectrum may not \
                 be flat so far; measure for longer, or use longer segments",
                hertz(*until),
                hertz(*cutoff)
            ),
            Self::TimesDiffer { component, autocorrelation, plateau } => write!(
                f,
                "{component}: the integral time is {} by the autocorrelation and {} by the plateau of the spectrum: \
                 either the autocorrelation becomes negative or the record drifts; look at both figures",
                time(*autocorrelation),
                time(*plateau)
            ),
            Self::Turbulent { intensity } => write!(
                f,
                "with a turbulence intensity of {} the length scale by Taylor’s hypothesis is only an estimate, and a \
                 single hot wire does not measure reversed flow",
                number(*intensity)
            ),
            Self::Misaligned { component, degrees } => write!(
                f,
                "{component}: the mean flow is inclined by {}° in this direction; is the probe aligned?",
                number(*degrees)
            ),
            Self::Anisotropic { ratio } => write!(
                f,
                "the smallest rms of the components is {} of the largest; the simulated turbulence is isotropic and has \
                 the mean of their energies",
                number(*ratio)
            ),
        }
    }
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
}
