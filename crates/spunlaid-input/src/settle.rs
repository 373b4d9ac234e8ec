//! The tension at the end of a spinline from flights of the fibre below it: fly, feed the mean tension at the
//! root back, solve the spinline again, until the speed stands. No reader flies: a file is read with tensions
//! of 0 N, [`Resources::resolve_tension`] flies what is wanted, and the file is read again.

use super::data::DataFiles;
use super::open::OpenCase;
use super::written_values::WrittenValues;
use spunlaid_fibre::case::keys;
use spunlaid_fibre::{Case, End};
use spunlaid_ground::threads::{lock, try_par_map};
use spunlaid_ground::{Diagnostic, Dimension, Error, Fault, RunContext};
use spunlaid_simulation::Recorded;
use spunlaid_simulation::ensemble::fly;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

const END_TENSION: &str = "spinline.end_tension";
/// The speed stands if it changes by less than this from one round to the next.
const SETTLED: f64 = 1e-3;
/// Most rounds of flights.
const MOST_ROUNDS: u64 = 8;
/// Replicates that fly, and how many times the fibre comes down after the spin-up at most.
const REPLICATES: u64 = 8;
const DESCENTS: f64 = 25.0;

/// What files need from outside of their text, each of it once for several readings: data files, and the
/// tensions at the ends of spinlines that flights have found.
#[derive(Debug, Default)]
pub struct Resources {
    pub(super) files: DataFiles,
    /// Of a case whose speed does not settle there is none.
    tensions: Vec<(OpenCase, Option<FlownTension>)>,
    /// The cases that have to fly for one, each with its steps of all fibres at most.
    wanted: Mutex<Vec<(OpenCase, u64)>>,
    /// Whether problems of a web may go away with the wanted tensions.
    in_doubt: AtomicBool,
}

/// The tension at the end of a spinline that flights have found.
#[derive(Clone, Copy, Debug)]
struct FlownTension {
    /// Mean tension at the root of the fibre [N].
    tension: f64,
    /// Relative change of the feed speed in the last round [-].
    change: f64,
}

impl Resources {
    /// Reads a file, flies for the tensions that it wants, and reads it again, until it wants none.
    ///
    /// * `read` – reads it with what is known
    /// * `fly` – calls [`Resources::fly`], with threads, progress and a stop of its own
    ///
    /// # Errors
    /// Those of both.
    pub fn resolve_tension<T, E>(
        &mut self,
        read: impl Fn(&Self) -> Result<T, E>,
        mut fly: impl FnMut(&mut Self) -> Result<(), E>,
    ) -> Result<T, E> {
        loop {
            let outcome = read(self);
            // Other problems are reported at once.
            if self.wanted() == 0 || outcome.is_err() && !self.is_in_doubt() {
                return outcome;
            }
            fly(self)?;
        }
    }

    /// Number of tensions that flights have to find.
    pub fn wanted(&self) -> usize {
        lock(&self.wanted).len()
    }

    /// Forgets the tensions that nobody has simulated, as those of values that were only looked at.
    pub fn forget_wanted(&self) {
        lock(&self.wanted).clear();
    }

    /// Whether the problems with a file may go away with the wanted tensions.
    pub fn is_in_doubt(&self) -> bool {
        self.in_doubt.load(Ordering::Relaxed)
    }

    /// Steps of all fibres that fly for the wanted tensions at most, which [`RunContext::done`] counts;
    /// those that are not needed count as simulated.
    pub fn most_steps(&self) -> u64 {
        lock(&self.wanted).iter().map(|(_, steps)| steps).sum()
    }

    /// Flies for the wanted tensions. They have the same bits for any number of threads.
    ///
    /// # Errors
    /// If a fibre is lost, or if the flights are stopped.
    pub fn fly(&mut self, by: RunContext<'_>) -> Result<(), Error> {
        self.in_doubt.store(false, Ordering::Relaxed);
        let wanted = std::mem::take(&mut *lock(&self.wanted));
        // The fibres of a case fly in one bundle.
        let each = RunContext { threads: 1, ..by };
        let found = try_par_map(by.threads, wanted.len(), |number| wanted[number].0.find_tension(each))?;
        self.tensions.extend(wanted.into_iter().map(|(open, _)| open).zip(found));
        Ok(())
    }

    /// The checked case. If its tension is still to be found, it is noted as wanted, and the case is one with
    /// a tension of zero, which a note says.
    ///
    /// # Errors
    /// Every reason why the case cannot be run.
    pub(super) fn resolve(&self, open: OpenCase) -> Result<(Case, Vec<Diagnostic>), Error> {
        if !open.waits_for_flights() {
            return open.resolve_at_once();
        }
        let is_it = |other: &OpenCase| other.key_values.has_values_of(&open.key_values);
        if let Some((_, found)) = self.tensions.iter().find(|(other, _)| is_it(other)) {
            return open.resolve_with(*found);
        }
        let (case, mut notes) = open.clone().resolve_at_once()?;
        let text = "is found when the case is simulated; until then, all that follows from it belongs to \
            a tension of 0 N";
        notes.push(open.note_of_end(Diagnostic::note(text)));
        let mut wanted = lock(&self.wanted);
        if !wanted.iter().any(|(other, _)| is_it(other)) {
            wanted.push((open, most_steps(&case)));
        }
        Ok((case, notes))
    }

    /// Notes that what follows from the tension of a case may be another one once it is found.
    pub(super) fn doubt(&self, case: &Case) {
        self.in_doubt.fetch_or(case.waits_for_flights(), Ordering::Relaxed);
    }
}

impl OpenCase {
    /// Whether the tension at the end of the spinline is that of flights.
    pub(super) fn waits_for_flights(&self) -> bool {
        self.case.waits_for_flights()
    }

    /// Flies fibres until the speed of the spinline stands; none if it never does. The bits of the tension
    /// depend on the case alone.
    ///
    /// # Errors
    /// Every reason why the case cannot be run, a fibre that is lost, and a stop.
    fn find_tension(&self, by: RunContext<'_>) -> Result<Option<FlownTension>, Error> {
        let mut open = self.clone();
        let mut speed = f64::NAN;
        let mut tension = 0.0;
        let mut steps = 0;
        for _ in 0..MOST_ROUNDS {
            let (case, _) = open.clone().resolve_at_once()?;
            let Some(line) = case.line else { break };
            let change = (line.feed_speed / speed - 1.0).abs();
            if change < SETTLED {
                // The rounds that are not needed count as simulated.
                by.done.fetch_add(most_steps(&case).saturating_sub(steps), Ordering::Relaxed);
                return Ok(Some(FlownTension { tension, change }));
            }
            speed = line.feed_speed;
            let round = round(&case);
            steps += round.run.steps * round.run.replicates;
            tension = mean_tension(&round, by)?;
            open.set_end(End::Flown(tension));
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
    fn resolve_with(mut self, found: Option<FlownTension>) -> Result<(Case, Vec<Diagnostic>), Error> {
        let Some(FlownTension { tension, change }) = found else {
            let what = Fault::new(
                format!("does not settle within {MOST_ROUNDS} rounds of simulations"),
                "write the tension that a run of this case with \"0 N\" reports, and try again",
            );
            let problem = Diagnostic { value: None, ..keys::diagnostic(END_TENSION, 0.0, what) };
            return Err(vec![self.key_values.placed(problem)].into());
        };
        self.set_end(End::Tension(tension));
        let open = self.clone();
        let (case, mut notes) = self.resolve_at_once()?;
        let speed = case.line.map_or(f64::NAN, |line| line.feed_speed);
        let text = format!(
            "was found by simulation: the mean tension at the root, {}, with a feed speed of {} that \
            changed by {} in the last round",
            Dimension::Force.pretty(tension),
            Dimension::Velocity.pretty(speed),
            Dimension::Ratio.pretty_to(change, 2)
        );
        notes.push(open.note_of_end(Diagnostic::choice(text)));
        Ok((case, notes))
    }

    fn note_of_end(&self, what: Diagnostic) -> Diagnostic {
        let note = self.key_values.placed(keys::diagnostic(END_TENSION, 0.0, what));
        Diagnostic { value: None, ..note }
    }

    fn set_end(&mut self, end: End) {
        if let Some(line) = &mut self.case.spinline {
            line.end = end;
        }
    }
}

impl WrittenValues {
    /// Whether others have the same values, wherever they stand.
    pub(super) fn has_values_of(&self, other: &Self) -> bool {
        let others = other.all().map(|(key, written)| (key, &written.value));
        self.all().map(|(key, written)| (key, &written.value)).eq(others)
    }
}

/// What flies of a case in a round.
fn round(case: &Case) -> Case {
    let mut case = case.clone();
    case.run.replicates = case.run.replicates.min(REPLICATES);
    if let Some(line) = case.line {
        let descents = DESCENTS * line.distance / line.feed_speed / case.run.time_step;
        case.run.steps = case.run.steps.min(case.run.spin_up_steps + descents.ceil() as u64);
    }
    case
}

/// Steps of all fibres that fly for the tension of a case, if it takes every round.
fn most_steps(case: &Case) -> u64 {
    let round = round(case);
    MOST_ROUNDS * round.run.steps * round.run.replicates
}

/// Mean tension at the root of the flights of a round [N].
fn mean_tension(round: &Case, by: RunContext<'_>) -> Result<f64, Error> {
    let mut tensions = Vec::new();
    fly::<Error>(round, Recorded::NUMBERS, by, |trajectory| {
        tensions.push(trajectory.number("root_tension"));
        Ok(())
    })?;
    Ok(tensions.iter().sum::<f64>() / tensions.len() as f64)
}
