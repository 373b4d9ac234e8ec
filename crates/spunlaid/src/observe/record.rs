//! What is measured of a velocity record. Each measure is declared once: its name, label, unit, meaning, and how it is found.
//! `analysis.json`, the terminal, the report and Python follow from it.

use super::{HERTZ, MILLIMETRES, PERCENT, RATIO, Unit};
use crate::record::{Analysis, Component, Interval};
use crate::units::Dimension;

/// A measure of a record, or of one of its components.
#[derive(Debug)]
pub struct RecordMeasure<T: 'static> {
    /// Name in `analysis.json`, with its SI unit.
    pub name: &'static str,
    /// Its label in tables; empty if it stands in `analysis.json` alone.
    pub label: &'static str,
    /// The unit in which tables show it.
    pub unit: Unit,
    /// What it means, of an analysis and what it is a measure of.
    pub meaning: fn(&Analysis, &T) -> String,
    /// Its value in SI units.
    pub number: fn(&T) -> RecordNumber,
}

/// The value of a measure of a record.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
#[serde(untagged)]
pub enum RecordNumber {
    /// With its 95 % confidence interval.
    Interval(Interval),
    /// Without one.
    Plain(f64),
}

impl<T> RecordMeasure<T> {
    /// A number that stands in `analysis.json` alone.
    const fn untold(name: &'static str, number: fn(&T) -> RecordNumber) -> Self {
        Self { name, label: "", unit: RATIO, meaning: |_, _| String::new(), number }
    }
}

/// The measures of a record, in the order of the tables: what the `[air]` of a case needs.
pub const OF_RECORDS: &[RecordMeasure<Analysis>] = &[
    RecordMeasure {
        name: "mean_velocity_m_s",
        label: "Mean velocity",
        unit: METRES_PER_SECOND,
        meaning: |analysis, _| format!("mean of {}", along(analysis)),
        number: |found| RecordNumber::Interval(found.mean_velocity),
    },
    RecordMeasure {
        name: "turbulence_intensity",
        label: "Turbulence intensity",
        unit: PERCENT,
        meaning: |analysis, _| {
            let meaning = match analysis.components.len() {
                0 | 1 => "rms of the fluctuation over the mean velocity",
                _ => "square root of the mean of the components’ variances, over the mean velocity",
            };
            meaning.to_owned()
        },
        number: |found| RecordNumber::Interval(found.turbulence_intensity),
    },
    RecordMeasure {
        name: "integral_time_s",
        label: "Integral time",
        unit: MILLISECONDS,
        meaning: |analysis, _| {
            format!("autocorrelation of {}, integrated {}", along(analysis), analysis.integral.words())
        },
        number: |found| RecordNumber::Interval(found.integral_time),
    },
    RecordMeasure {
        name: "length_scale_m",
        label: "Length scale",
        unit: MILLIMETRES,
        meaning: |_, _| "integral time × mean velocity: Taylor’s hypothesis".to_owned(),
        number: |found| RecordNumber::Interval(found.length_scale),
    },
    RecordMeasure {
        name: "cutoff_frequency_hz",
        label: "Cut-off frequency",
        unit: HERTZ,
        meaning: |analysis, _| {
            format!(
                "variance of {} over the plateau of its spectrum: here a flat spectrum with this variance and this \
                 plateau would end",
                along(analysis)
            )
        },
        number: |found| RecordNumber::Interval(found.cutoff_frequency),
    },
];

/// The measures of each component of a record, in the order of the tables.
pub const OF_COMPONENTS: &[RecordMeasure<Component>] = &[
    RecordMeasure {
        name: "mean_m_s",
        label: "Mean",
        unit: METRES_PER_SECOND,
        meaning: |_, _| String::new(),
        number: |found| RecordNumber::Interval(found.mean),
    },
    RecordMeasure {
        name: "rms_m_s",
        label: "Rms",
        unit: METRES_PER_SECOND,
        meaning: |_, _| "root mean square of the fluctuation about the mean".to_owned(),
        number: |found| RecordNumber::Interval(found.rms),
    },
    RecordMeasure {
        name: "skewness",
        label: "Skewness",
        unit: RATIO,
        meaning: |_, _| "0 for a Gaussian".to_owned(),
        number: |found| RecordNumber::Interval(found.skewness),
    },
    RecordMeasure {
        name: "flatness",
        label: "Flatness",
        unit: RATIO,
        meaning: |_, _| "3 for a Gaussian".to_owned(),
        number: |found| RecordNumber::Interval(found.flatness),
    },
    RecordMeasure::untold("minimum_m_s", |found| RecordNumber::Plain(found.range.0)),
    RecordMeasure::untold("maximum_m_s", |found| RecordNumber::Plain(found.range.1)),
    RecordMeasure {
        name: "integral_time_s",
        label: "Integral time",
        unit: MILLISECONDS,
        meaning: |analysis, found| {
            let time = |s: f64| Dimension::Time.pretty_to(s, 3);
            format!(
                "{}, here {}; by the plateau of the spectrum {}",
                analysis.integral.words(),
                time(found.autocorrelation.limit),
                time(found.flat.integral_time())
            )
        },
        number: |found| RecordNumber::Interval(found.integral_time),
    },
    RecordMeasure::untold("integral_limit_s", |found| RecordNumber::Plain(found.autocorrelation.limit)),
    RecordMeasure::untold("integral_time_of_plateau_s", |found| {
        RecordNumber::Plain(found.flat.integral_time())
    }),
    RecordMeasure {
        name: "plateau_m2_s2_per_hz",
        label: "Plateau of the spectrum",
        unit: Unit { shown: "10⁻³ (m/s)²/Hz", per_si: 1e3 },
        meaning: |_, found| {
            format!("mean density up to {}", Dimension::Frequency.pretty_to(found.flat.until, 3))
        },
        number: |found| RecordNumber::Interval(found.flat.density),
    },
    RecordMeasure::untold("plateau_until_hz", |found| RecordNumber::Plain(found.flat.until)),
    RecordMeasure {
        name: "cutoff_frequency_hz",
        label: "Cut-off frequency",
        unit: HERTZ,
        meaning: |_, _| "variance over plateau".to_owned(),
        number: |found| RecordNumber::Interval(found.flat.cutoff),
    },
    RecordMeasure {
        name: "drift_of_mean_m_s",
        label: "Drift of the mean",
        unit: METRES_PER_SECOND,
        meaning: |_, _| FROM_START_TO_END.to_owned(),
        number: |found| RecordNumber::Interval(found.mean_trend.change),
    },
    RecordMeasure {
        name: "drift_of_rms_m_s",
        label: "Drift of the rms",
        unit: METRES_PER_SECOND,
        meaning: |_, _| FROM_START_TO_END.to_owned(),
        number: |found| RecordNumber::Interval(found.rms_trend.change),
    },
];

const METRES_PER_SECOND: Unit = Unit { shown: "m/s", per_si: 1.0 };
const MILLISECONDS: Unit = Unit { shown: "ms", per_si: 1e3 };
const FROM_START_TO_END: &str = "from start to end, by a straight line";

/// Name of the component along the flow.
fn along(analysis: &Analysis) -> &str {
    analysis.components.first().map_or("u", |component| component.name.as_str())
}
