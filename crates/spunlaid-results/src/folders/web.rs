//! The folder of a web.

use crate::Failure;
use crate::figures::web_figures;
use crate::numbers::significant;
use crate::output::folder::Staging;
use crate::output::pictures;
use crate::output::web::{self, Layer, Performance, Summary};
use crate::report::{WebReport, web_html};
use spunlaid::input::{LayerSpec, WebFile, WebSpec};
use spunlaid::web::{Fibres, Findings, Laying, Web, Window, strands};

/// Everything of a web that goes into the files.
#[derive(Clone, Copy, Debug)]
pub struct WebFolder<'a> {
    /// What the web is called: the name of its file.
    pub name: &'a str,
    /// The file.
    pub file: &'a WebFile,
    /// The web that was laid.
    pub web: &'a Web,
    /// What was found of it.
    pub findings: &'a Findings,
    /// Notes for the reader.
    pub notes: &'a [String],
    /// What it cost.
    pub performance: Performance,
}

impl WebFolder<'_> {
    /// The text of `summary.json`.
    pub fn summary(&self) -> String {
        let rows = rows(&self.file.spec, self.web);
        Summary::new(self.web, self.findings, &rows, self.performance, self.notes).to_json()
    }

    /// Writes the map, the single fibres of a window, the figures, the report, the file of the web and the summary.
    ///
    /// # Errors
    /// If a file cannot be written, or the computation is interrupted.
    pub fn write(&self, staging: &Staging<'_>, by: Laying<'_>) -> Result<(), Failure> {
        let window = window(&self.file.spec);
        let strands = strands(self.web, window, by)?;
        let figures = web_figures(self.web, self.findings);
        // The map is packed while the figures are drawn.
        let (files, drawn) = std::thread::scope(|scope| {
            let files = scope.spawn(|| web::write(staging, self.findings, &strands));
            let draw = |name, content: &[u8]| staging.write(&format!("figures/{name}"), content);
            let drawn = pictures::write(&figures, draw);
            (files.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)), drawn)
        });
        files.and(drawn)?;
        let report = web_html(&WebReport {
            name: self.name,
            web: self.web,
            findings: self.findings,
            layers: &rows(&self.file.spec, self.web),
            strands: &strands,
            window,
            diameter: self.file.spec.layers.first().map_or(0.0, |layer| layer.diameter),
            figures: &figures,
            notes: self.notes,
            toml: &self.file.text,
            performance: self.performance,
        })?;
        staging.write("web.toml", &self.file.text)?;
        staging.write("report.html", report)?;
        staging.write("summary.json", self.summary())
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
pub fn notes(of: &Findings) -> Vec<String> {
    let mut notes = Vec::new();
    let map = &of.laid.map;
    if of.laid.cut > 0.0 {
        let whole = map.total() as f64 * map.quantum + of.laid.cut;
        notes.push(format!(
            "{} % of the fibre lies beyond the edges of the sheet and is cut off",
            significant(100.0 * of.laid.cut / whole, 2)
        ));
    }
    if of.margins != [0.0; 2] {
        let [first, last] = of.margins.map(|margin| significant(1e3 * margin, 3));
        notes.push(format!(
            "the first {first} mm and the last {last} mm across the web are left out of CV, clouds and autocorrelation, for the web is thinner there: they are edges, \
             3 σ_CD inwards of the outermost filament (web.edges = \"cut\")"
        ));
    }
    let unsure: Vec<String> = (of.patches.iter().filter(|patch| patch.map.standard_error.is_none()))
        .map(|patch| significant(1e3 * patch.map.patch, 3))
        .collect();
    if !unsure.is_empty() {
        notes.push(format!(
            "the CV over patches of {} mm has no error: the sheet holds too few independent clouds or streaks for one; make it larger, or lay several webs with \
             other seeds",
            unsure.join(", ")
        ));
    }
    if map.cells.len() > web::MOST_CELLS {
        notes.push(
            "the map is only in map.npy, for it has more cells than a table or a picture takes".to_owned(),
        );
    }
    notes
}
