//! Computes the statistics of a record with their confidence intervals.

use super::analysis::{BLOCKS, SpectrumSettings, block_time};
use super::artefacts::Artefacts;
use super::doubts::{AnalysisWithout, warnings};
use super::flat::FlatPart;
use super::interval::{error, jackknife};
use super::jackknife::{Blocks, Estimates};
use super::{
    Analysis, Autocorrelation, Component, IntegralRule, LEAST_SAMPLES, Moments, Record, Samples, Settings,
    Trend, number, rate_fault, too_few_samples,
};
use spunlaid_ground::units::shortest;
use spunlaid_ground::{Dimension, Fault, FileError, Interval, Welch};
use std::ops::Range;

/// Largest number of lags of an autocorrelation.
const MOST_LAGS: usize = 1 << 18;
/// Largest velocity whose fourth power can be summed [m/s].
const LARGEST: f64 = 1e70;
/// Largest number of samples in a segment of the spectrum.
const LONGEST_SEGMENT: usize = 1 << 18;
/// Cut-off over the step of frequency, so that the flat part holds several steps.
const SEGMENT_CUTOFFS: f64 = 80.0;

/// Analyses a record.
///
/// # Errors
/// When the record has too few samples, no fluctuation or no mean flow, or is too short for the settings.
pub fn analyse(record: &Record, settings: &Settings) -> Result<Analysis, FileError> {
    let analysis = analyse_fluctuation(record, settings)?;
    if analysis.has_mean() {
        return Ok(analysis);
    }
    let Interval { value, low, high } = analysis.mean_velocity;
    let fault = Fault::new(
        format!(
            "the mean velocity is zero within its error ({} ± {} m/s)",
            number(value),
            number(0.5 * (high - low))
        ),
        "if the mean has been subtracted, give the mean velocity",
    );
    Err(refuse(record, None, fault.option("--mean-velocity")))
}

/// [`analyse`] for a record that may lack a mean velocity. What depends on it has no meaning then.
pub fn analyse_fluctuation(record: &Record, settings: &Settings) -> Result<Analysis, FileError> {
    check(record, settings)?;
    let artefacts = Artefacts::find(record).map_err(|(name, fault)| refuse(record, Some(name), fault))?;
    let mut analysis = statistics(record, settings)?;
    let mended = artefacts.mended(record);
    let rest = mended.as_ref().and_then(|mended| {
        check(&mended.record, settings).and_then(|()| statistics(&mended.record, settings)).ok()
    });
    let without = mended.zip(rest.as_ref()).map(|(mended, analysis)| AnalysisWithout {
        samples: mended.left_out,
        joints: mended.joints,
        analysis,
    });
    analysis.warnings = warnings(record, &analysis, artefacts, without);
    Ok(analysis)
}

/// The results without warnings.
fn statistics(record: &Record, settings: &Settings) -> Result<Analysis, FileError> {
    let (samples, interval) = (record.samples(), record.interval);
    let rough: Vec<(f64, Autocorrelation)> = (record.components.iter())
        .map(|component| {
            let autocorrelation = autocorrelation_to_limit(&component.values, interval, settings.integral);
            (autocorrelation.integral_time().max(0.5 * interval), autocorrelation)
        })
        .collect();
    let block_time =
        rough.iter().map(|(time, correlation)| block_time(*time, correlation)).fold(interval, f64::max);
    let count = ((record.duration() / block_time) as usize).clamp(BLOCKS.0, BLOCKS.1);
    let blocks: Vec<Range<usize>> =
        (0..count).map(|b| b * samples / count..(b + 1) * samples / count).collect();
    let longest = rough.iter().map(|(time, _)| *time).fold(0.0, f64::max);
    let segment = segment(record, longest / interval, settings)?;
    let short = wanted_segment(longest / interval) > longest_segment(record) / 4;

    let summed: Vec<Blocks> = (record.components.iter().zip(&rough))
        .map(|(component, (_, correlation))| {
            // Enough lags for the estimates with a block left out, and for a figure.
            let most = (4.0 * correlation.limit / interval) as usize + 16;
            Blocks::new(&component.values, &blocks, most.min(longest_lag(samples)))
        })
        .collect();
    let estimates: Vec<Estimates> =
        (summed.iter()).map(|sums| Estimates::new(sums, count, interval, settings.integral)).collect();
    let components: Vec<Component> = (record.components.iter().zip(&estimates).zip(&summed))
        .map(|((samples, estimates), sums)| {
            component(samples, record, estimates, sums, segment, short, settings)
        })
        .collect();
    let together = together(&estimates, settings.mean_velocity);
    let mean_velocity = settings.mean_velocity.map_or(components[0].mean, Interval::exactly);
    let along = &components[0];
    let (integral_time, cutoff_frequency) = (along.integral_time, along.flat.cutoff);
    Ok(Analysis {
        samples,
        interval,
        duration: record.duration(),
        mean_velocity,
        turbulence_intensity: together.0,
        integral_time,
        length_scale: together.1,
        cutoff_frequency,
        components,
        integral: settings.integral,
        blocks: count,
        warnings: Vec::new(),
    })
}

fn refuse(record: &Record, column: Option<&str>, fault: Fault) -> FileError {
    let error = FileError::from(fault).file(&record.file);
    match column {
        Some(column) => error.column(column),
        None => error,
    }
}

fn check(record: &Record, settings: &Settings) -> Result<(), FileError> {
    let samples = record.samples();
    if samples < LEAST_SAMPLES {
        return Err(refuse(record, None, too_few_samples(samples, LEAST_SAMPLES)));
    }
    if !(record.interval > 0.0 && record.interval.is_finite()) {
        return Err(refuse(record, None, rate_fault(1.0 / record.interval)));
    }
    for (number, Samples { name, values }) in record.components.iter().enumerate() {
        if values.len() != samples {
            let fault = too_few_samples(values.len(), samples);
            return Err(refuse(record, Some(name), fault));
        }
        if let Some(value) = values.iter().copied().find(|x| x.is_nan() || x.abs() > LARGEST) {
            return Err(refuse(
                record,
                Some(name),
                Fault::new(
                    format!(
                        "holds values as large as {} m/s, which are too large to compute with",
                        shortest(value)
                    ),
                    "is the unit right?",
                ),
            ));
        }
        let Moments { mean, rms, .. } = Moments::new(values);
        if rms <= 1e-12 * mean.abs() || rms < 1.0 / LARGEST {
            return Err(refuse(
                record,
                Some(name),
                Fault::new(
                    format!(
                        "is constant, {} m/s in every sample, so there is no turbulence in it",
                        shortest(mean)
                    ),
                    match number {
                        0 => "is the probe connected?",
                        // As across the plane of a plane simulation.
                        _ => "name the other columns only (--columns), if the air moves in a plane",
                    },
                ),
            ));
        }
    }
    if let IntegralRule::Fixed(asked) = settings.integral {
        let most = longest_lag(samples) as f64 * record.interval;
        if !(asked > 0.0 && asked <= most - 2.0 * record.interval) {
            return Err(refuse(
                record,
                None,
                Fault::new(
                    format!(
                        "an integral over {} reaches beyond a quarter of the record, {}",
                        Dimension::Time.pretty(asked),
                        Dimension::Time.pretty(most)
                    ),
                    "give a shorter time",
                )
                .option("--integral"),
            ));
        }
    }
    Ok(())
}

/// A quarter of the record, or [`MOST_LAGS`].
fn longest_lag(samples: usize) -> usize {
    (samples / 4).min(MOST_LAGS)
}

/// The autocorrelation of a record, with enough lags for the limit of the integral.
fn autocorrelation_to_limit(values: &[f64], interval: f64, rule: IntegralRule) -> Autocorrelation {
    let most = longest_lag(values.len());
    let mut lags = match rule {
        IntegralRule::Fixed(lag) => most.min((lag / interval) as usize + 3),
        _ => most.min(1024),
    };
    loop {
        let found = Blocks::whole(values, lags).autocorrelation(None, interval, rule);
        if found.limit_found || lags == most {
            return found;
        }
        lags = most.min(4 * lags);
    }
}

/// Number of samples in a segment of the spectrum.
fn segment(record: &Record, integral_time: f64, settings: &Settings) -> Result<usize, FileError> {
    let most = longest_segment(record);
    if let Some(asked) = settings.spectrum.segment {
        if !asked.is_power_of_two() || !(8..=most).contains(&asked) {
            let advice = asked.clamp(8, most).next_power_of_two().min(most);
            return Err(refuse(
                record,
                None,
                Fault::new(
                    format!("a segment cannot have {asked} samples"),
                    format!("write a power of two from 8 to {most}, like {advice}"),
                )
                .option("--segment"),
            ));
        }
        return Ok(asked);
    }
    // The record then holds at least seven segments that overlap by half.
    Ok(wanted_segment(integral_time).min(most / 4))
}

/// The largest power of two that the record holds.
fn longest_segment(record: &Record) -> usize {
    (1 << record.samples().ilog2()).min(LONGEST_SEGMENT)
}

/// Number of samples in a segment whose spectrum has several steps in the flat part.
///
/// * `integral_time` – in samples
fn wanted_segment(integral_time: f64) -> usize {
    let wanted = (4.0 * SEGMENT_CUTOFFS * integral_time).min(LONGEST_SEGMENT as f64) as usize;
    wanted.max(16).next_power_of_two()
}

fn component(
    samples: &Samples,
    record: &Record,
    estimates: &Estimates,
    sums: &Blocks,
    segment: usize,
    short: bool,
    settings: &Settings,
) -> Component {
    let Moments { mean, rms, .. } = estimates.moments;
    let SpectrumSettings { window, overlap, .. } = settings.spectrum;
    let mut welch = Welch::new(record.interval, segment, window, overlap);
    welch.add(&samples.values, Some(mean));
    let spectrum = welch.finish();
    let integral_time = estimates.integral_time();
    let variances: Vec<f64> = estimates.left_out.iter().map(|(m, _)| 2.0 * libm::log(m.rms)).collect();
    let variance = (rms * rms, error(&variances));
    let time = integral_time.value.abs().max(0.25 * record.interval);
    let flat = if short {
        FlatPart::from_short_record(
            &samples.values,
            record.interval,
            mean,
            variance,
            settings.flat_until,
            time,
        )
    } else {
        FlatPart::new(&spectrum, variance, settings.flat_until, time, record.duration())
    };
    let of_blocks = |moment: fn(&Moments) -> f64| -> Vec<f64> {
        sums.powers.iter().map(|powers| moment(&powers.moments(sums.reference))).collect()
    };
    let (least, most) =
        samples.values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
    Component {
        name: samples.name.clone(),
        mean: estimates.moment(|m| m.mean, false),
        rms: estimates.moment(|m| m.rms, true),
        skewness: estimates.skewness(),
        flatness: estimates.flatness(),
        integral_time,
        integral: settings.integral,
        autocorrelation: estimates.autocorrelation.clone(),
        spectrum,
        flat,
        mean_trend: Trend::new(&of_blocks(|m| m.mean)),
        rms_trend: Trend::new(&of_blocks(|m| m.rms)),
        range: (least, most),
    }
}

/// Turbulence intensity and length scale; both need the mean velocity.
fn together(estimates: &[Estimates], mean_velocity: Option<f64>) -> (Interval, Interval) {
    let found = |pick: &dyn Fn(&Estimates) -> (Moments, f64)| {
        let along = pick(&estimates[0]);
        let velocity = mean_velocity.unwrap_or(along.0.mean).abs();
        let squares: f64 = estimates.iter().map(|e| pick(e).0.rms * pick(e).0.rms).sum();
        ((squares / estimates.len() as f64).sqrt() / velocity, along.1 * velocity)
    };
    let whole = found(&|e| (e.moments, e.autocorrelation.integral_time()));
    let blocks = estimates[0].left_out.len();
    let (intensities, lengths): (Vec<f64>, Vec<f64>) = (0..blocks).map(|b| found(&|e| e.left_out[b])).unzip();
    (jackknife(whole.0, &intensities, true), jackknife(whole.1, &lengths, true))
}
