//! The folder of a web.

use crate::Failure;
use crate::figures::{SPINLINE, effects_figure, spinline_figures, web_figures};
use crate::output::copied_files::{self, CASE_FILES};
use crate::output::folder::Staging;
use crate::output::spinline::{SpinResults, SpinSummary, write_stations};
use crate::output::web::{self, Layer, Performance, Summary};
use crate::report::{LayerSpinline, web_report};
use spunlaid::advice::Advice;
use spunlaid::case::Case;
use spunlaid::fabric::Fabric;
use spunlaid::input::{LayerSpec, WebFile, WebSpec, write_web};
use spunlaid::layers::{FlownWeb, LayerFibres};
use spunlaid::spinline::Solution;
use spunlaid::web::{Fibres, Findings, LayControl, Web, strands};
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
        let (window, toml) = (self.file.spec.window(), keep_web(staging, &self.file.spec)?);
        let strands = match &self.findings.laid.shared_air {
            Some(together) => Cow::Borrowed(&together.strands[..]),
            None => Cow::Owned(strands(self.web, window, laying)?),
        };
        let tried = [self.advice, self.guesses].into_iter().flatten();
        let effects = tried.filter_map(|tried| effects_figure(&self.file.spec, tried));
        let figures: Vec<Figure> = web_figures(self.web, self.findings).into_iter().chain(effects).collect();
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
            let report = web_report(
                (&self.file.spec, &toml, self.web),
                (self.findings, self.fabric),
                (self.advice, self.guesses),
                (&rows(&self.file.spec, self.web, self.layers), &spinlines),
                &strands,
                &figures,
                self.performance,
            );
            let report = report.map(|report| report.named(self.name).noting(self.notes).html());
            others.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)).and(report)
        })?;
        staging.write("web.toml", &toml)?;
        staging.write("report.html", report)?;
        staging.write("summary.json", self.summary())
    }
}

/// Copies the files that the cases of a web name. Returns the text of the web's file, which names the copies.
pub(super) fn keep_web(staging: &Staging<'_>, spec: &WebSpec) -> Result<String, Failure> {
    let copied = copied_files::copy(spec.files(), &staging.place(CASE_FILES).0)?;
    Ok(write_web(&spec.with_files_at(copied_files::place(&copied))))
}

/// What layers were laid from, for the files.
fn rows(spec: &WebSpec, web: &Web, layers: &[LayerFibres]) -> Vec<Layer> {
    let row = |(i, (layer, drawn)): (usize, (&LayerSpec, &spunlaid::web::Layer))| {
        let fit = layers.get(i).and_then(LayerFibres::residual);
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

/// What a reader must know of what was found.
pub fn notes(flown: &FlownWeb, findings: &Findings) -> Vec<String> {
    let mut notes: Vec<String> = flown.doubts(findings).iter().map(ToString::to_string).collect();
    if findings.laid.map.cells.len() > web::MOST_CELLS {
        notes.push(
            "the map is only in map.npy, because it has more cells than a table or a picture can hold"
                .to_owned(),
        );
    }
    notes
}
