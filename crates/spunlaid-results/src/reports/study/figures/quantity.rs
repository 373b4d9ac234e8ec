//! The axes of a study's figures: quantities and readable units.

use crate::effects::label;
use crate::figures::with_unit;
use crate::reports::run::figures::measured::axes;
use spunlaid_charts::{Axis, Spacing};
use spunlaid_experiment::{Design, Factor, PointResults, Study, study};
use spunlaid_fibre::ZERO_CELSIUS;
use spunlaid_ground::{Dimension, Unit, measure};
use spunlaid_simulation::FibreMeasure;
use spunlaid_simulation::layers::place_in_web;

/// The results of one figure, as they are declared: one result, one in y and one in z, or one for each size of patches.
#[derive(Clone, Debug)]
pub(super) struct QuantityGroup {
    pub(super) figure: &'static measure::Figure,
    pub(super) title: String,
    pub(super) unit: Unit,
    /// Indices into the quantities of the study, and the names of the series.
    pub(super) members: Vec<(usize, String)>,
}

/// All groups, in the order of the declarations. Quantities without a figure are left out.
pub(super) fn groups(study: &Study) -> Vec<QuantityGroup> {
    let mut groups: Vec<QuantityGroup> = Vec::new();
    for (i, quantity) in
        study.quantities.iter().enumerate().filter(|(_, quantity)| !quantity.figure.name.is_empty())
    {
        let member = (i, quantity.series.clone());
        match groups.iter_mut().find(|group| group.figure.name == quantity.figure.name) {
            Some(group) => group.members.push(member),
            None => {
                let (figure, unit) = (quantity.figure, quantity.unit);
                groups.push(QuantityGroup {
                    figure,
                    title: figure.title.to_owned(),
                    unit,
                    members: vec![member],
                });
            }
        }
    }
    groups
}

impl QuantityGroup {
    /// The same group with one size of patches, the middle one, if it has many series.
    pub(super) fn with_few_series(mut self) -> Self {
        if self.members.len() > 2 {
            let middle = self.members.swap_remove(self.members.len() / 2);
            self.title = format!("{} over {}", self.title, middle.1);
            self.members = vec![middle];
        }
        self
    }

    /// Its axis.
    pub(super) fn axis(&self) -> Axis {
        let label = with_unit(&self.title, self.unit.shown);
        match (self.figure.logarithmic, self.figure.from_zero) {
            (true, _) => Axis::logarithmic(&label).decades(9),
            (false, true) => Axis::linear(&label).zero_based(),
            (false, false) => Axis::linear(&label),
        }
    }

    /// Whether it is drawn where there is a figure for each key: the motion across the flow, the CV of
    /// a web and what a buyer sees of it, or what a spinline gives.
    pub(super) fn is_main(&self) -> bool {
        let series: Vec<&str> = self.members.iter().map(|(_, series)| &**series).collect();
        series == ["*y*", "*z*"]
            || ["cv", "thin_places", "weakest_section", "final_diameter", "final_speed"]
                .contains(&self.figure.name)
    }

    /// Leaves out results that apply to no point, as the work check does with implicit tension. None if no
    /// result is left.
    pub(super) fn applying(mut self, results: &[PointResults]) -> Option<Self> {
        self.members.retain(|(measure, _)| results.iter().any(|point| point.mean(*measure).is_finite()));
        if self.members.is_empty() { None } else { Some(self) }
    }

    /// Mean and standard error of one of its measures at a point, in the units of the axis.
    pub(super) fn value(&self, results: &PointResults, measure: usize) -> (f64, Option<f64>) {
        let error = results.standard_error(measure).map(|error| error * self.unit.per_si);
        (results.mean(measure) * self.unit.per_si, error)
    }
}

/// Label of a key with its letter: `Mean velocity *U*`.
pub(super) fn label_of_key(key: &str) -> String {
    label(key).to_owned() + &place_in_web(key)
}

/// Name of a key within a sentence: `mean velocity`.
pub fn name_of_key(key: &str) -> String {
    let label = spunlaid_charts::label::plain(label(key));
    // The letter at the end is left out.
    let words = match label.rsplit_once(' ') {
        Some((words, letter)) if letter.chars().count() <= 2 => words,
        _ => &label,
    };
    let words = words.to_owned();
    if words.starts_with("Young") {
        return words;
    }
    let small = |(i, c): (usize, char)| if i == 0 { c.to_ascii_lowercase() } else { c };
    words.chars().enumerate().map(small).collect::<String>() + &place_in_web(key)
}

/// The axis of a factor.
#[derive(Clone, Debug)]
pub struct FactorAxis {
    pub(crate) axis: Axis,
    /// Where the units of the axis begin, in SI units, and what converts from there.
    pub(crate) zero: f64,
    pub(crate) scale: f64,
    pub(super) unit: &'static str,
    /// The values of a factor of words, in the order of the axis.
    words: Vec<f64>,
}

impl FactorAxis {
    /// * `base` – a word that comes before those of the factor
    pub(super) fn new(factor: &Factor, base: Option<f64>) -> Self {
        let mut words = if factor.key.words().is_empty() { Vec::new() } else { factor.levels() };
        if let Some(base) = base.filter(|base| !words.is_empty() && !words.contains(base)) {
            words.insert(0, base);
        }
        if !words.is_empty() {
            let names = words.iter().map(|word| factor.key.pretty(*word));
            let axis = Axis::from_words(&label_of_key(&factor.key.name), names);
            return Self { axis, zero: 0.0, scale: 1.0, unit: "", words };
        }
        let (least, greatest) = factor.ends();
        let wide = least > 0.0 && greatest / least >= 30.0;
        let is_logarithmic = factor.spacing() == study::Spacing::Logarithmic || wide;
        let (zero, scale, unit) = match factor.key.dimension() {
            Dimension::Temperature if !is_logarithmic => (ZERO_CELSIUS, 1.0, "°C"),
            dimension => {
                let (scale, unit) = handy(dimension, greatest.abs().max(least.abs()));
                (0.0, scale, unit)
            }
        };
        let label = with_unit(&label_of_key(&factor.key.name), unit);
        let axis = if is_logarithmic { Axis::logarithmic(&label) } else { Axis::linear(&label) };
        Self { axis, zero, scale, unit, words }
    }

    /// The axis of a factor of a study.
    pub(crate) fn from_study(study: &Study, factor: usize) -> Self {
        let base = study.points.first().filter(|_| study.design == Design::OneAtATime);
        Self::new(&study.factors[factor], base.map(|point| point.values[factor]))
    }

    pub(super) fn place(&self, value: f64) -> f64 {
        self.words
            .iter()
            .position(|word| *word == value)
            .map_or((value - self.zero) * self.scale, |place| place as f64)
    }

    /// Whether the values have an order and a distance, so that a line may join them.
    pub(super) fn is_joined(&self) -> bool {
        self.words.is_empty()
    }

    /// How far the points of one of several series stand aside, so that those of a word do not hide each other.
    pub(super) fn aside(&self, series: usize, count: usize) -> f64 {
        if self.is_joined() { 0.0 } else { 0.5 * ((series as f64 + 0.5) / count as f64 - 0.5) }
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
        Dimension::MassFlow => (6e4, "g/min"),
        other => (1.0, other.si_unit()),
    }
}

/// How values in SI units stand on an axis.
#[derive(Clone, Debug)]
pub struct Scale {
    /// Quantity and unit, with letters between asterisks: `Frequency *f* (Hz)`.
    pub label: String,
    /// The value at which the unit of the axis counts zero [SI unit].
    pub zero: f64,
    /// Factor from the SI unit to the unit of the axis.
    pub per_si: f64,
    /// Whether the axis is logarithmic.
    pub logarithmic: bool,
}

impl Scale {
    fn new(axis: Axis, per_si: f64) -> Self {
        let logarithmic = axis.spacing == Spacing::Logarithmic;
        Self { label: axis.label, zero: 0.0, per_si, logarithmic }
    }

    /// The scale of a number that is measured.
    pub fn from_quantity(label: &str, unit: Unit) -> Self {
        Self::new(Axis::linear(&with_unit(label, unit.shown)), unit.per_si)
    }

    /// The scales of a curve, along and up; `None` for a number.
    pub fn from_curve(measure: &FibreMeasure) -> Option<[Self; 2]> {
        let (.., unit) = measure.kind.abscissa()?;
        let (along, up) = axes(measure, true);
        Some([Self::new(along, unit.per_si), Self::new(up, measure.unit.per_si)])
    }

    /// The scale of a factor of a study.
    pub fn from_factor(study: &Study, factor: usize) -> Self {
        let FactorAxis { axis, zero, scale, .. } = FactorAxis::from_study(study, factor);
        Self { zero, ..Self::new(axis, scale) }
    }
}
