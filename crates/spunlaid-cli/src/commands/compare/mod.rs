//! `spunlaid compare`: the results of several runs side by side.

mod read;

use super::interrupt::stop_on_ctrl_c;
use crate::args::Compare;
use crate::failure::Failure;
use crate::figures::{MOST_COMPARED, overlaid_figures};
use crate::output::comparison::{self, Compared, Comparison};
use crate::output::folder::Staging;
use crate::output::pictures;
use crate::report::{ComparisonReport, comparison_html};
use crate::say;
use read::Run;
use spunlaid::observe::MEASURES;
use spunlaid::statistics::{Difference, Estimate};
use std::path::{Path, PathBuf};

/// The files of a comparison; the last one marks it as complete.
const FILES: &[&str] = &["figures", "report.html", "comparison.json"];

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

pub(crate) fn compare(compare: &Compare) -> Result<(), Failure> {
    if compare.runs.len() > MOST_COMPARED {
        return Err(Failure::TooManyRuns { runs: compare.runs.len(), most: MOST_COMPARED });
    }
    let names = names(&compare.runs);
    let folder = compare.out.clone().unwrap_or_else(|| PathBuf::from("results").join(joined(&names)));
    let files = (!compare.json || compare.out.is_some())
        .then(|| Staging::new(&folder, FILES, compare.force, stop_on_ctrl_c()))
        .transpose()?;
    let runs = compare.runs.iter().zip(names).map(|(folder, name)| Run::read(folder, name));
    let runs: Vec<Run> = runs.collect::<Result<_, _>>()?;
    let (first, others) = match runs.split_first() {
        Some((first, others)) if !others.is_empty() => (first, others),
        _ => return Ok(()),
    };
    let comparisons: Vec<Comparison> = others.iter().map(|other| compared(first, other)).collect();
    let json = comparison::json(&comparisons);
    if let Some(staging) = files {
        let curves: Vec<_> = runs.iter().map(|run| run.curves.clone()).collect();
        let figures = overlaid_figures(&curves);
        pictures::write(&figures, |name, content| staging.write(&format!("figures/{name}"), content))?;
        let version = env!("CARGO_PKG_VERSION");
        let report =
            comparison_html(&ComparisonReport { comparisons: &comparisons, figures: &figures, version });
        staging.write("report.html", report)?;
        staging.write("comparison.json", &json)?;
        staging.publish()?;
    }
    if compare.json {
        say::text(&json);
    } else if !compare.quiet {
        comparisons.iter().for_each(|of| say::text(&comparison::table(of)));
        say::line(&format!("open {}", folder.join("report.html").display()));
    }
    Ok(())
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
        let of = |run: &Run| run.values(measure.group.name, measure.column);
        let values = [of(first)?, of(other)?];
        let difference = match pairs {
            Some(_) => Difference::paired(&values[0], &values[1]),
            None => Difference::independent(&values[0], &values[1]),
        };
        let finite =
            |values: &Vec<f64>| Estimate::of(values.iter().copied().filter(|v| v.is_finite()).collect());
        let means = [finite(&values[0]), finite(&values[1])];
        means.iter().all(|of| of.mean.is_finite()).then_some(Compared { measure, means, difference })
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
    Comparison { run: other.name().to_owned(), against: first.name().to_owned(), pairs, reason, measures }
}
