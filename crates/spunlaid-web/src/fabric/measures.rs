//! What is reported of a fabric, of its patches and strips.

use super::{Fabric, FabricPatch, Marked, Streak, Strips};
use spunlaid_ground::Formula::Reported;
use spunlaid_ground::Known::Exact;
use spunlaid_ground::measure::figure;
use spunlaid_ground::{Figure, MILLIMETRES, Measure, PER_SQUARE_METRE, PERCENT, RATIO, Unit};

type OfFabric = Measure<Fabric>;
type OfPatch = Measure<FabricPatch>;
type OfStrips = Measure<Strips>;
type OfPlace = Measure<Marked>;
type OfStreak = Measure<Streak>;

const THIN_PLACES: Figure =
    figure("thin_places", "Patches lighter than 80 % of the mean", "number of thin spots");
const WEAKEST: Figure =
    Figure { from_zero: false, ..figure("weakest_section", "Weakest section of a strip", "weakest section") };

const METRES: Unit = Unit { shown: "m", per_si: 1.0 };

/// The numbers of a whole fabric.
pub const FABRIC_MEASURES: &[Measure<Fabric>] = &[
    OfFabric::new("width_m", "Width", MILLIMETRES, Reported(|fabric| Some(Exact(fabric.width))))
        .meaning("width of the part of the web for these numbers"),
    OfFabric::new("trim_m", "Trim", MILLIMETRES, Reported(|fabric| fabric.trim.map(Exact)))
        .meaning("width cut off at both edges together"),
    OfFabric::new(
        "usable_width_m",
        "Width within the tolerance of the weight",
        MILLIMETRES,
        Reported(|fabric| Some(Exact(fabric.usable?.width))),
    )
    .short("Width within tolerance")
    .meaning(
        "width in which the profile across this map, averaged over 20 mm, is within the tolerance of \
         the mean of the middle half",
    )
    .named("usable_width"),
    OfFabric::new(
        "usable_trim",
        "Trim to that width",
        PERCENT,
        Reported(|fabric| Some(Exact(fabric.usable?.trim))),
    )
    .meaning("its trim, as a fraction of the web"),
    OfFabric::new(
        "stiffness_ratio",
        "Stiffness MD/CD, of the directions alone",
        RATIO,
        Reported(|fabric| fabric.stiffness_ratio),
    )
    .short("Stiffness MD/CD")
    .meaning(
        "stiffness along MD over that along CD, ⟨cos⁴⟩/⟨sin⁴⟩ of the laid fibres, within 20 %, \
         without curl within a piece and bonds",
    )
    .named("stiffness_ratio"),
    OfFabric::new("bare_area", "Bare area", PERCENT, Reported(|fabric| fabric.bare))
        .meaning(
            "fraction of the area that no fibre covers, for round fibres that lie independently within 2 \
         mm: bonds lower it, ropes raise it",
        )
        .named("bare_area")
        .main()
        .figure(&figure("bare_area", "Bare area", "bare area")),
    OfFabric::new(
        "solid_fraction",
        "Fibre volume fraction",
        PERCENT,
        Reported(|fabric| Some(Exact(fabric.air?.solid))),
    )
    .short("Fibre by volume")
    .meaning("volume of the fibre over that of the fabric"),
    OfFabric::new(
        "air_permeability_m_s",
        "Air permeability",
        Unit { shown: "m/s", per_si: 1.0 },
        Reported(|fabric| Some(fabric.air?.permeability)),
    )
    .meaning(
        "mean speed of the air at the pressure of the test, over patches of 2 mm, from half to twice the \
         permeability by the formulas of Davies and of Jackson and James. Only the ratio of two webs is reliable",
    )
    .named("air_permeability")
    .figure(&figure("air_permeability", "Air permeability", "air permeability")),
    OfFabric::new(
        "air_permeability_cv",
        "CV of the air permeability over 20 cm²",
        PERCENT,
        Reported(|fabric| fabric.air?.spread),
    )
    .short("Its CV over 20 cm²")
    .meaning("coefficient of variation of the speed of the air over areas of 20 cm², because of the clouds")
    .named("air_permeability_cv"),
    OfFabric::new("opacity", "Opacity", PERCENT, Reported(|fabric| Some(fabric.opacity?.mean)))
        .meaning("mean opacity of patches of 2 mm, from the measured one")
        .named("opacity"),
    OfFabric::new(
        "opacity_spread",
        "Standard deviation of the opacity over 2 mm",
        PERCENT,
        Reported(|fabric| Some(fabric.opacity?.spread)),
    )
    .short("Its standard deviation over 2 mm")
    .meaning("standard deviation of the opacity over patches of 2 mm, because of the clouds")
    .named("opacity_spread"),
];

/// The numbers of the patches of one size.
pub const FABRIC_PATCH_MEASURES: &[Measure<FabricPatch>] = &[
    OfPatch::new("patch_m", "Patch", MILLIMETRES, Reported(|patch| Some(Exact(patch.thin.patch))))
        .meaning("side of the square patches"),
    OfPatch::new("formation", "Formation number", RATIO, Reported(|patch| patch.formation))
        .meaning("CV² over that of straight fibres at random, which have 1; a cloudy web has more")
        .kept("formation_#_mm", "formation_#_mm"),
    OfPatch::new(
        "lighter_than_50_percent_per_m2",
        "Lighter than 50 %",
        PER_SQUARE_METRE,
        Reported(|patch| Some(patch.thin.lighter[0])),
    )
    .meaning("patches lighter than this fraction of the mean, per area")
    .kept("lighter_than_50_percent_#_mm", "lighter_than_50_percent_#_mm_per_m2"),
    OfPatch::new(
        "lighter_than_70_percent_per_m2",
        "Lighter than 70 %",
        PER_SQUARE_METRE,
        Reported(|patch| Some(patch.thin.lighter[1])),
    )
    .meaning("patches lighter than this fraction of the mean, per area")
    .kept("lighter_than_70_percent_#_mm", "lighter_than_70_percent_#_mm_per_m2"),
    OfPatch::new(
        "lighter_than_80_percent_per_m2",
        "Lighter than 80 %",
        PER_SQUARE_METRE,
        Reported(|patch| Some(patch.thin.lighter[2])),
    )
    .meaning("patches lighter than this fraction of the mean, per area")
    .kept("lighter_than_80_percent_#_mm", "lighter_than_80_percent_#_mm_per_m2")
    .main()
    .figure(&THIN_PLACES)
    .series("# mm"),
    OfPatch::new(
        "heavier_than_130_percent_per_m2",
        "Heavier than 130 %",
        PER_SQUARE_METRE,
        Reported(|patch| Some(patch.thin.heavier)),
    )
    .meaning("patches heavier than this fraction of the mean, per area")
    .kept("heavier_than_130_percent_#_mm", "heavier_than_130_percent_#_mm_per_m2"),
    OfPatch::new(
        "weight_of_1_percent",
        "Lightest 1 %",
        PERCENT,
        Reported(|patch| Some(patch.thin.quantiles[0])),
    )
    .meaning("weight over the mean below which this fraction of the patches lies")
    .kept("weight_of_1_percent_#_mm", "weight_of_1_percent_#_mm"),
    OfPatch::new(
        "weight_of_5_percent",
        "Lightest 5 %",
        PERCENT,
        Reported(|patch| Some(patch.thin.quantiles[1])),
    )
    .meaning("weight over the mean below which this fraction of the patches lies"),
    OfPatch::new("median_weight", "Median", PERCENT, Reported(|patch| Some(patch.thin.quantiles[2])))
        .meaning("weight over the mean below which this fraction of the patches lies"),
    OfPatch::new(
        "weight_of_95_percent",
        "Heaviest 5 %",
        PERCENT,
        Reported(|patch| Some(patch.thin.quantiles[3])),
    )
    .meaning("weight over the mean below which this fraction of the patches lies"),
    OfPatch::new(
        "weight_of_99_percent",
        "Heaviest 1 %",
        PERCENT,
        Reported(|patch| Some(patch.thin.quantiles[4])),
    )
    .meaning("weight over the mean below which this fraction of the patches lies"),
];

/// The numbers of the strips in one direction.
pub const STRIP_MEASURES: &[Measure<Strips>] = &[
    OfStrips::new("strips", "Strips", RATIO, Reported(|strips| Some(Exact(strips.count as f64))))
        .meaning("number of strips on the sheet"),
    OfStrips::new("section_m", "Section", MILLIMETRES, Reported(|strips| Some(Exact(strips.size.section))))
        .meaning("length of a section of a strip, in whole cells"),
    OfStrips::new("weakest_section", "Weakest section", PERCENT, Reported(|strips| Some(strips.weakest)))
        .meaning(
            "weight of the lightest section of a strip over the mean of the strip, the mean of all strips",
        )
        .kept("weakest_section_#", "weakest_section_#")
        .main()
        .figure(&WEAKEST)
        .series("#"),
    OfStrips::new(
        "weakest_section_cv",
        "CV of the weakest section",
        PERCENT,
        Reported(|strips| strips.scatter),
    )
    .meaning("standard deviation of the weakest section over its mean, from strip to strip"),
    OfStrips::new(
        "weakest_section_of_5_percent",
        "5 % of strips are below",
        PERCENT,
        Reported(|strips| strips.low),
    )
    .meaning("the weakest section below which one strip in twenty is"),
    OfStrips::new("sections_cv", "CV of all sections", PERCENT, Reported(|strips| Some(strips.sections)))
        .meaning("standard deviation of a section about the mean of its strip, over that mean")
        .kept("sections_cv_#", "sections_cv_#"),
];

/// The numbers of one of the thinnest places.
pub const THINNEST_PATCH_MEASURES: &[Measure<Marked>] = &[
    OfPlace::new("across_m", "Across", MILLIMETRES, Reported(|place| Some(Exact(place.middle()[0]))))
        .meaning("middle of the patch across the sheet, from the edge of the map")
        .digits(5),
    OfPlace::new("along_m", "Along", MILLIMETRES, Reported(|place| Some(Exact(place.middle()[1]))))
        .meaning("middle of the patch along the sheet, from its beginning")
        .digits(5),
    OfPlace::new("weight", "Weight", PERCENT, Reported(|place| Some(Exact(place.weight)))).meaning(
        "weight of the patch over the mean: the lightest patch, then the lightest ones that are at \
         least half a side apart",
    ),
];

/// The numbers of the streak that a defect of the line leaves.
pub const STREAK_MEASURES: &[Measure<Streak>] = &[
    OfStreak::new("place_m", "Position", MILLIMETRES, Reported(|streak| Some(Exact(streak.place))))
        .meaning("middle of the streak across the sheet"),
    OfStreak::new("holes", "Holes", RATIO, Reported(|streak| Some(Exact(streak.holes as f64))))
        .meaning("holes that make it"),
    OfStreak::new("band_m", "Band", MILLIMETRES, Reported(|streak| Some(Exact(streak.band))))
        .meaning("width over which it is looked for"),
    OfStreak::new("dip", "Dip", PERCENT, Reported(|streak| Some(Exact(streak.dip)))).meaning(
        "fraction by which the band is lighter than the web next to it, because of the missing filaments; \
         below zero where it is heavier",
    ),
    OfStreak::new("dip_of_map", "Dip in this map", PERCENT, Reported(|streak| streak.found)).meaning(
        "the same in this map, with its sampling error; a dip of more than two standard errors can be seen",
    ),
    OfStreak::new("length_m", "Detectable from a length of", METRES, Reported(|streak| streak.length))
        .meaning(
            "length of a scan from which on the dip is significant at 95 %; none where the web has other \
             streaks as large, or is too small",
        ),
];
