//! What the checks of a run say against its numbers: in its notes, in its headline, and in the errors that
//! the headline states.

use crate::numbers::plus_minus;
use spunlaid::fibre::{Case, Checks};
use spunlaid::ground::{Dimension, Estimate};
use spunlaid::simulation::{Change, FinerCheck, FinerChecks, Refinement, Unchecked};

/// Error of step or mesh that is small enough [-].
pub(super) const FINE_ENOUGH: f64 = 0.03;
/// Standard errors on each side of a difference within which the true one very likely is.
pub(super) const SURE: f64 = 2.0;

/// Changes of a check that are surely beyond what is small enough.
pub(super) fn beyond(check: &FinerCheck) -> impl Iterator<Item = &Change> {
    counted(check).filter(|change| least(check, change) > FINE_ENOUGH)
}

/// Changes that count. The texture of a laid fibre is that of its elements, and is reported as such.
pub(super) fn counted(check: &FinerCheck) -> impl Iterator<Item = &Change> {
    check.changes.iter().filter(|change| change.statistic.name != "chord_over_arc")
}

/// The smallest error that a change stands for, with what is known of chance.
fn least(check: &FinerCheck, change: &Change) -> f64 {
    let least = |of: Estimate| of.mean.abs() - SURE * of.standard_error.unwrap_or(f64::INFINITY);
    errors(check, change).into_iter().map(least).fold(f64::NEG_INFINITY, f64::max)
}

/// The error of a statistic, where the order of convergence is known; else what the finer flights change, which is the
/// least that can be told.
pub(super) fn errors(check: &FinerCheck, change: &Change) -> Vec<Estimate> {
    let times = |estimate: &Estimate, factor: f64| Estimate {
        mean: factor * estimate.mean,
        standard_error: estimate.standard_error.map(|error| factor * error),
        values: Vec::new(),
    };
    match check.error_over(change) {
        Some(factor) => vec![times(&change.estimate, factor)],
        None => change.estimates().map(|estimate| times(estimate, 1.0)).collect(),
    }
}

/// What a check tells of the error of a statistic: `frequency is off by +25 ± 2 %`, or what differs where its order is
/// not known.
pub(super) fn told(check: &FinerCheck, change: &Change, case: &Case) -> String {
    let (label, errors) = (change.statistic.label.to_lowercase(), errors(check, change));
    let at = |i: usize| errors.get(i).map(percent).unwrap_or_default();
    let is_limit = check.refined == Refinement::TimeStep && check.is_resolved;
    let most = if check.refined == Refinement::TimeStep && !check.is_resolved { "at most " } else { "" };
    let with = compared_with(check, case);
    match (check.error_over(change), &change.from_quarter) {
        (Some(_), _) if !is_limit => format!("{label} is off by {most}{}", at(0)),
        (None, Some((length, _))) => format!(
            "{label} differs by {} from {with} and by {} from those of {}",
            at(0),
            at(1),
            Dimension::Length.pretty_to(*length, 3)
        ),
        _ => format!("{label} differs by {} from {}", at(0), with.trim_end_matches(',')),
    }
}

/// All that a check tells beyond its limit, with words before each and between them; none if there is nothing.
fn all_told(check: &FinerCheck, case: &Case, [before, between]: [&str; 2]) -> Option<String> {
    let each: Vec<String> =
        beyond(check).map(|change| format!("{before}{}", told(check, change, case))).collect();
    let is_open = |change: &Change| check.error_over(change).is_none() && change.from_quarter.is_some();
    let end = match beyond(check).any(is_open) {
        true => ", which does not show how far this is from very fine elements",
        false => "",
    };
    (!each.is_empty()).then(|| format!("{}{}{end}", part(check, case), each.join(between)))
}

/// With what a run is compared: `half the step`.
pub(super) fn compared_with(check: &FinerCheck, case: &Case) -> String {
    match check.refined {
        Refinement::TimeStep => shorter(check, case),
        Refinement::Elements => {
            let length = Dimension::Length.pretty_to(check.element_length, 3);
            format!("elements of {length}, half the length,")
        }
    }
}

/// A share in per cent.
pub(super) fn percent(estimate: &Estimate) -> String {
    format!("{} %", plus_minus(100.0 * estimate.mean, estimate.standard_error.map(|error| 100.0 * error)))
}

/// With what a step is compared.
fn shorter(check: &FinerCheck, case: &Case) -> String {
    let step = Dimension::Time.pretty_to(check.time_step, 3);
    match check.is_resolved {
        true if check.scheme == case.run.scheme => format!("steps of {step}, which resolve axial waves,"),
        true => format!("{} at {step}, which resolves axial waves,", check.scheme.name()),
        false => "half the step".to_owned(),
    }
}

/// `in the first 36 ms of 250 ms: `, of a check over a part of a run that may differ from the whole.
fn part(check: &FinerCheck, case: &Case) -> String {
    let time = |seconds| Dimension::Time.pretty_to(seconds, 3);
    let (some, all) = (time(check.duration), time(case.run.duration()));
    if check.is_of_a_part(&case.run) { format!("in the first {some} of {all}: ") } else { String::new() }
}

/// Notes about checks that are beyond their limit, and about those that could not be made.
pub fn notes(checks: &FinerChecks, case: &Case) -> Vec<String> {
    let found = |check: &FinerCheck| {
        let (name, limit, kept) = (check.refined.name(), 100.0 * FINE_ENOUGH, kept(check, case));
        let told = all_told(check, case, ["", ", "])?;
        Some(format!("the check of the {name} is beyond its limit of {limit} %: {told}; {kept}"))
    };
    let each = [(&checks.step, Refinement::TimeStep), (&checks.mesh, Refinement::Elements)];
    each.into_iter()
        .filter_map(|(check, refined)| match check {
            Ok(check) => found(check),
            Err(why) => why.leaves_doubt().then(|| unchecked(refined, why)),
        })
        .collect()
}

/// Whether the errors of the results contain what a check found.
fn kept(check: &FinerCheck, case: &Case) -> &'static str {
    match (check.is_of_a_part(&case.run), case.run.replicates) {
        (true, _) => "the errors do not contain this",
        (false, 1) => "a single replicate has no error that could contain this",
        (false, _) => "the errors contain this",
    }
}

/// That a check was not made, and why.
pub(super) fn unchecked(refined: Refinement, why: &Unchecked) -> String {
    format!("{}: not checked: {why}", refined.name())
}

/// An estimate of a run with its whole error: by chance, and what the checks found beyond their limit. Those over a
/// part of the run are told in words alone. What chance does to a single replicate is not known, nor is its error.
pub fn with_error_of_checks(
    estimate: Estimate,
    measure: &str,
    checks: &FinerChecks,
    case: &Case,
) -> Estimate {
    let of_checks: f64 = checks
        .all()
        .filter(|check| !check.is_of_a_part(&case.run))
        .flat_map(|check| {
            let own = beyond(check).filter(|change| change.statistic.measures.contains(&measure));
            own.map(|change| {
                // From the value of the limit, or of the finer flight, to that of the run.
                let off = |error: &Estimate| {
                    let error = error.mean.max(-0.95);
                    (estimate.mean * error / (1.0 + error)).abs()
                };
                errors(check, change).iter().map(off).fold(0.0, f64::max).powi(2)
            })
        })
        .sum();
    let standard_error = estimate.standard_error.map(|chance| chance.hypot(of_checks.sqrt()));
    Estimate { standard_error, ..estimate }
}

/// The measures whose whole errors have more in them than chance, as the labels of their statistics.
pub fn statistics_in_errors(checks: &FinerChecks, case: &Case) -> Vec<&'static str> {
    let whole = checks.all().filter(|check| !check.is_of_a_part(&case.run));
    let mut labels: Vec<_> = whole.flat_map(beyond).map(|change| change.statistic.label).collect();
    labels.dedup();
    labels
}

/// What the headline has to say about the checks, as whole sentences; empty if they are within their limits.
pub fn sentences(checks: &FinerChecks, case: &Case) -> String {
    let mut text = String::new();
    for check in checks.all() {
        let kept = match (check.is_of_a_part(&case.run), case.run.replicates) {
            (false, 2..) => "The error contains what",
            _ => "No error above contains what",
        };
        if let Some(told) = all_told(check, case, ["the ", "; "]) {
            text += &format!(" {kept} the check of the {} found: {told}.", check.refined.name());
        }
    }
    let why = if case.run.checks == Checks::None { ", as the case asks" } else { "" };
    match (&checks.step, &checks.mesh) {
        (Err(Unchecked::Pending), _) | (_, Err(Unchecked::Pending)) => {
            text += " Time step and mesh are not checked yet.";
        }
        (Err(_), Err(_)) => text += &format!(" Time step and mesh are not checked{why}."),
        (Err(_), Ok(_)) => text += " The time step is not checked.",
        (Ok(_), Err(_)) => text += " The mesh is not checked.",
        (Ok(_), Ok(_)) => {}
    }
    text
}

#[cfg(test)]
#[allow(clippy::unwrap_used)]
mod tests {
    use super::super::sample;
    use super::*;
    use spunlaid::fibre::chain::Scheme;
    use spunlaid::simulation::Statistic;

    fn checks(mean: f64, standard_error: f64, duration: f64) -> FinerChecks {
        let statistic = Statistic::all().find(|statistic| statistic.name == "spread").unwrap();
        let estimate = Estimate { mean, standard_error: Some(standard_error), values: vec![mean; 8] };
        let step = FinerCheck {
            refined: Refinement::TimeStep,
            scheme: Scheme::Leapfrog,
            time_step: 1e-6,
            element_length: 2e-3,
            is_fed: true,
            is_resolved: true,
            duration,
            replicates: 8,
            share_of_run: 0.1,
            path: None,
            changes: vec![Change::new(statistic, estimate)],
        };
        FinerChecks { step: Ok(step), mesh: Err(Unchecked::Dear { times: 12.0 }) }
    }

    #[test]
    fn what_is_beyond_its_limit_is_in_error_headline_and_notes() {
        let case = sample::fed_case(100, 2);
        let run = case.run.duration();
        let width = || Estimate { mean: 2.778, standard_error: Some(0.026), values: Vec::new() };
        let error = |checks: &FinerChecks| {
            with_error_of_checks(width(), "sigma_md", checks, &case).standard_error.unwrap()
        };
        // The run has 0.34 of the true spread, which is 2.778/0.34.
        let whole = checks(-0.66, 0.02, run);
        assert!((error(&whole) - (2.778 / 0.34 - 2.778)).abs() < 1e-3, "{}", error(&whole));
        assert!(
            sentences(&whole, &case).starts_with(" The error contains what the check of the time step found")
        );
        assert!(notes(&whole, &case)[0].contains("spread differs by −66"), "{:?}", notes(&whole, &case));
        assert!(notes(&whole, &case)[1].starts_with("mesh: not checked: it would take 12 times"));
        // A part of a fed fibre's run is told as one.
        let part = checks(1.17, 0.05, 0.1 * run);
        assert_eq!(error(&part), 0.026);
        assert!(sentences(&part, &case).starts_with(" No error above contains"));
        assert!(notes(&part, &case)[0].contains("in the first "));
        // What chance alone may be is within the limit.
        let within = checks(-0.05, 0.02, run);
        assert_eq!((error(&within), notes(&within, &case).len()), (0.026, 1));
        assert_eq!(sentences(&within, &case), " The mesh is not checked.");
    }
}
