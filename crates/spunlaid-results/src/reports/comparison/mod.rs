//! The results of several runs, or of several webs, side by side.

mod fabric;
mod figures;
mod files;
mod maps;
mod report;
mod runs;
mod streaks;
mod web;
mod webs;

use crate::Failure;
use crate::figures::COLOURS;
use crate::files::folder::Staging;
use crate::files::origin::ORIGIN;
use crate::folders::{Contents, Maker, Page};
use files::Comparison;
use maps::ComparedPictures;
use report::comparison_report;
use spunlaid_charts::Figure;
use spunlaid_ground::Fault;
use std::path::{Path, PathBuf};

/// Most results in one picture.
const MOST: usize = COLOURS.len();

/// Folders that are to be compared.
#[derive(Clone, Copy, Debug)]
pub struct Folders<'a> {
    folders: &'a [PathBuf],
}

impl<'a> Folders<'a> {
    /// # Errors
    /// If there are fewer than two, or more than can be distinguished from one another in a figure.
    pub fn new(folders: &'a [PathBuf]) -> Result<Self, Failure> {
        let count = folders.len();
        if count < 2 {
            return Err(
                Fault::new(format!("{count} folders are named"), "name two or more to compare").into()
            );
        }
        if count > MOST {
            let message = format!("{count} runs are named, and at most {MOST} are compared at a time");
            return Err(Fault::new(message, "name fewer").into());
        }
        Ok(Self { folders })
    }

    /// Their names; the whole paths where two names are equal.
    fn names(self) -> Vec<String> {
        let name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
        let whole = |path: &PathBuf| path.display().to_string();
        let short: Vec<String> =
            self.folders.iter().map(|path| name(path).unwrap_or_else(|| whole(path))).collect();
        let is_once = |one: &String| short.iter().filter(|other| *other == one).count() == 1;
        if short.iter().all(is_once) { short } else { self.folders.iter().map(whole).collect() }
    }

    /// Name of the results folder: `a_against_b`.
    pub fn joined(self) -> String {
        let plain = |c: char| if matches!(c, '/' | '\\') { '_' } else { c };
        self.names().join("_against_").chars().map(plain).collect()
    }

    /// Reads the folders, and compares every one with the first.
    ///
    /// # Errors
    /// If a folder cannot be read, or not all hold runs, or webs with patches of the same size.
    pub fn compare(self) -> Result<ComparedFolders, Failure> {
        let names = self.names();
        let found = match webs::read(self.folders, &names)? {
            Some(webs) => webs::compared(&webs)?,
            None => runs::compared(self.folders, names)?,
        };
        Ok(ComparedFolders { found })
    }
}

/// Comparisons with their figures.
#[derive(Debug)]
struct Found {
    comparisons: Vec<Comparison>,
    figures: Vec<Figure>,
    /// Of webs.
    pictures: Option<ComparedPictures>,
    /// What is missing, and why.
    notes: Vec<String>,
}

/// What a comparison of folders has found.
#[derive(Debug)]
pub struct ComparedFolders {
    found: Found,
}

impl Contents for ComparedFolders {
    const ENTRIES: &'static [&'static str] = &[ORIGIN, "figures", "report.html", Self::SUMMARY];
    const SUMMARY: &'static str = "comparison.json";

    fn summary(&self) -> String {
        files::summary(&self.found.comparisons, &self.found.notes)
    }

    fn found(&self) -> &[String] {
        &self.found.notes
    }

    fn make(&self, maker: &Maker<'_>) -> Result<Page, Failure> {
        let Found { comparisons, figures, pictures, notes } = &self.found;
        let files = |staging: &Staging<'_>| {
            let drawn = pictures.iter().flat_map(|webs| &webs.pictures.files);
            (1..).zip(drawn).try_for_each(|(number, picture)| {
                staging.write(&format!("figures/web_picture_{number}.png"), picture)
            })
        };
        let report = || Ok(comparison_report(comparisons, figures, pictures.as_ref()));
        maker.finish("", notes, figures, files, report)
    }
}
