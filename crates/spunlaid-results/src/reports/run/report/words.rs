//! What a run has found, its mesh and its case, in sentences.

use crate::numbers::THIN;
use crate::page::words::{count, estimate_text, length, quantity, time};
use crate::reports::run::doubt;
use spunlaid_air::EddyModel;
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Case, Root};
use spunlaid_ground::Estimate;
use spunlaid_simulation::{FinerChecks, Results};

/// The result in a sentence, and what its checks say against it.
pub(super) fn headline(case: &Case, results: &Results, checks: &FinerChecks) -> String {
    let estimate = |measure: &str| doubt::with_error_of_checks(results.estimate(measure), measure, checks);
    match found(case, estimate) {
        (sentence, true) => sentence + &doubt::sentences(checks, case),
        (sentence, false) => sentence,
    }
}

/// The result in a sentence, and whether it has a number.
fn found(case: &Case, estimate: impl Fn(&str) -> Estimate) -> (String, bool) {
    if case.line.is_some() {
        return found_of_laid(estimate);
    }
    let both = ["y", "z"].map(|axis| (axis, estimate(&format!("amplitude_{axis}"))));
    if both.iter().any(|(_, amplitude)| !amplitude.mean.is_finite()) {
        return ("The motion of the free end could not be measured.".to_owned(), false);
    }
    // Below this it is rounding.
    let least = 1e-12 * case.fibre.length;
    let moving: Vec<_> = both.iter().filter(|(_, amplitude)| amplitude.mean > least).collect();
    let amplitudes: Vec<String> =
        moving.iter().map(|(axis, a)| format!("{}{THIN}mm in {axis}", estimate_text(a, 1e3))).collect();
    let amplitudes = amplitudes.join(" and ");
    let frequency = estimate("mean_frequency");
    let swings = ["frequency_y", "frequency_z"].iter().any(|name| estimate(name).mean > 0.0);
    let sentence = match (moving.is_empty(), swings) {
        (true, _) => "The free end does not move sideways.".to_owned(),
        (false, true) if frequency.mean.is_finite() => {
            let frequency = estimate_text(&frequency, 1.0);
            format!("Amplitude of the free end: {amplitudes}, at a mean frequency of {frequency}{THIN}Hz.")
        }
        (false, true) => format!("Amplitude of the free end: {amplitudes}."),
        (false, false) => {
            format!(
                "Amplitude of the free end: {amplitudes} (standard deviation). It does not cross its axis."
            )
        }
    };
    (sentence, !moving.is_empty())
}

/// The same of a fed fibre.
fn found_of_laid(estimate: impl Fn(&str) -> Estimate) -> (String, bool) {
    let [md, cd] = ["sigma_md", "sigma_cd"].map(estimate);
    if !(md.mean.is_finite() && cd.mean.is_finite()) {
        return ("Too little fibre was laid to give its standard deviation.".to_owned(), false);
    }
    let sentence = format!(
        "The fibre lies {}{THIN}mm wide in machine direction and {}{THIN}mm in cross direction (standard deviation).",
        estimate_text(&md, 1e3),
        estimate_text(&cd, 1e3)
    );
    (sentence, true)
}

/// Scale at which a fibre folds when it meets the belt [m].
pub(super) fn folding_scale(case: &Case) -> Option<f64> {
    let (fibre, line) = (&case.fibre, case.line?);
    Some(fibre.diameter * (fibre.youngs_modulus / fibre.density).sqrt() / (4.0 * line.feed_speed))
}

/// What the mesh of a fed fibre resolves: a heading and sentences.
pub(super) fn mesh(case: &Case) -> Option<(String, String)> {
    /// Elements in a folding scale with which the texture was seen to stand still.
    const FINE: f64 = 3.0;
    let scale = folding_scale(case)?;
    let element = case.fibre.rest_length();
    let (fold, each) = (length(significant_of(scale)), length(element));
    let texture = if FINE * element <= scale {
        format!(
            "The elements of {each} are fine enough for such folds, so the texture on the belt (chord over arc in \
            the table, and the finest bends in the pictures) is a valid result. Halve fibre.element_length to check \
            it."
        )
    } else {
        format!(
            "Elements of {each} cannot show such folds. So the texture below 10{THIN}mm (chord over arc in the \
            table, and the finest bends in the pictures) depends on the mesh: with finer elements the fibre is \
            folded more closely."
        )
    };
    Some((
        format!("Mesh: elements of {each}; the fibre itself folds at a scale of {fold}"),
        format!(
            "A fibre that meets the belt folds at a scale of d√(E/\u{2060}ρ)/\u{2060}(4v), which is {fold} \
            in this case. {texture}"
        ),
    ))
}

/// The same with two digits.
fn significant_of(value: f64) -> f64 {
    let power = 10f64.powf(value.abs().log10().floor() - 1.0);
    if power > 0.0 && power.is_finite() { (value / power).round() * power } else { value }
}

/// What was simulated, in three sentences.
pub(super) fn case(case: &Case) -> String {
    let fibre = &case.fibre;
    let air = &case.air;
    let run = &case.run;
    let support = match fibre.root {
        Root::Pinned => "held at one end, free to turn there",
        Root::Clamped => "clamped at one end",
        Root::Free => "free at both ends",
    };
    let medium = if air.density == 0.0 {
        "in a vacuum".to_owned()
    } else if air.velocity == 0.0 {
        "in still air".to_owned()
    } else if air.rms() == 0.0 {
        format!("in air of {} without turbulence", quantity(air.velocity, "m/s"))
    } else {
        let along = match (air.is_uniform(), case.line) {
            (true, _) => "",
            (false, None) => ", on average along the fibre",
            (false, Some(_)) => ", on average along its way",
        };
        let eddies = match air.eddies {
            EddyModel::Independent => format!("in eddies of {}", length(air.length_scale)),
            EddyModel::Convected { .. } if case.line.is_some() => {
                "that is carried along by the air".to_owned()
            }
            EddyModel::Convected { .. } => "that is carried along the fibre".to_owned(),
        };
        let measured = if air.records.is_empty() { "" } else { "measured " };
        format!(
            "in air of {} with {} {measured}turbulence {eddies}{along}",
            quantity(air.velocity, "m/s"),
            quantity(air.turbulence_intensity * 100.0, "%"),
        )
    };
    let scheme = match run.scheme {
        Scheme::SemiImplicitEuler => "semi-implicit Euler",
        Scheme::Leapfrog => "leapfrog",
        Scheme::ImplicitTension => "leapfrog with implicit tension",
    };
    let computed = format!(
        "{} computed, {}for {} in {} of {} ({scheme}).",
        count(run.replicates, "replicate") + if run.replicates == 1 { " was" } else { " were" },
        if run.replicates > 1 { "each " } else { "" },
        time(run.duration()),
        count(run.steps, "step"),
        time(run.time_step),
    );
    if let Some(line) = case.line {
        let support = if fibre.root == Root::Clamped { "" } else { ", free to turn at the inlet," };
        return format!(
            "A fibre of {} diameter is fed at {}{support} and falls {medium} onto a belt {} below the \
            inlet that moves at {}. {computed} The fibre is divided into elements of {}.",
            length(fibre.diameter),
            quantity(line.feed_speed, "m/s"),
            length(line.distance),
            quantity(line.belt_speed, "m/s"),
            length(fibre.rest_length()),
        );
    }
    format!(
        "A fibre of {} length and {} diameter, {support}, moves {medium}. {computed} The fibre is divided into {}.",
        length(fibre.length),
        length(fibre.diameter),
        count(fibre.elements as u64, "element"),
    )
}
