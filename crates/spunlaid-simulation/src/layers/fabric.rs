//! The fabric that a web becomes.

use super::{LayerSpec, WebSpec};
use spunlaid_ground::Dimension;
use spunlaid_web::fabric::LaidPatch;
use spunlaid_web::fabric::{Filaments, columns_sold, estimate};
use spunlaid_web::map::uniformity::variance_of_mean;
use spunlaid_web::map::{Evidence, Findings, PatchFindings, holes};
use spunlaid_web::{Defect, Fabric, Laid, Layer, StreakSource, Web};

/// Side of the patches whose waves show how the ends of a sheet cut its clouds [m].
const OF_PART: f64 = 10e-3;

/// On which area numbers are counted, where the CV comes from a larger one.
fn counted_on(found: &Findings) -> Option<String> {
    let few = found.laid.few().find(|few| few.is_of_two_levels())?;
    let area = |area: f64| Dimension::Ratio.pretty_to(area, 2);
    Some(format!(
        "thin spots, weights, strips, bare area and light are counted on the map, which has the clouds of {} m²; the \
        CV comes from {} m². How far the map is off is in their errors",
        area(few.sheet[0] * few.sheet[1]),
        area(few.area)
    ))
}

impl WebSpec {
    /// What a buyer wants to know of the fabric.
    ///
    /// * `web`, `found` – the web that was laid, and what was found of it
    pub fn fabric(&self, web: &Web, found: &Findings, threads: usize) -> Fabric {
        let sheet = &web.sheet;
        let kinds = self.layers.iter().zip(&web.layers).map(|(layer, drawn)| Filaments {
            diameter: layer.fed_filament().diameter(),
            density: layer.fed_filament().density,
            basis_weight: drawn.basis_weight(sheet),
        });
        let laid_patch = |of: &PatchFindings| LaidPatch {
            patch: of.map.patch,
            reported: of.with_total_error(),
            off: of.off_of_map(),
        };
        let laid = Laid {
            map: &found.laid.map,
            margins: found.margins,
            reach: Some(found.reach),
            filaments: kinds.collect(),
            orientation: Some(&found.orientation),
            patches: found.patches.iter().map(laid_patch).collect(),
            streaks: found.laid.evidence() != Evidence::Known
                || self.layers.iter().any(LayerSpec::has_random_streaks),
            error_of_weight: self.error_of_part(web, found).or(found.error_of_weight).unwrap_or(0.0),
            defects: self.streak_sources(web),
        };
        let mut fabric = estimate(&laid, &self.fabric, threads);
        fabric.notes.extend(counted_on(found));
        fabric
    }

    /// Standard error of the mean weight of a part that is sold, as a fraction of it; None if all of the web is.
    fn error_of_part(&self, web: &Web, found: &Findings) -> Option<f64> {
        let (map, cell) = (&found.laid.map, web.sheet.cell);
        let of = |saleable| columns_sold(map, found.margins, Some(found.reach), saleable);
        let sold = of(self.fabric.saleable_width);
        if sold.len() == of(None).len() {
            return None;
        }
        let width = sold.len() as f64 * cell;
        let side = (OF_PART / cell).round() as usize;
        let places = web.places(width);
        let variance = variance_of_mean(&map.between(sold), side, width / web.sheet.width, &places);
        Some((variance + web.variance_by_defects()).sqrt())
    }

    /// What the defects of its layers take from the web.
    fn streak_sources(&self, web: &Web) -> Vec<StreakSource> {
        let of_layer = |(number, layer): (usize, &Layer)| {
            let mass = layer.linear_density / layer.belt_ratio();
            let source = |(i, defect): (usize, &Defect)| {
                let holes = holes(web.layer_filaments(number, layer), i, defect);
                let less = (1.0 - defect.titre) * mass;
                let missing = holes.into_iter().map(|(_, place)| (place, less)).collect();
                let until = defect.until(web.sheet.length, layer.belt_speed);
                StreakSource { missing, spread: layer.fibres.sigma_cd(), until }
            };
            layer.defects.iter().enumerate().map(source).collect::<Vec<_>>()
        };
        let all = web.layers.iter().enumerate().flat_map(of_layer);
        // Where chance chose no hole, there is no streak.
        all.filter(|source| !source.missing.is_empty()).collect()
    }
}
