//! Where the stations between inlet and belt are, and what turbulence each of them has.

use super::{Air, Eddies, EddyModel, EddyTurbulence};
use crate::field::Hint;
use crate::vec3::Vec3;

/// Most stations along the way.
const MOST: f64 = 2000.0;
/// Stations in a length scale of a carried pattern, and in the shortest wave.
const PER_LENGTH_SCALE: f64 = 4.0;
const PER_WAVE: f64 = 8.0;

/// Stations along x, the first half a spacing from the inlet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StationGrid {
    /// Number of stations, at least two.
    pub count: usize,
    /// Distance between two [m].
    pub spacing: f64,
}

impl StationGrid {
    /// Vector from the inlet to half a spacing below the last station [m].
    fn along(&self) -> Vec3<f64> {
        Vec3::new(self.spacing * self.count as f64, 0.0, 0.0)
    }

    /// The eddies, one for each station.
    pub fn eddies(&self) -> Eddies {
        Eddies::one_for_each(self.count)
    }
}

impl Air {
    /// The stations between an inlet and a belt at a distance [m] from it.
    ///
    /// Independent eddies have one in each length scale. A carried pattern has four in each length scale and
    /// eight in the shortest wave.
    pub fn stations(&self, distance: f64) -> StationGrid {
        const PLACES: usize = 64;
        let mut hint = Hint::default();
        let spacing = match self.eddies {
            EddyModel::Independent => self.length_scale,
            EddyModel::Convected { .. } => (0..PLACES)
                .map(|i| {
                    let x = distance * (i as f64 + 0.5) / PLACES as f64;
                    let air = self.local(Vec3::new(x, 0.0, 0.0), &mut hint);
                    let wave = air.velocity.norm() / air.cutoff_frequency;
                    let shortest = if wave > 0.0 { wave / PER_WAVE } else { f64::INFINITY };
                    shortest.min(air.length_scale / PER_LENGTH_SCALE)
                })
                .fold(f64::INFINITY, f64::min),
        };
        let count = (distance / spacing).ceil().clamp(1.0, MOST);
        StationGrid { count: count as usize + 1, spacing: spacing.max(distance / count) }
    }

    /// The turbulence at each station; its mean is zero. In a uniform flow it has the flow's rms, otherwise rms one.
    pub fn turbulence_at(&self, grid: &StationGrid) -> Vec<EddyTurbulence> {
        let mut turbulence = self.turbulence_along(grid.along(), grid.count, &grid.eddies());
        turbulence.iter_mut().for_each(|eddy| eddy.mean = 0.0);
        turbulence
    }

    /// Correlation of the signals of two neighbouring stations [-], the second of which is `lower`.
    pub(super) fn correlation(&self, upper: &EddyTurbulence, lower: &EddyTurbulence) -> f64 {
        let Some(time) = lower.carried else { return 0.0 };
        let (mut common, mut own) = (0.0, (0.0, 0.0));
        let spacing = std::f64::consts::TAU / self.repeat_time();
        for component in 0..3 {
            let amplitudes = [upper, lower].map(|end| end.spectrum(self, component).amplitudes());
            for (n, (a, b)) in amplitudes[0].iter().zip(&amplitudes[1]).enumerate() {
                common += a * b * libm::cos((n as f64 + 0.5) * spacing * time);
            }
            own.0 += amplitudes[0].iter().map(|a| a * a).sum::<f64>();
            own.1 += amplitudes[1].iter().map(|a| a * a).sum::<f64>();
        }
        let whole = (own.0 * own.1).sqrt();
        if whole > 0.0 { (common / whole * libm::exp(-lower.decay_times)).clamp(0.0, 1.0) } else { 1.0 }
    }
}
