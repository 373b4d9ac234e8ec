//! A case that was simulated.

pub(crate) mod checked;
mod doubt;
pub(crate) mod figures;
mod finer;
mod report;
#[cfg(test)]
pub(crate) mod sample;
mod simulated;
pub(crate) mod summary;
mod tables;

pub use checked::about_case;
pub use report::frames::{CAMERA, SCENE};
pub use simulated::FlightRecords;
pub use tables::unit_of_column;

use crate::Failure;
use crate::files::folder::{ENTRIES, Staging};
use crate::files::kept_input::Input;
use crate::files::origin::Performance;
use crate::files::paraview;
use crate::folders::{Contents, Maker, Making, Page};
use crate::numbers::{lost_fibres_text, significant};
use crate::reports::spinline::figures::{SPINLINE, spinline_figures};
use crate::reports::spinline::files::{SpinResults, write_stations};
use figures::run_figures;
use report::run_report;
use simulated::Tables;
use spunlaid_charts::Figure;
use spunlaid_fibre::Case;
use spunlaid_ground::{Diagnostic, Isa, RunContext, WIDTH};
use spunlaid_simulation::ensemble::{fly_for_checks, turbulence_spectrum};
use spunlaid_simulation::{
    FinerChecks, FinerPlans, KeepShapes, LostFibre, Recorded, Recorder, Results, RunPaths,
};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock};
use std::time::Instant;
use summary::summary;

/// Number of replicates whose shapes are kept for the report and ParaView.
const KEPT: usize = WIDTH;
/// Fewest shapes in a period of the free end that follow its motion.
const PER_PERIOD: f64 = 8.0;
/// Most lost fibres that are listed.
const LOST_LISTED: usize = 10;
/// Number of node positions kept for the report and ParaView. Each takes 24 bytes.
pub const POSITIONS: u64 = 4_000_000;

/// What was simulated of a case.
#[derive(Debug)]
pub struct SimulatedRun {
    /// The results of the replicates, the lost ones among them.
    pub results: Results,
    /// What the checks compare; `None` if the flights were interrupted.
    pub paths: Option<RunPaths>,
    /// Number of replicates, from the first on, that have landed or are lost.
    pub replicates: u64,
    /// Flights that are kept until the results are complete; then [`FlightRecords::finish`] forgets them.
    pub kept: Option<FlightRecords>,
}

/// The replicates of a run that have landed.
#[derive(Debug)]
pub struct LandedRun {
    /// Their results.
    pub results: Results,
    /// Their number.
    pub replicates: u64,
    /// Whether these are all replicates of the case.
    pub is_whole: bool,
}

/// Flies all replicates. If there is a results folder, the tables are written during the flights, and flights
/// are kept for a process that goes on where this one is interrupted. A fibre that is lost is in
/// [`Results::lost`], and in no table.
///
/// With a results folder, an interruption ends the flights and is no error if a fibre has landed.
///
/// * `with_shapes` – whether shapes are kept
/// * `found` – called with the number of replicates that an interrupted process has left, if there are any
///
/// # Errors
/// If too few fibres are left ([`fly_for_checks`]), a table cannot be written, or the flights are interrupted.
pub fn fly(
    case: &Case,
    plans: &FinerPlans,
    computing: RunContext<'_>,
    staging: Option<&Staging<'_>>,
    with_shapes: bool,
    found: impl FnOnce(u64),
) -> Result<SimulatedRun, Failure> {
    let shapes = if with_shapes { KeepShapes::within(case, POSITIONS) } else { KeepShapes::NONE };
    let keep = Recorded { shapes, ..Recorded::CURVES };
    let flights = staging.map(|staging| FlightRecords::open(staging, case, Some(keep))).transpose()?;
    if let Some(left) = flights.as_ref().map(FlightRecords::earlier).filter(|left| *left > 0) {
        found(left);
    }
    let tables = staging.zip(flights.as_ref()).map(|(staging, flights)| Tables::create(staging, flights));
    let mut tables = tables.transpose()?;
    let recorder = flights.as_ref().map(|flights| flights as &dyn Recorder);
    let recorded = Recorded { recorder, ..keep };
    let mut collector = Results::collector(KEPT);
    let mut replicates = 0;
    let mut landed_well = 0;
    let simulated = fly_for_checks(
        case,
        plans,
        recorded,
        computing,
        |some, paths| flights.as_ref().map_or(Ok(None), |flights| flights.recall(some, paths)),
        |landed| {
            match landed {
                Ok(trajectory) => {
                    tables.iter_mut().try_for_each(|tables| tables.add(trajectory.replicate))?;
                    flights.iter().for_each(|flights| flights.land(&trajectory));
                    collector.take(trajectory);
                    landed_well += 1;
                }
                Err(lost) => {
                    flights.iter().for_each(|flights| flights.leave_out(lost.replicate));
                    collector.lose(lost);
                }
            }
            replicates += 1;
            Ok::<(), Failure>(())
        },
    );
    let paths = match simulated {
        Ok(paths) => Some(paths),
        // What has landed becomes results. Another interruption ends that too.
        Err(Failure::Interrupted)
            if staging.is_some() && landed_well > 0 && computing.stop.swap(false, Ordering::Relaxed) =>
        {
            None
        }
        Err(ended) => return Err(ended),
    };
    flights.iter().for_each(|flights| flights.interrupted.store(paths.is_none(), Ordering::Relaxed));
    tables.map_or(Ok(()), Tables::finish)?;
    Ok(SimulatedRun { results: collector.finish(), paths, replicates, kept: flights })
}

/// Everything of a run that goes into the files.
#[derive(Debug)]
pub struct RunFolder {
    /// What the run is called: the name of the case file.
    pub name: String,
    /// The case.
    pub case: Arc<Case>,
    /// The results of [`fly`].
    pub results: Results,
    /// What a finer time step and finer elements change.
    pub checks: FinerChecks,
    /// Warnings and remarks for the reader, without those of the checks.
    pub notes: Vec<String>,
    /// What the run cost.
    pub performance: Performance,
    /// Its figures, once they are drawn: the checks change none.
    pub drawn: OnceLock<Vec<Figure>>,
}

impl RunFolder {
    /// A run whose time step and mesh are not checked yet; one that was interrupted is of the replicates that have
    /// landed.
    ///
    /// * `notes` – about the case
    /// * `started` – when the flights began
    pub fn new(
        name: String,
        mut case: Arc<Case>,
        notes: &[Diagnostic],
        landed: LandedRun,
        plans: &FinerPlans,
        started: Instant,
        by: RunContext<'_>,
    ) -> Self {
        let LandedRun { results, replicates, is_whole } = landed;
        let mut notes = Diagnostic::notes_of_results(notes);
        let checks = if is_whole { plans.before_flight() } else { plans.stopped() };
        if !is_whole {
            let asked = case.run.replicates;
            notes.push(format!(
                "{replicates} of {asked} replicates: the run was interrupted, and the same command simulates the others"
            ));
            Arc::make_mut(&mut case).run.replicates = replicates;
        }
        let performance = performance(&case, &results, by, started.elapsed().as_secs_f64());
        notes.extend(found(&case, &results).into_iter().flatten());
        Self { name, case, results, checks, notes, performance, drawn: OnceLock::new() }
    }

    /// Warnings and remarks, with those of the checks.
    fn all_notes(&self) -> Vec<String> {
        let doubts =
            doubt::notes(&self.checks, &self.case).into_iter().filter(|doubt| !self.notes.contains(doubt));
        self.notes.iter().cloned().chain(doubts).collect()
    }
}

/// The tables are those of [`fly`].
impl Contents for RunFolder {
    const ENTRIES: &'static [&'static str] = ENTRIES;
    const OF_ONE_FORMAT: &'static [&'static str] = &["end_node.parquet", "energy.parquet", "laid.parquet"];

    fn summary(&self) -> String {
        summary(&self.case, &self.results, &self.checks, self.performance, &self.all_notes())
    }

    /// A page of less than 6 MB.
    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let Self { case, results, .. } = self;
        let input = maker.keep(Input::Case(case))?;
        if self.drawn.get().is_none() {
            let Making { threads, stop, .. } = maker.making;
            let fibre_steps = &AtomicU64::new(0);
            let computing = RunContext { threads, isa: Isa::detect(), stop, done: fibre_steps };
            let drawn = run_figures(case, results, &turbulence_spectrum(case, computing)?);
            let _ = self.drawn.set(drawn);
        }
        let figures = self.drawn.get().map_or(&[][..], Vec::as_slice);
        let spinline = SpinResults::from_case(case);
        let drawn = spinline
            .as_ref()
            .map(|solved| (solved, spinline_figures(SPINLINE, &solved.rows, &solved.influences)));
        let all: Vec<&Figure> = drawn.iter().flat_map(|(_, figures)| figures).chain(figures).collect();
        let files = |staging: &Staging<'_>| {
            spinline.iter().try_for_each(|solved| write_stations(staging, &[(1, &solved.rows)]))?;
            paraview::write(staging, case, &results.trajectories)?;
            paraview::write_laid(staging, &results.trajectories)
        };
        let report = || {
            let drawn = drawn.as_ref().map(|(solved, figures)| (*solved, &figures[..]));
            let report = run_report(case, &input, results, &self.checks, figures, drawn, self.performance)?;
            Ok(report.named(&self.name).noting(&self.all_notes()))
        };
        maker.finish(&self.name, &self.all_notes(), &all, files, report)
    }
}

/// What must be said of results: that fibres were lost; that they leave the region where the flow is known;
/// and that shapes are too far apart in time.
pub fn found(case: &Case, results: &Results) -> [Option<String>; 3] {
    [lost(&results.lost, case.run.replicates), outside(results), coarse_shapes(case, results)]
}

/// A warning about fibres that leave the region where the flow is known.
pub fn outside(results: &Results) -> Option<String> {
    let share = 100.0
        * results
            .number("share_outside_flow")
            .map(|number| number.estimate.mean)
            .filter(|share| *share > 0.0)?;
    Some(format!(
        "the fibres’ elements are outside the region where the flow is known for {} % of the time, beyond \
        its walls or its ends; there, the air at the nearest known point acts on them. Check the position of \
        the root and the length of the fibre",
        significant(share, 2)
    ))
}

/// A warning about fibres that were lost.
///
/// * `of` – how many were to fly
pub fn lost(fibres: &[LostFibre], of: u64) -> Option<String> {
    let lost = lost_fibres_text(fibres.len() as u64, of);
    let each: String = fibres.iter().take(LOST_LISTED).map(|fibre| format!("\n{}", fibre.reason)).collect();
    (!fibres.is_empty()).then(|| format!("{lost}; all others are in the results{each}"))
}

/// A note about shapes for ParaView that are too far apart in time to follow the free end.
pub fn coarse_shapes(case: &Case, results: &Results) -> Option<String> {
    let shapes = &results.trajectories.first()?.shapes;
    let interval = shapes.interval()? * paraview::thinned(case, shapes.len()) as f64;
    let frequency = ["frequency_y", "frequency_z"].map(|name| results.estimate(name).mean);
    let frequency = frequency[0].max(frequency[1]);
    let each = 1.0 / (frequency * interval);
    // A frequency from a crossing or two is no frequency.
    let is_known = frequency * (case.run.duration() - case.run.spin_up()) > 2.0;
    (is_known && each < PER_PERIOD).then(|| {
        let count = (case.run.duration() * frequency * PER_PERIOD).ceil() + 1.0;
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
            "the shapes for ParaView are {} ms apart, {} in a period of the free end ({} Hz): too few to \
            follow it; write run.shapes = {count}{finer}",
            significant(interval * 1e3, 3),
            significant(each, 2),
            significant(frequency, 3)
        )
    })
}

/// What the flights cost, without those of the checks.
///
/// * `wall_s` – time that they took [s]
pub fn performance(case: &Case, results: &Results, computing: RunContext<'_>, wall_s: f64) -> Performance {
    let threads = computing.threads.min(case.flights() as usize);
    // Of a fed fibre, as many as there are in the air on average.
    let elements =
        results.number("nodes_in_air").map_or(case.fibre.elements as f64, |nodes| nodes.estimate.mean);
    let element_steps = (elements * (case.run.steps * case.run.replicates) as f64).round() as u64;
    Performance {
        wall_s,
        threads,
        element_steps: Some(element_steps),
        ns_per_element_step: Some(wall_s * threads as f64 / element_steps as f64 * 1e9),
        instruction_set: computing.isa.name(),
        ..Performance::default()
    }
}
