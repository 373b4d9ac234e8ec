//! Computes the statistics of a record with their confidence intervals.

use super::correlation::{lagged_products, pairs};
use super::flat::FlatPart;
use super::interval::{Interval, error};
use super::moments::Powers;
use super::warning::{BLOCK_TIMES, BLOCKS, warnings};
use super::{Autocorrelation, IntegralRule, Moments, Record, Samples, Trend, Warning};
use crate::error::{FileError, RecordFault};
use crate::statistics::{Spectrum, Welch, Window, student_t_95};
use std::ops::Range;

/// Least number of samples.
pub(super) const LEAST_SAMPLES: usize = 64;
/// Limit of the integral for the jackknife over the first zero: for an autocorrelation that crosses zero steeply, as
/// that of the flat spectrum, and for one that approaches it slowly, as an exponential. With these the standard error
/// is the scatter between records.
const BEYOND_ZERO: (f64, f64) = (1.1, 1.3);
/// First zero over integral time of the two.
const ZERO_OVER_TIME: (f64, f64) = (1.8, 2.4);
/// Increase of the intervals of skewness and flatness for a skewness of 1; with it 90 % or more hold the known value
/// for lognormal signals of skewness 0.6 to 2, 100 to 1000 integral times long.
const WIDER_BY_SKEWNESS: f64 = 0.5;
/// Largest number of lags of an autocorrelation.
const MOST_LAGS: usize = 1 << 18;
/// Largest velocity whose fourth power can be summed [m/s].
const LARGEST: f64 = 1e70;
/// Largest number of samples in a segment of the spectrum.
const LONGEST_SEGMENT: usize = 1 << 18;
/// Cut-off over the step of frequency, so that the flat part holds several steps.
const SEGMENT_CUTOFFS: f64 = 80.0;

/// How to analyse a record.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Settings {
    /// Rule for the largest lag of the integral of the autocorrelation.
    pub integral: IntegralRule,
    /// How to compute the spectrum.
    pub spectrum: SpectrumSettings,
    /// End of the flat part of the spectrum [Hz]; an eighth of the cut-off by default.
    pub flat_until: Option<f64>,
    /// Mean velocity along the flow [m/s]; it replaces the mean of the record.
    pub mean_velocity: Option<f64>,
}

/// How to compute a spectrum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpectrumSettings {
    /// Window of a segment.
    pub window: Window,
    /// Share of a segment that the next one has in common with it, 0 to 0.9.
    pub overlap: f64,
    /// Number of samples in a segment, a power of two; by default it follows from the integral time.
    pub segment: Option<usize>,
}

impl Default for SpectrumSettings {
    fn default() -> Self {
        Self { window: Window::Hann, overlap: 0.5, segment: None }
    }
}

/// The results of an analysis; intervals have a confidence of 95 %.
#[derive(Clone, Debug, PartialEq)]
pub struct Analysis {
    /// Number of samples of a component.
    pub samples: usize,
    /// Time between samples [s].
    pub interval: f64,
    /// Duration of the record [s].
    pub duration: f64,
    /// Mean of the component along the flow, `Ū` [m/s].
    pub mean_velocity: Interval,
    /// `Tu = u/|Ū|` [-], `u²` the mean of the components' variances.
    pub turbulence_intensity: Interval,
    /// Integral time `T_I` of the component along the flow [s].
    pub integral_time: Interval,
    /// Length scale by Taylor's hypothesis, `L = T_I |Ū|` [m].
    pub length_scale: Interval,
    /// Cut-off frequency of the flat spectrum with the variance and plateau of the component along the flow [Hz].
    pub cutoff_frequency: Interval,
    /// Results of each component; the first is along the mean flow.
    pub components: Vec<Component>,
    /// Rule of the integral time.
    pub integral: IntegralRule,
    /// Number of blocks of the jackknife.
    pub blocks: usize,
    /// Warnings about the record and the results.
    pub warnings: Vec<Warning>,
}

/// The results of one component.
#[derive(Clone, Debug, PartialEq)]
pub struct Component {
    /// Its name in the file.
    pub name: String,
    /// [m/s]
    pub mean: Interval,
    /// [m/s]
    pub rms: Interval,
    /// [-]
    pub skewness: Interval,
    /// [-]
    pub flatness: Interval,
    /// [s]
    pub integral_time: Interval,
    /// Autocorrelation up to a few times the limit of the integral.
    pub autocorrelation: Autocorrelation,
    /// Spectrum.
    pub spectrum: Spectrum,
    /// Flat part of the spectrum, and cut-off.
    pub flat: FlatPart,
    /// Trend of the mean.
    pub mean_trend: Trend,
    /// Trend of the rms.
    pub rms_trend: Trend,
    /// Smallest and largest sample [m/s].
    pub range: (f64, f64),
}

impl Component {
    /// Length of a block for which blocks are independent [s].
    pub(super) fn block_time(&self) -> f64 {
        block_time(self.integral_time.value, &self.autocorrelation)
    }
}

impl Analysis {
    /// Duration for which the 95 % interval of a result would be ± `share` of its value [s].
    pub fn duration_for(&self, result: &Interval, share: f64) -> f64 {
        self.duration * (result.relative() / share) * (result.relative() / share)
    }
}

/// Analyses a record.
///
/// # Errors
/// When the record has too few samples, no fluctuation or no mean flow, or is too short for the settings.
pub fn analyse(record: &Record, settings: &Settings) -> Result<Analysis, FileError> {
    let (samples, interval) = (record.samples(), record.interval);
    check(record, settings)?;
    let lengths: Vec<usize> =
        record.components.iter().map(|c| lags(&c.values, interval, settings.integral)).collect();
    let rough: Vec<(f64, Autocorrelation)> = (record.components.iter().zip(&lengths))
        .map(|(component, lags)| {
            let whole = Blocks::whole(&component.values, *lags);
            let autocorrelation = whole.autocorrelation(None, interval, settings.integral);
            (autocorrelation.integral_time().max(0.5 * interval), autocorrelation)
        })
        .collect();
    let block_time = rough.iter().map(|(time, of)| block_time(*time, of)).fold(interval, f64::max);
    let count = ((record.duration() / block_time) as usize).clamp(BLOCKS.0, BLOCKS.1);
    let blocks: Vec<Range<usize>> =
        (0..count).map(|b| b * samples / count..(b + 1) * samples / count).collect();
    let longest = rough.iter().map(|(time, _)| *time).fold(0.0, f64::max);
    let segment = segment(record, longest / interval, settings)?;
    let short = wanted_segment(longest / interval) > longest_segment(record) / 4;

    let summed: Vec<Blocks> = (record.components.iter().zip(&rough))
        .map(|(component, (_, of))| {
            // Enough lags for the estimates with a block left out, and for a figure.
            let most = (4.0 * of.limit / interval) as usize + 16;
            Blocks::of(&component.values, &blocks, most.min(longest_lag(samples)))
        })
        .collect();
    let estimates: Vec<Estimates> =
        (summed.iter()).map(|sums| Estimates::of(sums, count, interval, settings.integral)).collect();
    let components: Vec<Component> = (record.components.iter().zip(&estimates).zip(&summed))
        .map(|((samples, estimates), sums)| {
            component(samples, record, estimates, sums, (segment, short), settings)
        })
        .collect();
    let together = together(&estimates, settings.mean_velocity);
    let mean_velocity = settings.mean_velocity.map_or(components[0].mean, Interval::exactly);
    if mean_velocity.holds(0.0) {
        let error = 0.5 * (mean_velocity.high - mean_velocity.low);
        return Err(refuse(record, None, RecordFault::NoMean { mean: mean_velocity.value, error }));
    }
    let along = &components[0];
    let (integral_time, cutoff_frequency) = (along.integral_time, along.flat.cutoff);
    let mut analysis = Analysis {
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
    };
    analysis.warnings = warnings(record, &analysis);
    Ok(analysis)
}

fn refuse(record: &Record, column: Option<&str>, fault: RecordFault) -> FileError {
    let error = FileError::from(fault).file(&record.file);
    match column {
        Some(column) => error.column(column),
        None => error,
    }
}

fn check(record: &Record, settings: &Settings) -> Result<(), FileError> {
    let samples = record.samples();
    if samples < LEAST_SAMPLES {
        return Err(refuse(
            record,
            None,
            RecordFault::TooFewSamples { found: samples, least: LEAST_SAMPLES },
        ));
    }
    if !(record.interval > 0.0 && record.interval.is_finite()) {
        return Err(refuse(record, None, RecordFault::Rate { rate: 1.0 / record.interval }));
    }
    for Samples { name, values } in &record.components {
        if values.len() != samples {
            let fault = RecordFault::TooFewSamples { found: values.len(), least: samples };
            return Err(refuse(record, Some(name), fault));
        }
        if let Some(value) = values.iter().copied().find(|x| x.is_nan() || x.abs() > LARGEST) {
            return Err(refuse(record, Some(name), RecordFault::TooLarge { value }));
        }
        let Moments { mean, rms, .. } = Moments::of(values);
        if rms <= 1e-12 * mean.abs() || rms < 1.0 / LARGEST {
            return Err(refuse(record, Some(name), RecordFault::Constant { value: mean }));
        }
    }
    if let IntegralRule::Fixed(asked) = settings.integral {
        let most = longest_lag(samples) as f64 * record.interval;
        if !(asked > 0.0 && asked <= most - 2.0 * record.interval) {
            return Err(refuse(record, None, RecordFault::IntegralTooLong { asked, most }));
        }
    }
    Ok(())
}

/// A quarter of the record, or [`MOST_LAGS`].
fn longest_lag(samples: usize) -> usize {
    (samples / 4).min(MOST_LAGS)
}

/// Number of lags that reach the limit of the integral.
fn lags(values: &[f64], interval: f64, rule: IntegralRule) -> usize {
    let most = longest_lag(values.len());
    if let IntegralRule::Fixed(lag) = rule {
        return most.min((lag / interval) as usize + 3);
    }
    let mut lags = 1024.min(most);
    while lags < most {
        let whole = Blocks::whole(values, lags);
        if whole.autocorrelation(None, interval, rule).limit_found {
            break;
        }
        lags = most.min(4 * lags);
    }
    lags
}

/// Length of a block for which blocks are independent [s].
fn block_time(integral_time: f64, autocorrelation: &Autocorrelation) -> f64 {
    (BLOCK_TIMES * integral_time).max(8.0 * autocorrelation.limit)
}

/// Number of samples in a segment of the spectrum.
fn segment(record: &Record, integral_time: f64, settings: &Settings) -> Result<usize, FileError> {
    let most = longest_segment(record);
    if let Some(asked) = settings.spectrum.segment {
        if !asked.is_power_of_two() || !(8..=most).contains(&asked) {
            let advice = asked.clamp(8, most).next_power_of_two().min(most);
            return Err(refuse(record, None, RecordFault::Segment { asked, most, advice }));
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

/// Sums over the blocks; any block can be left out of the total.
struct Blocks {
    reference: f64,
    samples: usize,
    ranges: Vec<Range<usize>>,
    powers: Vec<Powers>,
    all_powers: Powers,
    products: Vec<Vec<f64>>,
    all_products: Vec<f64>,
}

impl Blocks {
    /// The whole record as one block.
    fn whole(values: &[f64], lags: usize) -> Self {
        Self::of(values, std::slice::from_ref(&(0..values.len())), lags)
    }

    fn of(values: &[f64], ranges: &[Range<usize>], lags: usize) -> Self {
        let reference = values.iter().sum::<f64>() / values.len() as f64;
        let powers: Vec<Powers> = ranges.iter().map(|r| Powers::of(&values[r.clone()], reference)).collect();
        let all_powers = powers.iter().fold(Powers::default(), |sum, p| sum.plus(p, 1.0));
        let products = lagged_products(values, reference, ranges, lags);
        let all_products =
            (0..lags).map(|k| products.iter().map(|p| p.get(k).copied().unwrap_or(0.0)).sum()).collect();
        Self {
            reference,
            samples: values.len(),
            ranges: ranges.to_vec(),
            powers,
            all_powers,
            products,
            all_products,
        }
    }

    /// Of all blocks, or of all but one.
    fn moments(&self, without: Option<usize>) -> Moments {
        let left = without.map_or(self.all_powers, |b| self.all_powers.plus(&self.powers[b], -1.0));
        left.moments(self.reference)
    }

    /// Of all blocks, or of all but one.
    fn autocorrelation(&self, without: Option<usize>, interval: f64, rule: IntegralRule) -> Autocorrelation {
        let moments = self.moments(without);
        let offset = (moments.mean - self.reference) * (moments.mean - self.reference);
        let all = 0..self.samples;
        let coefficients = (self.all_products.iter().enumerate())
            .map(|(k, sum)| {
                let less = without
                    .map_or((0.0, 0.0), |b| (self.products[b][k], pairs(&self.ranges[b], k, self.samples)));
                ((sum - less.0) / (pairs(&all, k, self.samples) - less.1) - offset)
                    / (moments.rms * moments.rms)
            })
            .collect();
        Autocorrelation::new(coefficients, interval, rule)
    }
}

/// Estimates from the whole record, and with each block left out.
struct Estimates {
    moments: Moments,
    autocorrelation: Autocorrelation,
    left_out: Vec<(Moments, f64)>,
}

impl Estimates {
    fn of(sums: &Blocks, blocks: usize, interval: f64, rule: IntegralRule) -> Self {
        let autocorrelation = sums.autocorrelation(None, interval, rule);
        // Each estimate to its own zero would jump, and all to the zero of the whole would leave out its scatter.
        let rule = match rule {
            IntegralRule::FirstZero => {
                let ratio = autocorrelation.limit / autocorrelation.integral_time();
                let slow = (ratio - ZERO_OVER_TIME.0) / (ZERO_OVER_TIME.1 - ZERO_OVER_TIME.0);
                let beyond = BEYOND_ZERO.0 + (BEYOND_ZERO.1 - BEYOND_ZERO.0) * slow.clamp(0.0, 1.0);
                IntegralRule::Fixed(beyond * autocorrelation.limit)
            }
            other => other,
        };
        let left_out = (0..blocks)
            .map(|b| (sums.moments(Some(b)), sums.autocorrelation(Some(b), interval, rule).integral_time()));
        Self { moments: sums.moments(None), autocorrelation, left_out: left_out.collect() }
    }

    fn moment(&self, of: fn(&Moments) -> f64, positive: bool) -> Interval {
        let left_out: Vec<f64> = self.left_out.iter().map(|(moments, _)| of(moments)).collect();
        Interval::jackknife(of(&self.moments), &left_out, positive)
    }

    /// The interval is that of `asinh` of the skewness, whose error depends least on its value; without the bias
    /// that the jackknife finds.
    fn skewness(&self) -> Interval {
        let value = self.moments.skewness;
        let left_out: Vec<f64> = self.left_out.iter().map(|(m, _)| libm::asinh(m.skewness)).collect();
        let blocks = left_out.len() as f64;
        let mean = left_out.iter().sum::<f64>() / blocks;
        let middle = blocks * libm::asinh(value) - (blocks - 1.0) * mean;
        let half = self.half_width(&left_out);
        let (low, high) = (libm::sinh(middle - half), libm::sinh(middle + half));
        Interval { value, low: low.min(value), high: high.max(value) }
    }

    /// The interval is that of `−1/F²` of the flatness, whose error depends least on its value. It has no upper end
    /// where the tails are long and the record is short; then the square of the value is taken.
    fn flatness(&self) -> Interval {
        let value = self.moments.flatness;
        let inverse_square = |f: f64| -1.0 / (f * f);
        let left_out: Vec<f64> = self.left_out.iter().map(|(m, _)| inverse_square(m.flatness)).collect();
        let (middle, half) = (inverse_square(value), self.half_width(&left_out));
        let end = |at: f64| if at < 0.0 { (-1.0 / at).sqrt() } else { f64::INFINITY };
        Interval { value, low: end(middle - half), high: end(middle + half).min((value * value).max(value)) }
    }

    /// Half the interval of a transformed moment. The jackknife finds too small an error in skewed signals, because
    /// few blocks hold their largest values.
    fn half_width(&self, left_out: &[f64]) -> f64 {
        let wider = 1.0 + WIDER_BY_SKEWNESS * self.moments.skewness.abs().min(2.0);
        wider * student_t_95((left_out.len() as u64).saturating_sub(1)) * error(left_out)
    }

    fn integral_time(&self) -> Interval {
        let left_out: Vec<f64> = self.left_out.iter().map(|(_, time)| *time).collect();
        Interval::jackknife(self.autocorrelation.integral_time(), &left_out, true)
    }
}

fn component(
    samples: &Samples,
    record: &Record,
    estimates: &Estimates,
    sums: &Blocks,
    (segment, short): (usize, bool),
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
        FlatPart::of_short(&samples.values, record.interval, (mean, variance), settings.flat_until, time)
    } else {
        FlatPart::of(&spectrum, variance, settings.flat_until, time, record.duration())
    };
    let of_blocks = |of: fn(&Moments) -> f64| -> Vec<f64> {
        sums.powers.iter().map(|powers| of(&powers.moments(sums.reference))).collect()
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
        autocorrelation: estimates.autocorrelation.clone(),
        spectrum,
        flat,
        mean_trend: Trend::of(&of_blocks(|m| m.mean)),
        rms_trend: Trend::of(&of_blocks(|m| m.rms)),
        range: (least, most),
    }
}

/// Turbulence intensity and length scale; both need the mean velocity.
fn together(estimates: &[Estimates], mean_velocity: Option<f64>) -> (Interval, Interval) {
    let of = |pick: &dyn Fn(&Estimates) -> (Moments, f64)| {
        let along = pick(&estimates[0]);
        let velocity = mean_velocity.unwrap_or(along.0.mean).abs();
        let squares: f64 = estimates.iter().map(|e| pick(e).0.rms * pick(e).0.rms).sum();
        ((squares / estimates.len() as f64).sqrt() / velocity, along.1 * velocity)
    };
    let whole = of(&|e| (e.moments, e.autocorrelation.integral_time()));
    let blocks = estimates[0].left_out.len();
    let (intensities, lengths): (Vec<f64>, Vec<f64>) = (0..blocks).map(|b| of(&|e| e.left_out[b])).unzip();
    (Interval::jackknife(whole.0, &intensities, true), Interval::jackknife(whole.1, &lengths, true))
}
