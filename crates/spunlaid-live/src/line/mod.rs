//! A line whose knobs are turned while its web is simulated. The thread of the session hears what pages ask and plans;
//! another one simulates. No page waits for a web, and a web that nobody waits for is stopped.
//!
//! ```text
//! commands, knobs   what pages ask; knobs in their units
//! plan              what is simulated next
//! flight            the thread that simulates
//! known_web, laid   what is known of each web
//! found, picture    numbers and bytes for pages
//! filament          its filaments, on pages of their own
//! ```

mod commands;
mod filament;
mod flight;
mod found;
mod knobs;
mod known_web;
mod laid;
mod picture;
mod plan;
mod show;

use crate::board::{Board, PageId};
use crate::message::{PageRequest, Receives, at_once};
use filament::FilamentPage;
use flight::{End, HALF, Job, News, What, Work};
use knobs::Slope;
use known_web::KnownWeb;
use picture::BeltPicture;
use plan::{Air, Known, Task};
use spunlaid::experiment::advice::{LOOKS, Seen};
use spunlaid::ground::{Error, Fault, Isa, RunContext};
use spunlaid::input::{LineFile, Resources, TurnedLine, read_line};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, mpsc};
use std::thread;

/// How much of the belt runs by until the last look, over the length of the sheet that is looked at, about.
const WITH_BEGINNING: f64 = 1.4;
/// Files of one name that are looked for before another name is given.
const MOST_FILES: u32 = 1000;

/// What the session hears.
pub(super) enum Heard {
    Page(PageRequest),
    Flight(News),
}

impl From<PageRequest> for Heard {
    fn from(request: PageRequest) -> Self {
        Self::Page(request)
    }
}

/// A task that is being done.
struct Flying {
    number: u64,
    task: Task,
    /// How far it is, from 0 to 1.
    share: f64,
    stop: Arc<AtomicBool>,
}

impl Flying {
    /// Whether nobody waits for it any more.
    fn is_unwanted(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }
}

/// See the [module](self).
pub(super) struct Session {
    file: Arc<LineFile>,
    path: Option<PathBuf>,
    /// What messages call the line, and from where the files in it are read.
    name: String,
    /// Whether it lies in another folder than that where files are saved.
    is_elsewhere: bool,
    folder: PathBuf,
    save_name: String,
    resources: Resources,
    /// All webs that are remembered; the present one is the last.
    webs: Vec<KnownWeb>,
    last_number: u32,
    /// Numbers of the web of comparison and of the present one.
    before: u32,
    now: u32,
    /// The web that is pinned.
    pinned: Option<u32>,
    slopes: Vec<Slope>,
    /// The web of whose knobs all effects are known.
    tried: Option<u32>,
    failed: Vec<Task>,
    trouble: Option<String>,
    /// Why the present web cannot be compared.
    no_sketch: Option<String>,
    stands: bool,
    /// The pages that can be seen.
    pages: BTreeSet<PageId>,
    flying: Option<Flying>,
    last_job: u64,
    /// The pages of its filaments, and why there is none of others.
    filaments: Vec<FilamentPage>,
    lacking: Vec<String>,
    picture: BeltPicture,
    board: Arc<Board<BeltPicture>>,
}

impl Session {
    /// * `folder` – where lines are saved
    ///
    /// # Errors
    /// The line cannot be read.
    pub(super) fn new(text: String, path: Option<PathBuf>, folder: PathBuf) -> Result<Self, Error> {
        let name = path.as_ref().map_or_else(|| "line.toml".to_owned(), |path| path.display().to_string());
        let mut resources = Resources::default();
        let stop = AtomicBool::new(false);
        let done = AtomicU64::new(0);
        let threads = thread::available_parallelism().map_or(1, usize::from);
        let by = RunContext { threads, isa: Isa::detect(), stop: &stop, done: &done };
        let read = |resources: &Resources| {
            let file = read_line(&text, &name, resources)?;
            let line = file.turned(&[], resources)?;
            Ok::<_, Error>((file, line))
        };
        let (file, line) = resources.resolve_tension(read, |resources| resources.fly(by))?;
        if !line.spec.flies() {
            let what = format!(
                "{name} gives the laydown as numbers, so no filaments are simulated that a page could show"
            );
            let remedy = format!(
                "`spunlaid web {name}` lays it; `spunlaid new --web` writes a line that is simulated"
            );
            return Err(Fault::new(what, remedy).into());
        }
        let is_elsewhere = path.as_ref().and_then(|path| path.parent()).is_some_and(|at| at != Path::new(""));
        let first = KnownWeb::new(0, Vec::new(), line);
        let mut session = Self {
            file: Arc::new(file),
            path,
            name,
            is_elsewhere,
            folder,
            save_name: String::new(),
            resources,
            webs: vec![first],
            last_number: 0,
            before: 0,
            now: 0,
            pinned: None,
            slopes: Vec::new(),
            tried: None,
            failed: Vec::new(),
            trouble: None,
            no_sketch: None,
            stands: false,
            pages: BTreeSet::new(),
            flying: None,
            last_job: 0,
            filaments: Vec::new(),
            lacking: Vec::new(),
            picture: BeltPicture::default(),
            board: Arc::new(Board::new(BeltPicture::default())),
        };
        session.save_name = session.free_name();
        session.show();
        Ok(session)
    }

    /// Where pages see the line.
    pub(super) fn board(&self) -> Arc<Board<BeltPicture>> {
        Arc::clone(&self.board)
    }

    fn path(&self) -> &Path {
        self.path.as_deref().unwrap_or(Path::new("line.toml"))
    }

    /// A name for a file beside the line that no file has.
    fn free_name(&self) -> String {
        let stem = self.path().file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let name = |number: u32| format!("{stem}_{number}.toml");
        let is_free = |name: &String| self.folder.join(name).symlink_metadata().is_err();
        (2..MOST_FILES).map(name).find(is_free).unwrap_or_else(|| name(MOST_FILES))
    }

    /// The web of a number; one that is forgotten is the present one.
    fn web(&self, number: u32) -> &KnownWeb {
        let found = self.webs.iter().find(|web| web.number == number);
        // There is always a present one.
        found.unwrap_or(&self.webs[self.webs.len() - 1])
    }

    fn web_mut(&mut self, number: u32) -> Option<&mut KnownWeb> {
        self.webs.iter_mut().find(|web| web.number == number)
    }

    /// Receives pages and flights until nobody is there any more who could ask.
    ///
    /// * `sender` – leads to `heard`
    pub(super) fn fly(mut self, heard: &mpsc::Receiver<Heard>, sender: mpsc::SyncSender<Heard>) {
        let (jobs, asked) = mpsc::channel();
        let (file, name) = (Arc::clone(&self.file), self.name.clone());
        let pilot = thread::Builder::new().name("flight".to_owned());
        if let Err(error) = pilot.spawn(move || flight::fly(file, name, &asked, sender)) {
            self.trouble = Some(error.to_string());
        }
        while let Ok(first) = heard.recv() {
            self.receive_all(at_once(first, heard));
            self.go_on(&jobs);
            self.show();
        }
    }

    /// Receives what has come at once.
    fn receive_all(&mut self, all: Vec<Heard>) {
        let mut requests = Vec::new();
        for one in all {
            match one {
                Heard::Page(request) => requests.push(request),
                Heard::Flight(news) => self.take(news),
            }
        }
        let board = self.board();
        if self.receive(&requests, &board) {
            self.show_picture();
        }
    }

    /// Stops what nobody waits for, and begins what is next.
    fn go_on(&mut self, jobs: &mpsc::Sender<Job>) {
        let next = self.next();
        if let Some(flying) = &self.flying {
            if Some(flying.task) != next {
                flying.stop.store(true, Ordering::Relaxed);
            }
            return;
        }
        let Some(task) = next else { return };
        let work = match task {
            Task::Settle(web) => Work::Settle(self.web(web).turns.clone()),
            Task::Pin(web) => Work::Pin(Arc::clone(&self.web(web).spec)),
            Task::Compare { now, air: Air::OfFile, .. } => Work::Compare(Arc::clone(&self.web(now).spec)),
            Task::Compare { before, now, air: Air::Other } => {
                Work::Confirm([before, now].map(|number| Arc::clone(&self.web(number).spec)))
            }
            Task::Lay(web) => Work::Lay(Arc::clone(&self.web(web).spec)),
            Task::Try(web) => {
                let text = self.web(web).line.text.clone();
                Work::Try(text, self.slopes.iter().map(|slope| slope.place).collect())
            }
        };
        if matches!(task, Task::Pin(_)) {
            self.pinned = None;
        }
        if matches!(task, Task::Pin(_) | Task::Compare { air: Air::OfFile, .. }) {
            self.picture.clear_belt();
        }
        self.last_job += 1;
        let (number, stop) = (self.last_job, Arc::new(AtomicBool::new(false)));
        self.flying = Some(Flying { number, task, share: 0.0, stop: Arc::clone(&stop) });
        if jobs.send(Job { number, work, stop }).is_err() {
            self.flying = None;
            self.failed.push(task);
            self.trouble = Some("the thread that simulates has ended; start the program again".to_owned());
        }
    }

    /// The next task; none while the line stands or nobody looks.
    fn next(&self) -> Option<Task> {
        if self.stands || self.pages.is_empty() {
            return None;
        }
        let (before, now) = (self.web(self.before), self.web(self.now));
        let known = Known {
            before: before.state(),
            now: now.state(),
            is_pinned: self.pinned == Some(self.before),
            is_compared: now.comparison(Air::OfFile, self.before).is_some_and(|one| one.is_done),
            is_in_question: now.comparison(Air::Other, self.before).is_some_and(|one| !one.is_done),
            is_tried: self.tried == Some(self.before),
        };
        plan::next(&known, &self.failed)
    }

    /// Takes in what is heard of a task.
    fn take(&mut self, News { of, what }: News) {
        let Some(flying) = self.flying.as_mut().filter(|flying| flying.number == of) else { return };
        let (task, is_unwanted) = (flying.task, flying.is_unwanted());
        match what {
            What::Share(share) => flying.share = share.min(1.0),
            What::Ended(ended) => {
                self.flying = None;
                self.end(task, ended);
                self.show_picture();
            }
            _ if is_unwanted => {}
            What::Seen(seen) => self.see(task, seen),
            What::Tried(change, place, effects) => {
                self.slopes.push(Slope { change: *change, place, effects })
            }
        }
    }

    /// Takes in what is seen of a coarse web.
    fn see(&mut self, task: Task, seen: Seen) {
        let last = LOOKS[LOOKS.len() - 1];
        match (seen, task) {
            (Seen::Laid(stretch), _) => {
                let layers = self.web(self.now).spec.layers.len();
                let part = stretch.belt * stretch.width / (last * WITH_BEGINNING);
                let share = (stretch.layer as f64 + part.min(1.0)) / layers as f64;
                let Some(flying) = &mut self.flying else { return };
                if matches!(task, Task::Compare { air: Air::Other, .. }) {
                    // Of its two webs one after the other; the belt shows the one in the air of the file.
                    let from = if flying.share < HALF { 0.0 } else { HALF };
                    flying.share = (from + HALF * share).min(from + HALF - f64::EPSILON);
                    return;
                }
                flying.share = share;
                self.picture.add(&stretch);
                self.show_picture();
            }
            (Seen::Look(look), Task::Pin(web)) => {
                if let Some(web) = self.web_mut(web) {
                    web.coarse = Some(look);
                }
            }
            (Seen::Look(look), Task::Compare { before, now, air }) => {
                if let Some(web) = self.web_mut(now) {
                    web.compare(air, before).look = Some(look);
                }
            }
            _ => {}
        }
    }

    /// Takes in how a task has ended.
    fn end(&mut self, task: Task, ended: Result<End, Error>) {
        let end = match ended {
            Ok(end) => end,
            Err(Error::Interrupted) => return,
            Err(error) => {
                self.failed.push(task);
                match task {
                    Task::Compare { now, air: Air::Other, .. } => {
                        self.web_mut(now).into_iter().for_each(|web| web.forget_comparison(Air::Other));
                        self.no_sketch = Some(format!("the change could not be confirmed: {error}"));
                    }
                    Task::Pin(_) | Task::Compare { .. } => self.no_sketch = Some(no_sketch(&error)),
                    Task::Try(_) => {}
                    _ => self.trouble = Some(error.to_string()),
                }
                return;
            }
        };
        match (task, end) {
            (Task::Settle(web), End::Settled(line)) => self.settled(web, *line),
            (Task::Lay(web), End::Laid(laid)) => {
                self.web_mut(web).into_iter().for_each(|web| web.laid = Some((*laid).clone()));
            }
            (Task::Pin(web), _) => self.pinned = Some(web),
            (Task::Compare { before, now, air }, _) if before == self.before => {
                self.web_mut(now).into_iter().for_each(|web| web.compare(air, before).is_done = true);
            }
            (Task::Try(web), _) => self.tried = Some(web),
            _ => {}
        }
    }

    /// A tension has been found.
    fn settled(&mut self, number: u32, line: TurnedLine) {
        let Some(place) = self.webs.iter().position(|web| web.number == number) else { return };
        let turns = self.webs[place].turns.clone();
        self.webs[place] = KnownWeb::new(number, turns, line);
        if number == self.now {
            self.show_filaments();
        }
    }
}

/// Why a web is not compared, and what follows.
fn no_sketch(error: &Error) -> String {
    format!("no first numbers; the complete web will give them: {error}")
}
