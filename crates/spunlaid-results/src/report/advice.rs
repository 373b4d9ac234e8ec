//! What would make a web more even, for people: the sentence under the headline, and a table of all settings that were tried.

use super::table::{Row, Table};
use super::unevenness::{PER_CENT, grams, headline_patch};
use super::words::millimetres;
use crate::command::web_command;
use crate::numbers::{HARD, THIN, plus_minus, significant};
use crate::output::web::HOUR;
use spunlaid::advice::{Advice, Change, ChangedKey, CvChange, Effect, NAMED, Setting};
use spunlaid::layers::WebSpec;
use spunlaid::web::Findings;

/// Which changed settings lower the CV of a web most, by how much, and what they cost in throughput: a sentence or two.
///
/// * `advice` – None if no change was tried
pub fn advice_words(spec: &WebSpec, findings: &Findings, advice: Option<&Advice>) -> String {
    let Some(advice) = advice else {
        return "What would make it more even was not tried: spunlaid web with --advice flies it anew for each setting of the line.".to_owned();
    };
    let Some(i) = headline_patch(findings) else { return String::new() };
    let patch = findings.patches[i].map.patch;
    if advice.effects.is_empty() {
        return "What would make it more even cannot be tried: its fibres have been flown above this belt, or no setting of its line can be changed. Name a \
                case to fly (laydown.case)."
            .to_owned();
    }
    let improvements = advice.improvements(patch);
    let elsewhere = elsewhere(findings, advice, patch);
    let weight = grams(findings.within().basis_weight());
    let what = if findings.laid.shared_air.is_some() { "CV" } else { "expected CV" };
    let place = format!("over patches of {}", millimetres(patch));
    let also = elsewhere.map_or_else(String::new, |found| found.words(spec, patch));
    if improvements.is_empty() {
        return format!(
            "At the same {weight}, none of the {} changes of the line that were tried lowers the {what} {place} by more than 1{THIN}% and beyond chance.{}{also}",
            advice.effects.len(),
            unconfirmed(spec, advice, patch)
        );
    }
    let named: Vec<String> = improvements
        .iter()
        .take(NAMED)
        .map(|(effect, cv)| {
            let acts = match cv.is_of_clouds() {
                Some(true) => ", which acts on the clouds",
                Some(false) => ", which acts on what each filament does for itself",
                None => "",
            };
            format!(
                "{} ({}{THIN}%){acts}, {}",
                describe_change(&effect.change, spec),
                per_cent(cv),
                cost(effect)
            )
        })
        .collect();
    let mut words =
        format!("At the same {weight}, the {what} {place} falls most with {}.", named.join("; then with "));
    if named.len() < NAMED {
        words += &format!(
            " No other setting that was tried lowers it {place} by more than 1{THIN}% and beyond chance."
        );
    }
    if advice.is_confirmed {
        words += " These numbers come from a second flight in another air, because the best of many changes is overrated.";
    }
    words += &unconfirmed(spec, advice, patch);
    words += &also;
    if is_known(spec) {
        words += " The lay-down itself is taken as it is, because no fibre was flown.";
    }
    words
}

/// The commands that lay the webs of the changes which [`advice_words`] names, in their order.
pub fn advice_commands(findings: &Findings, advice: &Advice) -> Vec<String> {
    let Some(patch) = headline_patch(findings).map(|i| findings.patches[i].map.patch) else {
        return Vec::new();
    };
    let named = advice.improvements(patch).into_iter().take(NAMED).map(|(effect, _)| effect);
    let named = named.chain(elsewhere(findings, advice, patch).map(|found| found.effect));
    named.map(|effect| web_command(&effect.change)).collect()
}

/// Least change of a CV over patches of another size that is named beside those of the headline, as a share of it: of many sizes and settings
/// some changes seem to be beyond chance.
const LARGE: f64 = 0.05;

/// A change that lowers the CV over patches of another size.
struct Elsewhere<'a> {
    effect: &'a Effect,
    cv: &'a CvChange,
}

/// The change that lowers the CV most over patches of another size than the headline's, and is none of those that lower it there.
fn elsewhere<'a>(findings: &Findings, advice: &'a Advice, patch: f64) -> Option<Elsewhere<'a>> {
    let named = advice.improvements(patch);
    let is_new = |effect: &Effect| !named.iter().any(|(other, _)| std::ptr::eq(*other, effect));
    let patches = findings.patches.iter().map(|found| found.map.patch).filter(|other| *other != patch);
    let found = patches.flat_map(|other| advice.improvements(other));
    let found = found.filter(|(effect, cv)| cv.change <= -LARGE && is_new(effect));
    let best = found.min_by(|(_, a), (_, b)| a.change.total_cmp(&b.change));
    best.map(|(effect, cv)| Elsewhere { effect, cv })
}

impl Elsewhere<'_> {
    /// * `patch` – of the headline [m]
    fn words(&self, spec: &WebSpec, patch: f64) -> String {
        let Self { effect, cv } = self;
        let here = effect.over(patch).map_or_else(String::new, |here| {
            format!("; over patches of {} that changes it by {}{THIN}%", millimetres(patch), per_cent(here))
        });
        format!(
            " Patches of another size ask for something else: over patches of {} it falls with {} ({}{THIN}%), {}{here}.",
            millimetres(cv.patch),
            describe_change(&effect.change, spec),
            per_cent(cv),
            cost(effect)
        )
    }
}

/// What seemed to be among the best in a first air, and was not in a second one.
fn unconfirmed(spec: &WebSpec, advice: &Advice, patch: f64) -> String {
    let confirmed = advice.improvements(patch);
    let is_confirmed = |effect: &Effect| confirmed.iter().any(|(other, _)| std::ptr::eq(*other, effect));
    let words = |effect: &Effect| {
        let change = describe_change(&effect.change, spec);
        let again = effect.over(patch).map_or_else(String::new, per_cent);
        format!(
            " In a first air it seemed to fall with {change} as well; in a second one that changed it by {again}{THIN}%."
        )
    };
    let again =
        advice.effects.iter().filter(|effect| !effect.in_first_air.is_empty() && !is_confirmed(effect));
    again.map(words).collect()
}

/// Least correlation of the clouds of two webs from which on it makes their comparison better.
const IN_COMMON: f64 = 0.3;

/// Which changes are compared as two webs by themselves, because hardly any cloud is the same in both.
fn clouds_apart(spec: &WebSpec, advice: &Advice, patch: f64) -> String {
    let is_apart = |effect: &&Effect| {
        effect.over(patch).and_then(|cv| cv.in_common).is_some_and(|common| common < IN_COMMON)
    };
    let names: Vec<String> =
        advice.effects.iter().filter(is_apart).map(|effect| describe_change(&effect.change, spec)).collect();
    if names.is_empty() {
        return String::new();
    }
    format!(
        " With these the filaments come down in other clouds, although the air is the same, so that only a large effect is seen: {}.",
        names.join("; ")
    )
}

/// Whether nothing of the web was flown.
pub(super) fn is_known(spec: &WebSpec) -> bool {
    spec.layers.iter().all(|layer| layer.source.case().is_none())
}

/// `−10.6 ± 0.7`, or `+3.2 ± 1.3`.
fn per_cent(cv: &CvChange) -> String {
    let error = Some(PER_CENT * cv.standard_error).filter(|error| error.is_finite());
    let plus = if cv.change > 0.0 { "+" } else { "" };
    format!("{plus}{}", plus_minus(PER_CENT * cv.change, error))
}

/// `20 % less titre, 2 to 1.6 dtex`.
fn describe_change(change: &Change, spec: &WebSpec) -> String {
    let names: Vec<String> = change.layers.iter().map(|layer| name_of(spec, *layer)).collect();
    let whose = match &names[..] {
        [] => String::new(),
        [one] => format!(" of layer {one}"),
        [more @ .., last] => format!(" of layers {} and {last}", more.join(", ")),
    };
    let values = change.keys.first().map_or_else(String::new, values);
    format!("{} {}{whose}, {values}", share(change), change.setting.words())
}

fn name_of(spec: &WebSpec, layer: usize) -> String {
    let named = spec.layers.get(layer - 1).and_then(|layer| layer.name.clone());
    named.unwrap_or_else(|| layer.to_string())
}

/// `20 % less`, or `10 °C more`.
fn share(change: &Change) -> String {
    let Some(key) = change.keys.first() else { return String::new() };
    let way = match (key.to < key.from, key.whole) {
        (true, true) => "fewer",
        (true, false) => "less",
        (false, _) => "more",
    };
    if change.setting == Setting::DieTemperature {
        return format!("{}{THIN}°C {way}", significant((key.to - key.from).abs(), 3));
    }
    format!("{}{THIN}% {way}", significant(PER_CENT * (key.to / key.from - 1.0).abs(), 3))
}

fn values(key: &ChangedKey) -> String {
    // No line ends between a number and its unit.
    let [from, to] = [key.from, key.to].map(|value| key.pretty(value).replace(' ', &HARD.to_string()));
    format!("{from} to {to}")
}

/// What a change costs in throughput.
fn cost(effect: &Effect) -> String {
    let [before, after] = effect.mass_flow;
    let change = after / before - 1.0;
    // What is held is rounded by less than this.
    if change.abs() < 1e-4 {
        return "with the same throughput".to_owned();
    }
    let way = if change < 0.0 { "less" } else { "more" };
    format!("with {}{THIN}% {way} throughput", significant(PER_CENT * change.abs(), 2))
}

/// All changes that were tried, with the command of each, and what is said below them. None if there are none.
pub(super) fn advice_table(spec: &WebSpec, findings: &Findings, advice: &Advice) -> Option<(Table, String)> {
    if advice.effects.is_empty() {
        return None;
    }
    let patches: Vec<f64> = findings.patches.iter().map(|patch| patch.map.patch).collect();
    let row = |effect: &Effect| {
        let cv = |patch: &f64| effect.over(*patch).map_or_else(|| "–".to_owned(), per_cent);
        let line = [effect.belt_speed[1], HOUR * effect.mass_flow[1]].map(|number| significant(number, 4));
        let cells = patches.iter().map(cv).chain(line);
        Row::new(describe_change(&effect.change, spec), cells).command(web_command(&effect.change))
    };
    let heads = patches.iter().map(|patch| format!("CV at {}, %", millimetres(*patch)));
    let heads = ["At the same basis weight".to_owned()].into_iter().chain(heads);
    let heads = heads.chain(["Belt, m/s", "From each metre, kg/h"].map(str::to_owned));
    let failed: Vec<String> = (advice.failed.iter())
        .map(|(change, why)| format!("{}: {why}", describe_change(change, spec)))
        .collect();
    let error = if advice.is_confirmed {
        "from blocks of both webs which the same air has laid, so that what both have by chance does not count; the best ones were flown once more in another air"
    } else if findings.laid.shared_air.is_some() {
        "which counts both maps as independent"
    } else if is_known(spec) {
        "from paths with the same random numbers before and after; the lay-down itself (σ MD, σ CD, A) is taken as it is, because no fibre was flown"
    } else if spec.layers.iter().any(|layer| layer.source.case().is_none()) {
        "from paths with the same random numbers before and after the change, which leaves out the chance of the few flown fibres and takes the lay-down of the \
             other layers as exact"
    } else {
        "over the flown fibres, each compared with itself in the same gusts before the change"
    };
    let mut caption = format!(
        "Change of the CV as a share of it when one setting of the line is changed and the belt follows, so that the basis weight stays {}: over patches of \
             each size, ± one standard error, {error}. All other settings stay as they are; with another titre the throughput of a hole stays and the filament is fed \
             slower or faster. The command below each change lays that web.",
        grams(findings.within().basis_weight())
    );
    if let Some(patch) = headline_patch(findings).and_then(|i| patches.get(i)) {
        caption += &clouds_apart(spec, advice, *patch);
    }
    if !failed.is_empty() {
        caption += &format!(" These could not be tried: {}.", failed.join("; "));
    }
    Some((Table::new(heads).rows(advice.effects.iter().map(row)), caption))
}
