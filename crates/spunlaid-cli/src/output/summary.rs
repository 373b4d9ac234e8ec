//! `summary.json`: every result of a run.

use serde::Serialize;
use spunlaid::case::Case;
use spunlaid::ensemble::{Number, Results};
use spunlaid::observe::Over;
use spunlaid::statistics::Estimate;
use std::collections::BTreeMap;

/// Version of the layout; raised when a field is renamed, removed or changes its meaning.
const SCHEMA_VERSION: u32 = 2;

#[derive(Debug, Serialize)]
pub(crate) struct Summary<'a> {
    schema_version: u32,
    spunlaid_version: &'static str,
    case: CaseSummary,
    elements: usize,
    steps: u64,
    replicates: u64,
    /// `end_node`, `fibre`, `energy`: the measures by group.
    #[serde(flatten)]
    measures: BTreeMap<&'static str, GroupSummary<'a>>,
    performance: Performance,
    notes: Vec<String>,
}

/// A number over the replicates: what stands for all of them where that is not the mean, then mean, standard
/// error and the replicates' own values.
#[derive(Debug, Serialize)]
struct NumberSummary<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    median: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    largest: Option<f64>,
    mean: f64,
    standard_error: Option<f64>,
    values: &'a [f64],
}

/// The measures of a group by their columns.
type GroupSummary<'a> = BTreeMap<&'static str, NumberSummary<'a>>;

/// How fast it went; the only part that differs from run to run.
#[derive(Clone, Copy, Debug, Serialize)]
pub(crate) struct Performance {
    pub(crate) wall_s: f64,
    pub(crate) threads: usize,
    pub(crate) element_steps: u64,
    /// Time of one thread for an element and step of one fibre.
    pub(crate) ns_per_element_step: f64,
    pub(crate) instruction_set: &'static str,
}

/// The resolved case, SI units in the names.
#[derive(Debug, Serialize)]
struct CaseSummary {
    fibre: CaseFibre,
    air: CaseAir,
    drag: CaseDrag,
    run: CaseRun,
}

#[derive(Debug, Serialize)]
struct CaseFibre {
    length_m: f64,
    diameter_m: f64,
    density_kg_m3: f64,
    youngs_modulus_pa: f64,
    element_length_m: f64,
    root: &'static str,
    direction: [f64; 3],
}

#[derive(Debug, Serialize)]
struct CaseAir {
    velocity_m_s: f64,
    turbulence_intensity: f64,
    length_scale_m: f64,
    cutoff_frequency_hz: f64,
    density_kg_m3: f64,
    kinematic_viscosity_m2_s: f64,
    harmonics: usize,
    /// Of a flow that is not uniform, the numbers above are those along the fibre.
    flow: &'static str,
    spectrum: &'static str,
    eddies: &'static str,
    records: usize,
}

#[derive(Debug, Serialize)]
struct CaseDrag {
    along: &'static str,
    across: &'static str,
    friction_coefficient: Option<f64>,
}

#[derive(Debug, Serialize)]
struct CaseRun {
    duration_s: f64,
    time_step_s: f64,
    replicates: u64,
    seed: u64,
    scheme: &'static str,
    gravity_m_s2: f64,
    spin_up_s: f64,
    output_interval_s: f64,
    damping_1_s: f64,
}

impl<'a> Summary<'a> {
    pub(crate) fn new(
        case: &Case,
        results: &'a Results,
        performance: Performance,
        notes: Vec<String>,
    ) -> Self {
        let mut measures: BTreeMap<&'static str, GroupSummary<'_>> = BTreeMap::new();
        for number in &results.numbers {
            let group = measures.entry(number.measure.group.name).or_default();
            group.insert(number.measure.column, summary_of(number));
        }
        Self {
            schema_version: SCHEMA_VERSION,
            spunlaid_version: env!("CARGO_PKG_VERSION"),
            case: resolved(case),
            elements: case.fibre.elements,
            steps: case.run.steps,
            replicates: case.run.replicates,
            measures,
            performance,
            notes,
        }
    }

    pub(crate) fn to_json(&self) -> String {
        // Serialising plain numbers and strings into memory cannot fail.
        let mut text = serde_json::to_string_pretty(self).unwrap_or_default();
        text.push('\n');
        text
    }
}

fn summary_of(number: &Number) -> NumberSummary<'_> {
    let Estimate { mean, standard_error, values } = &number.estimate;
    let over = |over| (number.measure.over_replicates == over).then(|| number.value());
    NumberSummary {
        median: over(Over::Median),
        largest: over(Over::Largest),
        mean: *mean,
        standard_error: *standard_error,
        values,
    }
}

fn resolved(case: &Case) -> CaseSummary {
    let (fibre, air, drag, run) = (&case.fibre, &case.air, &case.drag, &case.run);
    CaseSummary {
        fibre: CaseFibre {
            length_m: fibre.length,
            diameter_m: fibre.diameter,
            density_kg_m3: fibre.density,
            youngs_modulus_pa: fibre.youngs_modulus,
            element_length_m: fibre.rest_length(),
            root: fibre.root.name(),
            direction: [fibre.direction.x, fibre.direction.y, fibre.direction.z],
        },
        air: CaseAir {
            velocity_m_s: air.velocity,
            turbulence_intensity: air.turbulence_intensity,
            length_scale_m: air.length_scale,
            cutoff_frequency_hz: air.cutoff_frequency,
            density_kg_m3: air.density,
            kinematic_viscosity_m2_s: air.kinematic_viscosity,
            harmonics: air.harmonics,
            flow: air.flow.name(),
            spectrum: air.spectrum.name(),
            eddies: air.eddies.name(),
            records: air.records.len(),
        },
        drag: CaseDrag {
            along: drag.along.name(),
            across: drag.across.name(),
            friction_coefficient: drag.along.factor(),
        },
        run: CaseRun {
            duration_s: run.duration(),
            time_step_s: run.time_step,
            replicates: run.replicates,
            seed: run.seed,
            scheme: run.scheme.name(),
            gravity_m_s2: run.gravity,
            spin_up_s: run.spin_up(),
            output_interval_s: run.output_interval(),
            damping_1_s: run.damping,
        },
    }
}
