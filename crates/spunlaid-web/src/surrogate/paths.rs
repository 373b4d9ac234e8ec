//! Paths of the surrogate, eight abreast.

use super::Surrogate;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use spunlaid_ground::lanes::{cos_sin_turn, log2};
use spunlaid_ground::random::stream;
use spunlaid_ground::{Isa, Lanes, Register, Task, WIDTH, Wide};
use std::array::from_fn;
use std::f64::consts::{LN_2, PI};

/// The key of the random numbers of a path. Equal keys give equal paths, bit for bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathKey {
    /// Master seed of the run.
    pub seed: u64,
    /// Number of the fibre.
    pub fibre: u64,
}

impl PathKey {
    /// ChaCha makes the streams of neighbouring keys independent; xoshiro256++ (Blackman & Vigna 2021) goes
    /// on from there, which is faster.
    fn stream(self) -> Xoshiro256PlusPlus {
        // No wind has streams with this last word.
        const SURROGATE: u64 = 3;
        Xoshiro256PlusPlus::from_rng(&mut stream([self.seed, self.fibre, 0, SURROGATE]))
    }
}

/// Points that are made at once, an even number.
pub(crate) const BLOCK: usize = 64;

/// Up to eight paths of a surrogate, which go on for as long as they are asked for.
///
/// A path is a chain of straight pieces of one length, so the length of fibre is exact. At each corner the
/// direction turns by half the drift at that place, the noise, and the other half of the drift, each solved
/// exactly. The scheme is symmetric, of weak order two: corners spread wider than the surrogate by `h²/24σ²`
/// of σ, 0.04 % at a step h of 0.1σ.
#[derive(Clone, Debug)]
pub struct Paths {
    isa: Isa,
    /// Length of a piece [m].
    step: f64,
    /// Standard deviation of the noise of a step [turns].
    noise: f64,
    /// Half a step's drift over the position [1/m].
    pull: [f64; 2],
    streams: Vec<Xoshiro256PlusPlus>,
    position: [Lanes; 2],
    direction: [Lanes; 2],
    /// A block and the first point after it. Those not yet asked for are the last ones.
    points: Vec<[Lanes; 2]>,
    taken: usize,
    /// Cosine and sine of the noise of the next steps.
    turns: Vec<[Lanes; 2]>,
    /// Random bits of the steps after these.
    bits: Vec<Lanes>,
}

impl Paths {
    /// Paths in the stationary state: ξ normal, direction uniform. Lanes left over repeat the first.
    ///
    /// None without a key or with more than eight, and if the step is not positive, is above a quarter of a
    /// standard deviation, or if the noise turns the direction by more than about one and a half radians in a
    /// step, A²h > 2.
    ///
    /// * `step` – length of fibre from one point to the next [m]
    pub fn new(isa: Isa, surrogate: Surrogate, step: f64, keys: &[PathKey]) -> Option<Self> {
        let Surrogate { sigma_md, sigma_cd, noise } = surrogate;
        // The straight pieces forget their direction such that they spread as far as the surrogate in the long run,
        // (1 + ρ)/(1 − ρ) = 4/A²h: theirs is a little more noise.
        let quarter = 0.25 * noise * noise * step;
        let turn = (2.0 * (libm::log1p(quarter) - libm::log1p(-quarter))).sqrt();
        let known = (1..=WIDTH).contains(&keys.len())
            && step > 0.0
            && [sigma_md, sigma_cd].iter().all(|sigma| (step..f64::MAX).contains(&(0.25 * sigma)))
            && (0.0..=0.5).contains(&quarter);
        if !known {
            return None;
        }
        let mut paths = Self {
            isa,
            step,
            noise: turn / (2.0 * PI),
            pull: [sigma_md, sigma_cd].map(|sigma| -0.5 * step / (sigma * sigma)),
            streams: keys.iter().map(|key| key.stream()).collect(),
            position: [Lanes::ZERO; 2],
            direction: [Lanes::ZERO; 2],
            points: vec![[Lanes::ZERO; 2]; BLOCK + 1],
            taken: BLOCK,
            turns: vec![[Lanes::ZERO; 2]; BLOCK],
            bits: vec![Lanes::ZERO; BLOCK / 2],
        };
        isa.run(Start { paths: &mut paths, sigmas: [sigma_md, sigma_cd] });
        Some(paths)
    }

    /// Fills `points` with the next points, [ξ₁, ξ₂] of each path [m]; the first point of all is the start.
    ///
    /// The paths do not depend on how many points are asked for at a time.
    pub fn fill(&mut self, mut points: &mut [[Lanes; 2]]) {
        while !points.is_empty() {
            if self.taken == BLOCK {
                self.isa.run(Next([self]));
            }
            let count = points.len().min(BLOCK - self.taken);
            let (now, later) = points.split_at_mut(count);
            now.copy_from_slice(&self.points[self.taken..][..count]);
            self.taken += count;
            points = later;
        }
    }

    /// Makes the next block of some sets of paths, of two in less time than one after the other.
    pub(crate) fn go_on(sets: &mut [Self]) {
        match sets {
            [one, other] => one.isa.run(Next([one, other])),
            _ => sets.iter_mut().for_each(|paths| paths.isa.run(Next([paths]))),
        }
    }

    /// The points of the block that has been made, and the one after it, with which the next block begins.
    pub(crate) fn block(&self) -> &[[Lanes; 2]] {
        &self.points
    }

    /// Random bits, a number for each lane.
    #[inline(always)]
    fn bits(&mut self) -> Lanes {
        let mut bits = [0; WIDTH];
        for (bits, stream) in bits.iter_mut().zip(&mut self.streams) {
            *bits = stream.next_u64();
        }
        let first = bits[0];
        let lanes = self.streams.len();
        Lanes::from_fn(|i| f64::from_bits(if i < lanes { bits[i] } else { first }))
    }
}

/// Two independent random numbers of the standard normal distribution from 64 random bits (Box and Muller). The
/// largest is 6.8.
#[inline(always)]
fn normals<S: Register>(bits: &Lanes) -> [Wide<S>; 2] {
    const TWO_52: f64 = 4_503_599_627_370_496.0;
    const SCALE: f64 = 1.0 / 4_294_967_296.0;
    let bits = Wide::<S>::load(bits);
    // The low bits of 2⁵² + integer are the integer.
    let high = Wide(bits.0.shift_right::<32>().or_bits(TWO_52.to_bits())) - Wide::splat(TWO_52 - 0.5);
    let low = Wide(bits.0.and_bits(0xffff_ffff).or_bits(TWO_52.to_bits())) - Wide::splat(TWO_52);
    let radius = (log2(high * Wide::splat(SCALE)) * Wide::splat(-2.0 * LN_2)).sqrt();
    let (cos, sin) = cos_sin_turn(low * Wide::splat(SCALE));
    [radius * cos, radius * sin]
}

struct Start<'a> {
    paths: &'a mut Paths,
    sigmas: [f64; 2],
}

impl Task for Start<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        let paths = self.paths;
        let normal = normals::<S>(&paths.bits());
        for ((position, normal), sigma) in paths.position.iter_mut().zip(normal).zip(self.sigmas) {
            *position = (normal * Wide::splat(sigma)).store();
        }
        // The angle of two normal numbers is uniform.
        let [x, y] = normals::<S>(&paths.bits());
        let inverse = Wide::splat(1.0).over(x.mul_add(x, y * y).sqrt());
        paths.direction = [(x * inverse).store(), (y * inverse).store()];
        for pair in 0..BLOCK / 2 {
            let bits = paths.bits();
            turns::<S>(paths.noise, &bits, &mut paths.turns[2 * pair..]);
        }
    }
}

/// Cosine and sine of the noise of two steps.
#[inline(always)]
fn turns<S: Register>(noise: f64, bits: &Lanes, into: &mut [[Lanes; 2]]) {
    for (turn, normal) in into.iter_mut().zip(normals::<S>(bits)) {
        let (cos, sin) = cos_sin_turn(normal * Wide::splat(noise));
        *turn = [cos.store(), sin.store()];
    }
}

/// Makes the next block of points of several sets of paths. A step waits for the one before; meanwhile the
/// processor works on the other sets.
struct Next<'a, const SETS: usize>([&'a mut Paths; SETS]);

impl<const SETS: usize> Task for Next<'_, SETS> {
    type Output = ();

    // A closure would not be compiled for the instruction set.
    #[allow(clippy::needless_range_loop)]
    #[inline(always)]
    fn call<S: Register>(self) {
        let Self(mut sets) = self;
        for paths in &mut sets {
            for pair in 0..BLOCK / 2 {
                paths.bits[pair] = paths.bits();
            }
        }
        let corners: [Corner<S>; SETS] = from_fn(|k| Corner::new(sets[k].step, sets[k].pull));
        let mut at: [[Wide<S>; 2]; SETS] = [[Wide::zero(); 2]; SETS];
        let mut along = at;
        for k in 0..SETS {
            let Paths { position, direction, .. } = &*sets[k];
            at[k] = [Wide::load(&position[0]), Wide::load(&position[1])];
            along[k] = [Wide::load(&direction[0]), Wide::load(&direction[1])];
        }
        for pair in 0..BLOCK / 2 {
            for i in [2 * pair, 2 * pair + 1] {
                for k in 0..SETS {
                    sets[k].points[i] = [at[k][0].store(), at[k][1].store()];
                    (at[k], along[k]) = corners[k].pass(at[k], along[k], &sets[k].turns[i]);
                }
            }
            for k in 0..SETS {
                along[k] = normalise(along[k]);
                // The noise of the next block.
                let Paths { noise, bits, turns: into, .. } = &mut *sets[k];
                turns::<S>(*noise, &bits[pair], &mut into[2 * pair..][..2]);
            }
        }
        for k in 0..SETS {
            sets[k].position = [at[k][0].store(), at[k][1].store()];
            sets[k].points[BLOCK] = sets[k].position;
            sets[k].direction = [along[k][0].store(), along[k][1].store()];
            sets[k].taken = 0;
        }
    }
}

/// Sets right the length of a direction that rounding has changed: on the way out from the centre the steps would
/// enlarge the error.
#[inline(always)]
fn normalise<S: Register>([a, b]: [Wide<S>; 2]) -> [Wide<S>; 2] {
    let squared = a.mul_add(a, b * b);
    let factor = squared.mul_add(Wide::splat(-0.5), Wide::splat(1.5));
    [a * factor, b * factor]
}

/// What a corner of the path does.
struct Corner<S: Register> {
    step: Wide<S>,
    pull: [Wide<S>; 2],
}

impl<S: Register> Corner<S> {
    #[inline(always)]
    fn new(step: f64, pull: [f64; 2]) -> Self {
        Self { step: Wide::splat(step), pull: [Wide::splat(pull[0]), Wide::splat(pull[1])] }
    }

    /// Turns the direction and goes on to the next corner.
    ///
    /// A drift `F = −(ξ₁/σ₁², ξ₂/σ₂²)` that stands still turns τ within the length h/2 to
    /// `τ' = (τ(1 − p²) + 2p(1 + p·τ))/(1 + p² + 2p·τ)`, `p = F/|F| tanh(h|F|/4)`: a unit vector for any p.
    /// Numerator and denominator of the first half go through the noise to the second half, which saves a
    /// division.
    #[inline(always)]
    fn pass(
        &self,
        [x, y]: [Wide<S>; 2],
        [a, b]: [Wide<S>; 2],
        turn: &[Lanes; 2],
    ) -> ([Wide<S>; 2], [Wide<S>; 2]) {
        let one = Wide::splat(1.0);
        let (u, v) = (x * self.pull[0], y * self.pull[1]);
        let squared = u.mul_add(u, v * v);
        // tanh(w/2)/w in w²; w is below 1 within eight standard deviations.
        let c0 = Wide::splat(0.5);
        let c1 = Wide::splat(-1.0 / 24.0);
        let c2 = Wide::splat(1.0 / 240.0);
        let ratio = c2.mul_add(squared, c1).mul_add(squared, c0);
        let (p, q) = (u * ratio, v * ratio);
        let square = p.mul_add(p, q * q);
        let (less, more) = (one - square, one + square);
        let (two_p, two_q) = (p + p, q + q);

        let dot = p.mul_add(a, q * b);
        let (factor, under) = (one + dot, more + dot + dot);
        let (a, b) = (two_p.mul_add(factor, a * less), two_q.mul_add(factor, b * less));

        let (cos, sin) = (Wide::load(&turn[0]), Wide::load(&turn[1]));
        let (a, b) = (sin.neg_mul_add(b, cos * a), sin.mul_add(a, cos * b));

        let dot = p.mul_add(a, q * b);
        let (factor, inverse) = (under + dot, one.over(more.mul_add(under, dot + dot)));
        let a = two_p.mul_add(factor, a * less) * inverse;
        let b = two_q.mul_add(factor, b * less) * inverse;
        ([self.step.mul_add(a, x), self.step.mul_add(b, y)], [a, b])
    }
}
