//! Everything that is reported of a fabric.

use super::air_through::{Filaments, air_permeability, sensitivity, solid_fraction};
use super::light::{LOCAL, bare_area, formation as formation_number, local_weights};
use super::marks::Marks;
use super::patches::{ThinPlaces, thin_places, weights};
use super::streaks::{Streak, StreakSource, streaks};
use super::strips::{Strips, strips};
use super::usable::{Usable, usable};
use super::{Deviations, FabricKeys, MapUncertainty, light};
use crate::map::lattice::{Chance, Lattice};
use crate::map::uniformity::{PatchCv, patch_cv};
use crate::map::{Map, Orientation, straight_fibres};
use crate::scan::{Findings, PatchFindings};
use spunlaid_fibre::body::{diameter_of, linear_density};
use spunlaid_ground::threads::par_map;
use spunlaid_ground::{Dimension, Known};
use std::borrow::Cow;
use std::ops::Range;

/// Sides of the patches of which thin spots are reported [m].
pub const PATCHES: [f64; 5] = [1e-3, 2e-3, 5e-3, 10e-3, 20e-3];
/// Area of a test of the air permeability (ISO 9073-15) [m²], and side of the patches over which the opacity
/// varies [m].
const AIR_AREA: f64 = 20e-4;
const OPACITY_PATCH: f64 = 2e-3;
/// A patch may be so much larger or smaller than it is called, to be one of whole cells.
pub const ABOUT: f64 = 0.05;
/// Fewest areas whose spread is reported.
const FEWEST: usize = 12;

/// What was laid.
#[derive(Clone, Debug)]
pub struct Laid<'a> {
    /// The map of the sheet.
    pub map: &'a Map,
    /// Widths of the strips at its edges that are left out [m].
    pub margins: [f64; 2],
    /// Where the web begins and ends across the sheet [m]; None of a scan.
    pub reach: Option<[f64; 2]>,
    /// Its filaments; none of a scan, of which they are not known.
    pub filaments: Vec<Filaments>,
    /// Directions of the fibres, if they are known.
    pub orientation: Option<&'a Orientation>,
    /// Its CV over patches of some sides.
    pub patches: Vec<LaidPatch>,
    /// Whether its streaks are chance.
    pub streaks: bool,
    /// Standard error of the mean basis weight of the part that is described, as a fraction of it.
    pub error_of_weight: f64,
    /// Defects of the line.
    pub defects: Vec<StreakSource>,
}

/// The CV over patches of one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LaidPatch {
    /// Their side [m].
    pub patch: f64,
    /// The CV of the web; None if it is not known.
    pub reported: Option<PatchCv>,
    /// The share by which the deviations of the map would have to be larger; None if it is not known.
    pub off: Option<f64>,
}

impl Laid<'_> {
    /// How far the deviations over patches of a side may be off: as over those of the nearest side. None if it is not
    /// known.
    fn deviations(&self, patch: f64) -> Option<Deviations> {
        let far = |of: &&LaidPatch| libm::log(of.patch / patch).abs();
        let Some(nearest) = self.patches.iter().min_by(|a, b| far(a).total_cmp(&far(b))) else {
            return Some(Deviations::default());
        };
        // On a sheet that holds too few clouds or streaks for an error of the CV, nothing else has one.
        let by_chance = match nearest.reported {
            Some(of) => of.standard_error? / of.cv,
            None => 0.0,
        };
        Some(Deviations { by_chance, of_map: nearest.off? })
    }
}

/// A fabric in the words of those who buy it.
#[derive(Clone, Debug, PartialEq)]
pub struct Fabric {
    /// Width of the part of the sheet of which all else is reported [m].
    pub width: f64,
    /// What is cut off of the web at both edges together [m]; None unless a saleable width is given.
    pub trim: Option<f64>,
    /// The width whose weight is within the tolerance; None of a web that goes on at its edges, and of a scan.
    pub usable: Option<Usable>,
    /// Patches of each side.
    pub patches: Vec<FabricPatch>,
    /// Strips along MD and along CD.
    pub strips: [Option<Strips>; 2],
    /// Places that are worth a look.
    pub marks: Marks,
    /// The streaks that defects of the line leave.
    pub streaks: Vec<Streak>,
    /// Stiffness along MD over that along CD, of the directions alone.
    pub stiffness_ratio: Option<Known>,
    /// Share of the area that no fibre covers.
    pub bare: Option<Known>,
    /// Air that is blown through.
    pub air: Option<AirThrough>,
    /// Opacity.
    pub opacity: Option<Opacity>,
    /// Whether nothing is known but the map, as of a scan.
    pub is_of_map_alone: bool,
    /// What is not reported, and why.
    pub notes: Vec<String>,
}

/// Patches of one side.
#[derive(Clone, Debug, PartialEq)]
pub struct FabricPatch {
    /// Thin and thick places.
    pub thin: ThinPlaces,
    /// CV over that of straight fibres at random, squared; None where no CV is known, or not the filaments.
    pub formation: Option<Known>,
}

/// Air that is blown through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AirThrough {
    /// Share of the volume that is fibre.
    pub solid: f64,
    /// Speed of the air [m/s].
    pub permeability: Known,
    /// Its coefficient of variation over areas of a test; None of a small sheet.
    pub spread: Option<Known>,
}

/// Opacity of the fabric.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Opacity {
    /// Mean of all patches.
    pub mean: Known,
    /// Standard deviation over patches.
    pub spread: Known,
}

/// Reports everything that is known of a fabric.
pub fn estimate(laid: &Laid<'_>, keys: &FabricKeys, threads: usize) -> Fabric {
    let (first, map) = part(laid, keys);
    let map = map.as_ref();
    let corner = first as f64 * map.cell;
    let chance = Chance { closed: map.closed, streaks: laid.streaks };
    let mut notes = unknown(laid);
    // A part holds fewer clouds and streaks than the web.
    let narrower = columns(laid.map, laid.margins).len() as f64 / map.columns as f64;
    let deviations = |patch: f64| {
        let of = laid.deviations(patch)?;
        Some(Deviations { by_chance: of.by_chance * narrower.sqrt(), ..of })
    };
    let filaments = of_this_weight(&laid.filaments, map.basis_weight());
    let (length, diameter) = lengths(&filaments);
    let whole = |patch: f64| {
        let side = (patch / map.cell).round();
        ((side * map.cell / patch - 1.0).abs() < ABOUT).then_some(side as usize)
    };
    let sides: Vec<usize> = PATCHES.into_iter().filter_map(whole).collect();
    let reported = |side: usize| {
        let same = |found: &&LaidPatch| (found.patch / (side as f64 * map.cell) - 1.0).abs() < 1e-6;
        laid.patches.iter().find(same)?.reported
    };
    // The formation number is of the part of the sheet of which the CV beside it is, whatever is sold.
    let of_cv =
        of_this_weight(&laid.filaments, laid.map.between(columns(laid.map, laid.margins)).basis_weight());
    let patches = par_map(threads, sides.len(), |i| {
        let deviations = deviations(sides[i] as f64 * map.cell);
        let thin = thin_places(map, sides[i], MapUncertainty { chance, deviations })?;
        let found = reported(sides[i]).filter(|_| length > 0.0);
        let formation = found.map(|found| formation_number(&found, at_random(&of_cv, thin.patch)));
        Some(FabricPatch { thin, formation })
    });
    let uneven = |side: usize| match (keys.saleable_width, reported(side)) {
        (None, Some(reported)) => Some(reported),
        (_, reported) => {
            let found = with_error_of(patch_cv(map, side)?, reported);
            let is_known = deviations(found.patch).is_some();
            Some(PatchCv { standard_error: found.standard_error.filter(|_| is_known), ..found })
        }
    };
    let local = laid.orientation.filter(|_| length > 0.0).and_then(|_| {
        let side = ((LOCAL / map.cell).round().max(1.0) as usize).min(map.columns.min(map.rows));
        let found = uneven(side)?;
        Some((local_weights(map, length, &found), found))
    });
    let air = (!laid.filaments.is_empty()).then(|| {
        let given = keys.thickness.zip(local.as_ref());
        let found = given
            .and_then(|(thickness, (local, _))| air(laid, map, &filaments, local, thickness, keys.pressure));
        notes.extend(found.is_none().then(|| no_permeability(&filaments, keys.thickness)));
        found
    });
    let air = air.flatten();
    let bare = local.map(|(local, found)| bare_area(&local, length, laid.error_of_weight, diameter, &found));
    let of_sections = deviations((keys.strip.width * keys.strip.section).sqrt());
    let usable = laid.reach.and_then(|reach| usable(laid.map, reach, keys.tolerance));
    notes.extend(usable.is_some().then(unknown_neck_in));
    notes.extend(laid.orientation.map(directions_of));
    Fabric {
        width: map.columns as f64 * map.cell,
        trim: keys.saleable_width.zip(laid.reach).map(|(width, [from, to])| (to - from - width).max(0.0)),
        usable,
        patches: patches.into_iter().flatten().collect(),
        strips: strips(map, keys.strip, MapUncertainty { chance, deviations: of_sections }),
        marks: Marks::new(map, corner, keys.strip),
        streaks: streaks(map, corner, &laid.defects),
        stiffness_ratio: laid.orientation.map(|of| Known::Value(of.stiffness_ratio.0, of.stiffness_ratio.1)),
        bare,
        air,
        opacity: keys.measured_opacity.and_then(|measured| {
            let scattering = light::scattering(measured);
            match keys.opacity_weight {
                None => opacity(laid, map, scattering, 0.0),
                // It follows the weight of this sheet, and so has its error.
                Some(weight) => {
                    opacity(laid, map, scattering * map.basis_weight() / weight, laid.error_of_weight)
                }
            }
        }),
        is_of_map_alone: laid.orientation.is_none(),
        notes,
    }
}

/// Why no air permeability is reported.
fn no_permeability(filaments: &[Filaments], thickness: Option<f64>) -> String {
    match thickness {
        None => "the air permeability is not known: it needs the thickness of the fabric (fabric.thickness)"
            .to_owned(),
        Some(thickness) => format!(
            "the air permeability is not known: at fabric.thickness = {} µm fibre would fill {} % of the \
            fabric, and the formulas hold up to 30 %",
            (thickness * 1e6).round(),
            (100.0 * solid_fraction(filaments, thickness)).round()
        ),
    }
}

/// Of which directions the stiffness is.
fn directions_of(orientation: &Orientation) -> String {
    format!(
        "the stiffness MD/CD is that of pieces of {} of fibre as they were laid, each straight; curls within a \
        piece, which bring it nearer to 1, are not in it",
        Dimension::Length.pretty_to(orientation.piece, 2)
    )
}

fn unknown_neck_in() -> String {
    "the neck-in is not known: filaments at the edge are assumed to land as those in the middle do, about \
    the positions at which they are fed"
        .to_owned()
}

/// The columns of a map without the strips at its edges.
fn columns(map: &Map, margins: [f64; 2]) -> Range<usize> {
    let [first, last] = margins.map(|width| (width / map.cell).round().max(0.0) as usize);
    first..map.columns - last
}

/// The part of the map that is reported of, and its first column: what is sold, or all but the edges.
fn part<'a>(laid: &Laid<'a>, keys: &FabricKeys) -> (usize, Cow<'a, Map>) {
    let within = columns_sold(laid.map, laid.margins, laid.reach, keys.saleable_width);
    (within.start, laid.map.between(within))
}

/// The columns of what is sold, or of all but the edges.
///
/// * `reach` – where the web begins and ends across the sheet [m]
/// * `saleable` – width that is sold [m]
pub fn columns_sold(
    map: &Map,
    margins: [f64; 2],
    reach: Option<[f64; 2]>,
    saleable: Option<f64>,
) -> Range<usize> {
    let cells = |width: f64| (width / map.cell).round().max(0.0) as usize;
    let all = columns(map, margins);
    let Some(width) = saleable else { return all };
    let [from, to] = reach.unwrap_or([0.0, map.columns as f64 * map.cell]);
    let middle = 0.5 * (from + to);
    let sold = cells(middle - 0.5 * width)..cells(middle + 0.5 * width).min(map.columns);
    if sold.is_empty() { all } else { sold }
}

/// The same filaments with the basis weight of a part of the sheet.
fn of_this_weight(filaments: &[Filaments], basis_weight: f64) -> Vec<Filaments> {
    let whole: f64 = filaments.iter().map(|of| of.basis_weight).sum();
    let share = |of: &Filaments| Filaments { basis_weight: of.basis_weight * basis_weight / whole, ..*of };
    filaments.iter().map(share).collect()
}

/// CV of filaments that are straight and lie at random: the variances of the kinds add up.
fn at_random(filaments: &[Filaments], patch: f64) -> f64 {
    let whole: f64 = filaments.iter().map(|of| of.basis_weight).sum();
    let square = |of: &Filaments| {
        let (length, _) = lengths(std::slice::from_ref(of));
        (of.basis_weight / whole * straight_fibres(length, patch)).powi(2)
    };
    filaments.iter().map(square).sum::<f64>().sqrt()
}

/// The CV of the part that is sold with at least the relative error of that of the web, which accounts for how few
/// filaments were simulated.
fn with_error_of(part: PatchCv, reported: Option<PatchCv>) -> PatchCv {
    let Some(reported) = reported else { return part };
    let of_web = reported.standard_error.map(|error| error / reported.cv * part.cv);
    let standard_error = part.standard_error.zip(of_web).map(|(own, of_web)| own.max(of_web));
    PatchCv { standard_error, ..part }
}

/// Length of fibre per area [1/m], and the mean of the diameter over it [m].
fn lengths(filaments: &[Filaments]) -> (f64, f64) {
    let length = |of: &Filaments| of.basis_weight / linear_density(of.diameter, of.density);
    let whole: f64 = filaments.iter().map(length).sum();
    (whole, filaments.iter().map(|of| length(of) * of.diameter).sum::<f64>() / whole)
}

fn air(
    laid: &Laid<'_>,
    map: &Map,
    filaments: &[Filaments],
    local: &[f64],
    thickness: f64,
    pressure: f64,
) -> Option<AirThrough> {
    let permeability = air_permeability(filaments, local, thickness, pressure)?;
    let factor = sensitivity(filaments, thickness, pressure).abs();
    let (_, cv) = over_patches(laid, map, AIR_AREA.sqrt(), |weight| weight)?;
    Some(AirThrough {
        solid: solid_fraction(filaments, thickness),
        permeability,
        spread: Some(cv.times(factor)),
    })
}

/// * `scattering` – of the mean weight
/// * `error` – of this weight, as a fraction of it
fn opacity(laid: &Laid<'_>, map: &Map, scattering: f64, error: f64) -> Option<Opacity> {
    let of = |weight| light::opacity(scattering * weight);
    let (mean, cv) = over_patches(laid, map, OPACITY_PATCH, of)?;
    let spread = cv.times(mean.value());
    let by_weight = 0.5 * (of(1.0 + error) - of(1.0 - error)).abs();
    let with = |number: Known, off: f64| match number {
        Known::Value(value, Some(error)) => Known::Value(value, Some(error.hypot(off))),
        other => other,
    };
    // The spread is that of the weights times the slope, which falls as the opacity rises.
    let slope = |weight: f64| of(weight * (1.0 + 1e-4)) - of(weight * (1.0 - 1e-4));
    let of_spread = 0.5 * spread.value() * (slope(1.0 + error) - slope(1.0 - error)).abs() / slope(1.0);
    Some(Opacity { mean: with(mean, by_weight), spread: with(spread, of_spread) })
}

/// Mean and CV over patches side by side of what follows from their weight. What deviations take from the mean grows
/// with their square.
fn over_patches(laid: &Laid<'_>, map: &Map, patch: f64, of: impl Fn(f64) -> f64) -> Option<(Known, Known)> {
    let (sides, weights) = weights(map, patch);
    let numbers: Vec<f64> = weights.iter().copied().map(&of).collect();
    // The weights are those over their own mean, as on a closed sheet.
    let lattice = Lattice { sides, chance: Chance { closed: [true; 2], streaks: laid.streaks } };
    let off: Vec<f64> = weights.iter().map(|weight| weight - 1.0).collect();
    let [mean, cv] = [lattice.mean(&numbers, &off), lattice.cv(&numbers, &off)];
    let by_clouds = 2.0 * (mean.value() - of(1.0));
    let of_map = laid.deviations(patch);
    let with = |number, change: f64| Deviations::add(of_map, number, |by| change * by);
    (numbers.len() >= FEWEST).then(|| (with(mean, by_clouds), with(cv, cv.value())))
}

/// Over which patches the CV of the web or its error is not known, so that nothing that follows has an error.
fn unknown(laid: &Laid<'_>) -> Vec<String> {
    let of_sides = |is_one: &dyn Fn(&LaidPatch) -> bool| {
        let sides = laid.patches.iter().filter(|of| is_one(of));
        sides.map(|of| Dimension::Length.pretty_to(of.patch, 2)).collect::<Vec<String>>().join(", ")
    };
    let unknown = of_sides(&|of| of.off.is_none());
    let has_no_error = |of: &PatchCv| of.standard_error.is_none();
    let small = of_sides(&|of| of.off.is_some() && of.reported.as_ref().is_some_and(has_no_error));
    let reasons = [
        (unknown, "the CV of the web over these is not known, and the map may have another one"),
        (small, "the sheet holds too few clouds or streaks for the error of the CV over these"),
    ];
    let note = |(sides, reason): (String, &str)| {
        format!(
            "thin spots, weights, strips, bare area and light have no error where they follow from \
            patches of {sides}: {reason}"
        )
    };
    reasons.into_iter().filter(|(sides, _)| !sides.is_empty()).map(note).collect()
}

/// Any density, of which only the length of fibre is made, which depends on the titre alone.
const DENSITY: f64 = 1000.0;

/// What a scan gives of the fabric: thin spots, weights and strips, and the formation number where basis
/// weight and titre are known.
pub fn of_scan(findings: &Findings) -> Fabric {
    let titre = findings.titre.filter(|_| findings.mean_known);
    let filaments = titre.map(|titre| Filaments {
        diameter: diameter_of(titre, DENSITY),
        density: DENSITY,
        basis_weight: findings.map.basis_weight(),
    });
    // What makes a CV doubtful does so to its patches: an assumed lamp, blur, a small sheet. Blur of other patches says
    // nothing of larger ones.
    let is_of_fabric = |side: f64| PATCHES.iter().any(|patch| (side / patch - 1.0).abs() < ABOUT);
    let counts = |of: &&PatchFindings| {
        findings.assumption.is_some() || of.interval.is_ok() || is_of_fabric(of.patch_cv.patch)
    };
    let patch = |of: &PatchFindings| LaidPatch {
        patch: of.patch_cv.patch,
        reported: Some(of.patch_cv),
        off: (findings.assumption.is_none() && of.interval.is_ok()).then_some(0.0),
    };
    let laid = Laid {
        map: &findings.map,
        margins: [0.0; 2],
        reach: None,
        filaments: filaments.into_iter().collect(),
        orientation: None,
        patches: findings.patches.iter().filter(counts).map(patch).collect(),
        streaks: true,
        error_of_weight: 0.0,
        defects: Vec::new(),
    };
    let mut fabric = estimate(&laid, &FabricKeys::USUAL, 1);
    let formation = match titre {
        Some(_) => "",
        None => {
            ", and the formation number: that needs the mean basis weight and the titre of the filaments \
            (weight, titre)"
        }
    };
    // What else is not reported needs the fibres, and that is said once.
    fabric.notes = vec![format!(
        "a scan does not show what needs its fibres: stiffness, bare area, air \
        permeability{formation}"
    )];
    if let Some(assumption) = findings.assumption {
        fabric.notes.push(format!("thin spots and strips have no errors, because {assumption}"));
    }
    fabric
}
