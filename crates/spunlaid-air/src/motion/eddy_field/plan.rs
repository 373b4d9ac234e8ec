//! The plan of a field: its lattice, its generations, and the shape of the turbulence in each.

use super::lattice::{Extent, Lattice, left, samples};
use super::way::{EddyPath, Stage};
use crate::motion::{Air, Spectrum};
use std::array::from_fn;
use std::f64::consts::{SQRT_2, TAU};
use std::sync::Arc;

/// Wave number of the energy in von Kármán's turbulence, times the length scale. theory.md (79)
const ENERGY_WAVE: f64 = 0.746834;
/// Fewest harmonics, and fewest of the generation with the lowest cut-off frequency.
const FEWEST: [f64; 2] = [64.0, 10.0];
/// Samples more than are looked at around a place.
const MARGIN: f64 = 12.0;
/// Blocks of time in a repeat time.
pub(super) const BLOCKS: f64 = 8.0;

/// How a field is made and how it is read.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Plan {
    pub(super) way: EddyPath,
    pub(super) lattice: Lattice,
    /// Largest wave number across of the modes that fields of a larger one have in common with this [1/m].
    pub(super) in_common: f64,
    /// Time after which the harmonics repeat with the opposite sign [s].
    pub(super) repeat_time: f64,
    pub(super) generations: Vec<Generation>,
    /// Correlation of each generation with the next, of each component; one where there is none.
    pub(super) correlations: Vec<[f64; 3]>,
    /// Angle by which the phase of a mode turns from one generation to the next, to either side.      theory.md (82)
    pub(super) turn: f64,
}

/// The shape of the turbulence at one age.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Generation {
    /// Travel time from the inlet [s].
    pub(super) travel: f64,
    /// Samples in a repeat time.
    pub(super) samples: usize,
    /// Samples per time [1/s].
    pub(super) samples_per_time: f64,
    /// Of each harmonic.
    pub(super) harmonics: Arc<Vec<Harmonic>>,
}

/// The shape of the turbulence at one frequency.                                                    theory.md (79)
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Harmonic {
    /// Wave number along the flow [1/m]; negative, because the phase of a wave that is carried is `ωc = ωt − (ω/U)x`.
    pub(super) wave_number: f64,
    /// Factor of each component.
    pub(super) scale: [f32; 3],
    /// Amplitudes `|k| (k² + k_e²)^(−17/12)` of modes by their numbers of waves along y and z, zero and
    /// above, with what the interpolation takes away added. `[waves along y][waves along z]`
    pub(super) amplitudes: Vec<f32>,
}

impl Plan {
    /// * `cutoff`, `in_common` – largest wave number across, of all modes and of those that fields of a larger cut-off
    ///   have in common with this one, times the length scale [-]
    pub(super) fn new(air: &Air, way: EddyPath, extent: Extent, [cutoff, in_common]: [f64; 2]) -> Self {
        let (lattice, harmonics) = sizes(&way, extent, cutoff);
        let in_common = lattice.largest * in_common / cutoff;
        let highest = way.stages.iter().map(|stage| stage.cutoff_frequency).fold(0.0, f64::max);
        let repeat_time = harmonics as f64 / highest;
        let shapes: Vec<Shape> =
            way.stages.iter().map(|stage| Shape::new(air, stage, &lattice, repeat_time)).collect();
        // The interpolated pattern remembers longer than the walk by 1 + 0.34 Δ; longer steps make up for it.
        let ageing = way.ageing * (1.0 + way.ageing / 3.0 + 0.18 * way.ageing * way.ageing);
        let walk = if way.is_carried() { libm::exp(-ageing) } else { 0.0 };
        let next = |j: usize| shapes.get(j + 1).filter(|_| way.is_carried());
        let correlation =
            |j: usize| next(j).map_or([1.0; 3], |next| shapes[j].overlap(next).map(|part| part * walk));
        let correlations = (0..shapes.len()).map(correlation).collect();
        let generations = shapes.into_iter().map(|shape| shape.generation).collect();
        Self { way, lattice, in_common, repeat_time, generations, correlations, turn: libm::acos(walk) }
    }

    /// The same plan on a way on which its pattern passes faster or slower; None if the way has another pattern.
    pub(super) fn on_way(&self, way: EddyPath) -> Option<Self> {
        let pace = way.pace_of(&self.way)?;
        let generation = |(of, stage): (&Generation, &Stage)| Generation {
            travel: stage.travel,
            samples_per_time: of.samples_per_time * pace,
            ..of.clone()
        };
        let generations = self.generations.iter().zip(&way.stages).map(generation).collect();
        Some(Self { generations, repeat_time: self.repeat_time / pace, way, ..self.clone() })
    }

    /// Time from sample to sample of a generation [s].
    pub(super) fn spacing(&self, generation: usize) -> f64 {
        self.repeat_time / self.generations[generation].samples as f64
    }

    /// Time of a field at which a fibre begins, so that the first windows are in full strength there and all that is
    /// looked at before [s].
    pub(super) fn start_of_fibre(&self) -> f64 {
        let of = |j| self.way.travels(j)[1] + 0.25 * self.repeat_time + MARGIN * self.spacing(j);
        (0..self.generations.len()).map(of).fold(0.0, f64::max)
    }

    /// Time that a pair of windows lasts [s].
    pub(super) fn pair(&self) -> f64 {
        1.5 * self.repeat_time
    }

    /// A good length of the blocks of time for which a field is made [s].
    pub(super) fn block(&self) -> f64 {
        self.repeat_time / BLOCKS
    }
}

/// The lattice and the number of harmonics up to the highest cut-off frequency.
pub(super) fn sizes(way: &EddyPath, extent: Extent, cutoff: f64) -> (Lattice, usize) {
    let smallest = way.stages.iter().map(|stage| stage.length_scale).fold(f64::INFINITY, f64::min);
    let cutoffs = way.stages.iter().map(|stage| stage.cutoff_frequency);
    let (lowest, highest) =
        cutoffs.fold((f64::INFINITY, 0.0_f64), |(low, high), f| (low.min(f), high.max(f)));
    let harmonics = FEWEST[0].max(FEWEST[1] * highest / lowest).ceil() as usize;
    (Lattice::new(extent, cutoff / smallest), harmonics)
}

/// A generation, and what is needed to compare it with the next.
struct Shape {
    generation: Generation,
    /// Modes with each pair of numbers of waves, zero and above.
    modes: Vec<Mode>,
}

/// Modes that differ in the signs of their wave numbers only.
#[derive(Clone, Copy)]
struct Mode {
    /// Where its amplitude is.
    index: usize,
    count: f64,
    /// Wave numbers along y and z [1/m].
    across: [f64; 2],
    /// What the interpolation leaves of its rms.
    left: f64,
    /// Whether it is the only one of its frequency.
    is_alone: bool,
}

impl Shape {
    fn new(air: &Air, stage: &Stage, lattice: &Lattice, repeat_time: f64) -> Self {
        let integral_time = stage.length_scale / stage.speed;
        let amplitudes = [0, 1, 2].map(|component| {
            let cutoff = stage.cutoff_frequency;
            Spectrum::new(&air.spectrum, 1.0, cutoff, integral_time, component, 1.0 / repeat_time)
                .amplitudes()
        });
        let modes = modes(lattice);
        let columns = lattice.most_waves()[1] as usize + 1;
        let size = (lattice.most_waves()[0] as usize + 1) * columns;
        let samples = samples(amplitudes[0].len());
        let energy_wave = ENERGY_WAVE / stage.length_scale;
        let harmonic = |n: usize| {
            let turn = TAU * (n as f64 + 0.5);
            let wave_number = -turn / repeat_time / stage.speed;
            let left_in_time = left(turn / samples as f64);
            let mut of_modes = vec![0.0_f32; size];
            let mut energy = [0.0; 3];
            for mode in &modes {
                let square = wave_number * wave_number + mode.across[0].powi(2) + mode.across[1].powi(2);
                let amplitude = square.sqrt() * libm::pow(square + energy_wave * energy_wave, -17.0 / 12.0);
                of_modes[mode.index] = (amplitude / (mode.left * left_in_time)) as f32;
                for (energy, row) in energy.iter_mut().zip(mode.projection(wave_number)) {
                    *energy += mode.count * amplitude * amplitude * row.iter().map(|p| p * p).sum::<f64>();
                }
            }
            let scale = |i: usize| match energy[i] > 0.0 {
                true => SQRT_2 * amplitudes[i][n] / energy[i].sqrt(),
                false => 0.0,
            };
            Harmonic { wave_number, scale: [0, 1, 2].map(|i| scale(i) as f32), amplitudes: of_modes }
        };
        let harmonics = Arc::new((0..amplitudes[0].len()).map(harmonic).collect());
        let samples_per_time = samples as f64 / repeat_time;
        Self { generation: Generation { travel: stage.travel, samples, samples_per_time, harmonics }, modes }
    }

    /// Correlation of two shapes with the same random phases, of each component.                    theory.md (81)
    fn overlap(&self, next: &Self) -> [f64; 3] {
        let [mut common, mut own, mut others] = [[0.0; 3]; 3];
        let shapes = [self, next].map(|shape| &shape.generation);
        let left_in_time = |g: &Generation, n: usize| left(TAU * (n as f64 + 0.5) / g.samples as f64);
        let count = shapes[0].harmonics.len().max(shapes[1].harmonics.len());
        for n in 0..count {
            let harmonics = shapes.map(|g| g.harmonics.get(n).map(|harmonic| (harmonic, left_in_time(g, n))));
            for mode in &self.modes {
                // The three parts of each component, one for each of the random amplitudes.
                let parts: [[[f64; 3]; 3]; 2] = from_fn(|of| {
                    harmonics[of].map_or([[0.0; 3]; 3], |(harmonic, left_in_time)| {
                        let amplitude = f64::from(harmonic.amplitudes[mode.index]) * mode.left * left_in_time;
                        let projection = mode.projection(harmonic.wave_number);
                        from_fn(|i| from_fn(|m| projection[i][m] * amplitude * f64::from(harmonic.scale[i])))
                    })
                });
                let entries = parts[0].as_flattened().iter().zip(parts[1].as_flattened());
                for (entry, (a, b)) in entries.enumerate() {
                    let i = entry / 3;
                    common[i] += mode.count * a * b;
                    own[i] += mode.count * a * a;
                    others[i] += mode.count * b * b;
                }
            }
        }
        [0, 1, 2].map(|i| {
            let whole = (own[i] * others[i]).sqrt();
            if whole > 0.0 { (common[i] / whole).clamp(0.0, 1.0) } else { 1.0 }
        })
    }
}

/// The modes of a lattice with numbers of waves of zero and above.
fn modes(lattice: &Lattice) -> Vec<Mode> {
    let most = lattice.most_waves();
    let units = lattice.wave_number_units();
    let mut modes = Vec::new();
    for waves_y in 0..=most[0] {
        for waves_z in 0..=lattice.waves_beside(waves_y).unwrap_or(-1) {
            let signs = |waves: i64| if waves == 0 { 1.0 } else { 2.0 };
            modes.push(Mode {
                index: waves_y as usize * (most[1] as usize + 1) + waves_z as usize,
                count: signs(waves_y) * signs(waves_z),
                across: [waves_y as f64 * units[0], waves_z as f64 * units[1]],
                left: lattice.left([waves_y, waves_z]),
                is_alone: lattice.is_uniform(),
            });
        }
    }
    modes
}

impl Mode {
    fn projection(&self, wave_number: f64) -> [[f64; 3]; 3] {
        projection([wave_number, self.across[0], self.across[1]], self.is_alone)
    }
}

/// `δ_im − k_i k_m/k²`, which leaves nothing along the wave vector: the air keeps its volume.
///
/// * `is_alone` – whether the field is the same everywhere across. Then nothing is taken away, because
///   nothing would be left of the component along the flow.
#[inline(always)]
pub(super) fn projection(k: [f64; 3], is_alone: bool) -> [[f64; 3]; 3] {
    let square = k[0] * k[0] + k[1] * k[1] + k[2] * k[2];
    let per_square = if is_alone { 0.0 } else { 1.0 / square };
    let [x, y, z] = k;
    let less = |whole: f64, product: f64| whole - product * per_square;
    let xy = less(0.0, x * y);
    let xz = less(0.0, x * z);
    let yz = less(0.0, y * z);
    [[less(1.0, x * x), xy, xz], [xy, less(1.0, y * y), yz], [xz, yz, less(1.0, z * z)]]
}
