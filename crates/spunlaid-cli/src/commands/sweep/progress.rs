//! Progress of a study: a bar on a terminal, or a line from time to time in a log file.

use crate::progress::{bar, fitting, show_while};
use crate::say;
use spunlaid::study::{Progress, Study};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// A line is written to a log file after this time, or after this fraction of the work but not before the last time.
const LINE_AFTER: Duration = Duration::from_secs(10);
const LINE_SHARE: f64 = 0.05;
const LINE_SOONEST: Duration = Duration::from_secs(2);

/// Columns of what stands before the words of the bar.
const BEFORE: usize = 31;

/// Runs `work` and shows its progress, unless `quiet`.
pub(super) fn follow<T>(
    study: &Study,
    progress: &Progress,
    steps: &AtomicU64,
    quiet: bool,
    work: impl FnOnce() -> T,
) -> T {
    if quiet {
        return work();
    }
    let bar = bar(1, "[{bar:20}] {percent:>3} %  {msg}", false);
    let mut log = Log { last: Instant::now(), share: 0.0 };
    let begun = Instant::now();
    let mut before = None;
    let show = || {
        let state = State::new(study, progress, steps, begun, &mut before);
        if bar.is_hidden() {
            log.show(&state);
        } else {
            bar.set_length(state.steps.max(1));
            bar.set_position(state.steps_done);
            bar.set_message(fitting(&state.words(), BEFORE));
        }
    };
    show_while(&bar, Duration::from_millis(100), show, work)
}

struct State {
    /// What a replicate is called.
    noun: &'static str,
    points: (u64, u64),
    fibres: (u64, u64),
    /// Fibres finished since the program began.
    finished: u64,
    steps: u64,
    steps_done: u64,
    elapsed: f64,
}

impl State {
    fn new(
        study: &Study,
        progress: &Progress,
        steps: &AtomicU64,
        begun: Instant,
        before: &mut Option<u64>,
    ) -> Self {
        let load = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        let (fibres, done) = (load(&progress.fibres), load(&progress.fibres_done));
        // Fibres that were finished before the program began.
        if before.is_none() && fibres > 0 {
            *before = Some(done);
        }
        Self {
            noun: study.noun(),
            points: (load(&progress.points_done), study.points.len() as u64),
            fibres: (done, fibres),
            finished: done.saturating_sub(before.unwrap_or(done)),
            steps: load(&progress.steps),
            steps_done: load(steps).min(load(&progress.steps)),
            elapsed: begun.elapsed().as_secs_f64(),
        }
    }

    fn words(&self) -> String {
        let ((points, of_points), (fibres, of_fibres)) = (self.points, self.fibres);
        let noun = self.noun;
        let mut words = format!("points {points}/{of_points}, {noun}s {fibres}/{of_fibres}");
        if self.finished > 0 {
            let rate = self.finished as f64 / self.elapsed;
            words += &format!(", {rate:.prec$} {noun}s/s", prec = usize::from(rate < 10.0));
        }
        if self.steps_done > 0 && self.elapsed > 1.0 {
            let left = self.elapsed * (self.steps - self.steps_done) as f64 / self.steps_done as f64;
            words += &format!(", {} left", time(left));
        }
        words
    }
}

/// A remaining time: `40 s`, `12 min`, `3.5 h`.
fn time(seconds: f64) -> String {
    match seconds {
        s if s < 100.0 => format!("{s:.0} s"),
        s if s < 6000.0 => format!("{:.0} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}

struct Log {
    last: Instant,
    share: f64,
}

impl Log {
    fn show(&mut self, state: &State) {
        let share = state.steps_done as f64 / state.steps.max(1) as f64;
        let since = self.last.elapsed();
        if since >= LINE_AFTER || since >= LINE_SOONEST && share >= self.share + LINE_SHARE {
            say::aside(&state.words());
            (self.last, self.share) = (Instant::now(), share);
        }
    }
}
