//! `spunlaid web`: lays a web of many filaments and says how even it is.

mod fibres;
mod laid;

use super::interrupt::stop_on_ctrl_c;
use super::{stem, threads};
use crate::args;
use crate::failure::Failure;
use crate::figures::web_figures;
use crate::numbers::{plus_minus, significant};
use crate::output::folder::Staging;
use crate::output::pictures;
use crate::output::web::{self, ENTRIES, Layer, Performance, Summary};
use crate::report::{WebReport, web_html};
use crate::{progress, say};
use fibres::{Flyer, OfLayer};
use spunlaid::input::{LayerSpec, Method, Overrides, WebFile, WebSpec, read_web};
use spunlaid::lanes::Isa;
use spunlaid::web::{Fibres, Findings, Laying, Strand, Web, Window, find, pieces, strands};
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicU64;
use std::time::Instant;

pub(crate) fn web(asked: &args::Web) -> Result<(), Failure> {
    let file = read_web(&asked.file, Overrides { values: &asked.set, word: "--set" })?;
    file.notes.iter().for_each(say::note);
    let name = stem(&asked.file, "web").to_string_lossy().into_owned();
    let folder = (asked.out.is_some() || !asked.json).then(|| super::folder(asked.out.as_ref(), &name));
    let stop = stop_on_ctrl_c();
    let staging =
        folder.as_ref().map(|folder| Staging::new(folder, ENTRIES, asked.force, stop)).transpose()?;

    let started = Instant::now();
    let mut flyer = Flyer::new(threads(asked.threads), stop, asked.quiet);
    let layers = file.spec.layers.iter().map(|layer| flyer.fibres(&file.spec, layer));
    let layers: Vec<OfLayer> = layers.collect::<Result<_, _>>()?;
    let web = to_lay(&file.spec, &layers)?;

    let laid = AtomicU64::new(0);
    let by = Laying { threads: threads(asked.threads), isa: Isa::detect(), stop, laid: &laid };
    let label = format!("laying {} km of fibre", significant(web.fibre_length() / 1e3, 3));
    let findings = progress::follow(&laid, pieces(&web)?, &label, asked.quiet, || find(&web, by))?;
    let performance = Performance {
        wall_s: started.elapsed().as_secs_f64(),
        threads: by.threads,
        instruction_set: by.isa.name(),
    };
    let found = notes(&findings);
    let notes: Vec<String> =
        file.notes.iter().map(ToString::to_string).chain(found.iter().cloned()).collect();
    let rows = rows(&file.spec, &web);
    let summary = Summary::new(&web, &findings, &rows, performance, &notes).to_json();
    if let Some(staging) = staging {
        let window = window(&file.spec);
        let strands = strands(&web, window, by)?;
        let written = Written {
            name: &name,
            file: &file,
            web: &web,
            findings: &findings,
            rows: &rows,
            notes: &notes,
            performance,
        };
        written.to(&staging, &strands, window)?;
        staging.write("summary.json", &summary)?;
        staging.publish()?;
    }
    if asked.json {
        say::text(&summary);
    } else if !asked.quiet {
        say::text(&told(&findings));
        say::line(&format!("\n{label} took {:.2} s", performance.wall_s));
        found.iter().for_each(|note| say::remark(false, note));
        if let Some(folder) = folder {
            say::line(&format!("open {}", folder.join("report.html").display()));
        }
    }
    Ok(())
}

/// The web with the fibres of its layers. Beside flown curves stands their surrogate, and the other way round.
fn to_lay(spec: &WebSpec, layers: &[OfLayer]) -> Result<Web, Failure> {
    let mut web = spec.web(layers.iter().map(|layer| layer.fibres.clone()));
    for ((layer, of), named) in web.layers.iter_mut().zip(layers).zip(&spec.layers) {
        layer.compared = of.flown.as_ref().and_then(|flown| match spec.method {
            Method::Surrogate => Some(Fibres::Curves(Arc::clone(&flown.curves))),
            Method::Dynamics => flown.surrogate(source(named)).ok().map(Fibres::Surrogate),
        });
    }
    Ok(web)
}

/// What a layer's fibres come from, for messages.
fn source(layer: &LayerSpec) -> &Path {
    use spunlaid::input::LaydownSource::{Case, Results, Surrogate};
    match &layer.source {
        Case { path, .. } | Results { folder: path, .. } => path,
        Surrogate(_) => Path::new(""),
    }
}

/// The square in the middle of the sheet whose single fibres are shown.
fn window(spec: &WebSpec) -> Window {
    let side = spec.window;
    Window { corner: [spec.sheet.width, spec.sheet.length].map(|size| 0.5 * (size - side)), sides: [side; 2] }
}

/// What layers were laid from, for the files.
fn rows(spec: &WebSpec, web: &Web) -> Vec<Layer> {
    let row = |(i, (layer, of)): (usize, (&LayerSpec, &spunlaid::web::Layer))| {
        let surrogate =
            [Some(&of.fibres), of.compared.as_ref()].into_iter().flatten().find_map(|fibres| match fibres {
                Fibres::Surrogate(surrogate) => Some(*surrogate),
                Fibres::Curves(_) => None,
            });
        Layer {
            name: layer.name.clone().unwrap_or_else(|| (i + 1).to_string()),
            linear_density_kg_m: of.linear_density,
            feed_speed_m_s: of.feed_speed,
            belt_speed_m_s: of.belt_speed,
            filaments: of.count(&web.sheet),
            basis_weight_kg_m2: of.basis_weight(&web.sheet),
            sigma_md_m: surrogate.map(|of| of.sigma_md),
            sigma_cd_m: surrogate.map(|of| of.sigma_cd),
            noise_per_sqrt_m: surrogate.map(|of| of.noise),
        }
    };
    spec.layers.iter().zip(&web.layers).enumerate().map(row).collect()
}

/// What a reader must know of what was found.
fn notes(of: &Findings) -> Vec<String> {
    let mut notes = Vec::new();
    let map = &of.laid.map;
    if of.laid.cut > 0.0 {
        let whole = map.total() as f64 * map.quantum + of.laid.cut;
        notes.push(format!(
            "{} % of the fibre lies beyond the edges of the sheet and is cut off",
            significant(100.0 * of.laid.cut / whole, 2)
        ));
    }
    if map.cells.len() > web::MOST_CELLS {
        notes.push(
            "the map is only in map.npy, for it has more cells than a table or a picture takes".to_owned(),
        );
    }
    notes
}

/// The table for the terminal.
fn told(of: &Findings) -> String {
    let per_cent = |cv: f64, error: Option<f64>| plus_minus(100.0 * cv, error.map(|error| 100.0 * error));
    let mut text = format!(
        "basis weight {} g/m²\nunevenness, CV in % ± standard error\n  {:>9}  {:>16}  {:>24}  {:>16}\n",
        significant(of.laid.map.basis_weight() * 1e3, 4),
        "patch",
        "this map",
        "expected (single fibres)",
        "straight fibres"
    );
    for patch in &of.patches {
        let side = format!("{} mm", significant(patch.map.patch * 1e3, 3));
        let map = per_cent(patch.map.cv, patch.map.standard_error);
        let alone = per_cent(patch.one_fibre.0, Some(patch.one_fibre.1));
        let straight = significant(100.0 * patch.straight_fibres, 3);
        text.push_str(&format!("  {side:>9}  {map:>16}  {alone:>24}  {straight:>16}\n"));
    }
    text
}

/// Everything that goes into the files.
struct Written<'a> {
    name: &'a str,
    file: &'a WebFile,
    web: &'a Web,
    findings: &'a Findings,
    rows: &'a [Layer],
    notes: &'a [String],
    performance: Performance,
}

impl Written<'_> {
    fn to(&self, staging: &Staging<'_>, strands: &[Strand], window: Window) -> Result<(), Failure> {
        web::write(staging, self.findings, strands)?;
        let figures = web_figures(self.web, self.findings);
        pictures::write(&figures, |name, content| staging.write(&format!("figures/{name}"), content))?;
        let report = web_html(&WebReport {
            name: self.name,
            web: self.web,
            findings: self.findings,
            layers: self.rows,
            strands,
            window,
            diameter: self.file.spec.layers.first().map_or(0.0, |layer| layer.diameter),
            figures: &figures,
            notes: self.notes,
            toml: &self.file.text,
            performance: self.performance,
        })?;
        staging.write("web.toml", &self.file.text)?;
        staging.write("report.html", report)
    }
}
