//! `summary.json`: all results of a web.

use serde::Serialize;
use spunlaid::statistics::Estimate;
use spunlaid::web::{Findings, Web};

/// Version of the layout. It increases when a field is renamed or removed or changes its meaning.
const SCHEMA_VERSION: u32 = 1;
/// Waves of clouds that the eye sees, for the cloudiness index [m].
pub(crate) const SEEN: [f64; 2] = [5e-3, 50e-3];

#[derive(Debug, Serialize)]
pub(crate) struct Summary<'a> {
    schema_version: u32,
    spunlaid_version: &'static str,
    layers: &'a [Layer],
    web: WebSummary,
    performance: Performance,
    notes: &'a [String],
}

/// What a layer was laid from.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Layer {
    pub(crate) name: String,
    pub(crate) linear_density_kg_m: f64,
    pub(crate) feed_speed_m_s: f64,
    pub(crate) belt_speed_m_s: f64,
    pub(crate) filaments: u64,
    pub(crate) basis_weight_kg_m2: f64,
    /// Of the surrogate, if the filaments were laid by one.
    pub(crate) sigma_md_m: Option<f64>,
    pub(crate) sigma_cd_m: Option<f64>,
    pub(crate) noise_per_sqrt_m: Option<f64>,
}

/// The speed of the work. This is the only part that differs when it is repeated.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Performance {
    pub(crate) wall_s: f64,
    pub(crate) threads: usize,
    pub(crate) instruction_set: &'static str,
}

#[derive(Debug, Serialize)]
struct WebSummary {
    basis_weight_kg_m2: f64,
    /// Cells in machine and in cross direction.
    cells: [usize; 2],
    cell_m: f64,
    fibre_length_m: f64,
    cut_off_kg: f64,
    patches: Vec<Patch>,
    orientation_md: Number,
    md_cd_ratio: f64,
    cloudiness: Option<Cloudiness>,
    clouds: Vec<Octave>,
    sensitivities: Vec<Levers>,
}

#[derive(Debug, Serialize)]
struct Patch {
    patch_m: f64,
    cv: f64,
    cv_standard_error: Option<f64>,
    cv_one_fibre: f64,
    cv_one_fibre_standard_error: f64,
    /// Of the flown curves if a surrogate was laid, and the other way round.
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_compared: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_compared_standard_error: Option<f64>,
    cv_straight_fibres: f64,
}

#[derive(Debug, Serialize)]
struct Number {
    mean: f64,
    standard_error: Option<f64>,
}

#[derive(Debug, Serialize)]
struct Cloudiness {
    from_m: f64,
    to_m: f64,
    index: f64,
    standard_error: Option<f64>,
}

/// The relative variance in waves of some lengths.
#[derive(Debug, Serialize)]
struct Octave {
    from_m: f64,
    to_m: f64,
    variance: f64,
    standard_error: Option<f64>,
}

/// Per cent of the CV for one per cent of a number.
#[derive(Debug, Serialize)]
struct Levers {
    number: &'static str,
    patch_m: f64,
    elasticity: f64,
    standard_error: Option<f64>,
}

impl<'a> Summary<'a> {
    pub(crate) fn new(
        web: &Web,
        of: &Findings,
        layers: &'a [Layer],
        performance: Performance,
        notes: &'a [String],
    ) -> Self {
        let map = &of.laid.map;
        let number = |of: &Estimate| Number { mean: of.mean, standard_error: of.standard_error };
        let patches = of.patches.iter().map(|patch| Patch {
            patch_m: patch.map.patch,
            cv: patch.map.cv,
            cv_standard_error: patch.map.standard_error,
            cv_one_fibre: patch.one_fibre.0,
            cv_one_fibre_standard_error: patch.one_fibre.1,
            cv_compared: patch.compared.map(|of| of.0),
            cv_compared_standard_error: patch.compared.map(|of| of.1),
            cv_straight_fibres: patch.straight_fibres,
        });
        let cloudiness = of.clouds.as_ref().map(|clouds| {
            let (index, standard_error) = clouds.cloudiness(SEEN[0], SEEN[1]);
            Cloudiness { from_m: SEEN[0], to_m: SEEN[1], index, standard_error }
        });
        let octaves = of.clouds.iter().flat_map(|clouds| clouds.octaves());
        let levers = of.sensitivities.iter().flat_map(|sensitivity| {
            let each = sensitivity.elasticity.iter().zip(&of.patches);
            each.map(|(elasticity, patch)| Levers {
                number: sensitivity.lever.name(),
                patch_m: patch.map.patch,
                elasticity: elasticity.mean,
                standard_error: elasticity.standard_error,
            })
        });
        Self {
            schema_version: SCHEMA_VERSION,
            spunlaid_version: env!("CARGO_PKG_VERSION"),
            layers,
            web: WebSummary {
                basis_weight_kg_m2: map.basis_weight(),
                cells: [map.rows, map.columns],
                cell_m: map.cell,
                fibre_length_m: web.fibre_length(),
                cut_off_kg: of.laid.cut,
                patches: patches.collect(),
                orientation_md: number(&of.orientation.cos_squared),
                md_cd_ratio: of.orientation.md_cd_ratio(),
                cloudiness,
                clouds: octaves
                    .map(|([from_m, to_m], of)| Octave {
                        from_m,
                        to_m,
                        variance: of.mean,
                        standard_error: of.standard_error,
                    })
                    .collect(),
                sensitivities: levers.collect(),
            },
            performance,
            notes,
        }
    }

    pub(crate) fn to_json(&self) -> String {
        crate::output::json_text(self)
    }
}
