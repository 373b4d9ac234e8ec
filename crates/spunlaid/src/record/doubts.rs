//! What makes a record or its results doubtful.

use super::analysis::BLOCKS;
use super::{Analysis, Component, Interval, Reading, Record, Trend};
use crate::error::{Fault, WAS, by_count, counted, listed};
use crate::statistics::median;
use crate::units::{Dimension, shortest};

/// Standard deviations from the median beyond which a sample may be an outlier.
const OUTLIER: f64 = 12.0;
/// Largest number of samples that are sorted to find the median.
const MOST_RANKED: usize = 1 << 16;
/// Share of interpolated samples from which results may mislead.
const MUCH_FILLED: f64 = 0.001;

impl Record {
    /// What the reader mended or left out, as far as it is no warning of [`super::analyse`].
    pub fn repairs(&self) -> Vec<Fault> {
        let mut repairs: Vec<Fault> =
            filled(self).filter(|_| self.filled_share() <= MUCH_FILLED).into_iter().collect();
        let Reading { cut_off, unused, .. } = &self.reading;
        if *cut_off > 0 {
            let all = *cut_off as u64;
            let places = match self.reading.cut_off_start {
                start if start == *cut_off => "start",
                0 => "end",
                _ => "start and the end",
            };
            let (rows, were) = (counted(all, "incomplete row"), by_count(all, WAS));
            repairs.push(Fault::plain(format!("{rows} at the {places} {were} dropped")));
        }
        if !unused.is_empty() {
            repairs.push(Fault::plain(format!("not used: {}", listed(unused))));
        }
        repairs
    }

    /// Samples that were interpolated, as a share of all.
    fn filled_share(&self) -> f64 {
        self.reading.filled as f64 / (self.samples() * self.components.len()) as f64
    }
}

/// That samples were interpolated, if any were.
fn filled(record: &Record) -> Option<Fault> {
    let Reading { filled, skipped, .. } = record.reading;
    let lacking = if skipped > 0 {
        format!("; the file lacks {} by its times", counted(skipped as u64, "row"))
    } else {
        String::new()
    };
    let message = format!(
        "{} ({} % of all) {} interpolated linearly{lacking}",
        counted(filled as u64, "missing sample"),
        number(100.0 * record.filled_share()),
        by_count(filled as u64, WAS),
    );
    (filled > 0).then(|| Fault::plain(message))
}

/// All warnings about a record and its analysis, with what to do about each.
pub(super) fn warnings(record: &Record, analysis: &Analysis) -> Vec<Fault> {
    let mut warnings = Vec::new();
    warnings.extend(record.reading.doubt.clone());
    warnings.extend(filled(record).filter(|_| record.filled_share() > MUCH_FILLED));
    let longest = analysis.components.iter().map(Component::block_time).fold(0.0, f64::max);
    if analysis.duration < BLOCKS.0 as f64 * longest {
        let count = number(analysis.duration / analysis.integral_time.value);
        warnings.push(Fault::new(
            format!(
                "the record lasts only {count} integral times, so the confidence intervals are uncertain"
            ),
            format!("measure for {} or longer", time(BLOCKS.0 as f64 * longest)),
        ));
    }
    for (component, samples) in analysis.components.iter().zip(&record.components) {
        let faults = [
            spike(&samples.values, record.reading.cut_off_start, analysis.interval),
            level(component),
            clipping(&samples.values),
            spectrum(component, analysis.interval),
        ];
        warnings.extend(faults.into_iter().flatten().map(|fault| Fault {
            message: format!("{}: {}", component.name, fault.message).into(),
            ..fault
        }));
    }
    let intensity = analysis.turbulence_intensity.value;
    // Without a mean neither intensity nor inclination has a meaning.
    if analysis.has_mean() && intensity > 0.3 {
        warnings.push(Fault::plain(format!(
            "with a turbulence intensity of {} the length scale by Taylor’s hypothesis is only an estimate, and a \
             single hot wire does not measure reversed flow",
            number(intensity)
        )));
    }
    for component in analysis.components.iter().skip(1).filter(|_| analysis.has_mean()) {
        let slope = component.mean.value.abs() / analysis.mean_velocity.value.abs();
        if slope > 0.05 {
            let (name, angle) = (&component.name, number(libm::atan(slope).to_degrees()));
            let message = format!("{name}: the mean flow is inclined by {angle}° in this direction");
            warnings.push(Fault::new(message, "is the probe aligned?"));
        }
    }
    let rms = || analysis.components.iter().map(|c| c.rms.value);
    let ratio = rms().fold(f64::INFINITY, f64::min) / rms().fold(0.0, f64::max);
    if ratio < 0.8 {
        warnings.push(Fault::plain(format!(
            "the smallest rms of the components is {} of the largest; the simulated turbulence is isotropic and has \
             the mean of their energies",
            number(ratio)
        )));
    }
    warnings
}

fn time(seconds: f64) -> String {
    Dimension::Time.pretty_to(seconds, 3)
}

fn hertz(frequency: f64) -> String {
    Dimension::Frequency.pretty_to(frequency, 3)
}

fn number(value: f64) -> String {
    shortest(format!("{value:.2e}").parse().unwrap_or(value))
}

/// A sample that is far from all others.
///
/// * `missing` – rows of the data before the first sample
fn spike(values: &[f64], missing: usize, interval: f64) -> Vec<Fault> {
    let Some((sample, deviations, count)) = outlier(values) else {
        return Vec::new();
    };
    let others = if count > 1 { format!(", the farthest of {count} outliers") } else { String::new() };
    vec![Fault::new(
        format!(
            "{} m/s in data row {} (at {}) is {} standard deviations from the median{others}; such a spike is not \
             turbulence and spoils every result",
            number(values[sample]),
            missing + sample + 1,
            time(sample as f64 * interval),
            number(deviations)
        ),
        "leave the cell empty and run the analysis again",
    )]
}

/// Whether the mean and the rms stay the same over the record, and whether the autocorrelation falls far enough.
fn level(component: &Component) -> Vec<Fault> {
    let mut faults = Vec::new();
    let autocorrelation = &component.autocorrelation;
    if !autocorrelation.limit_found {
        let lag = time(autocorrelation.limit);
        faults.push(Fault::new(
            format!(
                "the autocorrelation does not fall far enough within {lag}, so the integral time is a lower bound"
            ),
            "remove the drift or measure for longer",
        ));
    }
    let rms = component.rms.value;
    let drifts = |trend: &Trend| trend.significant && trend.change.value.abs() > 0.1 * rms;
    let change = |Interval { value, low, high }: Interval| {
        format!("{} ± {} m/s over the record", number(value), number(0.5 * (high - low)))
    };
    if drifts(&component.mean_trend) {
        let drift = component.mean_trend.change;
        faults.push(Fault::new(
            format!(
                "the mean drifts by {} ({} of the rms), which makes the integral time and the plateau too large",
                change(drift),
                number(drift.value.abs() / rms)
            ),
            "remove the drift or cut the record",
        ));
    }
    if drifts(&component.rms_trend) {
        let drift = change(component.rms_trend.change);
        let message =
            format!("the rms drifts by {drift} (mean {} m/s): the flow was not steady", number(rms));
        faults.push(Fault::plain(message));
    }
    faults
}

fn clipping(values: &[f64]) -> Vec<Fault> {
    let clipped = [1.0, -1.0].into_iter().filter_map(|sign| clipped(values, sign));
    let fault = |(samples, extreme)| {
        Fault::new(
            format!(
                "{samples} samples are all {} m/s, the extreme of the record: the instrument seems to clip at this \
                 value, which makes the rms too small",
                number(extreme)
            ),
            "measure with a wider range",
        )
    };
    clipped.map(fault).collect()
}

/// Whether the spectrum is that of turbulence, and whether it is resolved.
fn spectrum(component: &Component, interval: f64) -> Vec<Fault> {
    let mut faults = Vec::new();
    let (spectrum, flat) = (&component.spectrum, &component.flat);
    let top = spectrum.density.len().div_ceil(10);
    let end = &spectrum.density[spectrum.density.len() - top..];
    let share = end.iter().sum::<f64>() / top as f64 / flat.density.value;
    if share > 0.05 {
        faults.push(Fault::new(
            format!(
                "at half the sampling rate, {}, the spectrum is still {} of its plateau: higher frequencies are \
                 aliased into it",
                hertz(spectrum.highest()),
                number(share)
            ),
            "sample faster, or use a low-pass filter before sampling",
        ));
    }
    let integral_time = component.integral_time.value;
    if integral_time < 2.0 * interval {
        faults.push(Fault::new(
            format!(
                "the integral time of {} is hardly longer than the {} between samples, so the samples are nearly \
                 uncorrelated",
                time(integral_time),
                time(interval)
            ),
            "sample faster",
        ));
    }
    let tone = tone(&spectrum.density);
    if let Some((entry, share)) = tone {
        faults.push(Fault::plain(format!(
            "{} % of the variance is at one frequency, {}: this is a tone (shed vortices, a fan, the mains) and not \
             turbulence",
            number(100.0 * share),
            hertz(spectrum.frequency(entry))
        )));
    }
    if flat.coarse {
        faults.push(Fault::new(
            format!(
                "the plateau is the mean of the spectrum up to {}, but the cut-off is {}; the spectrum may not be flat \
                 up to there",
                hertz(flat.until),
                hertz(flat.cutoff.value)
            ),
            "measure for longer, or use longer segments",
        ));
    }
    // More than both errors explain, and more than the systematic difference of the rules.
    let plateau = flat.integral_time();
    let difference = libm::log(plateau / integral_time).abs();
    let error = flat.cutoff.relative().hypot(component.integral_time.relative());
    if tone.is_none() && !flat.coarse && difference > 1.5 * error && difference > 0.1 {
        faults.push(Fault::new(
            format!(
                "the integral time is {} by the autocorrelation and {} by the plateau of the spectrum: either the \
                 autocorrelation becomes negative or the record drifts",
                time(integral_time),
                time(plateau)
            ),
            "look at both figures",
        ));
    }
    faults
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
    // Both sides count: at its lowest frequencies the spectrum of any turbulence is far above the frequencies
    // after them.
    let below: Vec<f64> = near(peak.saturating_sub(10), peak.saturating_sub(2)).copied().collect();
    let above: Vec<f64> = near(peak + 4, peak + 11).copied().collect();
    let mean = |side: &[f64]| side.iter().sum::<f64>() / side.len() as f64;
    let level =
        [below, above].iter().filter(|side| !side.is_empty()).map(|side| mean(side)).fold(0.0, f64::max);
    let is_resolved = peak > 2;
    let line: f64 = near(peak.saturating_sub(2), peak + 3).sum();
    let share = line / density.iter().sum::<f64>();
    (is_resolved && density[peak] > 20.0 * level && share > 0.1).then_some((peak, share))
}

#[cfg(test)]
mod tests {
    use super::*;

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
