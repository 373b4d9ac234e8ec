//! One value: a number on the page and on the terminal is one of `summary.json`, in the unit that is next to it.

use super::{Outcome, leaves};
use crate::draw::Drawn;
use crate::program::Program;
use serde_json::{Map, Value as Json};
use spunlaid_fibre::{LOAD_MEASURES, LOAD_POSITION_MEASURES, SPINLINE_MEASURES};
use spunlaid_ground::{Dimension, Measure, measure};
use spunlaid_simulation::DECLARED;
use spunlaid_web::{FABRIC_MEASURES, FABRIC_PATCH_MEASURES, PATCH_MEASURES, STRIP_MEASURES, WEB_MEASURES};
use std::collections::BTreeMap;

/// Dimensions of what is printed with a unit that is no product of plain SI units.
const DIMENSIONS: [Dimension; 14] = [
    Dimension::Ratio,
    Dimension::Length,
    Dimension::Velocity,
    Dimension::Time,
    Dimension::Frequency,
    Dimension::LinearDensity,
    Dimension::BasisWeight,
    Dimension::Pressure,
    Dimension::Temperature,
    Dimension::MassFlow,
    Dimension::Force,
    Dimension::SurfaceTension,
    Dimension::Angle,
    Dimension::Noise,
];
/// What the names of entries that are not in SI units end with, and the unit.
const OTHER_UNITS: [(&str, &str); 2] = [("_percent", "%"), ("_c", "°C")];

/// Lines of cells, as they follow each other on a page or a terminal.
type Lines = Vec<Vec<Cell>>;

/// A cell of a table, or a sentence.
#[derive(Default)]
struct Cell {
    /// The head of its column; empty where it is not known.
    head: String,
    text: String,
}

/// A number and what half its last digit is.
#[derive(Clone, Copy)]
struct Rounded {
    value: f64,
    half: f64,
}

/// A number that is printed, in SI units.
struct Printed {
    value: Rounded,
    error: Option<Rounded>,
}

/// Names of the entries of a summary by the labels that tables give them.
struct Labels(BTreeMap<String, Vec<String>>);

impl Labels {
    fn of_measures() -> Self {
        let mut all = Self(BTreeMap::new());
        all.add(DECLARED.iter().flat_map(|declaration| declaration.measures));
        all.add(measure::with_errors(PATCH_MEASURES));
        all.add(measure::with_errors(WEB_MEASURES));
        all.add(measure::with_errors(FABRIC_MEASURES));
        all.add(measure::with_errors(FABRIC_PATCH_MEASURES));
        all.add(measure::with_errors(STRIP_MEASURES));
        all.add(measure::with_errors(SPINLINE_MEASURES));
        all.add(measure::with_errors(LOAD_MEASURES));
        all.add(measure::with_errors(LOAD_POSITION_MEASURES));
        all
    }

    fn add<T: 'static>(&mut self, measures: impl Iterator<Item = &'static Measure<T>>) {
        // What is written elsewhere has no entry.
        for measure in measures.filter(|measure| !measure.entry().is_empty()) {
            for label in [Some(measure.label), measure.short].into_iter().flatten() {
                let entry = measure.entry().replace('.', "/");
                self.0.entry(label.to_owned()).or_default().push(format!("/{entry}"));
            }
        }
    }

    /// The entries of which one is printed in a cell; none if it has no label of a measure.
    fn of(&self, row: &str, head: &str) -> Option<&Vec<String>> {
        [head, row].into_iter().filter(|label| !label.is_empty()).find_map(|label| self.0.get(label))
    }
}

/// Holds what is printed against the summary of the same computation.
pub fn printed(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    let out = program.new_place("printed");
    let Some(terminal) = program.printed(drawn, "--out=printed") else { return Outcome::Refused };
    let read = |name: &str| std::fs::read_to_string(out.join(name)).unwrap_or_default();
    let Ok(summary) = serde_json::from_str::<Json>(&read("summary.json")) else {
        return Outcome::Broken("summary.json is no JSON".to_owned());
    };
    let labels = Labels::of_measures();
    for (place, lines) in [("page", of_page(&read("report.html"))), ("terminal", of_terminal(&terminal))] {
        match unlike(&lines, &labels, &summary) {
            Ok(0) => return Outcome::Broken(format!("{place} has no number with an error or a label")),
            Ok(_) => {}
            Err(words) => return Outcome::Broken(format!("{place}: {words}")),
        }
    }
    Outcome::Holds
}

/// How many numbers were compared, or one that is not in the summary.
fn unlike(lines: &Lines, labels: &Labels, summary: &Json) -> Result<usize, String> {
    let numbers = numbers_of(summary);
    let objects = objects_of(summary);
    let mut compared = 0;
    for line in lines {
        let row = line.first().map_or("", |cell| &cell.text);
        for (place, cell) in line.iter().enumerate() {
            let entries = labels.of(if place == 1 { row } else { "" }, &cell.head);
            let unit = match line.get(place + 1) {
                Some(next) if ["", "Unit"].contains(&&*next.head) => next.text.as_str(),
                _ => cell.head.rsplit_once(", ").map_or("", |(_, unit)| unit),
            };
            let mut found = with_errors(&cell.text, unit);
            if found.is_empty() && entries.is_some() {
                found.extend(plain(&cell.text, unit));
            }
            for Printed { value, error } in found {
                compared += 1;
                let is_named = |path: &str| {
                    entries.is_none_or(|names| names.iter().any(|name| path.contains(name.as_str())))
                };
                let is_value = |(path, number): &(String, f64)| is_named(path) && value.is_of(*number);
                let is_there = match error {
                    None => numbers.iter().any(is_value),
                    Some(error) => objects.iter().any(|object: &Vec<(String, f64)>| {
                        object.iter().any(is_value) && object.iter().any(|(_, number)| error.is_of(*number))
                    }),
                };
                if !is_there {
                    let name = if cell.head.is_empty() { row } else { &cell.head };
                    return Err(format!(
                        "\"{}\" of \"{name}\" in \"{row}\" is {:e} in SI units{}, which summary.json does not have{}",
                        cell.text,
                        value.value,
                        error.map(|error| format!(" ± {:e}", error.value)).unwrap_or_default(),
                        entries.map(|names| format!(" as {}", names.join(", "))).unwrap_or_default()
                    ));
                }
            }
        }
    }
    Ok(compared)
}

/// All numbers of a summary in SI units, by their paths.
fn numbers_of(summary: &Json) -> Vec<(String, f64)> {
    let number = |(path, leaf): (String, Json)| Some((path.clone(), in_si(&path, leaf.as_f64()?)));
    leaves(summary).into_iter().filter_map(number).collect()
}

/// The numbers of each object by themselves: a value and its error are in one.
fn objects_of(summary: &Json) -> Vec<Vec<(String, f64)>> {
    fn walk(json: &Json, path: &str, all: &mut Vec<Vec<(String, f64)>>) {
        let own = |entries: &Map<String, Json>| -> Vec<(String, f64)> {
            let number = |(name, entry): (&String, &Json)| {
                let path = format!("{path}/{name}");
                let si = in_si(&path, entry.as_f64()?);
                Some((path, si))
            };
            entries.iter().filter_map(number).collect()
        };
        match json {
            Json::Object(entries) => {
                all.push(own(entries));
                entries.iter().for_each(|(name, entry)| walk(entry, &format!("{path}/{name}"), all));
            }
            Json::Array(entries) => entries.iter().for_each(|entry| walk(entry, path, all)),
            _ => {}
        }
    }
    let mut all = Vec::new();
    walk(summary, "", &mut all);
    all
}

fn in_si(path: &str, number: f64) -> f64 {
    let mut names = path.rsplit('/').filter(|name| name.parse::<u64>().is_err());
    // A mean has the unit in the name above it.
    let name = names.find(|name| name.contains('_') && *name != "standard_error").unwrap_or_default();
    // The weight of 1 % of the patches is no percentage.
    let is_in = |(end, _): &&(&str, &str)| {
        name.strip_suffix(end).is_some_and(|name| !name.ends_with(|letter: char| letter.is_ascii_digit()))
    };
    let unit = OTHER_UNITS.iter().find(is_in);
    unit.map_or(number, |(_, unit)| {
        let Scale { factor, zero } = Scale::of(unit).unwrap_or(Scale::SI);
        if path.ends_with("error") { number * factor } else { number * factor + zero }
    })
}

/// What a unit is in SI units.
#[derive(Clone, Copy)]
struct Scale {
    factor: f64,
    zero: f64,
}

impl Scale {
    const SI: Self = Self { factor: 1.0, zero: 0.0 };

    /// None of words that are no unit.
    fn of(unit: &str) -> Option<Self> {
        match unit {
            _ if unit.starts_with(|letter: char| letter.is_ascii_digit()) || unit.is_empty() => return None,
            "per m²" | "1/m²" => return Some(Self::SI),
            "per cm²" => return Some(Self { factor: 1e4, zero: 0.0 }),
            _ => {}
        }
        let of = |dimension: Dimension| {
            let zero = dimension.parse(&format!("0 {unit}")).ok()?;
            Some(Self { factor: dimension.parse(&format!("1 {unit}")).ok()? - zero, zero })
        };
        DIMENSIONS.into_iter().find_map(of)
    }

    /// That of the first words of a text, of the unit of a column, or SI units.
    fn before(text: &str, column: &str) -> Self {
        let words: Vec<&str> = text
            .split_whitespace()
            .take(2)
            .map(|word| word.trim_end_matches([',', '.', ';', ':', ')']))
            .collect();
        let first = words.first().copied().unwrap_or_default();
        let found = Self::of(&words.join(" ")).or_else(|| Self::of(first));
        found.or_else(|| Self::of(column).filter(|_| text.trim().is_empty())).unwrap_or(Self::SI)
    }
}

impl Rounded {
    /// The number at the beginning of a text, `-0.25` or `1e-9`, and what follows it.
    fn read(text: &str) -> Option<(Self, &str)> {
        let is_of_number = |letter: char| letter.is_ascii_digit() || "+-.e".contains(letter);
        let end = text.find(|letter| !is_of_number(letter)).unwrap_or(text.len());
        let digits = text[..end].trim_end_matches(['.', 'e']);
        let value: f64 = digits.parse().ok()?;
        let (mantissa, power) = digits.split_once('e').unwrap_or((digits, "0"));
        let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let half = 0.5 * 10f64.powi(power.parse::<i32>().ok()? - decimals as i32);
        Some((Self { value, half }, &text[digits.len()..]))
    }

    fn in_si(self, scale: Scale, is_error: bool) -> Self {
        let zero = if is_error { 0.0 } else { scale.zero };
        Self { value: self.value * scale.factor + zero, half: self.half * scale.factor }
    }

    fn is_of(self, number: f64) -> bool {
        (number - self.value).abs() <= self.half * (1.0 + 1e-6) + 1e-9 * number.abs()
    }
}

/// The numbers of a text that have an error.
fn with_errors(text: &str, column: &str) -> Vec<Printed> {
    let mut all = Vec::new();
    for (at, sign) in text.match_indices('±') {
        let before = text[..at].trim_end();
        let begin = before.rfind([' ', '(']).map_or(0, |space| space + 1);
        let value = Rounded::read(before[begin..].trim_start_matches('+'));
        let error = Rounded::read(text[at + sign.len()..].trim_start());
        let (Some((value, "")), Some((error, after))) = (value, error) else { continue };
        // An error has two digits, and a large value ends with it.
        let last_digit = 10f64.powf(error.value.abs().log10().floor() - 1.0);
        let half = |of: Rounded| Rounded { half: of.half.max(0.5 * last_digit), ..of };
        let scale = Scale::before(after, column);
        all.push(Printed {
            value: half(value).in_si(scale, false),
            error: Some(half(error).in_si(scale, true)),
        });
    }
    all
}

/// A cell that is one number with or without a unit.
fn plain(text: &str, column: &str) -> Option<Printed> {
    let text = text.strip_prefix("at most ").unwrap_or(text);
    let (value, unit) = Rounded::read(text)?;
    let is_whole = unit.trim().is_empty() || Scale::of(unit.trim()).is_some();
    is_whole.then(|| Printed {
        value: without_zeros(value).in_si(Scale::before(unit, column), false),
        error: None,
    })
}

/// Zeros at the end of a number without an error may stand for other digits.
fn without_zeros(number: Rounded) -> Rounded {
    let (mut half, mut rest) = (number.half, number.value);
    while half >= 0.5 && rest != 0.0 && rest % 10.0 == 0.0 {
        half *= 10.0;
        rest /= 10.0;
    }
    Rounded { half, ..number }
}

/// With signs that a keyboard has, and numbers as programs write them: `-7.3e-15`.
fn typed(text: &str) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    let text = text.replace(['\u{202f}', '\u{a0}'], " ").replace('−', "-");
    let mut parts = text.split(" × 10");
    let mut typed = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let is_raised = |letter: char| letter == '⁻' || RAISED.contains(&letter);
        let end = part.find(|letter| !is_raised(letter)).unwrap_or(part.len());
        let digit = |letter| RAISED.iter().position(|raised| *raised == letter);
        let power =
            part[..end].chars().map(|letter| digit(letter).map_or("-".to_owned(), |digit| digit.to_string()));
        typed += &format!("e{}{}", power.collect::<String>(), &part[end..]);
    }
    typed
}

/// The tables and sentences of a page.
fn of_page(html: &str) -> Lines {
    let mut lines: Lines = vec![vec![Cell::default()]];
    let mut rest = html;
    while let Some((text, after)) = rest.split_once('<') {
        let (tag, after) = after.split_once('>').unwrap_or((after, ""));
        let name = tag.split([' ', '\n']).next().unwrap_or_default();
        let line = lines.last_mut().expect("a line");
        line.last_mut().expect("a cell").text += text;
        rest = after;
        match name {
            "script" | "style" | "svg" => {
                rest = after.split_once(&format!("</{name}>")).map_or("", |(_, after)| after);
            }
            "td" => {
                let head = tag.split_once("data-head=\"").and_then(|(_, head)| head.split_once('"'));
                line.push(Cell { head: head.map_or("", |(head, _)| head).to_owned(), text: String::new() });
            }
            // What is below the name of a row is no part of it.
            "br" => line.push(Cell { head: "below".to_owned(), text: String::new() }),
            "tr" | "p" | "li" | "h1" | "h2" | "h3" | "dd" | "figcaption" | "summary" => {
                lines.push(vec![Cell::default()])
            }
            _ => {}
        }
    }
    for line in &mut lines {
        line.retain(|cell| cell.head != "below");
        for cell in line {
            for text in [&mut cell.head, &mut cell.text] {
                *text = typed(&text.replace("&#39;", "'").replace("&amp;", "&")).trim().to_owned();
            }
        }
    }
    lines
}

/// The tables and sentences of a terminal, where cells are apart by two spaces at least.
fn of_terminal(text: &str) -> Lines {
    let cell = |text: &str| Cell { text: text.trim().to_owned(), ..Cell::default() };
    let line = |line: &str| {
        typed(line).trim().split("  ").filter(|text| !text.trim().is_empty()).map(cell).collect()
    };
    text.lines().map(line).collect()
}
