//! What of a study could not be computed: fibres that were lost, spinlines without a steady state.

use crate::Failure;
use crate::numbers::lost_fibres_text;
use spunlaid::experiment::{Journal, ReplicateOutcome, Study};
use spunlaid::fibre::case::keys;
use spunlaid::fibre::{SpinSpec, spinline};

/// Largest number of lost fibres that are listed.
const LOST_LISTED: u64 = 10;

/// A list of the lost fibres, if there are any.
///
/// * `fibres` – number of all
///
/// # Errors
/// If the journal cannot be read.
pub fn lost(study: &Study, journal: &mut Journal, fibres: u64) -> Result<Option<String>, Failure> {
    let (mut lost, mut first) = (0, String::new());
    for (index, point) in study.points.iter().enumerate() {
        for record in journal.records(index, u64::MAX)? {
            if let ReplicateOutcome::Lost { node, time } = record.outcome {
                lost += 1;
                if lost <= LOST_LISTED {
                    let number = index + 1;
                    if let Some(Err(failure)) = point.experiment.spinline().map(SpinSpec::solve) {
                        first.push_str(&format!("\npoint {number}: {}", no_steady_state(&failure)));
                        continue;
                    }
                    let cause = point.experiment.case().map(|case| case.likely_cause_of_divergence());
                    let cause = cause.unwrap_or_default();
                    let replicate = record.replicate + 1;
                    first.push_str(&format!(
                        "\npoint {number}, replicate {replicate}: node {node} at {time:e} s; {cause}"
                    ));
                }
            }
        }
    }
    if lost == 0 {
        return Ok(None);
    }
    let what = match study.noun() {
        "spinline" if lost == 1 => format!("1 of {fibres} spinlines has no steady state"),
        "spinline" => format!("{lost} of {fibres} spinlines have no steady state"),
        _ => lost_fibres_text(lost, fibres),
    };
    Ok(Some(format!("{what}; all others are in the results{first}")))
}

/// Why a spinline has no steady state: `spinline.length = 20 mm is too short…`.
fn no_steady_state(failure: &spinline::Failure) -> String {
    let dimension = keys::find(failure.key).and_then(|key| key.dimension());
    let value =
        failure.value.zip(dimension).map(|(value, dimension)| format!(" = {}", dimension.pretty(value)));
    format!("{}{} {}", failure.key, value.unwrap_or_default(), failure.fault)
}
