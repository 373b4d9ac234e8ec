//! Progress of a run: a bar on a terminal, a line now and then elsewhere.

use crate::say;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use spunlaid::ground::OnDrop;
use spunlaid::ground::threads::look_while;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use terminal_size::terminal_size_of;

/// How often a line is written where there is no terminal.
const BETWEEN_LINES: Duration = Duration::from_secs(10);

/// Runs `work` and shows how far `done` is on its way to `total`: as a bar on a terminal, elsewhere as a line
/// every ten seconds. Nothing is shown if `quiet`.
pub(crate) fn follow<T>(
    done: &AtomicU64,
    total: u64,
    label: &str,
    quiet: bool,
    work: impl FnOnce() -> T,
) -> T {
    follow_state(|| (done.load(Ordering::Relaxed), total, label.to_owned()), quiet, work)
}

/// [`follow`] of work whose total may change.
///
/// * `state` – what is done, the total, and the words for both
pub(crate) fn follow_state<T>(
    mut state: impl FnMut() -> (u64, u64, String) + Send,
    quiet: bool,
    work: impl FnOnce() -> T,
) -> T {
    if quiet {
        return work();
    }
    let bar = bar(1, "[{bar:20}] {percent:>3} %  {msg}", quiet);
    let begun = Instant::now();
    let (is_hidden, mut next) = (bar.is_hidden(), BETWEEN_LINES);
    let show = || {
        if is_hidden && begun.elapsed() < next {
            return;
        }
        let (done, total, words) = state();
        let share = (done as f64 / total.max(1) as f64).min(1.0);
        let left = left(share, begun.elapsed());
        if is_hidden {
            next = begun.elapsed() + BETWEEN_LINES;
            say::aside(&format!("{words}: {:.0} %{left}", 100.0 * share));
        } else {
            bar.set_length(total.max(1));
            bar.set_message(fitting(&format!("{words}{left}"), BEFORE));
            bar.set_position(done.min(total));
        }
    };
    // The bar is cleared, also if the work panics.
    let _clear = OnDrop(|| bar.finish_and_clear());
    look_while(Duration::from_millis(if is_hidden { 500 } else { 50 }), show, work)
}

/// How long work will take that has taken some time for a share of it; nothing before a hundredth is done.
fn left(share: f64, taken: Duration) -> String {
    if share < 0.01 {
        return String::new();
    }
    let seconds = (taken.as_secs_f64() * (1.0 - share) / share).ceil() as u64;
    match seconds {
        0..60 => format!(", {seconds} s left"),
        60..3600 => format!(", {} min left", seconds.div_ceil(60)),
        _ => format!(", {} h {} min left", seconds / 3600, seconds % 3600 / 60),
    }
}

/// Columns of what stands before the words of [`follow`].
const BEFORE: usize = 31;

/// As much of the words behind a bar as the terminal has room for now: a line that is wrapped cannot be
/// cleared once the terminal has another width.
///
/// * `before` – columns of what stands before them
pub(crate) fn fitting(words: &str, before: usize) -> String {
    let room =
        terminal_size_of(std::io::stderr()).map(|(width, _)| usize::from(width.0).saturating_sub(before));
    words.chars().take(room.unwrap_or(usize::MAX)).collect()
}

/// A bar of so many parts, which is hidden without a terminal or if `quiet`.
pub(crate) fn bar(total: u64, template: &str, quiet: bool) -> ProgressBar {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(Some(total), target);
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}
