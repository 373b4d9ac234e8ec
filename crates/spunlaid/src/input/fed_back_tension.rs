//! The tension at the end of a spinline from flights of the fibre below it: fly, feed the mean tension at the root back, solve the
//! spinline again, until the speed stands.

use super::open::OpenCase;
use crate::case::keys;
use crate::case::{Case, Neighbours, Note, Remark};
use crate::ensemble::{Keep, RunControl, fly};
use crate::error::{Error, Fault, Finding};
use crate::lanes::Isa;
use crate::spinline::End;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// The speed stands if it changes by less than this from one round to the next.
const SETTLED: f64 = 1e-3;
/// Most rounds of flights.
const MOST_ROUNDS: usize = 8;
/// Replicates that fly, and how many times the fibre comes down after the spin-up at most.
const REPLICATES: u64 = 8;
const DESCENTS: f64 = 25.0;

impl OpenCase {
    /// Whether the tension at the end of the spinline is that of flights.
    pub(super) fn waits_for_flights(&self) -> bool {
        self.case.spinline.as_ref().is_some_and(|line| matches!(line.end, End::Flown(_)))
    }

    /// The checked case whose spinline ends at the mean tension of its own fibres. From then on the tension is a number.
    ///
    /// # Errors
    /// Every reason why the case cannot be run, a fibre that is lost, or a speed that does not settle.
    pub(super) fn resolve_with_flights(mut self) -> Result<(Case, Vec<Note>), Error> {
        let mut speed = f64::NAN;
        for _ in 0..MOST_ROUNDS {
            let (case, _) = self.clone().resolve_at_once()?;
            let Some(line) = case.line else { break };
            let change = (line.feed_speed / speed - 1.0).abs();
            if change < SETTLED {
                let End::Flown(tension) = self.end() else { break };
                self.set_end(End::Tension(tension));
                let what = Remark::TensionFlown { tension, speed: line.feed_speed, change };
                let note = self.key_values.placed(keys::finding("spinline.end_tension", tension, what));
                let (case, mut notes) = self.resolve_at_once()?;
                notes.push(Note { value: None, ..note });
                return Ok((case, notes));
            }
            speed = line.feed_speed;
            self.set_end(End::Flown(mean_tension(&case)?));
        }
        let what = Fault::new(
            format!("does not settle within {MOST_ROUNDS} rounds of flights"),
            "write a tension, as the run of this case with \"0 N\" says it, and look again",
        );
        let finding = Finding { value: None, ..keys::finding("spinline.end_tension", 0.0, what) };
        Err(vec![self.key_values.placed(finding)].into())
    }

    fn end(&self) -> End {
        self.case.spinline.as_ref().map_or(End::Tension(0.0), |line| line.end)
    }

    fn set_end(&mut self, end: End) {
        if let Some(line) = &mut self.case.spinline {
            line.end = end;
        }
    }
}

/// Mean tension at the root of some flights of the case [N].
fn mean_tension(case: &Case) -> Result<f64, Error> {
    let mut case = Case { neighbours: Neighbours::default(), ..case.clone() };
    case.run.replicates = case.run.replicates.min(REPLICATES);
    if let Some(line) = case.line {
        let descents = DESCENTS * line.distance / line.feed_speed / case.run.time_step;
        case.run.steps = case.run.steps.min(case.run.spin_up_steps + descents.ceil() as u64);
    }
    let computing = RunControl {
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        isa: Isa::detect(),
        stop: &AtomicBool::new(false),
        fibre_steps: &AtomicU64::new(0),
        recorder: None,
    };
    let mut tensions = Vec::new();
    fly::<Error>(&case, Keep::NUMBERS, computing, |trajectory| {
        tensions.push(trajectory.number("root_tension"));
        Ok(())
    })?;
    Ok(tensions.iter().sum::<f64>() / tensions.len() as f64)
}
