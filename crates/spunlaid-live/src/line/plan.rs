//! What is to be simulated next.

/// The air in which two webs are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Air {
    /// That of the file.
    OfFile,
    /// One with another seed, which a change has not been chosen by.
    Other,
}

/// A piece of work. Webs are called by their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Task {
    /// Find the tension at the end of the spinline of a web.
    Settle(u32),
    /// Simulate a web coarsely, for others to be compared with.
    Pin(u32),
    /// Compare a web with the pinned one, or both again in another air.
    Compare { before: u32, now: u32, air: Air },
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
    /// Whether the change is to be confirmed in another air.
    pub(super) is_in_question: bool,
    /// Whether the effects of all knobs of the first one are known.
    pub(super) is_tried: bool,
}

/// The next task; None if all is known that can be.
///
/// The first numbers come first: a coarse web of comparison, then the change. The web of comparison is laid in full
/// before the present one, because all later numbers follow from it. What a person has asked for comes before that.
///
/// * `failed` – tasks that have ended without a result
pub(super) fn next(known: &Known, failed: &[Task]) -> Option<Task> {
    let Known { before, now, is_pinned, is_compared, is_in_question, is_tried } = *known;
    let is_turned = before.number != now.number;
    let can_fly = [before, now].map(|web| web.is_settled);
    let compare = |air| Task::Compare { before: before.number, now: now.number, air };
    let tasks = [
        (!before.is_settled, Task::Settle(before.number)),
        (is_turned && !now.is_settled, Task::Settle(now.number)),
        (can_fly[0] && !is_pinned, Task::Pin(before.number)),
        (is_turned && is_pinned && can_fly[1] && !is_compared, compare(Air::OfFile)),
        (is_turned && is_compared && is_in_question, compare(Air::Other)),
        (can_fly[0] && !before.is_laid, Task::Lay(before.number)),
        (is_turned && can_fly[1] && !now.is_laid, Task::Lay(now.number)),
        (is_pinned && !is_tried, Task::Try(before.number)),
    ];
    tasks.into_iter().find(|(is_wanted, task)| *is_wanted && !failed.contains(task)).map(|(_, task)| task)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn web(number: u32, is_laid: bool) -> WebState {
        WebState { number, is_settled: true, is_laid }
    }

    fn unknown(before: WebState, now: WebState) -> Known {
        let [is_pinned, is_compared, is_in_question, is_tried] = [false; 4];
        Known { before, now, is_pinned, is_compared, is_in_question, is_tried }
    }

    /// All tasks until nothing is left to do.
    fn tasks(mut known: Known) -> Vec<Task> {
        let mut all = Vec::new();
        while let Some(task) = next(&known, &[]) {
            all.push(task);
            match task {
                Task::Settle(number) => {
                    let web = if number == known.before.number { &mut known.before } else { &mut known.now };
                    web.is_settled = true;
                }
                Task::Pin(_) => known.is_pinned = true,
                Task::Compare { air: Air::OfFile, .. } => known.is_compared = true,
                Task::Compare { air: Air::Other, .. } => known.is_in_question = false,
                Task::Lay(number) if number == known.before.number => known.before.is_laid = true,
                Task::Lay(_) => known.now.is_laid = true,
                Task::Try(_) => known.is_tried = true,
            }
        }
        all
    }

    #[test]
    fn the_first_numbers_come_first_and_what_is_known_is_not_done_again() {
        let before = web(1, false);
        let known = unknown(before, before);
        assert_eq!(tasks(known), [Task::Pin(1), Task::Lay(1), Task::Try(1)]);
        let turned = Known { now: web(2, false), ..known };
        let [compare, confirm] =
            [Air::OfFile, Air::Other].map(|air| Task::Compare { before: 1, now: 2, air });
        assert_eq!(tasks(turned), [Task::Pin(1), compare, Task::Lay(1), Task::Lay(2), Task::Try(1)]);
        let back =
            Known { before: web(1, true), now: web(2, true), is_pinned: true, is_tried: true, ..turned };
        assert_eq!(tasks(Known { is_compared: true, ..back }), []);
        assert_eq!(tasks(back), [compare]);
        let asked = Known { is_in_question: true, ..turned };
        assert_eq!(tasks(asked)[..4], [Task::Pin(1), compare, confirm, Task::Lay(1)]);
        let unsettled = WebState { is_settled: false, ..web(2, false) };
        assert_eq!(tasks(Known { now: unsettled, ..back }), [Task::Settle(2), compare, Task::Lay(2)]);
    }

    #[test]
    fn what_has_failed_is_left_out_with_all_that_needs_it() {
        let before = web(1, false);
        let now = WebState { is_settled: false, ..web(2, false) };
        let known = unknown(before, now);
        assert_eq!(next(&known, &[Task::Settle(2), Task::Pin(1)]), Some(Task::Lay(1)));
        assert_eq!(next(&known, &[Task::Settle(2), Task::Pin(1), Task::Lay(1)]), None);
    }
}
