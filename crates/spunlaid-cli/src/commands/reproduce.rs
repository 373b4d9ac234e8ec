//! `spunlaid reproduce`: the paper's figures anew, and its claims put to the test.

use super::interrupt::stop_on_ctrl_c;
use super::{plural, threads};
use crate::args::{Reproduce, SchemeName};
use crate::failure::Failure;
use crate::figures::{Figure, paper as draw};
use crate::output::folder::Staging;
use crate::output::pictures;
use crate::output::study::column_name;
use crate::report::{PaperReport, mean_and_error, paper_html};
use crate::{progress, say};
use serde::Serialize;
use spunlaid::case::Case;
use spunlaid::chain::schemes::Scheme;
use spunlaid::ensemble::{
    Computing, ErrorOverTime, KeepShapes, Results, SpectrumPoint, fly, turbulence_spectrum, velocity_record,
};
use spunlaid::input::write_case;
use spunlaid::lanes::Isa;
use spunlaid::paper::{
    Claim, Parameter, TrendPoint, choices as choices_of_the_paper, claims_of_step_errors, claims_of_trend,
    in_scheme, table1, time_steps,
};
use spunlaid::study::{Journal, PointResults, Progress, Replicates, Study, results_of_point, run};
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::atomic::AtomicU64;
use std::sync::{Mutex, PoisonError};

/// The figures there are to choose from.
const FIGURES: [&str; 9] = ["2", "3", "8a", "8b", "9", "10", "11a", "11b", "11c"];

pub(crate) fn reproduce(asked: &Reproduce) -> Result<(), Failure> {
    let wanted = chosen(&asked.figures)?;
    let scheme = match asked.scheme {
        SchemeName::SemiImplicitEuler => Scheme::SemiImplicitEuler,
        SchemeName::Leapfrog => Scheme::Leapfrog,
        SchemeName::ImplicitTension => Scheme::ImplicitTension,
    };
    let mut base = table1(scheme)?;
    base.run.replicates = asked.replicates;
    let folder = asked.out.clone().unwrap_or_else(|| PathBuf::from("results").join("paper"));
    let stop = stop_on_ctrl_c();
    let staging = Staging::new(&folder, asked.force, stop)?;
    let flying = Flying::new(&base, &wanted)?;

    let fibre_steps = AtomicU64::new(0);
    let computing =
        Computing { threads: threads(asked.threads), isa: Isa::detect(), stop, fibre_steps: &fibre_steps };
    let label = format!("flying {}", plural(flying.fibres(), "fibre"));
    let flown =
        progress::follow(&fibre_steps, flying.steps(), &label, asked.quiet, || flying.fly(computing))?;

    let figures = flown.figures(&base);
    let claims = flown.claims();
    let choices = flown.choices();
    for (figure, table) in &figures {
        staging.write(&format!("figures/{}.csv", figure.name), table)?;
    }
    let drawn: Vec<Figure> = figures.into_iter().map(|(figure, _)| figure).collect();
    pictures::write(&drawn, |name, content| staging.write(&format!("figures/{name}"), content))?;
    let case_toml = write_case(&base);
    let how = format!(
        "{} at each point, scheme {}, time step {} µs, the same random phases at all points of a figure. Figures 8 by \
         the paper’s own scheme whatever the others.",
        plural(base.run.replicates, "replicate"),
        scheme.name(),
        base.run.time_step * 1e6
    );
    let report = paper_html(&PaperReport {
        claims: &claims,
        figures: &drawn,
        choices: &choices,
        how: &how,
        case_toml: &case_toml,
        version: env!("CARGO_PKG_VERSION"),
    });
    staging.write("report.html", report)?;
    staging.write("case.toml", case_toml)?;
    staging.write("summary.json", summary(&claims))?;
    staging.publish()?;
    if !asked.quiet {
        for claim in &claims {
            say::line(&format!("{:<4} {:<13} {}", claim.figure, claim.verdict.name(), claim.claim));
            say::line(&format!("                   {}", claim.evidence));
        }
        say::line(&format!("open {}", folder.join("report.html").display()));
    }
    Ok(())
}

/// The figures asked for, all if none; `8`, `9` and `11` mean all their parts.
fn chosen(asked: &[String]) -> Result<Vec<&'static str>, Failure> {
    if asked.is_empty() {
        return Ok(FIGURES.to_vec());
    }
    let mut wanted = Vec::new();
    for name in asked {
        // 9a and 9b are drawn from the same flights.
        let plain = match name.as_str() {
            "9a" | "9b" => "9",
            "10a" | "10b" => "10",
            other => other,
        };
        let part = |figure: &str| figure.trim_end_matches(char::is_alphabetic) == plain;
        let found: Vec<_> = FIGURES.into_iter().filter(|&figure| figure == plain || part(figure)).collect();
        if found.is_empty() {
            return Err(Failure::NoSuchFigure { name: name.clone(), known: FIGURES.join(", ") });
        }
        wanted.extend(found);
    }
    Ok(FIGURES.into_iter().filter(|figure| wanted.contains(figure)).collect())
}

/// A parameter that is varied, and what its study says of it.
struct Trend {
    parameter: Parameter,
    /// What the values are called in a table.
    column: String,
    /// The values [SI], each with the place of its point in the study of everything.
    points: Vec<(f64, usize)>,
}

/// Everything that is to be flown.
struct Flying {
    wanted: Vec<&'static str>,
    /// Table 1 with several time steps, for Figures 8.
    steps: Vec<Case>,
    trends: Vec<Trend>,
    /// Each with the place of its point.
    choices: Vec<(&'static str, usize)>,
    /// All that the trends and choices need.
    study: Study,
    base: Case,
}

impl Flying {
    fn new(base: &Case, wanted: &[&'static str]) -> Result<Self, Failure> {
        let wants = |figure| wanted.contains(&figure);
        // Points that studies share, Table 1 above all, are flown once.
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
            let column = study.inputs().map(|(key, dimension)| column_name(key, dimension)).collect();
            let points = study.points.into_iter().map(|point| (point.values[0], place(point.case)));
            trends.push(Trend { parameter, column, points: points.collect() });
        }
        let mut choices = Vec::new();
        if wanted.len() == FIGURES.len() {
            for (name, case) in choices_of_the_paper()? {
                choices.push((name, place(case)));
            }
        }
        let mut steps: Vec<Case> = time_steps()?.points.into_iter().map(|point| point.case).collect();
        steps.truncate(if wants("8b") { usize::MAX } else { usize::from(wants("8a")) });
        for case in &mut steps {
            case.run.replicates = base.run.replicates;
        }
        let study = Study::of_cases(cases, Replicates::fixed(base.run.replicates));
        Ok(Self { wanted: wanted.to_vec(), steps, trends, choices, study, base: base.clone() })
    }

    fn fibres(&self) -> u64 {
        self.study.most_fibres() + self.steps.len() as u64 * self.base.run.replicates
    }

    /// Steps of all fibres.
    fn steps(&self) -> u64 {
        let points = self.study.points.iter().map(|p| p.case.run.steps * p.case.run.replicates);
        let steps = self.steps.iter().map(|case| case.run.steps * case.run.replicates);
        points.chain(steps).sum()
    }

    fn fly(self, computing: Computing<'_>) -> Result<Flown, Failure> {
        let journal = Mutex::new(Journal::in_memory(self.study.points.len()));
        run(&self.study, &journal, computing, &Progress::default())?;
        let mut journal = journal.into_inner().unwrap_or_else(PoisonError::into_inner);
        let points = (0..self.study.points.len())
            .map(|point| results_of_point(&mut journal, point))
            .collect::<Result<Vec<_>, _>>()?;
        let mut steps = Vec::new();
        for case in &self.steps {
            let keep = KeepShapes { replicates: 1, every: case.run.steps / case.run.output_steps };
            let mut collector = Results::collector(case, 1);
            fly(case, keep, computing, |flight| {
                collector.take(&flight);
                Ok::<(), Failure>(())
            })?;
            steps.push((case.run.time_step, collector.finish()));
        }
        let wants = |figure| self.wanted.contains(&figure);
        let record = if wants("2") { velocity_record(&self.base, computing.isa, 0.5) } else { Vec::new() };
        let spectrum = if wants("3") { turbulence_spectrum(&self.base, computing) } else { Vec::new() };
        Ok(Flown { flying: self, points, steps, record, spectrum })
    }
}

/// What has been flown.
struct Flown {
    flying: Flying,
    points: Vec<PointResults>,
    /// Time step and results.
    steps: Vec<(f64, Results)>,
    record: Vec<(f64, f64)>,
    spectrum: Vec<SpectrumPoint>,
}

impl Flown {
    fn trend(&self, trend: &Trend) -> Vec<TrendPoint> {
        trend.points.iter().map(|&(value, point)| TrendPoint::of(value, &self.points[point])).collect()
    }

    fn errors(&self) -> Vec<(f64, Vec<ErrorOverTime>)> {
        self.steps.iter().map(|(step, results)| (*step, results.errors.clone())).collect()
    }

    /// The figures, each with its data as CSV.
    fn figures(&self, base: &Case) -> Vec<(Figure, String)> {
        let mut figures = Vec::new();
        let wants = |figure| self.flying.wanted.contains(&figure);
        if wants("2") {
            let rows = self.record.iter().map(|&(t, u)| vec![t, u]);
            let figure = draw::velocity_history(&self.record, base.air.velocity);
            figures.push((figure, csv("time_s,velocity_m_s", rows)));
        }
        if wants("3") {
            let rows = self.spectrum.iter().map(|p| vec![p.frequency, p.realised, p.wanted]);
            let head = "frequency_hz,synthesised_m2_s,model_m2_s";
            figures.push((draw::spectrum(&self.spectrum), csv(head, rows)));
        }
        let last = self.steps.first().and_then(|(_, r)| r.flights.first()?.shapes.last());
        if let (true, Some(shape)) = (wants("8a"), last) {
            let rows = shape.position.iter().map(|p| vec![p.x, p.y, p.z]);
            figures.push((draw::final_shape(&shape.position), csv("x_m,y_m,z_m", rows)));
        }
        if wants("8b") {
            let errors = self.errors();
            let rows = errors
                .iter()
                .flat_map(|(step, errors)| errors.iter().map(|e| vec![*step, e.time, e.work.0, e.work.1]));
            let table = csv("time_step_s,time_s,work_error_percent_mean,work_error_percent_largest", rows);
            figures.push((draw::step_errors(&errors), table));
        }
        for flown in &self.flying.trends {
            let (parameter, trend) = (flown.parameter, self.trend(flown));
            let head = format!(
                "{},amplitude_y_m,amplitude_y_m_se,amplitude_z_m,amplitude_z_m_se,frequency_y_hz,frequency_y_hz_se,frequency_z_hz,frequency_z_hz_se,n",
                flown.column
            );
            let rows = trend.iter().map(|p| {
                let pairs = p.amplitude.iter().chain(&p.frequency);
                let results = pairs.flat_map(|&(mean, error)| [mean, error.unwrap_or(f64::NAN)]);
                std::iter::once(p.value).chain(results).chain([p.n as f64]).collect()
            });
            let table = csv(&head, rows);
            figures.extend(draw::trend(parameter, &trend).into_iter().map(|f| (f, table.clone())));
        }
        figures
    }

    fn claims(&self) -> Vec<Claim> {
        let errors: Vec<_> = self
            .steps
            .iter()
            .map(|(step, r)| (*step, r.work_error_percent.final_mean, r.work_error_percent.time_median))
            .collect();
        let mut claims =
            if self.flying.wanted.contains(&"8b") { claims_of_step_errors(&errors) } else { Vec::new() };
        for trend in &self.flying.trends {
            claims.extend(claims_of_trend(trend.parameter, &self.trend(trend)));
        }
        claims
    }

    /// Table 1 by choice: amplitudes [mm] and frequencies [Hz] with their errors.
    fn choices(&self) -> Vec<(String, Vec<String>)> {
        let cells = |point: usize| {
            let results = &self.points[point];
            let cell = |i: usize, factor| mean_and_error(results.mean[i], results.standard_error[i], factor);
            vec![cell(0, 1e3), cell(1, 1e3), cell(2, 1.0), cell(3, 1.0)]
        };
        self.flying.choices.iter().map(|&(name, point)| (name.to_owned(), cells(point))).collect()
    }
}

fn csv(head: &str, rows: impl Iterator<Item = Vec<f64>>) -> String {
    let mut text = format!("{head}\n");
    for row in rows {
        let cells: Vec<String> =
            row.iter().map(|v| if v.is_finite() { format!("{v}") } else { String::new() }).collect();
        let _ = writeln!(text, "{}", cells.join(","));
    }
    text
}

/// `summary.json`: the claims with their evidence and verdicts.
fn summary(claims: &[Claim]) -> String {
    #[derive(Serialize)]
    struct Summary<'a> {
        schema_version: u32,
        spunlaid_version: &'static str,
        claims: Vec<Entry<'a>>,
    }
    #[derive(Serialize)]
    struct Entry<'a> {
        figure: &'a str,
        claim: &'a str,
        evidence: &'a str,
        verdict: &'static str,
    }
    let claims = claims
        .iter()
        .map(|c| Entry { figure: c.figure, claim: c.claim, evidence: &c.evidence, verdict: c.verdict.name() })
        .collect();
    let summary = Summary { schema_version: 1, spunlaid_version: env!("CARGO_PKG_VERSION"), claims };
    // Serialising plain strings into memory cannot fail.
    serde_json::to_string_pretty(&summary).unwrap_or_default() + "\n"
}
