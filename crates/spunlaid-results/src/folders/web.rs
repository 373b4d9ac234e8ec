//! The folder of a web.

use super::flown_cases::write_cases;
use crate::Failure;
use crate::figures::{SPINLINE, spinline_figures, web_figures};
use crate::numbers::significant;
use crate::output::folder::Staging;
use crate::output::spinline::{SpinResults, SpinSummary, write_stations};
use crate::output::web::{self, Layer, Performance, Summary};
use crate::report::{LayerSpinline, WebReport, web_html};
use spunlaid::advice::Advice;
use spunlaid::case::Case;
use spunlaid::fabric::Fabric;
use spunlaid::input::{LayerSpec, WebFile, WebSpec};
use spunlaid::layers::LayerFibres;
use spunlaid::spinline::Solution;
use spunlaid::surrogate::Residual;
use spunlaid::web::{FewDoubt, Fibres, Findings, LayControl, PatchFindings, SharedAirFindings, Web, strands};
use spunlaid_charts::Figure;
use std::borrow::Cow;

/// Everything of a web that goes into the files.
#[derive(Clone, Copy, Debug)]
pub struct WebFolder<'a> {
    /// What the web is called: the name of its file.
    pub name: &'a str,
    /// The file.
    pub file: &'a WebFile,
    /// The web that was laid.
    pub web: &'a Web,
    /// The fibres of its layers.
    pub layers: &'a [LayerFibres],
    /// What was found of it.
    pub findings: &'a Findings,
    /// What is told of the fabric.
    pub fabric: &'a Fabric,
    /// What would make it more even; None if it was not tried.
    pub advice: Option<&'a Advice>,
    /// What guesses matter for it; None if it was not tried.
    pub guesses: Option<&'a Advice>,
    /// Notes for the reader.
    pub notes: &'a [String],
    /// What it cost.
    pub performance: Performance,
}

impl WebFolder<'_> {
    /// The text of `summary.json`.
    pub fn summary(&self) -> String {
        let rows = rows(&self.file.spec, self.web, self.layers);
        let (found, tried) = ((self.findings, self.fabric), (self.advice, self.guesses));
        Summary::new(self.web, found, tried, &rows, self.performance, self.notes).to_json()
    }

    /// Writes the map, the single fibres of a window, the figures, the report, the file of the web and the summary.
    ///
    /// # Errors
    /// If a file cannot be written, or the computation is interrupted.
    pub fn write(&self, staging: &Staging<'_>, laying: LayControl<'_>) -> Result<(), Failure> {
        // The map is packed while everything else is made.
        std::thread::scope(|scope| {
            let map = scope.spawn(|| web::write_map(staging, &self.findings.laid.map));
            let others = self.write_others(staging, laying);
            map.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)).and(others)
        })
    }

    /// Writes all files but those of the map.
    fn write_others(&self, staging: &Staging<'_>, laying: LayControl<'_>) -> Result<(), Failure> {
        let (window, toml) = (self.file.spec.window(), write_cases(staging, self.file.spec.clone())?);
        let strands = match &self.findings.laid.shared_air {
            Some(together) => Cow::Borrowed(&together.strands[..]),
            None => Cow::Owned(strands(self.web, window, laying)?),
        };
        let figures = web_figures(self.web, self.findings);
        let spinlines = spinlines(&self.file.spec);
        let threads: Vec<(usize, &[Solution])> = (spinlines.iter())
            .map(|spinline| {
                (spinline.layers.first().map_or(1, |layer| layer + 1), &spinline.results.rows[..])
            })
            .collect();
        if !threads.is_empty() {
            write_stations(staging, &threads)?;
        }
        let all: Vec<&Figure> =
            figures.iter().chain(spinlines.iter().flat_map(|spinline| &spinline.figures)).collect();
        let report = std::thread::scope(|scope| {
            let others = scope.spawn(|| {
                staging.write_figures(&all)?;
                web::write_strands(staging, &strands)
            });
            let report = web_html(&WebReport {
                name: self.name,
                spec: &self.file.spec,
                web: self.web,
                findings: self.findings,
                fabric: self.fabric,
                advice: self.advice,
                guesses: self.guesses,
                layers: &rows(&self.file.spec, self.web, self.layers),
                strands: &strands,
                window,
                diameter: self.file.spec.layers.first().map_or(0.0, |layer| layer.diameter),
                figures: &figures,
                spinlines: &spinlines,
                notes: self.notes,
                toml: &toml,
                performance: self.performance,
            });
            others.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)).and(report)
        })?;
        staging.write("web.toml", &toml)?;
        staging.write("report.html", report)?;
        staging.write("summary.json", self.summary())
    }
}

/// What layers were laid from, for the files.
fn rows(spec: &WebSpec, web: &Web, layers: &[LayerFibres]) -> Vec<Layer> {
    let row = |(i, (layer, drawn)): (usize, (&LayerSpec, &spunlaid::web::Layer))| {
        let fit = residual(layers.get(i));
        let surrogate = [Some(&drawn.fibres), drawn.other_description.as_ref()]
            .into_iter()
            .flatten()
            .find_map(|fibres| match fibres {
                Fibres::Surrogate(surrogate) => Some(*surrogate),
                Fibres::Curves(_) => None,
            });
        Layer {
            name: layer.name.clone().unwrap_or_else(|| (i + 1).to_string()),
            linear_density_kg_m: drawn.linear_density,
            feed_speed_m_s: drawn.feed_speed,
            belt_speed_m_s: drawn.belt_speed,
            filaments: drawn.count(&web.sheet),
            basis_weight_kg_m2: drawn.basis_weight(&web.sheet),
            sigma_md_m: surrogate.map(|drawn| drawn.sigma_md),
            sigma_cd_m: surrogate.map(|drawn| drawn.sigma_cd),
            noise_per_sqrt_m: surrogate.map(|drawn| drawn.noise),
            fit_residual: fit.map(|fit| fit.rms),
            fit_residual_by_chance: fit.and_then(|fit| fit.by_chance),
            lateral_cutoff: spec.lateral_cutoff(i),
            spinline: layer.source.case().and_then(SpinSummary::from_case),
        }
    };
    spec.layers.iter().zip(&web.layers).enumerate().map(row).collect()
}

/// The spinlines from which the filaments of the layers come, each with all of its layers.
fn spinlines(spec: &WebSpec) -> Vec<LayerSpinline> {
    let mut found: Vec<(&Case, Vec<usize>)> = Vec::new();
    for (layer, LayerSpec { source, .. }) in spec.layers.iter().enumerate() {
        let Some(case) = source.case().filter(|case| case.spinline.is_some()) else { continue };
        let same = |known: &Case| known.spinline == case.spinline && known.drag.along == case.drag.along;
        match found.iter_mut().find(|(known, _)| same(known)) {
            Some((_, layers)) => layers.push(layer),
            None => found.push((case, vec![layer])),
        }
    }
    let solved = |(number, (case, layers)): (usize, (&Case, Vec<usize>))| {
        let results = SpinResults::from_case(case)?;
        let prefix = if number == 0 { SPINLINE.to_owned() } else { format!("{SPINLINE}_{}", number + 1) };
        let figures = spinline_figures(&prefix, &results.rows, &results.influences);
        let throughput = case.spinline.as_ref()?.throughput;
        Some(LayerSpinline { layers, throughput, results, figures })
    };
    found.into_iter().enumerate().filter_map(solved).collect()
}

/// How well the surrogate of a layer fits what its fibres have laid.
fn residual(layer: Option<&LayerFibres>) -> Option<Residual> {
    layer?.flown.as_ref()?.residual
}

/// What a reader must know of what was found.
pub fn notes(web: &Web, findings: &Findings, layers: &[LayerFibres]) -> Vec<String> {
    let mut notes = match &findings.laid.shared_air {
        Some(together) => {
            [lost_filament_notes(web, together), few_filament_notes(findings, together)].concat()
        }
        None => model_notes(web, findings, layers),
    };
    let map = &findings.laid.map;
    if findings.laid.cut > 0.0 {
        let whole = map.total() as f64 * map.quantum + findings.laid.cut;
        notes.push(format!(
            "{} % of the fibre lies beyond the edges of the sheet and is cut off",
            significant(100.0 * findings.laid.cut / whole, 2)
        ));
    }
    if findings.margins != [0.0; 2] {
        let [first, last] = findings.margins.map(|margin| significant(1e3 * margin, 3));
        notes.push(format!(
            "the first {first} mm and the last {last} mm across the web are left out of CV, clouds and \
             autocorrelation, because the web is thinner at its edges, which reach 3 σ_CD inwards from the \
             outermost filament (web.edges = \"cut\")"
        ));
    }
    let together = findings.laid.shared_air.as_ref();
    let is_told = |patch: f64| together.is_none_or(|together| together.tells(patch));
    let unsure: Vec<f64> = (findings.patches.iter().map(|patch| patch.map))
        .filter(|map| map.standard_error.is_none() && is_told(map.patch))
        .map(|map| map.patch)
        .collect();
    if !unsure.is_empty() {
        notes.push(format!(
            "the CV over patches of {} mm has no error: the sheet holds too few independent clouds or streaks for one; make it larger, or lay several webs with \
             other seeds",
            sizes(unsure.into_iter())
        ));
    }
    if map.cells.len() > web::MOST_CELLS {
        notes.push(
            "the map is only in map.npy, because it has more cells than a table or a picture can hold"
                .to_owned(),
        );
    }
    notes
}

/// Sides of patches, in mm.
fn sizes(patches: impl Iterator<Item = f64>) -> String {
    patches.map(|patch| significant(1e3 * patch, 3)).collect::<Vec<_>>().join(", ")
}

/// How many filaments of a web in one air were lost.
fn lost_filament_notes(web: &Web, together: &SharedAirFindings) -> Vec<String> {
    let count = |number: usize, layer: &spunlaid::web::Layer| {
        let few = together.few.iter().find(|few| few.layer == number);
        few.map_or_else(|| layer.count(&web.sheet), |few| few.filaments + few.lost)
    };
    let all: u64 = web.layers.iter().enumerate().map(|(number, layer)| count(number, layer)).sum();
    match together.lost {
        0 => Vec::new(),
        lost => vec![format!(
            "{lost} of {all} filaments {} lost in flight, and each is missing from then on: the web is lighter by that, and a little more uneven",
            if lost == 1 { "was" } else { "were" }
        )],
    }
}

/// Part of the variance that filled-in filaments may miss where small patches of the map are to be believed.
const MISSING: f64 = 0.1;

/// Whether the few filaments that were flown are enough for what is told of all.
fn few_filament_notes(findings: &Findings, together: &SharedAirFindings) -> Vec<String> {
    let mut notes = Vec::new();
    for few in &together.few {
        let what = match few.doubt() {
            Some(FewDoubt::Halves(patch, off)) => format!(
                "every second one of the flown filaments would tell a CV over patches of {} mm that is {} % {}",
                significant(1e3 * patch, 3),
                significant(100.0 * off.abs(), 2),
                if off > 0.0 { "higher" } else { "lower" }
            ),
            Some(FewDoubt::Neighbours(correlation)) => format!(
                "the flown filaments are {} mm apart, and the places where such neighbours come down have a correlation of {}",
                significant(1e3 * few.pitch, 3),
                significant(correlation, 2)
            ),
            None => continue,
        };
        let untold = few.cvs.iter().filter(|cv| few.doubt_over(cv.patch).is_some());
        notes.push(format!(
            "the CV over patches of {} mm has no error, because {what}: too few filaments were flown to tell what all do. Fly twice as many, web.flown = {}, or \"all\"; \
             \"auto\" flies as many as are needed, up to four times its first number",
            sizes(untold.map(|cv| cv.patch)),
            (2.0 / few.pitch).round()
        ));
    }
    let missing = together.few.iter().flat_map(|few| few.missing).fold(0.0, f64::max);
    if missing > MISSING {
        notes.push(format!(
            "filaments between the flown ones are known but for {} % of their variance, so the map is too uneven over patches below 10 mm; the CV \
             that is told is not. Fly more filaments for the map (web.flown)",
            significant(100.0 * missing, 2)
        ));
    }
    let larger: Vec<f64> = (findings.patches.iter())
        .filter(|patch| patch.few.is_none() && !together.few.is_empty())
        .map(|patch| patch.map.patch)
        .collect();
    if !larger.is_empty() {
        notes.push(format!(
            "the sheet that was flown is too small for patches of {} mm: their CV is that of the map, which is made of pieces of that sheet, and it has \
             no error",
            sizes(larger.into_iter())
        ));
    }
    notes
}

/// A flown CV with a larger relative error checks no surrogate within 5 %.
const TOO_FEW: f64 = 0.025;
/// A surrogate whose autocorrelations are farther off, beyond chance, does not describe the laid fibre.
const POOR_FIT: f64 = 0.05;

/// Whether the surrogate speaks for the flown fibres, and which of them to believe where it does not.
fn model_notes(web: &Web, findings: &Findings, layers: &[LayerFibres]) -> Vec<String> {
    let mut notes = Vec::new();
    let by_surrogate = web.layers.iter().any(|layer| matches!(layer.fibres, Fibres::Surrogate(_)));
    let element = web.longest_element().unwrap_or(0.0);
    let (coarse, fine): (Vec<&PatchFindings>, Vec<_>) = findings
        .patches
        .iter()
        .filter(|patch| patch.surrogate_is_far())
        .partition(|patch| patch.map.patch >= element);
    let apart = |patch: &PatchFindings| patch.surrogate_over_flown().map_or(0.0, |difference| difference.0);
    if let Some(most) = coarse.iter().max_by(|a, b| apart(a).abs().total_cmp(&apart(b).abs())) {
        let cv = |estimate: Option<(f64, f64)>| {
            significant(100.0 * estimate.map_or(f64::NAN, |estimate| estimate.0), 3)
        };
        let remedy = if by_surrogate {
            "web.method = \"dynamics\" lays the map from them"
        } else {
            "this map is laid from them"
        };
        notes.push(format!(
            "the surrogate’s CV is more than 5 % from that of the flown curves over patches of {}: {} for {} %, {} \
             % {}, over patches of {}. Rely on the flown curves there: the flight has laid them, and the \
             surrogate has only their spread and their autocorrelation. {remedy}",
            sides(&coarse),
            cv(most.surrogate),
            cv(most.flown),
            significant(100.0 * apart(most).abs(), 2),
            if apart(most) < 0.0 { "too low" } else { "too high" },
            sides(&[*most])
        ));
    }
    if !fine.is_empty() {
        notes.push(format!(
            "over patches of {} the surrogate and the flown curves also differ by more than 5 %, and neither is \
             accurate to 5 % there, because these patches are smaller than an element of the flight, {} mm \
             (fibre.element_length)",
            sides(&fine),
            significant(element * 1e3, 3)
        ));
    }
    let too_few = |patch: &&PatchFindings| {
        !patch.surrogate_is_far()
            && patch.flown.is_some_and(|(cv, error)| error.is_nan() || error > TOO_FEW * cv)
    };
    let unknown: Vec<&PatchFindings> = findings.patches.iter().filter(too_few).collect();
    let errors = unknown.iter().filter_map(|patch| patch.flown).map(|(cv, error)| error / cv);
    if let Some(error) = errors.max_by(f64::total_cmp) {
        let known = if error.is_nan() {
            "rests on a single fibre, so its error is not known".to_owned()
        } else {
            format!("is known within {} % only, one standard error", significant(100.0 * error, 2))
        };
        notes.push(format!(
            "over patches of {} the CV of the flown curves {known}; the surrogate cannot be checked within 5 %. Fly more fibre \
             (run.replicates, run.duration)",
            sides(&unknown)
        ));
    }
    if by_surrogate && findings.patches.iter().any(|patch| patch.flown.is_none()) {
        notes.push(
            "no fibre was flown for every layer of this web, so the errors are by chance only, and it is not known \
             how far a surrogate with these numbers is from real fibres. Compared with flown curves, its CV was \
             up to 20 % wrong (docs/web.md)"
                .to_owned(),
        );
    }
    if let ([layer], false) = (&web.layers[..], findings.sensitivities.is_empty())
        && layer.belt_changes_flight()
    {
        notes.push(format!(
            "the effect of a faster belt is not given, because this belt runs at {} of the feed speed and pulls at \
             the fibre in the air, so the flight changes with it; fly webs at other speeds (a study over \
             belt.speed, docs/web.md)",
            significant(layer.belt_ratio(), 2)
        ));
    }
    for (layer, row) in web.layers.iter().zip(layers) {
        let Some(fit) = residual(Some(row)) else { continue };
        let excess = (fit.rms.powi(2) - fit.by_chance.unwrap_or(0.0).powi(2)).max(0.0).sqrt();
        if excess > POOR_FIT {
            notes.push(format!(
                "no surrogate describes the laid fibre of {} well: its autocorrelation differs by {} (rms) from \
                 that of the best one, and chance would explain {}",
                grams(layer.basis_weight(&web.sheet)),
                significant(fit.rms, 2),
                fit.by_chance.map_or_else(|| "an unknown part".to_owned(), |residual| significant(residual, 2))
            ));
        }
    }
    notes
}

fn grams(weight: f64) -> String {
    format!("the layer of {} g/m²", significant(weight * 1e3, 3))
}

/// `2, 5 and 10 mm`.
fn sides(patches: &[&PatchFindings]) -> String {
    let sides: Vec<String> = patches.iter().map(|patch| significant(patch.map.patch * 1e3, 3)).collect();
    match sides.as_slice() {
        [first @ .., last] if !first.is_empty() => format!("{} and {last} mm", first.join(", ")),
        sides => format!("{} mm", sides.concat()),
    }
}
