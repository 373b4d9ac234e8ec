//! Progress of a run, on the terminal only.

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Duration;

/// Runs `work` and shows a bar that follows `done` up to `total`. There is no bar without a terminal or if `quiet`.
pub(crate) fn follow<T>(
    done: &AtomicU64,
    total: u64,
    label: &str,
    quiet: bool,
    work: impl FnOnce() -> T,
) -> T {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let bar = ProgressBar::with_draw_target(Some(total), target);
    if bar.is_hidden() {
        return work();
    }
    let style =
        ProgressStyle::with_template("{msg} [{bar:32}] {percent:>3} %  {elapsed} elapsed, {eta} left");
    if let Ok(style) = style {
        bar.set_style(style.progress_chars("=> "));
    }
    bar.set_message(label.to_owned());
    show_while(&bar, Duration::from_millis(50), || bar.set_position(done.load(Ordering::Relaxed)), work)
}

/// Runs `work` while another thread shows how far it is, again and again. That thread ends also if the work panics; the
/// program would wait for it for ever otherwise.
pub(crate) fn show_while<T>(
    bar: &ProgressBar,
    interval: Duration,
    mut show: impl FnMut() + Send,
    work: impl FnOnce() -> T,
) -> T {
    let finished = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let display = scope.spawn(|| {
            while !finished.load(Ordering::Acquire) {
                std::thread::park_timeout(interval);
                show();
            }
        });
        let outcome = catch_unwind(AssertUnwindSafe(work));
        finished.store(true, Ordering::Release);
        display.thread().unpark();
        bar.finish_and_clear();
        outcome.unwrap_or_else(|panic| resume_unwind(panic))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_in_the_work_ends_the_bar() {
        let bar = ProgressBar::with_draw_target(Some(1), ProgressDrawTarget::hidden());
        let shown = |work: fn() -> i32| show_while(&bar, Duration::from_millis(50), || {}, work);
        assert!(catch_unwind(AssertUnwindSafe(|| shown(|| panic!("as a test of it")))).is_err());
        assert_eq!(shown(|| 7), 7);
    }
}
