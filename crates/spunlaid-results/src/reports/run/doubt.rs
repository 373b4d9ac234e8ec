//! What the checks of a run say against its numbers: in its notes, in its headline, and in the errors that
//! the headline states.

use crate::numbers::{capitalised, plus_minus, significant};
use spunlaid_fibre::{Case, Checks};
use spunlaid_ground::{Dimension, Estimate};
use spunlaid_simulation::{Change, FinerCheck, FinerChecks, Refinement, Silence, Unchecked};

/// Error of step or mesh that is small enough [-].
pub(super) const FINE_ENOUGH: f64 = 0.03;
/// Standard errors on each side of a difference within which the true one very likely is.
pub(super) const SURE: f64 = 2.0;

/// Change of unknown order from which on a number has not converged with the mesh [-]: it has no error then, because
/// its distance from that of very fine elements is not known.
const NOT_CONVERGED: f64 = 0.1;

/// Changes of a check that are surely beyond what is small enough, and whether the errors contain them.
pub(super) fn beyond(check: &FinerCheck, contained: bool) -> impl Iterator<Item = &Change> {
    let wanted = move |change: &&Change| has_converged(check, change) == contained;
    counted(check).filter(|change| least(check, change) > FINE_ENOUGH).filter(wanted)
}

/// Whether an error can contain what a change stands for.
fn has_converged(check: &FinerCheck, change: &Change) -> bool {
    check.error_over(change).is_some() || least(check, change) <= NOT_CONVERGED
}

/// How far a number is from that of the finest elements with which it was compared.
pub(super) struct FromFinest {
    /// Their length [m].
    pub length: f64,
    /// The difference as a fraction, of the number or of its size.
    pub difference: f64,
    /// Root mean square of a number of both signs, in its unit; none of another one.
    pub size: Option<f64>,
}

impl FromFinest {
    /// `44 % lower than with elements of 12.5 mm`.
    fn describe(&self) -> String {
        format!(
            "{} %{} {} than with elements of {}",
            significant(100.0 * self.difference.abs(), 2),
            if self.size.is_some() { " of its root mean square" } else { "" },
            if self.difference < 0.0 { "lower" } else { "higher" },
            Dimension::Length.pretty_to(self.length, 3)
        )
    }
}

/// The change of a measure that has not converged with the mesh.
pub(super) fn not_converged(measure: &str, checks: &FinerChecks) -> Option<FromFinest> {
    let check = checks.mesh.as_ref().ok()?;
    let of_statistic = check.change_of_statistic(measure);
    let change = of_statistic.or_else(|| check.change_of(measure))?;
    (!has_converged(check, change)).then(|| finest(check, change))
}

/// Why a measure has no error though its run was checked; none if it has one.
pub(super) fn why_unknown(measure: &str, checks: &FinerChecks) -> Option<String> {
    let silent = checks.all().find_map(|check| Some((check.refined.name(), check.silence_about(measure)?)));
    let silent = silent.map(|(refined, silence)| match silence {
        Silence::AxialWaves => format!(
            "error not known: waves along the fibre decide this number, and the check of the {refined} does not \
            follow them"
        ),
        Silence::SamplingError => format!(
            "error not known: this number is close to zero, and the check of the {refined} is too short to show how \
            much it changes"
        ),
    });
    let open = not_converged(measure, checks);
    open.map(|finest| format!("not converged: {}", finest.describe())).or(silent)
}

fn finest(check: &FinerCheck, change: &Change) -> FromFinest {
    let own = (check.element_length, &change.estimate);
    let (length, estimate) =
        change.from_quarter.as_ref().map_or(own, |(length, estimate)| (*length, estimate));
    FromFinest { length, difference: estimate.mean, size: change.size }
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
/// least that can be reported.
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

/// What a check reports of the error of a number: `frequency is off by +25 ± 2 %`, or what differs where its order is
/// not known.
pub(super) fn describe_change(check: &FinerCheck, change: &Change, case: &Case) -> String {
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

/// All that a check finds beyond its limit; none if there is nothing.
fn describe_changes(check: &FinerCheck, case: &Case) -> Option<String> {
    let each: Vec<String> = beyond(check, true).map(|change| describe_change(check, change, case)).collect();
    let is_open = |change: &Change| check.error_over(change).is_none() && change.from_quarter.is_some();
    let end = match beyond(check, true).any(is_open) {
        true => ", which does not show how far this is from very fine elements",
        false => "",
    };
    (!each.is_empty()).then(|| format!("{}{}{end}", part(check, case), each.join(", ")))
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

/// What has not converged with the mesh, and the command that settles it; none if all has.
fn unsettled(checks: &FinerChecks) -> Option<String> {
    let check = checks.mesh.as_ref().ok()?;
    let each: Vec<String> = beyond(check, false)
        .map(|change| {
            format!("the {} is {}", change.statistic.label.to_lowercase(), finest(check, change).describe())
        })
        .collect();
    let finer = Dimension::Length.pretty_to(finer_elements(check), 3);
    (!each.is_empty()).then(|| {
        format!(
            "not converged with the mesh: {}; no error contains this, so run again with \
            --set fibre.element_length=\"{finer}\"",
            each.join(", ")
        )
    })
}

/// The longest elements [m] whose error may be small enough, if it falls with the square of their length: shorter than
/// any that were compared.
pub(super) fn finer_elements(check: &FinerCheck) -> f64 {
    let changes = || counted(check).flat_map(|change| errors(check, change));
    let found = changes().map(|error| error.mean.abs()).fold(0.0, f64::max);
    let compared = if counted(check).any(|change| change.from_quarter.is_some()) { 3.0 } else { 2.0 };
    let least = if beyond(check, false).next().is_some() { compared } else { 1.0 };
    let halvings = (0.5 * (found / FINE_ENOUGH).log2()).ceil().max(least);
    2.0 * check.element_length * 0.5f64.powf(halvings)
}

/// Notes about checks that are beyond their limit, and about those that could not be made.
pub fn notes(checks: &FinerChecks, case: &Case) -> Vec<String> {
    let found = |check: &FinerCheck| {
        let (name, limit) = (check.refined.name(), 100.0 * FINE_ENOUGH);
        let kept = match case.run.replicates {
            1 => "a single replicate has no error that could contain this",
            _ => "the errors contain this",
        };
        let changes = describe_changes(check, case)?;
        Some(format!("the check of the {name} is beyond its limit of {limit} %: {changes}; {kept}"))
    };
    let each = [(&checks.step, Refinement::TimeStep), (&checks.mesh, Refinement::Elements)];
    let of_each = each.into_iter().filter_map(|(check, refined)| match check {
        Ok(check) => found(check),
        Err(why) => why.leaves_doubt().then(|| unchecked(refined, why)),
    });
    of_each.chain(unsettled(checks)).collect()
}

/// That a check was not made, and why.
pub(super) fn unchecked(refined: Refinement, why: &Unchecked) -> String {
    format!("{}: not checked: {why}", refined.name())
}

/// An estimate of a run with its total standard error: by sampling, and by step and mesh as the checks found them. One
/// that has not converged has no error. What chance does to a single replicate is not known, nor is its error.
///                                                                                             theory.md (58)
pub fn with_error_of_checks(estimate: Estimate, measure: &str, checks: &FinerChecks) -> Estimate {
    // From the value of the limit, or of the finer flight, to that of the run. Chance is in the square of what was
    // found too.
    let square_of = |error: &Estimate, size: Option<f64>| {
        let ratio = 1.0 + error.mean.max(-0.95);
        let (of, off, by_chance) = match size {
            Some(size) => (size, error.mean, error.standard_error.unwrap_or(0.0)),
            None => (estimate.mean / ratio, ratio - 1.0, error.standard_error.unwrap_or(0.0) / ratio),
        };
        of * of * (off * off - by_chance * by_chance).max(0.0)
    };
    let square = |check: &FinerCheck| {
        let Some(change) = check.change_of(measure) else { return 0.0 };
        errors(check, change).iter().map(|error| square_of(error, change.size)).fold(0.0, f64::max)
    };
    let of_checks: f64 = checks.all().map(square).sum();
    let is_known = why_unknown(measure, checks).is_none();
    let chance = estimate.standard_error.filter(|_| is_known);
    Estimate { standard_error: chance.map(|chance| chance.hypot(of_checks.sqrt())), ..estimate }
}

/// What the headline has to say about the checks, as whole sentences: what no error contains. Empty if all is known.
pub fn sentences(checks: &FinerChecks, case: &Case) -> String {
    let open = unsettled(checks).map(|unsettled| format!(" {}.", capitalised(&unsettled)));
    let mut text = open.unwrap_or_default();
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
    use spunlaid_fibre::chain::Scheme;
    use spunlaid_simulation::Statistic;

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
            has_scheme_of_run: true,
            duration,
            replicates: 8,
            share_of_run: 0.1,
            path: None,
            changes: vec![Change::new(statistic, estimate)],
            of_measures: Vec::new(),
        };
        FinerChecks { step: Ok(step), mesh: Err(Unchecked::Dear { times: 12.0 }) }
    }

    #[test]
    fn what_is_beyond_its_limit_is_in_error_headline_and_notes() {
        let case = sample::fed_case(100, 2);
        let run = case.run.duration();
        let width = || Estimate { mean: 2.778, standard_error: Some(0.026), values: Vec::new() };
        let error =
            |checks: &FinerChecks| with_error_of_checks(width(), "sigma_md", checks).standard_error.unwrap();
        // The run has 0.34 of the true spread, which is 2.778/0.34. The change is known to 0.02 of that.
        let whole = checks(-0.66, 0.02, run);
        let [off, chance] = [2.778f64 / 0.34 * 0.66, 2.778f64 / 0.34 * 0.02 / 0.34];
        assert!((error(&whole) - (off * off - chance * chance).sqrt()).abs() < 1e-3, "{}", error(&whole));
        assert_eq!(sentences(&whole, &case), " The mesh is not checked.");
        assert!(notes(&whole, &case)[0].contains("spread differs by −66"), "{:?}", notes(&whole, &case));
        assert!(notes(&whole, &case)[1].starts_with("mesh: not checked: it would take 12 times"));
        // A part of a fed fibre's run is named as one, and is in the error too.
        let part = checks(1.17, 0.05, 0.1 * run);
        assert!((error(&part) - 2.778 / 2.17 * 1.17).abs() < 0.01, "{}", error(&part));
        assert!(notes(&part, &case)[0].contains("in the first "));
        // A change within the limit is in the error, less what chance does to it, and in no note.
        let within = checks(-0.02, 0.002, run);
        let off = 2.778 / 0.98 * (0.02f64.powi(2) - (0.002f64 / 0.98).powi(2)).sqrt();
        assert!((error(&within) - off.hypot(0.026)).abs() < 1e-9);
        assert_eq!((error(&checks(-0.02, 0.03, run)), notes(&within, &case).len()), (0.026, 1));
        assert_eq!(sentences(&within, &case), " The mesh is not checked.");
    }

    /// Waves along a fibre are others in another scheme: a check that flies with one says nothing of what they decide.
    #[test]
    fn what_waves_decide_has_no_error_from_a_check_with_another_scheme() {
        let strain = || Estimate { mean: 8e-4, standard_error: Some(1e-5), values: Vec::new() };
        let is_known = |has_scheme_of_run: bool, measure: &str| {
            let mut checks = checks(0.02, 0.01, 1.0);
            checks.step = checks.step.map(|check| FinerCheck {
                has_scheme_of_run,
                of_measures: vec![Change {
                    statistic: Box::leak(Box::new(Statistic { name: "strain_99", label: "", measures: &[] })),
                    ..check.changes[0].clone()
                }],
                ..check
            });
            let error = with_error_of_checks(strain(), measure, &checks).standard_error;
            assert_eq!(error.is_none(), why_unknown(measure, &checks).is_some());
            error.is_some()
        };
        assert!(is_known(true, "strain_99") && !is_known(false, "strain_99"));
        assert!(!is_known(true, "peak_root_tension") && is_known(false, "sigma_md"));
    }

    /// The mean of a number of both signs may be close to zero accidentally. Its change is a fraction of its root mean
    /// square, and its error does not follow how close to zero it is.
    #[test]
    fn the_error_of_a_number_close_to_zero_does_not_follow_the_number() {
        let error = |mean: f64, change: f64, of_change: f64, size: Option<f64>| {
            let mut checks = checks(change, of_change, 1.0);
            checks.step.as_mut().unwrap().changes[0].size = size;
            checks.mesh =
                checks.step.clone().map(|check| FinerCheck { refined: Refinement::Elements, ..check });
            let estimate = Estimate { mean, standard_error: Some(3e-5), values: Vec::new() };
            let why = why_unknown("sigma_md", &checks);
            (with_error_of_checks(estimate, "sigma_md", &checks).standard_error, why)
        };
        let off = 2e-3_f64.hypot(2e-3) * (0.08f64.powi(2) - 0.01f64.powi(2)).sqrt();
        for mean in [1e-6, -1e-3, 5e-3] {
            let (found, _) = error(mean, -0.08, 0.01, Some(2e-3));
            assert!((found.unwrap() / off.hypot(3e-5) - 1.0).abs() < 1e-12, "{mean}: {found:?}");
        }
        let (found, why) = error(1e-6, -0.9, 0.01, Some(2e-3));
        let said = "not converged: 90 % of its root mean square lower than with elements of 2 mm";
        assert_eq!((found, why.as_deref()), (None, Some(said)));
        // Chance in the check is as large as the number; one that keeps its sign has its error all the same.
        let (found, why) = error(1e-6, -0.1, 0.3, Some(2e-3));
        assert!(found.is_none() && why.unwrap().starts_with("error not known: this number is close to zero"));
        assert!(error(1e-6, -0.1, 0.3, None).0.is_some());
    }

    /// A change of unknown order that is surely beyond a tenth is no error, but a number that has not converged.
    #[test]
    fn what_has_not_converged_has_no_error_and_a_command() {
        let case = sample::fed_case(100, 2);
        let of_mesh = |mean: f64| {
            let mut checks = checks(mean, 0.01, case.run.duration());
            checks.mesh = checks.step.map(|check| FinerCheck { refined: Refinement::Elements, ..check });
            FinerChecks { step: Err(Unchecked::TooShort), ..checks }
        };
        let width = || Estimate { mean: 2.8, standard_error: Some(0.03), values: Vec::new() };
        let error = |mean: f64| with_error_of_checks(width(), "sigma_md", &of_mesh(mean)).standard_error;
        assert_eq!(error(-0.44), None);
        assert!(error(-0.11).unwrap() > 0.3);
        let said = sentences(&of_mesh(-0.44), &case);
        assert!(
            said.contains("Not converged with the mesh: the spread is 44 % lower than with elements of 2 mm")
        );
        assert!(said.contains("--set fibre.element_length=\"1 mm\""), "{said}");
        assert_eq!(notes(&of_mesh(-0.44), &case).len(), 1);
    }
}
