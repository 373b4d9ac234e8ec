//! What is measured of a web. Each measure is declared once: its name, unit, meaning, figure, and how it is found.

use super::{Figure, Measure, PERCENT, Unit};
use crate::web::{Fibres, Findings, PatchFindings, Web};

/// A measure of a whole web.
#[derive(Debug)]
pub struct WebMeasure {
    /// What it is.
    pub measure: Measure,
    /// Its value; NaN if this web has none.
    pub number: fn(&Web, &Findings) -> f64,
}

/// A measure of the patches of one size. In `name`, `column`, `label` and `series` the sign `#` stands for their side in
/// millimetres.
#[derive(Debug)]
pub struct PatchMeasure {
    /// What it is.
    pub measure: Measure,
    /// Its value; NaN if this web has none.
    pub number: fn(&PatchFindings) -> f64,
    /// The measure, by its end after `cv_#`, that is its standard error.
    pub error: Option<Deviation>,
    /// Further errors of the same measure, which more replicates do not lower, by their ends after `cv_#`.
    pub causes: &'static [&'static str],
}

/// Where the standard error of a measure comes from, if not from the replicates alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deviation {
    /// From this measure where there is a single replicate.
    OfOne(&'static str),
    /// Always from this measure: all replicates share what causes it.
    Always(&'static str),
}

/// The measures of the patches of each size, in the order of the tables.
pub const OF_PATCHES: &[PatchMeasure] = &[
    PatchMeasure {
        measure: Measure {
            name: "cv_#_mm",
            column: "cv_#_mm",
            label: "CV over patches of # mm",
            meaning: "coefficient of variation of the basis weight of the map over square patches of this side",
            figure: &CV,
            series: "# mm",
            ..SHARE
        },
        number: |patch| patch.map.cv,
        error: Some(Deviation::OfOne("_mm_chance")),
        causes: &["_mm_few_fibres", "_mm_model"],
    },
    PatchMeasure {
        measure: Measure {
            name: "cv_#_mm_one_fibre",
            column: "cv_#_mm_one_fibre",
            label: "CV from single fibres, # mm",
            meaning: "coefficient of variation that is expected for independent filaments, from single fibres",
            figure: &ONE_FIBRE,
            series: "# mm",
            ..SHARE
        },
        number: |patch| patch.single_fibres.0,
        error: None,
        causes: &[],
    },
    PatchMeasure {
        measure: Measure {
            name: "cv_#_mm_independent",
            column: "cv_#_mm_independent",
            label: "CV in airs of their own, # mm",
            meaning: "coefficient of variation that the filaments of a web in one air would give in airs of their own",
            figure: &INDEPENDENT,
            series: "# mm",
            ..SHARE
        },
        number: |patch| patch.independent.map_or(f64::NAN, |(cv, _)| cv),
        error: Some(Deviation::OfOne("_mm_independent_error")),
        causes: &[],
    },
    PatchMeasure {
        measure: Measure {
            name: "cv_#_mm_pairs",
            column: "cv_#_mm_pairs",
            label: "CV from pairs of filaments, # mm",
            meaning: "coefficient of variation that is expected for a web in one air from the correlations of pairs of filaments",
            figure: &PAIRS,
            series: "# mm",
            ..SHARE
        },
        number: |patch| patch.pairs.unwrap_or(f64::NAN),
        error: None,
        causes: &[],
    },
    PatchMeasure {
        measure: Measure {
            name: "cv_#_mm_flown",
            column: "cv_#_mm_flown",
            label: "CV from the flown curves, # mm",
            meaning: "coefficient of variation that is expected from the flown curves",
            figure: &FLOWN,
            series: "# mm",
            ..SHARE
        },
        number: |patch| patch.flown.map_or(f64::NAN, |(cv, _)| cv),
        error: Some(Deviation::Always("_mm_flown_error")),
        causes: &[],
    },
    PatchMeasure {
        measure: Measure {
            name: "cv_#_mm_straight_fibres",
            column: "cv_#_mm_straight_fibres",
            label: "CV of straight fibres, # mm",
            meaning: "coefficient of variation of straight fibres in all directions of the same mass",
            figure: &STRAIGHT,
            series: "# mm",
            ..SHARE
        },
        number: |patch| patch.straight_fibres,
        error: None,
        causes: &[],
    },
    PatchMeasure {
        measure: Measure {
            name: "cv_#_mm_chance",
            column: "cv_#_mm_chance",
            label: "Error of the CV by chance, # mm",
            meaning: "standard error of the coefficient of variation of one map: another piece of the same web \
                would have another coefficient",
            ..SHARE
        },
        number: |patch| patch.map.standard_error.unwrap_or(f64::NAN),
        error: None,
        causes: &[],
    },
    PatchMeasure {
        measure: Measure {
            name: "cv_#_mm_few_fibres",
            column: "cv_#_mm_few_fibres",
            label: "Error of the CV by the few fibres, # mm",
            meaning: "standard error of the coefficient of variation because only a few fibres were flown",
            ..SHARE
        },
        number: |patch| patch.whole_error().flight.unwrap_or(f64::NAN),
        error: None,
        causes: &[],
    },
    PatchMeasure {
        measure: Measure {
            name: "cv_#_mm_model",
            column: "cv_#_mm_model",
            label: "Error of the CV by the model, # mm",
            meaning: "error of the coefficient of variation because of the surrogate: its difference from that of \
                the flown curves",
            ..SHARE
        },
        number: |patch| patch.whole_error().model.unwrap_or(f64::NAN),
        error: None,
        causes: &[],
    },
    PatchMeasure {
        measure: Measure {
            name: "cv_#_mm_independent_error",
            column: "cv_#_mm_independent_error",
            label: "Error of the CV in airs of their own, # mm",
            meaning: "standard error of the coefficient of variation of the same filaments in airs of their own",
            ..SHARE
        },
        number: |patch| patch.independent.map_or(f64::NAN, |(_, error)| error),
        error: None,
        causes: &[],
    },
    PatchMeasure {
        measure: Measure {
            name: "cv_#_mm_flown_error",
            column: "cv_#_mm_flown_error",
            label: "Error of the flown CV, # mm",
            meaning: "standard error of the coefficient of variation that is expected from the flown curves",
            ..SHARE
        },
        number: |patch| patch.flown.map_or(f64::NAN, |(_, error)| error),
        error: None,
        causes: &[],
    },
];

/// The measures of a whole web, in the order of the tables.
pub const OF_WEBS: &[WebMeasure] = &[
    WebMeasure {
        measure: Measure {
            name: "basis_weight",
            column: "basis_weight_kg_m2",
            label: "Basis weight",
            meaning: "mean mass of the web per area",
            unit: Unit { shown: "g/m²", per_si: 1e3 },
            figure: &figure("basis_weight", "Basis weight", "basis weight"),
            ..Measure::NUMBER
        },
        number: |_, found| found.laid.map.basis_weight(),
    },
    WebMeasure {
        measure: Measure {
            name: "fibre_length",
            column: "fibre_length_m",
            label: "Length of fibre",
            meaning: "length of all filaments on the web",
            unit: Unit { shown: "km", per_si: 1e-3 },
            ..Measure::NUMBER
        },
        number: |web, _| web.fibre_length(),
    },
    WebMeasure {
        measure: Measure {
            name: "orientation_md",
            column: "orientation_md",
            label: "Orientation along MD",
            meaning: "mean squared cosine of the angle between fibre and machine direction: 0.5 without any orientation",
            ..Measure::NUMBER
        },
        number: |_, found| found.orientation.cos_squared.mean,
    },
    WebMeasure {
        measure: Measure {
            name: "md_cd_ratio",
            column: "md_cd_ratio",
            label: "MD/CD",
            meaning: "length of fibre along the machine direction over that along the cross direction",
            figure: &figure("md_cd_ratio", "Ratio of fibre along MD and CD", "MD/CD ratio"),
            ..Measure::NUMBER
        },
        number: |_, found| found.orientation.md_cd_ratio(),
    },
    WebMeasure {
        measure: Measure {
            name: "sigma_md",
            column: "sigma_md_m",
            label: "Spread in MD",
            meaning: "spread σ of a filament in machine direction, of the surrogate of the first layer",
            unit: super::MILLIMETRES,
            ..Measure::NUMBER
        },
        number: |web, _| surrogate(web)[0],
    },
    WebMeasure {
        measure: Measure {
            name: "sigma_cd",
            column: "sigma_cd_m",
            label: "Spread in CD",
            meaning: "spread σ of a filament in cross direction, of the surrogate of the first layer",
            unit: super::MILLIMETRES,
            ..Measure::NUMBER
        },
        number: |web, _| surrogate(web)[1],
    },
    WebMeasure {
        measure: Measure {
            name: "noise",
            column: "noise_per_sqrt_m",
            label: "Noise of the direction",
            meaning: "strength A of the noise in the direction, of the surrogate of the first layer",
            unit: Unit { shown: "m^-½", per_si: 1.0 },
            ..Measure::NUMBER
        },
        number: |web, _| surrogate(web)[2],
    },
];

/// A share that is shown in per cent.
const SHARE: Measure = Measure { unit: PERCENT, ..Measure::NUMBER };

const fn figure(name: &'static str, title: &'static str, words: &'static str) -> Figure {
    Figure { name, title, words, logarithmic: false, from_zero: true, caption: "" }
}

const CV: Figure = figure("cv", "Unevenness of the web, CV", "CV of the web");
const ONE_FIBRE: Figure = figure("cv_one_fibre", "CV expected from single fibres", "expected CV");
const INDEPENDENT: Figure =
    figure("cv_independent", "CV of the same filaments in airs of their own", "CV in airs of their own");
const PAIRS: Figure = figure("cv_pairs", "CV expected from pairs of filaments", "CV from pairs of filaments");
const FLOWN: Figure = figure("cv_flown", "CV expected from the flown curves", "CV of the flown curves");
const STRAIGHT: Figure = figure("cv_straight_fibres", "CV of straight fibres", "CV of straight fibres");

/// σ_MD and σ_CD [m] and A [m^-½] of the surrogate of the first layer; NaN without one.
fn surrogate(web: &Web) -> [f64; 3] {
    let layer = web.layers.first();
    let fibres = layer.into_iter().flat_map(|layer| [Some(&layer.fibres), layer.other_description.as_ref()]);
    let found = fibres.flatten().find_map(|fibres| match fibres {
        Fibres::Surrogate(surrogate) => Some([surrogate.sigma_md, surrogate.sigma_cd, surrogate.noise]),
        Fibres::Curves(_) => None,
    });
    found.unwrap_or([f64::NAN; 3])
}
