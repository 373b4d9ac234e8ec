//! The report of a run: the moving fibre, the results, the figures, and how far the computation can be trusted.

pub(crate) mod frames;
mod table;
#[cfg(test)]
mod tests;
mod words;

use super::finer::CheckWords;
use super::{doubt, finer};
use crate::Failure;
use crate::files::origin::Performance;
use crate::numbers::{THIN, capitalised, number};
use crate::page::document::{Part, Report, Section};
use crate::page::methods::{methods, of_case};
use crate::page::words::{cost, count};
use crate::reports::load::{load_of_spinline, section_of_loads};
use crate::reports::spinline::files::SpinResults;
use crate::reports::spinline::report::section_of_fibre;
use spunlaid_charts::Figure;
use spunlaid_fibre::Case;
use spunlaid_ground::MeasureKind;
use spunlaid_simulation::{DECLARED, FinerChecks, Number, Results};
use table::{Whole, replicate_table, result_table};
use words::{case as words_of_case, headline, mesh};

/// A run. The page has less than 6 MB.
///
/// * `toml` – the resolved case as a case file
/// * `results` – with the trajectories that are to be seen moving
/// * `checks` – what finer steps and elements change
/// * `figures` – see [`super::figures::run_figures`]
/// * `spinline` – from which the fibre is fed, with its figures
///
/// # Errors
/// The file of the shapes cannot be read.
pub fn run_report<'a>(
    case: &Case,
    toml: &str,
    results: &Results,
    checks: &FinerChecks,
    figures: &'a [Figure],
    spinline: Option<(&SpinResults, &'a [Figure])>,
    performance: Performance,
) -> Result<Report<'a>, Failure> {
    let headline = headline(case, results, checks);
    let finer = finer::words(checks, case, results);
    let whole = |one: &Number| {
        let name = one.measure.name;
        let why_unknown = doubt::why_unknown(name, checks);
        (doubt::with_error_of_checks(one.estimate.clone(), name, checks), why_unknown)
    };
    let methods = methods("run", of_case(case), "case.toml of the results");
    let load = load_of_spinline(case, &results.way());
    let loads: Vec<_> = load.iter().map(|load| (None, load)).collect();
    let file = Section::new("case", "The case")
        .paragraph(
            "With every default filled in. Save it as a case file and run it again: it gives the same numbers, to \
            the last digit.",
        )
        .file("case-toml", toml);
    Ok(Report::new("run", headline)
        .lead(words_of_case(case))
        .with(motion(case, results)?)
        .with(numbers(results, &whole, checks.all().next().is_some()).printed())
        .with_all(spinline.map(|(results, figures)| section_of_fibre(case, results, figures)))
        .with_all(section_of_loads(&loads))
        .with(under_headings(figures))
        .with(trust(finer).printed())
        .with(energy(case, results))
        .with(methods)
        .with(file)
        .costing(cost(performance)))
}

/// The moving fibre.
fn motion(case: &Case, results: &Results) -> Result<Section<'static>, Failure> {
    let section = Section::new("motion", "The moving fibre");
    let Some(frames) = frames::pack(case, results)? else {
        return Ok(section.paragraph("No shapes of the fibre were kept in this run."));
    };
    let axes = if case.line.is_some() {
        "x runs from the inlet down to the belt, y in machine direction (MD), z in cross direction (CD)"
    } else {
        "x runs along the mean flow and gravity, y and z across"
    };
    let remarks: String = frames.remarks.iter().map(|remark| format!(" {remark}")).collect();
    let caption = format!(
        "{axes}; all axes in millimetres. The sideways scale (y and z) may be stretched against the length to make \
        the motion visible; the picture gives the factor.{remarks}"
    );
    Ok(section.view(frames.view()).caption(caption))
}

/// The results, and those of each replicate.
///
/// * `is_checked` – whether the errors contain what a check found
fn numbers(results: &Results, whole: &Whole<'_>, is_checked: bool) -> Section<'static> {
    let n = results.replicates() as u64;
    let (about, caption) = if n > 1 {
        let caption = "Replicates are fibres that differ in nothing but the random phases of the turbulence. \
            About two times in three the true mean lies within one standard error.";
        let contained =
            if is_checked { ", with the results of the checks of time step and mesh" } else { "" };
        let replicates = count(n, "replicate");
        (format!("Mean ± one standard error of the mean over {replicates}{contained}."), caption)
    } else {
        let about = "From a single replicate, so without a standard error; run more replicates to get one.";
        (about.to_owned(), "")
    };
    let (table, unlisted) = replicate_table(results);
    let mut of_each = vec![Part::Table(table)];
    if unlisted > 0 {
        of_each.push(Part::Caption(format!("{unlisted} more are in summary.json.")));
    }
    Section::new("results", "Results")
        .paragraph(about)
        .table(result_table(results, whole))
        .caption(caption)
        .with(Part::Folded("Values of each replicate", of_each))
}

/// How far the computation can be trusted: what finer steps and elements change.
fn trust(checks: [Result<CheckWords, String>; 2]) -> Section<'static> {
    checks.into_iter().fold(Section::new("trust", "Can the computation be trusted?"), |section, check| {
        match check {
            Ok((name, all)) => section.heading(name).with(Part::List(all)),
            Err(why) => section.paragraph(format!("{}. So the error is not known.", capitalised(&why))),
        }
    })
}

/// Whether the mesh is as long as an eddy, and whether energy is kept.
fn energy(case: &Case, results: &Results) -> Section<'static> {
    let work_error = results.number("work_error");
    let balance = number(results.number("balance_error").map_or(f64::NAN, Number::value));
    let carried = if case.line.is_some() {
        " of feed and belt, and what the fed fibre brings and the laid fibre takes along,"
    } else {
        ""
    };
    let scheme = if work_error.is_none() { " and the scheme" } else { "" };
    let balance = (
        format!("Energy balance: {balance}{THIN}%"),
        format!(
            "Kinetic and elastic energy must equal the work of gravity and air,{carried} minus what damping{scheme} \
            took out. This is the difference, relative to the work of the air. It also finds errors in the forces. \
            If it is above one per cent, halve `run.time_step` and see whether the results change."
        ),
    );
    let work = work_error.map(|error| {
        let name = format!("Work check: {}{THIN}%", number(error.value()));
        let meaning = "The work of all forces must equal the kinetic energy. This is the difference, relative to \
            the kinetic energy. It grows with the time step, and does not check the forces.";
        (name, meaning.to_owned())
    });
    let all = mesh(case).into_iter().chain([balance]).chain(work);
    Section::new("energy", "Mesh and energy").descriptions(all).caption(
        "The energy errors are medians over time and replicates. These checks show how well the equations were \
        solved, not how well they describe a fibre.",
    )
}

/// The figures under headings, in the order of the headings.
fn under_headings(figures: &[Figure]) -> Section<'_> {
    const HEADINGS: [&str; 6] = [
        "The laid fibre",
        "From the inlet to the belt",
        "Motion of the free end",
        "Along the fibre",
        "Over time",
        "Air",
    ];
    let kind = |figure: &Figure| {
        let mut measures = DECLARED.iter().flat_map(|declaration| declaration.measures);
        measures.find(|measure| measure.figure.name == figure.name).map(|measure| measure.kind)
    };
    let heading = |figure: &Figure| match kind(figure) {
        Some(MeasureKind::Lag | MeasureKind::Direction) => HEADINGS[0],
        None if ["laid_trace", "footprint"].contains(&figure.name.as_str()) => HEADINGS[0],
        Some(MeasureKind::Way) => HEADINGS[1],
        Some(MeasureKind::Number | MeasureKind::Spectrum) => HEADINGS[2],
        Some(MeasureKind::Profile) => HEADINGS[3],
        Some(MeasureKind::Series) => HEADINGS[4],
        None if figure.name.starts_with("end_node") => HEADINGS[2],
        None => HEADINGS[5],
    };
    HEADINGS.into_iter().fold(Section::new("figures", "Figures"), |section, title| {
        let below: Vec<&Figure> = figures.iter().filter(|figure| heading(figure) == title).collect();
        if below.is_empty() { section } else { section.figures_below(title, below) }
    })
}
