//! Webs of which a few filaments were simulated in the same air, compared block by block.

use spunlaid_ground::{Difference, Effect};
use spunlaid_simulation::WebSpec;
use spunlaid_web::map::OfMean;
use spunlaid_web::{ExpectedCv, SubsampleEstimate, SubsampleWarning};

/// What the coarser mesh and air of webs that are compared do to a change of the CV, and to a CV by itself, as
/// shares of the CV.
const OF_MESH: f64 = 0.015;
pub(super) const OF_OTHER_MESH: f64 = 0.03;

/// What a few filaments say about the layers of a web.
pub(super) struct WebOfFew {
    /// Of each layer: its share of the basis weight, and what its filaments say.
    layers: Vec<(f64, SubsampleEstimate)>,
}

/// What is known of the patches of one side.
struct Patches<'a> {
    /// CV² of the web.
    square: f64,
    /// The part of it that filaments make each for itself.
    own: f64,
    /// Of each layer the squared share of the basis weight, the blocks of the sheet, and their number across.
    layers: Vec<(f64, &'a [f64], usize)>,
    /// How far every second filament is off, as a share of the CV.
    of_halves: f64,
}

impl WebOfFew {
    pub(super) fn new(spec: &WebSpec, few: Vec<SubsampleEstimate>) -> Self {
        let share = |layer: usize| spec.alone(layer).mass_flow() / spec.mass_flow();
        Self { layers: few.into_iter().enumerate().map(|(layer, few)| (share(layer), few)).collect() }
    }

    /// The changes of the CV from this web to another one in the same air, over the patches that both have.
    /// What both have by chance, because they have the same clouds, does not count.
    ///                                                                  theory.md, "Two webs in the same air"
    pub(super) fn changes_to(&self, other: &Self) -> Vec<Effect<f64>> {
        let Some((_, first)) = self.layers.first() else { return Vec::new() };
        let change = |patch: f64| {
            let (before, after) = (self.over(patch)?, other.over(patch)?);
            let ratio = (after.square / before.square).sqrt();
            let mut variance = 0.0;
            let mut degrees = f64::INFINITY;
            let mut common = [0.0; 3];
            for ((weight, blocks, across), (other_weight, other_blocks, _)) in
                before.layers.iter().zip(&after.layers)
            {
                let count = blocks.len().min(other_blocks.len());
                // To first order, half the relative change of CV² is that of CV.
                let shares = |blocks: &[f64], share: f64| {
                    let mean = blocks.iter().take(count).sum::<f64>() / count as f64;
                    blocks.iter().take(count).map(|block| 0.5 * share * (block - mean)).collect::<Vec<_>>()
                };
                let here = shares(blocks, weight / before.square);
                let there = shares(other_blocks, other_weight / after.square);
                let sum = |of: &dyn Fn(f64, f64) -> f64| -> f64 {
                    here.iter().zip(&there).map(|(here, there)| of(*here, *there)).sum()
                };
                let parts: Vec<f64> = here.iter().zip(&there).map(|(here, there)| there - here).collect();
                let of_mean = OfMean::of(&parts, *across);
                let moments = [sum(&|a, _| a * a), sum(&|_, b| b * b), sum(&|a, b| a * b)];
                common.iter_mut().zip(moments).for_each(|(all, of_layer)| *all += of_layer);
                variance += of_mean.variance;
                degrees = degrees.min(of_mean.degrees);
            }
            let by_pitch = 0.5 * (after.of_halves - before.of_halves);
            let standard_error = ratio * (variance + by_pitch * by_pitch + OF_MESH * OF_MESH).sqrt();
            let own = Some(0.5 * (after.own - before.own) / before.square);
            let [here, there, both] = common;
            let in_common = Some(both / (here * there).sqrt()).filter(|common| common.is_finite());
            let difference = Difference { value: ratio - 1.0, standard_error, degrees };
            Some(Effect { of: patch, difference, own, in_common })
        };
        first.cvs.iter().filter_map(|cv| change(cv.patch)).collect()
    }

    /// The CV over patches of each size, in an air that no other web has, of filaments at usual places without defects.
    ///
    /// * `of_mesh` – what a coarser mesh and air do to it, as a share of it
    pub(super) fn cvs(&self, of_mesh: f64) -> Vec<ExpectedCv> {
        let Some((_, first)) = self.layers.first() else { return Vec::new() };
        let of_patch = |patch: f64| {
            let cv = self.over(patch)?.square.sqrt();
            let part = |(share, few): &(f64, SubsampleEstimate)| {
                let of_layer = few.cvs.iter().find(|of_layer| of_layer.patch == patch)?;
                let error = of_layer.by_chance?.hypot(of_layer.by_pitch);
                Some((share * share * of_layer.cv * error / cv).powi(2))
            };
            let variance: Option<f64> = self.layers.iter().map(part).sum();
            let error = variance.map(|variance| variance.sqrt().hypot(of_mesh * cv));
            Some(ExpectedCv::alone(patch, cv, error))
        };
        first.cvs.iter().filter_map(|cv| of_patch(cv.patch)).collect()
    }

    fn over(&self, patch: f64) -> Option<Patches<'_>> {
        let of_layer = |(share, few): &'_ (f64, SubsampleEstimate)| {
            let number = few.cvs.iter().position(|cv| cv.patch == patch)?;
            Some((share * share, number))
        };
        let mut patches = Patches { square: 0.0, own: 0.0, layers: Vec::new(), of_halves: 0.0 };
        for layer in &self.layers {
            let (weight, number) = of_layer(layer)?;
            // Nothing is a change of a CV that is not reported at all.
            if let Some(SubsampleWarning::Own(_) | SubsampleWarning::Neighbours(_)) =
                layer.1.warning_over(patch)
            {
                return None;
            }
            let cv = layer.1.cvs[number];
            patches.square += weight * cv.cv * cv.cv;
            patches.own += weight * cv.own;
            patches.of_halves += weight * cv.cv * cv.cv * cv.of_halves;
            patches.layers.push((weight, &layer.1.blocks[number][..], layer.1.blocks_across));
        }
        patches.of_halves /= patches.square;
        Some(patches)
    }
}
