//! Reads the results folders of runs.

use super::super::finished::read_summary_of_run;
use crate::Failure;
use crate::figures::{CurvePoint, Curves};
use serde_json::Value as Json;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// The results of a run.
#[derive(Clone, Debug)]
pub(super) struct ComparedRun {
    pub(super) curves: Curves,
    summary: Json,
}

impl ComparedRun {
    pub(super) fn read(folder: &Path, name: String) -> Result<Self, Failure> {
        let summary = read_summary_of_run(folder)?;
        Ok(Self { curves: Curves { name, rows: curves(&folder.join("figures")) }, summary })
    }

    pub(super) fn name(&self) -> &str {
        &self.curves.name
    }

    pub(super) fn replicates(&self) -> u64 {
        self.summary["replicates"].as_u64().unwrap_or(0)
    }

    /// A value by its path in `summary.json`.
    pub(super) fn at(&self, path: &str) -> Option<&Json> {
        self.summary.pointer(path)
    }

    /// The values of the replicates of a measure; NaN where there is none.
    pub(super) fn values(&self, group: &str, column: &str) -> Option<Vec<f64>> {
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
