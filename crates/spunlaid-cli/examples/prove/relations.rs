//! What holds of every input and its results.

use super::draw::{Base, Drawn};
use super::program::{Program, Said, with_folder};
use serde_json::Value as Json;
use spunlaid::fibre::case::keys::{self, Kind};
use spunlaid::ground::{Dimension, Powers};
use std::collections::BTreeMap;

/// Something that holds whatever the numbers are.
pub struct Relation {
    pub name: &'static str,
    /// Commands of the inputs that it is for; all if empty.
    commands: &'static [&'static str],
    check: fn(&Program, &Drawn, &Json) -> Outcome,
}

/// What became of a relation.
pub enum Outcome {
    Holds,
    /// The program does not compute such an input.
    Refused,
    /// It does not hold: expected and got, in words.
    Broken(String),
}

/// One row for each relation.
pub const RELATIONS: [Relation; 11] = [
    Relation { name: "threads", commands: &["run", "web"], check: threads },
    Relation { name: "in the file", commands: &[], check: in_the_file },
    Relation { name: "units", commands: &[], check: units },
    Relation { name: "order of keys", commands: &[], check: order_of_keys },
    Relation { name: "read again", commands: &[], check: read_again },
    Relation { name: "bounds", commands: &[], check: bounds },
    Relation { name: "similarity", commands: &["run"], check: similarity },
    Relation { name: "mass of a web", commands: &["web"], check: mass_of_a_web },
    Relation { name: "mass of a line", commands: &["spin"], check: mass_of_a_line },
    Relation { name: "files", commands: &[], check: files },
    Relation { name: "seeds", commands: &["run"], check: seeds },
];

/// What may differ between two computations of the same input.
const COSTS: [&str; 3] = ["performance", "notes", "command"];

impl Relation {
    pub fn applies(&self, base: &Base) -> bool {
        self.commands.is_empty() || self.commands.contains(&base.command)
    }

    /// Whether it holds of an input with these results.
    pub fn holds(&self, program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
        (self.check)(program, drawn, results)
    }
}

/// The numbers of results by their paths; `None` of what is no number.
fn leaves(results: &Json) -> BTreeMap<String, Json> {
    fn walk(json: &Json, path: String, all: &mut BTreeMap<String, Json>) {
        match json {
            Json::Object(parts) => {
                let wanted = parts.iter().filter(|(name, _)| !COSTS.contains(&name.as_str()));
                wanted.for_each(|(name, part)| walk(part, format!("{path}/{name}"), all));
            }
            Json::Array(parts) => {
                parts.iter().enumerate().for_each(|(i, part)| walk(part, format!("{path}/{i}"), all));
            }
            leaf => drop(all.insert(path, leaf.clone())),
        }
    }
    let mut all = BTreeMap::new();
    walk(results, String::new(), &mut all);
    all
}

/// The same results, bit by bit.
fn same(wanted: &Json, said: Said, what: &str) -> Outcome {
    let found = match said {
        Said::Results(found) => found,
        Said::Refused(words) => return Outcome::Broken(format!("{what} it is refused: {words}")),
        Said::Failed(words) => return Outcome::Broken(format!("{what}: {words}")),
    };
    let (wanted, found) = (leaves(wanted), leaves(&found));
    let paths = wanted.keys().chain(found.keys());
    let differs = |path: &&String| wanted.get(*path) != found.get(*path);
    match paths.into_iter().find(differs) {
        None => Outcome::Holds,
        Some(path) => Outcome::Broken(format!(
            "{what}: {path} is {:?}, and was {:?}",
            found.get(path).map(ToString::to_string),
            wanted.get(path).map(ToString::to_string)
        )),
    }
}

fn threads(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    same(results, program.computed(drawn, &["--threads=3"]), "on three threads")
}

/// The text of the base with the changes written in it. What they take the place of is left out, as `--set` does.
fn written(drawn: &Drawn) -> Option<String> {
    let mut text = toml_lines::Lines::new(&with_folder(drawn.base.text));
    drawn.changes.iter().all(|(key, value)| text.set(key, value)).then(|| text.text())
}

fn in_the_file(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    // What a key takes the place of stands in the file, where `--set` takes it out.
    let Some(text) = written(drawn) else { return Outcome::Refused };
    match program.computed_text(drawn.base.command, &text, &[]) {
        Said::Refused(_) => Outcome::Refused,
        said => same(results, said, "with its keys in the file"),
    }
}

fn units(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    same(results, program.computed(&drawn.in_si_units(), &[]), "in SI units")
}

fn order_of_keys(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let turned = toml_lines::Lines::new(&with_folder(drawn.base.text)).turned().text();
    let set = drawn.changes.iter().rev().map(|(key, value)| format!("--set={key}={value}"));
    same(
        results,
        program.computed_text(drawn.base.command, &turned, &set.collect::<Vec<_>>()),
        "in another order",
    )
}

/// What is kept of the input gives the same results.
fn read_again(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let out = program.place("kept");
    let _ = std::fs::remove_dir_all(&out);
    match program.computed(drawn, &["--out=kept"]) {
        Said::Results(_) => {}
        Said::Refused(words) | Said::Failed(words) => {
            return Outcome::Broken(format!("with a folder it is refused: {words}"));
        }
    }
    let name = ["case.toml", "web.toml", "spinline.toml"].into_iter().find(|name| out.join(name).exists());
    let Some(text) = name.and_then(|name| std::fs::read_to_string(out.join(name)).ok()) else {
        return Outcome::Broken("keeps no input".to_owned());
    };
    same(results, program.computed_text(drawn.base.command, &text, &[]), "read again")
}

/// One value: what the terminal prints as JSON and what the folder holds.
fn files(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    let out = program.place("filed");
    let _ = std::fs::remove_dir_all(&out);
    let printed = program.computed(drawn, &["--out=filed"]);
    let text = std::fs::read(out.join("summary.json")).unwrap_or_default();
    match serde_json::from_slice(&text) {
        Ok(filed) => match same(results, printed, "printed with a folder") {
            Outcome::Holds => same(results, Said::Results(filed), "in summary.json"),
            broken => broken,
        },
        Err(error) => Outcome::Broken(format!("summary.json: {error}")),
    }
}

/// Shares are between 0 and 1, errors are not negative, an interval holds its value, quantiles are in order.
fn bounds(_: &Program, _: &Drawn, results: &Json) -> Outcome {
    const SHARES: [&str; 5] = ["share", "fraction", "bare_area", "opacity", "_transmission"];
    const NEVER_NEGATIVE: [&str; 7] =
        ["error", "_se", "standard_error", "cv", "amplitude", "diameter", "variance"];
    let all = leaves(results);
    for (path, value) in &all {
        let name = path.rsplit('/').find(|part| part.parse::<u64>().is_err()).unwrap_or_default();
        let parent = path.rsplit('/').nth(1).unwrap_or_default();
        let Some(number) = value.as_f64() else { continue };
        let is_of_input =
            ["/case", "/web/case", "/spinline/influences"].iter().any(|input| path.starts_with(input))
                || path.contains("interval");
        if is_of_input {
            continue;
        }
        let is_change = path.contains("differ") || path.contains("change") || path.contains("over");
        let is_error = NEVER_NEGATIVE.iter().any(|word| name.contains(word));
        if is_error && !is_change && number < 0.0 {
            return Outcome::Broken(format!("{path} is {number}, below zero"));
        }
        let is_share = SHARES.iter().any(|word| name.starts_with(word) || parent.starts_with(word));
        let is_value = name == "mean" || SHARES.iter().any(|word| name.starts_with(word));
        if is_share && is_value && !is_change && !(-1e-9..=1.0 + 1e-9).contains(&number) {
            return Outcome::Broken(format!("{path} is {number}, outside of 0 to 1"));
        }
    }
    for (path, value) in all.iter().filter(|(path, _)| path.ends_with("interval/0")) {
        let stem = path.trim_end_matches("/0");
        let of = stem.trim_end_matches("_interval").trim_end_matches("/interval").to_owned();
        let number = |path: &str| all.get(path).and_then(Json::as_f64);
        let (Some(low), Some(high)) = (value.as_f64(), number(&format!("{stem}/1"))) else { continue };
        let held = number(&of).or_else(|| number(&format!("{of}/value"))).unwrap_or(low);
        if !(low..=high).contains(&held) {
            return Outcome::Broken(format!("{of} is {held}, outside of its interval, {low} to {high}"));
        }
    }
    quantiles(&all)
}

fn quantiles(all: &BTreeMap<String, Json>) -> Outcome {
    for (path, low) in all.iter().filter(|(path, _)| path.contains("weight_of_5_percent")) {
        let ordered = ["weight_of_5_percent", "median_weight", "weight_of_95_percent"];
        let at = |name: &str| all.get(&path.replace(ordered[0], name)).and_then(Json::as_f64);
        let Some(low) = low.as_f64() else { continue };
        let of_all = ordered.map(|name| at(name).unwrap_or(low));
        if path.ends_with(ordered[0]) && !of_all.is_sorted() {
            return Outcome::Broken(format!("{path}: {ordered:?} are {of_all:?}"));
        }
    }
    Outcome::Holds
}

/// Metre, kilogram and second are halved or doubled: the numbers of the input and of the results are others, and the
/// fibre is the same.
fn similarity(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    const SMALLER: [f64; 5] = [2.0, 4.0, 0.5, 1.0, 1.0];
    let out = program.place("similar");
    let _ = std::fs::remove_dir_all(&out);
    let Said::Results(_) = program.computed(drawn, &["--out=similar"]) else { return Outcome::Refused };
    let text = std::fs::read_to_string(out.join("case.toml")).expect("a case");
    let scaled = toml_lines::Lines::new(&text).map(|key, value| {
        let Kind::Quantity(dimension, _) = keys::find(key)?.kind else { return None };
        let si = dimension.parse(value).ok()?;
        Some(dimension.exact(si * Powers::from_dimension(dimension).factor(SMALLER)))
    });
    let said = match program.computed_text(drawn.base.command, &scaled.text(), &[]) {
        Said::Results(found) => found,
        // Where a limit or a usual range is in the way, nothing is compared.
        _ => return Outcome::Refused,
    };
    // Rounding makes another flight where the motion is chaotic, as of what is laid and in air that blows upwards.
    as_likely(results, &said, "in other units", |path| factor_of(path, SMALLER))
}

/// Means differ by no more than their standard errors allow.
///
/// * `factor` – by which each number is larger in the other results; those without one are not compared
fn as_likely(one: &Json, other: &Json, what: &str, factor: impl Fn(&str) -> Option<f64>) -> Outcome {
    /// Errors that a mean of a few replicates has once in ten hours at most: the t distribution of few of them has long
    /// tails, and there are some twenty numbers.
    const FAR: f64 = 25.0;
    let (one, other) = (leaves(one), leaves(other));
    for (path, mean) in one.iter().filter(|(path, _)| path.ends_with("/mean")) {
        let error_path = path.replace("/mean", "/standard_error");
        let number = |of: &BTreeMap<String, Json>, path: &str| of.get(path).and_then(Json::as_f64);
        let Some(factor) = factor(path) else { continue };
        let (Some(a), Some(b)) = (mean.as_f64(), number(&other, path)) else { continue };
        let (Some(of_a), Some(of_b)) = (number(&one, &error_path), number(&other, &error_path)) else {
            continue;
        };
        let (a, of_a) = (a * factor, of_a * factor);
        if (a - b).abs() > FAR * of_a.hypot(of_b) + 1e-9 * a.abs().max(b.abs()) {
            return Outcome::Broken(format!("{path} is {a} ± {of_a}, and {b} ± {of_b} {what}"));
        }
    }
    Outcome::Holds
}

/// By what the number at a path is larger in smaller units; None of what is of the input or has a unit that is not
/// known here.
fn factor_of(path: &str, smaller: [f64; 5]) -> Option<f64> {
    const PARTS: [&str; 6] = ["mean", "error", "standard_error", "median", "largest", "values"];
    const LENGTHS_AND_TIMES: [Dimension; 4] =
        [Dimension::Velocity, Dimension::Length, Dimension::Time, Dimension::Frequency];
    if ["/case", "/turbulence", "/energy"].iter().any(|input| path.starts_with(input)) {
        return None;
    }
    // Of these the last unit is not that of the whole.
    let is_ratio = path.contains("_per_");
    let is_part = |name: &&str| PARTS.contains(name) || name.parse::<u64>().is_ok();
    let name = path.rsplit('/').find(|name| !is_part(name)).filter(|_| !is_ratio)?;
    // A velocity, which ends as a time does, comes first.
    let dimension = LENGTHS_AND_TIMES.into_iter().find(|dimension| name.ends_with(&dimension.suffix()))?;
    Some(Powers::from_dimension(dimension).factor(smaller))
}

/// What is laid in a second is what is fed: the mean weight of each layer is the mass that its filaments bring.
fn mass_of_a_web(_: &Program, _: &Drawn, results: &Json) -> Outcome {
    /// Width of the web of `web.toml` [m].
    const WIDTH: f64 = 0.3;
    for layer in results["layers"].as_array().into_iter().flatten() {
        let of = |name: &str| layer[name].as_f64().unwrap_or(f64::NAN);
        let fed = of("filaments") * of("linear_density_kg_m") * of("feed_speed_m_s");
        let (wanted, found) = (fed / (WIDTH * of("belt_speed_m_s")), of("basis_weight_kg_m2"));
        if (found / wanted - 1.0).abs() > 1e-6 {
            return Outcome::Broken(format!("a layer weighs {found}, and is fed with {wanted} kg/m²"));
        }
    }
    Outcome::Holds
}

/// The mass that passes the end in a second is the throughput of the hole.
fn mass_of_a_line(_: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    /// That of `spinline.toml`.
    const THROUGHPUT: &str = "0.5 g/min";
    let set = drawn.changes.iter().find(|(key, _)| *key == "spinline.throughput");
    let throughput = set.map_or(THROUGHPUT, |(_, value)| value);
    let wanted = Dimension::MassFlow.parse(throughput).expect("a throughput");
    let of = |name: &str| results["spinline"][name].as_f64();
    let Some((titre, speed)) = of("linear_density_kg_m").zip(of("final_speed_m_s")) else {
        return Outcome::Refused;
    };
    let found = titre * speed;
    match (found / wanted - 1.0).abs() < 1e-6 {
        true => Outcome::Holds,
        false => Outcome::Broken(format!("{found} kg/s pass the end, and {wanted} kg/s the hole")),
    }
}

/// Another seed gives the same means within their errors.
fn seeds(program: &Program, drawn: &Drawn, results: &Json) -> Outcome {
    if drawn.changes.iter().any(|(key, _)| *key == "run.seed") {
        return Outcome::Refused;
    }
    match program.computed(drawn, &["--set=run.seed=77"]) {
        Said::Results(other) => as_likely(results, &other, "with another seed", |_| Some(1.0)),
        _ => Outcome::Refused,
    }
}

/// The lines of a file by their tables.
mod toml_lines {
    /// Tables with their lines, in order.
    pub struct Lines(Vec<(String, Vec<String>)>);

    impl Lines {
        pub fn new(text: &str) -> Self {
            let mut tables: Vec<(String, Vec<String>)> = vec![(String::new(), Vec::new())];
            for line in text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'))
            {
                match line.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
                    Some(name) => tables.push((name.to_owned(), Vec::new())),
                    None => tables.last_mut().expect("a table").1.push(line.to_owned()),
                }
            }
            Self(tables)
        }

        /// Writes a key; false if it is of a table within another.
        pub fn set(&mut self, key: &str, value: &str) -> bool {
            let Some((table, name)) = key.split_once('.').filter(|(_, name)| !name.contains('.')) else {
                return false;
            };
            let is_plain = value.parse::<f64>().is_ok() || ["true", "false"].contains(&value);
            let line = if is_plain { format!("{name} = {value}") } else { format!("{name} = \"{value}\"") };
            if !self.0.iter().any(|(own, _)| own == table) {
                self.0.push((table.to_owned(), Vec::new()));
            }
            let (_, lines) = self.0.iter_mut().find(|(own, _)| own == table).expect("a table");
            lines.retain(|line| line.split('=').next().is_none_or(|own| own.trim() != name));
            lines.push(line);
            true
        }

        /// With other values of some keys, from their full names and their values without quotation marks.
        pub fn map(&self, other: impl Fn(&str, &str) -> Option<String>) -> Self {
            let line = |table: &str, line: &str| {
                let (name, value) = line.split_once('=')?;
                let other = other(&format!("{table}.{}", name.trim()), value.trim().trim_matches('"'))?;
                Some(format!("{name}= \"{other}\""))
            };
            let table = |(name, lines): &(String, Vec<String>)| {
                let lines = lines.iter().map(|own| line(name, own).unwrap_or_else(|| own.clone()));
                (name.clone(), lines.collect())
            };
            Self(self.0.iter().map(table).collect())
        }

        /// The tables in another order, and their lines too. The first has no name and stays.
        pub fn turned(mut self) -> Self {
            self.0[1..].reverse();
            self.0.iter_mut().for_each(|(_, lines)| lines.reverse());
            self
        }

        pub fn text(&self) -> String {
            let table = |(name, lines): &(String, Vec<String>)| {
                let head = if name.is_empty() { String::new() } else { format!("[{name}]\n") };
                head + &lines.join("\n") + "\n"
            };
            self.0.iter().map(table).collect()
        }
    }
}
