//! How much memory fields take, before any is made.

use super::lattice::{Extent, Lattice, samples};
use super::plan::{BLOCKS, sizes};
use super::way::EddyPath;
use super::{synthesis, tape};

/// The most memory that so many fields take, of which one at a time is made in such blocks [bytes].
pub(super) fn memory(fields: u64, way: &EddyPath, extent: Extent, cutoff: f64) -> f64 {
    let (lattice, harmonics) = sizes(way, extent, cutoff);
    let highest = way.stages.iter().map(|stage| stage.cutoff_frequency).fold(0.0, f64::max);
    let (mut kept, mut making) = (0.0, 0.0_f64);
    for (j, stage) in way.stages.iter().enumerate() {
        let of_stage = harmonics as f64 * stage.cutoff_frequency / highest;
        let samples = samples(of_stage.ceil() as usize);
        let [youngest, oldest] = way.travels(j);
        let looked_at = samples as f64 * (1.0 / BLOCKS + (oldest - youngest) * highest / harmonics as f64);
        kept += tape::memory(&lattice, samples, looked_at) + of_stage * amplitudes_memory(&lattice);
        making =
            making.max(synthesis::memory(&lattice, of_stage) + tape::memory_while_joining(&lattice, samples));
    }
    kept * fields as f64 + making
}

/// Memory of the amplitudes of a harmonic [bytes].
fn amplitudes_memory(lattice: &Lattice) -> f64 {
    let [y, z] = lattice.most_waves().map(|most| (most + 1) as f64);
    y * z * size_of::<f32>() as f64
}
