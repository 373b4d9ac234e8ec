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

#[cfg(test)]
mod tests {
    use super::super::few_findings::SubsampleCv;
    use super::super::uniformity::PatchCv;
    use super::*;

    /// The number of each measure of a patch, with those of its errors.
    fn numbers(found: &PatchFindings) -> Vec<(&'static str, Option<f64>)> {
        let of = |measure: &OfPatch| match measure.formula {
            Known(number) => (measure.entry(), number(found)),
            _ => (measure.entry(), None),
        };
        PATCH_MEASURES
            .iter()
            .flat_map(|measure| std::iter::once(of(measure)).chain(measure.errors.iter().map(of)))
            .collect()
    }

    /// What is there of a patch is what is known of it; the sampling error 0.05 of 0.2 has eight degrees of freedom.
    #[test]
    fn analytic_the_measures_of_a_patch() {
        let map = PatchCv { patch: 10e-3, cv: 0.2, standard_error: Some(0.05) };
        let few = SubsampleCv { cv: 0.2, by_pitch: 0.12, own: 0.01, ..SubsampleCv::UNKNOWN };
        let single_fibres = Some((0.15, Some(0.02)));
        let of = |evidence: Evidence, few: Option<SubsampleCv>| {
            numbers(&PatchFindings {
                map,
                single_fibres,
                straight_fibres: 0.1,
                evidence,
                few,
                warning: None,
                of_map: 0.19,
            })
        };
        let check = |found: Vec<(&'static str, Option<f64>)>, wanted: [Option<f64>; 9]| {
            let columns = [
                "cv",
                "cv_standard_error",
                "cv_degrees",
                "cv_sample_error",
                "cv_total_error",
                "cv_of_map",
                "own_share",
                "cv_independent",
                "cv_one_fibre",
            ];
            for (column, wanted) in columns.into_iter().zip(wanted) {
                let (_, number) = found.iter().find(|(own, _)| *own == column).unwrap();
                let is_same = match (number, wanted) {
                    (Some(number), Some(wanted)) => (number - wanted).abs() < 1e-12,
                    (number, wanted) => number.is_none() && wanted.is_none(),
                };
                assert!(is_same, "{column}: {number:?} {wanted:?}");
            }
        };
        // Tables have what is expected of known filaments, or what independent ones would give.
        let is_shown = |evidence: Evidence, column: &str| {
            let patch = PatchFindings {
                map,
                single_fibres,
                straight_fibres: 0.1,
                evidence,
                few: None,
                warning: None,
                of_map: 0.19,
            };
            PATCH_MEASURES.iter().any(|measure| measure.entry() == column && (measure.is_shown)(&patch))
        };
        for (evidence, is_known) in [(Evidence::Known, true), (Evidence::AllInOneAir, false)] {
            assert_eq!(is_shown(evidence, "cv_one_fibre"), is_known);
            assert_eq!(is_shown(evidence, "cv_independent"), !is_known);
        }
        let (cv, error, degrees) = (Some(0.2), Some(0.05), Some(8.0));
        check(of(Evidence::Known, None), [cv, error, degrees, None, None, None, None, None, Some(0.15)]);
        let known = of(Evidence::Known, None);
        assert!(known.contains(&("cv_one_fibre_standard_error", Some(0.02))));
        assert!(known.contains(&("cv_straight_fibres", Some(0.1))));
        let all = [cv, error, degrees, Some(0.0), error, None, None, Some(0.15), None];
        check(of(Evidence::AllInOneAir, None), all);
        let sample = [cv, error, degrees, Some(0.12), Some(0.13), Some(0.19), Some(0.25), Some(0.15), None];
        check(of(Evidence::FewInOneAir, Some(few)), sample);
    }
}
