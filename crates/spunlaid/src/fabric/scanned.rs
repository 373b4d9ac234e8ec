//! The fabric of a scan, as far as a map alone tells it.

use super::FabricKeys;
use super::air_through::Filaments;
use super::tell::{Fabric, Laid, tell};
use crate::scan::{Findings, PatchFindings};
use std::f64::consts::PI;

/// Any density, of which only the length of fibre is made, which depends on the titre alone.
const DENSITY: f64 = 1000.0;

/// What a scan tells of the fabric: thin places, weights and strips, and the formation number where basis
/// weight and titre are known.
pub fn of_scan(findings: &Findings) -> Fabric {
    let titre = findings.titre.filter(|_| findings.mean_known);
    let filaments = titre.map(|titre| Filaments {
        diameter: (4.0 * titre / (PI * DENSITY)).sqrt(),
        density: DENSITY,
        basis_weight: findings.map.basis_weight(),
    });
    let laid = Laid {
        map: &findings.map,
        margins: [0.0; 2],
        reach: None,
        filaments: filaments.into_iter().collect(),
        orientation: None,
        patches: findings.patches.iter().map(|patch| patch.unevenness).collect(),
        defects: Vec::new(),
    };
    let mut fabric = tell(&laid, &FabricKeys::USUAL, 1);
    let formation = match titre {
        Some(_) => "",
        None => {
            ", and the formation number: that needs the mean basis weight and the titre of the filaments \
            (weight, titre)"
        }
    };
    // What else is not told needs the fibres, and that is said once.
    fabric.notes = vec![format!(
        "a scan does not tell what needs its fibres: stiffness, bare area, air \
        permeability{formation}"
    )];
    // What makes a CV doubtful does so to its patches: a guess of the lamp, blur, a small sheet.
    for patch in &mut fabric.patches {
        let thin = &mut patch.thin;
        let is_same = |found: &&PatchFindings| (found.unevenness.patch / thin.patch - 1.0).abs() < 1e-6;
        let same = findings.patches.iter().find(is_same);
        if findings.guess.is_some() || same.is_some_and(|found| found.interval.is_err()) {
            let numbers = thin.lighter.iter_mut().chain([&mut thin.heavier]).chain(&mut thin.quantiles);
            numbers.for_each(|number| *number = number.without_error());
        }
    }
    if let Some(guess) = findings.guess {
        fabric.notes.push(format!("thin places and strips have no errors, because {guess}"));
        for strips in fabric.strips.iter_mut().flatten() {
            let numbers = [Some(&mut strips.weakest), strips.scatter.as_mut(), strips.low.as_mut()];
            let numbers = numbers.into_iter().flatten().chain([&mut strips.sections]);
            numbers.for_each(|number| *number = number.without_error());
        }
    }
    fabric
}
