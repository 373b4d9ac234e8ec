//! What makes a record or its results doubtful.

use super::{Analysis, Component, Record, Warning};
use crate::statistics::median;

/// Fewest and most blocks of a record.
pub(super) const BLOCKS: (usize, usize) = (8, 64);
/// Length of a block in integral times.
pub(super) const BLOCK_TIMES: f64 = 40.0;

/// Standard deviations from the median beyond which a sample may be an outlier.
const OUTLIER: f64 = 12.0;
/// Largest number of samples that are sorted to find the median.
const MOST_RANKED: usize = 1 << 16;

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
