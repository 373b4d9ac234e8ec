//! What would make a web more even.

use super::laying::LayControl;
use super::one_fibre::{OneFibre, one_fibre};
use super::{Curves, Fibres, Layer, Web};
use crate::error::Error;
use crate::statistics::Estimate;
use crate::surrogate::Surrogate;
use crate::threads::try_each;
use std::sync::Arc;

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
        if self == Self::BeltSpeed {
            turned.belt_speed *= factor;
        }
        let ratio = turned.belt_ratio();
        match (self, &mut turned.fibres) {
            (Self::Filaments, _) | (Self::BeltSpeed, Fibres::Surrogate(_)) => {}
            (Self::SigmaMd, Fibres::Surrogate(Surrogate { sigma_md, .. })) => *sigma_md *= factor,
            (Self::SigmaCd, Fibres::Surrogate(Surrogate { sigma_cd, .. })) => *sigma_cd *= factor,
            (Self::Noise, Fibres::Surrogate(Surrogate { noise, .. })) => *noise *= factor,
            (Self::BeltSpeed, Fibres::Curves(curves)) => *curves = Arc::new(curves.on_belt(ratio)?),
            (_, Fibres::Curves(_)) => return None,
        }
        Some(turned)
    }

    /// The layer with the number divided and multiplied by the same factor, and what they rest on: flown curves where these let the number
    /// change and reach over the largest patch, and else the surrogate.
    ///
    /// * `largest` – side of the largest patch [m]
    fn both(self, layer: &Layer, factor: f64, largest: f64) -> Option<(Source, [Layer; 2])> {
        let fibres = [Some(&layer.fibres), layer.other_description.as_ref()].into_iter().flatten();
        let both = |fibres: &Fibres| {
            let changed = Layer { fibres: fibres.clone(), ..layer.clone() };
            let [less, more] = [factor.recip(), factor].map(|factor| self.turned(&changed, factor));
            Some([less?, more?])
        };
        let long_enough = |curves: &Arc<Curves>| curves.length() * layer.belt_ratio() / factor > largest;
        let flown = fibres
            .clone()
            .find(|fibres| matches!(fibres, Fibres::Curves(curves) if long_enough(curves)))
            .and_then(both)
            .map(|both| (Source::FlownFibres, both));
        let surrogate = || {
            let surrogate = fibres.clone().find(|fibres| matches!(fibres, Fibres::Surrogate(_)))?;
            Some((Source::Surrogate, both(surrogate)?))
        };
        match self {
            Self::Filaments => Some((Source::Law, [layer.clone(), layer.clone()])),
            _ => flown.or_else(surrogate),
        }
    }
}

/// What a sensitivity rests on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// The curves that were flown, each with the number before and after. For the speed of the belt see [`Curves::on_belt`].
    FlownFibres,
    /// Paths of the surrogate.
    Surrogate,
    /// A law that holds for all curves.
    Law,
}

impl Source {
    /// Name in results: `flown`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FlownFibres => "flown",
            Self::Surrogate => "surrogate",
            Self::Law => "law",
        }
    }
}

/// By how many per cent the unevenness over patches changes when a number of the first layer's line changes by one per cent.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// The number.
    pub lever: Lever,
    /// What it rests on.
    pub source: Source,
    /// `d ln CV / d ln number` for each side of a patch, over the fibres. None where it would come from a surrogate whose CV is
    /// [far](super::PatchFindings::surrogate_is_far) from that of the flown curves, and for the speed of a belt that
    /// [changes the flight](Layer::belt_changes_flight).
    pub elasticity: Vec<Option<Estimate>>,
}

/// Belt speed over feed speed above which the sensitivity to it is not told. docs/validation.md has what was measured: up to here the
/// moved curves have that of curves that are flown anew.
const SLOW: f64 = 0.1;

impl Layer {
    /// Whether the belt is so fast that the flight changes with its speed: it pulls at the fibre in the air, and neither
    /// [moved curves](Curves::on_belt) nor a surrogate that stays as it is say what a faster one would do.
    pub fn belt_changes_flight(&self) -> bool {
        self.belt_ratio() > SLOW
    }
}

/// Relative change of a number.
const STEP: f64 = 0.1;

/// Sensitivities of the unevenness of a web of one layer, from single fibres with the same random numbers before and after, or from
/// flown curves where there are some and they let the number change.
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
    sample: OneFibre,
    by: LayControl<'_>,
) -> Result<Vec<Sensitivity>, Error> {
    let mut found = Vec::new();
    let [layer] = &web.layers[..] else {
        return Ok(found);
    };
    let largest = sides.iter().copied().max().unwrap_or(1) as f64 * sample.cell;
    let both = |lever: Lever| Some((lever, lever.both(layer, 1.0 + STEP, largest + sample.cell)?));
    let turned: Vec<(Lever, (Source, [Layer; 2]))> = Lever::ALL.into_iter().filter_map(both).collect();
    let of_both: Vec<Vec<Estimate>> = try_each(by.threads, 2 * turned.len(), |i| {
        let (lever, (_, layers)) = &turned[i / 2];
        // The effect of the number of filaments follows from a known law. A fast belt changes the flight, so its effect is not given.
        if *lever == Lever::Filaments || (*lever == Lever::BeltSpeed && layer.belt_changes_flight()) {
            return Ok(Vec::new());
        }
        let found = one_fibre(&layers[i % 2], sides, sample, by)?;
        Ok(found.iter().map(|alone| alone.estimate(&layer.filaments).clone()).collect())
    })?;
    for ((lever, (source, _)), of_both) in turned.into_iter().zip(of_both.chunks_exact(2)) {
        let elasticity = if lever == Lever::BeltSpeed && layer.belt_changes_flight() {
            vec![None; sides.len()]
        } else if lever == Lever::Filaments {
            // Independent filaments: the variance goes with one over their number.
            vec![Some(Estimate { mean: -0.5, standard_error: None, values: Vec::new() }); sides.len()]
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
                Some(Estimate { mean, ..Estimate::new(parts) })
            };
            of_both[0].iter().zip(&of_both[1]).map(of_side).collect()
        };
        found.push(Sensitivity { lever, source, elasticity });
    }
    Ok(found)
}
