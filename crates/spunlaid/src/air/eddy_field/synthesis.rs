//! A pair of windows of one generation: random modes, transformed into samples.
//!
//! ```text
//! random phases of the modes, turned by their age → shape of the generation → transform along y, z → along the label
//! ```
//!
//! The real and the imaginary part of one complex transform are two independent fields: two windows, one after the other.

use super::lattice::Lattice;
use super::plan::{Harmonic, Plan, projection};
use crate::air::StreamKey;
use crate::threads::each;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use rustfft::num_complex::Complex32;
use rustfft::{Fft, FftPlannerScalar};
use std::f64::consts::PI;
use std::sync::Arc;

/// Number of different random phases.
const PHASES: usize = 1024;
/// Points of a line that are transformed together.
const TOGETHER: usize = 16;
/// Marks the keys of fields in space, beside those of winds, paths and places.
const FIELD: u64 = 1 << 63;

/// The samples of two successive windows along one line of z: `[component][sample][z]`, first of the one window, then of the
/// other.
pub(super) type Line = [Vec<f32>; 2];

/// The transforms of a plan.
pub(super) struct Synthesis {
    along_y: Arc<dyn Fft<f32>>,
    along_z: Arc<dyn Fft<f32>>,
    /// Of each generation.
    along_label: Vec<Arc<dyn Fft<f32>>>,
    /// `e^(2πi p/PHASES)`
    phases: Vec<Complex32>,
    /// Turns by a whole number of steps of the walk, from `−J` to `J`.
    turns: Vec<Complex32>,
}

impl Synthesis {
    pub(super) fn new(plan: &Plan) -> Self {
        // The same operations on every machine, so the same bits.
        let mut planner = FftPlannerScalar::new();
        let [y, z] = plan.lattice.points;
        let steps = plan.generations.len() as i64 - 1;
        Self {
            along_y: planner.plan_fft_inverse(y),
            along_z: planner.plan_fft_inverse(z),
            along_label: plan.generations.iter().map(|g| planner.plan_fft_forward(g.samples)).collect(),
            phases: (0..PHASES).map(|p| unit(2.0 * PI * p as f64 / PHASES as f64)).collect(),
            turns: (-steps..=steps).map(|step| unit(plan.turn * step as f64)).collect(),
        }
    }

    /// Makes two windows of a generation, and passes each line to `finish`.
    ///
    /// * `pair` – number of the pair of windows
    pub(super) fn lines<T: Send>(
        &self,
        plan: &Plan,
        key: StreamKey,
        (generation, pair): (usize, i64),
        threads: usize,
        finish: impl Fn(usize, Line) -> T + Sync,
    ) -> Vec<T> {
        let shape = &plan.generations[generation];
        let planes: Vec<Vec<Complex32>> = each(threads, shape.harmonics.len(), |n| {
            let mut random = Random::new(plan, key, pair, generation, n);
            self.plane(plan, &shape.harmonics[n], &mut random)
        });
        each(threads, plan.lattice.points[0], |y| finish(y, self.line(plan, generation, &planes, y)))
    }

    /// The modes of a harmonic as points `[component][y][z]`.
    fn plane(&self, plan: &Plan, harmonic: &Harmonic, random: &mut Random) -> Vec<Complex32> {
        let lattice = &plan.lattice;
        let [points_y, points_z] = lattice.points;
        let size = points_y * points_z;
        // `[component][waves along z][waves along y]`
        let mut modes = vec![Complex32::ZERO; 3 * size];
        self.fill(lattice, harmonic, random, &mut modes);
        let mut scratch =
            vec![
                Complex32::ZERO;
                self.along_y.get_inplace_scratch_len().max(self.along_z.get_inplace_scratch_len())
            ];
        let most = lattice.most_waves()[1] as usize;
        let mut points = vec![Complex32::ZERO; 3 * size];
        for (modes, points) in modes.chunks_exact_mut(size).zip(points.chunks_exact_mut(size)) {
            for (waves, column) in modes.chunks_exact_mut(points_y).enumerate() {
                if waves <= most || waves + most >= points_z {
                    self.along_y.process_with_scratch(column, &mut scratch);
                }
            }
            for (y, row) in points.chunks_exact_mut(points_z).enumerate() {
                for (z, point) in row.iter_mut().enumerate() {
                    *point = modes[z * points_y + y];
                }
                self.along_z.process_with_scratch(row, &mut scratch);
            }
        }
        points
    }

    /// Fills in the random modes of a harmonic.                                                     theory.md (81)
    fn fill(&self, lattice: &Lattice, harmonic: &Harmonic, random: &mut Random, modes: &mut [Complex32]) {
        let [points_y, points_z] = lattice.points;
        let size = points_y * points_z;
        let [unit_y, unit_z] = lattice.wave_number_units();
        let [most_y, most_z] = lattice.most_waves();
        let scale = harmonic.scale;
        for waves_y in -most_y..=most_y {
            let Some(beside) = lattice.waves_beside(waves_y) else { continue };
            let amplitudes = &harmonic.amplitudes[waves_y.unsigned_abs() as usize * (most_z as usize + 1)..];
            let y = waves_y.rem_euclid(points_y as i64) as usize;
            for waves_z in -beside..=beside {
                let z = waves_z.rem_euclid(points_z as i64) as usize;
                let k = [harmonic.wave_number, waves_y as f64 * unit_y, waves_z as f64 * unit_z];
                let projection = projection(k, lattice.is_uniform());
                let amplitude = amplitudes[waves_z.unsigned_abs() as usize];
                let white = random.next(&self.phases, &self.turns);
                for i in 0..3 {
                    let [a, b, c] = projection[i].map(|part| part as f32);
                    let sum = white[0] * a + white[1] * b + white[2] * c;
                    modes[i * size + z * points_y + y] = sum * (scale[i] * amplitude);
                }
            }
        }
    }

    /// The samples along the label of one line of points.
    fn line(&self, plan: &Plan, generation: usize, planes: &[Vec<Complex32>], y: usize) -> Line {
        let [points_y, points_z] = plan.lattice.points;
        let (size, samples) = (points_y * points_z, plan.generations[generation].samples);
        let transform = &self.along_label[generation];
        let mut scratch = vec![Complex32::ZERO; transform.get_inplace_scratch_len()];
        // Half-odd frequencies: one more turn, by half a period in all.
        let half_turn: Vec<Complex32> = (0..samples).map(|m| unit(-PI * m as f64 / samples as f64)).collect();
        let mut windows = [0, 1].map(|_| vec![0.0; 3 * samples * points_z]);
        let mut waves = vec![Complex32::ZERO; TOGETHER * samples];
        for component in 0..3 {
            for start in (0..points_z).step_by(TOGETHER) {
                let count = TOGETHER.min(points_z - start);
                let waves = &mut waves[..count * samples];
                waves.fill(Complex32::ZERO);
                for (n, plane) in planes.iter().enumerate() {
                    let points = &plane[component * size + y * points_z + start..][..count];
                    for (z, point) in points.iter().enumerate() {
                        waves[z * samples + n] = *point;
                    }
                }
                transform.process_with_scratch(waves, &mut scratch);
                for (m, turn) in half_turn.iter().enumerate() {
                    let at = (component * samples + m) * points_z + start;
                    for z in 0..count {
                        let value = waves[z * samples + m] * turn;
                        (windows[0][at + z], windows[1][at + z]) = (value.re, value.im);
                    }
                }
            }
        }
        windows
    }
}

/// `e^(i angle)`
fn unit(angle: f64) -> Complex32 {
    Complex32::new(libm::cos(angle) as f32, libm::sin(angle) as f32)
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
    fn new(plan: &Plan, key: StreamKey, pair: i64, generation: usize, harmonic: usize) -> Self {
        // Independent eddies have phases of their own, carried ones a walk that goes on.
        let eddy = if plan.way.is_carried() { 0 } else { generation as u64 };
        let last = FIELD | eddy << 32 | harmonic as u64;
        let mut bytes = [0; 32];
        for (bytes, word) in bytes.chunks_exact_mut(8).zip([key.seed, key.replicate, pair as u64, last]) {
            bytes.copy_from_slice(&word.to_le_bytes());
        }
        let carried = plan.way.is_carried() && plan.turn > 0.0;
        let steps = if carried { plan.generations.len() - 1 } else { 0 };
        Self {
            stream: ChaCha8Rng::from_seed(bytes),
            generation: if carried { generation } else { 0 },
            words: steps.div_ceil(32),
            steps: plan.generations.len() - 1,
        }
    }

    /// Three white complex amplitudes of the modulus one at the age of the generation.              theory.md (84)
    #[inline(always)]
    fn next(&mut self, phases: &[Complex32], turns: &[Complex32]) -> [Complex32; 3] {
        let start = self.stream.next_u32();
        [0, 10, 20].map(|shift| {
            let phase = phases[(start >> shift) as usize % PHASES];
            let (mut forward, mut left) = (0, self.generation as u32);
            for _ in 0..self.words {
                let bits = left.min(32);
                let mask = if bits == 32 { u32::MAX } else { (1 << bits) - 1 };
                forward += (self.stream.next_u32() & mask).count_ones();
                left -= bits;
            }
            // Forward less backward.
            let net = 2 * forward as usize + self.steps - self.generation;
            phase * turns[net]
        })
    }
}
