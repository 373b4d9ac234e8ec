//! What fed fibres have laid on the belt since the last change; a number as the page shows it.

use super::fibres::Instant;
use serde::Serialize;
use spunlaid::fibre::Case;
use spunlaid::ground::{Estimate, Measure, WIDTH};
use spunlaid::simulation::{DECLARED, FibreMeasure};
use spunlaid::web::surrogate::identify;
use spunlaid::web::{Footprint, Trace, TraceSettings, laydown};
use std::array::from_fn;

/// Points of each fibre from one fit of the surrogate to the next, as a share of those that it had.
const FIT_AGAIN: f64 = 0.25;

/// The laid curves of eight fibres.
#[derive(Debug)]
pub(super) struct LaidStatistics {
    traces: [Trace; WIDTH],
    /// Points of the first fibre at the last fit of the surrogate, and the noises found.
    fitted: (u64, Vec<f64>),
}

/// Where the fibres came down, about the mean of each: counts on a lattice.
#[derive(Debug, Serialize, PartialEq)]
pub(super) struct Map {
    /// Side of a cell [mm].
    cell: f64,
    /// Cells in machine direction.
    columns: usize,
    /// Smallest coordinates, in machine and cross direction [mm].
    corner: [f64; 2],
    /// Row after row in cross direction.
    counts: Vec<u64>,
}

impl LaidStatistics {
    /// No points yet; `None` for fibres of fixed length.
    pub(super) fn new(case: &Case) -> Option<Self> {
        let line = case.line?;
        let belt_ratio = line.belt_ratio();
        let tracing =
            TraceSettings { spacing: case.fibre.rest_length(), belt_ratio, skip: 0, reach: line.distance };
        Some(Self { traces: from_fn(|_| Trace::new(tracing)), fitted: (0, Vec::new()) })
    }

    pub(super) fn see(&mut self, instant: &Instant<'_>) {
        for (trace, points) in self.traces.iter_mut().zip(instant.laid) {
            points.iter().for_each(|point| trace.add(point.md, point.cd));
        }
    }

    /// Spreads, correlation lengths and the surrogate. The errors are those over the eight fibres.
    pub(super) fn numbers(&mut self) -> Vec<ShownNumber> {
        let curves = self.traces.each_ref().map(Trace::finish);
        let points = self.traces[0].points();
        // A fit takes longer than all else.
        if points as f64 > (1.0 + FIT_AGAIN) * self.fitted.0 as f64 {
            let noises = curves.iter().filter_map(|curve| {
                let sigmas = [curve.sigma_md, curve.sigma_cd];
                let found = identify(sigmas, curve.lag_step, [&curve.correlation_md, &curve.correlation_cd]);
                Some(found?.surrogate.noise)
            });
            self.fitted = (points, noises.collect());
        }
        let values_of =
            |quantity: fn(&laydown::LaidCurve) -> f64| curves.iter().map(quantity).collect::<Vec<f64>>();
        let all = [
            ("sigma_md", values_of(|curve| curve.sigma_md)),
            ("sigma_cd", values_of(|curve| curve.sigma_cd)),
            ("noise", self.fitted.1.clone()),
            ("half_correlation_length_md", values_of(|curve| curve.half_correlation_length_md)),
            ("half_correlation_length_cd", values_of(|curve| curve.half_correlation_length_cd)),
            ("orientation_md", values_of(|curve| curve.orientation_md)),
        ];
        all.into_iter().filter_map(|(name, values)| ShownNumber::of_fibres(name, values)).collect()
    }

    /// Where the fibres came down; `None` before they have.
    pub(super) fn map(&self) -> Option<Map> {
        let curves = self.traces.each_ref().map(Trace::finish);
        let with_points = || curves.iter().filter(|curve| curve.mean[0].is_finite());
        let cell = with_points().map(|curve| curve.footprint.cell).fold(0.0, f64::max);
        let mut counted = Vec::new();
        for curve in with_points() {
            counted.extend(
                cells(&curve.footprint, curve.mean)
                    .map(|(at, count)| (at.map(|x| (x / cell).floor()), count)),
            );
        }
        let range = |axis: usize| {
            let places = || counted.iter().map(|(place, _)| place[axis]);
            (places().fold(f64::INFINITY, f64::min), places().fold(f64::NEG_INFINITY, f64::max))
        };
        let ((left, right), (bottom, top)) = (range(0), range(1));
        let [columns, rows] = [right - left, top - bottom].map(|cells| cells as usize + 1);
        if counted.is_empty() || columns.saturating_mul(rows) > 1 << 16 {
            return None;
        }
        let mut counts = vec![0; columns * rows];
        for ([column, row], count) in counted {
            counts[(row - bottom) as usize * columns + (column - left) as usize] += count;
        }
        Some(Map { cell: 1e3 * cell, columns, corner: [left, bottom].map(|x| 1e3 * cell * x), counts })
    }
}

/// The middles of the cells that hold points, relative to a place [m], and their counts.
fn cells(footprint: &Footprint, mean: [f64; 2]) -> impl Iterator<Item = ([f64; 2], u64)> {
    let (corner, cell) = (footprint.corner(), footprint.cell);
    footprint.rows().enumerate().flat_map(move |(row, counts)| {
        counts.iter().enumerate().filter(|(_, count)| **count > 0).map(move |(column, count)| {
            let middle = |index: usize, axis: usize| corner[axis] + (index as f64 + 0.5) * cell - mean[axis];
            ([middle(column, 0), middle(row, 1)], *count)
        })
    })
}

/// A number with its standard error, in the unit in which it is shown.
#[derive(Debug, Serialize)]
pub(super) struct ShownNumber {
    pub(super) name: &'static str,
    label: &'static str,
    meaning: &'static str,
    unit: &'static str,
    pub(super) value: Option<f64>,
    pub(super) error: Option<f64>,
}

impl ShownNumber {
    /// The mean of a measure over the fibres, with the error that its scatter reports.
    ///
    /// * `values` – of each fibre, in SI units; NaN where there is none
    pub(super) fn of_fibres(name: &str, mut values: Vec<f64>) -> Option<Self> {
        values.retain(|value| value.is_finite());
        let Estimate { mean, standard_error, .. } = Estimate::new(values);
        let Measure { name, label, meaning, unit, .. } = *measure(name)?;
        let finite = |x: f64| x.is_finite().then_some(x * unit.per_si);
        Some(Self {
            name,
            label,
            meaning,
            unit: unit.shown,
            value: finite(mean),
            error: standard_error.and_then(finite),
        })
    }
}

pub(super) fn measure(name: &str) -> Option<&'static FibreMeasure> {
    DECLARED.iter().flat_map(|declared| declared.measures).find(|measure| measure.name == name)
}

#[cfg(test)]
mod tests {
    use super::super::fibres::Fibres;
    use super::super::measured::Statistics;
    use super::*;
    use spunlaid::input::{read_case, starter_case, starter_case_of_fed};

    #[test]
    fn the_map_holds_every_point_and_the_spread_is_that_of_the_points() {
        let (case, _) =
            read_case((starter_case_of_fed(), "fed.toml"), &[("fibre.element_length".into(), "4 mm".into())])
                .unwrap();
        let mut statistics = LaidStatistics::new(&case).unwrap();
        let mut fibres = Fibres::new(case.clone()).unwrap();
        let mut points: Vec<f64> = Vec::new();
        let mut all = 0;
        fibres
            .fly((0.2 / case.run.time_step) as u64, |instant| {
                statistics.see(&instant);
                points.extend(instant.laid[2].iter().map(|point| point.cd));
                all += instant.laid.iter().map(Vec::len).sum::<usize>() as u64;
            })
            .unwrap();
        let n = points.len() as f64;
        let mean = points.iter().sum::<f64>() / n;
        let sigma = (points.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / n).sqrt();
        assert!((statistics.traces[2].finish().sigma_cd / sigma - 1.0).abs() < 1e-9);
        let map = statistics.map().unwrap();
        assert_eq!(map.counts.iter().sum::<u64>(), all);
        assert_eq!(map.counts.len() % map.columns, 0);
        assert!(map.corner.iter().all(|corner| *corner < 0.0), "{map:?}");
    }

    #[test]
    fn standard_deviations_are_reported_with_errors_after_the_fibres_have_landed() {
        let (case, _) =
            read_case((starter_case_of_fed(), "fed.toml"), &[("fibre.element_length".into(), "4 mm".into())])
                .unwrap();
        let mut fibres = Fibres::new(case.clone()).unwrap();
        let mut measured = Statistics::new(&case, fibres.flight());
        fibres.fly((0.5 / case.run.time_step) as u64, |instant| measured.see(instant)).unwrap();
        let statistics = serde_json::to_value(measured.message(3, fibres.flight())).unwrap();
        assert_eq!(statistics["numbers"][0]["name"], "sigma_md");
        let sigma = statistics["numbers"][0]["value"].as_f64().unwrap();
        let error = statistics["numbers"][0]["error"].as_f64().unwrap();
        assert!(sigma > 1.0 && error > 0.0 && error < sigma, "{statistics}");
    }

    #[test]
    fn fibres_of_fixed_length_lay_nothing() {
        let (case, _) = read_case((starter_case(), "a.toml"), &[]).unwrap();
        assert!(LaidStatistics::new(&case).is_none());
    }
}
