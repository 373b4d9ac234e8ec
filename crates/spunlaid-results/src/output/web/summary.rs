//! `summary.json`: all results of a web.

use crate::figures::SEEN;
use serde::Serialize;
use spunlaid::scan;
use spunlaid::statistics::{Estimate, interval_of_deviation};
use spunlaid::web::{Clouds, Edges, Findings, Map, Web};

/// Version of the layout. It increases when a field is renamed or removed or changes its meaning.
const SCHEMA_VERSION: u32 = 2;

/// The content of `summary.json` of a web.
#[derive(Debug, Serialize)]
pub struct Summary<'a> {
    schema_version: u32,
    spunlaid_version: &'static str,
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    layers: &'a [Layer],
    web: WebSummary,
    #[serde(skip_serializing_if = "Option::is_none")]
    scan: Option<Scan<'a>>,
    performance: Performance,
    notes: &'a [String],
}

/// How a scan was read.
#[derive(Clone, Copy, Debug, Serialize)]
struct Scan<'a> {
    file: &'a str,
    /// Grey level of the lamp without web.
    white: Option<f64>,
    mean_density: Option<f64>,
    /// How much brighter the lamp was at its brightest than at its darkest place, before this was taken out.
    shading: Option<f64>,
    filled_pixels: usize,
    saturated_pixels: usize,
    lighter_pixels: usize,
    /// Area beside the rectangle that was cut out, because the bare lamp is seen there.
    cut_off_m2: f64,
    /// Grey level of the bare lamp there, over that of its picture if there is one.
    bare_lamp: Option<f64>,
    /// Dark spots that were left out.
    dark_spots: usize,
    /// Their area.
    dark_spots_m2: f64,
}

/// What a layer was laid from.
#[derive(Clone, Debug, Serialize)]
pub struct Layer {
    /// Its name.
    pub name: String,
    /// Line density of a filament [kg/m].
    pub linear_density_kg_m: f64,
    /// Speed of the filaments [m/s].
    pub feed_speed_m_s: f64,
    /// Speed of the belt [m/s].
    pub belt_speed_m_s: f64,
    /// Number of filaments.
    pub filaments: u64,
    /// Basis weight [kg/m²].
    pub basis_weight_kg_m2: f64,
    /// Of the surrogate, if the filaments were laid by one.
    pub sigma_md_m: Option<f64>,
    /// Spread in cross direction [m].
    pub sigma_cd_m: Option<f64>,
    /// Noise of the surrogate [m^-½].
    pub noise_per_sqrt_m: Option<f64>,
    /// Rms difference between the autocorrelations of the flown fibres and those of the surrogate.
    pub fit_residual: Option<f64>,
    /// What chance alone would leave of it.
    pub fit_residual_by_chance: Option<f64>,
    /// Largest lateral wave number of the air that all filaments share, times its length scale; none of filaments in airs of their own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lateral_cutoff: Option<f64>,
}

/// The speed of the work. This is the only part that differs when it is repeated.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Performance {
    /// Wall-clock time [s].
    pub wall_s: f64,
    /// Number of threads.
    pub threads: usize,
    /// Name of the instruction set.
    pub instruction_set: &'static str,
    /// Time that the flights of filaments in one air took [s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flights_s: Option<f64>,
    /// The part of it that is shared among the threads [s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flights_in_parallel_s: Option<f64>,
}

impl Performance {
    /// With the times of flights in one air, if there were some.
    #[must_use]
    pub fn with_flights(self, findings: &Findings) -> Self {
        let spent = findings.laid.together.as_ref().map(|together| together.spent);
        Self {
            flights_s: spent.map(|spent| spent.whole.as_secs_f64()),
            flights_in_parallel_s: spent.map(|spent| spent.in_parallel.as_secs_f64()),
            ..self
        }
    }
}

#[derive(Debug, Serialize)]
struct WebSummary {
    /// None if it is not known.
    basis_weight_kg_m2: Option<f64>,
    /// Cells in machine and in cross direction.
    cells: [usize; 2],
    cell_m: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    fibre_length_m: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cut_off_kg: Option<f64>,
    /// Filaments in one air that were lost in flight.
    #[serde(skip_serializing_if = "Option::is_none")]
    lost_filaments: Option<u64>,
    /// Where edges cut fibre off: the strips that all but the map leaves out.
    #[serde(skip_serializing_if = "Option::is_none")]
    edges: Option<Margins>,
    patches: Vec<Patch>,
    #[serde(skip_serializing_if = "Option::is_none")]
    orientation_md: Option<NumberWithError>,
    #[serde(skip_serializing_if = "Option::is_none")]
    md_cd_ratio: Option<f64>,
    /// Share of the texture along the machine direction, ½ without orientation.
    texture_md: Option<NumberWithError>,
    cloudiness: Option<Cloudiness>,
    clouds: Vec<Octave>,
    sensitivities: Vec<Levers>,
}

#[derive(Debug, Default, Serialize)]
struct Patch {
    patch_m: f64,
    cv: f64,
    /// By chance alone.
    cv_standard_error: Option<f64>,
    /// Of the same filaments in airs of their own; none if they are independent as they are.
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_independent: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_independent_standard_error: Option<f64>,
    /// By the few fibres that were flown.
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_flight_error: Option<f64>,
    /// By the surrogate in place of the flown curves.
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_model_error: Option<f64>,
    /// By all causes; none if one is not known.
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_whole_error: Option<f64>,
    /// 95 % confidence interval of the CV of all such webs.
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_interval: Option<[f64; 2]>,
    /// Why the true CV cannot be known.
    #[serde(skip_serializing_if = "Option::is_none")]
    no_interval: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_one_fibre: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_one_fibre_standard_error: Option<f64>,
    /// The one expected from the flown curves.
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_flown: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_flown_standard_error: Option<f64>,
    /// The one expected from paths of the surrogate.
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_surrogate: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_surrogate_standard_error: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_straight_fibres: Option<f64>,
    /// Of the noise of the camera alone, at most or as given.
    #[serde(skip_serializing_if = "Option::is_none")]
    cv_noise: Option<f64>,
    /// Share by which one more pixel of blur lowers the CV.
    #[serde(skip_serializing_if = "Option::is_none")]
    blur_of_a_pixel: Option<f64>,
}

/// What the edges of a web take.
#[derive(Debug, Serialize)]
struct Margins {
    /// Widths of the strips at the first column and at the last one.
    margins_m: [f64; 2],
    /// Mean basis weight between them, and of the whole sheet.
    basis_weight_between_kg_m2: f64,
    basis_weight_sheet_kg_m2: f64,
}

#[derive(Debug, Serialize)]
struct NumberWithError {
    mean: f64,
    standard_error: Option<f64>,
}

#[derive(Debug, Serialize)]
struct Cloudiness {
    from_m: f64,
    to_m: f64,
    index: f64,
    standard_error: Option<f64>,
    /// 95 % confidence interval for all such webs; null if the map is too small to say.
    interval: Option<[f64; 2]>,
    /// Why the true index cannot be known.
    #[serde(skip_serializing_if = "Option::is_none")]
    no_interval: Option<String>,
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
    /// What it rests on.
    source: &'static str,
    /// None where the surrogate is too far from the flown curves to say.
    elasticity: Option<f64>,
    standard_error: Option<f64>,
}

impl WebSummary {
    /// What any map says.
    fn of_map(map: &Map, clouds: Option<&Clouds>, patches: Vec<Patch>) -> Self {
        let cloudiness = clouds.map(|clouds| {
            let (index, standard_error) = clouds.cloudiness(SEEN[0], SEEN[1]);
            let interval = standard_error.map(|error| interval_of_deviation(index, error));
            Cloudiness { from_m: SEEN[0], to_m: SEEN[1], index, standard_error, interval, no_interval: None }
        });
        let octave = |([from_m, to_m], estimate): ([f64; 2], Estimate)| Octave {
            from_m,
            to_m,
            variance: estimate.mean,
            standard_error: estimate.standard_error,
        };
        Self {
            basis_weight_kg_m2: Some(map.basis_weight()),
            cells: [map.rows, map.columns],
            cell_m: map.cell,
            fibre_length_m: None,
            cut_off_kg: None,
            lost_filaments: None,
            edges: None,
            patches,
            orientation_md: None,
            md_cd_ratio: None,
            texture_md: clouds.map(|clouds| NumberWithError::new(&clouds.texture_md())),
            cloudiness,
            clouds: clouds.into_iter().flat_map(Clouds::octaves).map(octave).collect(),
            sensitivities: Vec::new(),
        }
    }
}

impl NumberWithError {
    fn new(estimate: &Estimate) -> Self {
        Self { mean: estimate.mean, standard_error: estimate.standard_error }
    }
}

impl<'a> Summary<'a> {
    /// Gathers everything.
    pub fn new(
        web: &Web,
        findings: &Findings,
        layers: &'a [Layer],
        performance: Performance,
        notes: &'a [String],
    ) -> Self {
        let patches = findings.patches.iter().map(|patch| Patch {
            patch_m: patch.map.patch,
            cv: patch.map.cv,
            cv_standard_error: patch.map.standard_error,
            cv_independent: patch.independent.map(|of| of.0),
            cv_independent_standard_error: patch.independent.map(|of| of.1),
            cv_interval: patch.map.interval(),
            no_interval: patch.map.interval().is_none().then(|| "the map is too small".to_owned()),
            cv_one_fibre: Some(patch.one_fibre.0),
            cv_one_fibre_standard_error: Some(patch.one_fibre.1),
            cv_flight_error: patch.whole_error().flight,
            cv_model_error: patch.whole_error().model,
            cv_whole_error: patch.whole_error().whole(),
            cv_flown: patch.flown.map(|cv| cv.0),
            cv_flown_standard_error: patch.flown.map(|cv| cv.1),
            cv_surrogate: patch.surrogate.map(|cv| cv.0),
            cv_surrogate_standard_error: patch.surrogate.map(|cv| cv.1),
            cv_straight_fibres: Some(patch.straight_fibres),
            ..Patch::default()
        });
        let levers = findings.sensitivities.iter().flat_map(|sensitivity| {
            let each = sensitivity.elasticity.iter().zip(&findings.patches);
            each.map(|(elasticity, patch)| Levers {
                number: sensitivity.lever.name(),
                patch_m: patch.map.patch,
                source: sensitivity.source.name(),
                elasticity: elasticity.as_ref().map(|estimate| estimate.mean),
                standard_error: elasticity.as_ref().and_then(|estimate| estimate.standard_error),
            })
        });
        Self {
            schema_version: SCHEMA_VERSION,
            spunlaid_version: env!("CARGO_PKG_VERSION"),
            layers,
            web: WebSummary {
                fibre_length_m: Some(web.fibre_length()),
                cut_off_kg: Some(findings.laid.cut),
                lost_filaments: findings.laid.together.as_ref().map(|together| together.lost),
                edges: (web.sheet.edges == Edges::Cut).then(|| Margins {
                    margins_m: findings.margins,
                    basis_weight_between_kg_m2: findings.within().basis_weight(),
                    basis_weight_sheet_kg_m2: findings.laid.map.basis_weight(),
                }),
                orientation_md: Some(NumberWithError::new(&findings.orientation.cos_squared)),
                md_cd_ratio: Some(findings.orientation.md_cd_ratio()),
                sensitivities: levers.collect(),
                ..WebSummary::of_map(&findings.laid.map, findings.clouds.as_ref(), patches.collect())
            },
            scan: None,
            performance,
            notes,
        }
    }

    /// Of a scanned web, which was read from a file.
    pub fn of_scan(
        file: &'a str,
        findings: &scan::Findings,
        performance: Performance,
        notes: &'a [String],
    ) -> Self {
        let patches = findings.patches.iter().map(|patch| Patch {
            patch_m: patch.unevenness.patch,
            cv: patch.unevenness.cv,
            cv_standard_error: patch.unevenness.standard_error,
            cv_interval: patch.interval.ok(),
            no_interval: patch.interval.err().map(|doubt| doubt.to_string()),
            cv_noise: Some(patch.noise),
            blur_of_a_pixel: Some(patch.blur),
            ..Patch::default()
        });
        let mut web = WebSummary::of_map(&findings.map, findings.clouds.as_ref(), patches.collect());
        if let Some(guess) = findings.guess {
            // Chance is not all that the error of a variance is made of.
            web.clouds.iter_mut().for_each(|octave| octave.standard_error = None);
            if let Some(cloudiness) = &mut web.cloudiness {
                (cloudiness.standard_error, cloudiness.no_interval) = (None, Some(guess.to_string()));
            }
        }
        let basis_weight_kg_m2 = web.basis_weight_kg_m2.filter(|_| findings.mean_known);
        Self {
            schema_version: SCHEMA_VERSION,
            spunlaid_version: env!("CARGO_PKG_VERSION"),
            layers: &[],
            web: WebSummary { basis_weight_kg_m2, ..web },
            scan: Some(Scan {
                file,
                white: findings.white,
                mean_density: findings.density,
                shading: findings.shading,
                filled_pixels: findings.pixels.filled,
                saturated_pixels: findings.pixels.saturated,
                lighter_pixels: findings.pixels.lighter,
                cut_off_m2: findings.aside.cut_off,
                bare_lamp: findings.aside.bare,
                dark_spots: findings.aside.spots.len(),
                dark_spots_m2: findings.aside.masked,
            }),
            performance,
            notes,
        }
    }

    /// The text of the file.
    pub fn to_json(&self) -> String {
        crate::output::json_text(self)
    }
}
