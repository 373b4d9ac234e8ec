//! The thread in which the fibres fly: hears what pages ask, flies, shows frames. It never waits for a page.

use super::clock::Clock;
use super::document::{Document, complaints};
use super::fibres::Fibres;
use super::frame::{Frame, Lately};
use super::measured::Measured;
use super::message::{Answer, Asked, Complaint, Given, Pace};
use super::save;
use super::settings::{Present, Setting, present, settings};
use serde::Serialize;
use spunlaid::case::Case;
use spunlaid::case::keys::{self, Key, Kind};
use spunlaid::chain::schemes::Scheme;
use spunlaid::lanes::WIDTH;
use spunlaid::units::Dimension;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tokio::sync::{mpsc, watch};

/// Time between two tellings of the statistics.
const TELLING: Duration = Duration::from_millis(250);

/// A step that takes longer than this ends before its time.
const LONGEST_STEP: Duration = Duration::from_millis(200);
/// Steps of the flight between two looks at the clock, within such a step.
const PIECE: u64 = 16;

/// Messages that are heard between two ticks.
const MOST_HEARD: usize = 256;

/// Number of a page.
pub(super) type Page = u64;

/// A message of a page.
#[derive(Debug)]
pub(super) struct Ask {
    pub(super) from: Page,
    pub(super) asked: Asked,
    /// Where answers go. One that a page does not fetch is lost.
    pub(super) answers: mpsc::Sender<String>,
}

/// What all pages see; each sees the latest only.
#[derive(Clone, Debug)]
pub(super) struct Shown {
    pub(super) frame: watch::Receiver<Arc<Frame>>,
    /// The settings, the state and the statistics, as JSON.
    pub(super) texts: [watch::Receiver<Arc<String>>; 3],
}

/// A flight that pages look at.
pub(super) struct Session {
    document: Document,
    /// Warnings about the case.
    notes: Vec<String>,
    /// What is to be said of the scheme, as long as it is not the one of the file.
    remark: Option<String>,
    fibres: Fibres,
    measured: Measured,
    lately: Lately,
    clock: Clock,
    stands: bool,
    generation: u32,
    /// What is added to the time of the flight, so that the time of the pages goes on when the fibres start anew [s].
    since: f64,
    trouble: Option<String>,
    /// The pages that can be seen.
    pages: BTreeSet<Page>,
    folder: PathBuf,
    frames: watch::Sender<Arc<Frame>>,
    texts: [watch::Sender<Arc<String>>; 3],
    told: Instant,
}

/// The state of the flight, as it is told to pages.
#[derive(Serialize)]
#[serde(tag = "is", rename = "state")]
struct State<'a> {
    generation: u32,
    title: String,
    text: &'a str,
    command: String,
    values: Vec<Present>,
    notes: &'a [String],
    remark: Option<&'a String>,
    trouble: &'a Option<String>,
    pace: Pace,
    stands: bool,
    scheme: &'static str,
    step: String,
    /// Time from one recorded instant to the next.
    instant: String,
    length_mm: f64,
    held: bool,
    air: f64,
    gravity: f64,
    cutoff: f64,
    belt: Option<Belt>,
}

#[derive(Serialize)]
struct Belt {
    speed: f64,
    feed: f64,
}

#[derive(Serialize)]
#[serde(tag = "is", rename = "settings")]
struct Offered {
    settings: Vec<Setting>,
}

fn json(value: &impl Serialize) -> Arc<String> {
    // These values always have a text.
    Arc::new(serde_json::to_string(value).unwrap_or_default())
}

impl Session {
    /// * `remark` – what is to be said of the scheme
    /// * `folder` – where cases are saved
    ///
    /// # Errors
    /// The case cannot be read or flown.
    pub(super) fn new(
        document: Document,
        remark: Option<String>,
        folder: PathBuf,
    ) -> Result<(Self, Shown), Vec<Complaint>> {
        let read = document.read()?;
        let fibres = Fibres::new(read.case).map_err(|error| complaints(&error))?;
        let lately = Lately::new();
        let (frames, frame) = watch::channel(Arc::new(Frame::of(fibres.seen(), &lately)));
        let channels: [_; 3] = std::array::from_fn(|_| watch::channel(Arc::new(String::new())));
        let shown = Shown { frame, texts: channels.each_ref().map(|(_, shown)| shown.clone()) };
        let now = Instant::now();
        let mut clock = Clock::new(now);
        if fibres.case().line.is_some() {
            // It comes down in some hundredths of a second, too fast for an eye.
            clock.pace = Pace::Tenth;
        }
        let mut session = Self {
            measured: Measured::new(fibres.case(), 0.0),
            document,
            notes: read.warnings,
            remark,
            fibres,
            lately,
            clock,
            stands: false,
            generation: 0,
            since: 0.0,
            trouble: None,
            pages: BTreeSet::new(),
            folder,
            frames,
            texts: channels.map(|(texts, _)| texts),
            told: now,
        };
        session.show_all();
        Ok((session, shown))
    }

    /// Flies until there is nobody any more who could ask.
    pub(super) fn fly(mut self, mut asks: mpsc::Receiver<Ask>) {
        loop {
            if self.is_idle() {
                let Some(ask) = asks.blocking_recv() else { return };
                self.hear(ask, &mut asks);
                self.clock.begin(Instant::now());
                self.show_frame();
                continue;
            }
            match asks.try_recv() {
                Ok(ask) => self.hear(ask, &mut asks),
                Err(mpsc::error::TryRecvError::Empty) => {}
                Err(mpsc::error::TryRecvError::Disconnected) => return,
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

    /// Hears a message, and all that have come after it.
    fn hear(&mut self, first: Ask, asks: &mut mpsc::Receiver<Ask>) {
        let mut heard = vec![first];
        while heard.len() < MOST_HEARD
            && let Ok(ask) = asks.try_recv()
        {
            heard.push(ask);
        }
        let mut changed = false;
        for i in 0..heard.len() {
            let Ask { from, asked, answers } = &heard[i];
            // Of several values of one key that came at once, only the last counts; each gets its answer.
            let replaced = matches!(asked, Asked::Set { key, .. }
                if heard[i + 1..].iter().any(|later| matches!(&later.asked, Asked::Set { key: other, .. } if other == key)));
            let answer = match asked {
                Asked::Set { stamp, .. } if replaced => {
                    Some(Answer::Applied { stamp: *stamp, generation: self.generation + 1 })
                }
                Asked::Look { visible } => {
                    if *visible {
                        self.pages.insert(*from)
                    } else {
                        self.pages.remove(from)
                    };
                    None
                }
                asked => {
                    changed = true;
                    self.obey(asked).unwrap_or_else(Some)
                }
            };
            if let Some(answer) = answer {
                // A page that does not listen misses its answers.
                let _ = answers.try_send(answer.json());
            }
        }
        if changed {
            self.show_all();
        }
    }

    /// Does what was asked.
    ///
    /// # Errors
    /// The answer that refuses it.
    fn obey(&mut self, asked: &Asked) -> Result<Option<Answer>, Answer> {
        match asked {
            Asked::Set { key, value, stamp } => {
                let document = self.with(key, value)?;
                self.become_of(document)?;
                return Ok(Some(Answer::Applied { stamp: *stamp, generation: self.generation }));
            }
            Asked::Case { text } => self.become_of(self.document.with_text(text.clone()))?,
            Asked::Pace { pace } => {
                self.clock.pace = *pace;
                self.clock.begin(Instant::now());
            }
            Asked::Pause {} => self.stands = true,
            Asked::Go {} => {
                self.stands = false;
                self.clock.begin(Instant::now());
            }
            Asked::Step {} => {
                self.stands = true;
                self.step();
            }
            Asked::Reset {} => {
                self.fibres.reset().map_err(|error| Answer::Refused { problems: complaints(&error) })?;
                self.since = 0.0;
                self.began_anew();
            }
            Asked::Forget {} => self.changed(),
            Asked::Look { .. } => {}
            Asked::Save { name, replace } => {
                let name = save::plain_name(name).map_err(Answer::refused)?;
                let text = self.document.to_save();
                save::save(&self.folder, &name, &text, *replace)?;
                self.document = self.document.saved(&name, text);
                return Ok(Some(Answer::Saved { name }));
            }
        }
        Ok(None)
    }

    /// The document with another value of a key.
    fn with(&self, name: &str, value: &Given) -> Result<Document, Answer> {
        let key = keys::named(name).map_err(|problem| Answer::refused(problem.to_string()))?;
        let refused = |problems| Answer::Refused { problems };
        let written = toml_of(key, value).map_err(Answer::refused)?;
        let mut document = self.document.with(key, Some(written)).map_err(refused)?;
        // The diameter may have been written as a linear density.
        if let Some(other) = keys::find("fibre.linear_density").filter(|_| key.name == "fibre.diameter") {
            document = document.with(other, None).map_err(refused)?;
        }
        Ok(document)
    }

    fn become_of(&mut self, document: Document) -> Result<(), Answer> {
        let refused = |problems| Answer::Refused { problems };
        let read = document.read().map_err(refused)?;
        let since = self.now();
        let anew = self.fibres.become_of(read.case).map_err(|error| refused(complaints(&error)))?;
        (self.document, self.notes, self.trouble) = (document, read.warnings, None);
        if anew {
            self.since = since;
            self.began_anew();
        } else {
            self.changed();
        }
        Ok(())
    }

    fn began_anew(&mut self) {
        self.lately.clear_belt();
        self.trouble = None;
        self.changed();
    }

    /// Begins the statistics of the next generation.
    fn changed(&mut self) {
        self.generation = self.generation.wrapping_add(1);
        self.measured = Measured::new(self.fibres.case(), self.fibres.flight().time());
        self.clock.begin(Instant::now());
    }

    /// Time on the clock of the pages [s].
    fn now(&self) -> f64 {
        self.since + self.fibres.seen().time
    }

    fn tick(&mut self) {
        let step = self.fibres.flight().time_step();
        let Self { fibres, measured, lately, clock, since, .. } = self;
        let flown = clock.tick(step, |steps| {
            fibres.fly(steps, |instant| {
                lately.add(*since + instant.snapshot.time, instant.snapshot, &instant.laid[0]);
                measured.see(instant);
            })
        });
        if let Err(error) = flown {
            self.lost(error.to_string());
        }
        self.show_frame();
        if self.told.elapsed() >= TELLING {
            self.tell();
        }
    }

    /// Flies on by a recorded instant, as far as it goes without letting anybody wait.
    fn step(&mut self) {
        let Self { fibres, measured, lately, since, .. } = self;
        let (begun, mut left) = (Instant::now(), fibres.case().run.output_steps);
        while left > 0 && begun.elapsed() < LONGEST_STEP {
            let steps = left.min(PIECE);
            left -= steps;
            let flown = fibres.fly(steps, |instant| {
                lately.add(*since + instant.snapshot.time, instant.snapshot, &instant.laid[0]);
                measured.see(instant);
            });
            if let Err(error) = flown {
                return self.lost(error.to_string());
            }
        }
    }

    /// The fibres are lost: they start anew, and stand.
    fn lost(&mut self, why: String) {
        self.since = self.now();
        if !self.since.is_finite() {
            self.since = 0.0;
        }
        // A case that has been flown can be started again.
        let _ = self.fibres.reset();
        self.began_anew();
        self.stands = true;
        self.trouble = Some(why);
        self.show_all();
    }

    fn show_frame(&self) {
        let fed = self.fibres.case().line;
        let mut frame = Frame::of(self.fibres.seen(), &self.lately);
        frame.generation = self.generation;
        frame.stands = self.stands;
        frame.behind = self.clock.is_behind();
        frame.fed = fed.is_some();
        frame.belt_run = fed.map_or(0.0, |line| line.belt_speed * frame.time);
        frame.time = self.now();
        frame.speed = if self.stands { 0.0 } else { self.clock.speed() };
        self.frames.send_replace(Arc::new(frame));
    }

    fn tell(&mut self) {
        self.told = Instant::now();
        let told = self.measured.told(self.generation, self.fibres.flight());
        self.texts[2].send_replace(json(&told));
    }

    /// Shows settings, state, statistics and a frame.
    fn show_all(&mut self) {
        let case = self.fibres.case();
        let offered = json(&Offered { settings: settings(case) });
        self.texts[0].send_if_modified(|old| {
            let other = *old != offered;
            if other {
                *old = offered;
            }
            other
        });
        self.texts[1].send_replace(json(&self.state(case)));
        self.tell();
        self.show_frame();
    }

    fn state<'a>(&'a self, case: &Case) -> State<'a> {
        let line = case.line;
        State {
            generation: self.generation,
            title: self.document.title(),
            text: self.document.text(),
            command: self.document.command(WIDTH),
            values: present(case),
            notes: &self.notes,
            remark: self.remark.as_ref().filter(|_| case.run.scheme == Scheme::ImplicitTension),
            trouble: &self.trouble,
            pace: self.clock.pace,
            stands: self.stands,
            scheme: case.run.scheme.name(),
            step: Dimension::Time.pretty_to(case.run.time_step, 3),
            instant: Dimension::Time.pretty_to(case.run.output_interval(), 3),
            length_mm: 1e3 * line.map_or(case.fibre.length, |line| line.distance),
            held: case.fibre.root != spunlaid::fibre::Root::Free,
            air: case.air.velocity,
            gravity: case.run.gravity,
            cutoff: case.air.cutoff_frequency,
            belt: line.map(|line| Belt { speed: line.belt_speed, feed: line.feed_speed }),
        }
    }
}

/// A value as a case file has it: a number gets the unit of its key.
fn toml_of(key: &Key, value: &Given) -> Result<toml_edit::Value, String> {
    match (value, &key.kind) {
        (Given::Number(number), _) if !number.is_finite() => Err("the number is not finite".to_owned()),
        (Given::Number(number), Kind::Quantity(Dimension::Ratio, _)) => Ok((*number).into()),
        (Given::Number(number), Kind::Quantity(dimension, _)) => Ok(dimension.pretty_to(*number, 6).into()),
        (Given::Number(number), Kind::Whole(..)) if number.fract() == 0.0 && (0.0..9e15).contains(number) => {
            Ok((*number as i64).into())
        }
        (Given::Text(text), Kind::Quantity(Dimension::Ratio, _)) => {
            Ok(text.trim().parse::<f64>().map_or_else(|_| text.trim().into(), Into::into))
        }
        (Given::Text(text), Kind::Whole(..)) => {
            Ok(text.trim().parse::<i64>().map_or_else(|_| text.trim().into(), Into::into))
        }
        (Given::Text(text), _) => Ok(text.trim().into()),
        _ => Err(format!("{} takes {}", key.name, key.allowed())),
    }
}
