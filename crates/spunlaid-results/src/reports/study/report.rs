//! The report of a study: question, ranking, figures and points. It does not depend on the time of computation.

use super::figures::quantity::name_of_key;
use super::files::shown;
use crate::numbers::{THIN, number};
use crate::page::claims::claim_sections;
use crate::page::document::{Report, Section};
use crate::page::methods::{Reference, methods, of_case, of_web};
use crate::page::table::{Cell, Layout, Row, Table};
use crate::page::words::count;
use crate::reports::web::report::effects::effect_cell;
use spunlaid_charts::Figure;
use spunlaid_experiment::{Claim, Contrast, Design, Experiment, PointResults, Quantity, Ranking, Study};
use spunlaid_ground::{Difference, Effect};

/// Largest number of points that are listed.
const LISTED: usize = 500;
/// Figures whose quantities a terminal shows of webs.
const IN_SHORT: [&str; 4] = ["cv", "basis_weight", "md_cd_ratio", "thin_places"];

/// A study.
///
/// * `results` – of every point
/// * `rankings` – main effects; empty if the study does not give them
/// * `refusal` – why it does not
/// * `claims` – with their verdicts
/// * `texts` – the study as a file, and the case or web that it varies
pub fn study_report<'a>(
    study: &Study,
    results: &[PointResults],
    rankings: &[Ranking],
    refusal: Option<&str>,
    claims: &[Claim],
    figures: &'a [Figure],
    texts: [&str; 2],
) -> Report<'a> {
    let question = question(study);
    // The title is the answer, where there is one; the question then begins the text.
    let (title, asked) = match answer(study, rankings) {
        Some(answer) => (answer, format!("{question} ")),
        None => (question, String::new()),
    };
    let verdicts = "The program judges the claims of the study file by the results. A factor matters more, and ends \
        differ, by more than three standard errors. A step in the wrong direction counts against a rise or a \
        fall if it is larger than 2.5. “Open” means that the errors are too large to decide; more replicates \
        would help.";
    Report::new("sweep", title)
        .lead(format!("{asked}{}", summary(study, results)))
        .lead(phases(study))
        .with(points_in_short(study, results))
        .with_all(claim_sections(claims, "What is claimed", verdicts))
        .with_all(ranking(study, rankings, refusal).map(Section::open))
        .with(Section::of_figures(figures).open())
        .with(points(study, results))
        .with(methods("sweep", cited(study), "study.toml of the results"))
        .with(files(study, texts))
}

/// What matters most; why that cannot be reported; or nothing if there is nothing to choose from.
fn ranking(study: &Study, rankings: &[Ranking], refusal: Option<&str>) -> Option<Section<'static>> {
    let section = Section::new("ranking", "What matters most");
    if let Some(refusal) = refusal {
        return Some(section.paragraph(format!("The factors are not ranked: {refusal}.")).printed());
    }
    // The rows have the order of the effects on the amplitude.
    let first = rankings.first().filter(|_| study.factors.len() > 1)?;
    let mut quantities = shown::quantities(study);
    quantities.retain(|quantity| ranking_of(rankings, *quantity).is_some());
    let row = |effect: &Effect<Contrast>| {
        let cells = quantities.iter().map(|quantity| cell(study, rankings, *quantity, effect.of));
        let [from, to] = ends(study, effect.of);
        let range = match is_of_words(study, effect.of) {
            false => format!("{from} to {to}"),
            true => format!("{to} instead of {from}"),
        };
        Row::new(name_of_key(&study.factors[effect.of.factor].key.name), cells).detail(range)
    };
    let heads = quantities.iter().map(|quantity| shown::head(&study.quantities[*quantity]));
    let table = Table::new(["Factor".to_owned()].into_iter().chain(heads))
        .rows(first.effects.iter().map(row))
        .foot(Row::new("explained", explained(rankings, &quantities)));
    Some(section.table(table).caption(format!(
        "Change of the mean from the least to the greatest value of a factor, on the straight line that fits \
        the points best, or from one word to another, ± one standard error. Grey values \
        have a 95\u{202f}% confidence interval that contains zero. “Explained” is the fraction of the variation \
        between points that straight lines explain (adjusted R²). If it is low, the response is curved or the factors \
        act together, and the figures say more than the ranking. {}",
        intervals(study)
    )))
}

/// The quantities that tables show and that some point has.
fn quantities_with_values(study: &Study, results: &[PointResults]) -> Vec<usize> {
    let mut shown = shown::quantities(study);
    shown.retain(|quantity| results.iter().any(|point| point.mean(*quantity).is_finite()));
    shown
}

/// Points and measures for a terminal.
fn points_in_short(study: &Study, results: &[PointResults]) -> Section<'static> {
    const POINTS: usize = 24;
    const MEASURES: usize = 4;
    let mut shown = quantities_with_values(study, results);
    let title = if study.noun() == "web" {
        let is_of_web = |i: &usize| IN_SHORT.contains(&study.quantities[*i].figure.name);
        shown.retain(is_of_web);
        "CV of basis weight in %, ± its total standard error, over patches of this side"
    } else {
        shown.truncate(MEASURES);
        "Points"
    };
    let heads = shown.iter().map(|quantity| {
        let quantity = &study.quantities[*quantity];
        if quantity.figure.name == "cv" { quantity.series.clone() } else { shown::head(quantity) }
    });
    let inputs = study.inputs().map(|input| input.name.rsplit('.').next().unwrap_or(&input.name).to_owned());
    let heads = ["Point".to_owned()].into_iter().chain(inputs).chain(heads).chain(["n".to_owned()]);
    let rows = point_rows(study, results, &shown).take(POINTS);
    let section = Section::new("", title).table(Table::of_numbers(heads).rows(rows)).on_terminal();
    match results.len().saturating_sub(POINTS) {
        0 => section,
        more => section.paragraph(format!("and {more} more points in results.csv")),
    }
}

/// A row for each point: the values that vary, some of its results, and how many replicates it has.
fn point_rows(study: &Study, results: &[PointResults], shown: &[usize]) -> impl Iterator<Item = Row> {
    results.iter().enumerate().map(|(index, point)| {
        let values = study.points[index].values.iter().zip(study.inputs());
        let inputs = values.map(|(value, input)| input.pretty(*value));
        let results = shown.iter().map(|quantity| shown::cell(study, point, *quantity));
        Row::new((index + 1).to_string(), inputs.chain(results).chain([point.n.to_string()]))
    })
}

/// The points with their results.
fn points(study: &Study, results: &[PointResults]) -> Section<'static> {
    let shown = quantities_with_values(study, results);
    let heads = ["Point".to_owned()].into_iter().chain(study.inputs().map(|input| input.name.clone()));
    let quantities = shown.iter().map(|quantity| shown::head(&study.quantities[*quantity]));
    let table = Table::new(heads.chain(quantities).chain(["n".to_owned()]))
        .laid_out(Layout::Scrolled("all points and columns"))
        .rows(point_rows(study, results, &shown).take(LISTED));
    let more = match results.len().saturating_sub(LISTED) {
        0 => String::new(),
        more => format!(" {more} more points are in results.csv."),
    };
    Section::new("points", "Points").table(table).caption(format!(
        "Mean ± one standard error of the mean over n replicates.{more} The files results.parquet and \
        replicates.parquet hold all digits and every replicate."
    ))
}

/// The study, and what it varies.
fn files(study: &Study, [text, base_text]: [&str; 2]) -> Section<'static> {
    let [base, command] = match study.noun() {
        "web" => ["web", "web"],
        "spinline" => ["spinline", "spin"],
        _ => ["case", "run"],
    };
    Section::new("study", "The study")
        .paragraph(format!(
            "The study with every default, and below it the {base} that it varies. Both files are in the \
            folder of this page. `spunlaid sweep study.toml` gives exactly the same numbers again. `spunlaid \
            sweep study.toml --print-point K` prints the {base} of point K for `spunlaid {command}`."
        ))
        .file("study-toml", text)
        .file("base-toml", base_text)
}

/// What is cited for what varies.
fn cited(study: &Study) -> Vec<Reference> {
    match study.points.first().map(|point| &point.experiment) {
        Some(Experiment::Case(case)) => of_case(case),
        Some(Experiment::Web(spec)) => of_web(spec),
        Some(Experiment::Spinline(spec)) => vec![spec.drag.along.source()],
        None => Vec::new(),
    }
}

fn question(study: &Study) -> String {
    let names: Vec<String> = study.factors.iter().map(|factor| name_of_key(&factor.key.name)).collect();
    let what = match study.points.first().map(|point| &point.experiment) {
        Some(Experiment::Web(_)) => "uniformity of the web",
        Some(Experiment::Spinline(_)) => "filament",
        Some(Experiment::Case(case)) if case.line.is_some() => "laid fibre",
        _ => "fibre’s motion",
    };
    match names.as_slice() {
        [] if study.noun() == "web" => "How uniform is the web?".to_owned(),
        [] if study.noun() == "spinline" => "Which filament does the line make?".to_owned(),
        [] => "How does the fibre move?".to_owned(),
        [one] => format!("How does the {what} depend on the {one}?"),
        [one, two] => format!("How does the {what} depend on the {one} and the {two}?"),
        [first @ .., last] => {
            format!("Which matters most for the {what}: the {} or the {last}?", first.join(", the "))
        }
    }
}

/// What matters most for the first quantity of the tables, and by how much; that nothing does beyond chance;
/// or none if the study does not give it.
fn answer(study: &Study, rankings: &[Ranking]) -> Option<String> {
    let quantity = shown::quantities(study).into_iter().find(|i| ranking_of(rankings, *i).is_some())?;
    let effects = &ranking_of(rankings, quantity)?.effects;
    let result = &study.quantities[quantity];
    let label = &result.label;
    let size = |effect: &&Effect<Contrast>| effect.difference.value.abs();
    let known = effects.iter().filter(|effect| effect.difference.is_significant());
    let Some(effect) = known.max_by(|a, b| size(a).total_cmp(&size(b))) else {
        let all_known = effects.iter().all(|effect| effect.difference.known_half_width().is_some());
        return all_known.then(|| format!("{label} does not change significantly"));
    };
    let name = name_of_key(&study.factors[effect.of.factor].key.name);
    let [from, to] = ends(study, effect.of);
    let sign = if effect.difference.value > 0.0 { "+" } else { "" };
    let change = change(result, &effect.difference);
    let unit = Some(result.unit.shown)
        .filter(|unit| !unit.is_empty())
        .map_or(String::new(), |unit| format!("{THIN}{unit}"));
    let difference = match is_of_words(study, effect.of) {
        false => format!("from {from} to {to}"),
        true => format!("with {to} instead of {from}"),
    };
    Some(if study.factors.len() == 1 {
        format!("{label}: {sign}{change}{unit} {difference} of the {name}")
    } else {
        format!("{label}: the {name} matters most, {sign}{change}{unit} {difference}")
    })
}

/// The values of a factor between which it changes.
fn ends(study: &Study, Contrast { factor, from, to }: Contrast) -> [String; 2] {
    [from, to].map(|value| study.factors[factor].key.pretty(value))
}

fn is_of_words(study: &Study, contrast: Contrast) -> bool {
    !study.factors[contrast.factor].key.words().is_empty()
}

/// The change of a result, ± one standard error.
fn change(result: &Quantity, difference: &Difference) -> String {
    let known = difference.known_half_width().map(|_| difference.standard_error);
    shown::in_unit(result, difference.value, known)
}

fn summary(study: &Study, results: &[PointResults]) -> String {
    let how = match study.design {
        Design::Grid => "every combination of values",
        Design::OneAtATime => "the base case, and points in which one factor differs from it",
        Design::Paired => "the first values of all lists, then the second values, and so on",
        Design::LatinHypercube(_) => {
            "a Latin hypercube, in which the range of each factor has as many slices as there are points, \
            and each slice holds one point"
        }
    };
    let fibres: u64 = results.iter().map(|point| point.n).sum();
    let least = results.iter().map(|point| point.n).min().unwrap_or(0);
    let most = results.iter().map(|point| point.n).max().unwrap_or(0);
    let each = if least == most { least.to_string() } else { format!("{least} to {most}") };
    let mut text = format!(
        "{}: {how}. Each point has {}; the study has {} in total.",
        count(results.len() as u64, "point"),
        if most == 1 { "1 replicate".to_owned() } else { format!("{each} replicates") },
        count(fibres, study.noun())
    );
    for link in &study.links {
        let (name, formula) = (name_of_key(&link.key.name), link.expression.text());
        text += &format!(" The {name} follows from the others: {} = {formula}.", link.key.name);
    }
    text += &most_even(study, results).unwrap_or_default();
    let lost: u64 = results.iter().map(|point| point.lost).sum();
    if lost > 0 {
        text += &format!(
            " {} lost: {}. All means leave them out.",
            if lost == 1 {
                format!("1 {} was", study.noun())
            } else {
                format!("{lost} {}s were", study.noun())
            },
            match study.noun() {
                "spinline" => "it has no steady state, or its filament is not solid at the end",
                _ => "the computation diverged, or the fibre did not reach the belt",
            }
        );
    }
    text
}

/// The most even and the least even web, over patches of one size. None for fibres, and where all points are alike.
fn most_even(study: &Study, results: &[PointResults]) -> Option<String> {
    let all: Vec<usize> =
        (0..study.quantities.len()).filter(|i| study.quantities[*i].figure.name == "cv").collect();
    let quantity = *all.get(all.len() / 2)?;
    if !results.iter().all(|point| point.mean(quantity).is_finite()) {
        return None;
    }
    let order = |a: &usize, b: &usize| results[*a].mean(quantity).total_cmp(&results[*b].mean(quantity));
    let best = (0..results.len()).min_by(order)?;
    let worst = (0..results.len()).max_by(order)?;
    let words = |point: usize| {
        let values = study.inputs().zip(&study.points[point].values);
        let values =
            values.map(|(factor, value)| format!("{} {}", name_of_key(&factor.name), factor.pretty(*value)));
        let cv = shown::cell(study, &results[point], quantity);
        format!("{} (CV {cv} %)", values.collect::<Vec<_>>().join(", "))
    };
    let side = &study.quantities[quantity].series;
    (best != worst).then(|| {
        format!(
            " Over patches of {side} the web is most uniform at {} and least uniform at {}.",
            words(best),
            words(worst)
        )
    })
}

/// Where the confidence intervals of the effects come from.
fn intervals(study: &Study) -> &'static str {
    if study.noun() == "spinline" {
        "The intervals come from the scatter of the points about the straight lines. A spinline has no random part, \
        so they describe how far straight lines are from the curves."
    } else {
        "The intervals come from the differences between replicates; with common phases, each replicate of \
        all points is compared with the same replicate."
    }
}

fn phases(study: &Study) -> &'static str {
    if study.noun() == "spinline" {
        "A spinline has no random part, so the numbers have no error bars. How far the model is from a real \
        line is not known: no diameter that it gives has been compared with a measured one."
    } else if study.noun() == "web" {
        "Replicate 1 of every point has the same random numbers, and likewise replicate 2 and so on, as far as the \
         keys allow. Errors are those of the scatter of the webs of a point, or of the parts of a single web; \
         where a sample of filaments was simulated, with the error of the sample."
    } else if study.common_phases {
        "Common phases: replicate 1 of every point has the same random phases of the turbulence, and \
        likewise replicate 2 and so on. Differences between points are therefore more certain than their \
        error bars suggest, while the errors of all points have a common part."
    } else {
        "Every point has its own random phases, so the points are independent."
    }
}

fn ranking_of(rankings: &[Ranking], quantity: usize) -> Option<&Ranking> {
    rankings.iter().find(|ranking| ranking.measure == quantity)
}

fn cell(study: &Study, rankings: &[Ranking], quantity: usize, of: Contrast) -> Cell {
    let effect = ranking_of(rankings, quantity).and_then(|ranking| ranking.of(of));
    let difference = effect.map(|effect| &effect.difference);
    effect_cell(difference, "–", |difference| change(&study.quantities[quantity], difference))
}

fn explained(rankings: &[Ranking], quantities: &[usize]) -> Vec<String> {
    let explained = |quantity: &usize| {
        ranking_of(rankings, *quantity)
            .and_then(|ranking| ranking.explained)
            .map_or_else(|| "–".to_owned(), |share| format!("{}{THIN}%", number((share * 100.0).round())))
    };
    quantities.iter().map(explained).collect()
}
