//! What a finer time step and finer elements change, in words. Terminal and report say the same.

use super::doubt::{
    FINE_ENOUGH, SURE, compared_with, counted, describe_change, errors, finer_elements, percent, unchecked,
};
use crate::numbers::{capitalised, significant};
use spunlaid_air::EddyModel;
use spunlaid_fibre::Case;
use spunlaid_ground::{Dimension, Estimate};
use spunlaid_simulation::{FinerCheck, FinerChecks, Refinement, Results};

/// A check: what is compared, and what it says, in sentences.
pub type CheckWords = (String, Vec<String>);

/// Both checks in words; an error says what was not compared, and why.
pub fn words(checks: &FinerChecks, case: &Case, results: &Results) -> [Result<CheckWords, String>; 2] {
    [(&checks.step, Refinement::TimeStep), (&checks.mesh, Refinement::Elements)].map(|(check, refined)| {
        check
            .as_ref()
            .map(|check| words_of_check(check, case, results))
            .map_err(|why| unchecked(refined, why))
    })
}

fn words_of_check(check: &FinerCheck, case: &Case, results: &Results) -> CheckWords {
    let FinerCheck { replicates, .. } = check;
    let extent = format!(
        "{replicates} replicate{} over the first {} s; it took {} % of the run's computing time",
        if *replicates == 1 { "" } else { "s" },
        significant(check.duration, 2),
        significant(100.0 * check.share_of_run, 2)
    );
    let path = check.path.iter();
    let path = path.map(|path| format!("Path of the free end differs by {} of its amplitude", percent(path)));
    let found = check.changes.iter().map(|change| capitalised(&describe_change(check, change, case)));
    let part = check.is_of_a_part(&case.run).then(|| {
        format!(
            "This is so in the first {} of {} s; the whole run may differ by more or less",
            significant(check.duration, 2),
            significant(case.run.duration(), 3)
        )
    });
    let with = compared_with(check, case);
    let (what, advice) = match check.refined {
        Refinement::TimeStep => ("Time step", step_advice(check, results)),
        Refinement::Elements => ("Mesh", mesh_advice(check) + papers_mesh(case)),
    };
    let meaning = meaning(check);
    let end = [meaning.to_owned(), format!("Compared: {extent}."), format!("{advice}.")];
    let found = path.chain(found).chain(part).map(|words| format!("{words}."));
    let name = format!("{what}, compared with {with} in the same turbulence");
    (name, found.chain(end).collect())
}

/// How the error follows from what differs.
fn meaning(check: &FinerCheck) -> &'static str {
    let has_order = check.changes.iter().any(|change| change.is_second_order);
    match (check.refined, check.error_of_step()) {
        (Refinement::TimeStep, Some(1.0)) => {
            "The finer step is taken as the limit, so the difference is the error of the step."
        }
        (Refinement::TimeStep, Some(_)) => "The error of the step is at most about 2.5 times as large.",
        (Refinement::TimeStep, None) => {
            "Implicit tension damps axial waves by as much at half the step, so the error is not known; it is \
            at least the difference."
        }
        (Refinement::Elements, _) if has_order => {
            "Where two halvings show that the error falls with the square of the length, it is 4/3 of the difference; \
            elsewhere it is not known, and at least the difference."
        }
        (Refinement::Elements, _) => {
            "It was not shown that the error falls with the square of the length, so it is not known; it is \
            at least the difference."
        }
    }
}

/// Compares the error of the step with the standard error of the amplitude or the spread, as a share of it.
fn step_advice(check: &FinerCheck, results: &Results) -> String {
    let Some(change) = check.changes.first() else {
        return String::new();
    };
    let statistic = change.statistic;
    let quantity = statistic.label.to_lowercase();
    // Where one end of the difference is the limit itself, the other end is the error.
    let most = |error: Estimate| error.mean.abs() + error.standard_error.unwrap_or(0.0);
    let error = errors(check, change).into_iter().map(most).fold(0.0, f64::max);
    let Some(scatter) = scatter(statistic.measures, results) else {
        return "If that matters to you, halve run.time_step; more replicates would also give the scatter"
            .to_owned();
    };
    let known = format!("standard error over the replicates is {} %", significant(100.0 * scatter, 2));
    if error < 0.5 * scatter {
        format!("A shorter step would gain nothing: the {quantity}'s {known}")
    } else {
        format!(
            "Halve run.time_step and see whether the results change by more than the sampling error: the \
            {quantity}'s {known}"
        )
    }
}

/// The smallest relative standard error of some measures; `None` for a single replicate.
fn scatter(measures: &[&str], results: &Results) -> Option<f64> {
    let relative = |name: &&str| {
        let estimate = results.estimate(name);
        estimate.standard_error.map(|error| error / estimate.mean).filter(|share| share.is_finite())
    };
    measures.iter().filter_map(relative).reduce(f64::min)
}

/// What is said of a mesh like that of the paper, in which each element is as long as an eddy.
fn papers_mesh(case: &Case) -> &'static str {
    let is_papers = case.air.eddies == EddyModel::Independent
        && (case.fibre.rest_length() / case.air.length_scale - 1.0).abs() < 0.01;
    if is_papers {
        ". Elements as long as an eddy are the mesh of the paper (theory.md), so its figures have this error too"
    } else {
        ""
    }
}

/// Which elements to take.
fn mesh_advice(check: &FinerCheck) -> String {
    let shares = |sure: f64| {
        let share = |of: Estimate| of.mean.abs() + sure * of.standard_error.unwrap_or(f64::INFINITY);
        counted(check).flat_map(|change| errors(check, change)).map(share).fold(0.0, f64::max)
    };
    let (surely, at_most) = (shares(-SURE), shares(SURE));
    let length = |metres: f64| Dimension::Length.pretty_to(metres, 3);
    if check.is_fed {
        return if surely > FINE_ENOUGH {
            let half = length(check.element_length);
            format!("The elements are too long: write fibre.element_length = \"{half}\" and run again")
        } else {
            "One halving does not show how far this is from very fine elements: a laid fibre folds more finely \
             than its elements, and each further halving may change as much again"
                .to_owned()
        };
    }
    if at_most <= FINE_ENOUGH {
        return "The elements are short enough: finer ones change less than 3 %".to_owned();
    }
    let found = shares(0.0);
    if surely > FINE_ENOUGH || found > 2.0 * FINE_ENOUGH {
        return format!(
            "The elements are too long: write fibre.element_length = \"{}\" and run again",
            length(finer_elements(check))
        );
    }
    "This run is too short to show whether their error is below 3 %; simulate a longer time".to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use spunlaid_fibre::chain::Scheme;
    use spunlaid_simulation::{Change, Statistic};

    fn check(refined: Refinement, name: &str, mean: f64, standard_error: f64) -> FinerCheck {
        let estimate = Estimate { mean, standard_error: Some(standard_error), values: vec![mean; 8] };
        let statistic = Statistic::all().find(|statistic| statistic.name == name).unwrap();
        let is_fed = !matches!(name, "amplitude" | "frequency");
        FinerCheck {
            refined,
            scheme: Scheme::ImplicitTension,
            time_step: 1e-4,
            element_length: 12.5e-3,
            is_fed,
            is_resolved: false,
            has_scheme_of_run: true,
            duration: 1.0,
            replicates: 8,
            share_of_run: 0.1,
            path: None,
            changes: vec![Change { is_second_order: !is_fed, ..Change::new(statistic, estimate) }],
            of_measures: Vec::new(),
        }
    }

    #[test]
    fn advice_on_the_mesh_names_an_element_length() {
        let advice = |mean, error| mesh_advice(&check(Refinement::Elements, "frequency", mean, error));
        // 4/3 of 18.5 % is 25 %, of which a sixteenth is left at a quarter of 25 mm.
        assert!(advice(0.185, 0.015).contains("fibre.element_length = \"6.25 mm\" and run again"));
        assert!(
            advice(-0.045, 0.007).contains("fibre.element_length = \"12.5 mm\""),
            "{}",
            advice(-0.045, 0.007)
        );
        assert!(advice(0.011, 0.002).contains("less than 3 %"));
        assert!(advice(0.01, 0.02).contains("too short to show"));
        let advice_for_spread = |mean| mesh_advice(&check(Refinement::Elements, "spread", mean, 1e-3));
        assert!(
            advice_for_spread(0.05).contains("\"12.5 mm\"")
                && advice_for_spread(3e-3).contains("One halving does not show")
        );
        assert!(
            mesh_advice(&check(Refinement::Elements, "chord_over_arc", 0.3, 1e-3))
                .contains("One halving does not show")
        );
    }
}
