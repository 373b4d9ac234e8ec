//! Fibres that fly while their case is changed: the thread in which they do hears what pages ask, flies, shows frames.
//! It never waits for a page.
//!
//! ```text
//! document, settings   the case as text; what can be changed
//! fibres, clock        eight fibres in one flight; how much time goes by
//! laid, measured       statistics since the last change
//! frame                the moving picture
//! ```

mod clock;
mod commands;
mod document;
mod fibres;
mod frame;
mod laid;
mod measured;
mod settings;
mod show;
mod start;
mod tension;

pub(super) use document::Document;
pub(super) use start::begin;

use crate::board::{Board, PageId};
use crate::message::{PageDiagnostic, PageRequest, Receives, at_once, diagnostics};
use clock::Clock;
use fibres::Fibres;
use frame::{Frame, RecentMotion};
use measured::Statistics;
use spunlaid::ground::Error;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::{Arc, mpsc};
use std::time::{Duration, Instant};
use tension::TensionSearch;

/// Time between two tellings of the statistics.
const TELLING: Duration = Duration::from_millis(250);

/// A step that takes longer than this ends before its time.
const LONGEST_STEP: Duration = Duration::from_millis(200);
/// Steps of the flight between two looks at the clock, within such a step.
const PIECE: u64 = 16;

/// Time between two looks whether a search for a tension has ended, while nothing else happens.
const LOOK: Duration = Duration::from_millis(50);

/// A flight that pages look at.
pub(super) struct Session {
    document: Document,
    /// Warnings about the case.
    notes: Vec<String>,
    /// What is to be said of the scheme, as long as it is not the one of the file.
    remark: Option<String>,
    fibres: Fibres,
    measured: Statistics,
    recent_motion: RecentMotion,
    clock: Clock,
    stands: bool,
    generation: u32,
    /// What is added to the time of the flight, so that the time of the pages goes on when the fibres start again [s].
    since: f64,
    trouble: Option<String>,
    /// The flights that find the tension at the end of the spinline, as long as it is not known.
    search: Option<TensionSearch>,
    /// The pages that can be seen.
    pages: BTreeSet<PageId>,
    folder: PathBuf,
    board: Arc<Board<Frame>>,
    statistics_shown: Instant,
}

impl Session {
    /// * `remark` – what the user must know of the scheme
    /// * `folder` – where cases are saved
    ///
    /// # Errors
    /// The case cannot be read or simulated.
    fn new(document: Document, remark: Option<String>, folder: PathBuf) -> Result<Self, Vec<PageDiagnostic>> {
        let read = document.read()?;
        let search = read.case.waits_for_flights().then(|| TensionSearch::begin(&document));
        let fibres = Fibres::new(read.case).map_err(|error| diagnostics(&error))?;
        let recent_motion = RecentMotion::new();
        let board = Arc::new(Board::new(Frame::new(fibres.snapshot(), &recent_motion)));
        let now = Instant::now();
        let mut clock = Clock::new(now);
        if fibres.case().line.is_some() {
            // It comes down in some hundredths of a second, too fast for an eye.
            clock.pace = crate::message::Pace::Tenth;
        }
        let mut session = Self {
            measured: Statistics::new(fibres.case(), fibres.flight()),
            document,
            notes: read.warnings,
            remark,
            fibres,
            recent_motion,
            clock,
            stands: false,
            generation: 0,
            since: 0.0,
            trouble: None,
            search,
            pages: BTreeSet::new(),
            folder,
            board,
            statistics_shown: now,
        };
        session.show_all();
        Ok(session)
    }

    /// Where pages see the flight.
    pub(super) fn board(&self) -> Arc<Board<Frame>> {
        Arc::clone(&self.board)
    }

    /// Flies until there is nobody any more who could ask.
    pub(super) fn fly(mut self, requests: &mpsc::Receiver<PageRequest>) {
        loop {
            self.take_tension();
            if self.is_idle() {
                let heard = match self.search {
                    Some(_) => requests.recv_timeout(LOOK),
                    None => requests.recv().map_err(|_| mpsc::RecvTimeoutError::Disconnected),
                };
                match heard {
                    Ok(request) => self.receive_all(at_once(request, requests)),
                    Err(mpsc::RecvTimeoutError::Timeout) => continue,
                    Err(mpsc::RecvTimeoutError::Disconnected) => return,
                }
                self.clock.begin(Instant::now());
                self.show_frame();
                continue;
            }
            match requests.try_recv() {
                Ok(request) => self.receive_all(at_once(request, requests)),
                Err(mpsc::TryRecvError::Empty) => {}
                Err(mpsc::TryRecvError::Disconnected) => return,
            }
            if !self.is_idle() {
                self.tick();
                std::thread::sleep(self.clock.rest());
            }
        }
    }

    /// Whether the time stands, or nobody looks.
    fn is_idle(&self) -> bool {
        self.stands || self.pages.is_empty()
    }

    /// Receives what has come at once.
    fn receive_all(&mut self, requests: Vec<PageRequest>) {
        let board = self.board();
        if self.receive(&requests, &board) {
            self.show_all();
        }
    }

    /// Time on the clock of the pages [s].
    fn now(&self) -> f64 {
        self.since + self.fibres.snapshot().time
    }

    /// Flies as many steps as the clock asks for.
    fn tick(&mut self) {
        let step = self.fibres.flight().time_step();
        let Self { fibres, measured, recent_motion, clock, since, .. } = self;
        if let Err(error) = clock.tick(step, |steps| see(fibres, steps, *since, recent_motion, measured)) {
            self.handle_lost_fibres(error.to_string());
        }
        self.show_frame();
        if self.statistics_shown.elapsed() >= TELLING {
            self.send_statistics();
        }
    }

    /// Flies on by a recorded instant, as far as it goes without letting anybody wait.
    fn step(&mut self) {
        let Self { fibres, measured, recent_motion, since, .. } = self;
        let (begun, mut left) = (Instant::now(), fibres.case().run.output_steps);
        while left > 0 && begun.elapsed() < LONGEST_STEP {
            let steps = left.min(PIECE);
            left -= steps;
            if let Err(error) = see(fibres, steps, *since, recent_motion, measured) {
                return self.handle_lost_fibres(error.to_string());
            }
        }
    }

    /// The fibres are lost: they start again, and stand.
    fn handle_lost_fibres(&mut self, why: String) {
        self.since = self.now();
        if !self.since.is_finite() {
            self.since = 0.0;
        }
        // A case that has been simulated can be started again.
        let _ = self.fibres.reset();
        self.restart_statistics();
        self.stands = true;
        self.trouble = Some(why);
        self.show_all();
    }
}

/// Flies a number of steps; the recorded instants are kept for frames and statistics.
fn see(
    fibres: &mut Fibres,
    steps: u64,
    since: f64,
    recent_motion: &mut RecentMotion,
    measured: &mut Statistics,
) -> Result<(), Error> {
    fibres.fly(steps, |instant| {
        recent_motion.add(since + instant.snapshot.time, instant.snapshot, &instant.laid[0]);
        measured.see(instant);
    })
}
