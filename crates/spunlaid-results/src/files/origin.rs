//! What results were made from, as it stands in their folder, and what the computation took.

use serde::Serialize;
use spunlaid_ground::Isa;
use spunlaid_web::TimeSpent;
use spunlaid_web::map::Findings;
use std::fs;
use std::path::{Component, Path, PathBuf};
use std::time::{Duration, Instant};

/// The file in a results folder.
pub const ORIGIN: &str = "origin.toml";

/// The command that makes results: its files and its options. The same command may replace what it wrote before.
#[derive(Clone, Debug)]
pub struct Origin {
    text: String,
}

impl Origin {
    /// * `command` – its name, `run`
    /// * `files` – the files or folders that it reads
    /// * `options` – those that decide what the results are
    /// * `folder` – of the results
    pub fn new(command: &str, files: &[&Path], options: &[String], folder: &Path) -> Self {
        let folder = whole(folder);
        let files = files.iter().map(|file| relative(&folder, &whole(file)).to_string_lossy().into_owned());
        let text = format!(
            "# `spunlaid {command}` of these files, seen from this folder, replaces these results when it \
            runs again with the same options.\ncommand = \"{command}\"\nfiles = {:?}\n\
            options = {options:?}\n",
            files.collect::<Vec<_>>()
        );
        Self { text }
    }

    /// The text of the file.
    pub(crate) fn text(&self) -> &str {
        &self.text
    }

    /// Whether the results in a folder were made by this command.
    pub(crate) fn is_of(&self, folder: &Path) -> bool {
        fs::read_to_string(folder.join(ORIGIN)).is_ok_and(|text| text == self.text)
    }
}

/// The whole path of a file or folder, of which the last parts may not exist yet.
fn whole(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let known = path.ancestors().find_map(|above| Some((above.canonicalize().ok()?, above)));
    known.map_or_else(
        || path.clone(),
        |(canonical, above)| canonical.join(path.strip_prefix(above).unwrap_or(Path::new(""))),
    )
}

/// A path as it is seen from a folder. Both are whole.
fn relative(folder: &Path, path: &Path) -> PathBuf {
    let common = folder.components().zip(path.components()).take_while(|(a, b)| a == b).count();
    if common == 0 {
        return path.to_owned();
    }
    let up = folder.components().skip(common).map(|_| Component::ParentDir);
    up.chain(path.components().skip(common)).collect()
}

/// The speed of the work. This is the only part that differs when it is repeated.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Performance {
    /// Wall-clock time [s]; of a run that of the flights.
    pub wall_s: f64,
    /// Number of threads.
    pub threads: usize,
    /// Of a run: number of steps of single elements.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub element_steps: Option<u64>,
    /// Of a run: time that one thread needs for one element and one step of one fibre.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_element_step: Option<f64>,
    /// Name of the instruction set.
    pub instruction_set: &'static str,
    /// Time that the flights of filaments in shared turbulence took [s].
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
        let simulated = Some(&findings.laid.simulated).filter(|simulated| !simulated.is_empty());
        let sum = |of: fn(&TimeSpent) -> Duration| {
            simulated.map(|simulated| {
                simulated.iter().map(|layer| of(&layer.spent)).sum::<Duration>().as_secs_f64()
            })
        };
        Self {
            flights_s: sum(|spent| spent.whole),
            flights_in_parallel_s: sum(|spent| spent.in_parallel),
            ..self
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_seen_from_the_folder() {
        let path = |folder: &str, file: &str| relative(Path::new(folder), Path::new(file));
        assert_eq!(path("/a/results/my", "/a/my.toml"), Path::new("../../my.toml"));
        assert_eq!(path("/a/my", "/a/my/case.toml"), Path::new("case.toml"));
        assert_eq!(path("/a", "/b/c/my.toml"), Path::new("../b/c/my.toml"));
    }

    #[test]
    fn only_the_same_command_files_and_options_are_the_same_origin() {
        let place = tempfile::tempdir().unwrap();
        let folder = place.path().join("results/my");
        let file = place.path().join("my.toml");
        let options = ["--set air.velocity=20 m/s".to_owned()];
        let first = Origin::new("run", &[&file], &options, &folder);
        fs::create_dir_all(&folder).unwrap();
        assert!(!first.is_of(&folder), "an empty folder is of nothing");
        fs::write(folder.join(ORIGIN), first.text()).unwrap();
        // The folder exists now, which changes nothing.
        assert!(Origin::new("run", &[&file], &options, &folder).is_of(&folder));
        let others = [
            Origin::new("web", &[&file], &options, &folder),
            Origin::new("run", &[&place.path().join("other.toml")], &options, &folder),
            Origin::new("run", &[&file], &[], &folder),
        ];
        assert!(others.iter().all(|other| !other.is_of(&folder)));
    }
}
