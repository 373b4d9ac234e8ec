//! `spunlaid check`: what a case means, without flying it.

use super::run::POSITIONS;
use crate::args::Check;
use crate::failure::Failure;
use crate::say;
use spunlaid::case::{Case, RECORD_ON_DISK};
use spunlaid::ensemble::{KeepShapes, pace};
use spunlaid::input::write_case;
use spunlaid::lanes::{Isa, WIDTH};
use spunlaid::units::Dimension;

pub(crate) fn check(check: &Check) -> Result<(), Failure> {
    let (case, notes) = check.source.read(&[])?;
    notes.iter().for_each(say::note);
    say::line("# the case, every default written out");
    say::text(&write_case(&case));
    say::line("");
    mesh(&case);
    limits(&case);
    cost(&case)?;
    say::line(&format!("ready: spunlaid run {}", check.source.case.display()));
    Ok(())
}

fn mesh(case: &Case) {
    let fibre = &case.fibre;
    let eddies = case.eddies().count();
    say::line("# mesh");
    say::line(&format!(
        "#   {} elements of {}, {} eddies of {} along the fibre",
        fibre.elements,
        Dimension::Length.pretty(fibre.rest_length()),
        eddies,
        Dimension::Length.pretty(case.air.length_scale)
    ));
    if case.air.rms() > 0.0 {
        say::line(&format!(
            "#   turbulence of {} rms from {} harmonics, repeats after {}",
            Dimension::Velocity.pretty(case.air.rms()),
            case.air.harmonics,
            Dimension::Time.pretty(2.0 * case.air.repeat_time())
        ));
    }
}

fn limits(case: &Case) {
    let h = case.run.time_step;
    say::line(&format!("# time step {}, {} steps; stable below", Dimension::Time.pretty(h), case.run.steps));
    for limit in case.stable_step_limits() {
        say::line(&format!(
            "#   {:<10} {} ({:.3} of it used)",
            Dimension::Time.pretty(limit.limit),
            limit.cause,
            h / limit.limit
        ));
    }
}

fn cost(case: &Case) -> Result<(), Failure> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let bundles = case.run.replicates.div_ceil(WIDTH as u64);
    let busy = (threads as u64).min(bundles);
    let memory = case.bundle_memory().total() * busy as f64 / f64::from(1 << 20);
    // A bundle takes as long whether its lanes are full or not.
    let rounds = bundles.div_ceil(busy) as f64;
    let seconds = pace(case, Isa::detect())? * case.run.steps as f64 * rounds;
    say::line(&format!(
        "# to expect: {} on {busy} of {threads} threads, {:.0} MiB of memory, {} of results",
        duration(seconds),
        memory + case.air.field_memory() as f64 / f64::from(1 << 20) + 30.0,
        size(on_disk(case))
    ));
    Ok(())
}

/// What the results take: tables, shapes as text, figures and report [bytes].
fn on_disk(case: &Case) -> f64 {
    const POSITION: f64 = 90.0;
    const FIGURES_AND_REPORT: f64 = 1e6;
    let run = &case.run;
    let instants = (run.steps / run.output_steps + 1) as f64;
    let kept = KeepShapes::within(case, POSITIONS);
    let positions = instants / kept.every as f64 * kept.replicates as f64 * (case.fibre.elements + 1) as f64;
    instants * run.replicates as f64 * RECORD_ON_DISK + positions * POSITION + FIGURES_AND_REPORT
}

fn size(bytes: f64) -> String {
    if bytes < 1e9 { format!("{:.0} MB", bytes / 1e6) } else { format!("{:.1} GB", bytes / 1e9) }
}

/// A time to wait, in words.
fn duration(seconds: f64) -> String {
    match seconds {
        s if s < 1.0 => "less than a second".to_owned(),
        s if s < 120.0 => format!("about {s:.0} s"),
        s if s < 7200.0 => format!("about {:.0} min", s / 60.0),
        s => format!("about {:.0} h", s / 3600.0),
    }
}
