//! A filament under one tension at the die, followed to the end of the line.

use super::filament::{Filament, LN_SPEED, Phase, State, TEMPERATURE, TENSION};
use super::integration::{Step, Stepper};
use super::{SolidificationCause, Station};

/// A filament that is faster runs away [m/s].
pub(super) const FASTEST: f64 = 2000.0;
/// Most steps of a shot; it takes some sixty.
const MOST_STEPS: usize = 5_000;
/// Relaxation times in a step from which on it is too long for a method that is not meant for stiff equations.
const STIFF: f64 = 2.0;
/// The step next to a sharp cusp of the heat transfer, as a share of the root of the line's length.
const AT_CUSP: f64 = 1e-7;
/// The first step, as a share of the line.
pub(super) const FIRST_STEP: f64 = 0.02;

/// How a shot ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Outcome {
    /// The filament reaches the end of the line.
    Complete,
    /// The melt is no longer pulled.
    Slack,
    /// The filament gets faster without bound.
    RunsAway,
    /// The filament gets as fast as its own elastic wave.
    ElasticWave,
}

/// A filament under one tension at the die.
#[derive(Clone)]
pub(super) struct Shot {
    pub(super) outcome: Outcome,
    /// The state at the end.
    pub(super) end: State,
    /// The point at which it becomes solid: what makes it solid, and the filament there.
    pub(super) solidification: Option<(SolidificationCause, Station, f64)>,
    /// Its steps.
    pub(super) steps: Vec<Step>,
}

/// Follows the filament from a state at the die to the end of the line.
pub(super) fn shoot(filament: &Filament<'_>, die: State) -> Shot {
    let length = libm::sqrt(filament.line.length);
    Leg::new(filament, 0.0, die, FIRST_STEP * length, die[TENSION]).follow(length)
}

/// A part of a filament: where it is, and what is behind.
pub(super) struct Leg<'t, 'a> {
    stepper: Stepper<'t, 'a>,
    shot: Shot,
    s: f64,
    state: State,
    /// Length of the next step [√m].
    wanted: f64,
}

impl<'t, 'a> Leg<'t, 'a> {
    /// A part that begins in the melt.
    ///
    /// * `start` – the root of its distance from the die [√m], and the state there
    /// * `wanted` – length of the first step [√m]
    /// * `tension` – size of the tensions that occur [N]
    pub(super) fn new(filament: &'t Filament<'a>, s: f64, state: State, wanted: f64, tension: f64) -> Self {
        let shot = Shot { outcome: Outcome::Complete, end: state, solidification: None, steps: Vec::new() };
        Self { stepper: Stepper::new(filament, tension), shot, s, state, wanted }
    }

    /// Follows the filament to the root of a distance from the die [√m].
    pub(super) fn follow(mut self, end: f64) -> Shot {
        let filament = self.stepper.filament;
        let length = filament.line.length;
        // The air may have a kink in each of its rows.
        let rows = filament.air.rows().iter().copied().filter(|row| (1e-9 * length..length).contains(row));
        let rows = rows.map(libm::sqrt).filter(|row| (self.s..end).contains(row));
        for end in rows.chain([end]).collect::<Vec<_>>() {
            while self.s < end {
                if let Some(outcome) = self.advance(end) {
                    self.shot.outcome = outcome;
                    return self.shot;
                }
            }
        }
        self.shot.end = self.state;
        self.shot
    }

    /// One step, or a try that is too long. What ends the shot, if something does.
    fn advance(&mut self, end: f64) -> Option<Outcome> {
        if self.shot.steps.len() >= MOST_STEPS || self.wanted < 1e-13 * end {
            return Some(Outcome::RunsAway);
        }
        // A remnant that is much shorter than a step would cost as much as one.
        let (left, wanted) = (end - self.s, self.wanted);
        let length = if wanted >= left { left } else { wanted.min(0.5 * left).max(wanted.min(left) * 0.6) };
        self.stepper.is_stiff =
            self.stepper.filament.relaxations(&self.state, self.s, self.s + length) > STIFF;
        let step = self.stepper.step(self.s, length, &self.state);
        self.wanted = step.next_length();
        if step.error > 1.0 || step.error.is_nan() {
            let is_wave = self.stepper.is_elastic_wave && self.wanted < 1e-9 * end;
            return is_wave.then_some(Outcome::ElasticWave);
        }
        let step = self.up_to_event(step);
        self.s = if step.length == left { end } else { step.end() };
        self.state = step.to;
        self.shot.steps.push(step);
        self.arrive()
    }

    /// The part of a step before the melt becomes solid, and before the filament overtakes the air or the air the
    /// filament: its heat transfer has a cusp there, which an error of a step across it does not show.
    fn up_to_event(&mut self, mut step: Step) -> Step {
        let filament = self.stepper.filament;
        if self.stepper.phase == Phase::Melt && filament.until_solid(&step.to) <= 0.0 {
            step = freeze(filament, &mut self.stepper, &step);
        }
        let Some((to_cusp, is_sharp)) = self.stepper.cusp(&step) else { return step };
        // Towards a sharp one in shorter and shorter steps, and away from it in longer and longer ones.
        let shortest = AT_CUSP * libm::sqrt(filament.line.length);
        if is_sharp && to_cusp > shortest {
            return self.stepper.step(step.start, 0.8 * to_cusp, &step.from);
        }
        self.wanted = if is_sharp { shortest } else { self.wanted };
        self.stepper.step(step.start, to_cusp, &step.from)
    }

    /// What a filament does that has arrived at the end of a step.
    fn arrive(&mut self) -> Option<Outcome> {
        let filament = self.stepper.filament;
        let rates = self.stepper.rates(self.s, &self.state);
        if self.stepper.phase == Phase::Melt {
            if filament.ends_slack && rates.station.stress <= 0.0 {
                return Some(Outcome::Slack);
            }
            if filament.until_solid(&self.state) <= 0.0 {
                let is_cold = filament.is_cold(&self.state);
                let by = if is_cold {
                    SolidificationCause::Temperature
                } else {
                    SolidificationCause::Crystallisation
                };
                let cooling_rate = -rates.slopes[TEMPERATURE] * rates.station.speed;
                self.shot.solidification = Some((by, rates.station, cooling_rate));
                let orientation = filament.orientation(rates.station.stress);
                self.stepper.phase = Phase::Solid { orientation };
            } else if rates.is_elastic_wave {
                return Some(Outcome::ElasticWave);
            }
        }
        // What the conformation gives in the melt goes on as the balance of forces gives it.
        self.state[TENSION] = rates.station.tension;
        (libm::exp(self.state[LN_SPEED]) > FASTEST).then_some(Outcome::RunsAway)
    }
}

/// The part of a step in which the melt becomes solid: it ends where the filament is solid, by regula falsi (Illinois).
fn freeze(filament: &Filament<'_>, stepper: &mut Stepper<'_, '_>, step: &Step) -> Step {
    let (mut melt, mut solid) = (0.0, step.length);
    let mut above = filament.until_solid(&step.from);
    let mut below = filament.until_solid(&step.to);
    let mut last = *step;
    for _ in 0..60 {
        if below == 0.0 || solid - melt <= 1e-15 * step.end() || above <= 0.0 {
            break;
        }
        let share = above / (above - below);
        let length = melt + share.clamp(0.001, 0.999) * (solid - melt);
        let part = stepper.step(step.start, length, &step.from);
        let left = filament.until_solid(&part.to);
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
