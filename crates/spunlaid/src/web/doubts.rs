//! Which numbers of a web are in doubt, and why.

use super::doubt::Doubt;
use super::laid_web::SharedAirFindings;
use super::{Findings, Layer, PatchFindings, Web};
use crate::charge::STRONG;

/// Part of the variance that filled-in filaments may miss where small patches of the map are to be believed.
const MISSING: f64 = 0.1;
/// A map whose CV is farther from the told one, as a share of it, is another one.
const OF_MAP: f64 = 0.05;

impl Findings {
    /// What must be known of these numbers before they are believed.
    pub fn doubts(&self, web: &Web) -> Vec<Doubt> {
        let mut doubts = match &self.laid.shared_air {
            Some(together) => {
                [lost(web, together), few_filaments(self, together), charged(together)].concat()
            }
            None if self.patches.is_empty() => Vec::new(),
            None => vec![Doubt::NothingFlown],
        };
        let map = &self.laid.map;
        if self.laid.cut > 0.0 {
            let whole = map.total() as f64 * map.quantum + self.laid.cut;
            doubts.push(Doubt::CutOff { share: self.laid.cut / whole });
        }
        if self.margins != [0.0; 2] {
            doubts.push(Doubt::ThinEdges { margins: self.margins });
        }
        let unsure = self.patches.iter().filter_map(PatchFindings::told);
        let unsure = unsure.filter(|map| map.standard_error.is_none());
        doubts.extend(of_sides(unsure.map(|map| map.patch), |sides| Doubt::NoError { sides }));
        doubts
    }
}

/// A doubt about patches of these sides [m]; none if there are none.
fn of_sides(sides: impl Iterator<Item = f64>, doubt: impl FnOnce(Vec<f64>) -> Doubt) -> Option<Doubt> {
    let sides: Vec<f64> = sides.collect();
    (!sides.is_empty()).then(|| doubt(sides))
}

/// Filaments of a web in one air that were lost.
fn lost(web: &Web, together: &SharedAirFindings) -> Vec<Doubt> {
    let count = |(number, layer): (usize, &Layer)| {
        let few = together.few.iter().find(|few| few.layer == number);
        few.map_or_else(|| layer.count(&web.sheet), |few| few.filaments + few.lost)
    };
    let of = web.layers.iter().enumerate().map(count).sum();
    let lost = Some(together.lost).filter(|lost| *lost > 0);
    lost.map(|filaments| Doubt::Lost { filaments, of }).into_iter().collect()
}

/// Whether charged filaments would keep their charge.
fn charged(together: &SharedAirFindings) -> Vec<Doubt> {
    let field = together.charged.iter().map(|charged| charged.edge_field).fold(0.0, f64::max);
    (field > STRONG).then_some(Doubt::StrongField { field }).into_iter().collect()
}

/// Whether the few filaments that were flown are enough for what is told of all.
fn few_filaments(findings: &Findings, together: &SharedAirFindings) -> Vec<Doubt> {
    let too_few = together.few.iter().filter_map(|few| {
        let why = few.doubt()?;
        let sides = few.cvs.iter().map(|cv| cv.patch).filter(|patch| few.doubt_over(*patch).is_some());
        let (pitch, enough) = (few.pitch, few.enough_per_metre());
        Some(Doubt::FewFilaments { sides: sides.collect(), why, pitch, enough })
    });
    let mut doubts: Vec<Doubt> = too_few.collect();
    let missing = together.few.iter().flat_map(|few| few.missing).fold(0.0, f64::max);
    let apart = |patch: &PatchFindings| {
        let told = patch.few.and_then(|_| patch.told())?;
        Some((told.patch, patch.filled? / told.cv - 1.0))
    };
    let apart: Vec<(f64, f64)> = findings.patches.iter().filter_map(apart).collect();
    let off: Vec<(f64, f64)> = apart.into_iter().filter(|(_, apart)| apart.abs() > OF_MAP).collect();
    if missing > MISSING || !off.is_empty() {
        let most = off.iter().map(|(_, apart)| *apart).max_by(|a, b| a.abs().total_cmp(&b.abs()));
        let sides = off.iter().map(|(side, _)| *side).collect();
        doubts.push(Doubt::FilledIn { missing, sides, apart: most.unwrap_or(0.0) });
    }
    let larger = findings.patches.iter().filter(|patch| patch.few.is_none() && !together.few.is_empty());
    doubts.extend(of_sides(larger.map(|patch| patch.map.patch), |sides| Doubt::SmallSheet { sides }));
    doubts
}
