//! What changes do to a web, for people: what would make it more even and how much assumed values matter, on the first
//! screen, and a table of all changes that were tried.

use super::cards::Card;
use crate::command::web_command;
use crate::effects::{PER_CENT, describe, difference_text, label};
use crate::numbers::{HARD, THIN, in_sentence, plus_minus, significant};
use crate::page::table::{Cell, Row, Table, Tone};
use crate::page::words::{grams, millimetres};
use crate::reports::web::files::effects::{Advised, HOUR};
use spunlaid_experiment::{Advice, ChangedWeb, SensitivityRun, setting};
use spunlaid_ground::{Difference, Effect, NAMED, Turned};
use spunlaid_simulation::WebSpec;
use spunlaid_web::map::{Evidence, Findings};

/// Side of the patches by which changes are judged [m].
fn judged_by(findings: &Findings, advice: &Advice) -> Option<f64> {
    advice.judged_by.or_else(|| findings.seen().map(|patch| patch.map.patch))
}

/// Which changed settings lower the CV of a web most, by how much, and what they cost in throughput.
pub(super) fn advice_card(spec: &WebSpec, findings: &Findings, tried: Advised<'_>) -> Card {
    let card = |[rows, apart]: [Vec<Row>; 2], words: String| {
        let apart = ("Not on the running line", apart);
        let summary = Some("How these were computed");
        Card { id: "change", title: "Change first", rows, apart, words: vec![words], summary }
    };
    let none = || [Vec::new(), Vec::new()];
    let Some(advice) = tried.advice else {
        return card(none(), untried("What would make it more uniform", tried.awaited));
    };
    let Some(patch) = judged_by(findings, advice).filter(|_| !advice.tried.is_empty()) else {
        let why = "No change can be tried, because no setting of the line of this web can be changed. Name a case \
            (laydown.case).";
        return card(none(), why.to_owned());
    };
    let row = |(tried, effect): Found<'_>, also: String| {
        let acts = match effect.is_of_clouds() {
            Some(true) => ", acts on the clouds",
            Some(false) => ", acts on each filament",
            None => "",
        };
        let detail = format!("{}{acts}{also}", of_line(spec, &tried.change.experiment));
        Row::new(describe(&tried.change, spec), [format!("{}{THIN}%", per_cent(effect))]).detail(detail)
    };
    let with_command =
        |row: Row, (found, _): Found<'_>| row.command(web_command(&found.change, tried.beside));
    let improvements = advice.improvements(patch);
    let other = elsewhere(findings, advice, patch);
    let is_running = |(tried, _): &Found<'_>| tried.change.setting.turned == Turned::Running;
    let rows = [true, false].map(|running| {
        let is_one = |found: &Found<'_>| is_running(found) == running;
        let named = improvements.iter().copied().filter(is_one).take(NAMED);
        let named = named.map(|found| with_command(row(found, String::new()), found));
        let other = other.filter(is_one).map(|found| {
            let here = found.0.on(patch).map_or_else(String::new, |here| {
                format!(", where it changes that of {} by {}{THIN}%", millimetres(patch), per_cent(here))
            });
            with_command(row(found, format!("; over patches of {}{here}", millimetres(found.1.of))), found)
        });
        named.chain(other).collect()
    });
    let weight = grams(findings.within().basis_weight());
    let what = if findings.laid.evidence() == Evidence::Known { "expected CV" } else { "CV" };
    let about = format!(
        "the {what} over patches of {}, of {} changes that were tried at the same {weight}",
        millimetres(patch),
        advice.tried.len()
    );
    let mut words = match improvements.len() {
        0 => format!("No change lowers {about} by more than 1{THIN}%, significantly."),
        _ if !improvements.iter().any(is_running) => {
            format!("No setting of the running line lowers {about} by more than 1{THIN}%, significantly.")
        }
        1 => format!("Change of {about}; no other lowers it by more than 1{THIN}%, significantly."),
        _ => format!("Change of {about}: what lowers it most."),
    };
    if advice.is_confirmed && !improvements.is_empty() {
        words +=
            " From a second simulation in other turbulence, because the best of many changes is overrated.";
    }
    words += &unconfirmed(spec, advice, patch);
    if !spec.flies() {
        words += " The laydown itself is taken as given, because no fibre was simulated.";
    }
    card(rows, words)
}

/// That something is tried next, or was not.
fn untried(what: &str, awaited: bool) -> String {
    match awaited {
        true => format!("{what}: computed next."),
        false => format!("{what} was not computed: spunlaid web with --advice computes it."),
    }
}

/// Least change of a CV over patches of another size that is named beside those of the headline, as a share
/// of it: of many sizes and settings some changes seem to be beyond chance.
const LARGE: f64 = 0.05;

/// A change with what it does over patches of one size.
type Found<'a> = (&'a SensitivityRun, &'a Effect<f64>);

/// The change that lowers the CV most over patches of another size than the one by which they are judged, and
/// is none of those that lower it there.
fn elsewhere<'a>(findings: &Findings, advice: &'a Advice, patch: f64) -> Option<Found<'a>> {
    let named = advice.improvements(patch);
    let is_new = |tried: &SensitivityRun| !named.iter().any(|(other, _)| std::ptr::eq(*other, tried));
    let patches = findings.patches.iter().map(|found| found.map.patch).filter(|other| *other != patch);
    let found = patches.flat_map(|other| advice.improvements(other));
    let found = found.filter(|(tried, effect)| effect.difference.value <= -LARGE && is_new(tried));
    found.min_by(|(_, a), (_, b)| a.difference.value.total_cmp(&b.difference.value))
}

/// What seemed to be among the best in a first air, and was not in a second one.
fn unconfirmed(spec: &WebSpec, advice: &Advice, patch: f64) -> String {
    let confirmed = advice.improvements(patch);
    let is_confirmed =
        |tried: &SensitivityRun| confirmed.iter().any(|(other, _)| std::ptr::eq(*other, tried));
    let words = |tried: &SensitivityRun| {
        let again = tried.on(patch).map_or_else(String::new, per_cent);
        format!(
            " In a first simulation {} seemed to lower it too; in a second one the change was {again}{THIN}%.",
            describe(&tried.change, spec)
        )
    };
    let again = advice.tried.iter().filter(|tried| !tried.at_first.is_empty() && !is_confirmed(tried));
    again.map(words).collect()
}

/// Least correlation of the clouds of two webs from which on it makes their comparison better.
const IN_COMMON: f64 = 0.3;

/// Which changes are compared as two webs by themselves, because hardly any cloud is the same in both.
fn clouds_apart(spec: &WebSpec, advice: &Advice, patch: f64) -> String {
    let is_apart = |tried: &&SensitivityRun| {
        tried.on(patch).and_then(|effect| effect.in_common).is_some_and(|common| common < IN_COMMON)
    };
    let apart = advice.tried.iter().filter(is_apart);
    let names: Vec<String> = apart.map(|tried| describe(&tried.change, spec)).collect();
    if names.is_empty() {
        return String::new();
    }
    format!(
        " With these changes the filaments land in other clouds, although the turbulence is the same, so only a \
        large effect is significant: {}.",
        names.join("; ")
    )
}

/// A change as a share, with its standard error.
fn per_cent(effect: &Effect<f64>) -> String {
    difference_text(&effect.difference, PER_CENT)
}

/// What becomes of titre, mass and belt: `2 dtex, 150 to 120 kg/h, belt 125 to 100 m/min`.
fn of_line(spec: &WebSpec, ChangedWeb { spec: changed, belt_speed, mass_flow, .. }: &ChangedWeb) -> String {
    let layers = spec.layers.iter().zip(&changed.layers);
    let mut titres: Vec<String> = layers
        .map(|(before, after)| {
            from_to([before, after].map(|layer| 1e7 * layer.fed_filament().linear_density()), "dtex")
        })
        .collect();
    titres.dedup();
    let mass = from_to(mass_flow.map(|flow| HOUR * flow), "kg/h");
    format!(
        "{}, {mass} per metre, belt {}",
        titres.join(" and "),
        from_to(belt_speed.map(|speed| 60.0 * speed), "m/min")
    )
}

/// `150 to 120 kg/h`, or one number of what stays.
fn from_to([before, after]: [f64; 2], unit: &str) -> String {
    let [from, to] = [before, after].map(|number| significant(number, 4));
    if from == to { format!("{to}{THIN}{unit}") } else { format!("{from} to {to}{THIN}{unit}") }
}

/// A cell of a table of effects; one that may be by chance is faint.
pub(crate) fn effect_cell(
    difference: Option<&Difference>,
    missing: &str,
    text: impl Fn(&Difference) -> String,
) -> Cell {
    match difference {
        None => Cell::new(missing, Tone::Faint),
        Some(difference) if difference.is_significant() => Cell::new(text(difference), Tone::Plain),
        Some(difference) => Cell::new(text(difference), Tone::Faint),
    }
}

/// All changes that were tried, with the command of each, and what is said below them. None if there are none.
pub(super) fn effects_table(
    spec: &WebSpec,
    findings: &Findings,
    advice: &Advice,
    beside: &str,
) -> Option<(Table, String)> {
    let are_assumed = advice.tried.first()?.change.setting == setting::ASSUMED;
    let patches: Vec<f64> = findings.patches.iter().map(|patch| patch.map.patch).collect();
    let row = |tried: &SensitivityRun| {
        let cv = |patch: &f64| {
            let effect = tried.on(*patch).map(|effect| &effect.difference);
            effect_cell(effect, "–", |difference| difference_text(difference, PER_CENT))
        };
        let ChangedWeb { belt_speed, mass_flow, .. } = &tried.change.experiment;
        let line = [60.0 * belt_speed[1], belt_speed[1], HOUR * mass_flow[1]]
            .map(|number| Cell::from(significant(number, 4)));
        let cells = patches.iter().map(cv).chain(line);
        Row::new(describe(&tried.change, spec), cells).command(web_command(&tried.change, beside))
    };
    let first = if are_assumed { "With another value" } else { "At the same basis weight" };
    let heads = patches.iter().map(|patch| format!("CV at {}, %", millimetres(*patch)));
    let heads = [first.to_owned()].into_iter().chain(heads);
    let heads = heads.chain(["Belt, m/min", "Belt, m/s", "From each metre, kg/h"].map(str::to_owned));
    let failed: Vec<String> =
        (advice.failed.iter()).map(|(change, why)| format!("{}: {why}", describe(change, spec))).collect();
    let in_same_air = |tried: &SensitivityRun| tried.effects.iter().any(|effect| effect.in_common.is_some());
    let mut error = if advice.tried.iter().any(in_same_air) {
        "from blocks of both webs in the same turbulence, so the sampling error that both have in common cancels"
    } else if findings.laid.evidence() != Evidence::Known {
        "which treats both maps as independent"
    } else {
        "from paths with the same random numbers before and after; the laydown itself (σ MD, σ CD, A) is \
        taken as given, because no fibre was simulated"
    }
    .to_owned();
    if advice.is_confirmed {
        error += "; the best ones were simulated once more in other turbulence";
    }
    let (what, held) = if are_assumed {
        ("when an assumed value changes".to_owned(), "All other numbers stay as they are")
    } else {
        let weight = grams(findings.within().basis_weight());
        let what = format!(
            "when one setting of the line is changed and the belt follows, so that the basis weight stays {weight}"
        );
        (
            what,
            "All other settings stay as they are; with another titre the throughput of a hole stays and the \
            filament is fed at another speed",
        )
    };
    let mut caption = format!(
        "Relative change of the CV {what}: over patches of each size, ± one standard error, {error}. Grey values \
        are not significant at 95 %. {held}. The command below each change lays that web."
    );
    if let Some(patch) = judged_by(findings, advice).filter(|_| !are_assumed) {
        caption += &clouds_apart(spec, advice, patch);
    }
    if !failed.is_empty() {
        caption += &format!(" These could not be tried: {}.", failed.join("; "));
    }
    Some((Table::new(heads).rows(advice.tried.iter().map(row)), caption))
}

/// What the CV of a web is with half and twice of each number that its file calls an assumed value, because the error
/// of the CV excludes them: the assumption with the largest effect first.
pub(super) fn assumed_card(spec: &WebSpec, findings: &Findings, tried: Advised<'_>) -> Card {
    let card = |rows, words: String| Card {
        id: "measure",
        title: "Measure first",
        rows,
        apart: Default::default(),
        words: vec![words],
        summary: Some("What these numbers mean"),
    };
    let names: Vec<String> = spec.assumed.iter().map(|key| in_sentence(label(key))).collect();
    let names = listed(&names);
    let judged = tried.assumed_values.and_then(|assumed_values| {
        let patch = judged_by(findings, assumed_values)?;
        let found = findings.patches.iter().find(|found| found.map.patch == patch)?;
        Some((assumed_values, patch, found.reported()?.cv))
    });
    let Some((assumed_values, patch, cv)) = judged else {
        return card(
            Vec::new(),
            match spec.assumed.is_empty() {
                true => "The file of this web names no assumed value (web.assumed).".to_owned(),
                false => untried(
                    &format!("The CV with half and twice of the assumed {names}"),
                    tried.awaited && tried.assumed_values.is_none() && tried.advice.is_none(),
                ),
            },
        );
    };
    let key =
        |tried: &SensitivityRun| tried.change.keys.first().map_or_else(String::new, |key| key.key.clone());
    let most = |name: &str| {
        let of = assumed_values.tried.iter().filter(|tried| key(tried) == name);
        of.filter_map(|tried| Some(tried.on(patch)?.difference.value.abs())).fold(0.0, f64::max)
    };
    let mut sorted: Vec<&SensitivityRun> = assumed_values.tried.iter().collect();
    sorted.sort_by(|a, b| most(&key(b)).total_cmp(&most(&key(a))));
    let row = |found: &&SensitivityRun| {
        let (name, value) = value_and_cv(found, patch, cv)?;
        Some(Row::new(name, [value]).command(web_command(&found.change, tried.beside)))
    };
    let rows: Vec<Row> = sorted.iter().filter_map(row).collect();
    let place = format!("over patches of {}", millimetres(patch));
    let words = match (rows.is_empty(), assumed_values.range(patch)) {
        (true, _) => "No web with half or twice of the assumed values could be simulated.".to_owned(),
        (false, [1.0, 1.0]) => format!("None of these assumed values changes the CV {place} significantly."),
        (false, ends) => {
            let [from, to] = ends.map(|end| significant(PER_CENT * end * cv, 2));
            format!(
                "The error excludes these assumed values: with half and with twice of each, the CV {place} lies \
                between {from} and {to}{THIN}%. The first one has the largest effect."
            )
        }
    };
    let unknown = match sorted.iter().all(|tried| tried.on(patch).is_some()) {
        true => "",
        false => {
            " Where there is no number, too few filaments of that web were simulated: its command simulates as many \
             as needed."
        }
    };
    card(rows, words + unknown + &failed_words(assumed_values))
}

/// Which values could not be laid or simulated, and why.
fn failed_words(assumed_values: &Advice) -> String {
    let failed = assumed_values.failed.iter().filter_map(|(change, why)| {
        let key = change.keys.first()?;
        let part = if key.to < key.from { "Half" } else { "Twice" };
        let verb = if change.refusal.is_some() { "cannot be laid" } else { "could not be simulated" };
        Some(format!(
            " {part} of the {}, {}, {verb}: {why}.",
            in_sentence(label(&key.key)),
            key.pretty(key.to)
        ))
    });
    failed.collect()
}

/// `Depth of the slot: 10 mm`, and `18.3 ± 1.5 %`.
fn value_and_cv(tried: &SensitivityRun, patch: f64, cv: f64) -> Option<(String, String)> {
    let key = tried.change.keys.first()?;
    let value = key.pretty(key.to).replace(' ', &HARD.to_string());
    let cv_text = tried.on(patch).map_or_else(
        || "not known".to_owned(),
        |Effect { difference: Difference { value, standard_error, .. }, .. }| {
            // An error of rounding is none.
            let error = Some(PER_CENT * cv * standard_error).filter(|error| *error > 1e-9);
            let cv_text = plus_minus(PER_CENT * cv * (1.0 + value), error);
            format!("{cv_text}{THIN}%")
        },
    );
    Some((format!("{}: {value}", label(&key.key)), cv_text))
}

/// `a, b and c`.
fn listed(names: &[String]) -> String {
    match names {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        names => names.concat(),
    }
}
