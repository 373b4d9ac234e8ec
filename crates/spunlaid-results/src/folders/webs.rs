//! The folder of a study of webs: its journal, and what is made from it.

use crate::Failure;
use crate::failure::{holds_results, not_a_folder};
use crate::figures::figures_of_webs;
use crate::output::folder::Staging;
use crate::output::{leftovers, pictures, webs};
use crate::report::{WebStudyReport, webs_html};
use crate::webs::{PointOfWebs, WebJournal, results};
use spunlaid::input::{StudyNote, WebStudyFile, differences};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

const JOURNAL: &str = "webs.jsonl";
/// Files that are made from the journal, and those that describe the study.
const MADE: &[&str] = &["results.csv", "results.json", "study.toml", "web.toml", "figures", "report.html"];
/// Files of other results.
const OF_OTHERS: &[&str] = &["summary.json", "journal", "analysis.json"];

/// A results folder that this process has locked.
#[derive(Debug)]
pub struct WebStudyFolder<'a> {
    path: PathBuf,
    /// If this is set, nothing more is written.
    stop: &'a AtomicBool,
}

impl<'a> WebStudyFolder<'a> {
    /// Opens the folder to begin a study, or to continue the same study.
    ///
    /// * `force` – what the folder holds is replaced
    /// * `stop` – if this is set, nothing more is written
    ///
    /// # Errors
    /// If it cannot be written, or holds something else.
    pub fn open(
        path: &Path,
        file: &WebStudyFile,
        force: bool,
        stop: &'a AtomicBool,
    ) -> Result<(Self, WebJournal), Failure> {
        if path.exists() && !path.is_dir() {
            return Err(not_a_folder(path));
        }
        let journal = path.join(JOURNAL);
        let others: &[&[&str]] = if journal.exists() { &[OF_OTHERS] } else { &[OF_OTHERS, MADE] };
        let found = others.iter().copied().flatten().find(|name| path.join(name).exists());
        if let Some(found) = found.filter(|_| !force) {
            return Err(holds_results(path, found));
        }
        fs::create_dir_all(path).map_err(Failure::unwritable(path))?;
        let journal = WebJournal::open(&journal, &file.study, force, || differ(path, file))?;
        leftovers::remove_unclaimed(path);
        Ok((Self { path: path.to_owned(), stop }, journal))
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Makes the tables, the figures and the report from the journal.
    ///
    /// * `name` – what the study is called
    ///
    /// # Errors
    /// If a file cannot be written.
    pub fn write(
        &self,
        name: &str,
        file: &WebStudyFile,
        journal: &WebJournal,
    ) -> Result<Vec<PointOfWebs>, Failure> {
        let staging = Staging::new(&self.path, MADE, true, self.stop)?;
        let results = results(&file.study, journal);
        webs::write(&staging, &file.study, &results)?;
        let figures = figures_of_webs(&file.study, &results);
        pictures::write(&figures, |name, content| staging.write(&format!("figures/{name}"), content))?;
        let notes = StudyNote::of_results(&file.notes);
        let report = WebStudyReport { name, file, results: &results, figures: &figures, notes: &notes };
        staging.write("report.html", webs_html(&report))?;
        staging.write("study.toml", &file.text)?;
        staging.write("web.toml", &file.web_text)?;
        staging.publish()?;
        Ok(results)
    }
}

/// How the study in a folder differs, a line for each key.
fn differ(folder: &Path, file: &WebStudyFile) -> Vec<String> {
    let of = |(name, now): (&str, &String)| {
        let was = fs::read_to_string(folder.join(name)).unwrap_or_default();
        differences(&was, now).into_iter().map(move |line| format!("{name}: {line}")).collect::<Vec<_>>()
    };
    [("study.toml", &file.text), ("web.toml", &file.web_text)].into_iter().flat_map(of).collect()
}
