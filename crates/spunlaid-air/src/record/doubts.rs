//! What makes a record or its results doubtful.

use super::analysis::BLOCKS;
use super::artefacts::{Artefacts, smallest_step};
use super::{Analysis, Component, Reading, Record, Trend, hertz, number, time};
use crate::USUAL_LENGTH_SCALE;
use spunlaid_ground::error::{by_count, counted, listed};
use spunlaid_ground::{Dimension, Fault, Interval, WAS};

/// Largest share of an integral time that joints may take off, so that the record without its artefacts is reported.
const MOST_JOINED: f64 = 0.02;
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

/// An analysis without the samples that are no velocities.
#[derive(Clone, Copy)]
pub(super) struct AnalysisWithout<'a> {
    /// Number of these samples.
    pub(super) samples: usize,
    /// Number of places where others were joined in place of them.
    pub(super) joints: usize,
    pub(super) analysis: &'a Analysis,
}

/// All warnings about a record and its analysis, with what to do about each.
///
/// * `without` – the analysis without the samples that are no velocities, if there is one; warnings about the air are
///   then about it
pub(super) fn warnings(
    record: &Record,
    analysis: &Analysis,
    artefacts: Artefacts,
    without: Option<AnalysisWithout<'_>>,
) -> Vec<Fault> {
    let mut warnings = Vec::new();
    warnings.extend(record.reading.doubt.clone());
    warnings.extend(filled(record).filter(|_| record.filled_share() > MUCH_FILLED));
    warnings.extend(artefacts.faults);
    warnings.extend(without.and_then(AnalysisWithout::results));
    let analysis = without.map_or(analysis, |without| without.analysis);
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
        let coarse = Vec::from_iter(coarse(&samples.values, component.rms.value));
        let faults = [level(component), spectrum(component, analysis.interval), coarse];
        warnings.extend(faults.into_iter().flatten().map(|fault| Fault {
            message: format!("{}: {}", component.name, fault.message).into(),
            ..fault
        }));
    }
    let length = analysis.length_scale.value;
    if analysis.has_mean() && !(USUAL_LENGTH_SCALE.0..=USUAL_LENGTH_SCALE.1).contains(&length) {
        let [length, least, most] = [length, USUAL_LENGTH_SCALE.0, USUAL_LENGTH_SCALE.1]
            .map(|length| Dimension::Length.pretty_to(length, 3));
        warnings.push(Fault::new(
            format!("the length scale of {length} is outside the usual range, {least} to {most}"),
            "is the unit of the times, or of the velocities, right?",
        ));
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
            let name = &component.name;
            let angle = number(libm::atan(slope).to_degrees());
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

/// That velocities have few digits: rounding then adds to their variance, and takes from their correlation.
fn coarse(values: &[f64], rms: f64) -> Option<Fault> {
    /// Largest step over the rms.
    const LARGEST_STEP: f64 = 0.5;
    let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
    // Decimal numbers differ by their rounding too.
    let step = smallest_step(values, 1e-9 * largest);
    let message = format!(
        "the velocities are rounded to {} m/s, {} of the rms, so the rms is too large and the length scale too small",
        number(step),
        number(step / rms)
    );
    (step.is_finite() && step > LARGEST_STEP * rms).then(|| Fault::new(message, "record more digits"))
}

impl AnalysisWithout<'_> {
    /// What it gives. None if too many others had to be joined: each joint takes an integral time out of the record.
    fn results(self) -> Option<Fault> {
        let Self { samples, joints, analysis: rest } = self;
        let joined = joints as f64 * rest.integral_time.value;
        if !rest.has_mean() || joined > MOST_JOINED * rest.duration {
            return None;
        }
        Some(Fault::plain(format!(
            "without {} the analysis gives a turbulence intensity of {} %, an integral time of {} and a length scale \
             of {}",
            if samples == 1 { "this sample".to_owned() } else { format!("these {samples} samples") },
            number(100.0 * rest.turbulence_intensity.value),
            time(rest.integral_time.value),
            Dimension::Length.pretty_to(rest.length_scale.value, 3),
        )))
    }
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
