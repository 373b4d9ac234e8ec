//! The folders of products that are written at once: the air of a case, the claims of the paper, a velocity record, a
//! scan, the sources of filaments, and a spinline.

use crate::Failure;
use crate::figures::{SPINLINE, field_figure, record_figures, scan_figures, spinline_figures};
use crate::folders::contents::{Contents, Maker, Page};
use crate::folders::web::WebFolder;
use crate::numbers::{THIN, significant};
use crate::output::air::{self, PlaneFindings, Slices, pictures};
use crate::output::analysis::{air_block, analysis_json, write_curves};
use crate::output::folder::{CASE_FILES, ENTRIES, Staging};
use crate::output::kept_input::Input;
use crate::output::origin::ORIGIN;
use crate::output::sources::{self, OPENFOAM, VTK, write_openfoam};
use crate::output::spinline::{self, STATIONS, SpinResults, remarks, write_stations};
use crate::output::summary::Performance;
use crate::output::table::TABLES;
use crate::output::versioned_json;
use crate::output::web::{summary_of_scan, write_scan};
use crate::report::{
    air_report, analysis_report, paper_report, scan_report, sources_report, spinline_report,
};
use serde_json::json;
use spunlaid::air::{Analysis, Record};
use spunlaid::experiment::Claim;
use spunlaid::fibre::{Case, Remark};
use spunlaid::ground::{Error, Isa};
use spunlaid::input::SpinFile;
use spunlaid::simulation::Sources;
use spunlaid::web::Fabric;
use spunlaid::web::fabric::of_scan;
use spunlaid::web::scan::Findings;
use spunlaid_charts::Figure;
use std::time::Instant;

/// Everything of a look at the air that goes into the files.
#[derive(Clone, Copy, Debug)]
pub struct AirFolder<'a> {
    /// What the case is called: the name of its file.
    pub name: &'a str,
    /// The case.
    pub case: &'a Case,
    /// What was found.
    pub slices: &'a Slices,
    /// Number of the replicate whose air it is, from 0.
    pub replicate: u64,
    /// Notes for the reader.
    pub notes: &'a [String],
}

impl AirFolder<'_> {
    /// How strong the gusts are, in a sentence.
    fn headline(&self) -> String {
        let PlaneFindings { rms, expected_rms, .. } = PlaneFindings::new(self.case, self.slices, 0);
        let [x, y, z] = rms.map(|rms| significant(rms, 3));
        format!(
            "Gusts of {x}, {y} and {z}{THIN}m/s (rms along x, y and z, over the pictures); {}{THIN}m/s are expected.",
            significant(expected_rms, 3)
        )
    }
}

impl Contents for AirFolder<'_> {
    const ENTRIES: &'static [&'static str] = &[
        ORIGIN,
        CASE_FILES,
        "case.toml",
        "along.pvd",
        "across.pvd",
        "slices",
        "figures",
        "report.html",
        "summary.json",
    ];

    fn summary(&self) -> String {
        air::summary(self.case, self.slices, self.replicate, self.notes)
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let input = maker.keep(Input::Case(self.case))?;
        let field: Vec<Figure> = field_figure(self.case, None).into_iter().collect();
        let pictures = pictures(self.case, self.slices);
        let figures: Vec<&Figure> = field.iter().chain(&pictures).collect();
        let files = |staging: &Staging<'_>| air::write_vtk(staging, self.slices);
        let report =
            || Ok(air_report((self.case, &input), self.slices, [&field, &pictures], self.headline()));
        maker.finish((self.name, self.notes), &figures, files, report)
    }
}

/// Everything of the paper that goes into the files.
#[derive(Clone, Copy, Debug)]
pub struct PaperFolder<'a> {
    /// The claims, with their evidence and verdicts.
    pub claims: &'a [Claim],
    /// The figures.
    pub figures: &'a [Figure],
    /// The choices that the paper leaves open, with their results.
    pub choices: &'a [(String, Vec<String>)],
    /// How it was computed, in a sentence.
    pub how: &'a str,
    /// The case that is varied.
    pub case: &'a Case,
}

impl Contents for PaperFolder<'_> {
    const ENTRIES: &'static [&'static str] = ENTRIES;

    fn summary(&self) -> String {
        versioned_json(1, json!({"claims": self.claims}))
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let input = maker.keep(Input::Case(self.case))?;
        let report =
            || Ok(paper_report(self.claims, self.figures, self.choices, self.how, (self.case, &input)));
        maker.finish(("Battocchio, Sutcliffe & Teschner 2015", &[]), self.figures, |_| Ok(()), report)
    }
}

/// Everything of an analysis that goes into the files.
#[derive(Clone, Copy, Debug)]
pub struct RecordFolder<'a> {
    /// What the record is called: the name of its file.
    pub name: &'a str,
    /// The record.
    pub record: &'a Record,
    /// What was found in it.
    pub analysis: &'a Analysis,
    /// Remarks about its reading.
    pub remarks: &'a [String],
}

impl Contents for RecordFolder<'_> {
    const ENTRIES: &'static [&'static str] = ENTRIES;
    const SUMMARY: &'static str = "analysis.json";

    fn summary(&self) -> String {
        analysis_json(self.record, self.analysis)
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let Self { name, record, analysis, remarks } = *self;
        let (figures, air) = (record_figures(record, analysis), air_block(&record.file, analysis));
        let warnings: Vec<String> = analysis.warnings.iter().map(ToString::to_string).collect();
        let files = |staging: &Staging<'_>| {
            write_curves(staging, analysis)?;
            staging.write("air.toml", &air)
        };
        let report = || Ok(analysis_report(record, analysis, &figures, remarks, &air));
        maker.finish((name, &warnings), &figures, files, report)
    }
}

/// Everything of a scan that goes into the files.
#[derive(Debug)]
pub struct ScanFolder {
    /// What the scan is called: the name of its file.
    pub name: String,
    /// The path of its file.
    file: String,
    /// What was found of it.
    pub findings: Findings,
    /// What is told of the fabric.
    fabric: Fabric,
    /// What a reader must know of what was found.
    pub notes: Vec<String>,
    /// What it cost.
    performance: Performance,
}

impl ScanFolder {
    /// * `started` – when the scan began to be read
    pub fn new(name: String, file: String, findings: Findings, started: Instant) -> Self {
        let (fabric, performance) = (of_scan(&findings), Performance::measure(started, 1, Isa::detect()));
        let notes = findings.notes.iter().map(ToString::to_string).collect();
        Self { name, file, findings, fabric, notes, performance }
    }
}

impl Contents for ScanFolder {
    const ENTRIES: &'static [&'static str] = WebFolder::ENTRIES;

    fn summary(&self) -> String {
        summary_of_scan(&self.file, (&self.findings, &self.fabric), self.performance, &self.notes)
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let found = (&self.findings, &self.fabric);
        let figures = scan_figures(&self.findings);
        let report = || scan_report(&self.file, found, &figures, self.performance);
        maker.finish(
            (&self.name, &self.notes),
            &figures,
            |staging| write_scan(staging, &self.findings.map),
            report,
        )
    }
}

/// Everything of the sources that goes into the files.
#[derive(Clone, Copy, Debug)]
pub struct SourcesFolder<'a> {
    /// What the line is called: the name of its file.
    pub name: &'a str,
    /// The case that was flown.
    pub case: &'a Case,
    /// What it is from.
    pub input: Input<'a>,
    /// What was found.
    pub sources: &'a Sources,
    /// Notes for the reader.
    pub notes: &'a [String],
}

impl Contents for SourcesFolder<'_> {
    const ENTRIES: &'static [&'static str] =
        &[ORIGIN, CASE_FILES, "case.toml", "web.toml", VTK, OPENFOAM, "report.html", "summary.json"];

    fn summary(&self) -> String {
        sources::summary(self.case, self.sources, self.notes)
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let input = maker.keep(self.input)?;
        let files = |staging: &Staging<'_>| {
            if !self.sources.are_steady() {
                return Ok(());
            }
            sources::write_vtk(staging, self.case, self.sources)?;
            write_openfoam(staging, self.case, self.sources)
        };
        let report = || Ok(sources_report((self.case, &input), self.sources));
        maker.finish((self.name, self.notes), &[] as &[Figure], files, report)
    }
}

/// Everything of a spinline that goes into the files.
#[derive(Debug)]
pub struct SpinFolder {
    /// What the spinline is called: the name of its file.
    pub name: String,
    /// The spinline.
    pub file: SpinFile,
    /// Its solution.
    pub results: SpinResults,
    /// Remarks about what was found.
    pub found: Vec<String>,
}

impl SpinFolder {
    /// Solves a spinline.
    ///
    /// # Errors
    /// If it has no steady state that a line could run in.
    pub fn solve(name: String, file: SpinFile) -> Result<Self, Error> {
        let results = SpinResults::new(&file)?;
        let found = remarks(&results.rows);
        Ok(Self { name, file, results, found })
    }

    /// Notes for the reader.
    fn notes(&self) -> Vec<String> {
        [Remark::notes_of_results(&self.file.notes), self.found.clone()].concat()
    }
}

impl Contents for SpinFolder {
    const ENTRIES: &'static [&'static str] =
        &[ORIGIN, "spinline.toml", CASE_FILES, STATIONS, TABLES, "figures", "report.html", "summary.json"];

    fn summary(&self) -> String {
        spinline::summary(&self.results, &self.notes())
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let SpinResults { rows, influences } = &self.results;
        let input = maker.keep(Input::Spinline(&self.file.spec))?;
        let figures = spinline_figures(SPINLINE, rows, influences);
        let report = || Ok(spinline_report(&self.file.spec, &self.results, &figures, &input));
        let files = |staging: &Staging<'_>| write_stations(staging, &[(1, rows)]);
        maker.finish((&self.name, &self.notes()), &figures, files, report)
    }
}
