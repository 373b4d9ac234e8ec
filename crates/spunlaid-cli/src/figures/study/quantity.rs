//! What the axes of a study's figures say: quantities, units handy to read.

use super::super::scale::{Axis, Spacing};
use spunlaid::case::keys;
use spunlaid::study;
use spunlaid::study::{Factor, MEASURES, PointResults};
use spunlaid::units::Dimension;

/// Results shown in one figure: one, or that of y and that of z.
#[derive(Clone, Debug)]
pub(super) struct Group {
    pub(super) name: &'static str,
    /// `amplitude`, in a sentence.
    pub(super) words: &'static str,
    pub(super) label: &'static str,
    pub(super) unit: &'static str,
    /// From SI units to those of the axis.
    pub(super) factor: f64,
    /// Indices into the measures, and what each is called.
    pub(super) of: Vec<(usize, &'static str)>,
    pub(super) spacing: Spacing,
    /// Whether it starts at zero.
    pub(super) zero_based: bool,
    /// Whether it is what the fibre does across, rather than a check or a detail.
    pub(super) is_motion: bool,
}

/// All groups, the most wanted first.
pub(super) fn groups() -> Vec<Group> {
    let group = |name, words, label, unit, factor, of: &[(&str, &'static str)]| Group {
        name,
        words,
        label,
        unit,
        factor,
        of: of.iter().filter_map(|(measure, called)| Some((index(measure)?, *called))).collect(),
        spacing: Spacing::Linear,
        zero_based: true,
        is_motion: of.len() == 2 && factor != 0.01,
    };
    let errors = [("work_error", "work check"), ("balance_error", "energy balance")];
    vec![
        group(
            "amplitude",
            "amplitude",
            "Amplitude",
            "mm",
            1e3,
            &[("amplitude_y", "*y*"), ("amplitude_z", "*z*")],
        ),
        group(
            "frequency",
            "frequency",
            "Frequency",
            "Hz",
            1.0,
            &[("frequency_y", "*y*"), ("frequency_z", "*z*")],
        ),
        Group {
            zero_based: false,
            ..group(
                "mean_x",
                "mean position",
                "Mean position along the flow",
                "mm",
                1e3,
                &[("mean_x", "*x*")],
            )
        },
        group("max_strain", "largest strain", "Largest strain", "%", 1e2, &[("max_strain", "strain")]),
        Group {
            spacing: Spacing::Logarithmic,
            zero_based: false,
            is_motion: false,
            ..group("energy_error", "energy error", "Energy error", "%", 1.0, &errors)
        },
    ]
}

fn index(name: &str) -> Option<usize> {
    MEASURES.iter().position(|measure| measure.name == name)
}

impl Group {
    /// Its axis.
    pub(super) fn axis(&self) -> Axis {
        let label = format!("{} ({})", self.label, self.unit);
        match self.spacing {
            Spacing::Logarithmic => Axis::logarithmic(&label).decades(9),
            Spacing::Linear if self.zero_based => Axis::linear(&label).zero_based(),
            Spacing::Linear => Axis::linear(&label),
        }
    }

    /// Mean and standard error of one of its measures at a point, in the units of the axis.
    pub(super) fn value(&self, results: &PointResults, measure: usize) -> (f64, Option<f64>) {
        let error = results.standard_error[measure].map(|error| error * self.factor);
        (results.mean[measure] * self.factor, error)
    }
}

/// What a key is called, with its letter: `Mean velocity *U*`.
pub(super) fn label_of_key(key: &str) -> &str {
    keys::find(key).map_or(key, |key| key.label)
}

/// What a key is called in a sentence: `the mean velocity`.
pub(crate) fn name_of_key(key: &str) -> String {
    let label = super::super::svg::plain(label_of_key(key));
    // Without the letter at its end.
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

/// A factor as it stands along an axis.
#[derive(Clone, Debug)]
pub(super) struct Along {
    pub(super) axis: Axis,
    /// From SI units to those of the axis.
    scale: f64,
    pub(super) unit: &'static str,
}

impl Along {
    pub(super) fn new(factor: &Factor) -> Self {
        let (least, greatest) = factor.ends();
        let (scale, unit) = handy(factor.dimension, greatest.abs().max(least.abs()));
        let name = label_of_key(factor.key);
        let label = if unit.is_empty() { name.to_owned() } else { format!("{name} ({unit})") };
        let wide = least > 0.0 && greatest / least >= 30.0;
        let axis = if factor.spacing() == study::Spacing::Logarithmic || wide {
            Axis::logarithmic(&label)
        } else {
            Axis::linear(&label)
        };
        Self { axis, scale, unit }
    }

    pub(super) fn place(&self, value: f64) -> f64 {
        value * self.scale
    }
}

/// A unit in which a value of this size is easily read, and the factor from SI units.
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
