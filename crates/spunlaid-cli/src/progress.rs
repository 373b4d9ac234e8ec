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
    follow_on(&bar, done, work)
}

/// Runs `work` while another thread sets the bar to `done`.
fn follow_on<T>(bar: &ProgressBar, done: &AtomicU64, work: impl FnOnce() -> T) -> T {
    let finished = AtomicBool::new(false);
    std::thread::scope(|scope| {
        let shown = scope.spawn(|| {
            while !finished.load(Ordering::Acquire) {
                bar.set_position(done.load(Ordering::Relaxed));
                std::thread::park_timeout(Duration::from_millis(50));
            }
        });
        ended(work, || {
            finished.store(true, Ordering::Release);
            shown.thread().unpark();
            bar.finish_and_clear();
        })
    })
}

/// Does `work` and ends the thread that shows a bar, also if the work panics. Otherwise the program would wait for the
/// thread for ever.
pub(crate) fn ended<T>(work: impl FnOnce() -> T, end: impl FnOnce()) -> T {
    let done = catch_unwind(AssertUnwindSafe(work));
    end();
    done.unwrap_or_else(|panic| resume_unwind(panic))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_in_the_work_ends_the_bar() {
        let done = AtomicU64::new(0);
        let bar = || ProgressBar::with_draw_target(Some(1), ProgressDrawTarget::hidden());
        let panicked =
            catch_unwind(AssertUnwindSafe(|| follow_on(&bar(), &done, || panic!("as a test of it"))));
        assert!(panicked.is_err());
        assert_eq!(follow_on(&bar(), &done, || 7), 7);
    }
}
