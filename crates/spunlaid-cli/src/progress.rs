//! Progress of a run, on the terminal only.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use spunlaid::threads::{OnDrop, look_while};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Runs `work` and shows a bar that follows `done` up to `total`. There is no bar without a terminal or if `quiet`.
pub(crate) fn follow<T>(
    done: &AtomicU64,
    total: u64,
    label: &str,
    quiet: bool,
    work: impl FnOnce() -> T,
) -> T {
    let bar = bar(total, "[{bar:20}] {percent:>3} %  {eta} left  {wide_msg}", quiet);
    if bar.is_hidden() {
        return work();
    }
    bar.set_message(label.to_owned());
    show_while(&bar, Duration::from_millis(50), || bar.set_position(done.load(Ordering::Relaxed)), work)
}

/// A bar of so many parts, which is hidden without a terminal or if `quiet`. Its words come last and are cut where the terminal ends:
/// a line that is wrapped cannot be cleared once the terminal has another width.
pub(crate) fn bar(total: u64, template: &str, quiet: bool) -> ProgressBar {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(Some(total), target);
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.progress_chars("=> "));
    }
    bar
}

/// Runs `work` while another thread shows how far it is, again and again. Then the bar is cleared, also if the work panics.
pub(crate) fn show_while<T>(
    bar: &ProgressBar,
    interval: Duration,
    show: impl FnMut() + Send,
    work: impl FnOnce() -> T,
) -> T {
    let _clear = OnDrop(|| bar.finish_and_clear());
    look_while(interval, show, work)
}
