//! The thread that simulates webs for the session of a line: one piece of work at a time, until it is done or unwanted.

use super::Heard;
use super::laid::Laid;
use spunlaid::experiment::Change;
use spunlaid::experiment::advice::{PinnedWeb, Seen};
use spunlaid::ground::threads::look_while;
use spunlaid::ground::{Effect, Error, Isa, RunContext};
use spunlaid::input::{LineFile, Resources, Turn, TurnedLine, WebSpec, read_line};
use spunlaid::simulation::{Flights, Flyer};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{Receiver, SyncSender};
use std::thread;
use std::time::Duration;

/// Time between two looks at the progress of a web.
const LOOK: Duration = Duration::from_millis(250);

/// How far a confirmation is when the first of its two webs has been simulated.
pub(super) const HALF: f64 = 0.5;

/// Something to do.
pub(super) struct Job {
    /// Its number; what is heard of it has the same.
    pub(super) number: u64,
    pub(super) work: Work,
    /// Set when nobody waits for it any more.
    pub(super) stop: Arc<AtomicBool>,
}

/// What is to be done.
pub(super) enum Work {
    /// Find the tension at the end of the spinline, with these knobs turned.
    Settle(Vec<Turn>),
    /// Simulate a sample of the filaments coarsely, for others to be compared with.
    Pin(Arc<WebSpec>),
    /// Compare a web with the pinned one.
    Compare(Arc<WebSpec>),
    /// Compare the second web with the first one in an air with another seed.
    Confirm([Arc<WebSpec>; 2]),
    /// Lay a web as `spunlaid web` does.
    Lay(Arc<WebSpec>),
    /// Try the changes of a line, given as text, other than those of these numbers.
    Try(String, Vec<usize>),
}

/// What is heard of a job.
pub(crate) struct News {
    /// Number of the job.
    pub(super) of: u64,
    pub(super) what: What,
}

/// See [`News`].
pub(crate) enum What {
    /// How far it is, from 0 to 1.
    Share(f64),
    /// Something is seen of a coarse web.
    Seen(Seen),
    /// A change, its number, and what it does to the CV; nothing if it could not be tried.
    Tried(Box<Change>, usize, Vec<Effect<f64>>),
    /// It has ended, and what it has led to.
    Ended(Result<End, Error>),
}

/// How a job ends.
pub(crate) enum End {
    Settled(Box<TurnedLine>),
    Laid(Box<Laid>),
    /// All that it leads to has been heard.
    Done,
}

/// What the thread keeps from one job to the next.
struct Pilot {
    file: Arc<LineFile>,
    name: String,
    resources: Resources,
    pinned: Option<PinnedWeb>,
    news: SyncSender<Heard>,
}

/// Does jobs until nobody asks for more.
///
/// * `name` – what messages call the line, and from where the files in it are read
pub(super) fn fly(file: Arc<LineFile>, name: String, jobs: &Receiver<Job>, news: SyncSender<Heard>) {
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let mut pilot = Pilot { file, name, resources: Resources::default(), pinned: None, news };
    for Job { number, work, stop } in jobs {
        let done = AtomicU64::new(0);
        let by = RunContext { threads, isa: Isa::detect(), stop: &stop, done: &done };
        let ended = catch_unwind(AssertUnwindSafe(|| pilot.work(number, work, by)));
        // A fault of the program has said what it is.
        pilot.report(number, What::Ended(ended.unwrap_or(Err(Error::no_fibre()))));
    }
}

impl Pilot {
    /// Who does not listen any more hears nothing.
    fn report(&self, of: u64, what: What) {
        let _ = self.news.send(Heard::Flight(News { of, what }));
    }

    fn work(&mut self, number: u64, work: Work, by: RunContext<'_>) -> Result<End, Error> {
        match work {
            Work::Settle(turns) => {
                let file = Arc::clone(&self.file);
                let read = |resources: &Resources| file.turned(&turns, resources);
                let line = self.resources.resolve_tension(read, |resources| resources.fly(by))?;
                return Ok(End::Settled(Box::new(line)));
            }
            Work::Pin(spec) => {
                // The memory of the one before is free first.
                self.pinned = None;
                let pinned = PinnedWeb::fly(&spec, &mut |seen| self.report(number, What::Seen(seen)), by)?;
                self.pinned = Some(pinned);
            }
            Work::Compare(spec) => {
                let pinned = self.pinned.as_ref().ok_or_else(Error::no_fibre)?;
                pinned.compare(&spec, &mut |seen| self.report(number, What::Seen(seen)), by)?;
            }
            Work::Confirm(webs) => self.confirm(number, webs, by)?,
            Work::Lay(spec) => return self.lay(number, &spec, by).map(|laid| End::Laid(Box::new(laid))),
            Work::Try(text, tried) => self.try_changes(number, &text, &tried, by)?,
        }
        Ok(End::Done)
    }

    /// Compares two webs in an air with another seed.
    fn confirm(&self, number: u64, webs: [Arc<WebSpec>; 2], by: RunContext<'_>) -> Result<(), Error> {
        let [before, now] = webs.map(|spec| WebSpec { seed: other_seed(&spec), ..(*spec).clone() });
        // What the first web lays says how far it is, and nothing else.
        let mut go_on = |seen: Seen| {
            if matches!(seen, Seen::Laid(_)) {
                self.report(number, What::Seen(seen));
            }
        };
        let pinned = PinnedWeb::fly(&before, &mut go_on, by)?;
        self.report(number, What::Share(HALF));
        pinned.compare(&now, &mut |seen| self.report(number, What::Seen(seen)), by)
    }

    /// Lays a web: the same calls as `spunlaid web`, so the numbers have the same bits.
    fn lay(&self, number: u64, spec: &WebSpec, by: RunContext<'_>) -> Result<Laid, Error> {
        let (all, simulated) = (steps(spec), AtomicU64::new(0));
        let follow = |flights: Flights<'_>, work: &mut (dyn FnMut() + Send)| {
            let done = || simulated.load(Ordering::Relaxed) + flights.done.load(Ordering::Relaxed);
            let share = || self.report(number, What::Share(done() as f64 / all.max(1) as f64));
            look_while(LOOK, share, work);
            simulated.fetch_add(flights.done.load(Ordering::Relaxed), Ordering::Relaxed);
        };
        let mut web = Flyer::new(by.threads, by.stop, &follow).web(spec)?;
        let findings = web.find(by)?;
        Ok(Laid::new(&web, &findings))
    }

    /// Tries changes of a line, the cheapest first.
    fn try_changes(
        &mut self,
        number: u64,
        text: &str,
        tried: &[usize],
        by: RunContext<'_>,
    ) -> Result<(), Error> {
        let name = &self.name;
        let read = |resources: &Resources| Ok(read_line(text, name, resources)?.changes());
        let changes = self.resources.resolve_tension(read, |resources| resources.fly(by))?;
        let pinned = self.pinned.as_ref().ok_or_else(Error::no_fibre)?;
        let mut left: Vec<(usize, Change)> = one_of_each(changes.into_iter().enumerate());
        left.retain(|(place, _)| !tried.contains(place));
        left.sort_by_key(|(_, change)| steps(&change.experiment.spec));
        let count = left.len();
        for (i, (place, change)) in left.into_iter().enumerate() {
            self.report(number, What::Share(i as f64 / count as f64));
            let mut last = Vec::new();
            let mut see = |seen| {
                if let Seen::Look(look) = seen {
                    last = look.changes;
                }
            };
            match pinned.compare(&change.experiment.spec, &mut see, by) {
                Err(Error::Interrupted) => return Err(Error::Interrupted),
                // A change with which no line could run says nothing.
                Err(_) => self.report(number, What::Tried(Box::new(change), place, Vec::new())),
                Ok(()) => self.report(number, What::Tried(Box::new(change), place, last)),
            }
        }
        Ok(())
    }
}

/// The seed of the air in which a change of a web is confirmed.
pub(super) const fn other_seed(spec: &WebSpec) -> u64 {
    spec.seed.wrapping_add(1)
}

/// One change of each knob that can be made, the increase if both can.
fn one_of_each(changes: impl Iterator<Item = (usize, Change)>) -> Vec<(usize, Change)> {
    let is_more = |change: &Change| change.keys.first().is_some_and(|key| key.to > key.from);
    let mut all: Vec<(usize, Change)> = Vec::new();
    for (place, change) in changes.filter(|(_, change)| change.refusal.is_none()) {
        let is_same = |other: &Change| other.setting == change.setting && other.layers == change.layers;
        match all.iter_mut().find(|(_, other)| is_same(other)) {
            Some(known) if is_more(&change) => *known = (place, change),
            Some(_) => {}
            None => all.push((place, change)),
        }
    }
    all
}

/// Steps that a web takes, about.
pub(super) fn steps(spec: &WebSpec) -> u64 {
    spec.planned_flights().iter().map(|flight| flight.steps + flight.coarse_steps).sum()
}
