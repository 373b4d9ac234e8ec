//! Everything that is found out about a web.

use super::clouds::{Clouds, autocorrelation};
use super::lay::{Laid, Laying, lay, places};
use super::one_fibre::{OneFibre, one_fibre, straight_fibres};
use super::orientation::{Orientation, orientation};
use super::sensitivity::{Sensitivity, Source, sensitivities};
use super::threads::each;
use super::uniformity::{Unevenness, unevenness};
use super::{Edges, Fibres, Filaments, Layer, Sheet, Web};
use crate::error::Error;
use std::sync::atomic::AtomicU64;

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

/// The unevenness over patches of one size, in several ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchFindings {
    /// On the map.
    pub map: Unevenness,
    /// The expected one of independent filaments at the places of the layers, from single fibres, with its standard error.
    pub one_fibre: (f64, f64),
    /// The expected one of the curves that were flown, with its standard error, NaN for a single curve; None unless all layers have them.
    pub flown: Option<(f64, f64)>,
    /// The expected one of paths of the surrogate, with its standard error; None unless all layers have them.
    pub surrogate: Option<(f64, f64)>,
    /// Of straight fibres in all directions of the same mass.
    pub straight_fibres: f64,
}

/// Fibres that are laid alone.
const ALONE: u64 = 16;
/// Fibres that are laid alone for each sensitivity.
const TURNED: u64 = 8;
/// Longest lag of the autocorrelation [m], and most lags.
const LAG: f64 = 0.1;
const LAGS: usize = 257;

/// Lays a web and looks at it.
///
/// # Errors
/// If the web cannot be laid, or if it is stopped.
pub fn find(web: &Web, by: Laying<'_>) -> Result<Findings, Error> {
    let found = measure(web, by)?;
    let sides: Vec<usize> = found.patches.iter().map(|patch| side(&web.sheet, patch.map.patch)).collect();
    let of = OneFibre { cell: web.sheet.cell, fibres: TURNED, seed: web.seed };
    let aside = AtomicU64::new(0);
    let mut sensitivities = sensitivities(web, &sides, of, Laying { laid: &aside, ..by })?;
    // A surrogate that is not like the flown fibres does not say what would change their web.
    for of in sensitivities.iter_mut().filter(|of| of.source == Source::Surrogate) {
        for (elasticity, patch) in of.elasticity.iter_mut().zip(&found.patches) {
            if patch.surrogate_is_far() {
                *elasticity = None;
            }
        }
    }
    Ok(Findings { sensitivities, ..found })
}

/// Cells along the side of a patch [m].
fn side(sheet: &Sheet, patch: f64) -> usize {
    (patch / sheet.cell).round() as usize
}

/// [`find`] without the sensitivities, which take as long as the rest.
///
/// # Errors
/// As [`find`].
pub fn measure(web: &Web, by: Laying<'_>) -> Result<Findings, Error> {
    let sheet = &web.sheet;
    let laid = lay(web, by)?;
    // The progress is that of the web; what comes after it is short.
    let aside = AtomicU64::new(0);
    let by = Laying { laid: &aside, ..by };
    let map = &laid.map;
    let sides: Vec<usize> = sheet.patches.iter().map(|patch| side(sheet, *patch)).collect();
    let of = OneFibre { cell: sheet.cell, fibres: ALONE, seed: web.seed };
    let alone = expected(web, web.layers.clone(), &sides, of, by)?;
    let other = |layer: &Layer| Some(Layer { fibres: layer.compared.clone()?, ..layer.clone() });
    let compared = match web.layers.iter().map(other).collect() {
        Some(layers) => Some(expected(web, layers, &sides, of, by)?),
        None => None,
    };
    let all = |of: fn(&Fibres) -> bool, fibres: fn(&Layer) -> Option<&Fibres>| {
        web.layers.iter().all(|layer| fibres(layer).is_some_and(of))
    };
    let the_one = |of: fn(&Fibres) -> bool, i: usize| {
        let laid = all(of, |layer| Some(&layer.fibres)).then_some(alone[i]);
        laid.or_else(|| {
            compared.as_ref().filter(|_| all(of, |layer| layer.compared.as_ref())).map(|found| found[i])
        })
    };
    let weight = web.basis_weight();
    let mut patches = Vec::new();
    let uneven = each(by.threads, sides.len(), |i| Ok(unevenness(map, sides[i])))?;
    for (i, map) in uneven.into_iter().enumerate() {
        let Some(map) = map else { continue };
        let straight = |layer: &Layer| {
            let tau = layer.basis_weight(sheet) / layer.linear_density;
            (straight_fibres(tau, map.patch) * layer.basis_weight(sheet)).powi(2)
        };
        let straight_fibres = web.layers.iter().map(straight).sum::<f64>().sqrt() / weight;
        let flown = the_one(|fibres| matches!(fibres, Fibres::Curves(_)), i);
        let surrogate = the_one(|fibres| matches!(fibres, Fibres::Surrogate(_)), i);
        patches.push(PatchFindings { map, one_fibre: alone[i], flown, surrogate, straight_fibres });
    }
    let lags = ((LAG / sheet.cell).round() as usize + 1).min(LAGS);
    Ok(Findings {
        orientation: orientation(web, by)?,
        clouds: Clouds::of(map),
        autocorrelation: autocorrelation(map, lags),
        sensitivities: Vec::new(),
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
    let sheet = &web.sheet;
    let closed = sheet.edges == Edges::Periodic;
    let found = each(by.threads, layers.len(), |i| one_fibre(&layers[i], sides, of, by))?;
    let expected = |i: usize| {
        // Variances of independent layers add up, and so do what their places do at each column.
        let (mut square, mut error) = (0.0, 0.0);
        let mut across = vec![0.0; sheet.cells()[0]];
        for (number, (layer, found)) in layers.iter().zip(&found).enumerate() {
            let share = layer.basis_weight(sheet) / web.basis_weight();
            let scale = share * share * layer.linear_density / layer.basis_weight(sheet);
            let by_chance = found[i].of(&layer.filaments);
            square += scale * by_chance.mean;
            error += (scale * by_chance.standard_error.unwrap_or(f64::NAN)).powi(2);
            let of_places = match &layer.filaments {
                Filaments::AtRandom { .. } => vec![1.0; across.len()],
                Filaments::Rows(_) => {
                    let places = places(web, number, layer);
                    let places: Vec<f64> = places.iter().map(|place| place / sheet.cell).collect();
                    found[i].across(&places, (across.len(), closed), sides[i])
                }
            };
            across.truncate(of_places.len());
            across.iter_mut().zip(of_places).for_each(|(sum, of)| *sum += share * of);
        }
        let columns = across.len() as f64;
        let mean = across.iter().sum::<f64>() / columns;
        square += across.iter().map(|of| (of / mean - 1.0).powi(2)).sum::<f64>() / columns;
        (square.sqrt(), error.sqrt() / (2.0 * square.sqrt()))
    };
    Ok((0..sides.len()).map(expected).collect())
}
