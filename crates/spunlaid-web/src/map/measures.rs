//! What is measured of a web. `summary.json`, the tables of the terminal and of the report, Python and the
//! studies follow from it.

use super::{Evidence, Findings, PatchFindings};
use ErrorRole::{Further, OfOne};
use Formula::{Known, Mean, Number};
use spunlaid_ground::measure::figure;
use spunlaid_ground::{ErrorRole, Formula, MILLIMETRES, Measure, PERCENT, RATIO, Unit};

type OfWeb = Measure<Findings>;
type OfPatch = Measure<PatchFindings>;

/// The measures of the patches of each size, in the order of `summary.json`, where the interval follows the
/// first, of the tables and of studies.
pub const PATCH_MEASURES: &[Measure<PatchFindings>] = &[
    share("cv", "CV over patches of # mm", |patch| Some(patch.reported()?.cv))
        .meaning("coefficient of variation of the basis weight of the map over square patches")
        .kept("cv_#_mm", "cv_#_mm")
        .main()
        .figure(&figure("cv", "CV of the basis weight", "CV of the web"))
        .errors(&[
            share("cv_standard_error", "Sampling error of the CV", |patch| patch.map.standard_error)
                .meaning("standard error of the CV between pieces of the same web")
                .kept("cv_#_mm_chance", "cv_#_mm_chance")
                .role(OfOne),
            OfPatch::new("cv_degrees", "", RATIO, Known(|patch| patch.map.degrees()))
                .meaning("degrees of freedom of the sampling error"),
            share("cv_sample_error", "Error of the CV by the sample", |patch| patch.total_error().flight)
                .meaning("standard error of the CV because only a sample of filaments was simulated")
                .kept("cv_#_mm_few_fibres", "cv_#_mm_few_fibres")
                .short("sample")
                .digits(2)
                .shown_if(|patch| patch.few.is_some())
                .role(Further),
            share("cv_total_error", "", |patch| patch.total_error().whole())
                .meaning("total standard error of the CV"),
        ]),
    share("cv_of_map", "", |patch| patch.few.map(|_| patch.of_map))
        .meaning("CV of the map itself, in which filaments are filled in"),
    OfPatch::new(
        "own_share",
        "",
        RATIO,
        Known(|patch| patch.few.filter(|_| patch.warning.is_none()).map(|few| few.own / (few.cv * few.cv))),
    )
    .meaning("part of CV² that each filament contributes by itself"),
    share("cv_independent", "CV of the same filaments in independent turbulence", PatchFindings::independent)
        .meaning("CV of the same filaments in independent turbulence, by their surrogate")
        .kept("cv_#_mm_independent", "cv_#_mm_independent")
        .figure(&figure(
            "cv_independent",
            "CV of the same filaments in independent turbulence",
            "CV in independent turbulence",
        ))
        .short("independent turbulence")
        .shown_if(|patch| patch.evidence != Evidence::Known),
    share("cv_one_fibre", "CV expected from single fibres", |patch| Some(of_known(patch)?.0))
        .meaning("CV that is expected of independent filaments of known numbers")
        .kept("cv_#_mm_one_fibre", "cv_#_mm_one_fibre")
        .figure(&figure("cv_one_fibre", "CV expected from single fibres", "expected CV"))
        .short("single fibres")
        .shown_if(|patch| patch.evidence == Evidence::Known)
        .errors(&[share("cv_one_fibre_standard_error", "", |patch| of_known(patch)?.1)
            .meaning("its standard error")
            .role(OfOne)]),
    share("cv_straight_fibres", "CV of straight fibres", |patch| Some(patch.straight_fibres))
        .meaning("CV of straight fibres of the same mass in all directions")
        .kept("cv_#_mm_straight_fibres", "cv_#_mm_straight_fibres")
        .figure(&figure("cv_straight_fibres", "CV of straight fibres", "CV of straight fibres"))
        .short("straight fibres")
        .digits(3),
];

/// The measures of a whole web, in the order of `summary.json` and of studies.
pub const WEB_MEASURES: &[Measure<Findings>] = &[
    OfWeb::new(
        "basis_weight_kg_m2",
        "Basis weight",
        Unit { shown: "g/m²", per_si: 1e3 },
        Number(|found| found.basis_weight().0),
    )
    .meaning("mean mass of the web per area, between its edges")
    .named("basis_weight")
    .main()
    .elsewhere()
    .figure(&figure("basis_weight", "Basis weight", "basis weight")),
    OfWeb::new(
        "fibre_length_m",
        "Length of fibre",
        Unit { shown: "km", per_si: 1e-3 },
        Number(|found| found.fibre_length),
    )
    .meaning("length of all filaments on the web")
    .named("fibre_length")
    .elsewhere(),
    OfWeb::new(
        "orientation_md",
        "Orientation along MD",
        RATIO,
        Mean(|found| {
            let cos_squared = &found.orientation.cos_squared;
            (cos_squared.mean, cos_squared.standard_error)
        }),
    )
    .meaning(
        "mean cos² of the angle between pieces of fibre and the machine direction: 0.5 without \
         orientation",
    )
    .named("orientation_md"),
    OfWeb::new("md_cd_ratio", "MD/CD", RATIO, Mean(|found| found.orientation.md_cd_ratio()))
        .meaning("length of fibre along the machine direction over that across")
        .named("md_cd_ratio")
        .main()
        .figure(&figure("md_cd_ratio", "Ratio of fibre along MD and CD", "MD/CD ratio")),
    OfWeb::new(
        "sigma_md_m",
        "Standard deviation in MD",
        MILLIMETRES,
        Known(|found| Some(found.surrogate?.sigma_md)),
    )
    .meaning("standard deviation of a filament in machine direction, of the first layer")
    .named("sigma_md")
    .elsewhere(),
    OfWeb::new(
        "sigma_cd_m",
        "Standard deviation in CD",
        MILLIMETRES,
        Known(|found| Some(found.surrogate?.sigma_cd)),
    )
    .meaning("standard deviation of a filament in cross direction, of the first layer")
    .named("sigma_cd")
    .elsewhere(),
    OfWeb::new(
        "noise_per_sqrt_m",
        "Noise of the direction",
        Unit { shown: "m^-½", per_si: 1.0 },
        Known(|found| Some(found.surrogate?.noise)),
    )
    .meaning("strength A of the noise in the direction, of the first layer")
    .named("noise")
    .elsewhere(),
];

/// A share of the patches of one size, which is shown in per cent.
const fn share(
    column: &'static str,
    label: &'static str,
    number: fn(&PatchFindings) -> Option<f64>,
) -> Measure<PatchFindings> {
    Measure { series: "# mm", ..Measure::new(column, label, PERCENT, Known(number)) }
}

/// What is expected of filaments of known numbers, with its error.
fn of_known(patch: &PatchFindings) -> Option<(f64, Option<f64>)> {
    patch.single_fibres.filter(|_| patch.evidence == Evidence::Known)
}
