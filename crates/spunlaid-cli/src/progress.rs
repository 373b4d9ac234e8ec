//! Progress of a run, on the terminal only.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use spunlaid::threads::{OnDrop, look_while};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;
use terminal_size::terminal_size_of;

/// Runs `work` and shows a bar that follows `done` up to `total`. There is no bar without a terminal or if `quiet`.
pub(crate) fn follow<T>(
    done: &AtomicU64,
    total: u64,
    label: &str,
    quiet: bool,
    work: impl FnOnce() -> T,
) -> T {
    let bar = bar(total, "[{bar:20}] {percent:>3} %  {eta} left  {msg}", quiet);
    if bar.is_hidden() {
        return work();
    }
    let show = || {
        bar.set_message(fitting(label, BEFORE));
        bar.set_position(done.load(Ordering::Relaxed));
    };
    show_while(&bar, Duration::from_millis(50), show, work)
}

/// Columns of what stands before the words of [`follow`].
const BEFORE: usize = 44;

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
