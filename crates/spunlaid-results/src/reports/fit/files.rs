//! `fit.json`, `trials.csv` and the table of the terminal: which values make webs like the scan.

use crate::Failure;
use crate::files::folder::Staging;
use crate::files::table::{Value, number, whole};
use crate::files::versioned_json;
use crate::numbers::significant;
use serde_json::{Value as Json, json};
use spunlaid_experiment::{
    Fit, FittedKey, FittedNumber, IntervalEnd, KeyWarning, Parameter, Target, Texture, USUAL_WEBS,
};

/// The text of `fit.json`.
///
/// * `web`, `scan` – paths of what was fitted, and to what
pub(super) fn fit_json(fit: &Fit, target: &Target, [web, scan]: &[String; 2], notes: &[String]) -> String {
    let key = |key: &FittedKey| {
        let parameter = &key.parameter;
        let profile: Vec<Json> =
            key.profile.iter().map(|(value, misfit)| json!({"value": value, "misfit": misfit})).collect();
        json!({
            "key": parameter.key.name,
            "unit": parameter.key.dimension().si_unit(),
            "start": parameter.start,
            "range": parameter.range,
            "value": key.value,
            "interval": key.interval.as_ref().ok(),
            "no_interval": key.interval.as_ref().err(),
            "ends": key.ends.map(name_of_end),
            "doubt": key.warning.map(warning),
            "profile": profile,
        })
    };
    let number = |number: &FittedNumber| {
        let mut entry = json!({
            "scan": number.scan, "start": number.start, "fit": number.found,
            "scatter": number.scatter, "model_error": number.model_error, "residual": number.residual(),
        });
        match number.texture {
            Texture::Patch(side) => entry["patch_m"] = side.into(),
            Texture::Band { direction, waves } => {
                entry["direction"] = (if direction == 0 { "cd" } else { "md" }).into();
                entry["from_m"] = waves[0].into();
                entry["to_m"] = waves[1].into();
            }
        }
        entry
    };
    let alike = fit.alike.iter().map(|pair| {
        let keys = pair.keys.map(|key| fit.keys[key].parameter.key.name.as_str());
        json!({"keys": keys, "correlation": pair.correlation, "per_first": pair.per_first})
    });
    let refused = fit.refused.iter().map(|(values, reason)| json!({"values": values, "reason": reason}));
    let trials = fit.trials.iter().map(|trial| json!({"values": trial.values, "misfit": trial.misfit}));
    let [width, length] = target.sides();
    versioned_json(
        1,
        json!({
            "web": web,
            "scan": scan,
            "compared_width_m": width,
            "compared_length_m": length,
            "webs_per_trial": fit.webs,
            "webs_with_larger_misfit": fit.worse,
            "misfit_start": fit.misfit[0],
            "misfit": fit.misfit[1],
            "settled": fit.settled,
            "keys": fit.keys.iter().map(key).collect::<Vec<_>>(),
            "correlations": fit.correlations,
            "alike": alike.collect::<Vec<_>>(),
            "numbers": fit.numbers.iter().map(number).collect::<Vec<_>>(),
            "trials": trials.collect::<Vec<_>>(),
            "refused": refused.collect::<Vec<_>>(),
            "notes": notes,
        }),
    )
}

/// Writes `trials.csv`: a row for each trial.
///
/// # Errors
/// If it cannot be written.
pub fn write_trials(staging: &Staging<'_>, fit: &Fit) -> Result<(), Failure> {
    let key =
        |key: &FittedKey| number(key.parameter.key.name.clone() + &key.parameter.key.dimension().suffix());
    let columns = [whole("trial")].into_iter().chain(fit.keys.iter().map(key)).chain([number("misfit")]);
    let mut table = staging.table("trials", &["csv"], &columns.collect::<Vec<_>>())?;
    for (trial, found) in (1..).zip(&fit.trials) {
        let numbers = found.values.iter().chain([&found.misfit]).map(|value| Value::Number(*value));
        table.add(&[Value::Whole(trial)].into_iter().chain(numbers).collect::<Vec<_>>())?;
    }
    table.finish()
}

/// Why the value of a key is not to be trusted, in words.
pub fn warning(warning: KeyWarning) -> &'static str {
    match warning {
        KeyWarning::NoEffect => "it has no effect on what is compared",
        KeyWarning::Unknown => "the scan does not determine it: every value of the range fits",
        KeyWarning::AtEnd => "it is at an end of its range",
    }
}

/// The name of what is known of an end of an interval.
const fn name_of_end(end: IntervalEnd) -> &'static str {
    match end {
        IntervalEnd::Tried => "tried",
        IntervalEnd::OfRange => "end-of-range",
        IntervalEnd::Straight => "straight-line",
    }
}

/// A value of a key for people.
pub fn pretty(parameter: &Parameter, value: f64) -> String {
    if parameter.key.is_whole() {
        format!("{value:.0}")
    } else {
        parameter.key.dimension().pretty_to(value, 3)
    }
}

/// The value of a key, and its interval, for people.
pub fn value_and_interval(key: &FittedKey) -> [String; 2] {
    let pretty = |value: f64| pretty(&key.parameter, value);
    let interval = match &key.interval {
        Ok([low, high]) => {
            // At an end of the range the interval may go on.
            let mark =
                |end: IntervalEnd, mark: &'static str| if end == IntervalEnd::OfRange { mark } else { "" };
            let less = mark(key.ends[0], " or less");
            let more = mark(key.ends[1], " or more");
            format!("{}{less} to {}{more}", pretty(*low), pretty(*high))
        }
        Err(reason) => format!("none: {reason}"),
    };
    [pretty(key.value), interval]
}

/// A scan is unusual if only one of so many webs differs more from the others.
const RARE: u64 = 10;

/// What the fit says, sentence by sentence: whether such webs can look like the scan, and what the scan does not know.
pub fn sentences(fit: &Fit) -> Vec<String> {
    let mut all = Vec::new();
    let (worse, webs) = (fit.worse, fit.webs);
    all.push(if worse > 0 && RARE * worse <= webs {
        format!(
            "Webs of these values can look like the scan, but it is an unusual piece: only {worse} of {webs} \
            simulated webs differ more from the others than it does. A narrow interval may then miss the true \
            value; scan another piece before you rely on it."
        )
    } else if worse > 0 {
        format!(
            "Webs of these values can look like the scan: {worse} of {webs} simulated webs differ more from \
            the others than the scan does."
        )
    } else {
        let chance = significant(100.0 / (webs as f64 + 1.0), 2);
        let others = if webs < USUAL_WEBS {
            format!("Repeat the fit with --webs {USUAL_WEBS} or more before you rely on this.")
        } else {
            "Fit other keys, or look at the figure of the residuals.".to_owned()
        };
        format!(
            "No value of these keys makes webs like the scan: it differs more from the {webs} simulated webs than \
            any of them differs from the others. This happens with {chance} % of scans that such webs give. {others}"
        )
    });
    for key in &fit.keys {
        let name = &key.parameter.key.name;
        if let Some(found) = key.warning {
            let advice = match found {
                KeyWarning::NoEffect => "do not fit it",
                KeyWarning::Unknown => "set it to a known value, or compare the spectrum too (--spectrum)",
                KeyWarning::AtEnd => "give it a wider range, if values beyond it make sense",
            };
            all.push(format!("{name}: {}; {advice}.", warning(found)));
        }
        let Ok(interval) = &key.interval else { continue };
        for (end, value) in key.ends.iter().zip(interval) {
            let value = pretty(&key.parameter, *value);
            match end {
                IntervalEnd::OfRange if key.warning.is_none() => all.push(format!(
                    "{name}: {value} is the end of its range, not that of its interval. Values beyond it may \
                    look like the scan as well; give it a wider range if they make sense."
                )),
                IntervalEnd::Straight => all.push(format!(
                    "{name}: the end {value} of its interval is an estimate by straight lines, because few \
                    or no webs could be laid there."
                )),
                _ => {}
            }
        }
    }
    for pair in &fit.alike {
        let [one, other] = pair.keys.map(|key| &fit.keys[key].parameter);
        let how = if one.is_logarithmic() && other.is_logarithmic() {
            let change = 100.0 * (1.1_f64.powf(pair.per_first) - 1.0);
            format!(
                "10 % more of the first with {} % {} of the second",
                significant(change.abs(), 2),
                if change < 0.0 { "less" } else { "more" }
            )
        } else {
            "a change of the first with one of the second".to_owned()
        };
        all.push(format!(
            "The scan cannot separate {} and {} (correlation {}): {how} changes the web very little. Measure one of \
            them in another way, write its value in the file, and do not fit it.",
            one.key.name,
            other.key.name,
            significant(pair.correlation, 2)
        ));
    }
    if !fit.settled {
        all.push(
            "The search has not converged: better values may exist. Start it from another value, with --set \
                KEY=VALUE."
                .to_owned(),
        );
    }
    all
}

/// Why some trials could not be laid, if there are such.
pub fn refused(fit: &Fit) -> Option<String> {
    let (_, reason) = fit.refused.last()?;
    let count = fit.refused.len();
    let trials = if count == 1 { "1 trial".to_owned() } else { format!("{count} trials") };
    Some(format!("The webs of {trials} could not be laid, and the search continued without them: {reason}"))
}
