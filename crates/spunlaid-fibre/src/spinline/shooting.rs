//! Finds the tension at the die with which the filament meets what is known at the end of the line.

use super::End;
use super::boundary::{Arrival, Branch, Effort, Run, Varies, largest_tension};
use super::filament::{Filament, LN_SPEED, Phase, TEMPERATURE, TENSION};
use super::integration::Step;
use super::shot::{FASTEST, Outcome, Shot, shoot};

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
/// By how much the end may be missed, as a share of the speed or of the largest tension.
pub(super) const MISSED: f64 = 1e-6;
/// The draw ratio with which a continuation begins.
const EASY_DRAW_RATIO: f64 = 20.0;
/// How far `ln F_0` of a followed state may move at most, and how far it moves first.
const REACH: f64 = 0.5;
const FIRST_MOVE: f64 = 2e-3;

/// Why no tension meets the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Miss {
    /// The filament is faster, or more tense, at the end than it should be, under the smallest tension too.
    TooMuch,
    /// It is slack under every tension.
    Slack,
    /// Between a slack filament and one that is too fast, none reaches the end.
    NoThread,
    /// Followed from a slow line on, the filaments turn back here: at this speed [m/s] or tension [N] at the end.
    TurnsBack(f64),
    /// Followed from a slow line on, the filaments end where the melt cools no further before it is solid.
    StaysLiquid,
    /// The melt is pushed, first at this distance from the die [m].
    Pushed(f64),
    /// None was found, and whether there is one is not known.
    NotFound,
    /// The filament is still liquid at the end, at this temperature [K].
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

/// Shooting that has found no filament.
struct Missed {
    why: Miss,
    /// The closest one that reaches the end.
    near: Option<Box<Run>>,
}

struct Shooting<'t, 'a> {
    filament: &'t Filament<'a>,
}

impl Shooting<'_, '_> {
    fn shot(&self, x: f64) -> Option<Shot> {
        Some(shoot(self.filament, self.filament.at_die(libm::exp(x))?))
    }

    /// By how much the filament misses the end under the tension `exp(x)`: negative if it should be pulled more.
    fn miss(&self, x: f64) -> (f64, Option<Miss>) {
        let Some(shot) = self.shot(x) else { return (f64::NEG_INFINITY, Some(Miss::Slack)) };
        let reason = match shot.outcome {
            Outcome::Complete => shot.solidification.is_none().then(|| Miss::Liquid(shot.end[TEMPERATURE])),
            Outcome::Slack => Some(Miss::Slack),
            Outcome::RunsAway => Some(Miss::NoThread),
            Outcome::ElasticWave => Some(Miss::ElasticWave),
        };
        let miss = match (shot.outcome, self.filament.end) {
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
    /// If there is none: why the filament misses the end under the largest tension.
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
    /// one of a search it has a filament that should be pulled more below it. None if the state is lost.
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

    /// The shot between two tensions; with what it misses if it is not the one.
    fn hit(&self, bracket: [(f64, f64); 2], close: f64) -> Result<Run, Missed> {
        let at_die = brent(|x| self.miss(x).0, self.narrow(bracket)?, close);
        let run = self.run(at_die).ok_or(Missed { why: Miss::NoThread, near: None })?;
        if meets(self.filament, &run.shot) {
            Ok(run)
        } else {
            Err(Missed { why: Miss::NotFound, near: Some(Box::new(run)) })
        }
    }

    /// The filament under a tension, if it reaches the end.
    fn run(&self, at_die: f64) -> Option<Run> {
        let shot = self.shot(at_die).filter(|shot| shot.outcome == Outcome::Complete)?;
        Some(Run { at_die, shot })
    }

    /// Halves the interval until the filament reaches the end from both of its ends.
    ///
    /// # Errors
    /// If it does not, with the filament closest to it that reaches the end.
    fn narrow(&self, [mut low, mut high]: [(f64, f64); 2]) -> Result<[(f64, f64); 2], Missed> {
        let (mut of_slack, mut of_fast) = (None, None);
        while !(low.1.is_finite() && high.1.is_finite()) {
            let x = 0.5 * (low.0 + high.0);
            if high.0 - low.0 < 1e-13 * x.abs().max(1.0) {
                // A filament that gets to the end reports more than one that does not.
                let near = self.run(low.0).or_else(|| self.run(high.0)).map(Box::new);
                let why = match (of_slack, of_fast) {
                    (Some(liquid @ Miss::Liquid(_)), _) | (_, Some(liquid @ Miss::Liquid(_))) => liquid,
                    (_, Some(Miss::ElasticWave)) => Miss::ElasticWave,
                    _ => Miss::NoThread,
                };
                return Err(Missed { why, near });
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
pub(super) fn find(filament: &Filament<'_>, looks_on: bool) -> Result<Hit, Miss> {
    let shooting = Shooting { filament };
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
    let found = shooting.hit(bracket, CLOSE);
    let Run { at_die, shot } = found.or_else(|missed| continued(filament, missed))?;
    let has_second =
        looks_on && shooting.bracket(at_die + 1e-3, libm::log(MOST_OF_SECOND), SHORT_STRIDE).is_ok();
    Ok(Hit { tension: libm::exp(at_die), shot, has_second })
}

/// The filament that no single tension leads to: by continuation from one that is known.
fn continued(filament: &Filament<'_>, missed: Missed) -> Result<Run, Miss> {
    let effort = Effort::default();
    let by_end = |run: Run| Branch::new(filament, Varies::End, &run, &effort).walk(run);
    let is_beyond = match filament.end {
        End::TakeUp(speed) => speed > FASTEST,
        End::Tension(tension) | End::Flown(tension) => !(0.0..=TENSIONS[1]).contains(&tension),
    };
    if is_beyond {
        return Err(missed.why);
    }
    let mut found = missed.near.map_or(Arrival::Lost, |near| by_end(*near));
    if matches!(found, Arrival::Lost) {
        let shares = [1.0, 0.1, 1e-2, 1e-3, 1e-4];
        let is_free = filament.end == End::Tension(0.0);
        let free = eased(filament, End::Tension(0.0), &shares[usize::from(is_free)..], &effort);
        let is_slow = |run: &Run| {
            let end = run.shot.end[LN_SPEED];
            matches!(filament.end, End::TakeUp(speed) if libm::log(speed) < end)
        };
        if free.as_ref().is_some_and(is_slow) {
            return Err(Miss::TooMuch);
        }
        let slow = End::TakeUp(EASY_DRAW_RATIO * filament.die_speed());
        found = free.or_else(|| eased(filament, slow, &[0.0], &effort)).map_or(Arrival::Lost, by_end);
    }
    match found {
        // At a free end a melt is not pulled, and that it is liquid there is the reason.
        Arrival::Met(run) if meets(filament, &run.shot) => match pushed(filament, &run.shot) {
            _ if run.shot.solidification.is_none() => Err(Miss::Liquid(run.shot.end[TEMPERATURE])),
            Some(distance) => Err(Miss::Pushed(distance)),
            None => Ok(*run),
        },
        Arrival::TurnsBack(value) => Err(Miss::TurnsBack(value)),
        Arrival::RunsAway => Err(missed.why),
        Arrival::StaysLiquid => Err(Miss::StaysLiquid),
        Arrival::Lost | Arrival::Met(_) => {
            Err(if missed.why == Miss::NoThread { Miss::NotFound } else { missed.why })
        }
    }
}

/// A filament of this line with another end, found with little of inertia, weight, friction and surface tension first.
///
/// * `shares` – of these forces, the first with which shooting finds a filament
fn eased(filament: &Filament<'_>, end: End, shares: &[f64], effort: &Effort) -> Option<Run> {
    let [least, most] = TENSIONS.map(libm::log);
    let of = |forces: &f64| Filament { end, forces: *forces, ..filament.clone() };
    let run = |eased: Filament<'_>| {
        let shooting = Shooting { filament: &eased };
        let found = shooting.hit(shooting.bracket(least, most, STRIDE).ok()?, CLOSE);
        let run = found.map_or_else(|missed| along(&eased, Varies::End, *missed.near?, effort), Some)?;
        Some((eased.forces, run))
    };
    let (forces, run) = shares.iter().take_while(|_| !effort.is_too_much()).map(of).find_map(run)?;
    if forces == 1.0 { Some(run) } else { along(&of(&forces), Varies::Forces, run, effort) }
}

/// The filament that a continuation leads to.
fn along(filament: &Filament<'_>, varies: Varies, run: Run, effort: &Effort) -> Option<Run> {
    match Branch::new(filament, varies, &run, effort).walk(run) {
        Arrival::Met(run) => Some(*run),
        _ => None,
    }
}

/// Where the melt of a shot is pushed first [m].
fn pushed(filament: &Filament<'_>, shot: &Shot) -> Option<f64> {
    let mut melt = shot.steps.iter().filter(|step| step.phase == Phase::Melt);
    let distance = |step: &Step| step.end() * step.end();
    let is_pushed =
        |step: &&Step| filament.rates(distance(step), &step.to, Phase::Melt, &mut 0).station.stress <= 0.0;
    melt.find(is_pushed).map(distance)
}

/// Whether a shot meets what is known at the end.
fn meets(filament: &Filament<'_>, shot: &Shot) -> bool {
    match filament.end {
        End::TakeUp(speed) => (shot.end[LN_SPEED] - libm::log(speed)).abs() < MISSED,
        End::Tension(tension) | End::Flown(tension) => {
            (shot.end[TENSION] - tension).abs() < MISSED * largest_tension(shot)
        }
    }
}

/// Follows the state of a line that differs a little: the tension at the die that meets the end, close to the
/// one that did. None if the state is lost, and has to be sought.
///
/// * `tension` – at the die of the other line [N]
/// * `has_second` – whether that line has a second state
pub(super) fn follow(filament: &Filament<'_>, tension: f64, has_second: bool) -> Option<Hit> {
    let shooting = Shooting { filament };
    let run = shooting.hit(shooting.bracket_near(libm::log(tension))?, CLOSE_ENOUGH).ok()?;
    Some(Hit { tension: libm::exp(run.at_die), shot: run.shot, has_second })
}

/// The root between two places with misses of different signs. R. P. Brent: Algorithms for Minimization
/// without Derivatives, 1973.
pub(super) fn brent(
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
