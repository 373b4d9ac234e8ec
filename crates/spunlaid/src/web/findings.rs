//! Everything that is found out about a web.

use super::clouds::{Clouds, autocorrelation};
use super::lay::{Laid, Laying, lay};
use super::one_fibre::{OneFibre, one_fibre, straight_fibres};
use super::orientation::{Orientation, orientation};
use super::sensitivity::{Sensitivity, sensitivities};
use super::uniformity::{Unevenness, unevenness};
use super::{Layer, Web};
use crate::error::Error;

/// A web, laid and looked at.
#[derive(Clone, Debug)]
pub struct Findings {
    /// The map of the basis weight, and what was cut off at the edges.
    pub laid: Laid,
    /// How uneven it is, patch by patch.
    pub patches: Vec<PatchFindings>,
    /// Directions of the fibres.
    pub orientation: Orientation,
    /// Sizes of the clouds; none for a sheet of a few cells.
    pub clouds: Option<Clouds>,
    /// Autocorrelation coefficients of the basis weight in cross and in machine direction, cell by cell from lag zero.
    pub autocorrelation: [Vec<f64>; 2],
    /// What would make it more even, at the patches of [`Findings::patches`]; empty for several layers.
    pub sensitivities: Vec<Sensitivity>,
}

/// The unevenness over patches of one size, in three ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchFindings {
    /// On the map.
    pub map: Unevenness,
    /// The expected one of independent filaments at random places, from single fibres, with its standard error.
    pub one_fibre: (f64, f64),
    /// The expected one of [`Layer::compared`], if all layers have it, with its standard error.
    pub compared: Option<(f64, f64)>,
    /// Of straight fibres in all directions of the same mass.
    pub straight_fibres: f64,
}

/// Fibres that are laid alone.
const ALONE: u64 = 32;
/// Fibres that are laid alone for each sensitivity.
const TURNED: u64 = 16;
/// Longest lag of the autocorrelation [m], and most lags.
const LAG: f64 = 0.1;
const LAGS: usize = 257;

/// Lays a web and looks at it.
///
/// # Errors
/// If the web cannot be laid, or if it is stopped.
pub fn find(web: &Web, by: Laying<'_>) -> Result<Findings, Error> {
    let sheet = &web.sheet;
    let laid = lay(web, by)?;
    let map = &laid.map;
    let side = |patch: &f64| (patch / sheet.cell).round() as usize;
    let sides: Vec<usize> = sheet.patches.iter().map(side).collect();
    let of = OneFibre { cell: sheet.cell, fibres: ALONE, seed: web.seed };
    let alone = expected(web, web.layers.clone(), &sides, of, by)?;
    let other = |layer: &Layer| Some(Layer { fibres: layer.compared.clone()?, ..layer.clone() });
    let compared = match web.layers.iter().map(other).collect() {
        Some(layers) => Some(expected(web, layers, &sides, of, by)?),
        None => None,
    };
    let weight = web.basis_weight();
    let mut patches = Vec::new();
    for (i, side) in sides.iter().enumerate() {
        let Some(map) = unevenness(map, *side) else { continue };
        let straight = |layer: &Layer| {
            let tau = layer.basis_weight(sheet) / layer.linear_density;
            (straight_fibres(tau, map.patch) * layer.basis_weight(sheet)).powi(2)
        };
        let straight_fibres = web.layers.iter().map(straight).sum::<f64>().sqrt() / weight;
        let compared = compared.as_ref().map(|compared| compared[i]);
        patches.push(PatchFindings { map, one_fibre: alone[i], compared, straight_fibres });
    }
    let sides: Vec<usize> = patches.iter().map(|patch| side(&patch.map.patch)).collect();
    let lags = ((LAG / sheet.cell).round() as usize + 1).min(LAGS);
    Ok(Findings {
        orientation: orientation(web, by)?,
        clouds: Clouds::of(map),
        autocorrelation: autocorrelation(map, lags),
        sensitivities: sensitivities(web, &sides, OneFibre { fibres: TURNED, ..of }, by)?,
        patches,
        laid,
    })
}

/// The expected CV of a web of these layers for each side of a patch, and its standard error.
fn expected(
    web: &Web,
    layers: Vec<Layer>,
    sides: &[usize],
    of: OneFibre,
    by: Laying<'_>,
) -> Result<Vec<(f64, f64)>, Error> {
    // Variances of independent layers add up.
    let mut sums = vec![(0.0, 0.0); sides.len()];
    for layer in &layers {
        let share = layer.basis_weight(&web.sheet) / web.basis_weight();
        let tau = layer.basis_weight(&web.sheet) / layer.linear_density;
        for (sum, found) in sums.iter_mut().zip(one_fibre(layer, sides, of, by)?) {
            let scale = share * share / tau;
            let error = scale * found.standard_error.unwrap_or(0.0);
            *sum = (sum.0 + scale * found.mean, sum.1 + error * error);
        }
    }
    Ok(sums
        .into_iter()
        .map(|(square, error): (f64, f64)| (square.sqrt(), error.sqrt() / (2.0 * square.sqrt())))
        .collect())
}
