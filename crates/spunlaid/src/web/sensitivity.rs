//! What would make a web more even.

use super::laying::LayControl;
use super::one_fibre::{OneFibre, one_fibre};
use super::{Curves, Fibres, Layer, Web};
use crate::effects::{Change, Effect, Setting, Tried};
use crate::error::Error;
use crate::statistics::{Difference, Estimate};
use crate::surrogate::Surrogate;
use crate::threads::try_each;
use std::sync::Arc;

/// A number of a line that changes the unevenness of its web.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Lever {
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
    /// All of them, as they are called.
    const ALL: [(Self, &'static str, &'static str); 5] = [
        (Self::SigmaMd, "sigma_md", "spread of the lay-down in machine direction, σ MD"),
        (Self::SigmaCd, "sigma_cd", "spread of the lay-down in cross direction, σ CD"),
        (Self::Noise, "noise", "noise of the direction, A"),
        (Self::BeltSpeed, "belt_speed", "belt speed"),
        (Self::Filaments, "filaments", "filaments"),
    ];

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

    /// The layer with the number divided and multiplied by the same factor, and what they rest on: flown
    /// curves where these let the number change and reach over the largest patch, and else the surrogate.
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
    /// The curves that were flown, each with the number before and after. For the speed of the belt see
    /// [`Curves::on_belt`].
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

/// By how many per cent the unevenness over patches changes when a number of the first layer's line changes
/// by one per cent: `d ln CV / d ln number` over the fibres, for each side of a patch [m]. It has no effect
/// where it would come from a surrogate whose CV is [far](super::PatchFindings::surrogate_is_far) from that
/// of the flown curves, and none of the speed of a belt that [changes the
/// flight](Layer::belt_changes_flight).
pub type Sensitivity = Tried<Source, f64>;

/// Belt speed over feed speed above which the sensitivity to it is not told. docs/validation.md has what was
/// measured: up to here the moved curves have that of curves that are flown anew.
const SLOW: f64 = 0.1;

impl Layer {
    /// Whether the belt is so fast that the flight changes with its speed: it pulls at the fibre in the air,
    /// and neither [moved curves](Curves::on_belt) nor a surrogate that stays as it is say what a faster one
    /// would do.
    pub fn belt_changes_flight(&self) -> bool {
        self.belt_ratio() > SLOW
    }
}

/// Relative change of a number.
const STEP: f64 = 0.1;

/// Sensitivities of the unevenness of a web of one layer, from single fibres with the same random numbers
/// before and after, or from flown curves where there are some and they let the number change.
///
/// They say what a number does while the others stay. Basis weight is not held: with more filaments it rises, with a
/// faster belt it falls.
///
/// * `patches` – sides of the patches [m], and the same in cells
///
/// # Errors
/// As [`one_fibre`].
pub fn sensitivities(
    web: &Web,
    patches: &[(f64, usize)],
    sample: OneFibre,
    by: LayControl<'_>,
) -> Result<Vec<Sensitivity>, Error> {
    let [layer] = &web.layers[..] else {
        return Ok(Vec::new());
    };
    let sides: Vec<usize> = patches.iter().map(|(_, side)| *side).collect();
    let largest = sides.iter().copied().max().unwrap_or(1) as f64 * sample.cell;
    let both = |(lever, name, words)| {
        let (experiment, layers) = Lever::both(lever, layer, 1.0 + STEP, largest + sample.cell)?;
        let (setting, keys) = (Setting { name, words }, Vec::new());
        let change = Change { setting, layers: Vec::new(), keys, experiment, refusal: None };
        Some((lever, change, layers))
    };
    let turned: Vec<(Lever, Change<Source>, [Layer; 2])> = Lever::ALL.into_iter().filter_map(both).collect();
    // The effect of the number of filaments follows from a known law. A fast belt changes the flight, so its
    // effect is not given.
    let is_laid = |lever: Lever| {
        !(lever == Lever::Filaments || lever == Lever::BeltSpeed && layer.belt_changes_flight())
    };
    let of_both: Vec<Vec<Estimate>> = try_each(by.threads, 2 * turned.len(), |i| {
        let (lever, _, layers) = &turned[i / 2];
        if !is_laid(*lever) {
            return Ok(Vec::new());
        }
        let found = one_fibre(&layers[i % 2], &sides, sample, by)?;
        Ok(found.iter().map(|alone| alone.estimate(&layer.filaments).clone()).collect())
    })?;
    let of_lever = |((lever, change, _), of_both): ((Lever, Change<Source>, _), &[Vec<Estimate>])| {
        let effects = patches.iter().enumerate().filter_map(|(i, (patch, _))| {
            let difference = match lever {
                // Independent filaments: the variance goes with one over their number.
                Lever::Filaments => Difference::exact(-0.5),
                _ => elasticity(lever, [of_both[0].get(i)?, of_both[1].get(i)?]),
            };
            Some(Effect::new(*patch, difference))
        });
        Tried { change, effects: effects.collect(), at_first: Vec::new() }
    };
    Ok(turned.into_iter().zip(of_both.chunks_exact(2)).map(of_lever).collect())
}

/// `d ln CV / d ln number`, from `CV²·τ` of single fibres with less and with more of a number.
fn elasticity(lever: Lever, [less, more]: [&Estimate; 2]) -> Difference {
    // CV² is CV²τ/τ, and τ goes with one over the speed of the belt.
    let thinner = if lever == Lever::BeltSpeed { 2.0 * libm::log1p(STEP) } else { 0.0 };
    // The logarithm of a mean and not the mean of logarithms: each fibre's part of the change.
    let value = 0.5 * (libm::log(more.mean / less.mean) + thinner) / (2.0 * libm::log1p(STEP));
    let part =
        |(l, m): (&f64, &f64)| value + 0.5 * (m / more.mean - l / less.mean) / (2.0 * libm::log1p(STEP));
    let parts = Estimate::new(less.values.iter().zip(&more.values).map(part).collect());
    let degrees = parts.values.len() as f64 - 1.0;
    Difference { value, standard_error: parts.standard_error.unwrap_or(f64::NAN), degrees }
}
