//! The flights of the paper: its figures, its claims, and the choices that it leaves open.

use super::figures as draw;
use crate::Failure;
use crate::reports::study::shown;
use spunlaid_charts::Figure;
use spunlaid_experiment::study::{results_of_point, run};
use spunlaid_experiment::{Claim, Journal, PointResults, Progress, Replicates, Study};
use spunlaid_fibre::Case;
use spunlaid_ground::RunContext;
use spunlaid_ground::error::counted;
use spunlaid_ground::threads::unlock;
use spunlaid_input::paper::{
    Parameter, TrendPoint, choices as choices_of_the_paper, claims_of_step_errors, claims_of_trend,
    in_scheme, time_steps,
};
use spunlaid_simulation::ensemble::{fly, turbulence_spectrum, velocity_record};
use spunlaid_simulation::{CurveValue, KeepShapes, Number, Recorded, Results, SpectrumPoint};
use std::sync::Mutex;

/// The figures that can be chosen.
pub const FIGURES: [&str; 9] = ["2", "3", "8a", "8b", "9", "10", "11a", "11b", "11c"];

/// A varied parameter and the points of its study.
#[derive(Debug)]
struct Trend {
    parameter: Parameter,
    /// The values [SI], each with the index of its point in the joint study.
    points: Vec<(f64, usize)>,
}

/// All flights that are needed.
#[derive(Debug)]
pub struct PaperFlights {
    figures: Vec<&'static str>,
    /// Table 1 with several time steps, for Figures 8a and 8b.
    steps: Vec<Case>,
    trends: Vec<Trend>,
    /// The names of the choices, each with the index of its point in the joint study.
    choices: Vec<(&'static str, usize)>,
    /// The joint study: all points of the trends and choices.
    study: Study,
    base: Case,
}

impl PaperFlights {
    /// Those that some of [`FIGURES`] need.
    ///
    /// # Errors
    /// If a case of the paper cannot be read.
    pub fn new(base: &Case, figures: &[&'static str]) -> Result<Self, Failure> {
        let wants = |figure| figures.contains(&figure);
        // Points that several studies share, such as Table 1, are simulated once.
        let mut cases: Vec<Case> = Vec::new();
        let mut place = |case: Case| {
            let mut case = in_scheme(case, base.run.scheme, base.run.time_step);
            case.run.replicates = base.run.replicates;
            cases.iter().position(|known| *known == case).unwrap_or_else(|| {
                cases.push(case);
                cases.len() - 1
            })
        };
        let mut trends = Vec::new();
        for parameter in Parameter::ALL.into_iter().filter(|parameter| wants(parameter.figure())) {
            let study = parameter.study()?;
            let points = study.points.iter();
            let points =
                points.filter_map(|point| Some((point.values[0], place(point.experiment.case()?.clone()))));
            trends.push(Trend { parameter, points: points.collect() });
        }
        let mut choices = Vec::new();
        if figures.len() == FIGURES.len() {
            for (name, case) in choices_of_the_paper()? {
                choices.push((name, place(case)));
            }
        }
        let mut steps: Vec<Case> =
            time_steps()?.points.iter().filter_map(|point| point.experiment.case().cloned()).collect();
        steps.truncate(if wants("8b") { usize::MAX } else { usize::from(wants("8a")) });
        for case in &mut steps {
            case.run.replicates = base.run.replicates;
        }
        let study = Study::from_cases(cases, Replicates::fixed(base.run.replicates));
        Ok(Self { figures: figures.to_vec(), steps, trends, choices, study, base: base.clone() })
    }

    /// Number of fibres.
    pub fn fibres(&self) -> u64 {
        self.study.most_fibres() + self.steps.len() as u64 * self.base.run.replicates
    }

    /// Number of steps of all fibres.
    pub fn steps(&self) -> u64 {
        let cases = self.study.points.iter().filter_map(|point| point.experiment.case());
        let points = cases.map(|case| case.run.steps * case.run.replicates);
        let steps = self.steps.iter().map(|case| case.run.steps * case.run.replicates);
        points.chain(steps).sum()
    }

    /// Flies them.
    ///
    /// # Errors
    /// If a flight fails or is stopped.
    pub fn fly(self, computing: RunContext<'_>) -> Result<PaperResults, Failure> {
        let journal = Mutex::new(Journal::in_memory());
        run(&self.study, &journal, computing, &Progress::default())?;
        let mut journal = unlock(journal);
        let points = (0..self.study.points.len())
            .map(|point| results_of_point(&self.study, &mut journal, point))
            .collect::<Result<Vec<_>, _>>()?;
        let mut steps = Vec::new();
        for case in &self.steps {
            let shapes = KeepShapes { replicates: 1, every: case.run.steps / case.run.output_steps };
            let keep = Recorded { shapes, ..Recorded::CURVES };
            let mut collector = Results::collector(1);
            fly(case, keep, computing, |trajectory| {
                collector.take(trajectory);
                Ok::<(), Failure>(())
            })?;
            steps.push((case.run.time_step, collector.finish()));
        }
        let wants = |figure| self.figures.contains(&figure);
        let record = if wants("2") { velocity_record(&self.base, computing.isa, 0.5)? } else { Vec::new() };
        let spectrum = if wants("3") { turbulence_spectrum(&self.base, computing)? } else { Vec::new() };
        Ok(PaperResults { flying: self, points, steps, record, spectrum })
    }
}

/// The results of all flights.
#[derive(Debug)]
pub struct PaperResults {
    flying: PaperFlights,
    points: Vec<PointResults>,
    /// Time steps and their results.
    steps: Vec<(f64, Results)>,
    record: Vec<(f64, f64)>,
    spectrum: Vec<SpectrumPoint>,
}

impl PaperResults {
    fn trend(&self, trend: &Trend) -> Vec<TrendPoint> {
        trend.points.iter().map(|&(value, point)| TrendPoint::new(value, &self.points[point])).collect()
    }

    fn errors(&self) -> Vec<(f64, Vec<CurveValue>)> {
        self.steps
            .iter()
            .map(|(step, results)| (*step, results.curve("work_error_over_time").to_vec()))
            .collect()
    }

    /// The figures.
    pub fn figures(&self, base: &Case) -> Vec<Figure> {
        let mut figures = Vec::new();
        let wants = |figure| self.flying.figures.contains(&figure);
        if wants("2") {
            figures.push(draw::velocity_history(&self.record, base.air.velocity));
        }
        if wants("3") {
            figures.push(draw::spectrum(&self.spectrum));
        }
        let last = self.steps.first().and_then(|(_, r)| r.trajectories.first()?.shapes.last());
        if let (true, Some(shape)) = (wants("8a"), last) {
            figures.push(draw::final_shape(&shape.position));
        }
        if wants("8b") {
            figures.push(draw::step_errors(&self.errors()));
        }
        for trend in &self.flying.trends {
            figures.extend(draw::trend(trend.parameter, &self.trend(trend)));
        }
        figures
    }

    /// What the paper claims, judged.
    pub fn claims(&self) -> Vec<Claim> {
        let errors: Vec<_> = self
            .steps
            .iter()
            .map(|(step, r)| {
                (
                    *step,
                    r.estimate("work_error_at_end").mean,
                    r.number("work_error").map_or(f64::NAN, Number::value),
                )
            })
            .collect();
        let mut claims =
            if self.flying.figures.contains(&"8b") { claims_of_step_errors(&errors) } else { Vec::new() };
        for trend in &self.flying.trends {
            claims.extend(claims_of_trend(trend.parameter, &self.trend(trend)));
        }
        claims
    }

    /// How it was computed, in a sentence.
    pub fn how(&self) -> String {
        let Case { run, .. } = &self.flying.base;
        format!(
            "{} at each point, scheme {}, time step {} µs, the same random phases at all points of a figure. \
            Figures 8a and 8b always use the paper’s own scheme.",
            counted(run.replicates, "replicate"),
            run.scheme.name(),
            run.time_step * 1e6
        )
    }

    /// Table 1 with each choice: amplitudes [mm] and frequencies [Hz] with their errors.
    pub fn choices(&self) -> Vec<(String, Vec<String>)> {
        let cells = |point: usize| {
            let study = &self.flying.study;
            let names = ["amplitude_y", "amplitude_z", "frequency_y", "frequency_z"];
            let all = names.into_iter().filter_map(|name| study.quantity(name));
            all.map(|quantity| shown::cell(study, &self.points[point], quantity)).collect()
        };
        self.flying.choices.iter().map(|&(name, point)| (name.to_owned(), cells(point))).collect()
    }
}
