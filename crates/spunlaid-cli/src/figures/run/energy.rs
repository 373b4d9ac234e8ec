//! How far the energies are off.

use spunlaid::case::Case;
use spunlaid::ensemble::ErrorOverTime;
use spunlaid_charts::{
    Axis, Chart, Figure, Series,
    palette::{GREEN, PURPLE},
};

/// Most points over time; more are taken together.
const POINTS: usize = 250;

/// Mean and largest of an error over the replicates at an instant.
type Pick = fn(&ErrorOverTime) -> (f64, f64);

/// Both energy errors over time.
pub(super) fn errors(case: &Case, errors: &[ErrorOverTime]) -> Figure {
    let each = errors.len().div_ceil(POINTS).max(1);
    let panel = |name: &str, label: &str, colour, pick: Pick| {
        let (mean, band) = taken_together(errors, each, pick);
        let x = Axis::linear("").in_column("time_s").tight().including(0.0);
        let all = |of: fn((f64, f64)) -> f64| errors.iter().map(|e| (e.time, of(pick(e)), None)).collect();
        let chart = Chart::new(name, "", x, Axis::logarithmic("Error (%)").steady())
            .when_empty("no energy to compare with");
        let several = case.run.replicates > 1 || each > 1;
        let largest = format!("{label} largest");
        let label = if several { format!("{label}, mean") } else { label.to_owned() };
        let line = Series::new(&label, colour)
            .named(&label.replace(',', ""))
            .width(1.2)
            .thinned_from(all(|(mean, _)| mean));
        let chart = chart.line(line, &mean);
        let band_series = Series::new("up to the largest", colour).named(&largest);
        let band_series = band_series.thinned_from(all(|(_, largest)| largest));
        if several { chart.band(band_series, &band) } else { chart }
    };
    let work = panel("work_check", "work check", PURPLE, |e| e.work);
    let mut balance = panel("energy_balance", "energy balance", GREEN, |e| e.balance);
    balance.x.label = "Time *t* (s)".to_owned();
    let title = "Errors of the energy over time";
    let over = match (case.run.replicates, each) {
        (0 | 1, 1) => "of the only replicate".to_owned(),
        (0 | 1, n) => format!("mean and largest over {n} recorded instants at a time"),
        (_, 1) => "mean and largest over the replicates".to_owned(),
        (_, n) => format!("mean and largest over the replicates and {n} recorded instants at a time"),
    };
    let caption = format!(
        "Two checks on the computation, {over}. Work check: the work of all forces against the kinetic energy. Energy \
         balance: kinetic and elastic energy less the work of gravity, air and damping, relative to the work of the air. \
         Both would be zero with an infinitely small time step; at the very start they are large because there is little \
         energy yet."
    );
    let (work, balance) = (work.sized(640.0, 230.0), balance.sized(640.0, 250.0));
    Figure::stacked("energy_errors", title, &[&work, &balance], caption)
}

/// The mean, and the band from it to the largest, over so many instants at a time.
#[allow(clippy::type_complexity)]
fn taken_together(
    errors: &[ErrorOverTime],
    each: usize,
    pick: Pick,
) -> (Vec<(f64, f64)>, Vec<(f64, f64, f64)>) {
    let together = |some: &[ErrorOverTime]| {
        let known: Vec<_> = some.iter().map(pick).filter(|e| e.0.is_finite()).collect();
        let mean = known.iter().map(|e| e.0).sum::<f64>() / known.len() as f64;
        let largest = known.iter().map(|e| e.1).fold(f64::NAN, f64::max);
        (some[some.len() / 2].time, mean, largest)
    };
    let band: Vec<_> = errors.chunks(each).map(together).collect();
    (band.iter().map(|&(t, mean, _)| (t, mean)).collect(), band)
}
