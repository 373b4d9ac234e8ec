//! The filament as a boundary-value problem, for lines whose end does not follow from the tension at the die.
//!
//! Where inertia outweighs viscosity, two tensions that differ in the last digit lead to different ends. Then the
//! states at many places are sought together, and the filament is followed from each place to the next only
//! (multiple shooting). A known solution is moved to the wanted one in steps along the arc of the solutions, so
//! that it gets around turning points.

use super::End;
use super::elimination::Factors;
use super::filament::{
    ACROSS, ALONG, HEAT, LN_SPEED, PROGRESS, PULL, Phase, SIZE, State, TEMPERATURE, TENSION,
};
use super::filament::{Filament, WORK};
use super::integration::Step;
use super::shot::{FASTEST, FIRST_STEP, Leg, Outcome, Shot};
use std::cell::Cell;

/// Steps of the integration from one place to the next: few, so that an error does not grow by much.
const STEPS: usize = 8;
/// By how much a change may grow from one place to the next, `ln`.
const GROWTH: f64 = 3.0;
/// Steps between the last place and the solidification point, which moves.
const LAST_STEPS: usize = 4;
/// By how much an unknown is changed to see what depends on it, as a share of its size.
const CHANGE: f64 = 1e-5;
/// What is left of the equations, as a share of the sizes: aimed at, and enough.
const CLOSE: f64 = 1e-11;
const CLOSE_ENOUGH: f64 = 1e-7;
/// Most rounds of Newton's method, and most moves along the arc.
const MOST_ROUNDS: usize = 8;
const MOST_MOVES: usize = 150;
/// Most steps of the integration to find a line, some seconds of a processor. Lines that are found take 60,000 at most;
/// to show that a line has none may take four times as many.
const MOST_STEPS: usize = 400_000;
/// Solutions that cannot be followed on end at a melt that cools no further, if it cools at the solidification point
/// by no more than this share of what others do.
const LEAST_COOLING: f64 = 0.1;
/// The first move along the arc, the longest and the shortest.
const MOVES: [f64; 3] = [0.02, 0.5, 1e-5];

/// A filament between its ends.
#[derive(Clone)]
pub(super) struct Run {
    /// `ln F_0`, `F_0` in N.
    pub(super) at_die: f64,
    pub(super) shot: Shot,
}

/// What is changed along the arc.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Varies {
    /// The share of inertia, weight, friction and surface tension, up to one.
    Forces,
    /// What is known at the end, up to what is asked for.
    End,
}

/// Where the way along the arc leads.
pub(super) enum Arrival {
    /// To what was asked for.
    Met(Box<Run>),
    /// Around a turning point, at this speed [m/s] or tension [N] at the end, and back beyond its start.
    TurnsBack(f64),
    /// To filaments that are too fast.
    RunsAway,
    /// To a melt that cools no further before it is solid.
    StaysLiquid,
    /// No further.
    Lost,
}

/// A place between die and end, at which the state is unknown.
struct Place {
    /// Root of the distance from the die [√m].
    s: f64,
    state: State,
    /// What the values of the state are measured by.
    sizes: State,
    /// Length of the first step from here [√m].
    wanted: f64,
}

/// A solution on the arc.
#[derive(Clone)]
struct Point {
    run: Run,
    /// What is changed along the arc.
    value: f64,
}

/// Steps of the integration that all continuations to one line have taken so far.
#[derive(Default)]
pub(super) struct Effort(Cell<usize>);

impl Effort {
    fn add(&self, steps: usize) {
        self.0.set(self.0.get() + steps);
    }

    pub(super) fn is_too_much(&self) -> bool {
        self.0.get() >= MOST_STEPS
    }
}

/// Threads of a line along the arc.
pub(super) struct Branch<'a> {
    filament: Filament<'a>,
    varies: Varies,
    /// The values of a state that change by themselves.
    active: &'static [usize],
    /// Size of the tensions [N], and how far the melt cools [K].
    tension: f64,
    cooling: f64,
    places: Vec<Place>,
    effort: &'a Effort,
}

/// The plane in which a solution is sought.
#[derive(Clone, Copy)]
struct Plane<'p> {
    /// A point of it.
    through: &'p Unknowns,
    /// The direction across it.
    across: &'p Unknowns,
}

/// The unknowns of all places, and what is changed along the arc as the last.
type Unknowns = Vec<f64>;

impl<'a> Branch<'a> {
    pub(super) fn new(filament: &Filament<'a>, varies: Varies, run: &Run, effort: &'a Effort) -> Self {
        use super::Law;
        let active: &[usize] = match (filament.line.law == Law::Newtonian, filament.line.crystallisation) {
            (true, false) => &[LN_SPEED, TEMPERATURE, TENSION],
            (true, true) => &[LN_SPEED, TEMPERATURE, TENSION, PROGRESS],
            (false, false) => &[LN_SPEED, TEMPERATURE, ALONG, ACROSS],
            (false, true) => &[LN_SPEED, TEMPERATURE, ALONG, ACROSS, PROGRESS],
        };
        let filament = Filament { ends_slack: false, ..filament.clone() };
        let tension = largest_tension(&run.shot);
        let cooling = (filament.line.die_temperature - run.shot.end[TEMPERATURE]).clamp(0.1, 50.0);
        Self { filament, varies, active, tension, cooling, places: Vec::new(), effort }
    }

    /// Moves a solution along the arc to the one that is asked for.
    pub(super) fn walk(mut self, run: Run) -> Arrival {
        let (value, goal) = match self.varies {
            Varies::Forces => (self.filament.forces, 1.0),
            Varies::End => (self.end_of(&run.shot), self.wanted_end()),
        };
        let towards = (goal - value).signum();
        let (mut here, mut before) = (Point { run, value }, None::<Point>);
        let mut turn = None;
        let mut length = MOVES[0];
        let mut most_cooling = 0.0;
        for _ in 0..MOST_MOVES {
            self.accept(&here.run, here.value);
            let at = self.unknowns(&here).unwrap_or_default();
            let last = before.as_ref().and_then(|before| self.unknowns(before));
            let direction = self.direction(&at, last.as_ref(), towards);
            let cooling = here.run.shot.solidification.map_or(f64::INFINITY, |(_, _, cooling)| cooling);
            most_cooling = if cooling.is_finite() { cooling.max(most_cooling) } else { most_cooling };
            let Some(next) = self.next(&at, &direction, &mut length, goal) else {
                let stays_liquid = cooling < LEAST_COOLING * most_cooling;
                return if stays_liquid { Arrival::StaysLiquid } else { Arrival::Lost };
            };
            let is_met = next.value == goal;
            if is_met {
                return Arrival::Met(Box::new(next.run));
            }
            if libm::exp(next.run.shot.end[LN_SPEED]) > 0.5 * FASTEST {
                return Arrival::RunsAway;
            }
            if (next.value - here.value) * towards < 0.0 {
                let turned = *turn.get_or_insert(here.value);
                if (next.value - value) * towards < 0.0 {
                    return Arrival::TurnsBack(self.known_at_end(turned));
                }
            }
            before = Some(std::mem::replace(&mut here, next));
        }
        Arrival::Lost
    }

    /// The next solution along the arc, or the wanted one if that is not beyond it. Moves that fail are shortened.
    fn next(&self, at: &Unknowns, direction: &Unknowns, length: &mut f64, goal: f64) -> Option<Point> {
        let last = at.len() - 1;
        let on = |along: &[f64], share: f64| -> Unknowns {
            at.iter().zip(along).map(|(at, along)| at + share * along).collect()
        };
        while *length > MOVES[2] && !self.effort.is_too_much() {
            if let Some((unknowns, point, rounds)) = self.solve(on(direction, *length), direction) {
                if (point.value - goal) * (at[last] - goal) > 0.0 {
                    *length = (*length * if rounds <= 4 { 1.6 } else { 0.8 }).min(MOVES[1]);
                    return Some(point);
                }
                let moved: Unknowns = unknowns.iter().zip(at).map(|(next, at)| next - at).collect();
                let mut start = on(&moved, (goal - at[last]) / moved[last]);
                start[last] = goal;
                if let Some((_, point, _)) = self.solve(start, &self.along_value(1.0, at.len())) {
                    return Some(Point { value: goal, ..point });
                }
            }
            *length *= 0.4;
        }
        None
    }

    /// A direction in which only what is changed along the arc changes.
    fn along_value(&self, towards: f64, unknowns: usize) -> Unknowns {
        let mut direction = vec![0.0; unknowns];
        direction[unknowns - 1] = towards;
        direction
    }

    /// The direction from the last solution to this one, of length one; places count as one together.
    fn direction(&self, at: &Unknowns, last: Option<&Unknowns>, towards: f64) -> Unknowns {
        let Some(last) = last else { return self.along_value(towards, at.len()) };
        let mut direction: Unknowns = at.iter().zip(last).map(|(at, last)| at - last).collect();
        let length = libm::sqrt(self.product(&direction, &direction));
        direction.iter_mut().for_each(|part| *part /= length);
        direction
    }

    /// Scalar product in which the places count as one together.
    fn product(&self, a: &Unknowns, b: &Unknowns) -> f64 {
        let last = a.len() - 1;
        let places: f64 = a[1..last].iter().zip(&b[1..last]).map(|(a, b)| a * b).sum();
        a[0] * b[0] + a[last] * b[last] + places / self.places.len().max(1) as f64
    }

    /// What a shot has at its end, in the measure of what is known there.
    fn end_of(&self, shot: &Shot) -> f64 {
        match self.filament.end {
            End::TakeUp(_) => shot.end[LN_SPEED],
            End::Tension(_) | End::Flown(_) => shot.end[TENSION] / self.tension,
        }
    }

    fn wanted_end(&self) -> f64 {
        match self.filament.end {
            End::TakeUp(speed) => libm::log(speed),
            End::Tension(tension) | End::Flown(tension) => tension / self.tension,
        }
    }

    /// A speed [m/s] or a tension [N] in the measure of what is known at the end.
    fn known_at_end(&self, value: f64) -> f64 {
        match self.filament.end {
            End::TakeUp(_) => libm::exp(value),
            End::Tension(_) | End::Flown(_) => value * self.tension,
        }
    }

    /// Chooses the places by the steps of a shot: after so many of them, and where a small change has grown.
    fn accept(&mut self, run: &Run, value: f64) {
        let filament = self.filament(value);
        let melt: Vec<&Step> = run.shot.steps.iter().take_while(|step| step.phase == Phase::Melt).collect();
        self.places.clear();
        let (mut steps, mut grown) = (0, 0.0);
        for (i, step) in melt.iter().enumerate() {
            let growth = filament.growth(&step.from, step.start, step.end());
            let is_due = steps >= STEPS && i + LAST_STEPS < melt.len();
            if i > 0 && (is_due || grown + growth > GROWTH) {
                self.places.push(self.place(step, 0.0));
                (steps, grown) = (0, 0.0);
            }
            let parts = (growth / GROWTH).ceil().max(1.0);
            for part in 1..parts as usize {
                self.places.push(self.place(step, part as f64 / parts));
            }
            (steps, grown) = (steps + 1, grown + growth / parts);
        }
    }

    fn place(&self, step: &Step, share: f64) -> Place {
        let s = step.start + share * step.length;
        let state = if share == 0.0 { step.from } else { step.at(s) };
        let strain = (state[ALONG] - 1.0).abs().max((state[ACROSS] - 1.0).abs()).max(1e-6);
        let mut sizes = [1.0; SIZE];
        (sizes[TEMPERATURE], sizes[TENSION]) = (self.cooling, self.tension);
        (sizes[ALONG], sizes[ACROSS]) = (strain, strain);
        Place { s, state, sizes, wanted: step.length }
    }

    /// The unknowns of a solution; none if it is solid at a place.
    fn unknowns(&self, point: &Point) -> Option<Unknowns> {
        let mut unknowns = vec![point.run.at_die];
        let mut steps = point.run.shot.steps.iter().peekable();
        for place in &self.places {
            while steps.next_if(|step| step.end() <= place.s).is_some() {}
            let step = steps.peek().filter(|step| step.phase == Phase::Melt)?;
            let state = step.at(place.s);
            unknowns.extend(self.active.iter().map(|i| state[*i] / place.sizes[*i]));
        }
        unknowns.push(point.value);
        Some(unknowns)
    }

    /// The filament with what is changed along the arc.
    fn filament(&self, value: f64) -> Filament<'a> {
        let forces = if self.varies == Varies::Forces { value } else { self.filament.forces };
        Filament { forces, ..self.filament.clone() }
    }

    /// Follows the filament from a place, or from the die, to the next one. None if it does not get there.
    fn leg(&self, number: usize, unknowns: &[f64], filament: &Filament<'a>) -> Option<Shot> {
        let length = libm::sqrt(filament.line.length);
        let end = self.places.get(number).map_or(length, |place| place.s);
        let leg = match number.checked_sub(1).map(|before| &self.places[before]) {
            None => {
                let first = FIRST_STEP * length;
                Leg::new(filament, 0.0, filament.at_die(libm::exp(unknowns[0]))?, first, self.tension)
            }
            Some(place) => {
                let mut state = place.state;
                let first = 1 + (number - 1) * self.active.len();
                for (i, value) in self.active.iter().zip(&unknowns[first..]) {
                    state[*i] = value * place.sizes[*i];
                }
                Leg::new(filament, place.s, state, place.wanted, self.tension)
            }
        };
        let shot = leg.follow(end);
        self.effort.add(shot.steps.len());
        let is_last = number == self.places.len();
        (shot.outcome == Outcome::Complete && (is_last || shot.solidification.is_none())).then_some(shot)
    }

    /// All parts of the filament.
    fn legs(&self, unknowns: &Unknowns) -> Option<Vec<Shot>> {
        let filament = self.filament(unknowns[unknowns.len() - 1]);
        (0..=self.places.len()).map(|number| self.leg(number, unknowns, &filament)).collect()
    }

    /// What the end of a part adds to the equations: the gap to the place there, or what the end of the line misses.
    fn ends(&self, number: usize, shot: &Shot) -> Vec<f64> {
        match self.places.get(number) {
            Some(place) => self.active.iter().map(|i| shot.end[*i] / place.sizes[*i]).collect(),
            None => vec![self.end_of(shot)],
        }
    }

    /// What is left of the equations: the gaps between the parts, what the end misses, and how far the solution is
    /// from the plane across the arc that it is sought in.
    fn residual(&self, unknowns: &Unknowns, legs: &[Shot], plane: Plane<'_>) -> Vec<f64> {
        let last = unknowns.len() - 1;
        let mut left: Vec<f64> =
            legs.iter().enumerate().flat_map(|(number, shot)| self.ends(number, shot)).collect();
        for (left, known) in left.iter_mut().zip(&unknowns[1..last]) {
            *left -= known;
        }
        left[last - 1] -= if self.varies == Varies::End { unknowns[last] } else { self.wanted_end() };
        let moved: Unknowns = unknowns.iter().zip(plane.through).map(|(now, start)| now - start).collect();
        left.push(self.product(&moved, plane.across));
        left
    }

    /// How the equations change with the unknowns, row by row.
    fn derivatives(&self, unknowns: &Unknowns, legs: &[Shot], across: &Unknowns) -> Option<Vec<f64>> {
        let (size, width) = (unknowns.len(), self.active.len());
        let mut rows = vec![0.0; size * size];
        let filament = self.filament(unknowns[size - 1]);
        for (number, shot) in legs.iter().enumerate() {
            let here = self.ends(number, shot);
            let of_start = if number == 0 { 0..1 } else { 1 + (number - 1) * width..1 + number * width };
            let of_value = (self.varies == Varies::Forces).then_some(size - 1);
            for column in of_start.chain(of_value) {
                let mut near = unknowns.clone();
                // Back rather than on: a filament that gets faster may run away.
                near[column] -= CHANGE;
                let there = match column == size - 1 {
                    true => self.leg(number, &near, &self.filament(near[column])),
                    false => self.leg(number, &near, &filament),
                };
                for (i, (here, there)) in here.iter().zip(self.ends(number, &there?)).enumerate() {
                    rows[(number * width + i) * size + column] = (here - there) / CHANGE;
                }
            }
        }
        for i in 0..size - 2 {
            rows[i * size + i + 1] -= 1.0;
        }
        if self.varies == Varies::End {
            rows[(size - 2) * size + size - 1] -= 1.0;
        }
        let weight = 1.0 / self.places.len().max(1) as f64;
        for (i, across) in across.iter().enumerate() {
            rows[(size - 1) * size + i] = if i == 0 || i == size - 1 { *across } else { weight * across };
        }
        Some(rows)
    }

    /// Solves the equations by Newton's method from a start, in the plane through it across the arc. None if they
    /// have no solution near it. With the number of rounds.
    fn solve(&self, start: Unknowns, across: &Unknowns) -> Option<(Unknowns, Point, usize)> {
        let left_of = |unknowns: &Unknowns| {
            let legs = self.legs(unknowns)?;
            let left = self.residual(unknowns, &legs, Plane { through: &start, across });
            let size = left.iter().fold(0.0, |most: f64, left| most.max(left.abs()));
            size.is_finite().then_some((legs, left, size))
        };
        let mut unknowns = start.clone();
        let (mut legs, mut left, mut size) = left_of(&unknowns)?;
        let mut rounds = 0;
        while size > CLOSE && rounds < MOST_ROUNDS {
            rounds += 1;
            let rows = self.derivatives(&unknowns, &legs, across)?;
            let count = unknowns.len();
            let mut change = left.clone();
            Factors::of(count, |row, column| rows[row * count + column]).solve(&mut change);
            let shorter = [1.0, 0.5, 0.25, 0.1].into_iter().find_map(|share| {
                let next: Unknowns =
                    unknowns.iter().zip(&change).map(|(now, change)| now - share * change).collect();
                let (legs, left, smaller) = left_of(&next)?;
                (smaller < (1.0 - 0.3 * share) * size).then_some((next, legs, left, smaller))
            });
            let Some(next) = shorter else { break };
            (unknowns, legs, left, size) = next;
        }
        if size > CLOSE_ENOUGH {
            return None;
        }
        let run = Run { at_die: unknowns[0], shot: joined(legs) };
        let point = Point { run, value: unknowns[unknowns.len() - 1] };
        Some((unknowns, point, rounds))
    }
}

/// The parts of a filament as one.
fn joined(legs: Vec<Shot>) -> Shot {
    const SUMS: [usize; 3] = [PULL, HEAT, WORK];
    let mut whole: Option<Shot> = None;
    for mut leg in legs {
        let Some(whole) = whole.as_mut() else {
            whole = Some(leg);
            continue;
        };
        // Each part, but the first, begins with the sums of the place as it was chosen.
        let first = leg.steps.first().map_or(leg.end, |step| step.from);
        let add = |state: &mut State, end: &State| SUMS.iter().for_each(|i| state[*i] += end[*i] - first[*i]);
        for step in &mut leg.steps {
            add(&mut step.from, &whole.end);
            add(&mut step.to, &whole.end);
        }
        add(&mut leg.end, &whole.end);
        whole.steps.append(&mut leg.steps);
        (whole.end, whole.solidification) = (leg.end, leg.solidification);
    }
    whole.unwrap_or(Shot {
        outcome: Outcome::RunsAway,
        end: [0.0; SIZE],
        solidification: None,
        steps: Vec::new(),
    })
}

/// The largest tension in a shot [N].
pub(super) fn largest_tension(shot: &Shot) -> f64 {
    shot.steps.iter().map(|step| step.from[TENSION].abs()).fold(shot.end[TENSION].abs(), f64::max)
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::shooting::find;
    use super::super::shot::shoot;
    use super::super::tests::{NONE, isothermal};
    use super::super::{Law, Spinline};
    use super::*;

    /// A melt that cools and gets stiffer, with inertia.
    fn line(law: Law) -> Spinline {
        let mut line = Spinline { law, end: End::TakeUp(2.0), ..isothermal(1000.0) };
        (line.material.activation_energy, line.material.surface_tension) = (44e3, 0.02);
        line
    }

    fn filament(line: &Spinline) -> Filament<'_> {
        Filament { heat_transfer: Some(0.015), ..Filament::new(line, NONE, &line.air) }
    }

    fn run(filament: &Filament<'_>, tension: f64) -> Run {
        Run { at_die: tension.ln(), shot: shoot(filament, filament.at_die(tension).unwrap()) }
    }

    /// A filament that was followed in one go satisfies the equations between them, and each derivative is that of the
    /// equations, by central differences.
    #[test]
    fn analytic_the_equations_of_a_known_filament_and_their_derivatives() {
        for law in [Law::Newtonian, Law::Giesekus] {
            let line = line(law);
            let filament = filament(&line);
            let run = run(&filament, 3e-4);
            for varies in [Varies::End, Varies::Forces] {
                let effort = Effort::default();
                let mut branch = Branch::new(&filament, varies, &run, &effort);
                let value = if varies == Varies::End { branch.end_of(&run.shot) } else { 1.0 };
                branch.accept(&run, value);
                assert!(branch.places.len() >= 2, "{}", branch.places.len());
                let at = branch.unknowns(&Point { run: run.clone(), value }).unwrap();
                let count = at.len();
                assert_eq!(count, 2 + branch.places.len() * branch.active.len());
                let across: Unknowns = (0..count).map(|i| 1.0 / (1.0 + i as f64)).collect();
                let left = |unknowns: &Unknowns| {
                    let legs = branch.legs(unknowns).unwrap();
                    branch.residual(unknowns, &legs, Plane { through: &at, across: &across })
                };
                // What is missed at the end is the wanted end, of ln 2, where forces vary.
                let found = left(&at);
                let missed = if varies == Varies::End { 0.0 } else { branch.end_of(&run.shot) - 2_f64.ln() };
                for (i, left) in found.iter().enumerate() {
                    let expected = if i == count - 2 { missed } else { 0.0 };
                    assert!((left - expected).abs() < 1e-6, "{law:?} {i}: {left} {expected}");
                }
                let rows = branch.derivatives(&at, &branch.legs(&at).unwrap(), &across).unwrap();
                for column in 0..count {
                    let near = |by: f64| {
                        let mut near = at.clone();
                        near[column] += by;
                        left(&near)
                    };
                    for (row, (after, before)) in near(1e-4).into_iter().zip(near(-1e-4)).enumerate() {
                        let found = rows[row * count + column];
                        let expected = (after - before) / 2e-4;
                        let within = 2e-3 * expected.abs().max(1.0);
                        assert!(
                            (found - expected).abs() < within,
                            "{law:?} {row} {column}: {found} {expected}"
                        );
                    }
                }
                assert!(effort.0.get() > 100 && !effort.is_too_much());
            }
        }
    }

    /// Followed along the arc from another end, or from half of the forces, a filament is the one that is found by its
    /// tension alone; its parts join to what one shot has.
    #[test]
    fn analytic_a_filament_at_the_end_of_the_arc_is_that_of_shooting() {
        for law in [Law::Newtonian, Law::Giesekus] {
            let line = line(law);
            for end in [End::TakeUp(2.0), End::Tension(4e-4)] {
                let wanted = Filament { end, ..filament(&line) };
                let expected = find(&Filament { ends_slack: true, ..wanted.clone() }, false);
                let expected = expected.unwrap_or_else(|miss| panic!("{law:?} {end:?}: {miss:?}")).tension;
                for varies in [Varies::End, Varies::Forces] {
                    let forces = if varies == Varies::Forces { 0.5 } else { 1.0 };
                    let from = Filament { forces, ..wanted.clone() };
                    let start = match varies {
                        Varies::End => run(&from, 0.8 * expected),
                        Varies::Forces => {
                            let tension =
                                find(&from, false).unwrap_or_else(|miss| panic!("{miss:?}")).tension;
                            run(&from, tension)
                        }
                    };
                    let effort = Effort::default();
                    let arrival = Branch::new(&from, varies, &start, &effort).walk(start.clone());
                    let Arrival::Met(met) = arrival else { panic!("{law:?} {end:?}: not met") };
                    assert!((met.at_die - expected.ln()).abs() < 1e-6, "{law:?} {end:?}: {}", met.at_die);
                    // One shot under this tension has the same end and the same sums.
                    let alone = run(&wanted, met.at_die.exp()).shot;
                    for i in [LN_SPEED, TEMPERATURE, PULL, HEAT, WORK] {
                        let [found, alone] = [met.shot.end[i], alone.end[i]];
                        assert!((found - alone).abs() < 1e-5 * alone.abs().max(1e-9), "{i}: {found} {alone}");
                    }
                    let ends: Vec<f64> = met.shot.steps.iter().map(Step::end).collect();
                    assert!(
                        met.shot.steps[1..]
                            .iter()
                            .zip(&ends)
                            .all(|(step, end)| (step.start - end).abs() < 1e-12)
                    );
                }
            }
        }
    }
}
