//! Eight neighbours of a beam, in one flight.

use super::charge::BeamField;
use super::neighbours::Neighbours;
use super::{Beam, BeamFindings};
use crate::observe::{NodeStates, StretchedBalance, tension_lag};
use spunlaid_air::EddyField;
use spunlaid_fibre::{Flight, Job, LaidPoint, Line, SurroundingRun};
use spunlaid_ground::place::Inlet;
use spunlaid_ground::{Error, Isa, WIDTH};
use spunlaid_web::{Depositor, Sheet, Window, WindowCurves, WindowOnSheet};
use std::sync::Arc;

/// Neighbours across the web that are shared out to packs by their places in the slot.
const AREA: usize = 8 * WIDTH;
/// Number of steps between two checks that no fibre is lost.
const STEPS_UNSEEN: u64 = 256;
/// Fewest steps between two looks at the momentum of the filaments, each of which takes about as long as a step.
const LEAST_BETWEEN: u64 = 16;

/// Steps from one look to the next, without a common divisor with those to a birth: births are seen at all phases.
fn steps_between_looks(to_birth: u64) -> u64 {
    let shares =
        |steps: u64| (2..=steps).any(|part| steps.is_multiple_of(part) && to_birth.is_multiple_of(part));
    (LEAST_BETWEEN + 1..).find(|steps| !shares(*steps)).unwrap_or(LEAST_BETWEEN)
}

/// The filaments of each pack: neighbours read the same part of the air.
pub(super) fn adjacent_filaments(places: &[Inlet]) -> Vec<Vec<usize>> {
    let mut order: Vec<usize> = (0..places.len()).collect();
    for area in order.chunks_mut(AREA) {
        area.sort_by(|one, other| places[*one].y.total_cmp(&places[*other].y));
    }
    order.chunks(WIDTH).map(<[usize]>::to_vec).collect()
}

/// Up to eight filaments and their flight.
#[derive(Debug)]
pub(super) struct Pack {
    flight: Flight,
    filaments: Vec<Filament>,
    balance: StretchedBalance,
    spin_up: f64,
    /// Number of steps from one look at the momentum of the filaments to the next, and to the next one from now on.
    steps_between: u64,
    until_look: u64,
}

impl Pack {
    /// * `numbers` – of its filaments
    /// * `keeps_all` – whether the curves of all of them are kept
    /// * `field` – the air of all filaments, if they share one
    pub(super) fn new(
        beam: &Beam<'_>,
        numbers: &[usize],
        keeps_all: bool,
        isa: Isa,
        field: Option<&Arc<EddyField>>,
    ) -> Result<Self, Error> {
        let job = |number: &usize| Job { case: beam.case, replicate: 0, place: beam.places[*number] };
        let jobs: Vec<Job<'_>> = numbers.iter().map(job).collect();
        let filament =
            |number: &usize| Filament::new(*number, beam.places[*number], keeps_all || beam.keeps(*number));
        let flight = Flight::in_air(&jobs, isa, SurroundingRun { field, ..SurroundingRun::run(beam.case) })?;
        let steps_between = steps_between_looks(beam.case.line.map_or(1, |line| line.steps_per_element));
        Ok(Self {
            flight,
            filaments: numbers.iter().map(filament).collect(),
            balance: StretchedBalance::new(beam.case),
            spin_up: beam.case.run.spin_up(),
            steps_between,
            until_look: steps_between,
        })
    }

    pub(super) fn filaments(&self) -> &[Filament] {
        &self.filaments
    }

    /// Advances all filaments and lays what has come down.
    ///
    /// * `field` – the air of all filaments during these steps, if they share one
    pub(super) fn advance(
        &mut self,
        steps: u64,
        field: Option<&Arc<EddyField>>,
        stretch: &BeltStretch,
        on: Option<&Depositor<'_>>,
    ) -> Reach {
        field.iter().for_each(|field| self.flight.give_field(field));
        let mut left = steps;
        while left > 0 && self.filaments.iter().any(|filament| filament.lost.is_none()) {
            let now = left.min(STEPS_UNSEEN);
            self.advance_and_look(now);
            left -= now;
            for (lane, reason) in self.flight.losses() {
                self.filaments[lane].lost.get_or_insert(reason);
            }
        }
        if field.is_some() {
            self.flight.release_field();
        }
        let mut reach = Reach { fed: f64::INFINITY, ..Reach::default() };
        for (lane, filament) in self.filaments.iter_mut().enumerate() {
            let points = self.flight.take_laid(lane);
            // What it laid last may be wrong.
            if filament.lost.is_none() {
                filament.lay(points, stretch, on, &mut reach);
            } else {
                reach.lost += 1;
            }
        }
        reach
    }

    /// Advances all filaments, and looks at their momentum in between; however few steps that are, the looks are as far
    /// apart.
    fn advance_and_look(&mut self, steps: u64) {
        let mut left = steps;
        while left > 0 {
            let now = left.min(self.until_look);
            (left, self.until_look) = (left - now, self.until_look - now);
            if self.until_look > 0 {
                self.flight.advance(now);
                continue;
            }
            self.until_look = self.steps_between;
            self.flight.advance(now - 1);
            // The drag of a step belongs to where its elements were: one that lands in it hung in the air.
            let snapshot = self.flight.observe();
            let flies =
                |lane: usize| self.filaments.get(lane).is_some_and(|filament| filament.lost.is_none());
            let nodes = NodeStates::of(&snapshot, tension_lag(&self.flight), flies);
            self.balance.see(&nodes, snapshot.time - self.spin_up);
        }
    }

    /// Gives its filaments their charge and what the others do to them.
    pub(super) fn charge(&mut self, field: &BeamField) {
        field.charge(&mut self.flight);
    }

    /// Hands over where the charge of its filaments is.
    pub(super) fn see_charge(&self, field: &mut BeamField) {
        for (lane, filament) in self.filaments.iter().enumerate().filter(|(_, one)| one.lost.is_none()) {
            field.see(&self.flight, lane, filament.number);
        }
    }

    /// Hands over where its filaments have come down since the last time.
    pub(super) fn compare(&mut self, neighbours: &mut Neighbours) {
        for filament in &mut self.filaments {
            match filament.lost {
                Some(_) => neighbours.lose(filament.number),
                None => neighbours.lay(filament.number, &mut filament.deviations),
            }
        }
    }

    /// Hands over what its filaments have done.
    ///
    /// * `balance` – to which it adds its own
    pub(super) fn finish(self, simulated: &mut BeamFindings, balance: &mut StretchedBalance) {
        balance.add(&self.balance);
        for filament in self.filaments {
            let Filament { number, kept, strands, lost, .. } = filament;
            simulated.layer.strands.extend(strands.into_parts());
            match lost {
                Some(reason) => simulated.lost.push((number, reason)),
                None => simulated.kept.extend(kept.map(|points| (number, points))),
            }
        }
    }
}

/// How far what has been laid reaches along the belt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Reach {
    /// Farthest that a point lies ahead of where the belt was when it was fed at its start [m].
    pub(super) ahead: f64,
    /// Farthest back that a point of the start lies on the belt [m].
    pub(super) start: f64,
    /// Length of fibre that each filament has laid at least [m]; filaments that are lost do not count.
    pub(super) fed: f64,
    /// Number of filaments that are lost.
    pub(super) lost: usize,
}

impl Default for Reach {
    fn default() -> Self {
        Self { ahead: f64::NEG_INFINITY, start: f64::INFINITY, fed: 0.0, lost: 0 }
    }
}

impl Reach {
    pub(super) fn with(self, other: Self) -> Self {
        Self {
            ahead: self.ahead.max(other.ahead),
            start: self.start.min(other.start),
            fed: self.fed.min(other.fed),
            lost: self.lost + other.lost,
        }
    }
}

/// The stretch of belt that becomes the sheet. Places on the belt are `y − v_b t`: what is laid later lies
/// farther back.
#[derive(Clone, Debug)]
pub(super) struct BeltStretch {
    belt_ratio: f64,
    /// Length of fibre that is fed in the start [m].
    start: f64,
    length: f64,
    /// Longest piece, but for rare exceptions [m].
    longest: f64,
    window: WindowOnSheet,
    /// Where the sheet begins, at its back [m]; None while filaments lay the fibre of their start.
    back: Option<f64>,
}

impl BeltStretch {
    /// While nothing has been laid.
    pub(super) fn before(beam: &Beam<'_>, line: &Line, sheet: &Sheet, window: Window) -> Self {
        Self {
            belt_ratio: line.belt_ratio(),
            start: line.feed_speed * beam.case.run.spin_up(),
            length: sheet.length,
            longest: beam.longest_piece(),
            window: WindowOnSheet::new(window, sheet),
            back: None,
        }
    }

    /// Finds the place of the sheet as soon as all filaments have laid the fibre of their start.
    pub(super) fn reconcile(&mut self, reach: &Reach) {
        if self.back.is_none() && reach.fed > self.start {
            self.back = Some(reach.start - self.length);
        }
    }

    /// Where the sheet begins, at its back [m]; None while filaments lay the fibre of their start.
    pub(super) const fn back(&self) -> Option<f64> {
        self.back
    }
}

/// A filament: its place, and what of it has not been drawn.
#[derive(Debug)]
pub(super) struct Filament {
    /// Number across the web.
    pub(super) number: usize,
    pub(super) place: Inlet,
    /// The last point that was drawn, and those after it.
    waiting: Vec<LaidPoint>,
    /// Deviations of the points after the start from the straight trace of a filament that comes down at one
    /// place, in machine and in cross direction [m].
    pub(super) deviations: Vec<[f64; 2]>,
    /// All points, if they are kept.
    pub(super) kept: Option<Vec<LaidPoint>>,
    /// Its parts in the window.
    pub(super) strands: WindowCurves,
    /// Why it is lost.
    pub(super) lost: Option<Error>,
}

impl Filament {
    pub(super) fn new(number: usize, place: Inlet, kept: bool) -> Self {
        let kept = kept.then(Vec::new);
        let (waiting, deviations) = (Vec::new(), Vec::new());
        Self { number, place, waiting, deviations, kept, strands: WindowCurves::default(), lost: None }
    }

    /// Takes points that it has laid, and draws its pieces on the sheet as soon as it is known where that is.
    pub(super) fn lay(
        &mut self,
        points: Vec<LaidPoint>,
        stretch: &BeltStretch,
        on: Option<&Depositor<'_>>,
        reach: &mut Reach,
    ) {
        for point in &points {
            let md = self.place.y + point.md;
            reach.ahead = reach.ahead.max(md + stretch.belt_ratio * point.fed);
            if point.fed < stretch.start {
                reach.start = reach.start.min(md);
            } else {
                self.deviations.push([point.md + stretch.belt_ratio * point.fed, point.cd]);
            }
        }
        if let Some(kept) = &mut self.kept {
            kept.extend(&points);
        }
        self.waiting.extend(points);
        if let Some(back) = stretch.back {
            let place = self.place;
            let on_sheet = |point: &LaidPoint| [place.z + point.cd, place.y + point.md - back];
            let curve: Vec<[f64; 2]> = self.waiting.iter().map(on_sheet).collect();
            let quanta_at = |to: [f64; 2]| {
                on.map_or((0, 1.0), |brush| brush.quanta_at(brush.titres.of(self.number), to[1]))
            };
            if let Some(brush) = on {
                brush.canvas.draw(&curve, stretch.longest, |to| quanta_at(to).0);
            }
            for ends in curve.windows(2) {
                let ends = [ends[0], ends[1]];
                self.strands.keep(self.number, ends, quanta_at(ends[1]).1, &stretch.window);
            }
        } else {
            // The points of the start lie before the sheet.
            let first = self.waiting.iter().position(|point| point.fed >= stretch.start);
            self.waiting.drain(..first.unwrap_or(self.waiting.len()).saturating_sub(1));
        }
        reach.fed = reach.fed.min(self.waiting.last().map_or(0.0, |point| point.fed));
        if stretch.back.is_some() {
            self.waiting.drain(..self.waiting.len().saturating_sub(1));
        }
    }
}
