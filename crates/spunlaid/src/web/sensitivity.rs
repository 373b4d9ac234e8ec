//! What would make a web more even.

use super::lay::Laying;
use super::one_fibre::{OneFibre, one_fibre};
use super::threads::each;
use super::{Fibres, Layer, Web};
use crate::error::Error;
use crate::statistics::Estimate;
use crate::surrogate::Surrogate;

/// A number of a line that changes the unevenness of its web.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lever {
    /// Spread of the lay-down in machine direction.
    SigmaMd,
    /// Spread of the lay-down in cross direction.
    SigmaCd,
    /// Noise of the direction.
    Noise,
    /// Speed of the belt; the basis weight falls as it rises.
    BeltSpeed,
    /// Number of filaments; the basis weight rises with it.
    Filaments,
}

impl Lever {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::SigmaMd, Self::SigmaCd, Self::Noise, Self::BeltSpeed, Self::Filaments];

    /// Name in results: `sigma_md`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::SigmaMd => "sigma_md",
            Self::SigmaCd => "sigma_cd",
            Self::Noise => "noise",
            Self::BeltSpeed => "belt_speed",
            Self::Filaments => "filaments",
        }
    }

    /// The layer with the number times a factor; None if its curves do not let it change.
    fn turned(self, layer: &Layer, factor: f64) -> Option<Layer> {
        let mut turned = layer.clone();
        match (self, &mut turned.fibres) {
            (Self::Filaments, _) => {}
            (Self::BeltSpeed, Fibres::Surrogate(_)) => turned.belt_speed *= factor,
            (Self::SigmaMd, Fibres::Surrogate(Surrogate { sigma_md, .. })) => *sigma_md *= factor,
            (Self::SigmaCd, Fibres::Surrogate(Surrogate { sigma_cd, .. })) => *sigma_cd *= factor,
            (Self::Noise, Fibres::Surrogate(Surrogate { noise, .. })) => *noise *= factor,
            (_, Fibres::Curves(_)) => return None,
        }
        Some(turned)
    }
}

/// By how many per cent the unevenness over patches changes when a number of the first layer's line changes by one per cent.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// The number.
    pub lever: Lever,
    /// `d ln CV / d ln number` for each side of a patch, over the fibres.
    pub elasticity: Vec<Estimate>,
}

/// Relative change of a number.
const STEP: f64 = 0.1;

/// Sensitivities of the unevenness of a web of one layer, from single fibres with the same random numbers before and after.
///
/// They say what a number does while the others stay. Basis weight is not held: with more filaments it rises, with a
/// faster belt it falls.
///
/// * `sides` – of the patches [cells]
///
/// # Errors
/// As [`one_fibre`].
pub fn sensitivities(
    web: &Web,
    sides: &[usize],
    of: OneFibre,
    by: Laying<'_>,
) -> Result<Vec<Sensitivity>, Error> {
    let mut found = Vec::new();
    let [layer] = &web.layers[..] else {
        return Ok(found);
    };
    let factors = [1.0 / (1.0 + STEP), 1.0 + STEP];
    let turned: Vec<(Lever, [Layer; 2])> = Lever::ALL
        .into_iter()
        .filter_map(|lever| {
            let [less, more] = factors.map(|factor| lever.turned(layer, factor));
            Some((lever, [less?, more?]))
        })
        .collect();
    let of_both: Vec<Vec<Estimate>> = each(by.threads, 2 * turned.len(), |i| {
        let (lever, layers) = &turned[i / 2];
        // Of the number of filaments, the law is known.
        if *lever == Lever::Filaments {
            return Ok(Vec::new());
        }
        let found = one_fibre(&layers[i % 2], sides, of, by)?;
        Ok(found.iter().map(|alone| alone.of(&layer.filaments).clone()).collect())
    })?;
    for ((lever, _), of_both) in turned.into_iter().zip(of_both.chunks_exact(2)) {
        let elasticity = if lever == Lever::Filaments {
            // Independent filaments: the variance goes with one over their number.
            vec![Estimate { mean: -0.5, standard_error: None, values: Vec::new() }; sides.len()]
        } else {
            // CV² is CV²τ/τ, and τ goes with one over the speed of the belt.
            let thinner = if lever == Lever::BeltSpeed { 2.0 * libm::log1p(STEP) } else { 0.0 };
            let of_side = |(less, more): (&Estimate, &Estimate)| {
                let change = |less: f64, more: f64| {
                    0.5 * (libm::log(more / less) + thinner) / (2.0 * libm::log1p(STEP))
                };
                // The logarithm of a mean and not the mean of logarithms: each fibre's part of the change.
                let mean = change(less.mean, more.mean);
                let part = |(l, m): (&f64, &f64)| {
                    mean + 0.5 * (m / more.mean - l / less.mean) / (2.0 * libm::log1p(STEP))
                };
                let parts = less.values.iter().zip(&more.values).map(part).collect();
                Estimate { mean, ..Estimate::of(parts) }
            };
            of_both[0].iter().zip(&of_both[1]).map(of_side).collect()
        };
        found.push(Sensitivity { lever, elasticity });
    }
    Ok(found)
}
