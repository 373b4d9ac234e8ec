//! Looks at fields: cubic B-splines in label, y and z, and between two generations.
//!
//! Eight places are looked at together: where they lie and all weights are computed side by side, and then
//! the points around each are summed up. Everything here is loops over arrays, because a closure is not
//! compiled for the instruction set of the kernel that calls it.

use super::EddyField;
use super::lattice::{BEFORE, NEEDED, READ};
use super::plan::Plan;
use super::tape::{Rows, Tape};
use spunlaid_ground::lanes::{indices, integers, singles};
use spunlaid_ground::{F32x12, Lanes, Register, Vec3, WIDTH, Wide};

/// Eight fields, one of each place that is looked at, and what does not depend on the place.
pub(crate) struct EddyFields<'a> {
    plans: [&'a Plan; WIDTH],
    tapes: [&'a [Tape]; WIDTH],
    y: Ring,
    z: Ring,
    /// One where one generation passes into the next, zero where there is only one, or where eddies are not carried.
    fading: Lanes,
    /// Number of the last generation that has one to fade into.
    last: Lanes,
    /// Times of the pattern at the start [s].
    starts: Lanes,
    /// Generations that are looked at.
    parts: usize,
}

/// A place whose points have not been made.
#[derive(Clone, Copy)]
pub(crate) struct Missing {
    pub(crate) lane: usize,
    pub(super) generation: usize,
    /// The first points around it along y and z.
    pub(super) first: [usize; 2],
}

/// The points along y or along z, after which a field repeats itself.
struct Ring {
    turns_per_length: Lanes,
    points: Lanes,
}

/// Where places lie along an axis: the numbers of the first of four points around them, and the weights of these.
struct AxisWeights<S: Register> {
    first: [i64; WIDTH],
    weights: [Wide<S>; NEEDED],
}

impl<'a> EddyFields<'a> {
    #[inline(always)]
    pub(crate) fn new(fields: [&'a EddyField; WIDTH]) -> Self {
        let ring = || Ring { turns_per_length: Lanes::ZERO, points: Lanes::ZERO };
        let mut all = Self {
            plans: fields.map(|field| &*field.plan),
            tapes: fields.map(|field| &*field.tapes),
            y: ring(),
            z: ring(),
            fading: Lanes::ZERO,
            last: Lanes::ZERO,
            starts: Lanes::ZERO,
            parts: 1,
        };
        for (lane, (plan, field)) in all.plans.iter().zip(fields).enumerate() {
            all.starts.0[lane] = field.start;
            let lattice = &plan.lattice;
            let axes = [(&mut all.y, lattice.extent.y), (&mut all.z, lattice.extent.z)];
            for ((ring, extent), points) in axes.into_iter().zip(lattice.points) {
                ring.turns_per_length.0[lane] = 1.0 / extent;
                ring.points.0[lane] = points as f64;
            }
            let fading = usize::from(plan.way.is_carried() && plan.generations.len() > 1);
            all.parts = all.parts.max(1 + fading);
            all.fading.0[lane] = fading as f64;
            all.last.0[lane] = (plan.generations.len() - 1 - fading) as f64;
        }
        all
    }

    /// Fluctuations of rms one, x, y and z [-]; and a place for which the field has not been made, if there is one.
    ///
    /// * `time` – for which the fields have been made [s]
    /// * `at` – places: distance from the inlet, and y and z [m]
    #[inline(always)]
    pub(crate) fn fluctuations<S: Register>(
        &self,
        time: f64,
        at: &Vec3<Lanes>,
    ) -> (Vec3<Lanes>, Option<Missing>) {
        let one = Wide::<S>::splat(1.0);
        let [generation, travel] = self.passages::<S>(&at.x);
        let young = generation.floor().min(Wide::load(&self.last));
        let share = (generation - young).min(one) * Wide::load(&self.fading);
        let young = indices(young);
        let label = (Wide::splat(time) + Wide::load(&self.starts) - travel).store();

        let across_y = self.y.around::<S>(&at.y);
        let across_z = self.z.around::<S>(&at.z);
        // Where all samples are is found first, so that they are on their way from memory while the first
        // ones are summed up.
        let mut rows = [[[Rows::NONE; NEEDED]; WIDTH]; 2];
        let mut missing = None;
        // Of a line and a sample.
        let mut weights = [[[[0.0_f32; WIDTH]; NEEDED]; NEEDED]; 2];
        for (next, part) in [one - share, share].into_iter().enumerate().take(self.parts) {
            let mut generations = young;
            let mut places = Lanes::ZERO;
            for (lane, generation) in generations.iter_mut().enumerate() {
                *generation += next * self.fading.0[lane] as usize;
                places.0[lane] = label.0[lane] * self.plans[lane].generations[*generation].samples_per_time;
            }
            let along = around::<S>(Wide::load(&places));
            for (of_line, of_y) in weights[next].iter_mut().zip(across_y.weights) {
                for (weight, of_label) in of_line.iter_mut().zip(along.weights) {
                    *weight = singles(of_y * (of_label * part));
                }
            }
            for (lane, rows) in rows[next].iter_mut().enumerate() {
                let tape = &self.tapes[lane][generations[lane]];
                let Some(block) = tape.around(along.first[lane]) else {
                    continue;
                };
                let first = [across_y.first[lane] as usize, across_z.first[lane] as usize];
                let Some([mut line, point]) = tape.part.place(first) else {
                    missing = Some(Missing { lane, generation: generations[lane], first });
                    continue;
                };
                let lines = tape.part.counts()[0];
                for rows in rows {
                    *rows = block.rows(along.first[lane], line, point);
                    line = if line + 1 == lines { 0 } else { line + 1 };
                }
            }
        }
        let mut sums = [[0.0; READ]; WIDTH];
        for (lane, sums) in sums.iter_mut().enumerate() {
            let mut of_samples = [S::F32x12::zero(); NEEDED];
            for (rows, weights) in rows.iter().zip(&weights).take(self.parts) {
                for (rows, weights) in rows[lane].iter().zip(weights) {
                    for (m, sum) in of_samples.iter_mut().enumerate() {
                        *sum = sum.add_weighted(rows.row(m), weights[m][lane]);
                    }
                }
            }
            let [a, b, c, d] = of_samples;
            *sums = a.add(b).add(c.add(d)).store();
        }
        (self.across_z(&sums, &across_z.weights, share, &young), missing)
    }

    /// Generation and travel time of the air at distances from the inlet [m].
    #[inline(always)]
    fn passages<S: Register>(&self, x: &Lanes) -> [Wide<S>; 2] {
        let mut per_length = Lanes::ZERO;
        for (lane, plan) in self.plans.iter().enumerate() {
            per_length.0[lane] = plan.way.pieces_per_length();
        }
        // A fibre that is lost may be nowhere, which is then at the inlet.
        let (zero, place) = (Wide::<S>::zero(), Wide::load(x) * Wide::load(&per_length));
        let place = Wide::select_less(zero, place, place, zero).store();
        let mut pieces = [&[0.0; 4]; WIDTH];
        let mut shares = Lanes::ZERO;
        for (lane, piece) in pieces.iter_mut().enumerate() {
            (*piece, shares.0[lane]) = self.plans[lane].way.piece(place.0[lane]);
        }
        let [generation, travel, next_generation, next_travel] = S::load_rows(pieces).map(Wide);
        let share = Wide::load(&shares);
        [share.mul_add(next_generation - generation, generation), share.mul_add(next_travel - travel, travel)]
    }

    /// Sums up four points of three components, and makes the rms one between two generations.
    ///
    /// * `sums` – `[lane][point][component]`
    #[inline(always)]
    fn across_z<S: Register>(
        &self,
        sums: &[[f32; READ]; WIDTH],
        weights: &[Wide<S>; NEEDED],
        share: Wide<S>,
        young: &[usize; WIDTH],
    ) -> Vec3<Lanes> {
        let one = Wide::<S>::splat(1.0);
        let both = share * (one - share) * Wide::splat(2.0);
        let mut value = [Lanes::ZERO; 3];
        for (component, value) in value.iter_mut().enumerate() {
            let mut sum = Wide::zero();
            for (point, weight) in weights.iter().enumerate() {
                let mut of_point = Lanes::ZERO;
                for (into, sums) in of_point.0.iter_mut().zip(sums) {
                    *into = f64::from(sums[3 * point + component]);
                }
                sum = Wide::load(&of_point).mul_add(*weight, sum);
            }
            let mut correlation = Lanes::ZERO;
            for (lane, into) in correlation.0.iter_mut().enumerate() {
                *into = self.plans[lane].correlations[young[lane]][component];
            }
            let left = both.neg_mul_add(one - Wide::load(&correlation), one);
            *value = sum.over(left.sqrt()).store();
        }
        let [x, y, z] = value;
        Vec3::new(x, y, z)
    }
}

impl Ring {
    /// The points around places.
    #[inline(always)]
    fn around<S: Register>(&self, at: &Lanes) -> AxisWeights<S> {
        let turns = Wide::<S>::load(at) * Wide::load(&self.turns_per_length);
        let points = Wide::load(&self.points);
        let place = ((turns - turns.floor()) * points).min(points);
        // A fibre that is lost may be nowhere.
        let place = Wide::select_less(Wide::zero(), place, place, Wide::zero());
        let AxisWeights { mut first, weights } = around(place);
        // Rounding may put a place on the point after the last, which is the first.
        for (first, points) in first.iter_mut().zip(self.points.0) {
            let points = points as i64;
            let point = if *first < 0 { *first + points } else { *first };
            *first = if point >= points { point - points } else { point };
        }
        AxisWeights { first, weights }
    }
}

/// The points around places among evenly spaced ones.
#[inline(always)]
fn around<S: Register>(places: Wide<S>) -> AxisWeights<S> {
    let floors = places.floor();
    let mut first = integers(floors);
    for first in &mut first {
        *first -= BEFORE;
    }
    AxisWeights { first, weights: weights(places - floors) }
}

/// Weights of the four points around places between the second and the third of them.
///
/// * `share` – of the way from the second to the third
#[inline(always)]
fn weights<S: Register>(share: Wide<S>) -> [Wide<S>; NEEDED] {
    let rest = Wide::splat(1.0) - share;
    [cubed(rest), middle(share), middle(rest), cubed(share)]
}

#[inline(always)]
fn cubed<S: Register>(share: Wide<S>) -> Wide<S> {
    share * share * (share * Wide::splat(1.0 / 6.0))
}

#[inline(always)]
fn middle<S: Register>(share: Wide<S>) -> Wide<S> {
    (share * share).mul_add(share.mul_add(Wide::splat(0.5), Wide::splat(-1.0)), Wide::splat(2.0 / 3.0))
}
