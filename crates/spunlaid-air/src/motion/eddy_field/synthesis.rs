//! A pair of windows of one generation: random modes, transformed into samples.
//!
//! ```text
//! random phases of the modes, turned by their age → shape of the generation → transform along y, z → along the label
//! ```
//!
//! The real and the imaginary part of one complex transform are two independent fields: two windows, one
//! after the other.

use super::lattice::{Lattice, Part};
use super::plan::{Harmonic, Plan, projection};
use super::transform::{ABREAST, Numbers, Transform, Turned, root};
use crate::motion::StreamKey;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::Rng;
use spunlaid_ground::Isa;
use spunlaid_ground::random::stream;
use spunlaid_ground::threads::par_map;
use std::f64::consts::TAU;

/// Number of different random phases.
const PHASES: usize = 1024;
/// Marks the keys of fields in space, beside those of winds, paths and places.
const FIELD: u64 = 1 << 63;
/// Marks those of the modes with smaller waves than fields have in common.
const SMALLER: u64 = 1 << 62;

/// Complex numbers of points: real parts and imaginary parts.
type Complexes = [Vec<f32>; 2];

/// Two windows that are made from one transform.
pub(super) struct WindowPair<'a> {
    pub(super) generation: usize,
    /// Number of the pair.
    pub(super) number: i64,
    /// The points that are made.
    pub(super) part: &'a Part,
}

/// The transforms of a plan.
#[derive(Debug)]
pub(super) struct Synthesis {
    pub(super) isa: Isa,
    along_y: Transform,
    along_z: Transform,
    /// Of each generation.
    along_label: Vec<Transform>,
    /// Of each sample of each generation: half a turn more in the whole time makes the frequencies half-odd.
    half_turns: Vec<Vec<[f32; 2]>>,
    /// `e^(2πi p/PHASES)`
    phases: Vec<[f32; 2]>,
    /// Turns by a whole number of steps of the walk, from `−J` to `J`.
    turns: Vec<[f32; 2]>,
}

impl Synthesis {
    pub(super) fn new(plan: &Plan, isa: Isa) -> Self {
        let [y, z] = plan.lattice.points;
        let steps = plan.generations.len() as i64 - 1;
        Self {
            isa,
            along_y: Transform::new(y),
            along_z: Transform::new(z),
            along_label: plan.generations.iter().map(|shape| Transform::new(shape.samples)).collect(),
            half_turns: plan.generations.iter().map(|shape| half_turns(shape.samples)).collect(),
            phases: (0..PHASES).map(|p| root(p as f64 / PHASES as f64)).collect(),
            turns: (-steps..=steps).map(|step| root(plan.turn / TAU * step as f64)).collect(),
        }
    }

    /// Makes two windows of a generation, and lets `finish` make each line.
    pub(super) fn lines<T: Send>(
        &self,
        plan: &Plan,
        key: StreamKey,
        windows: &WindowPair<'_>,
        threads: usize,
        finish: impl Fn(usize, LineMaker<'_>) -> T + Sync,
    ) -> Vec<T> {
        let WindowPair { generation, number, part } = *windows;
        let shape = &plan.generations[generation];
        let planes = par_map(threads, shape.harmonics.len(), |n| {
            let mut random =
                [0, SMALLER].map(|set| Random::new(plan, key, number, generation, n as u64 | set));
            self.plane(plan, &shape.harmonics[n], &mut random, part)
        });
        let [lines, points] = part.counts();
        par_map(threads, lines, |y| {
            let line = LineMaker {
                synthesis: self,
                generation,
                planes: &planes,
                line: [y, points],
                components: [const { Vec::new() }; 3],
                scratch: vec![Numbers::ZERO; shape.samples],
            };
            finish(y, line)
        })
    }

    /// The modes of a harmonic as points, of each component `[y][z]`.
    fn plane(
        &self,
        plan: &Plan,
        harmonic: &Harmonic,
        random: &mut [Random; 2],
        part: &Part,
    ) -> [Complexes; 3] {
        let lattice = &plan.lattice;
        let (Part([of_y, of_z]), [lines, columns]) = (part, part.counts());
        let [points_y, points_z] = lattice.points;
        let waves_y = 2 * lattice.most_waves()[0] as usize + 1;
        let mut scratch = Vec::new();
        self.modes(plan, harmonic, random).map(|modes| {
            // `[waves along y][z]`
            let mut half = [0, 1].map(|_| vec![0.0; waves_y * columns]);
            for first in (0..waves_y).step_by(ABREAST) {
                let count = ABREAST.min(waves_y - first);
                let mut numbers = load(&modes, points_z, waves_y, first, count);
                scratch.resize(points_z, Numbers::ZERO);
                self.along_z.pass(self.isa, points_z, &mut numbers, &mut scratch);
                for z in 0..columns {
                    let number = &numbers[of_z.point(z)];
                    for wave in 0..count {
                        half[0][(first + wave) * columns + z] = number.re[wave];
                        half[1][(first + wave) * columns + z] = number.im[wave];
                    }
                }
            }
            let mut points = [0, 1].map(|_| vec![0.0; lines * columns]);
            for first in (0..columns).step_by(ABREAST) {
                let count = ABREAST.min(columns - first);
                let waves = load(&half, waves_y, columns, first, count);
                let mut numbers = vec![Numbers::ZERO; points_y];
                for (wave, number) in waves.iter().enumerate() {
                    numbers[place(wave as i64 - (waves_y / 2) as i64, points_y)] = *number;
                }
                scratch.resize(points_y, Numbers::ZERO);
                self.along_y.pass(self.isa, points_y, &mut numbers, &mut scratch);
                for y in 0..lines {
                    let number = &numbers[of_y.point(y)];
                    points[0][y * columns + first..][..count].copy_from_slice(&number.re[..count]);
                    points[1][y * columns + first..][..count].copy_from_slice(&number.im[..count]);
                }
            }
            points
        })
    }

    /// The random modes of a harmonic, of each component `[waves along z][waves along y]`: along z as the
    /// transform wants them, along y from the most negative number of waves to the largest.    theory.md (79)
    ///
    /// * `random` – phases of the modes that are in common with other fields, and of those with smaller waves
    fn modes(&self, plan: &Plan, harmonic: &Harmonic, random: &mut [Random; 2]) -> [Complexes; 3] {
        let lattice = &plan.lattice;
        let in_common = Lattice { largest: plan.in_common, ..*lattice };
        let points_z = lattice.points[1];
        let [unit_y, unit_z] = lattice.wave_number_units();
        let [most_y, most_z] = lattice.most_waves();
        let (columns, is_alone) = (2 * most_y as usize + 1, lattice.is_uniform());
        let mut modes = [0, 1, 2].map(|_| [0, 1].map(|_| vec![0.0; points_z * columns]));
        let ([x, y, z], [a, b, c]) = (&mut modes, harmonic.scale);
        for waves_y in -most_y..=most_y {
            let Some(beside) = lattice.waves_beside(waves_y) else { continue };
            let larger = in_common.waves_beside(waves_y).unwrap_or(-1);
            let amplitudes = &harmonic.amplitudes[waves_y.unsigned_abs() as usize * (most_z as usize + 1)..];
            for waves_z in -beside..=beside {
                let k = [harmonic.wave_number, waves_y as f64 * unit_y, waves_z as f64 * unit_z];
                let amplitude = amplitudes[waves_z.unsigned_abs() as usize];
                let part = usize::from(waves_z.abs() > larger);
                let white = random[part].next(&self.phases, &self.turns);
                let at = place(waves_z, points_z) * columns + (waves_y + most_y) as usize;
                let [of_x, of_y, of_z] = projection(k, is_alone);
                for (modes, row, scale) in [(&mut *x, of_x, a), (&mut *y, of_y, b), (&mut *z, of_z, c)] {
                    let factors = [row[0] as f32, row[1] as f32, row[2] as f32];
                    modes[0][at] = weighted(factors, white, 0) * (scale * amplitude);
                    modes[1][at] = weighted(factors, white, 1) * (scale * amplitude);
                }
            }
        }
        modes
    }
}

/// The sum of the real parts, or of the imaginary ones, of three amplitudes.
#[inline(always)]
fn weighted([a, b, c]: [f32; 3], [u, v, w]: [[f32; 2]; 3], part: usize) -> f32 {
    a * u[part] + b * v[part] + c * w[part]
}

/// Two windows along one line of z, made some points at a time.
pub(super) struct LineMaker<'a> {
    synthesis: &'a Synthesis,
    generation: usize,
    planes: &'a [[Complexes; 3]],
    /// Number along y, and number of points.
    line: [usize; 2],
    components: [Vec<Numbers>; 3],
    scratch: Vec<Numbers>,
}

impl LineMaker<'_> {
    /// Number of points.
    pub(super) fn points(&self) -> usize {
        self.line[1]
    }

    /// The samples of [`ABREAST`] points, those of the first window as real parts and those of the second one
    /// as imaginary parts.
    ///
    /// * `first` – number of the first point
    pub(super) fn windows(&mut self, first: usize) -> &[Vec<Numbers>; 3] {
        let Self { synthesis, generation, planes, line: [y, points], .. } = *self;
        let (start, count) = (y * points + first, ABREAST.min(points - first));
        for (component, numbers) in self.components.iter_mut().enumerate() {
            numbers.resize(self.scratch.len(), Numbers::ZERO);
            for (number, plane) in numbers.iter_mut().zip(planes) {
                let [re, im] = &plane[component];
                number.re[..count].copy_from_slice(&re[start..][..count]);
                number.im[..count].copy_from_slice(&im[start..][..count]);
            }
            let transform = &synthesis.along_label[generation];
            let turns = &synthesis.half_turns[generation];
            transform.pass(synthesis.isa, planes.len(), numbers, &mut self.scratch);
            synthesis.isa.run(Turned { numbers, turns });
        }
        &self.components
    }
}

/// Memory that two windows with so many harmonics take while they are made [bytes]: the points of each
/// harmonic, complex and of three components.
pub(super) fn memory(points: [usize; 2], harmonics: f64) -> f64 {
    let [y, z] = points.map(|points| points as f64);
    harmonics * y * z * (3 * size_of::<[f32; 2]>()) as f64
}

/// Some columns of a table, each a signal.
fn load([re, im]: &Complexes, rows: usize, columns: usize, first: usize, count: usize) -> Vec<Numbers> {
    let row = |row: usize| {
        let (mut numbers, start) = (Numbers::ZERO, row * columns + first);
        numbers.re[..count].copy_from_slice(&re[start..][..count]);
        numbers.im[..count].copy_from_slice(&im[start..][..count]);
        numbers
    };
    (0..rows).map(row).collect()
}

fn half_turns(samples: usize) -> Vec<[f32; 2]> {
    (0..samples).map(|m| root(0.5 * m as f64 / samples as f64)).collect()
}

/// Where a transform of so many points has a number of waves.
fn place(waves: i64, points: usize) -> usize {
    if waves < 0 { (points as i64 + waves) as usize } else { waves as usize }
}

/// Random phases of the modes of one harmonic in a pair of windows, in their order.
struct Random {
    stream: ChaCha8Rng,
    /// Steps of the walk so far, and generations before this one.
    generation: usize,
    words: usize,
    steps: usize,
}

impl Random {
    fn new(plan: &Plan, key: StreamKey, pair: i64, generation: usize, harmonic: u64) -> Self {
        // Independent eddies have phases of their own, carried ones a walk that goes on.
        let eddy = if plan.way.is_carried() { 0 } else { generation as u64 };
        let last = FIELD | eddy << 32 | harmonic;
        let carried = plan.way.is_carried() && plan.turn > 0.0;
        let steps = if carried { plan.generations.len() - 1 } else { 0 };
        Self {
            stream: stream([key.seed, key.replicate, pair as u64, last]),
            generation: if carried { generation } else { 0 },
            words: steps.div_ceil(32),
            steps: plan.generations.len() - 1,
        }
    }

    /// Three white complex amplitudes of the modulus one at the age of the generation.              theory.md (82)
    #[inline(always)]
    fn next(&mut self, phases: &[[f32; 2]], turns: &[[f32; 2]]) -> [[f32; 2]; 3] {
        let start = self.stream.next_u32();
        let mut white = [[0.0; 2]; 3];
        for (i, white) in white.iter_mut().enumerate() {
            let phase = phases[(start >> (10 * i)) as usize % PHASES];
            let (mut forward, mut left) = (0, self.generation as u32);
            for _ in 0..self.words {
                let bits = left.min(32);
                let mask = if bits == 32 { u32::MAX } else { (1 << bits) - 1 };
                forward += (self.stream.next_u32() & mask).count_ones();
                left -= bits;
            }
            // Forward less backward.
            let net = 2 * forward as usize + self.steps - self.generation;
            let turn = turns[net];
            *white = [phase[0] * turn[0] - phase[1] * turn[1], phase[0] * turn[1] + phase[1] * turn[0]];
        }
        white
    }
}
