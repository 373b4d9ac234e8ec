//! Times that stand on a busy machine: processor time, the least of many short repetitions.

use cpu_time::ThreadTime;
use std::time::Duration;

/// One thing to be timed.
pub struct Trial<'a> {
    /// How much the work is worth: element steps of a fibre, seconds of a fibre.
    amount: f64,
    work: Box<dyn FnMut() -> Duration + 'a>,
    fastest: Duration,
}

impl<'a> Trial<'a> {
    /// A trial whose work says itself how long it took.
    pub fn new(amount: f64, work: impl FnMut() -> Duration + 'a) -> Self {
        Self { amount, work: Box::new(work), fastest: Duration::MAX }
    }

    /// Seconds of one amount, the least seen.
    pub fn each(&self) -> f64 {
        self.fastest.as_secs_f64() / self.amount
    }
}

/// Processor time this thread takes for some work.
pub fn processor_time(work: impl FnOnce()) -> Duration {
    let started = ThreadTime::now();
    work();
    started.elapsed()
}

/// Runs all trials in turn, round after round, until `seconds` are spent on each but the slow ones, which
/// run three times: what disturbs the machine for a while disturbs all alike, and ratios hold.
pub fn in_rounds(trials: &mut [Trial<'_>], seconds: f64) {
    let mut spent = vec![0.0; trials.len()];
    for round in 0.. {
        let mut any = false;
        for (trial, spent) in trials.iter_mut().zip(&mut spent) {
            if *spent < seconds || round < 3 {
                let time = (trial.work)();
                trial.fastest = trial.fastest.min(time);
                *spent += time.as_secs_f64();
                any = true;
            }
        }
        if !any {
            return;
        }
    }
}
