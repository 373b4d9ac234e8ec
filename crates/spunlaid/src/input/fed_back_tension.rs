//! The tension at the end of a spinline from flights of the fibre below it: fly, feed the mean tension at the
//! root back, solve the spinline again, until the speed stands.

use super::open::OpenCase;
use crate::case::keys;
use crate::case::{Case, Note, Remark};
use crate::ensemble::{Keep, RunControl, fly};
use crate::error::{Error, Fault, Finding};
use crate::spinline::End;
use std::sync::atomic::Ordering;

const END_TENSION: &str = "spinline.end_tension";
/// The speed stands if it changes by less than this from one round to the next.
const SETTLED: f64 = 1e-3;
/// Most rounds of flights.
const MOST_ROUNDS: u64 = 8;
/// Replicates that fly, and how many times the fibre comes down after the spin-up at most.
const REPLICATES: u64 = 8;
const DESCENTS: f64 = 25.0;

/// The tension at the end of a spinline that flights have found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlownTension {
    /// Mean tension at the root of the fibre [N].
    pub tension: f64,
    /// Relative change of the feed speed in the last round [-].
    pub change: f64,
}

impl OpenCase {
    /// Whether the tension at the end of the spinline is that of flights.
    pub(super) fn waits_for_flights(&self) -> bool {
        matches!(self.end(), End::Flown(_))
    }

    /// Flies fibres until the speed of the spinline stands; none if it never does. The bits of the tension
    /// depend on the case alone.
    ///
    /// # Errors
    /// Every reason why the case cannot be run, a fibre that is lost, and a stop.
    pub(super) fn find_tension(&self, by: RunControl<'_>) -> Result<Option<FlownTension>, Error> {
        let mut open = self.clone();
        let (mut speed, mut steps) = (f64::NAN, 0);
        for _ in 0..MOST_ROUNDS {
            let (case, _) = open.clone().resolve_at_once()?;
            let Some(line) = case.line else { break };
            let change = (line.feed_speed / speed - 1.0).abs();
            if change < SETTLED {
                let End::Flown(tension) = open.end() else { break };
                // The rounds that are not needed count as flown.
                by.fibre_steps.fetch_add(most_steps(&case).saturating_sub(steps), Ordering::Relaxed);
                return Ok(Some(FlownTension { tension, change }));
            }
            speed = line.feed_speed;
            let round = round(&case);
            steps += round.run.steps * round.run.replicates;
            open.set_end(End::Flown(mean_tension(&round, by)?));
        }
        Ok(None)
    }

    /// The checked case whose spinline ends at the mean tension of its own fibres. From then on the tension
    /// is a number.
    ///
    /// * `found` – none if the speed does not settle
    ///
    /// # Errors
    /// Every reason why the case cannot be run.
    pub(super) fn resolve_with(mut self, found: Option<FlownTension>) -> Result<(Case, Vec<Note>), Error> {
        let Some(FlownTension { tension, change }) = found else {
            let what = Fault::new(
                format!("does not settle within {MOST_ROUNDS} rounds of flights"),
                "write a tension, as the run of this case with \"0 N\" says it, and look again",
            );
            let problem = Finding { value: None, ..keys::finding(END_TENSION, 0.0, what) };
            return Err(vec![self.key_values.placed(problem)].into());
        };
        self.set_end(End::Tension(tension));
        let open = self.clone();
        let (case, mut notes) = self.resolve_at_once()?;
        let speed = case.line.map_or(f64::NAN, |line| line.feed_speed);
        notes.push(open.note_of_end(Remark::TensionFlown { tension, speed, change }));
        Ok((case, notes))
    }

    /// The checked case with a tension of zero, which is not that of flights, and a note that says so.
    ///
    /// # Errors
    /// Every reason why the case cannot be run. None of them would go away with the tension of flights, which
    /// begin with this case.
    pub(super) fn resolve_without(&self) -> Result<(Case, Vec<Note>), Error> {
        let (case, mut notes) = self.clone().resolve_at_once()?;
        notes.push(self.note_of_end(Remark::TensionUnflown));
        Ok((case, notes))
    }

    fn note_of_end(&self, what: Remark) -> Note {
        let note = self.key_values.placed(keys::finding(END_TENSION, 0.0, what));
        Note { value: None, ..note }
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

/// What flies of a case in a round.
fn round(case: &Case) -> Case {
    let mut case = case.clone();
    case.run.replicates = flown_replicates(case.run.replicates);
    if let Some(line) = case.line {
        let descents = DESCENTS * line.distance / line.feed_speed / case.run.time_step;
        case.run.steps = case.run.steps.min(case.run.spin_up_steps + descents.ceil() as u64);
    }
    case
}

/// How many of the replicates of a case fly for its tension.
pub(super) fn flown_replicates(replicates: u64) -> u64 {
    replicates.min(REPLICATES)
}

/// Steps of all fibres that fly for the tension of a case, if it takes every round.
pub(super) fn most_steps(case: &Case) -> u64 {
    let round = round(case);
    MOST_ROUNDS * round.run.steps * round.run.replicates
}

/// Mean tension at the root of the flights of a round [N].
fn mean_tension(round: &Case, by: RunControl<'_>) -> Result<f64, Error> {
    let mut tensions = Vec::new();
    fly::<Error>(round, Keep::NUMBERS, RunControl { recorder: None, ..by }, |trajectory| {
        tensions.push(trajectory.number("root_tension"));
        Ok(())
    })?;
    Ok(tensions.iter().sum::<f64>() / tensions.len() as f64)
}
