//! The charge of the filaments of a layer, and what is known of it before they fly.

use super::LayerSpec;
use spunlaid_fibre::{Case, Charge, ChargeEstimate};
use spunlaid_web::Sheet;

impl LayerSpec {
    /// Its charge; None of filaments without charge.
    pub fn charged(&self) -> Option<Charge> {
        let per_mass = self.charge.filter(|charge| *charge != 0.0)?;
        Some(Charge { per_mass, walls: self.walls })
    }

    /// What its charge does at the edge of the curtain, before it has been simulated; None of filaments without
    /// charge, and of those that no case flies.
    pub fn charge_estimate(&self, sheet: &Sheet) -> Option<ChargeEstimate> {
        let (charge, case) = (self.charged()?, self.source.case()?);
        let per_metre = self.filaments.count(sheet) as f64 / sheet.width;
        let mass_per_height = per_metre * self.fed_filament().linear_density() * length_per_height(case)?;
        Some(charge.estimate(mass_per_height, case.run.gravity))
    }

    /// Farthest that a filament is fed from the middle of the slot, along the machine direction [m].
    pub fn farthest_inlet(&self) -> f64 {
        self.filaments.depths().into_iter().map(f64::abs).fold(0.0, f64::max)
    }
}

/// Length of filament for each length of the way to the belt, as a mean: where the air is slower than the
/// feed, a filament that goes with it hangs in folds.
fn length_per_height(case: &Case) -> Option<f64> {
    let (air, _) = case.air.along_and_speed(case.along());
    let slack = case.line?.feed_speed / air;
    Some(if air > 0.0 { slack.max(1.0) } else { 1.0 })
}
