//! The directions of the fibres in a web.

use super::Web;
use super::laying::LayControl;
use super::plan::plans;
use crate::error::Error;
use crate::lanes::WIDTH;
use crate::statistics::Estimate;

/// Directions of the pieces of some filaments on the belt, each piece with its mass.
#[derive(Clone, Debug, PartialEq)]
pub struct Orientation {
    /// `⟨cos²⟩` of the angle to the machine direction of each filament: ½ without orientation.
    pub cos_squared: Estimate,
    /// Share of the mass by direction: entry i holds angles to the machine direction from 10i to 10(i+1)
    /// degrees, positive towards the cross direction, in the sense in which the fibre was fed.
    pub directions: [f64; Self::DIRECTIONS],
}

impl Orientation {
    /// Number of classes of direction.
    pub const DIRECTIONS: usize = 36;

    /// Mass along the machine direction over mass along the cross direction, `⟨cos²⟩/⟨sin²⟩`.
    pub fn md_cd_ratio(&self) -> f64 {
        self.cos_squared.mean / (1.0 - self.cos_squared.mean)
    }
}

/// Filaments of a layer that are looked at.
const SAMPLE: usize = 8 * WIDTH;

/// Directions of the web, from up to 64 filaments of each layer, spread over its width.
///
/// # Errors
/// As [`lay`](super::lay).
pub fn orientation(web: &Web, by: LayControl<'_>) -> Result<Orientation, Error> {
    let (mut values, mut directions, mut whole) = (Vec::new(), [0.0; Orientation::DIRECTIONS], 0.0);
    for plan in &plans(web)? {
        let groups = plan.places.len().div_ceil(WIDTH);
        let weight = plan.layer.basis_weight(&web.sheet) / web.basis_weight();
        let advance = plan.layer.belt_ratio() * plan.piece;
        let mut of_layer = Vec::new();
        let mut counts = [0u64; Orientation::DIRECTIONS];
        for group in (0..groups).step_by(groups.div_ceil(SAMPLE / WIDTH).max(1)) {
            let (first, count) = (group * WIDTH, WIDTH.min(plan.places.len() - group * WIDTH));
            let mut sums = [(0u64, 0.0); WIDTH];
            plan.walk(web, first, count, by, |points| {
                for pair in points.windows(2) {
                    for (lane, sum) in sums.iter_mut().enumerate().take(count) {
                        let md = pair[1][0].0[lane] - pair[0][0].0[lane] - advance;
                        let cd = pair[1][1].0[lane] - pair[0][1].0[lane];
                        let squared = md * md + cd * cd;
                        if squared > 0.0 {
                            *sum = (sum.0 + 1, sum.1 + md * md / squared);
                            let turn = libm::atan2(cd, md) / (2.0 * std::f64::consts::PI);
                            let class = ((turn + 1.0).fract() * Orientation::DIRECTIONS as f64) as usize;
                            counts[class.min(Orientation::DIRECTIONS - 1)] += 1;
                        }
                    }
                }
            })?;
            of_layer.extend(sums.iter().take(count).filter(|sum| sum.0 > 0).map(|sum| sum.1 / sum.0 as f64));
        }
        let total: u64 = counts.iter().sum();
        for (direction, count) in directions.iter_mut().zip(counts) {
            *direction += weight * count as f64 / total.max(1) as f64;
        }
        values.push((weight, of_layer));
        whole += weight;
    }
    // Each value stands for its layer's share of the mass.
    let count = values.iter().map(|(_, shares)| shares.len()).min().unwrap_or(0);
    let mixed = |i: usize| values.iter().map(|(weight, shares)| weight * shares[i] / whole).sum::<f64>();
    Ok(Orientation { cos_squared: Estimate::new((0..count).map(mixed).collect()), directions })
}
