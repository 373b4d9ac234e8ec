//! Curves that fibres have laid.

use crate::error::Fault;

/// Laid curves of one line, seen from their straight traces.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    spacing: f64,
    belt_ratio: f64,
    /// Of each curve the points (ξ₁, ξ₂) [m].
    curves: Vec<Vec<[f64; 2]>>,
    /// How far they hang together, if they were flown in one air.
    one_air: Option<OneAir>,
}

/// How far curves that were flown in one air hang together.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct OneAir {
    /// Number of the group of neighbours of each curve. Groups are so wide that one hardly knows of another.
    pub(crate) groups: Vec<usize>,
    /// Length of fed fibre after which gusts are forgotten [m].
    pub(crate) memory: f64,
}

impl Curves {
    /// Fewest pieces of a curve.
    const FEWEST: usize = 16;

    /// Curves from their points on the belt.
    ///
    /// * `spacing` – fed length from point to point [m]
    /// * `belt_ratio` – speed of the belt over speed of the feed
    /// * `curves` – of each fibre the places (md, cd) of its points on the belt [m], in the order of feed
    ///
    /// # Errors
    /// If there is no curve, or one of less than 16 pieces or with a point that is not finite.
    pub fn new(spacing: f64, belt_ratio: f64, mut curves: Vec<Vec<[f64; 2]>>) -> Result<Self, Fault> {
        let usable = |curve: &Vec<[f64; 2]>| {
            curve.len() > Self::FEWEST && curve.iter().flatten().all(|x| x.is_finite())
        };
        let known = spacing > 0.0 && spacing.is_finite() && belt_ratio > 0.0 && belt_ratio.is_finite();
        if !known || curves.is_empty() || !curves.iter().all(usable) {
            return Err(no_curves());
        }
        for curve in &mut curves {
            for (i, point) in curve.iter_mut().enumerate() {
                point[0] += belt_ratio * spacing * i as f64;
            }
            let middle = [0, 1].map(|axis| curve.iter().map(|p| p[axis]).sum::<f64>() / curve.len() as f64);
            for point in curve.iter_mut() {
                // The place under the nozzle is where the curve is on average.
                *point = [point[0] - middle[0], point[1] - middle[1]];
            }
        }
        Ok(Self { spacing, belt_ratio, curves, one_air: None })
    }

    /// The same curves, known to hang together.
    pub(crate) fn in_one_air(self, one_air: OneAir) -> Self {
        Self { one_air: Some(one_air), ..self }
    }

    pub(super) const fn one_air(&self) -> Option<&OneAir> {
        self.one_air.as_ref()
    }

    /// Fed length from point to point [m].
    pub const fn spacing(&self) -> f64 {
        self.spacing
    }

    /// Speed of the belt over speed of the feed.
    pub const fn belt_ratio(&self) -> f64 {
        self.belt_ratio
    }

    /// The points (ξ₁, ξ₂) of each curve [m].
    pub(super) fn curves(&self) -> &[Vec<[f64; 2]>] {
        &self.curves
    }

    /// Fed length of the shortest curve [m].
    pub(super) fn length(&self) -> f64 {
        self.curves.iter().map(|curve| curve.len() - 1).min().unwrap_or(0) as f64 * self.spacing
    }

    /// Spread about the straight trace in cross direction [m].
    pub(super) fn sigma_cd(&self) -> f64 {
        let points = self.curves.iter().map(Vec::len).sum::<usize>() as f64;
        (self.curves.iter().flatten().map(|p| p[1] * p[1]).sum::<f64>() / points).sqrt()
    }
}

/// The fault of curves that cannot be laid.
fn no_curves() -> Fault {
    Fault::new(
        "there are no laid curves, or they are too short: each needs more than 16 points at a spacing above zero",
        "fly the case for longer (run.duration)",
    )
}
