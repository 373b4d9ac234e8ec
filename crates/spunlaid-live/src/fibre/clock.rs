//! How much time of the fibres goes by with each tick of the clock.

use crate::message::Pace;
use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Time from one frame to the next.
pub(super) const TICK: Duration = Duration::from_nanos(1_000_000_000 / 60);
/// Share of a tick that may be computed, so that messages are heard at once.
const BUSY: f64 = 0.85;
/// What is owed longer than this is dropped: time that was lost is not caught up.
const LONGEST_DEBT: Duration = Duration::from_millis(50);
/// Time over which the speed is measured.
const MEASURED: Duration = Duration::from_secs(1);

/// The clock of a flight.
#[derive(Debug)]
pub(super) struct Clock {
    pub(super) pace: Pace,
    last: Instant,
    /// Time of the fibres that is still to be simulated [s].
    backlog: f64,
    /// Steps that are simulated at once: pieces of a tick, so that its end is kept.
    piece: u64,
    /// Ticks of the last second: when, and how much time of the fibres had gone by since the start of the program [s].
    past: VecDeque<(Instant, f64)>,
    simulated: f64,
}

impl Clock {
    pub(super) fn new(now: Instant) -> Self {
        Self { pace: Pace::Real, last: now, backlog: 0.0, piece: 1, past: VecDeque::new(), simulated: 0.0 }
    }

    /// Begins to count now: after a pause, at another pace, or with fibres that may take longer for a step.
    pub(super) fn begin(&mut self, now: Instant) {
        (self.last, self.backlog, self.piece) = (now, 0.0, 1);
        self.past.clear();
    }

    /// Flies for a tick. Never for longer than the tick lasts, and no more than the pace asks for.
    ///
    /// * `step` – shortest time that can be simulated [s]
    /// * `fly` – flies for a number of steps
    ///
    /// # Errors
    /// That of `fly`.
    pub(super) fn tick<E>(&mut self, step: f64, mut fly: impl FnMut(u64) -> Result<(), E>) -> Result<(), E> {
        let now = Instant::now();
        let until = now + TICK.mul_f64(BUSY);
        let gone = (now - self.last).min(LONGEST_DEBT).as_secs_f64();
        self.last = now;
        self.backlog = match self.pace.ratio() {
            Some(ratio) => (self.backlog + ratio * gone).min((ratio * LONGEST_DEBT.as_secs_f64()).max(step)),
            None => f64::INFINITY,
        };
        while self.backlog >= step && Instant::now() < until {
            let steps = if self.backlog.is_finite() {
                ((self.backlog / step) as u64).min(self.piece)
            } else {
                self.piece
            };
            let begun = Instant::now();
            fly(steps)?;
            self.backlog -= steps as f64 * step;
            self.simulated += steps as f64 * step;
            let took = begun.elapsed();
            if took > TICK.mul_f64(0.3) {
                self.piece = (self.piece / 2).max(1);
            } else if took < TICK.mul_f64(0.1) && steps == self.piece {
                self.piece *= 2;
            }
        }
        if !self.backlog.is_finite() {
            self.backlog = 0.0;
        }
        self.past.push_back((now, self.simulated));
        while self.past.front().is_some_and(|(then, _)| now - *then > MEASURED) {
            self.past.pop_front();
        }
        Ok(())
    }

    /// Time of the fibres over time of the clock, within the last second; zero if nothing is known.
    pub(super) fn speed(&self) -> f64 {
        match (self.past.front(), self.past.back()) {
            (Some((first, from)), Some((last, to))) if last > first => {
                (to - from) / (*last - *first).as_secs_f64()
            }
            _ => 0.0,
        }
    }

    /// Whether the fibres cannot keep the pace.
    pub(super) fn is_behind(&self) -> bool {
        let known = self.past.len() > 20;
        self.pace.ratio().is_some_and(|ratio| known && self.speed() < 0.9 * ratio)
    }

    /// Time until the next tick.
    pub(super) fn rest(&self) -> Duration {
        TICK.saturating_sub(self.last.elapsed())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn simulated(pace: Pace, ticks: u32, of_step: Duration) -> (f64, Duration, Clock) {
        let begun = Instant::now();
        let mut clock = Clock::new(begun);
        clock.pace = pace;
        let mut total = 0.0;
        for _ in 0..ticks {
            std::thread::sleep(clock.rest());
            let done: Result<(), ()> = clock.tick(1e-4, |steps| {
                total += steps as f64 * 1e-4;
                std::thread::sleep(of_step * steps as u32);
                Ok(())
            });
            assert!(done.is_ok());
        }
        (total, begun.elapsed(), clock)
    }

    #[test]
    fn the_pace_is_kept_and_never_exceeded() {
        for (pace, ratio) in [(Pace::Real, 1.0), (Pace::Tenth, 0.1), (Pace::Hundredth, 0.01)] {
            let (total, wall, _) = simulated(pace, 30, Duration::ZERO);
            assert!(total <= ratio * wall.as_secs_f64() + 1e-9, "{total}");
            // A busy machine may stop this thread for longer than a debt may last.
            assert!(total > 0.0, "{total}");
        }
    }

    #[test]
    fn fibres_that_are_too_slow_say_so_and_nothing_piles_up() {
        // A step of 0.1 ms takes 1 ms of the clock.
        let (total, _, mut clock) = simulated(Pace::Real, 40, Duration::from_millis(1));
        assert!(clock.is_behind(), "{}", clock.speed());
        assert!(total < 0.2, "{total}");
        // What is owed is dropped, so that a pause does not make the fibres run.
        std::thread::sleep(Duration::from_millis(200));
        let mut steps = 0;
        let done: Result<(), ()> = clock.tick(1e-4, |n| {
            steps += n;
            Ok(())
        });
        assert!(done.is_ok() && steps <= 500, "{steps}");
    }

    #[test]
    fn as_fast_as_it_goes_ends_with_the_tick() {
        let (total, _, clock) = simulated(Pace::Free, 5, Duration::from_micros(100));
        assert!(total > 0.0 && !clock.is_behind());
    }
}
