//! What a measure is: its names, unit and meaning, how it is found and with what errors.
//!
//! ```text
//! a list of measures + what was found → rows of values with their errors → JSON, tables, studies, Python
//! ```

mod number;

use crate::Interval;
pub use number::{
    HERTZ, KELVIN, Known, METRES_PER_SECOND, MILLIMETRES, MILLINEWTONS, OF_PERCENT, PER_METRE,
    PER_SQUARE_METRE, PERCENT, RATIO, SQUARE_MILLIMETRES_PER_HERTZ, Unit,
};
use std::fmt;

/// Something measured of a `T`: of a web, of its patches of one size, of a scan, of a velocity record or a
/// component of it, of a spinline; of the fibres of a flight, which observers look at.
pub struct Measure<T: 'static> {
    /// Name in a study file, `amplitude_y`; empty if studies leave it out. Of patches, `#` stands for their
    /// side in millimetres.
    pub name: &'static str,
    /// Name in the tables of runs and studies, with its SI unit: `amplitude_y_m`.
    pub column: &'static str,
    /// Name in `summary.json` or `analysis.json` where it is another; a point separates the name of a group:
    /// `solidification.distance_m`. Empty if it is written elsewhere there.
    pub entry: Option<&'static str>,
    /// Its label in a table: `Amplitude in y`; empty if tables leave it out. A study adds the side of patches
    /// at the end, or in place of `#`.
    pub label: &'static str,
    /// Its label on the terminal where that is shorter; empty if the terminal leaves it out.
    pub short: Option<&'static str>,
    /// Its definition in words.
    pub meaning: &'static str,
    /// What is special of a value; none where nothing is.
    pub remark: fn(&T) -> Option<String>,
    /// The unit in which it is shown.
    pub unit: Unit,
    /// The SI value that is shown as zero: 273.15 K of a temperature in °C. Studies keep and show the SI value.
    pub zero: f64,
    /// Number of digits that are shown; none of a number whose error reports it.
    pub digits: Option<i32>,
    /// Whether a table has it, if it has a label.
    pub is_shown: fn(&T) -> bool,
    /// Whether the tables of studies show it.
    pub is_main: bool,
    /// Number or curve.
    pub kind: MeasureKind,
    /// Its group.
    pub group: Group,
    /// The statistic over the replicates that is shown.
    pub aggregate: Aggregate,
    /// The figure that shows it.
    pub figure: &'static Figure,
    /// Its label in that figure: `*y*`.
    pub series: &'static str,
    /// How it is found.
    pub formula: Formula<T>,
    /// Its errors, which are measures too.
    pub errors: &'static [Measure<T>],
    /// What it is to its measure, if it is among the errors of one.
    pub role: ErrorRole,
}

/// How a measure is found, in SI units.
#[derive(Debug)]
pub enum Formula<T: 'static> {
    /// By an observer, while the fibres fly.
    Observed,
    /// A count.
    Count(fn(&T) -> u64),
    /// A number.
    Number(fn(&T) -> f64),
    /// A number, or none if this one has none.
    Known(fn(&T) -> Option<f64>),
    /// A mean, and its standard error if it is known.
    Mean(fn(&T) -> (f64, Option<f64>)),
    /// A number with its 95 % confidence interval.
    Interval(fn(&T) -> Interval),
    /// A number of which only a bound or a range may be known, or none if this one has none.
    Reported(fn(&T) -> Option<Known>),
}

/// What an error is to its measure, as studies and tables have to know.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ErrorRole {
    /// Its standard error, unless there are several replicates, whose scatter reports it.
    OfOne,
    /// A further error, which more replicates do not lower.
    Further,
    /// No error, but a number about the errors.
    About,
}

/// One value of a measure, in JSON as its contents.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum Value {
    /// A number in SI units; NaN where it is not defined.
    Number(f64),
    /// A count.
    Count(u64),
    /// A mean.
    Mean {
        /// The mean.
        mean: f64,
        /// Its standard error, if it is known.
        standard_error: Option<f64>,
    },
    /// A number with its 95 % confidence interval.
    Interval(Interval),
    /// A number, a bound or a range.
    Reported(Known),
    /// Places, times or frequencies, and the values there, as many of both, in SI units.
    Curve(Vec<f64>, Vec<f64>),
}

impl Value {
    /// The number; NaN of a curve.
    pub const fn number(&self) -> f64 {
        match self {
            Self::Number(value) | Self::Mean { mean: value, .. } | Self::Interval(Interval { value, .. }) => {
                *value
            }
            Self::Count(count) => *count as f64,
            Self::Reported(known) => known.value(),
            Self::Curve(..) => f64::NAN,
        }
    }
}

/// A row of a table: a measure and its value.
#[derive(Debug)]
pub struct Measured<T: 'static> {
    /// The measure.
    pub measure: &'static Measure<T>,
    /// Its value, from `zero` of the measure; none if there is none.
    pub value: Option<Value>,
    /// Its standard error, if it is known.
    pub error: Option<f64>,
    /// What is special of this value.
    pub remark: Option<String>,
}

impl<T> Measured<T> {
    /// What is special of the value, or else the definition of the measure.
    pub fn meaning(&self) -> &str {
        self.remark.as_deref().unwrap_or(self.measure.meaning)
    }
}

/// The rows of some measures, in their order.
pub fn measured<T>(measures: &'static [Measure<T>], found: &T) -> impl Iterator<Item = Measured<T>> {
    measures.iter().map(move |measure| measure.of(found))
}

/// Measures and their errors, each measure before its errors.
pub fn with_errors<T>(measures: &'static [Measure<T>]) -> impl Iterator<Item = &'static Measure<T>> {
    measures.iter().flat_map(|one| std::iter::once(one).chain(one.errors))
}

/// By its names, which distinguish it from all others; where its functions lie in memory says nothing.
impl<T> fmt::Debug for Measure<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Measure")
            .field("name", &self.name)
            .field("column", &self.column)
            .finish_non_exhaustive()
    }
}

impl<T> Measure<T> {
    /// The mean over the replicates of a number that has no name yet.
    pub const NUMBER: Self = Self {
        name: "",
        column: "",
        entry: None,
        label: "",
        short: None,
        meaning: "",
        remark: |_| None,
        unit: RATIO,
        zero: 0.0,
        digits: None,
        is_shown: |_| true,
        is_main: false,
        kind: MeasureKind::Number,
        group: Group { name: "", title: "" },
        aggregate: Aggregate::Mean,
        figure: &figure("", "", ""),
        series: "",
        formula: Formula::Observed,
        errors: &[],
        role: ErrorRole::About,
    };

    /// A measure by its name in files, its label in tables, the unit in which it is shown, and its formula.
    pub const fn new(column: &'static str, label: &'static str, unit: Unit, formula: Formula<T>) -> Self {
        Self { column, label, unit, formula, ..Self::NUMBER }
    }

    setters! {
        pub fn:
        /// Another one that an observer takes: its name in a study file, in tables, and its label.
        observed(name: &'static str, column: &'static str, label: &'static str) { name, column, label }
        /// Sets its definition in words.
        meaning(meaning: &'static str) { meaning }
        /// Sets its label on the terminal; empty leaves it out there.
        short(short: &'static str) { short: Some(short) }
        /// Sets the statistic over the replicates that is shown.
        aggregate(aggregate: Aggregate) { aggregate }
        /// Sets the unit in which it is shown.
        unit(unit: Unit) { unit }
        /// Sets the SI value that is shown as zero.
        zero(zero: f64) { zero }
        /// Sets the number of digits that are shown.
        digits(digits: i32) { digits: Some(digits) }
        /// Says what is special of a value.
        remark(remark: fn(&T) -> Option<String>) { remark }
        /// Limits it to some tables.
        shown_if(is_shown: fn(&T) -> bool) { is_shown }
        /// Adds its errors.
        errors(errors: &'static [Self]) { errors }
        /// Says what it is to the measure whose error it is.
        role(role: ErrorRole) { role }
        /// Puts it into studies under a name, in a column that is named as in `summary.json`.
        named(name: &'static str) { name }
        /// Puts it into the tables of studies too.
        main() { is_main: true }
        /// Says that another part of `summary.json` has it.
        elsewhere() { entry: Some("") }
        /// Puts it into a figure of studies.
        figure(figure: &'static Figure) { figure }
        /// Sets its label in its figure.
        series(series: &'static str) { series }
    }

    /// Puts it into studies under a name, in a column that has another name than in `summary.json`.
    pub const fn kept(self, name: &'static str, column: &'static str) -> Self {
        Self { name, column, entry: Some(self.column), ..self }
    }

    /// Its name in `summary.json` or `analysis.json`.
    pub const fn entry(&self) -> &'static str {
        match self.entry {
            Some(entry) => entry,
            None => self.column,
        }
    }

    /// Its label on the terminal.
    pub const fn terse(&self) -> &'static str {
        match self.short {
            Some(short) => short,
            None => self.label,
        }
    }

    /// Its value in SI units; none if this one has none.
    pub fn value(&self, found: &T) -> Option<Value> {
        match self.formula {
            Formula::Observed => None,
            Formula::Count(count) => Some(Value::Count(count(found))),
            Formula::Number(number) => Some(Value::Number(number(found))),
            Formula::Known(number) => number(found).map(Value::Number),
            Formula::Mean(mean) => {
                let (mean, standard_error) = mean(found);
                Some(Value::Mean { mean, standard_error })
            }
            Formula::Interval(interval) => Some(Value::Interval(interval(found))),
            Formula::Reported(known) => known(found).map(Value::Reported),
        }
    }

    /// Its value as a number in SI units; NaN if this one has none.
    pub fn number(&self, found: &T) -> f64 {
        self.value(found).map_or(f64::NAN, |value| value.number())
    }

    /// Its row of a table.
    pub fn of(&'static self, found: &T) -> Measured<T> {
        let value = self.value(found).map(|value| match value {
            Value::Number(number) => Value::Number(number - self.zero),
            other => other,
        });
        let error = match value {
            Some(Value::Mean { standard_error, .. }) => standard_error,
            _ => {
                let of_one = self.errors.iter().find(|error| error.role == ErrorRole::OfOne);
                let standard = of_one.and_then(|error| error.value(found));
                standard.map(|error| error.number())
            }
        };
        Measured { measure: self, value, error, remark: (self.remark)(found) }
    }
}

/// A group of measures: a heading of tables, and a part of `summary.json`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Group {
    /// Name in `summary.json`.
    pub name: &'static str,
    /// Heading.
    pub title: &'static str,
}

/// What kind of result a measure is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MeasureKind {
    /// A number.
    Number,
    /// A curve along the fibre, over the distance from the root [m].
    Profile,
    /// A curve over time [s], one value for each recorded instant.
    Series,
    /// A curve over frequency [Hz].
    Spectrum,
    /// A curve between the inlet and the belt, over the distance from the inlet along x [m].
    Way,
    /// A curve over the length of fibre between two points [m].
    Lag,
    /// A curve over the direction on the belt [degrees], 0 in machine direction.
    Direction,
}

impl MeasureKind {
    /// The abscissa of the curve: its name with the SI unit in a table, its label on an axis, and its unit.
    pub const fn abscissa(self) -> Option<(&'static str, &'static str, Unit)> {
        match self {
            Self::Number => None,
            Self::Profile => Some(("distance_m", "Distance from the root along the fibre", MILLIMETRES)),
            Self::Series => Some(("time_s", "Time", Unit { shown: "s", per_si: 1.0 })),
            Self::Spectrum => Some(("frequency_hz", "Frequency *f*", HERTZ)),
            Self::Way => Some(("distance_m", "Distance from the inlet", MILLIMETRES)),
            Self::Lag => Some(("lag_m", "Length of fibre between two points", MILLIMETRES)),
            Self::Direction => {
                Some(("direction_degrees", "Direction on the belt", Unit { shown: "°", per_si: 1.0 }))
            }
        }
    }
}

/// The statistic over the replicates that stands for all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Aggregate {
    /// Their mean, which has a standard error.
    Mean,
    /// Their median.
    Median,
    /// The largest.
    Largest,
}

/// A figure of one or more measures.
#[derive(Debug, PartialEq)]
pub struct Figure {
    /// Name of its files.
    pub name: &'static str,
    /// Its title, which also names the axis of the measures.
    pub title: &'static str,
    /// What it shows, in words: `amplitude`.
    pub words: &'static str,
    /// Whether the axis of the measures is logarithmic.
    pub logarithmic: bool,
    /// Whether that axis begins at zero.
    pub from_zero: bool,
    /// Sentences under a curve.
    pub caption: &'static str,
}

/// A figure of numbers without a caption of its own, whose axis begins at zero.
pub const fn figure(name: &'static str, title: &'static str, words: &'static str) -> Figure {
    Figure { name, title, words, logarithmic: false, from_zero: true, caption: "" }
}
