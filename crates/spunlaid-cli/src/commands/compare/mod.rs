//! `spunlaid compare`: the results of several runs, or of several webs, side by side.

mod maps;
mod read;
mod results;
mod web;
mod webs;

use super::{say_report, staged};
use crate::args::{Compare, Invocation};
use crate::failure::Failure;
use crate::say;
use read::Run;
use results::Results;
use spunlaid::error::Fault;
use spunlaid::observe::MEASURES;
use spunlaid::statistics::{Difference, Estimate};
use spunlaid_results::figures::{MOST_COMPARED, overlaid_figures};
use spunlaid_results::output::comparison::{self, ComparedMeasure, Comparison};
use spunlaid_results::output::origin::ORIGIN;
use spunlaid_results::report::{ComparisonReport, comparison_html};
use std::path::{Path, PathBuf};

/// The files of a comparison; the last one marks it as complete.
const FILES: &[&str] = &[ORIGIN, "figures", "report.html", "comparison.json"];

/// What two runs must have in common for their replicates to fly in the same turbulence: where it stands in
/// `summary.json`.
const OF_TURBULENCE: [&str; 10] = [
    "/case/run/seed",
    "/case/fibre/length_m",
    "/case/air/length_scale_m",
    "/case/air/cutoff_frequency_hz",
    "/case/air/harmonics",
    "/case/air/spectrum",
    "/case/air/eddies",
    "/case/air/decay_time_s",
    "/case/air/record",
    "/elements",
];

pub(crate) fn compare(compare: &Compare, invocation: &Invocation) -> Result<(), Failure> {
    if compare.runs.len() > MOST_COMPARED {
        let message = format!(
            "{} runs are named, and at most {MOST_COMPARED} are compared at a time",
            compare.runs.len()
        );
        return Err(Fault::new(message, "name fewer").into());
    }
    let names = names(&compare.runs);
    let folder = compare.output.folder(joined(&names));
    let files: Vec<&Path> = compare.runs.iter().map(PathBuf::as_path).collect();
    let staging = (!compare.json || compare.output.out.is_some())
        .then(|| {
            let origin = invocation.origin(&files, &folder);
            staged((&folder, FILES), &compare.output, origin, &compare.figures.files())
        })
        .transpose()?;
    let results = match webs::read(&compare.runs, &names)? {
        Some(webs) => webs::compared(&webs)?,
        None => compare_runs(&compare.runs, names)?,
    };
    let Results { comparisons, figures, pictures, notes } = &results;
    let json = comparison::json(comparisons, notes);
    if let Some(staging) = staging {
        staging.write_figures(figures)?;
        let drawn = pictures.iter().flat_map(|webs| &webs.pictures.files);
        for (number, picture) in (1..).zip(drawn) {
            staging.write(&format!("figures/web_picture_{number}.png"), picture)?;
        }
        let report =
            comparison_html(&ComparisonReport { comparisons, figures, pictures: pictures.as_ref(), notes });
        staging.write("report.html", report)?;
        staging.write("comparison.json", &json)?;
        staging.publish()?;
    }
    if compare.json {
        say::text(&json);
    } else if !compare.output.quiet {
        comparisons.iter().for_each(|comparison| say::text(&comparison::table(comparison)));
        notes.iter().for_each(|note| say::remark(false, note));
        say_report(&folder);
    }
    Ok(())
}

/// Every run against the first, and their curves in one picture each.
fn compare_runs(folders: &[PathBuf], names: Vec<String>) -> Result<Results, Failure> {
    let runs = folders.iter().zip(names).map(|(folder, name)| Run::read(folder, name));
    let runs: Vec<Run> = runs.collect::<Result<_, _>>()?;
    let comparisons = runs.iter().skip(1).map(|other| compared(&runs[0], other)).collect();
    let curves: Vec<_> = runs.into_iter().map(|run| run.curves).collect();
    Ok(Results { comparisons, figures: overlaid_figures(&curves), pictures: None, notes: Vec::new() })
}

/// The names of the folders; the whole paths where two names are equal.
fn names(folders: &[PathBuf]) -> Vec<String> {
    let name = |path: &Path| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let short: Vec<String> =
        folders.iter().map(|path| name(path).unwrap_or_else(|| path.display().to_string())).collect();
    let is_once = |one: &String| short.iter().filter(|other| *other == one).count() == 1;
    if short.iter().all(is_once) {
        short
    } else {
        folders.iter().map(|path| path.display().to_string()).collect()
    }
}

/// Name of the results folder: `a_against_b`.
fn joined(names: &[String]) -> String {
    let plain = |c: char| if matches!(c, '/' | '\\') { '_' } else { c };
    names.join("_against_").chars().map(plain).collect()
}

fn compared(first: &Run, other: &Run) -> Comparison {
    let differs = OF_TURBULENCE.iter().find(|path| first.at(path) != other.at(path));
    let pairs = differs.is_none().then(|| first.replicates().min(other.replicates()) as usize);
    let measure = |measure: &&'static spunlaid::observe::Measure| {
        let values_of_run = |run: &Run| run.values(measure.group.name, measure.column);
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
            unit: measure.unit.shown,
            per_si: measure.unit.per_si,
            means,
            difference,
            doubt: None,
        })
    };
    let reason = match (pairs, differs) {
        (Some(pairs), _) => format!(
            "paired by replicate, because both have the same seed and the same eddies ({pairs} pairs)"
        ),
        (None, Some(path)) => {
            let key = path.trim_start_matches("/case/").trim_start_matches('/').replace('/', ".");
            format!("as independent samples, because {key} differs (Welch’s t)")
        }
        (None, None) => "as independent samples (Welch’s t)".to_owned(),
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
    }
}
