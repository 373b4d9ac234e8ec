//! What is no velocity in a record: numbers for missing values, dropouts, clipped, frozen and held values, spikes.

mod apart;
mod component_report;
mod equal;
mod spikes;

use super::rows::fill;
use super::{LONGEST_GAP, Record};
use apart::{Apart, apart, clipped};
use component_report::ComponentReport;
use equal::{Equal, equal};
use spikes::spikes;
use spunlaid_ground::Fault;
use spunlaid_ground::statistics::quantile;
use std::ops::Range;

/// Largest share of a record that may be left out.
const MOST_LEFT_OUT: f64 = 0.5;

/// What is no velocity in a record.
#[derive(Debug, Default)]
pub(super) struct Artefacts {
    /// What is reported of it.
    pub(super) faults: Vec<Fault>,
    /// Whether a sample, of whatever component, is no velocity; empty if all are some.
    is_spoilt: Vec<bool>,
}

/// A record without its artefacts.
pub(super) struct Mended {
    pub(super) record: Record,
    /// Number of samples that were left out.
    pub(super) left_out: usize,
    /// Number of places where others were joined.
    pub(super) joints: usize,
}

impl Artefacts {
    /// Finds them.
    ///
    /// # Errors
    /// When a component holds numbers that stand for missing values: its name, and the fault.
    pub(super) fn find(record: &Record) -> Result<Self, (&str, Fault)> {
        let mut all = Self::default();
        for (i, component) in record.components.iter().enumerate() {
            let values = &component.values;
            let Some(robust) = Robust::new(values) else { continue };
            let factor = record.reading.factors.get(i).copied().unwrap_or(1.0);
            let apart = apart(values, &robust, factor);
            let report = ComponentReport { record, name: &component.name, values };
            if let Some((group, written)) =
                apart.iter().find_map(|group| Some((group, group.sentinel.as_ref()?)))
            {
                return Err((component.name.as_str(), report.sentinel(&group.samples, written)));
            }
            all.faults.extend(apart.iter().map(|group| report.dropouts(group)));
            let spoilt = all.look(&robust, &report, &apart);
            all.spoil(values.len(), spoilt);
        }
        Ok(all)
    }

    /// Looks for what does not lie apart; returns all stretches that are no velocities.
    fn look(&mut self, robust: &Robust, report: &ComponentReport<'_>, apart: &[Apart]) -> Vec<Range<usize>> {
        let values = report.values;
        let mut is_left_out = vec![false; values.len()];
        let mut spoilt: Vec<Range<usize>> = Vec::new();
        for i in apart.iter().flat_map(|group| &group.samples) {
            is_left_out[*i] = true;
            spoilt.push(*i..i + 1);
        }
        let mut extremes = Vec::new();
        for sign in [1.0, -1.0] {
            let clipped = clipped(values, robust, |i| is_left_out[i], sign);
            if let Some(first) = clipped.first() {
                extremes.push(values[*first]);
                self.faults.push(report.clipping(clipped.len(), values[*first]));
            }
        }
        let is_apart = |x: f64| apart.iter().any(|group| group.values.0 <= x && x <= group.values.1);
        let mut is_staircase = false;
        match equal(values, robust, |x| extremes.contains(&x) || is_apart(x)) {
            Equal::Usual => {}
            Equal::Frozen(stretches) => {
                self.faults.push(report.frozen(&stretches));
                stretches.iter().flat_map(Clone::clone).for_each(|i| is_left_out[i] = true);
                spoilt.extend(stretches);
            }
            Equal::Held(times) => {
                is_staircase = true;
                self.faults.push(report.held(times));
            }
            Equal::Irregular(share, explained) => {
                is_staircase = true;
                self.faults.push(report.irregular(share, explained));
            }
        }
        let rest: Vec<usize> = (0..values.len()).filter(|i| !is_left_out[*i]).collect();
        let left: Vec<f64> = rest.iter().map(|i| values[*i]).collect();
        let found = if is_staircase { Vec::new() } else { spikes(&left, robust) };
        let found: Vec<usize> = found.into_iter().map(|i| rest[i]).collect();
        self.faults.extend(report.spikes(&found, robust));
        spoilt.extend(found.into_iter().map(|i| i..i + 1));
        spoilt
    }

    fn spoil(&mut self, samples: usize, stretches: Vec<Range<usize>>) {
        if !stretches.is_empty() {
            self.is_spoilt.resize(samples, false);
            stretches.into_iter().flatten().for_each(|i| self.is_spoilt[i] = true);
        }
    }

    /// The record without them: as many samples in a row as the reader fills in are interpolated, more are cut out.
    /// None if there are none, or too many.
    pub(super) fn mended(&self, record: &Record) -> Option<Mended> {
        let samples = record.samples();
        let left_out = self.is_spoilt.iter().filter(|is_spoilt| **is_spoilt).count();
        if left_out == 0 || left_out as f64 > MOST_LEFT_OUT * samples as f64 {
            return None;
        }
        let mut keep = vec![true; samples];
        let mut joints = 0;
        let mut at = 0;
        for stretch in self.is_spoilt.chunk_by(|a, b| a == b) {
            let range = at..at + stretch.len();
            at = range.end;
            let is_at_end = range.start == 0 || range.end == samples;
            if stretch[0] && (is_at_end || stretch.len() > LONGEST_GAP) {
                joints += usize::from(!is_at_end);
                keep[range].fill(false);
            }
        }
        let mut record = record.clone();
        for component in &mut record.components {
            let values = component.values.iter().zip(&self.is_spoilt).zip(&keep).filter(|(_, keep)| **keep);
            component.values = values.map(|((x, spoilt), _)| if *spoilt { f64::NAN } else { *x }).collect();
            fill(&mut component.values);
        }
        Some(Mended { record, left_out, joints })
    }
}

/// Largest number of samples that are ranked.
const MOST_RANKED: usize = 1 << 16;
/// Quantiles of the distance from the median of a Gaussian, in standard deviations: of half and of four fifths.
const HALF: f64 = 0.6745;
const FOUR_FIFTHS: f64 = 1.2816;

/// Centre, spread and resolution that a fifth of spoilt samples does not change much.
#[derive(Clone, Copy, Debug)]
struct Robust {
    median: f64,
    /// Standard deviation, by the distances from the median that a half and four fifths of the samples keep.
    deviation: f64,
    /// Smallest step between neighbouring samples that differ.
    resolution: f64,
}

impl Robust {
    /// None if most samples are equal.
    fn new(values: &[f64]) -> Option<Self> {
        let some = thinned(values);
        let median = quantile(&some, 0.5);
        let distances: Vec<f64> = some.iter().map(|x| (x - median).abs()).collect();
        let deviation = (quantile(&distances, 0.5) / HALF).max(quantile(&distances, 0.8) / FOUR_FIFTHS);
        // Decimal numbers differ by their rounding too.
        let least = 1e-9 * deviation.max(median.abs());
        (deviation > least).then(|| Self { median, deviation, resolution: smallest_step(values, least) })
    }

    /// Standard deviations from the median.
    fn distance(&self, value: f64) -> f64 {
        (value - self.median).abs() / self.deviation
    }
}

/// The smallest step between neighbouring samples that differ by more than rounding; infinite if none do.
pub(super) fn smallest_step(values: &[f64], rounding: f64) -> f64 {
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    steps.filter(|step| *step > rounding).fold(f64::INFINITY, f64::min)
}

/// Samples at even distances, few enough to be ranked.
fn thinned(values: &[f64]) -> Vec<f64> {
    values.iter().copied().step_by(values.len().div_ceil(MOST_RANKED).max(1)).collect()
}
