//! Everything that is found out about a web.

use super::autocorrelation::autocorrelation;
use super::basis_weight::Map;
use super::clouds::Clouds;
use super::expected::{ALONE, SheetPosition, across, expected, paths, sides};
use super::few_findings::{SubsampleCv, SubsampleEstimate, SubsampleWarning};
use super::laid_web::{Evidence, LaidWeb, LayerFlown};
use super::lay::lay;
use super::one_fibre::{OneFibre, straight_fibres};
use super::orientation::{Orientation, orientation};
use super::uniformity::{PatchCv, nearest_to_seen, unevenness_at, variance_of_mean};
use super::warning::WebWarning;
use super::waves::Places;
use super::{Layer, Web};
use crate::surrogate::Surrogate;
use spunlaid_fibre::STRONG;
use spunlaid_ground::threads::try_par_map;
use spunlaid_ground::{Dimension, Error, Estimate, Fault, RunContext};
use std::borrow::Cow;
use std::sync::atomic::AtomicU64;

/// A web, laid and looked at.
#[derive(Clone, Debug)]
pub struct Findings {
    /// The map of the basis weight, and what was cut off at the edges.
    pub laid: LaidWeb,
    /// Widths of the strips at the two edges in cross direction [m]. The web is thinner there, and the fields
    /// below leave these strips out. They reach 3 σ_CD inwards of the outermost place of a filament; a web
    /// with periodic edges has none.
    pub margins: [f64; 2],
    /// Where the web begins and ends across the sheet: where the reach of the outermost filaments ends, or at
    /// the edges of the sheet, which cut it or where it goes on [m].
    pub reach: [f64; 2],
    /// Standard error of the mean basis weight between the edges, as a share of it; none of a sheet that is closed to
    /// a ring and has no defects at random holes.
    pub error_of_weight: Option<f64>,
    /// How uneven it is, patch by patch.
    pub patches: Vec<PatchFindings>,
    /// Directions of the fibres.
    pub orientation: Orientation,
    /// Sizes of the clouds; none for a sheet of a few cells.
    pub clouds: Option<Clouds>,
    /// Autocorrelation coefficients of the basis weight in cross and in machine direction, cell by cell from lag zero.
    pub autocorrelation: [Vec<f64>; 2],
    /// Length of all filaments [m].
    pub fibre_length: f64,
    /// The surrogate of the first layer, if it has one.
    pub surrogate: Option<Surrogate>,
}

impl Findings {
    /// The map without the edges.
    pub fn within(&self) -> Cow<'_, Map> {
        let map = &self.laid.map;
        let [first, last] = self.margins.map(|margin| (margin / map.cell).round() as usize);
        map.between(first..map.columns - last)
    }

    /// How uneven it is over patches of the size that the eye judges first.
    pub fn seen(&self) -> Option<&PatchFindings> {
        nearest_to_seen(self.patches.iter().map(|patch| patch.map.patch)).map(|i| &self.patches[i])
    }

    /// See [`Clouds::texture_md`]. It has no error where that of no CV is known: the sheet then has too few clouds, or
    /// too few filaments were simulated.
    pub fn texture_md(&self) -> Option<Estimate> {
        let texture = self.clouds.as_ref()?.texture_md();
        let is_known = |patch: &PatchFindings| {
            patch.reported().is_some_and(|estimate| estimate.standard_error.is_some())
        };
        let is_known = self.patches.iter().any(is_known);
        Some(Estimate { standard_error: texture.standard_error.filter(|_| is_known), ..texture })
    }

    /// The basis weight of this piece of web without its edges, and how far that of other pieces of the same web
    /// is from the mean of all [kg/m²]; no error of a sheet that is closed to a ring and has no defects at random
    /// holes.
    pub fn basis_weight(&self) -> (f64, Option<f64>) {
        let weight = self.within().basis_weight();
        (weight, self.error_of_weight.map(|error| error * weight))
    }
}

/// The CV over patches of one size, in several ways.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchFindings {
    /// On the map; of filaments in shared turbulence of which a few were simulated, as these give it
    /// ([`PatchFindings::few`]), and on the map again, without an error, where they do not give it
    /// ([`PatchFindings::warning`]).
    pub map: PatchCv,
    /// The expected one of independent filaments at the places of the layers, from single paths of the
    /// surrogate, with the standard error by the few paths; None unless all layers have a surrogate.
    pub single_fibres: Option<(f64, Option<f64>)>,
    /// Of straight fibres in all directions of the same mass.
    pub straight_fibres: f64,
    /// From what it is known. In independent turbulence, filaments in shared turbulence would give
    /// [`PatchFindings::independent`].
    pub evidence: Evidence,
    /// What a few filaments in shared turbulence say of all; None if all were simulated, or if the patch is too large
    /// for the sheet that they laid.
    pub few: Option<SubsampleCv>,
    /// Why a few filaments do not give the CV of all: there is no number then. None if they do, or if all
    /// were simulated.
    pub warning: Option<SubsampleWarning>,
    /// CV of the map itself, in which filaments between few simulated ones are filled in.
    pub of_map: f64,
}

impl PatchFindings {
    /// The CV of the web; None if a few filaments were simulated and do not give it.
    pub fn reported(&self) -> Option<PatchCv> {
        self.warning.is_none().then_some(self.map)
    }

    /// Gives the CV of a sample another value. Where it is raised the errors of its square stay, where it is lowered
    /// those of the CV.
    fn set_sample_cv(&mut self, cv: f64) {
        if let Some(few) = self.few.filter(|few| self.warning.is_none() && few.cv != cv) {
            let few = if cv > few.cv { few.with_square(cv * cv) } else { SubsampleCv { cv, ..few } };
            self.few = Some(few);
            (self.map.cv, self.map.standard_error) = (few.cv, few.by_chance);
        }
    }

    /// The CV of the web with its error by all causes, or by chance where another one is not known; None if it is
    /// not reported.
    pub fn with_total_error(&self) -> Option<PatchCv> {
        let estimate = self.reported()?;
        Some(PatchCv { standard_error: self.total_error().whole().or(estimate.standard_error), ..estimate })
    }

    /// The share by which the deviations of the map, with what is filled in, would have to be larger to be those of
    /// the web, with the error by the few fibres in it. None if it is not known.
    pub fn off_of_map(&self) -> Option<f64> {
        if self.evidence != Evidence::FewInOneAir {
            return Some(0.0);
        }
        let estimate = self.few.filter(|_| self.warning.is_none())?;
        let off = estimate.cv / self.of_map - 1.0;
        Some(off.hypot(estimate.by_pitch / estimate.cv).copysign(off))
    }

    /// What the filaments of a web in shared turbulence would give in independent turbulence, by their surrogate;
    /// None if they are independent as they are. How far a surrogate is from real curves is not known, so it has no
    /// error.
    pub fn independent(&self) -> Option<f64> {
        self.single_fibres.filter(|_| self.evidence != Evidence::Known).map(|(cv, _)| cv)
    }

    /// The error of the CV of the map, by its causes.
    pub fn total_error(&self) -> ErrorBudget {
        let flight = match self.evidence {
            Evidence::Known => None,
            Evidence::AllInOneAir => Some(0.0),
            Evidence::FewInOneAir => self.few.filter(|_| self.warning.is_none()).map(|few| few.by_pitch),
        };
        ErrorBudget { chance: self.map.standard_error, flight }
    }

    /// The 95 % confidence interval of the CV of all such webs; none if the sheet is too small to say, or if
    /// a few filaments do not give it. Which filaments were simulated for all is chance too.
    pub fn interval(&self) -> Option<[f64; 2]> {
        if self.evidence == Evidence::Known {
            return self.map.interval();
        }
        PatchCv { standard_error: self.total_error().whole(), ..self.map }.interval_of_few()
    }
}

/// Longest lag of the autocorrelation [m], and most lags.
const LAG: f64 = 0.1;
const LAGS: usize = 257;

/// Lays a web and looks at it.
///
/// # Errors
/// If the web cannot be laid, or if it is stopped.
pub fn find(web: &Web, by: RunContext<'_>) -> Result<Findings, Error> {
    find_laid(web, None, by)
}

/// [`find`] of a web that has been laid already, if it is given.
///
/// # Errors
/// As [`find`].
pub fn find_laid(web: &Web, laid: Option<LaidWeb>, by: RunContext<'_>) -> Result<Findings, Error> {
    let sheet = &web.sheet;
    let SheetPosition { reach, columns } = across(web);
    let sides = sides(sheet, &columns);
    let margins = [columns.start, sheet.cells()[0] - columns.end].map(|cells| cells as f64 * sheet.cell);
    if columns.is_empty() || (sides.is_empty() && !sheet.patches.is_empty()) {
        let smallest = sheet.patches.iter().copied().fold(f64::INFINITY, f64::min);
        let [left, right, width, smallest] =
            [margins[0], margins[1], sheet.width, smallest].map(|size| Dimension::Length.pretty(size));
        let message = format!(
            "the edges of the web, where it is thin, take {left} and {right} of its width of {width} (3 σ_CD \
            inwards of the outermost filament), and no two patches of {smallest} fit between them"
        );
        return Err(Fault::new(message, "write web.edges = \"periodic\", or a larger web.width").into());
    }
    let laid = laid.map_or_else(|| lay(web, by), Ok)?;
    let evidence = laid.evidence();
    // The progress is that of the web; what comes after it is short.
    let aside = AtomicU64::new(0);
    let by = RunContext { done: &aside, ..by };
    let map = laid.map.between(columns.clone());
    let sample = OneFibre { cell: sheet.cell, fibres: ALONE, seed: web.seed };
    let alone = match paths(web) {
        Some(layers) => Some(expected(web, layers, &sides, sample, columns.clone(), by)?),
        None => None,
    };
    // Without defects, all streaks of filaments in one air are random. With them, those of holes at random are, and the
    // rest counts as the same in all webs.
    let width = columns.len() as f64 * sheet.cell;
    let places = match evidence {
        Evidence::Known => web.places(width),
        _ if web.layers.iter().all(|layer| layer.defects.is_empty()) => Places::Unknown,
        _ => web.places_in_one_air(width),
    };
    let mut patches = Vec::new();
    let uneven = try_par_map(by.threads, sides.len(), |i| Ok(unevenness_at(&map, sides[i], &places)))?;
    for (i, map) in uneven.into_iter().enumerate() {
        let Some(map) = map else { continue };
        let single_fibres = alone.as_ref().map(|alone| alone[i].cv);
        let straight_fibres =
            alone.as_ref().map_or_else(|| straight(web, map.patch), |alone| alone[i].straight_fibres);
        let few = of_all_layers(web, &laid, map);
        let warning = laid.few().find_map(|few| few.warning_over(map.patch));
        let (of_map, is_reported) = (map.cv, warning.is_none());
        let map = match (evidence, few) {
            (_, Some(few)) if is_reported => PatchCv { cv: few.cv, standard_error: few.by_chance, ..map },
            // A map of pieces of another sheet says nothing of chance.
            (Evidence::FewInOneAir, _) => PatchCv { standard_error: None, ..map },
            _ => map,
        };
        patches.push(PatchFindings { few, warning, of_map, map, single_fibres, straight_fibres, evidence });
    }
    put_in_order(&mut patches);
    let seen = nearest_to_seen(patches.iter().map(|patch| patch.map.patch));
    let side = seen.map_or(1, |i| (patches[i].map.patch / sheet.cell).round() as usize);
    let variance =
        variance_of_mean(&map, side, width / sheet.width, &web.places(width)) + web.variance_by_defects();
    let error_of_weight = Some(variance.sqrt()).filter(|error| error.is_normal());
    let lags = ((LAG / sheet.cell).round() as usize + 1).min(LAGS);
    // The layer that the filling determines least.
    let off = |few: &&SubsampleEstimate| few.octaves.iter().map(|(_, off)| *off).fold(0.0, f64::max);
    let worst = laid.few().max_by(|a, b| off(a).total_cmp(&off(b)));
    let filling = worst.map_or_else(Vec::new, |few| few.octaves.clone());
    let of_weight = error_of_weight.filter(|_| evidence == Evidence::Known).unwrap_or(0.0);
    // A map of too few filaments has clouds that say as little as its CVs.
    let are_too_few = !patches.is_empty() && patches.iter().all(|patch| patch.warning.is_some());
    let of_weight = Some(of_weight).filter(|_| !are_too_few);
    let clouds = Clouds::at(&map, &places, by.threads)
        .map(|clouds| clouds.with_filling(filling).with_error_of_weight(of_weight));
    let autocorrelation = autocorrelation(&map, lags, by.threads);
    let orientation = orientation(web, by)?;
    drop(map);
    let surrogate = web.layers.first().and_then(|layer| layer.fibres.surrogate());
    Ok(Findings {
        fibre_length: web.fibre_length(),
        surrogate,
        orientation,
        clouds,
        autocorrelation,
        error_of_weight,
        patches,
        margins,
        reach,
        laid,
    })
}

/// Makes the CVs of a sample fall with the side of the patches. Patches that consist of whole smaller ones are no more
/// non-uniform than these, but a sample may have a larger CV there: the one with the larger error gives way, and the
/// smaller patches where the errors are equal or not known.
fn put_in_order(patches: &mut [PatchFindings]) {
    let mut order: Vec<usize> = (0..patches.len()).collect();
    order.sort_by(|a, b| patches[*a].map.patch.total_cmp(&patches[*b].map.patch));
    let is_whole = |small: &PatchFindings, large: &PatchFindings| {
        let times = large.map.patch / small.map.patch;
        times > 1.5 && (times - times.round()).abs() < 1e-6
    };
    let error = |patch: &PatchFindings| patch.with_total_error().and_then(|patch| patch.standard_error);
    let is_known_better = |one: &PatchFindings, other: &PatchFindings| {
        error(one).is_some_and(|own| error(other).is_none_or(|other| own < other))
    };
    for i in order.iter().rev() {
        let small = patches[*i];
        let larger =
            patches.iter().filter(|large| is_whole(&small, large) && !is_known_better(&small, large));
        let larger = larger.filter_map(PatchFindings::reported);
        patches[*i].set_sample_cv(larger.map(|large| large.cv).fold(small.map.cv, f64::max));
    }
    for i in order {
        let large = patches[i];
        let smaller =
            patches.iter().filter(|small| is_whole(small, &large) && is_known_better(small, &large));
        patches[i].set_sample_cv(smaller.map(|small| small.map.cv).fold(large.map.cv, f64::min));
    }
}

/// The CV of straight fibres in all directions in place of the layers.
fn straight(web: &Web, patch: f64) -> f64 {
    let squares = web.layers.iter().map(|layer| {
        let weight = layer.basis_weight(&web.sheet);
        (weight / web.basis_weight() * straight_fibres(weight / layer.linear_density, patch)).powi(2)
    });
    squares.sum::<f64>().sqrt()
}

/// What the few filaments of all layers say together.
///
/// Where they have laid the whole sheet, its map has what the places of the filaments, their defects and the layers
/// do together at random, and only what filling them in makes of it is taken away. On a sheet of pieces the layers,
/// whose airs are independent of each other, add up their variances.
fn of_all_layers(web: &Web, laid: &LaidWeb, map: PatchCv) -> Option<SubsampleCv> {
    let weights: Vec<f64> = web.layers.iter().map(|layer| layer.basis_weight(&web.sheet)).collect();
    let whole = weights.iter().sum::<f64>();
    let is_whole = is_whole(web, laid);
    let of_layer = |(weight, simulated): (&f64, &LayerFlown)| match &simulated.few {
        // All of its filaments are on the map.
        None => is_whole.then_some(None),
        Some(few) => Some(Some((weight / whole, few.on_sheet(map.patch)?))),
    };
    let layers: Vec<_> = weights.iter().zip(&laid.simulated).map(of_layer).collect::<Option<_>>()?;
    let layers: Vec<(f64, SubsampleCv)> = layers.into_iter().flatten().collect();
    if layers.is_empty() {
        return None;
    }
    let sum = |of: &dyn Fn(&SubsampleCv) -> f64, power: i32| {
        layers.iter().map(|(share, few)| (share.powi(2) * of(few)).powi(power)).sum::<f64>()
    };
    let square = sum(&|few| few.cv * few.cv, 1);
    let cv = square.sqrt();
    // The errors of sums of squares, as one of their root. What layers have in common at random is as much as their
    // waves are alike: at most, their sampling errors add up. Sheets in other airs have nothing in common.
    let is_of_levels = laid
        .simulated
        .iter()
        .all(|layer| layer.few.as_ref().is_some_and(SubsampleEstimate::is_of_two_levels));
    let chance = |few: &SubsampleCv| few.cv * few.by_chance.unwrap_or(f64::NAN);
    let by_chance = if is_of_levels { sum(&chance, 2).sqrt() } else { sum(&chance, 1) } / cv;
    let estimate = SubsampleCv {
        patch: map.patch,
        cv,
        by_chance: Some(by_chance).filter(|error| error.is_finite()),
        by_pitch: sum(&|few| few.cv * few.by_pitch, 2).sqrt() / cv,
        of_halves: sum(&|few| few.cv * few.cv * few.of_halves, 1) / square,
        by_missing: sum(&|few| few.cv * few.cv * few.by_missing, 1) / square,
        own: sum(&|few| few.own, 1),
        few: sum(&|few| few.few * few.few, 1).sqrt(),
        beyond_filling: sum(&|few| few.beyond_filling, 1),
        beyond_sheet: sum(&|few| few.beyond_sheet, 1),
    };
    if !is_whole {
        return Some(estimate);
    }
    let estimate = estimate.with_square(map.cv * map.cv + estimate.beyond_filling + estimate.beyond_sheet);
    if is_of_levels {
        return Some(estimate);
    }
    Some(SubsampleCv { by_chance: map.standard_error.map(|error| error * map.cv / estimate.cv), ..estimate })
}

/// Whether the filaments of every layer of which few were simulated have laid the whole sheet.
fn is_whole(web: &Web, laid: &LaidWeb) -> bool {
    laid.few().all(|few| few.sheet == [web.sheet.width, web.sheet.length])
}

/// The standard error of the CV of a map, by its causes [as the CV].
///
/// What the flight itself leaves out (its mesh, its time step, its drag law) is not in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorBudget {
    /// By chance: another piece of the same web has another CV. None if the sheet is too small to say.
    pub chance: Option<f64>,
    /// By the filaments that were simulated, which are few. None if nothing was simulated, or if they do not give it.
    pub flight: Option<f64>,
}

impl ErrorBudget {
    /// All causes together; None if one of them is not known.
    ///
    /// The square of a difference and the square of its standard error together are what the square of the
    /// true difference is on average, so the squares add up.
    pub fn whole(&self) -> Option<f64> {
        Some(self.chance?.hypot(self.flight?))
    }
}

/// Part of the variance that filled-in filaments may miss where small patches of the map are to be believed.
const MISSING: f64 = 0.1;
/// How much larger an error may be than the wanted one.
const WITHIN: f64 = 1.001;
/// A map whose CV is farther from the reported one, as a share of it, is another one.
const OF_MAP: f64 = 0.05;

impl Findings {
    /// What must be known of these numbers before they are believed.
    pub fn warnings(&self, web: &Web) -> Vec<WebWarning> {
        let laid = &self.laid;
        let mut warnings = match laid.evidence() {
            Evidence::Known if self.patches.is_empty() => Vec::new(),
            Evidence::Known => vec![WebWarning::NothingFlown],
            _ => [lost(web, laid), few_filaments(web, self), unsure(laid), charged(laid)].concat(),
        };
        if laid.cut > 0.0 {
            let whole = laid.map.total() as f64 * laid.map.quantum + laid.cut;
            warnings.push(WebWarning::CutOff { share: laid.cut / whole });
        }
        if self.margins != [0.0; 2] {
            warnings.push(WebWarning::ThinEdges { margins: self.margins });
        }
        let unsure = self.patches.iter().filter_map(PatchFindings::reported);
        let unsure = unsure.filter(|map| map.standard_error.is_none());
        warnings.extend(of_sides(unsure.map(|map| map.patch), |sides| WebWarning::NoError { sides }));
        warnings
    }
}

/// A warning about patches of these sides [m]; none if there are none.
fn of_sides(
    sides: impl Iterator<Item = f64>,
    warning: impl FnOnce(Vec<f64>) -> WebWarning,
) -> Option<WebWarning> {
    let sides: Vec<f64> = sides.collect();
    (!sides.is_empty()).then(|| warning(sides))
}

/// Filaments of a web in shared turbulence that were lost.
fn lost(web: &Web, laid: &LaidWeb) -> Vec<WebWarning> {
    let count = |(layer, simulated): (&Layer, &LayerFlown)| {
        simulated.few.as_ref().map_or_else(|| layer.count(&web.sheet), |few| few.filaments + few.lost)
    };
    let others = laid.few().map(|few| few.on_other_sheets + few.lost_on_other_sheets).sum::<u64>();
    let of = web.layers.iter().zip(&laid.simulated).map(count).sum::<u64>() + others;
    let lost = laid.simulated.iter().map(|layer| layer.lost).sum::<u64>()
        + laid.few().map(|few| few.lost_on_other_sheets).sum::<u64>();
    let lost = Some(lost).filter(|lost| *lost > 0);
    lost.map(|filaments| WebWarning::Lost { filaments, of }).into_iter().collect()
}

/// Layers whose CV is not known to the wanted error.
fn unsure(laid: &LaidWeb) -> Vec<WebWarning> {
    let of_layer = |few: &SubsampleEstimate| {
        let number = nearest_to_seen(few.cvs.iter().map(|cv| cv.patch))?;
        let (wanted, cv) = (few.wanted?, few.cvs[number]);
        let reached = cv.by_chance?.hypot(cv.by_pitch) / cv.cv;
        let by_sample = cv.by_pitch / cv.cv;
        (reached > WITHIN * wanted).then_some(WebWarning::Unsure {
            wanted,
            reached,
            by_sample,
            area: few.area,
        })
    };
    laid.few().filter_map(of_layer).collect()
}

/// Whether charged filaments would keep their charge.
fn charged(laid: &LaidWeb) -> Vec<WebWarning> {
    let field = laid.charged().map(|(_, charged)| charged.edge_field).fold(0.0, f64::max);
    (field > STRONG).then_some(WebWarning::StrongField { field }).into_iter().collect()
}

/// Whether the few filaments that were simulated are enough for what is reported of all.
fn few_filaments(web: &Web, findings: &Findings) -> Vec<WebWarning> {
    let few = || findings.laid.few();
    let too_few = few().filter_map(|few| {
        let why = few.warning()?;
        let sides = few.cvs.iter().map(|cv| cv.patch).filter(|patch| few.warning_over(*patch).is_some());
        let (pitch, enough) = (few.pitch, few.enough_per_metre());
        Some(WebWarning::Subsample { sides: sides.collect(), why, pitch, enough })
    });
    let mut warnings: Vec<WebWarning> = too_few.collect();
    let missing = few().flat_map(|few| few.missing).fold(0.0, f64::max);
    let apart = |patch: &PatchFindings| Some((patch.map.patch, patch.of_map / patch.reported()?.cv - 1.0));
    let apart: Vec<(f64, f64)> = findings.patches.iter().filter_map(apart).collect();
    let off: Vec<(f64, f64)> = apart.into_iter().filter(|(_, apart)| apart.abs() > OF_MAP).collect();
    let most = off.iter().map(|(_, apart)| *apart).max_by(|a, b| a.abs().total_cmp(&b.abs()));
    let (sides, apart): (Vec<f64>, f64) = (off.iter().map(|(side, _)| *side).collect(), most.unwrap_or(0.0));
    match is_whole(web, &findings.laid) {
        // Pieces make clouds of their own.
        false => {
            warnings.extend((!sides.is_empty()).then_some(WebWarning::Pieces { sides, apart }));
            let sides = Vec::new();
            warnings.extend((missing > MISSING).then_some(WebWarning::FilledIn {
                missing,
                sides,
                apart: 0.0,
            }));
        }
        true if missing > MISSING || !sides.is_empty() => {
            warnings.push(WebWarning::FilledIn { missing, sides, apart });
        }
        true => {}
    }
    let is_of_map = |patch: &&PatchFindings| {
        matches!((patch.evidence, patch.few, patch.warning), (Evidence::FewInOneAir, None, None))
    };
    let of_map = findings.patches.iter().filter(is_of_map).map(|patch| patch.map.patch);
    warnings.extend(of_sides(of_map, |sides| WebWarning::SmallSheet { sides }));
    warnings
}

#[cfg(test)]
#[allow(clippy::panic)]
mod tests;
