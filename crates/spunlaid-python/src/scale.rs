//! Scales of axes, for plots.

use spunlaid_results::figures::Scale;

/// Label with unit, zero and factor from SI units, whether logarithmic. `_plot.Axis` of Python has the same.
pub(crate) type AxisScale = (String, f64, f64, bool);

/// A scale for Python.
pub(crate) fn scale(scale: Scale) -> AxisScale {
    (scale.label, scale.zero, scale.per_si, scale.logarithmic)
}
