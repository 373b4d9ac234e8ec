//! The axes of a study's figures: quantities and readable units.

use crate::figures::with_unit;
use spunlaid::case::keys;
use spunlaid::observe::{self, Unit};
use spunlaid::study;
use spunlaid::study::{Design, Factor, MEASURES, PointResults, Study};
use spunlaid::units::Dimension;
use spunlaid_charts::Axis;

/// The results of one figure, as they are declared: one result, or one in y and one in z.
#[derive(Clone, Debug)]
pub(super) struct Group {
    pub(super) figure: &'static observe::Figure,
    pub(super) unit: Unit,
    /// Indices into the measures, and the names of the series.
    pub(super) of: Vec<(usize, &'static str)>,
}

/// All groups, in the order of the declarations.
pub(super) fn groups() -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (i, measure) in MEASURES.iter().enumerate() {
        match groups.iter_mut().find(|group| group.figure.name == measure.figure.name) {
            Some(group) => group.of.push((i, measure.series)),
            None => {
                let (figure, unit, of) = (measure.figure, measure.unit, vec![(i, measure.series)]);
                groups.push(Group { figure, unit, of });
            }
        }
    }
    groups
}

impl Group {
    /// Its axis.
    pub(super) fn axis(&self) -> Axis {
        let label = with_unit(self.figure.title, self.unit.shown);
        match (self.figure.logarithmic, self.figure.from_zero) {
            (true, _) => Axis::logarithmic(&label).decades(9),
            (false, true) => Axis::linear(&label).zero_based(),
            (false, false) => Axis::linear(&label),
        }
    }

    /// Whether it describes the motion across the flow.
    pub(super) fn is_motion(&self) -> bool {
        matches!(self.of[..], [(_, "*y*"), (_, "*z*")])
    }

    /// Leaves out results that apply to no point, as the work check does with implicit tension. None if no result is left.
    pub(super) fn applying(mut self, results: &[PointResults]) -> Option<Self> {
        self.of.retain(|(measure, _)| results.iter().any(|point| point.mean[*measure].is_finite()));
        if self.of.is_empty() { None } else { Some(self) }
    }

    /// Mean and standard error of one of its measures at a point, in the units of the axis.
    pub(super) fn value(&self, results: &PointResults, measure: usize) -> (f64, Option<f64>) {
        let error = results.standard_error(measure).map(|error| error * self.unit.per_si);
        (results.mean[measure] * self.unit.per_si, error)
    }
}

/// Label of a key with its letter: `Mean velocity *U*`.
pub(super) fn label_of_key(key: &str) -> &str {
    let of_web = |key| match key {
        "line.belt_speed" => "Belt speed",
        "line.feed_speed" => "Feed speed",
        "line.filaments_per_metre" => "Filaments per metre",
        "laydown.sigma_md" => "Spread in machine direction",
        "laydown.sigma_cd" => "Spread in cross direction",
        "laydown.noise" => "Noise of the direction *A*",
        other => other,
    };
    keys::find(key).map_or_else(|| of_web(key), |key| key.label)
}

/// Name of a key within a sentence: `mean velocity`.
pub fn name_of_key(key: &str) -> String {
    let label = spunlaid_charts::svg::plain(label_of_key(key));
    // The letter at the end is left out.
    let words = match label.rsplit_once(' ') {
        Some((words, letter)) if letter.chars().count() <= 2 => words,
        _ => &label,
    };
    let words = words.to_owned();
    if words.starts_with("Young") {
        return words;
    }
    words.chars().enumerate().map(|(i, c)| if i == 0 { c.to_ascii_lowercase() } else { c }).collect()
}

/// The axis of a factor.
#[derive(Clone, Debug)]
pub(in crate::figures) struct Along {
    pub(in crate::figures) axis: Axis,
    /// Converts SI units to the units of the axis.
    scale: f64,
    pub(super) unit: &'static str,
    /// The values of a factor of words, in the order of the axis.
    words: Vec<f64>,
}

impl Along {
    /// * `base` – a word that comes before those of the factor
    pub(in crate::figures) fn new(factor: &Factor, base: Option<f64>) -> Self {
        let mut words = if factor.words.is_empty() { Vec::new() } else { factor.levels() };
        if let Some(base) = base.filter(|base| !words.is_empty() && !words.contains(base)) {
            words.insert(0, base);
        }
        if !words.is_empty() {
            let names = words.iter().map(|word| factor.input().pretty(*word));
            let axis = Axis::of_words(label_of_key(factor.key), names);
            return Self { axis, scale: 1.0, unit: "", words };
        }
        let (least, greatest) = factor.ends();
        let (scale, unit) = handy(factor.dimension, greatest.abs().max(least.abs()));
        let label = with_unit(label_of_key(factor.key), unit);
        let wide = least > 0.0 && greatest / least >= 30.0;
        let axis = if factor.spacing() == study::Spacing::Logarithmic || wide {
            Axis::logarithmic(&label)
        } else {
            Axis::linear(&label)
        };
        Self { axis, scale, unit, words }
    }

    /// The axis of a factor of a study.
    pub(super) fn of(study: &Study, factor: usize) -> Self {
        let base = study.points.first().filter(|_| study.design == Design::OneAtATime);
        Self::new(&study.factors[factor], base.map(|point| point.values[factor]))
    }

    pub(in crate::figures) fn place(&self, value: f64) -> f64 {
        self.words.iter().position(|word| *word == value).map_or(value * self.scale, |place| place as f64)
    }

    /// Whether the values have an order and a distance, so that a line may join them.
    pub(in crate::figures) fn is_joined(&self) -> bool {
        self.words.is_empty()
    }

    /// How far the points of one of several series stand aside, so that those of a word do not hide each other.
    pub(in crate::figures) fn aside(&self, series: usize, of: usize) -> f64 {
        if self.is_joined() { 0.0 } else { 0.5 * ((series as f64 + 0.5) / of as f64 - 0.5) }
    }
}

/// A readable unit for a value of this size, and the factor from SI units.
fn handy(dimension: Dimension, size: f64) -> (f64, &'static str) {
    match dimension {
        Dimension::Length if size < 1e-3 => (1e6, "µm"),
        Dimension::Length if size < 1.0 => (1e3, "mm"),
        Dimension::Time if size < 1e-3 => (1e6, "µs"),
        Dimension::Time if size < 1.0 => (1e3, "ms"),
        Dimension::Pressure if size >= 1e9 => (1e-9, "GPa"),
        Dimension::Pressure if size >= 1e6 => (1e-6, "MPa"),
        Dimension::Frequency if size >= 1e4 => (1e-3, "kHz"),
        other => (1.0, other.si_unit()),
    }
}
