//! What is told of a fabric. Each number is declared once: its name, label, meaning, unit, and how it is found. `summary.json`, the
//! terminal and the report follow from it.

use super::{MILLIMETRES, PERCENT, RATIO, Unit};
use crate::fabric::{Fabric, FabricPatch, HolesOfRadius, Known, Strips};
use Known::Exact;

/// A number of a fabric, of its patches of one size, of its strips in one direction, or of its holes of one radius.
#[derive(Debug)]
pub struct FabricMeasure<T: 'static> {
    /// Name in `summary.json`, with its SI unit.
    pub name: &'static str,
    /// Its label in tables.
    pub label: &'static str,
    /// Its definition in words.
    pub meaning: &'static str,
    /// The unit in which it is shown.
    pub unit: Unit,
    /// Its value; none if this fabric has none.
    pub number: fn(&T) -> Option<Known>,
}

const PER_SQUARE_METRE: Unit = Unit { shown: "1/m²", per_si: 1.0 };
const MICROMETRES: Unit = Unit { shown: "µm", per_si: 1e6 };

/// The numbers of a whole fabric.
pub const OF_FABRICS: &[FabricMeasure<Fabric>] = &[
    FabricMeasure {
        name: "width_m",
        label: "Width that is told of",
        meaning: "width of the part of the web of which all else is told",
        unit: MILLIMETRES,
        number: |fabric| Some(Exact(fabric.width)),
    },
    FabricMeasure {
        name: "trim_m",
        label: "Trim",
        meaning: "what is cut off of the web at both edges together",
        unit: MILLIMETRES,
        number: |fabric| fabric.trim.map(Exact),
    },
    FabricMeasure {
        name: "stiffness_ratio",
        label: "Stiffness MD/CD, of the directions alone",
        meaning: "stiffness along MD over that along CD of straight fibres in these directions, within 20 %: curl and \
            bonds are not in it",
        unit: RATIO,
        number: |fabric| fabric.stiffness_ratio,
    },
    FabricMeasure {
        name: "bare_area",
        label: "Bare area",
        meaning: "share of the area that no fibre covers",
        unit: PERCENT,
        number: |fabric| Some(fabric.holes.as_ref()?.bare),
    },
    FabricMeasure {
        name: "largest_hole_m",
        label: "Radius of the largest hole in 100 cm²",
        meaning: "radius of the largest disc that fits into a hole of 100 cm², the area of the test of the hydrohead: half of all such areas have a larger one",
        unit: MICROMETRES,
        number: |fabric| Some(fabric.holes.as_ref()?.largest),
    },
    FabricMeasure {
        name: "hydrohead_pa",
        label: "Hydrohead",
        meaning: "pressure at which water comes through the largest hole",
        unit: Unit { shown: "Pa", per_si: 1.0 },
        number: |fabric| fabric.hydrohead,
    },
    FabricMeasure {
        name: "solid_fraction",
        label: "Share of the volume that is fibre",
        meaning: "volume of the fibre over that of the fabric",
        unit: PERCENT,
        number: |fabric| Some(Exact(fabric.air?.solid)),
    },
    FabricMeasure {
        name: "air_permeability_m_s",
        label: "Air permeability",
        meaning: "speed of the air at the pressure of the test, between the formulas of Davies and of Jackson and James, both with an \
            inertial term; trust the ratio of two webs, not the number",
        unit: Unit { shown: "m/s", per_si: 1.0 },
        number: |fabric| Some(fabric.air?.permeability),
    },
    FabricMeasure {
        name: "air_permeability_cv",
        label: "Spread of the air permeability over 20 cm²",
        meaning: "coefficient of variation of the speed of the air over areas of 20 cm² by the basis weight",
        unit: PERCENT,
        number: |fabric| fabric.air?.spread,
    },
    FabricMeasure {
        name: "opacity",
        label: "Opacity",
        meaning: "opacity, from that which was measured: the mean of patches of 2 mm",
        unit: PERCENT,
        number: |fabric| Some(fabric.opacity?.mean),
    },
    FabricMeasure {
        name: "opacity_spread",
        label: "Spread of the opacity over 2 mm",
        meaning: "standard deviation of the opacity over patches of 2 mm by the basis weight",
        unit: PERCENT,
        number: |fabric| Some(fabric.opacity?.spread),
    },
];

/// The numbers of the patches of one size.
pub const OF_FABRIC_PATCHES: &[FabricMeasure<FabricPatch>] = &[
    FabricMeasure {
        name: "patch_m",
        label: "Patch",
        meaning: "side of the square patches",
        unit: MILLIMETRES,
        number: |patch| Some(Exact(patch.thin.patch)),
    },
    FabricMeasure {
        name: "formation",
        label: "Formation number",
        meaning: "CV² over that of straight fibres at random, which have 1; a cloudy web has more",
        unit: RATIO,
        number: |patch| patch.formation,
    },
    FabricMeasure {
        name: "lighter_than_50_percent_per_m2",
        label: "Lighter than 50 %",
        meaning: "patches per area that are lighter than this share of the mean",
        unit: PER_SQUARE_METRE,
        number: |patch| Some(patch.thin.lighter[0]),
    },
    FabricMeasure {
        name: "lighter_than_70_percent_per_m2",
        label: "Lighter than 70 %",
        meaning: "patches per area that are lighter than this share of the mean",
        unit: PER_SQUARE_METRE,
        number: |patch| Some(patch.thin.lighter[1]),
    },
    FabricMeasure {
        name: "lighter_than_80_percent_per_m2",
        label: "Lighter than 80 %",
        meaning: "patches per area that are lighter than this share of the mean",
        unit: PER_SQUARE_METRE,
        number: |patch| Some(patch.thin.lighter[2]),
    },
    FabricMeasure {
        name: "heavier_than_130_percent_per_m2",
        label: "Heavier than 130 %",
        meaning: "patches per area that are heavier than this share of the mean",
        unit: PER_SQUARE_METRE,
        number: |patch| Some(patch.thin.heavier),
    },
    FabricMeasure {
        name: "weight_of_1_percent",
        label: "Lightest 1 %",
        meaning: "weight over the mean that this share of the patches goes below, or above",
        unit: PERCENT,
        number: |patch| Some(patch.thin.quantiles[0]),
    },
    FabricMeasure {
        name: "weight_of_5_percent",
        label: "Lightest 5 %",
        meaning: "weight over the mean that this share of the patches goes below, or above",
        unit: PERCENT,
        number: |patch| Some(patch.thin.quantiles[1]),
    },
    FabricMeasure {
        name: "median_weight",
        label: "Median",
        meaning: "weight over the mean that this share of the patches goes below, or above",
        unit: PERCENT,
        number: |patch| Some(patch.thin.quantiles[2]),
    },
    FabricMeasure {
        name: "weight_of_95_percent",
        label: "Heaviest 5 %",
        meaning: "weight over the mean that this share of the patches goes below, or above",
        unit: PERCENT,
        number: |patch| Some(patch.thin.quantiles[3]),
    },
    FabricMeasure {
        name: "weight_of_99_percent",
        label: "Heaviest 1 %",
        meaning: "weight over the mean that this share of the patches goes below, or above",
        unit: PERCENT,
        number: |patch| Some(patch.thin.quantiles[4]),
    },
];

/// The numbers of the strips in one direction.
pub const OF_STRIPS: &[FabricMeasure<Strips>] = &[
    FabricMeasure {
        name: "strips",
        label: "Strips",
        meaning: "number of strips on the sheet",
        unit: RATIO,
        number: |strips| Some(Exact(strips.count as f64)),
    },
    FabricMeasure {
        name: "section_m",
        label: "Section",
        meaning: "length of a section of a strip, in whole cells",
        unit: MILLIMETRES,
        number: |strips| Some(Exact(strips.size.section)),
    },
    FabricMeasure {
        name: "weakest_section",
        label: "Weakest section",
        meaning: "weight of the lightest section of a strip over the mean of the strip, over all strips",
        unit: PERCENT,
        number: |strips| Some(strips.weakest),
    },
    FabricMeasure {
        name: "weakest_section_cv",
        label: "Scatter of the weakest section",
        meaning: "standard deviation of the weakest section over its mean, from strip to strip",
        unit: PERCENT,
        number: |strips| strips.scatter,
    },
    FabricMeasure {
        name: "weakest_section_of_5_percent",
        label: "5 % of strips are below",
        meaning: "the weakest section below which one strip in twenty is",
        unit: PERCENT,
        number: |strips| strips.low,
    },
    FabricMeasure {
        name: "sections_cv",
        label: "Scatter of all sections",
        meaning: "standard deviation of a section about the mean of its strip, over that mean",
        unit: PERCENT,
        number: |strips| Some(strips.sections),
    },
];

/// The numbers of the holes of one radius.
pub const OF_HOLES: &[FabricMeasure<HolesOfRadius>] = &[
    FabricMeasure {
        name: "radius_m",
        label: "Radius",
        meaning: "radius of a disc",
        unit: MICROMETRES,
        number: |holes| Some(Exact(holes.radius)),
    },
    FabricMeasure {
        name: "counted",
        label: "Counted",
        meaning: "holes in the windows into which such a disc fits",
        unit: RATIO,
        number: |holes| Some(Exact(holes.counted as f64)),
    },
    FabricMeasure {
        name: "per_m2",
        label: "Holes",
        meaning: "holes per area into which such a disc fits: carried from the windows over the sheet, and where few were counted also from smaller radii",
        unit: PER_SQUARE_METRE,
        number: |holes| Some(holes.per_area),
    },
    FabricMeasure {
        name: "over_straight",
        label: "Over straight fibres",
        meaning: "holes over those of straight fibres at random with the local basis weight",
        unit: RATIO,
        number: |holes| holes.over_straight,
    },
];
