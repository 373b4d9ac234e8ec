//! A study: points with their results.

pub(crate) mod figures;
mod files;
mod report;

use crate::Failure;
use crate::failure::other_study;
use crate::files::folder::{CASE_FILES, Staging};
use crate::files::kept_input::{copy, places};
use crate::files::origin::Origin;
use crate::files::table::TABLES;
use crate::folders::{Contents, JournalFolder, Maker, Making, Page, Work, remove};
use crate::numbers::lost_fibres_text;
use figures::study_figures;
use files::json::write_json;
use report::study_report;
use spunlaid_experiment::study::{judge, rankings};
use spunlaid_experiment::{
    Claim, Experiment, Header, Journal, JournalState, PointResults, Rankings, ReplicateOutcome, Study,
};
use spunlaid_fibre::case::keys;
use spunlaid_fibre::{MOST_REPLICATES, SpinSpec, spinline};
use spunlaid_ground::Fault;
use spunlaid_input::{StudyFile, StudyNote, differences};
use std::collections::{BTreeMap, BTreeSet};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::{fs, io};

pub use figures::quantity::Scale;
pub use files::shown;

const STUDY: &str = "study.toml";
/// Files that describe the study, which one that was killed before its journal existed may have left.
const DESCRIPTION: &[&str] = &[CASE_FILES, "case.toml", "web.toml", "spinline.toml", STUDY];
/// Files that are made from the journal; the last one marks them as complete.
const MADE: &[&str] = &[
    "results.csv",
    "results.json",
    "results.parquet",
    "replicates.parquet",
    TABLES,
    "figures",
    "report.html",
];
/// Files of other results, and the journal that studies of webs had before they were like all others.
const OF_OTHERS: &[&str] =
    &["summary.json", "end_node.parquet", "energy.parquet", "analysis.json", "webs.jsonl"];

/// Opens the folder to begin a study, or to continue the same study. Returns its journal, and what that holds
/// if there was one.
///
/// * `force` – what the folder holds is replaced
/// * `origin` – the command that asks; a complete study that the same one made before is replaced too, when
///   this one is complete
/// * `stop` – if this is set, nothing more is written
///
/// # Errors
/// If it cannot be written, or holds something else.
pub fn open<'a>(
    path: &Path,
    file: &StudyFile,
    force: bool,
    origin: Option<&Origin>,
    stop: &'a AtomicBool,
) -> Result<(JournalFolder<'a>, Journal, Option<JournalState>), Failure> {
    let wanted = Header { version: env!("CARGO_PKG_VERSION").to_owned(), study: file.study.identity() };
    let size = (file.study.points.len(), MOST_REPLICATES);
    let entries = &[DESCRIPTION, MADE];
    let work = Work { header: &wanted, entries, description: DESCRIPTION, force, origin, size };
    let begin = |place: &Path| begin(place, file, stop);
    let (at, journal, found) = JournalFolder::open(path, &work, stop, begin, |place| differs(place, file))?;
    if found.is_some() {
        let (stored, most) = (journal.most_held(), file.study.replicates.at_most);
        if stored > most {
            let fault = Fault::new(
                format!("holds {stored} replicates of a point, more than the {most} of this study"),
                format!("ask for {stored} or more, name another folder, or start again"),
            );
            let options = format!("--replicates {stored}, --out, --force");
            return Err(Failure::folder(at.place(), fault.option(options)));
        }
        // These files follow from the study, so they are restored if someone has removed them. They are
        // renewed for more replicates.
        let was = fs::read_to_string(at.place().join(STUDY)).unwrap_or_default();
        let [text, _] = with_files_at(file, &places(files_of(file)));
        if was != text || !at.place().join(file.base_name()).exists() {
            describe(at.place(), file, stop)?;
        }
    }
    Ok((at, journal, found))
}

/// Makes the tables, the figures and the report from the journal. Returns what was found, and what a terminal shows.
///
/// * `name` – what the study is called
///
/// # Errors
/// If a file cannot be written, or the journal cannot be read.
pub fn write<'f>(
    folder: &mut JournalFolder<'_>,
    name: &str,
    file: &'f StudyFile,
    journal: &mut Journal,
    making: Making<'_>,
) -> Result<(FoundStudy<'f>, String), Failure> {
    let staging = folder.staging::<FoundStudy<'_>>()?;
    let results = files::write(&staging, &file.study, journal)?;
    let rankings = rankings(&file.study, journal)?;
    let claims = judge(&file.study, &results, &rankings.of_measures, journal)?;
    let found = FoundStudy { name: name.to_owned(), file, results, rankings, claims };
    let text = folder.finish(staging, &found, making)?;
    Ok((found, text))
}

/// Removes the files of an earlier study, and describes this one.
fn begin(place: &Path, file: &StudyFile, stop: &AtomicBool) -> Result<(), Failure> {
    OF_OTHERS.iter().chain(MADE).try_for_each(|name| remove(&place.join(name)))?;
    describe(place, file, stop)
}

fn describe(place: &Path, file: &StudyFile, stop: &AtomicBool) -> Result<(), Failure> {
    let mut staging = Staging::new(place, DESCRIPTION, true, stop)?;
    let copied = copy(files_of(file), &staging.place(CASE_FILES).0)?;
    for (name, text) in [STUDY, file.base_name()].into_iter().zip(with_files_at(file, &copied)) {
        staging.write(name, text)?;
    }
    staging.publish()
}

/// The error that lists how the study in a folder differs.
fn differs(place: &Path, file: &StudyFile) -> Failure {
    let copied = places(files_of(file));
    let mut all = Vec::new();
    for (name, now) in [STUDY, file.base_name()].into_iter().zip(with_files_at(file, &copied)) {
        let was = fs::read_to_string(place.join(name)).unwrap_or_default();
        all.extend(differences(&was, &now).into_iter().map(|line| format!("{name}: {line}")));
    }
    let mut changed = BTreeSet::new();
    for (file, parts) in files_of(file) {
        let Some(to) = copied.get(file).map(|to| place.join(to)) else { continue };
        let beside = parts.iter().map(|part| (file.with_file_name(part), to.with_file_name(part)));
        let all = std::iter::once((file.to_owned(), to.clone())).chain(beside);
        changed.extend(all.filter(|(from, to)| to.exists() && fs::read(from).ok() != fs::read(to).ok()));
    }
    all.extend(changed.iter().map(|(from, to)| {
        let [from, to] = [from, to].map(|path| path.display());
        format!("{from}: its content has changed; {to} has what the results were computed with")
    }));
    other_study(place, all)
}

/// A study, and what was found. The tables are made from its journal.
#[derive(Debug)]
pub struct FoundStudy<'a> {
    name: String,
    file: &'a StudyFile,
    /// The results of each point.
    pub results: Vec<PointResults>,
    rankings: Rankings,
    claims: Vec<Claim>,
}

impl FoundStudy<'_> {
    /// Why the keys are not ranked, if there are several.
    pub fn refusal(&self) -> Option<String> {
        let refusal = self.rankings.refusal.as_ref().filter(|_| self.file.study.factors.len() > 1);
        refusal.map(ToString::to_string)
    }
}

impl Contents for FoundStudy<'_> {
    const ENTRIES: &'static [&'static str] = MADE;
    const SUMMARY: &'static str = "results.json";

    fn summary(&self) -> String {
        let mut text = Vec::new();
        // Writing into memory cannot fail.
        let _ = self.write_summary(&mut text);
        String::from_utf8_lossy(&text).into_owned()
    }

    fn write_summary(&self, to: &mut dyn Write) -> io::Result<()> {
        write_json(to, &self.file.study, &self.results, &self.rankings, &self.claims)
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let StudyFile { study, text, base_text, notes, .. } = self.file;
        let refusal = self.refusal();
        let figures = study_figures(study, &self.results, &self.rankings.of_measures);
        let report = || {
            let rankings = &self.rankings.of_measures;
            let refusal = refusal.as_deref();
            let texts: [&str; 2] = [text, base_text];
            Ok(study_report(study, &self.results, rankings, refusal, &self.claims, &figures, texts))
        };
        maker.finish(&self.name, &StudyNote::notes_of_results(notes), &figures, |_| Ok(()), report)
    }
}

/// The files that all points name, with the files that these name.
fn files_of(file: &StudyFile) -> impl Iterator<Item = (&Path, &[PathBuf])> {
    file.study.points.iter().flat_map(|point| match &point.experiment {
        Experiment::Case(case) => case.files(),
        Experiment::Spinline(spec) => spec.files(),
        Experiment::Web(web) => web.files(),
    })
}

/// The texts of the study and of its case or web with the paths of copies.
fn with_files_at(file: &StudyFile, copied: &BTreeMap<PathBuf, PathBuf>) -> [String; 2] {
    // A study has been written with whole paths.
    let folder = file.base_path.parent().unwrap_or(Path::new(""));
    let replaced = |text: String, folder: &Path| {
        copied.iter().fold(text, |text, (from, to)| {
            let quoted = |path: &Path| format!("{:?}", path.to_string_lossy());
            let literal = |path: &Path| format!("'{}'", path.display());
            // A case is the text of its user; a web has been written with whole paths.
            let written = [from, from.strip_prefix(folder).unwrap_or(from)];
            written.into_iter().fold(text, |text, from| {
                text.replace(&quoted(from), &quoted(to)).replace(&literal(from), &quoted(to))
            })
        })
    };
    [replaced(file.text.clone(), Path::new("")), replaced(file.base_text.clone(), folder)]
}

/// Largest number of lost fibres that are listed.
const LOST_LISTED: u64 = 10;

/// A list of the lost fibres, if there are any.
///
/// * `fibres` – number of all
///
/// # Errors
/// If the journal cannot be read.
pub fn lost(study: &Study, journal: &mut Journal, fibres: u64) -> Result<Option<String>, Failure> {
    let (mut lost, mut first) = (0, String::new());
    for (index, point) in study.points.iter().enumerate() {
        for record in journal.records(index, u64::MAX)? {
            if let ReplicateOutcome::Lost { node, time } = record.outcome {
                lost += 1;
                if lost <= LOST_LISTED {
                    let number = index + 1;
                    if let Some(Err(failure)) = point.experiment.spinline().map(SpinSpec::solve) {
                        first.push_str(&format!("\npoint {number}: {}", no_steady_state(&failure)));
                        continue;
                    }
                    let cause = point.experiment.case().map(|case| case.likely_cause_of_divergence());
                    let cause = cause.unwrap_or_default();
                    let replicate = record.replicate + 1;
                    first.push_str(&format!(
                        "\npoint {number}, replicate {replicate}: node {node} at {time:e} s; {cause}"
                    ));
                }
            }
        }
    }
    if lost == 0 {
        return Ok(None);
    }
    let what = match study.noun() {
        "spinline" if lost == 1 => format!("1 of {fibres} spinlines has no steady state"),
        "spinline" => format!("{lost} of {fibres} spinlines have no steady state"),
        _ => lost_fibres_text(lost, fibres),
    };
    Ok(Some(format!("{what}; all others are in the results{first}")))
}

/// Why a spinline has no steady state: `spinline.length = 20 mm is too short…`.
fn no_steady_state(failure: &spinline::Failure) -> String {
    let dimension = keys::find(failure.key).and_then(|key| key.dimension());
    let value =
        failure.value.zip(dimension).map(|(value, dimension)| format!(" = {}", dimension.pretty(value)));
    format!("{}{} {}", failure.key, value.unwrap_or_default(), failure.fault)
}
