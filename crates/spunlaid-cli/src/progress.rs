//! Progress of a run: a bar on a terminal, a line now and then elsewhere.

use crate::say;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use spunlaid::threads::{OnDrop, look_while};
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
    if quiet {
        return work();
    }
    let (bar, begun) = (bar(total, "[{bar:20}] {percent:>3} %  {msg}", quiet), Instant::now());
    let share = || (done.load(Ordering::Relaxed) as f64 / total.max(1) as f64).min(1.0);
    if bar.is_hidden() {
        let mut next = BETWEEN_LINES;
        let show = || {
            if begun.elapsed() >= next {
                next = begun.elapsed() + BETWEEN_LINES;
                say::aside(&format!("{label}: {:.0} %{}", 100.0 * share(), left(share(), begun.elapsed())));
            }
        };
        return look_while(Duration::from_millis(500), show, work);
    }
    let show = || {
        bar.set_message(fitting(&format!("{label}{}", left(share(), begun.elapsed())), BEFORE));
        bar.set_position(done.load(Ordering::Relaxed));
    };
    show_while(&bar, Duration::from_millis(50), show, work)
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

/// Runs `work` while another thread shows how far it is, again and again. Then the bar is cleared, also if
/// the work panics.
pub(crate) fn show_while<T>(
    bar: &ProgressBar,
    interval: Duration,
    show: impl FnMut() + Send,
    work: impl FnOnce() -> T,
) -> T {
    let _clear = OnDrop(|| bar.finish_and_clear());
    look_while(interval, show, work)
}
