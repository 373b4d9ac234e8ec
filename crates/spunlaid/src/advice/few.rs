//! Webs of which a few filaments were flown in the same air, compared block by block.

use super::CvChange;
use crate::layers::WebSpec;
use crate::web::LayerFew;

/// What a few filaments say about the layers of a web.
pub(super) struct WebOfFew {
    /// Of each layer: its share of the basis weight, and what its filaments say.
    layers: Vec<(f64, LayerFew)>,
}

/// What is known of the patches of one side.
struct Patches<'a> {
    /// CV² of the web.
    square: f64,
    /// The part of it that filaments make each for itself.
    own: f64,
    /// Of each layer the squared share of the basis weight, and the blocks of the sheet.
    layers: Vec<(f64, &'a [f64])>,
    /// How far every second filament is off, as a share of the CV.
    of_halves: f64,
}

impl WebOfFew {
    pub(super) fn new(spec: &WebSpec, few: Vec<LayerFew>) -> Self {
        let share = |few: &LayerFew| spec.alone(few.layer).mass_flow() / spec.mass_flow();
        Self { layers: few.into_iter().map(|few| (share(&few), few)).collect() }
    }

    /// The changes of the CV from this web to another one in the same air, over the patches that both have. What both have by chance, because they
    /// have the same clouds, does not count.                         theory.md, "Two webs in the same air"
    pub(super) fn changes_to(&self, other: &Self) -> Vec<CvChange> {
        let Some((_, first)) = self.layers.first() else { return Vec::new() };
        let change = |patch: f64| {
            let (before, after) = (self.over(patch)?, other.over(patch)?);
            let ratio = (after.square / before.square).sqrt();
            let (mut variance, mut degrees, mut common) = (0.0, f64::INFINITY, [0.0; 3]);
            for ((weight, blocks), (other_weight, other_blocks)) in before.layers.iter().zip(&after.layers) {
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
                let squares = sum(&|here, there| (there - here).powi(2));
                let moments = [sum(&|a, _| a * a), sum(&|_, b| b * b), sum(&|a, b| a * b)];
                common.iter_mut().zip(moments).for_each(|(all, of_layer)| *all += of_layer);
                variance += squares / (count as f64 * (count as f64 - 1.0));
                degrees = degrees.min(count as f64 - 1.0);
            }
            let by_pitch = 0.5 * (after.of_halves - before.of_halves);
            let standard_error = ratio * (variance + by_pitch * by_pitch).sqrt();
            let own = Some(0.5 * (after.own - before.own) / before.square);
            let [here, there, both] = common;
            let in_common = Some(both / (here * there).sqrt()).filter(|common| common.is_finite());
            Some(CvChange { patch, change: ratio - 1.0, standard_error, degrees, own, in_common })
        };
        first.cvs.iter().filter_map(|cv| change(cv.patch)).collect()
    }

    fn over(&self, patch: f64) -> Option<Patches<'_>> {
        let of_layer = |(share, few): &'_ (f64, LayerFew)| {
            let number = few.cvs.iter().position(|cv| cv.patch == patch)?;
            Some((share * share, number))
        };
        let mut patches = Patches { square: 0.0, own: 0.0, layers: Vec::new(), of_halves: 0.0 };
        for layer in &self.layers {
            let (weight, number) = of_layer(layer)?;
            let cv = layer.1.cvs[number];
            patches.square += weight * cv.cv * cv.cv;
            patches.own += weight * cv.own;
            patches.of_halves += weight * cv.cv * cv.cv * cv.of_halves;
            patches.layers.push((weight, &layer.1.blocks[number][..]));
        }
        patches.of_halves /= patches.square;
        Some(patches)
    }
}
