//! A shot: the thread under one tension at the die, followed to the end of the line.

use super::integration::{Step, Stepper};
use super::thread::{LN_SPEED, Phase, State, TENSION, Thread};
use super::{FreezingCause, Station};

/// A thread that is faster runs away [m/s].
const FASTEST: f64 = 2000.0;
/// Most steps of a shot; it takes some sixty.
const MOST_STEPS: usize = 5_000;

/// How a shot ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Outcome {
    /// The thread reaches the end of the line.
    Complete,
    /// The melt is no longer pulled.
    Slack,
    /// The thread gets faster without bound.
    RunsAway,
    /// The thread gets as fast as its own elastic wave.
    ElasticWave,
}

/// A thread under one tension at the die.
pub(super) struct Shot {
    pub(super) outcome: Outcome,
    /// The state at the end.
    pub(super) end: State,
    /// The point at which it becomes solid: what makes it solid, and the thread there.
    pub(super) freezing: Option<(FreezingCause, Station, f64)>,
    /// Its steps.
    pub(super) steps: Vec<Step>,
}

/// Follows the thread from a state at the die to the end of the line.
pub(super) fn shoot(thread: &Thread<'_>, die: State) -> Shot {
    let mut shot = Shot { outcome: Outcome::Complete, end: die, freezing: None, steps: Vec::new() };
    let mut stepper = Stepper::new(thread, die[TENSION]);
    let length = thread.line.length;
    // The air may have a kink in each of its rows.
    let rows = thread.air.rows().iter().copied().filter(|row| (1e-9 * length..length).contains(row));
    let ends = rows.chain([length]).map(libm::sqrt);
    let (mut s, mut state) = (0.0, die);
    let mut wanted = 0.02 * libm::sqrt(length);
    for end in ends {
        while s < end {
            if shot.steps.len() >= MOST_STEPS || wanted < 1e-13 * end {
                shot.outcome = Outcome::RunsAway;
                return shot;
            }
            // A remnant that is much shorter than a step would cost as much as one.
            let left = end - s;
            let length =
                if wanted >= left { left } else { wanted.min(0.5 * left).max(wanted.min(left) * 0.6) };
            let mut step = stepper.step(s, length, &state);
            wanted = step.next_length();
            if step.error > 1.0 || step.error.is_nan() {
                if stepper.is_elastic_wave && wanted < 1e-9 * end {
                    shot.outcome = Outcome::ElasticWave;
                    return shot;
                }
                continue;
            }
            let is_melt = stepper.phase == Phase::Melt;
            if is_melt && thread.until_solid(&step.to) <= 0.0 {
                step = freeze(thread, &mut stepper, &step);
            }
            let reaches = step.length == left;
            s = if reaches { end } else { step.end() };
            state = step.to;
            shot.steps.push(step);
            let rates = stepper.rates(s, &state);
            if is_melt && thread.until_solid(&state) <= 0.0 {
                let by = if thread.is_cold(&state) {
                    FreezingCause::Temperature
                } else {
                    FreezingCause::Crystallisation
                };
                let cooling_rate = -rates.slopes[super::thread::TEMPERATURE] * rates.station.speed;
                shot.freezing = Some((by, rates.station, cooling_rate));
                let orientation = thread.orientation(rates.station.stress);
                stepper.phase = Phase::Solid { orientation };
            } else if is_melt && rates.station.stress <= 0.0 {
                shot.outcome = Outcome::Slack;
                return shot;
            } else if is_melt && rates.is_elastic_wave {
                shot.outcome = Outcome::ElasticWave;
                return shot;
            }
            // What the conformation gives in the melt goes on as the balance of forces tells.
            state[TENSION] = rates.station.tension;
            if libm::exp(state[LN_SPEED]) > FASTEST {
                shot.outcome = Outcome::RunsAway;
                return shot;
            }
        }
    }
    shot.end = state;
    shot
}

/// The part of a step in which the melt becomes solid: it ends where the thread is solid, by regula falsi (Illinois).
fn freeze(thread: &Thread<'_>, stepper: &mut Stepper<'_, '_>, step: &Step) -> Step {
    let (mut melt, mut solid) = (0.0, step.length);
    let (mut above, mut below) = (thread.until_solid(&step.from), thread.until_solid(&step.to));
    let mut last = *step;
    for _ in 0..60 {
        if below == 0.0 || solid - melt <= 1e-15 * step.end() || above <= 0.0 {
            break;
        }
        let share = above / (above - below);
        let length = melt + share.clamp(0.001, 0.999) * (solid - melt);
        let part = stepper.step(step.start, length, &step.from);
        let left = thread.until_solid(&part.to);
        if left > 0.0 {
            (melt, above, below) = (length, left, 0.5 * below);
        } else {
            (solid, below, last, above) = (length, left, part, 0.5 * above);
        }
        if left.abs() < 1e-14 && left <= 0.0 {
            break;
        }
    }
    last
}
