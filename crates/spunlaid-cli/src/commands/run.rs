//! `spunlaid run`: flies a case and writes the results.

use super::finished::continued;
use super::interrupt::stop_on_ctrl_c;
use super::{plural, stem, threads};
use crate::args::Run;
use crate::failure::Failure;
use crate::figures::run_figures;
use crate::numbers::significant;
use crate::output::folder::{ENTRIES, Staging};
use crate::output::laid::{LaidTable, Spill};
use crate::output::summary::{Performance, Summary};
use crate::output::tables::{self, Table};
use crate::output::{beside, paraview, pictures, table};
use crate::report::{self, ReportInput};
use crate::{progress, say};
use spunlaid::case::{Case, Note};
use spunlaid::ensemble::{
    Computing, Keep, KeepShapes, Results, StepCheck, StepCheckPlan, TakeLaid, fly_and_check_step,
    turbulence_spectrum,
};
use spunlaid::input::write_case;
use spunlaid::lanes::{Isa, WIDTH};
use std::sync::atomic::AtomicU64;
use std::time::Instant;

/// Number of replicates whose shapes are kept for the report and ParaView.
const KEPT: usize = WIDTH;
/// Fewest shapes in a period of the free end that follow its motion.
const PER_PERIOD: f64 = 8.0;
/// Number of node positions kept for the report and ParaView. Each takes 24 bytes.
pub(super) const POSITIONS: u64 = 4_000_000;

pub(crate) fn run(run: &Run) -> Result<(), Failure> {
    let (case, mut notes) = match run.until {
        Some(until) => continued(run, until)?,
        None => {
            let (case, notes) = run.source.read(&overrides(run))?;
            notes.iter().for_each(say::note);
            (case, notes.iter().map(Note::to_string).collect())
        }
    };
    let name = name(run);
    let folder = match run.until {
        Some(_) if run.out.is_none() => Some(run.source.case.clone()),
        _ => (run.out.is_some() || !run.json).then(|| super::folder(run.out.as_ref(), &name)),
    };
    let stop = stop_on_ctrl_c();
    // A continued run replaces its own results.
    let replace = run.force || run.until.is_some() && run.out.is_none();
    let staging = folder.as_ref().map(|folder| Staging::new(folder, ENTRIES, replace, stop)).transpose()?;

    let fibre_steps = AtomicU64::new(0);
    let computing = Computing {
        threads: threads(run.threads),
        isa: Isa::detect(),
        stop,
        fibre_steps: &fibre_steps,
        laid: None,
    };
    let started = Instant::now();
    let plan = StepCheckPlan::of(&case);
    let again = plan.map_or(0, |plan| plan.fibre_steps());
    let (results, check) = progress::follow(
        &fibre_steps,
        case.run.steps * case.run.replicates + again,
        &format!("flying {}", plural(case.run.replicates, "fibre")),
        run.quiet,
        || flights(&case, plan, computing, staging.as_ref()),
    )?;
    let performance = performance(&case, &results, plan, computing, started.elapsed().as_secs_f64());

    if let Some(outside) = outside(&results) {
        say::warning(&outside);
        notes.push(outside);
    }
    let coarse = coarse_shapes(&case, &results);
    notes.extend(coarse.clone());
    let summary = Summary::new(&case, &results, check.as_ref(), performance, notes.clone()).to_json();
    if let Some(staging) = staging {
        let written = Written {
            name,
            case: &case,
            results: &results,
            check: check.as_ref(),
            notes,
            performance,
            summary: &summary,
        };
        written.to(&staging, computing)?;
        staging.publish()?;
        coarse.iter().for_each(|coarse| say::remark(false, coarse));
    }

    if run.json {
        say::text(&summary);
    } else if !run.quiet {
        say::text(&table::results(&case, &results));
        if let Some(check) = &check {
            say::text(&table::step_check(check, &results));
        }
        let seconds = performance.wall_s;
        say::line(&format!(
            "\n{} in {seconds:.2} s, {:.1} ns per element and step and thread ({}, {})",
            plural(case.run.replicates, "fibre"),
            performance.ns_per_element_step,
            performance.instruction_set,
            plural(performance.threads as u64, "thread")
        ));
        if let Some(folder) = folder {
            say::line(&format!("open {}", folder.join("report.html").display()));
        }
    }
    Ok(())
}

/// What the results are called: as the case file, or as the folder of a run that is continued.
fn name(run: &Run) -> String {
    let case = &run.source.case;
    let folder = run.until.and_then(|_| Some(case.canonicalize().ok()?.file_name()?.to_owned()));
    folder.as_deref().unwrap_or_else(|| stem(case, "run")).to_string_lossy().into_owned()
}

/// The changes to the case on the command line.
fn overrides(run: &Run) -> Vec<(&'static str, String)> {
    let own = [("run.replicates", run.replicates), ("run.seed", run.seed)];
    own.into_iter().filter_map(|(key, value)| Some((key, value?.to_string()))).collect()
}

/// Flies all replicates. If there is a results folder, the tables are written during the flights.
fn flights(
    case: &Case,
    plan: Option<StepCheckPlan>,
    computing: Computing<'_>,
    staging: Option<&Staging<'_>>,
) -> Result<(Results, Option<StepCheck>), Failure> {
    let mut tables = Vec::new();
    if let Some(staging) = staging {
        for (name, columns) in tables::tables(case.line.is_some()) {
            tables.push(Table::create(staging.place(name), columns)?);
        }
    }
    let fed = staging.filter(|_| case.line.is_some());
    let spill = fed.map(Spill::new);
    let mut laid =
        fed.zip(spill.as_ref()).map(|(staging, spill)| LaidTable::create(staging, spill)).transpose()?;
    let computing = Computing { laid: spill.as_ref().map(|spill| spill as &dyn TakeLaid), ..computing };
    let mut collector = Results::collector(KEPT);
    let shapes = if staging.is_some() { KeepShapes::within(case, POSITIONS) } else { KeepShapes::NONE };
    let check = fly_and_check_step(case, plan, Keep { curves: true, shapes }, computing, |trajectory| {
        tables.iter_mut().try_for_each(|table| table.add(&trajectory))?;
        laid.iter_mut().try_for_each(|table| table.add(trajectory.replicate))?;
        collector.take(&trajectory);
        Ok::<(), Failure>(())
    })
    .map_err(|ended| match &spill {
        Some(spill) => spill.failure(ended),
        None => ended,
    })?;
    tables.into_iter().try_for_each(Table::finish)?;
    laid.map_or(Ok(()), LaidTable::finish)?;
    Ok((collector.finish(), check))
}

/// A warning about fibres that leave the region where the flow is known.
fn outside(results: &Results) -> Option<String> {
    let share = 100.0
        * results
            .number("share_outside_flow")
            .map(|number| number.estimate.mean)
            .filter(|share| *share > 0.0)?;
    Some(format!(
        "the fibres’ elements are outside the region where the flow is known for {} % of the time, beyond its walls or \
         its ends; there, the air at the nearest known point acts on them. Check the position of the root and the length \
         of the fibre",
        significant(share, 2)
    ))
}

/// A note about shapes for ParaView that are too far apart in time to follow the free end.
fn coarse_shapes(case: &Case, results: &Results) -> Option<String> {
    let shapes = &results.trajectories.first()?.shapes;
    let [first, second, ..] = shapes.as_slice() else {
        return None;
    };
    let thinned = paraview::thinned(case, shapes.len());
    let interval = (second.time - first.time) * thinned as f64;
    let frequency = ["frequency_y", "frequency_z"].map(|name| results.estimate(name).mean);
    let frequency = frequency[0].max(frequency[1]);
    let each = 1.0 / (frequency * interval);
    // A frequency from a crossing or two is no frequency.
    let is_known = frequency * (case.run.duration() - case.run.spin_up()) > 2.0;
    (is_known && each < PER_PERIOD).then(|| {
        let wanted = (case.run.duration() * frequency * PER_PERIOD).ceil() + 1.0;
        let longest = 1.0 / (frequency * PER_PERIOD);
        let finer = if case.run.output_interval() > longest {
            // Rounded down to one digit.
            let power = 10f64.powf((longest * 1e3).log10().floor());
            let rounded = (longest * 1e3 / power).floor() * power;
            format!(" and run.output_interval = \"{} ms\" or less", significant(rounded, 1))
        } else {
            String::new()
        };
        format!(
            "the shapes for ParaView are {} ms apart, {} in a period of the free end ({} Hz): too few to follow it; write \
             run.shapes = {wanted}{finer}",
            significant(interval * 1e3, 3),
            significant(each, 2),
            significant(frequency, 3)
        )
    })
}

fn performance(
    case: &Case,
    results: &Results,
    plan: Option<StepCheckPlan>,
    computing: Computing<'_>,
    wall_s: f64,
) -> Performance {
    let flights = case.run.replicates.div_ceil(WIDTH as u64) as usize + usize::from(plan.is_some());
    let threads = computing.threads.min(flights);
    let again = plan.map_or(0, |plan| plan.fibre_steps());
    // Of a fed fibre, as many as there are in the air on average.
    let elements =
        results.number("nodes_in_air").map_or(case.fibre.elements as f64, |nodes| nodes.estimate.mean);
    let fibre_steps = case.run.steps * case.run.replicates + again;
    let element_steps = (elements * fibre_steps as f64).round() as u64;
    Performance {
        wall_s,
        threads,
        element_steps,
        ns_per_element_step: wall_s * threads as f64 / element_steps as f64 * 1e9,
        instruction_set: computing.isa.name(),
    }
}

/// Everything that goes into the files.
struct Written<'a> {
    name: String,
    case: &'a Case,
    results: &'a Results,
    check: Option<&'a StepCheck>,
    notes: Vec<String>,
    performance: Performance,
    summary: &'a str,
}

impl Written<'_> {
    fn to(&self, staging: &Staging<'_>, computing: Computing<'_>) -> Result<(), Failure> {
        let copied = beside::copy([self.case], &staging.place(beside::CASE_FILES).0)?;
        let case_toml = write_case(&beside::relocated(self.case, &copied));
        let turbulence = turbulence_spectrum(self.case, computing)?;
        let figures = run_figures(self.case, self.results, &turbulence);
        // Writing a thousand small files waits for the disk, so the figures are drawn at the same time.
        std::thread::scope(|scope| {
            let (case, trajectories) = (self.case, &self.results.trajectories);
            let shapes = scope.spawn(move || {
                paraview::write(staging, case, trajectories)?;
                paraview::write_laid(staging, trajectories)
            });
            pictures::write(&figures, |name, content| staging.write(&format!("figures/{name}"), content))?;
            shapes.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
        })?;
        let report = report::html(&ReportInput {
            name: &self.name,
            case: self.case,
            case_toml: &case_toml,
            results: self.results,
            step_check: self.check,
            figures: &figures,
            notes: &self.notes,
            performance: self.performance,
            version: env!("CARGO_PKG_VERSION"),
        });
        staging.write("case.toml", case_toml)?;
        staging.write("report.html", report)?;
        staging.write("summary.json", self.summary)
    }
}
