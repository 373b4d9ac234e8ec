//! Warnings about a record and its results.

use super::{Analysis, Component, Interval, Record};
use crate::statistics::{median, student_t_95};
use crate::units::{Dimension, shortest};
use std::fmt;

/// Fewest and most blocks of a record.
pub(super) const BLOCKS: (usize, usize) = (8, 64);
/// Length of a block in integral times.
pub(super) const BLOCK_TIMES: f64 = 40.0;

/// Standard deviations from the median beyond which a sample may be an outlier.
const OUTLIER: f64 = 12.0;
/// Largest number of samples that are sorted to find the median.
const MOST_RANKED: usize = 1 << 16;

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

/// All warnings about a record and its analysis.
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
        if let Some((sample, deviations, count)) = outlier(&samples.values) {
            found.push(Warning::Outlier {
                component: component.name.clone(),
                row: record.reading.cut_off_start + sample + 1,
                time: sample as f64 * analysis.interval,
                value: samples.values[sample],
                deviations,
                samples: count,
            });
        }
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
    // More than both errors explain, and more than the systematic difference of the rules.
    let plateau = of.flat.integral_time();
    let apart = libm::log(plateau / integral_time).abs();
    let either = of.flat.cutoff.relative().hypot(of.integral_time.relative());
    if tone.is_none() && !of.flat.coarse && apart > 1.5 * either && apart > 0.1 {
        found.push(Warning::TimesDiffer { component: component(), autocorrelation: integral_time, plateau });
    }
}

/// The sample farthest off the others, its distance in standard deviations, and the number of such samples. Resolved
/// turbulence rises over several samples, so that an outlier also differs from a neighbour by half its distance.
fn outlier(values: &[f64]) -> Option<(usize, f64, usize)> {
    let some: Vec<f64> = values.iter().copied().step_by(values.len().div_ceil(MOST_RANKED)).collect();
    let middle = median(&some);
    let distances: Vec<f64> = some.iter().map(|x| (x - middle).abs()).collect();
    // The median distance of a Gaussian is 0.6745 standard deviations.
    let deviation = median(&distances) / 0.6745;
    let far = |i: usize| (values[i] - middle).abs();
    let leaps = |i: usize, j: usize| values.get(j).is_some_and(|x| (values[i] - x).abs() > 0.5 * far(i));
    let all = (0..values.len())
        .filter(|i| far(*i) > OUTLIER * deviation && (leaps(*i, i.wrapping_sub(1)) || leaps(*i, i + 1)));
    let (count, farthest) = all.fold((0, None), |(count, farthest), i| {
        (count + 1, farthest.filter(|j| far(*j) >= far(i)).or(Some(i)))
    });
    farthest.filter(|_| deviation > 0.0).map(|i| (i, far(i) / deviation, count))
}

/// Number of samples at the extreme value and the value, if far more samples have it than the value next to it.
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

/// The entry of the highest peak and its share of the variance, if it is far above its surroundings.
fn tone(density: &[f64]) -> Option<(usize, f64)> {
    let peak = (0..density.len()).max_by(|a, b| density[*a].total_cmp(&density[*b]))?;
    let near = |from: usize, to: usize| density.iter().skip(from).take(to.saturating_sub(from));
    // Both sides count: at its lowest frequencies the spectrum of any turbulence is far above the frequencies after them.
    let below: Vec<f64> = near(peak.saturating_sub(10), peak.saturating_sub(2)).copied().collect();
    let above: Vec<f64> = near(peak + 4, peak + 11).copied().collect();
    let mean = |side: &[f64]| side.iter().sum::<f64>() / side.len() as f64;
    let level =
        [below, above].iter().filter(|side| !side.is_empty()).map(|side| mean(side)).fold(0.0, f64::max);
    let seen = peak > 2;
    let line: f64 = near(peak.saturating_sub(2), peak + 3).sum();
    let share = line / density.iter().sum::<f64>();
    (seen && density[peak] > 20.0 * level && share > 0.1).then_some((peak, share))
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
    fn a_spike_is_an_outlier_and_a_gust_is_not() {
        let at = |i: usize| 10.0 + (i as f64 * 0.7).sin() + (i as f64 * 0.13).cos();
        let mut values: Vec<f64> = (0..20_000).map(at).collect();
        assert_eq!(outlier(&values), None);
        values[7000] = 1e4;
        values[9000] = -300.0;
        assert_eq!(outlier(&values).map(|(sample, _, count)| (sample, count)), Some((7000, 2)));
        let gust = |i: usize| at(i) + 100.0 * libm::exp(-((i as f64 - 500.0) / 20.0).powi(2));
        assert_eq!(outlier(&(0..20_000).map(gust).collect::<Vec<_>>()), None);
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
