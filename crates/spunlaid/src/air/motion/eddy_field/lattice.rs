//! The lattice on which a field is kept, across the way and in time.

use std::f64::consts::{PI, TAU};

/// Share of the highest wave number that a lattice can carry.
const CARRIED: f64 = 0.8;
/// Samples in the shortest period of a generation.
const SAMPLES_IN_PERIOD: usize = 4;

/// The distances after which a field repeats itself across the way [m].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Along y, the machine direction.
    pub y: f64,
    /// Along z, the cross direction.
    pub z: f64,
}

/// The points of a field across the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lattice {
    pub(super) extent: Extent,
    /// Number of points along y and z.
    pub(super) points: [usize; 2],
    /// Largest wave number across [1/m].
    pub(super) largest: f64,
}

impl Lattice {
    /// * `largest` – wave number across [1/m]; zero for a field that is the same everywhere across
    pub(super) fn new(extent: Extent, largest: f64) -> Self {
        let spacing = CARRIED * PI / largest;
        let points = [extent.y, extent.z].map(|extent| smooth((extent / spacing).ceil() as usize));
        Self { extent, points, largest }
    }

    /// Whether a field is the same everywhere across.
    pub(super) fn is_uniform(&self) -> bool {
        self.most_waves() == [0, 0]
    }

    /// The numbers of waves along z that go with a number of waves along y, from `-n` to `n`; none if the
    /// latter alone is too large.
    pub(super) fn waves_beside(&self, waves_y: i64) -> Option<i64> {
        let [y, z] = self.wave_number_units();
        let left = self.largest * self.largest - (waves_y as f64 * y).powi(2);
        (left >= 0.0).then(|| (left.sqrt() / z + 1e-9) as i64)
    }

    /// Most waves along y.
    pub(super) fn most_waves(&self) -> [i64; 2] {
        self.wave_number_units().map(|unit| (self.largest / unit + 1e-9) as i64)
    }

    /// Wave numbers of one wave along y and z [1/m].
    pub(super) fn wave_number_units(&self) -> [f64; 2] {
        [TAU / self.extent.y, TAU / self.extent.z]
    }

    /// What the interpolation leaves of the rms of waves: along y, and along z.
    pub(super) fn left(&self, waves: [i64; 2]) -> f64 {
        let each = [0, 1].map(|axis| left(TAU * waves[axis] as f64 / self.points[axis] as f64));
        each[0] * each[1]
    }
}

/// Samples of a generation with so many harmonics in the time after which they repeat; a multiple of four.
pub(super) fn samples(harmonics: usize) -> usize {
    4 * smooth(harmonics * SAMPLES_IN_PERIOD / 4)
}

/// Rms that cubic B-splines leave of a wave of rms one, averaged over the phase.
///
/// * `turn` – phase from point to point [rad]
pub(super) fn left(turn: f64) -> f64 {
    let cos = |times: f64| libm::cos(times * turn);
    ((2416.0 + 2382.0 * cos(1.0) + 240.0 * cos(2.0) + 2.0 * cos(3.0)) / 5040.0).sqrt()
}

/// The smallest number without other factors than 2, 3 and 5 that is not below `least`.
fn smooth(least: usize) -> usize {
    let is_smooth = |mut number: usize| {
        for factor in [2, 3, 5] {
            while number.is_multiple_of(factor) {
                number /= factor;
            }
        }
        number == 1
    };
    (least.max(1)..).find(|number| is_smooth(*number)).unwrap_or(least)
}

/// Samples before a place that its interpolation needs, and all that it needs.
pub(super) const BEFORE: i64 = 1;
pub(super) const NEEDED: usize = 4;
/// Samples, or points, that a piece repeats of the one beside it, so that those around a place lie side by side.
pub(super) const REPEATED: usize = NEEDED - 1;
/// Points along z in a brick. In a row of all points the samples around a place would lie far apart in memory.
pub(super) const BRICK: usize = 32;
/// Numbers of a sample in a brick, with the points that it repeats of the next one.
pub(super) const ROW: usize = 3 * (BRICK + REPEATED);
/// Numbers that are read for a sample: four points of three components, and what follows them.
pub(super) const READ: usize = 16;
/// Numbers in a line of a block. What follows the last point is read, but does not count.
pub(super) fn line_size(samples: usize, points: usize) -> usize {
    points.div_ceil(BRICK) * samples * ROW + READ - 3 * NEEDED
}
