//! Finds the tension at the die with which the thread meets what is known at the end of the line.

use super::integration::{Step, Stepper};
use super::thread::{LN_SPEED, Phase, State, TEMPERATURE, TENSION, Thread};
use super::{End, FreezingCause, Station};

/// The tensions between which the one at the die is sought [N].
const TENSIONS: [f64; 2] = [1e-8, 1e2];
/// From one tension to the next, `ln F_0` rises by this. With crystallisation there may be several steady
/// states close together.
const STRIDE: f64 = 0.4;
const SHORT_STRIDE: f64 = 0.05;
/// Up to this tension a second steady state is sought [N].
const MOST_OF_SECOND: f64 = 1.0;
/// How closely `ln F_0` is found, and how closely that of a state that is followed, whose steps have errors of 1e-8.
const CLOSE: f64 = 1e-12;
const CLOSE_ENOUGH: f64 = 1e-10;
/// How far `ln F_0` of a followed state may move at most, and how far it moves first.
const REACH: f64 = 0.5;
const FIRST_MOVE: f64 = 2e-3;

/// Why no tension meets the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Miss {
    /// The thread is faster, or more tense, at the end than it should be, under the smallest tension too.
    TooMuch,
    /// It is slack under every tension.
    Slack,
    /// Between a slack thread and one that is too fast, none reaches the end.
    NoThread,
    /// The thread is still liquid at the end, at this temperature [K].
    Liquid(f64),
    /// The melt is too elastic.
    ElasticWave,
}

/// The shot that meets the end.
pub(super) struct Hit {
    pub(super) tension: f64,
    pub(super) shot: Shot,
    /// Whether a larger tension meets it too.
    pub(super) has_second: bool,
}

struct Shooting<'t, 'a> {
    thread: &'t Thread<'a>,
}

impl Shooting<'_, '_> {
    fn shot(&self, x: f64) -> Option<Shot> {
        Some(shoot(self.thread, self.thread.at_die(libm::exp(x))?))
    }

    /// By how much the thread misses the end under the tension `exp(x)`: negative if it should be pulled more.
    fn miss(&self, x: f64) -> (f64, Option<Miss>) {
        let Some(shot) = self.shot(x) else { return (f64::NEG_INFINITY, Some(Miss::Slack)) };
        let reason = match shot.outcome {
            Outcome::Complete => shot.freezing.is_none().then(|| Miss::Liquid(shot.end[TEMPERATURE])),
            Outcome::Slack => Some(Miss::Slack),
            Outcome::RunsAway => Some(Miss::NoThread),
            Outcome::ElasticWave => Some(Miss::ElasticWave),
        };
        let miss = match (shot.outcome, self.thread.line.end) {
            (Outcome::Slack, _) => f64::NEG_INFINITY,
            (Outcome::RunsAway | Outcome::ElasticWave, _) => f64::INFINITY,
            (Outcome::Complete, End::Tension(tension) | End::Flown(tension)) => shot.end[TENSION] - tension,
            (Outcome::Complete, End::TakeUp(speed)) => shot.end[LN_SPEED] - libm::log(speed),
        };
        (miss, reason)
    }

    /// The first place above `from` at which the miss changes its sign, as two places and their misses.
    ///
    /// # Errors
    /// If there is none: why the thread misses the end under the largest tension.
    fn bracket(&self, from: f64, to: f64, stride: f64) -> Result<[(f64, f64); 2], Option<Miss>> {
        let mut before = (from, self.miss(from).0);
        let mut last = None;
        while before.0 < to {
            let x = before.0 + stride;
            let (miss, reason) = self.miss(x);
            if (before.1 < 0.0) != (miss < 0.0) {
                return Ok([before, (x, miss)]);
            }
            (before, last) = ((x, miss), reason);
        }
        Err(last)
    }

    /// The change of sign next to a place: a state that is a little more or less pulled than before. Like the
    /// one of a search it has a thread that should be pulled more below it. None if the state is lost.
    fn bracket_near(&self, from: f64) -> Option<[(f64, f64); 2]> {
        let mut before = (from, self.miss(from).0);
        let up = before.1 < 0.0;
        let mut length = FIRST_MOVE;
        while (before.0 - from).abs() < REACH {
            let x = if up { before.0 + length } else { before.0 - length };
            let here = (x, self.miss(x).0);
            if up != (here.1 < 0.0) {
                return Some(if up { [before, here] } else { [here, before] });
            }
            // A little beyond where a straight line through both of them changes its sign.
            let straight = 1.1 * (here.1 / (here.1 - before.1) * length).abs();
            let next = if straight.is_finite() { straight } else { 2.0 * length };
            (before, length) = (here, next.clamp(FIRST_MOVE, SHORT_STRIDE));
        }
        None
    }

    /// The shot between two tensions.
    fn hit(&self, bracket: [(f64, f64); 2], close: f64) -> Result<(f64, Shot), Miss> {
        let x = brent(|x| self.miss(x).0, self.narrow(bracket)?, close);
        let shot = self.shot(x).filter(|shot| shot.outcome == Outcome::Complete).ok_or(Miss::NoThread)?;
        Ok((x, shot))
    }

    /// Halves the interval until the thread reaches the end from both of its ends.
    fn narrow(&self, [mut low, mut high]: [(f64, f64); 2]) -> Result<[(f64, f64); 2], Miss> {
        let (mut of_slack, mut of_fast) = (None, None);
        while !(low.1.is_finite() && high.1.is_finite()) {
            let x = 0.5 * (low.0 + high.0);
            if high.0 - low.0 < 1e-13 * x.abs().max(1.0) {
                // A thread that gets to the end tells more than one that does not.
                return Err(match (of_slack, of_fast) {
                    (Some(liquid @ Miss::Liquid(_)), _) | (_, Some(liquid @ Miss::Liquid(_))) => liquid,
                    (_, Some(Miss::ElasticWave)) => Miss::ElasticWave,
                    _ => Miss::NoThread,
                });
            }
            let (miss, reason) = self.miss(x);
            if miss < 0.0 {
                (low, of_slack) = ((x, miss), reason);
            } else {
                (high, of_fast) = ((x, miss), reason);
            }
        }
        Ok([low, high])
    }
}

/// Finds the smallest tension at the die that meets the end.
///
/// * `looks_on` – whether to look for a second one
pub(super) fn find(thread: &Thread<'_>, looks_on: bool) -> Result<Hit, Miss> {
    let shooting = Shooting { thread };
    let [least, most] = TENSIONS.map(libm::log);
    let (miss, reason) = shooting.miss(least);
    if miss >= 0.0 {
        return Err(reason.filter(|reason| *reason == Miss::ElasticWave).unwrap_or(Miss::TooMuch));
    }
    let bracket = shooting.bracket(least, most, STRIDE);
    let mut bracket = bracket.map_err(|last| if last.is_none() { Miss::ElasticWave } else { Miss::Slack })?;
    if looks_on {
        bracket = shooting.bracket(least, bracket[1].0, SHORT_STRIDE).unwrap_or(bracket);
    }
    let (x, shot) = shooting.hit(bracket, CLOSE)?;
    let has_second = looks_on && shooting.bracket(x + 1e-3, libm::log(MOST_OF_SECOND), SHORT_STRIDE).is_ok();
    Ok(Hit { tension: libm::exp(x), shot, has_second })
}

/// Follows the state of a line that differs a little: the tension at the die that meets the end, close to the
/// one that did. None if the state is lost, and has to be sought.
///
/// * `known` – the tension at the die of the other line [N], and whether that has a second state
pub(super) fn follow(thread: &Thread<'_>, (tension, has_second): (f64, bool)) -> Option<Hit> {
    let shooting = Shooting { thread };
    let (x, shot) = shooting.hit(shooting.bracket_near(libm::log(tension))?, CLOSE_ENOUGH).ok()?;
    Some(Hit { tension: libm::exp(x), shot, has_second })
}

/// The root between two places with misses of different signs. R. P. Brent: Algorithms for Minimization
/// without Derivatives, 1973.
fn brent(
    mut miss: impl FnMut(f64) -> f64,
    [(mut a, mut at_a), (mut b, mut at_b)]: [(f64, f64); 2],
    close: f64,
) -> f64 {
    let (mut c, mut at_c) = (a, at_a);
    let (mut step, mut step_before) = (b - a, b - a);
    for _ in 0..100 {
        if (at_b > 0.0) == (at_c > 0.0) {
            (c, at_c) = (a, at_a);
            (step, step_before) = (b - a, b - a);
        }
        if at_c.abs() < at_b.abs() {
            (a, b, c) = (b, c, b);
            (at_a, at_b, at_c) = (at_b, at_c, at_b);
        }
        let half = 0.5 * (c - b);
        if half.abs() <= 0.5 * close || at_b == 0.0 {
            break;
        }
        if step_before.abs() >= close && at_a.abs() > at_b.abs() {
            // By a parabola through three places, or by a straight line through two.
            let s = at_b / at_a;
            let (mut p, mut q) = if a == c {
                (2.0 * half * s, 1.0 - s)
            } else {
                let (q, r) = (at_a / at_c, at_b / at_c);
                (s * (2.0 * half * q * (q - r) - (b - a) * (r - 1.0)), (q - 1.0) * (r - 1.0) * (s - 1.0))
            };
            if p > 0.0 {
                q = -q;
            }
            p = p.abs();
            if 2.0 * p < (3.0 * half * q - (close * q).abs()).min((step_before * q).abs()) {
                (step_before, step) = (step, p / q);
            } else {
                (step, step_before) = (half, half);
            }
        } else {
            (step, step_before) = (half, half);
        }
        (a, at_a) = (b, at_b);
        b += if step.abs() > 0.5 * close { step } else { (0.5 * close).copysign(half) };
        at_b = miss(b);
        if !at_b.is_finite() {
            at_b = at_b.signum() * f64::MAX;
        }
    }
    b
}

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
