//! What is measured of a web. Each measure is declared once: its names, unit, meaning, figure, and how it is found. `summary.json`, the
//! tables of the terminal and of the report, Python and the studies follow from it.

use super::{Measure, PERCENT, Unit, figure};
use crate::web::{Fibres, Findings, PatchFindings, Web};
use WebNumber::{Mean, Plain};

/// A measure of a whole web.
#[derive(Debug)]
pub struct WebMeasure {
    /// What it is. Its `column` is its name in `summary.json`.
    pub measure: Measure,
    /// Its value; none if this web has none.
    pub number: fn(&Web, &Findings) -> Option<WebNumber>,
}

/// The value of a measure of a whole web.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WebNumber {
    /// A number.
    Plain(f64),
    /// A mean, and its standard error if it is known.
    Mean(f64, Option<f64>),
}

impl WebNumber {
    /// The number, or the mean.
    pub const fn value(self) -> f64 {
        let (Self::Plain(value) | Self::Mean(value, _)) = self;
        value
    }
}

/// A measure of the patches of one size.
#[derive(Debug)]
pub struct PatchMeasure {
    /// Name in `summary.json`.
    pub name: &'static str,
    /// Whether it stands there before the interval of the CV of the map, of which it tells.
    pub is_of_map: bool,
    /// Its value; none if this web has none.
    pub number: fn(&PatchFindings) -> Option<f64>,
    /// Its column in the table of the report and in that of the terminal; none if they leave it out.
    pub column: Option<PatchColumn>,
    /// The measure as studies keep it; none if they do not. In `name`, `column`, `label` and `series` the sign `#` stands for the side of the
    /// patches in millimetres.
    pub study: Option<Measure>,
    /// Its place among the columns of a study, from 0.
    pub study_place: usize,
    /// The measure, by its end after `cv_#`, that is its standard error in studies.
    pub error: Option<Deviation>,
    /// Further errors of the same measure, which more replicates do not lower, by their ends after `cv_#`.
    pub causes: &'static [&'static str],
}

/// A column of the tables of patches, after those of the map: side, CV, its error by chance, and its interval.
#[derive(Debug)]
pub struct PatchColumn {
    /// Its place among these columns, from 0.
    pub place: usize,
    /// Its head in the report and on the terminal; empty where it is left out.
    pub heads: [&'static str; 2],
    /// Whether the table of a web with such patches has the column.
    pub is_shown: fn(&PatchFindings) -> bool,
    /// Number of significant digits; none of a number whose error tells it: the measure with its name and `_standard_error`, if there is one.
    pub digits: Option<i32>,
}

impl PatchMeasure {
    /// A number that has no name yet.
    const NUMBER: Self = Self {
        name: "",
        is_of_map: false,
        number: |_| None,
        column: None,
        study: None,
        study_place: 0,
        error: None,
        causes: &[],
    };
}

impl PatchColumn {
    /// A column that every table has.
    const NUMBER: Self = Self { place: 0, heads: ["", ""], is_shown: |_| true, digits: None };
}

/// Where the standard error of a measure comes from, if not from the replicates alone.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Deviation {
    /// From this measure where there is a single replicate.
    OfOne(&'static str),
    /// Always from this measure: all replicates share what causes it.
    Always(&'static str),
}

/// The measures of the patches of each size, in the order of `summary.json`.
pub const OF_PATCHES: &[PatchMeasure] = &[
    PatchMeasure {
        name: "cv",
        is_of_map: true,
        number: |patch| Some(patch.map.cv),
        study: Some(Measure {
            label: "CV over patches of # mm",
            meaning: "coefficient of variation of the basis weight of the map over square patches of this side",
            figure: &figure("cv", "Unevenness of the web, CV", "CV of the web"),
            ..share("cv_#_mm")
        }),
        study_place: 0,
        error: Some(Deviation::OfOne("_mm_chance")),
        causes: &["_mm_few_fibres", "_mm_model"],
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_standard_error",
        is_of_map: true,
        number: |patch| patch.map.standard_error,
        study: Some(Measure {
            label: "Error of the CV by chance, # mm",
            meaning: "standard error of the coefficient of variation of one map: another piece of the same web \
                would have another coefficient",
            ..share("cv_#_mm_chance")
        }),
        study_place: 6,
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_degrees",
        is_of_map: true,
        number: |patch| patch.map.degrees(),
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_flight_error",
        is_of_map: true,
        number: |patch| patch.whole_error().flight,
        column: Some(PatchColumn {
            place: 0,
            heads: ["few fibres flown", "few fibres"],
            is_shown: |patch| patch.few.is_some() || is_flown_alone(patch),
            digits: Some(2),
        }),
        study: Some(Measure {
            label: "Error of the CV by the few fibres, # mm",
            meaning: "standard error of the coefficient of variation because only a few fibres were flown",
            ..share("cv_#_mm_few_fibres")
        }),
        study_place: 7,
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_model_error",
        is_of_map: true,
        number: |patch| patch.whole_error().model,
        column: Some(PatchColumn {
            place: 1,
            heads: ["model", "model"],
            is_shown: is_flown_alone,
            digits: Some(2),
        }),
        study: Some(Measure {
            label: "Error of the CV by the model, # mm",
            meaning: "error of the coefficient of variation because of the surrogate: its difference from that of \
                the flown curves",
            ..share("cv_#_mm_model")
        }),
        study_place: 8,
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_whole_error",
        is_of_map: true,
        number: |patch| patch.whole_error().whole(),
        ..PatchMeasure::NUMBER
    },
    PatchMeasure { name: "cv_of_map", number: |patch| patch.filled, ..PatchMeasure::NUMBER },
    PatchMeasure {
        // Of CV², by what each filament of a web in one air does for itself.
        name: "own_share",
        number: |patch| patch.few.map(|few| few.own / (few.cv * few.cv)),
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_independent",
        number: |patch| Some(patch.independent?.cv),
        column: Some(PatchColumn {
            place: 2,
            heads: ["CV of the same filaments in airs of their own", "airs of their own"],
            is_shown: |patch| patch.independent.is_some(),
            ..PatchColumn::NUMBER
        }),
        study: Some(Measure {
            label: "CV in airs of their own, # mm",
            meaning: "coefficient of variation that the filaments of a web in one air would give in airs of their own",
            figure: &figure(
                "cv_independent",
                "CV of the same filaments in airs of their own",
                "CV in airs of their own",
            ),
            ..share("cv_#_mm_independent")
        }),
        study_place: 2,
        error: Some(Deviation::OfOne("_mm_independent_error")),
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_independent_standard_error",
        number: |patch| Some(patch.independent?.standard_error),
        study: Some(Measure {
            label: "Error of the CV in airs of their own, # mm",
            meaning: "standard error of the coefficient of variation of the same filaments in airs of their own",
            ..share("cv_#_mm_independent_error")
        }),
        study_place: 9,
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_independent_degrees",
        number: |patch| Some(patch.independent?.degrees),
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_independent_low",
        number: |patch| Some(patch.independent?.interval()?[0]),
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_independent_high",
        number: |patch| Some(patch.independent?.interval()?[1]),
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_one_fibre",
        number: |patch| Some(patch.single_fibres.0),
        column: Some(PatchColumn {
            place: 6,
            heads: ["CV expected, from single fibres", "single fibres"],
            is_shown: is_told_by_single_fibres,
            ..PatchColumn::NUMBER
        }),
        study: Some(Measure {
            label: "CV from single fibres, # mm",
            meaning: "coefficient of variation that is expected for independent filaments, from single fibres",
            figure: &figure("cv_one_fibre", "CV expected from single fibres", "expected CV"),
            ..share("cv_#_mm_one_fibre")
        }),
        study_place: 1,
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_one_fibre_standard_error",
        number: |patch| Some(patch.single_fibres.1),
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_flown",
        number: |patch| Some(patch.flown?.0),
        column: Some(PatchColumn {
            place: 5,
            heads: ["CV expected, from the flown curves", "flown curves"],
            is_shown: is_flown_alone,
            ..PatchColumn::NUMBER
        }),
        study: Some(Measure {
            label: "CV from the flown curves, # mm",
            meaning: "coefficient of variation that is expected from the flown curves",
            figure: &figure("cv_flown", "CV expected from the flown curves", "CV of the flown curves"),
            ..share("cv_#_mm_flown")
        }),
        study_place: 4,
        error: Some(Deviation::Always("_mm_flown_error")),
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_pairs",
        number: |patch| patch.pairs,
        column: Some(PatchColumn {
            place: 3,
            heads: ["CV expected, from pairs of filaments", ""],
            is_shown: |patch| patch.pairs.is_some(),
            ..PatchColumn::NUMBER
        }),
        study: Some(Measure {
            label: "CV from pairs of filaments, # mm",
            meaning: "coefficient of variation that is expected for a web in one air from the correlations of pairs of filaments",
            figure: &figure("cv_pairs", "CV expected from pairs of filaments", "CV from pairs of filaments"),
            ..share("cv_#_mm_pairs")
        }),
        study_place: 3,
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_flown_standard_error",
        number: |patch| Some(patch.flown?.1),
        study: Some(Measure {
            label: "Error of the flown CV, # mm",
            meaning: "standard error of the coefficient of variation that is expected from the flown curves",
            ..share("cv_#_mm_flown_error")
        }),
        study_place: 10,
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_surrogate",
        number: |patch| Some(patch.surrogate?.0),
        column: Some(PatchColumn {
            place: 4,
            heads: ["CV expected, from the surrogate", "surrogate"],
            is_shown: |patch| patch.independent.is_none() && patch.surrogate.is_some(),
            ..PatchColumn::NUMBER
        }),
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_surrogate_standard_error",
        number: |patch| Some(patch.surrogate?.1),
        ..PatchMeasure::NUMBER
    },
    PatchMeasure {
        name: "cv_straight_fibres",
        number: |patch| Some(patch.straight_fibres),
        column: Some(PatchColumn {
            place: 7,
            heads: ["Straight fibres", "straight fibres"],
            digits: Some(3),
            ..PatchColumn::NUMBER
        }),
        study: Some(Measure {
            label: "CV of straight fibres, # mm",
            meaning: "coefficient of variation of straight fibres in all directions of the same mass",
            figure: &figure("cv_straight_fibres", "CV of straight fibres", "CV of straight fibres"),
            ..share("cv_#_mm_straight_fibres")
        }),
        study_place: 5,
        ..PatchMeasure::NUMBER
    },
];

/// The measures of a whole web, in the order of `summary.json` and of studies.
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
        number: |_, found| Some(Plain(found.laid.map.basis_weight())),
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
        number: |web, _| Some(Plain(web.fibre_length())),
    },
    WebMeasure {
        measure: Measure {
            name: "orientation_md",
            column: "orientation_md",
            label: "Orientation along MD",
            meaning: "mean squared cosine of the angle between fibre and machine direction: 0.5 without any orientation",
            ..Measure::NUMBER
        },
        number: |_, found| {
            let cos_squared = &found.orientation.cos_squared;
            Some(Mean(cos_squared.mean, cos_squared.standard_error))
        },
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
        number: |_, found| Some(Plain(found.orientation.md_cd_ratio())),
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
        number: |web, _| Some(Plain(surrogate(web)?[0])),
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
        number: |web, _| Some(Plain(surrogate(web)?[1])),
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
        number: |web, _| Some(Plain(surrogate(web)?[2])),
    },
];

/// A share of the patches of one size, which is shown in per cent.
const fn share(name: &'static str) -> Measure {
    Measure { name, column: name, unit: PERCENT, series: "# mm", ..Measure::NUMBER }
}

/// σ_MD and σ_CD [m] and A [m^-½] of the surrogate of the first layer, if it has one.
fn surrogate(web: &Web) -> Option<[f64; 3]> {
    let layer = web.layers.first();
    let fibres = layer.into_iter().flat_map(|layer| [Some(&layer.fibres), layer.other_description.as_ref()]);
    fibres.flatten().find_map(|fibres| match fibres {
        Fibres::Surrogate(surrogate) => Some([surrogate.sigma_md, surrogate.sigma_cd, surrogate.noise]),
        Fibres::Curves(_) => None,
    })
}

/// Whether filaments of independent airs were flown.
fn is_flown_alone(patch: &PatchFindings) -> bool {
    patch.independent.is_none() && patch.flown.is_some()
}

/// Whether neither the surrogate nor the flown curves of all layers tell what is expected.
fn is_told_by_single_fibres(patch: &PatchFindings) -> bool {
    patch.independent.is_none() && patch.flown.is_none() && patch.surrogate.is_none()
}
