//! What is to be simulated next.

/// A piece of work. Webs are called by their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Task {
    /// Find the tension at the end of the spinline of a web.
    Settle(u32),
    /// Simulate a web coarsely, for others to be compared with.
    Pin(u32),
    /// Compare a web with the pinned one.
    Compare { before: u32, now: u32 },
    /// Lay a web in full.
    Lay(u32),
    /// Try what the knobs of a web do.
    Try(u32),
}

/// What is known of a web.
#[derive(Clone, Copy, Debug)]
pub(super) struct WebState {
    pub(super) number: u32,
    /// Whether no tension has to be found for it.
    pub(super) is_settled: bool,
    /// Whether it has been laid in full.
    pub(super) is_laid: bool,
}

/// What is known of the web of comparison and of the present one.
#[derive(Clone, Copy, Debug)]
pub(super) struct Known {
    pub(super) before: WebState,
    pub(super) now: WebState,
    /// Whether the first one is pinned.
    pub(super) is_pinned: bool,
    /// Whether the second one has been compared with it.
    pub(super) is_compared: bool,
    /// Whether the effects of all knobs of the first one are known.
    pub(super) is_tried: bool,
}

/// The next task; None if all is known that can be.
///
/// The first numbers come first: a coarse web of comparison, then the change. The web of comparison is laid in full
/// before the present one, because all later numbers follow from it.
///
/// * `failed` – tasks that have ended without a result
pub(super) fn next(known: &Known, failed: &[Task]) -> Option<Task> {
    let Known { before, now, is_pinned, is_compared, is_tried } = *known;
    let is_turned = before.number != now.number;
    let can_fly = [before, now].map(|web| web.is_settled);
    let tasks = [
        (!before.is_settled, Task::Settle(before.number)),
        (is_turned && !now.is_settled, Task::Settle(now.number)),
        (can_fly[0] && !is_pinned, Task::Pin(before.number)),
        (
            is_turned && is_pinned && can_fly[1] && !is_compared,
            Task::Compare { before: before.number, now: now.number },
        ),
        (can_fly[0] && !before.is_laid, Task::Lay(before.number)),
        (is_turned && can_fly[1] && !now.is_laid, Task::Lay(now.number)),
        (is_pinned && !is_tried, Task::Try(before.number)),
    ];
    tasks.into_iter().find(|(is_wanted, task)| *is_wanted && !failed.contains(task)).map(|(_, task)| task)
}
