//! What is said of a study before it is simulated, and meanwhile.

use super::counted;
use crate::args::Output;
use crate::delivery::{aside, say_continued};
use crate::failure::Failure;
use crate::say;
use spunlaid::experiment::{JournalState, Progress, Study};
use spunlaid::ground::Fault;
use spunlaid::input::write_experiment;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// Prints the file of a point.
pub(super) fn print_point(study: &Study, number: u64) -> Result<(), Failure> {
    let points = study.points.len();
    let point = (number as usize).checked_sub(1).and_then(|index| study.points.get(index));
    let refusal = || format!("--print-point {number}: the study has {points} points, counted from 1");
    let point = point.ok_or_else(|| Fault::plain(refusal()))?;
    say::text(&format!("# point {number} of {points}\n{}", write_experiment(&point.experiment)));
    Ok(())
}

/// Says what will be done, or what of it has been done before.
pub(super) fn say_begun(study: &Study, found: Option<JournalState>, output: &Output) {
    let noun = study.noun();
    if let Some(found) = found {
        let done = format!("{} of {} already done", counted(found.fibres, noun), study.most_fibres());
        say_continued(&found, &done, noun, output);
        if found.torn {
            say::aside(&format!("the last record of the journal was incomplete; its {noun} is made again"));
        }
        return;
    }
    let phases = match (noun, study.common_phases) {
        ("web" | "spinline", _) => "",
        (_, true) => ", common phases",
        (_, false) => ", independent phases",
    };
    let points = counted(study.points.len() as u64, "point");
    aside(output, &format!("{points}, each with {}{phases}", times(study)));
}

/// `10 replicates`, `8 to 100 replicates`.
fn times(study: &Study) -> String {
    let replicates = &study.replicates;
    if replicates.until.is_empty() {
        counted(replicates.at_most, if study.noun() == "fibre" { "replicate" } else { study.noun() })
    } else {
        format!("{} to {} replicates", replicates.at_least, replicates.at_most)
    }
}

/// How far a study is: steps, their total, and `points 1/9, fibres 30/90, 4.2 fibres/s`.
pub(super) fn state<'a>(
    study: &'a Study,
    fibre_steps: &'a AtomicU64,
    progress: &'a Progress,
) -> impl FnMut() -> (u64, u64, String) + Send {
    let (begun, mut before) = (Instant::now(), None);
    let load = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
    move || {
        let (points, of_points) = (load(&progress.points_done), study.points.len());
        let done = load(&progress.fibres_done);
        let fibres = load(&progress.fibres);
        let noun = study.noun();
        let mut words = format!("points {points}/{of_points}, {noun}s {done}/{fibres}");
        // Fibres that were finished before the program began are not of its work.
        let finished = done - if fibres > 0 { *before.get_or_insert(done) } else { done };
        if finished > 0 {
            let rate = finished as f64 / begun.elapsed().as_secs_f64();
            words += &format!(", {rate:.prec$} {noun}s/s", prec = usize::from(rate < 10.0));
        }
        (load(fibre_steps), load(&progress.steps), words)
    }
}
