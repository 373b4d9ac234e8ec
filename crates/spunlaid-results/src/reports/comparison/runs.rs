//! Runs side by side: their folders, the means of their measures, and their curves.

use super::Found;
use super::figures::{CurvePoint, Curves, overlaid_figures};
use super::files::{ComparedMeasure, Comparison};
use crate::Failure;
use crate::reports::finished::read_summary_of_run;
use serde_json::Value as Json;
use spunlaid_ground::{Difference, Estimate};
use spunlaid_simulation::{FibreMeasure, MEASURES};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// Every run against the first, and their curves in one picture each.
pub(super) fn compared(folders: &[PathBuf], names: Vec<String>) -> Result<Found, Failure> {
    let runs = folders.iter().zip(names).map(|(folder, name)| ComparedRun::read(folder, name));
    let runs: Vec<ComparedRun> = runs.collect::<Result<_, _>>()?;
    let comparisons = runs.iter().skip(1).map(|other| compare_with(&runs[0], other)).collect();
    let curves: Vec<_> = runs.into_iter().map(|run| run.curves).collect();
    Ok(Found { comparisons, figures: overlaid_figures(&curves), pictures: None, notes: Vec::new() })
}

fn compare_with(first: &ComparedRun, other: &ComparedRun) -> Comparison {
    let differs = first.turbulence_mismatch(other);
    let pairs = differs.is_none().then(|| first.replicates().min(other.replicates()) as usize);
    let measure = |measure: &&'static FibreMeasure| {
        let values_of_run = |run: &ComparedRun| run.values(measure.group.name, measure.column);
        let values = [values_of_run(first)?, values_of_run(other)?];
        let difference = match pairs {
            Some(_) => Difference::paired(&values[0], &values[1]),
            None => Difference::independent(&values[0], &values[1]),
        };
        let finite =
            |values: &Vec<f64>| Estimate::new(values.iter().copied().filter(|v| v.is_finite()).collect());
        let means = [finite(&values[0]), finite(&values[1])];
        means.iter().all(|values_of_run| values_of_run.mean.is_finite()).then(|| ComparedMeasure {
            label: measure.label.to_owned(),
            column: measure.column.to_owned(),
            unit: measure.unit,
            means,
            difference,
            remark: None,
            doubt: None,
        })
    };
    let reason = match (pairs, differs) {
        (Some(pairs), _) => format!(
            "paired by replicate, because both have the same seed and the same eddies ({pairs} pairs)"
        ),
        (None, what) => format!(
            "as independent samples, because the turbulence differs in {} (Welch’s t)",
            what.unwrap_or_default()
        ),
    };
    let measures = MEASURES.iter().filter_map(measure).collect();
    let errors = "Mean ± one standard error of the mean over the replicates.";
    Comparison {
        run: other.name().to_owned(),
        against: first.name().to_owned(),
        pairs,
        reason,
        errors,
        measures,
        causes: Vec::new(),
    }
}

/// The results of a run.
#[derive(Clone, Debug)]
struct ComparedRun {
    curves: Curves,
    summary: Json,
}

impl ComparedRun {
    fn read(folder: &Path, name: String) -> Result<Self, Failure> {
        let summary = read_summary_of_run(folder)?;
        Ok(Self { curves: Curves { name, rows: curves(&folder.join("figures")) }, summary })
    }

    fn name(&self) -> &str {
        &self.curves.name
    }

    fn replicates(&self) -> u64 {
        self.summary["replicates"].as_u64().unwrap_or(0)
    }

    /// In words, the first thing in which its turbulence differs from that of another run.
    fn turbulence_mismatch<'a>(&'a self, other: &'a Self) -> Option<&'a str> {
        let parts = |run: &'a Self| run.summary["turbulence"].as_object();
        let (Some(own), Some(others)) = (parts(self), parts(other)) else {
            return Some("something that an older folder does not record");
        };
        let differs = |what: &&String| own.get(*what) != others.get(*what);
        own.keys().chain(others.keys()).find(differs).map(String::as_str)
    }

    /// The values of the replicates of a measure; NaN where there is none.
    fn values(&self, group: &str, column: &str) -> Option<Vec<f64>> {
        // A group within another one: `laydown.surrogate`.
        let group = group.split('.').try_fold(&self.summary, |outer, inner| outer.get(inner))?;
        let values = group[column]["values"].as_array()?;
        Some(values.iter().map(|value| value.as_f64().unwrap_or(f64::NAN)).collect())
    }
}

/// The curves of the figures, as far as they can be read: a figure that is not there is not compared.
fn curves(folder: &Path) -> BTreeMap<String, Vec<CurvePoint>> {
    let files = fs::read_dir(folder).into_iter().flatten().filter_map(|entry| Some(entry.ok()?.path()));
    let table = |path: PathBuf| {
        let name = path.file_stem()?.to_str()?.to_owned();
        (path.extension()? == "csv").then(|| Some((name, rows(&path)?)))?
    };
    files.filter_map(table).collect()
}

/// The rows of a table of numbers beside a figure: series, place, value and, if there is one, the error.
fn rows(path: &Path) -> Option<Vec<CurvePoint>> {
    let mut reader = csv::Reader::from_path(path).ok()?;
    let error = reader.headers().ok()?.iter().position(|head| head == "error");
    let row = |record: csv::StringRecord| {
        let number = |column: usize| record.get(column)?.parse::<f64>().ok();
        Some(CurvePoint {
            series: record.get(0)?.to_owned(),
            at: number(1)?,
            value: number(2).unwrap_or(f64::NAN),
            error: error.and_then(number),
        })
    };
    reader.records().map(|record| record.ok().and_then(row)).collect()
}
