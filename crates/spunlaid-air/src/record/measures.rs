//! What is measured of a velocity record. `analysis.json`, the terminal, the report and Python follow from it.

use super::{Analysis, Component};
use Formula::{Interval, Number};
use spunlaid_ground::{
    Dimension, Formula, HERTZ, METRES_PER_SECOND, MILLIMETRES, Measure, PERCENT, RATIO, Unit,
};

type OfRecord = Measure<Analysis>;
type OfComponent = Measure<Component>;

/// The measures of a record, in the order of the tables: what the `[air]` of a case needs.
pub const RECORD_MEASURES: &[Measure<Analysis>] = &[
    result("mean_velocity_m_s", "Mean velocity", METRES_PER_SECOND, |record| record.mean_velocity)
        .meaning("mean of the component along the flow")
    .remark(|record| Some(format!("mean of {}", along(record)))),
    result("turbulence_intensity", "Turbulence intensity", PERCENT, |record| record.turbulence_intensity)
        .meaning("root of the mean variance of the components over the mean velocity")
    .remark(|record| {
        let is_single = record.components.len() < 2;
        is_single.then(|| "rms of the fluctuation over the mean velocity".to_owned())
    }),
    result("integral_time_s", "Integral time", MILLISECONDS, |record| record.integral_time)
        .meaning("integral of the autocorrelation of the component along the flow")
    .remark(|record| {
        Some(format!("autocorrelation of {}, integrated {}", along(record), record.integral.words()))
    }),
    result("length_scale_m", "Length scale", MILLIMETRES, |record| record.length_scale)
        .meaning("integral time × mean velocity: Taylor’s hypothesis"),
    result("cutoff_frequency_hz", "Cut-off frequency", HERTZ, |record| record.cutoff_frequency).meaning(
        "variance of the component along the flow over the plateau of its spectrum: where a flat spectrum ends",
    )
    .remark(|record| {
        Some(format!(
            "variance of {} over the plateau of its spectrum: here a flat spectrum with this variance and this \
             plateau would end",
            along(record)
        ))
    }),
];

/// The measures of each component of a record, in the order of the tables; what has no label stands in
/// `analysis.json` alone.
pub const COMPONENT_MEASURES: &[Measure<Component>] = &[
    OfComponent::new("mean_m_s", "Mean", METRES_PER_SECOND, Interval(|found| found.mean))
        .meaning("mean over the record"),
    OfComponent::new("rms_m_s", "Rms", METRES_PER_SECOND, Interval(|found| found.rms))
        .meaning("root mean square of the fluctuation about the mean"),
    OfComponent::new("skewness", "Skewness", RATIO, Interval(|found| found.skewness))
        .meaning("0 for a Gaussian"),
    OfComponent::new("flatness", "Flatness", RATIO, Interval(|found| found.flatness))
        .meaning("3 for a Gaussian"),
    OfComponent::new("minimum_m_s", "", METRES_PER_SECOND, Number(|found| found.range.0))
        .meaning("smallest sample"),
    OfComponent::new("maximum_m_s", "", METRES_PER_SECOND, Number(|found| found.range.1))
        .meaning("largest sample"),
    OfComponent::new("integral_time_s", "Integral time", MILLISECONDS, Interval(|found| found.integral_time))
        .meaning("integral of the autocorrelation")
        .remark(|found| {
            let time = |s: f64| Dimension::Time.pretty_to(s, 3);
            Some(format!(
                "{}, here {}; by the plateau of the spectrum {}",
                found.integral.words(),
                time(found.autocorrelation.limit),
                time(found.flat.integral_time())
            ))
        }),
    OfComponent::new("integral_limit_s", "", MILLISECONDS, Number(|found| found.autocorrelation.limit))
        .meaning("lag at which that integral ends"),
    OfComponent::new(
        "integral_time_of_plateau_s",
        "",
        MILLISECONDS,
        Number(|found| found.flat.integral_time()),
    )
    .meaning("integral time by the plateau of the spectrum"),
    OfComponent::new(
        "plateau_m2_s2_per_hz",
        "Plateau of the spectrum",
        Unit { shown: "10⁻³ (m/s)²/Hz", per_si: 1e3 },
        Interval(|found| found.flat.density),
    )
    .meaning("mean density at low frequencies")
    .remark(|found| {
        Some(format!("mean density up to {}", Dimension::Frequency.pretty_to(found.flat.until, 3)))
    }),
    OfComponent::new("plateau_until_hz", "", HERTZ, Number(|found| found.flat.until))
        .meaning("where the plateau ends"),
    OfComponent::new("cutoff_frequency_hz", "Cut-off frequency", HERTZ, Interval(|found| found.flat.cutoff))
        .meaning("variance over plateau"),
    OfComponent::new(
        "drift_of_mean_m_s",
        "Drift of the mean",
        METRES_PER_SECOND,
        Interval(|found| found.mean_trend.change),
    )
    .meaning("from start to end, by a straight line"),
    OfComponent::new(
        "drift_of_rms_m_s",
        "Drift of the rms",
        METRES_PER_SECOND,
        Interval(|found| found.rms_trend.change),
    )
    .meaning("from start to end, by a straight line"),
];

const fn result(
    column: &'static str,
    label: &'static str,
    unit: Unit,
    found: fn(&Analysis) -> spunlaid_ground::Interval,
) -> Measure<Analysis> {
    OfRecord::new(column, label, unit, Interval(found))
}

const MILLISECONDS: Unit = Unit { shown: "ms", per_si: 1e3 };

/// Name of the component along the flow.
fn along(analysis: &Analysis) -> &str {
    analysis.components.first().map_or("u", |component| component.name.as_str())
}
