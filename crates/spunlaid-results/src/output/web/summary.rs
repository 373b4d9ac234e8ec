//! `summary.json`: all results of a web.

use super::charge::ChargeSummary;
use super::effects::EffectsSummary;
use super::fabric::FabricSummary;
use crate::figures::SEEN;
use crate::output::in_order::OrderedObject;
use crate::output::load::LoadSummary;
use crate::output::measured::{json, values, with_errors};
use crate::output::spinline::SpinSummary;
use serde::Serialize;
use serde_json::Value as Json;
use spunlaid::advice::Advice;
use spunlaid::fabric::Fabric;
use spunlaid::lanes::Isa;
use spunlaid::observe::{Measure, OF_PATCHES, OF_SCANNED_PATCHES, OF_SCANS, OF_WEBS};
use spunlaid::scan::{self, Doubt};
use spunlaid::statistics::{Estimate, interval_of_deviation};
use spunlaid::web::{Clouds, Edges, Findings, LayerFew, Map, NeighbourCorrelation, Web};
use std::time::Instant;

/// The content of `summary.json` of a web.
#[derive(Debug, Serialize)]
pub struct Summary<'a> {
    #[serde(skip_serializing_if = "<[_]>::is_empty")]
    layers: &'a [Layer],
    web: WebSummary,
    #[serde(skip_serializing_if = "Option::is_none")]
    fabric: Option<FabricSummary<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    advice: Option<EffectsSummary<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    guesses: Option<EffectsSummary<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    neighbours: Option<NeighboursSummary<'a>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    charge: Vec<ChargeSummary<'a>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    scan: Option<OrderedObject<Json>>,
    performance: Performance,
    notes: &'a [String],
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
    /// Largest lateral wave number of the air that all filaments share, times its length scale; none of
    /// filaments in airs of their own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lateral_cutoff: Option<f64>,
    /// What its filaments do to their air, where a case says how they fly.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub curtain: Option<LoadSummary>,
    /// The spinline from which its filaments come, if its case has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub spinline: Option<SpinSummary>,
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
    /// The time since an instant, on so many threads.
    pub fn measure(started: Instant, threads: usize, isa: Isa) -> Self {
        let wall_s = started.elapsed().as_secs_f64();
        Self { wall_s, threads, instruction_set: isa.name(), ..Self::default() }
    }

    /// With the times of flights in one air, if there were some.
    #[must_use]
    pub fn with_flights(self, findings: &Findings) -> Self {
        let spent = findings.laid.shared_air.as_ref().map(|together| together.spent);
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
    /// What was flown of a web in one air, of each layer of which only a few filaments were.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    flown: Vec<FlownSummary>,
    /// Where edges cut fibre off: the strips that all but the map leaves out.
    #[serde(skip_serializing_if = "Option::is_none")]
    edges: Option<Margins>,
    patches: Vec<OrderedObject<Json>>,
    /// The declared measures of a laid web, but for those that stand elsewhere.
    #[serde(flatten)]
    declared: OrderedObject<Json>,
    /// Share of the texture along the machine direction, ½ without orientation.
    texture_md: Option<NumberWithError>,
    cloudiness: Option<Cloudiness>,
    clouds: Vec<Octave>,
}

/// The few filaments of a layer from which all others follow.
#[derive(Debug, Serialize)]
struct FlownSummary {
    filaments: u64,
    /// Distance of neighbours in a row, and the correlation of the places where two filaments at this
    /// distance and equal depth come down.
    pitch_m: f64,
    neighbour_correlation: f64,
    /// The sheet that they laid.
    width_m: f64,
    length_m: f64,
    /// Part of the variance of a filament between them that they do not tell.
    missing_variance_md: f64,
    missing_variance_cd: f64,
}

impl FlownSummary {
    fn from_few(few: &LayerFew) -> Self {
        let ([width_m, length_m], [missing_variance_md, missing_variance_cd]) = (few.sheet, few.missing);
        let (filaments, pitch_m, neighbour_correlation) = (few.filaments, few.pitch, few.correlation);
        Self {
            filaments,
            pitch_m,
            neighbour_correlation,
            width_m,
            length_m,
            missing_variance_md,
            missing_variance_cd,
        }
    }
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
    /// 95 % confidence interval for all such webs; null if the map is too small to say, or if too few
    /// filaments were flown.
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

/// How filaments that hang side by side in one air come down together.
#[derive(Debug, Serialize)]
struct NeighboursSummary<'a> {
    cd: Vec<NeighbourSummary<'a>>,
}

/// The correlations of the places where two filaments at a distance come down, under the names that they have
/// for the companions of a case.
#[derive(Debug, Serialize)]
struct NeighbourSummary<'a> {
    /// Name of the layer.
    layer: &'a str,
    distance_m: f64,
    correlation_md: f64,
    correlation_md_se: Option<f64>,
    correlation_cd: f64,
    correlation_cd_se: Option<f64>,
    /// 95 % confidence intervals, by Student's t; null if too little was laid.
    correlation_md_interval: Option<[f64; 2]>,
    correlation_cd_interval: Option<[f64; 2]>,
}

impl<'a> NeighboursSummary<'a> {
    /// None of a web of independent filaments.
    fn from_findings(findings: &Findings, layers: &'a [Layer]) -> Option<Self> {
        let entry = |neighbour: &NeighbourCorrelation| NeighbourSummary {
            layer: layers.get(neighbour.layer).map_or("", |layer| layer.name.as_str()),
            distance_m: neighbour.distance,
            correlation_md: neighbour.md.value,
            correlation_md_se: neighbour.md.standard_error,
            correlation_cd: neighbour.cd.value,
            correlation_cd_se: neighbour.cd.standard_error,
            correlation_md_interval: neighbour.md.interval(),
            correlation_cd_interval: neighbour.cd.interval(),
        };
        let neighbours = &findings.laid.shared_air.as_ref()?.neighbours;
        (!neighbours.is_empty()).then(|| Self { cd: neighbours.iter().map(entry).collect() })
    }
}

impl WebSummary {
    /// What any map says.
    fn from_map(map: &Map, clouds: Option<&Clouds>, patches: Vec<OrderedObject<Json>>) -> Self {
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
            flown: Vec::new(),
            edges: None,
            patches,
            declared: OrderedObject(Vec::new()),
            texture_md: clouds.map(|clouds| NumberWithError::new(&clouds.texture_md())),
            cloudiness,
            clouds: clouds.into_iter().flat_map(Clouds::octaves).map(octave).collect(),
        }
    }
}

/// The numbers of the patches of one size. Those that are not known are left out; the CV, which is the first,
/// is null.
///
/// * `interval` – 95 % confidence interval of the CV of all such webs, or why it cannot be told
fn numbers_of_patch<T>(
    side: f64,
    measures: &'static [Measure<T>],
    found: &T,
    interval: Result<[f64; 2], String>,
) -> OrderedObject<Json> {
    let (name, interval): (_, Json) = match interval {
        Ok(ends) => ("cv_interval", ends.to_vec().into()),
        Err(why) => ("no_interval", why.into()),
    };
    let mut all = vec![("patch_m".to_owned(), side.into())];
    for (place, measure) in measures.iter().enumerate() {
        let known = with_errors(measure, found);
        let is_missing = place == 0 && known.is_empty();
        all.extend(is_missing.then(|| (measure.entry().to_owned(), Json::Null)));
        all.extend(known);
        // It follows the CV, which is the first.
        all.extend((place == 0).then(|| (name.to_owned(), interval.clone())));
    }
    OrderedObject(all)
}

/// The declared measures of a whole web that do not stand elsewhere in the file: with the map, or with each
/// layer. Those that it does not have are left out.
fn declared_of_web(findings: &Findings) -> OrderedObject<Json> {
    let here = OF_WEBS.iter().filter(|measure| !measure.entry().is_empty());
    OrderedObject(here.flat_map(|measure| with_errors(measure, findings)).collect())
}

impl NumberWithError {
    fn new(estimate: &Estimate) -> Self {
        Self { mean: estimate.mean, standard_error: estimate.standard_error }
    }
}

impl<'a> Summary<'a> {
    /// Gathers everything.
    ///
    /// * `beside` – the folder of the web, beside which those of changed ones lie
    pub fn new(
        web: &Web,
        (findings, fabric): (&Findings, &'a Fabric),
        (advice, guesses, beside): (Option<&'a Advice>, Option<&'a Advice>, &str),
        layers: &'a [Layer],
        performance: Performance,
        notes: &'a [String],
    ) -> Self {
        let patches = findings.patches.iter().map(|patch| {
            let why = match patch.doubt {
                None => "the map is too small",
                Some(_) => "too few filaments were flown",
            };
            let interval = patch.interval().ok_or_else(|| why.to_owned());
            numbers_of_patch(patch.map.patch, OF_PATCHES, patch, interval)
        });
        Self {
            layers,
            web: WebSummary {
                fibre_length_m: Some(findings.fibre_length),
                cut_off_kg: Some(findings.laid.cut),
                flown: findings
                    .laid
                    .shared_air
                    .iter()
                    .flat_map(|together| together.few.iter().map(FlownSummary::from_few))
                    .collect(),
                lost_filaments: findings.laid.shared_air.as_ref().map(|together| together.lost),
                edges: (web.sheet.edges == Edges::Cut).then(|| Margins {
                    margins_m: findings.margins,
                    basis_weight_between_kg_m2: findings.within().basis_weight(),
                    basis_weight_sheet_kg_m2: findings.laid.map.basis_weight(),
                }),
                declared: declared_of_web(findings),
                ..WebSummary::from_map(&findings.laid.map, findings.clouds.as_ref(), patches.collect())
            },
            fabric: Some(FabricSummary::new(fabric)),
            advice: advice.map(|advice| EffectsSummary::of_line(advice, findings, beside)),
            guesses: guesses.map(|guesses| EffectsSummary::of_guesses(guesses, findings, beside)),
            neighbours: NeighboursSummary::from_findings(findings, layers),
            charge: ChargeSummary::from_findings(findings, |layer| {
                layers.get(layer).map_or("", |layer| layer.name.as_str())
            }),
            scan: None,
            performance,
            notes,
        }
    }

    /// Of a scanned web, which was read from a file.
    pub fn from_scan(
        file: &'a str,
        (findings, fabric): (&scan::Findings, &'a Fabric),
        performance: Performance,
        notes: &'a [String],
    ) -> Self {
        let patches = findings.patches.iter().map(|patch| {
            let interval = patch.interval.map_err(|doubt| doubt.to_string());
            numbers_of_patch(patch.unevenness.patch, OF_SCANNED_PATCHES, patch, interval)
        });
        let mut web = WebSummary::from_map(&findings.map, findings.clouds.as_ref(), patches.collect());
        if let Some(guess) = findings.guess {
            // Chance is not all that the error of a variance is made of.
            web.clouds.iter_mut().for_each(|octave| octave.standard_error = None);
            if let Some(cloudiness) = &mut web.cloudiness {
                (cloudiness.standard_error, cloudiness.no_interval) = (None, Some(guess.to_string()));
            }
        }
        let basis_weight_kg_m2 = web.basis_weight_kg_m2.filter(|_| findings.mean_known);
        let guess = Doubt::GUESSES.into_iter().find(|(_, doubt)| Some(*doubt) == findings.guess);
        let guess = guess.map(|(name, _)| name).into();
        let words = [("file".to_owned(), file.into()), ("guess".to_owned(), guess)];
        let numbers = values(OF_SCANS, findings).0.into_iter();
        let scan = words.into_iter().chain(numbers.map(|(name, value)| (name, json(value))));
        Self {
            layers: &[],
            web: WebSummary { basis_weight_kg_m2, ..web },
            fabric: Some(FabricSummary::new(fabric)),
            advice: None,
            guesses: None,
            neighbours: None,
            charge: Vec::new(),
            scan: Some(OrderedObject(scan.collect())),
            performance,
            notes,
        }
    }

    /// The text of the file.
    pub fn to_json(&self) -> String {
        crate::output::versioned_json(3, self)
    }
}
