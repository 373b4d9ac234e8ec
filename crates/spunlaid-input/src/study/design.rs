//! The design of a study: which keys vary, and how many points they make.

use super::super::document::Named;
use super::super::entry::{Entry, kind};
use super::{Base, MOST_FIBRES, MOST_POINTS_UNASKED, Reader, not_varied, not_written};
use spunlaid_experiment::{
    Design, Factor, Levels, MOST_POINTS, Quantity, RANGE, Replicates, Spacing, Statement, Study, StudyClaim,
    Trend,
};
use spunlaid_fibre::case::keys::{Kind, Relative, Value, VariedKey};
use spunlaid_ground::error::nearest_word;
use spunlaid_ground::{Diagnostic, Fault};
use std::path::Path;
use toml::de::{DeTable, DeValue};

impl<'a> Reader<'a> {
    pub(super) fn design(&mut self) -> Design {
        let points = self.key_values.integer("points");
        let name = self.key_values.text("design").unwrap_or_default();
        let all = Design::all(points.unwrap_or(1)).into_iter();
        // One that is unknown or missing has been noted.
        let Some(design) = all.into_iter().find(|design| design.name() == name) else { return Design::Grid };
        let is_given = self.key_values.get("points").is_some() || self.key_values.is_excused("points");
        let fault = match (design.draws(), is_given) {
            (true, false) => Fault::missing("", "points = 64, the number of points of the design"),
            (false, true) => Fault::new(
                format!("does not fit design = \"{name}\", whose number of points follows from its values"),
                "leave it out",
            ),
            _ => return design,
        };
        self.key_values.reject("points", fault);
        design
    }

    /// The key that is named; `None` if a study cannot vary it or it is one of some others, after noting the problem.
    pub(super) fn varied(
        &mut self,
        base: &dyn Base,
        named: &Named<'a, Study>,
        others: &[&str],
    ) -> Option<VariedKey> {
        let Named { name, entry, .. } = named;
        match base.varied(name) {
            Ok(key) if others.contains(&&*key.name) => {
                let (place, value) = (entry.place.clone(), None);
                let what = Fault::duplicate(name);
                self.key_values.problems.push(Diagnostic { place, value, ..what.into() });
                None
            }
            key => key.map_err(|advice| self.reject(name, entry, not_varied(advice))).ok(),
        }
    }

    /// The keys that vary.
    pub(super) fn factors(&mut self, design: Design, base: &dyn Base) -> Vec<Factor> {
        let mut factors: Vec<Factor> = Vec::new();
        for named in self.named("vary") {
            let keys: Vec<&str> = factors.iter().map(|factor| &*factor.key.name).collect();
            let Some(varied) = self.varied(base, &named, &keys) else { continue };
            let varied = self.with_files(varied, &named.entry);
            let before = base.value(&varied);
            if let Some(levels) = self.levels(&varied, before, named, design) {
                factors.push(Factor { key: varied, levels });
            }
        }
        factors
    }

    /// The same key, which also takes the files in the list of its values.
    fn with_files(&self, varied: VariedKey, entry: &Entry<'a>) -> VariedKey {
        let (Kind::File(kind), DeValue::Array(list)) = (varied.kind, &entry.value) else { return varied };
        let texts = list.iter().filter_map(|one| one.get_ref().as_str());
        let files = texts.filter(|text| !text.is_empty() && !kind.is_word(text));
        files.fold(varied, |varied, text| varied.or_file(&self.beside(&entry.place, text)))
    }

    /// Checks the factors together.
    ///
    /// * `base` – values of the factors before they vary; NaN for none
    pub(super) fn combination(&mut self, design: Design, factors: &[Factor], base: &[f64]) {
        if let (Design::Paired, Some(first)) = (design, factors.first()) {
            let wanted = first.levels.count();
            for factor in factors.iter().filter(|factor| factor.levels.count() != wanted) {
                let found = factor.levels.count();
                let fault = Fault::new(
                    format!("has {found} values, but \"{}\" has {wanted}", first.key.name),
                    "paired lists must have the same length",
                );
                self.key_values.reject(&factor.key.name, fault);
            }
        }
        if design == Design::OneAtATime {
            for (factor, base) in factors.iter().zip(base) {
                if base.is_nan() {
                    self.key_values.reject(&factor.key.name, not_written("vary it around this value"));
                }
            }
        }
    }

    /// Checks the number of points, and that of fibres.
    pub(super) fn size(&mut self, count: f64, asked: Option<u64>, replicates: u64) {
        let exact = count as u64;
        if count > MOST_POINTS as f64 {
            let points = if count < 1e15 { exact.to_string() } else { format!("{count:.1e}") };
            let advice = format!(
                "at most {MOST_POINTS} are possible: vary fewer keys or values, or write design = \"latin-hypercube\""
            );
            self.key_values.reject("design", too_many_points(&points, advice));
        } else if let Some(asked) = asked.filter(|asked| *asked != exact) {
            let fault = Fault::new(
                format!("makes {exact} points, but {asked} were requested"),
                format!("request {exact} points"),
            );
            self.key_values.reject("design", fault.option("--points"));
        } else if exact > MOST_POINTS_UNASKED && asked.is_none() {
            let advice = format!("request {exact} points by this number");
            self.key_values.reject("design", too_many_points(&exact.to_string(), advice));
        }
        let fibres = count * replicates as f64;
        if fibres > MOST_FIBRES as f64 && count <= MOST_POINTS as f64 {
            let most = MOST_FIBRES as f64;
            let fault = Fault::new(
                format!("needs {fibres:.1e} fibres in total; at most {most:e} are possible"),
                "reduce the replicates or the points",
            );
            self.key_values.reject("design", fault);
        }
    }
}

/// The fault of a design of more points than are simulated without a request.
fn too_many_points(points: &str, remedy: String) -> Fault {
    let message =
        format!("makes {points} points; more than {MOST_POINTS_UNASKED} must be requested by their number");
    Fault::new(message, remedy).option("--points")
}

/// Whole numbers up to this one are the same as floating-point numbers.
const LARGEST_WHOLE: u64 = 1 << 50;

impl<'a> Reader<'a> {
    /// The values of a factor; `None` if they cannot be read, after noting the problems.
    ///
    /// * `before` – the value before it varies; None if it has none
    pub(super) fn levels(
        &mut self,
        varied: &VariedKey,
        before: Option<f64>,
        named: Named<'a, Study>,
        design: Design,
    ) -> Option<Levels> {
        let Named { row, mut entry, .. } = named;
        let words = varied.words();
        let fault = match std::mem::replace(&mut entry.value, DeValue::Boolean(true)) {
            DeValue::Array(list) if list.is_empty() => Fault::new(
                "has no values",
                "list some, as in [\"5 m/s\", \"10 m/s\"], or write { from, to, steps }",
            ),
            DeValue::Array(list) => {
                let level = |value: toml::Spanned<DeValue<'a>>| {
                    let entry = self.entry(value.span().start, value, None);
                    self.level(varied, before, &varied.name, &entry)
                };
                // All of them are looked at.
                let levels: Vec<Option<f64>> = list.into_iter().map(level).collect();
                return levels.into_iter().collect::<Option<_>>().map(Levels::List);
            }
            DeValue::Table(_) if !words.is_empty() => {
                let words: Vec<String> = words.iter().take(2).map(|word| format!("\"{word}\"")).collect();
                let remedy = format!("list them, as in [{}]", words.join(", "));
                Fault::new("takes words, which have no range", remedy)
            }
            DeValue::Table(table) => return self.range(varied, before, &entry, table, design),
            other => Fault::wrong_type(kind(&other), row.kind.wanted()),
        };
        self.reject(&varied.name, &entry, fault);
        None
    }

    /// A value of a key that varies as a number, which may be given by its change.
    fn level(
        &mut self,
        varied: &VariedKey,
        before: Option<f64>,
        name: &str,
        entry: &Entry<'_>,
    ) -> Option<f64> {
        let words = varied.words();
        let is_it = |text: &str| {
            let path = self.beside(&entry.place, text);
            words.iter().position(|one| *one == text || Path::new(one) == path)
        };
        let word = entry.value.as_str().and_then(is_it);
        let read = match (word, entry.value.as_str()) {
            (Some(place), _) => Ok(place as f64),
            (None, Some(other)) if !words.is_empty() => {
                Err(Fault::not_one_of(nearest_word(other, words.iter().copied()), &words))
            }
            (_, text) => self.value_or_change(varied, before, entry, text).and_then(|value| match value {
                Value::Whole(number) if number > LARGEST_WHOLE => Err(Fault::out_of_range(1, LARGEST_WHOLE)),
                value => varied.number(&value).ok_or_else(|| Fault::not_one_of(None, &words)),
            }),
        };
        read.map_err(|fault| self.reject(name, entry, fault)).ok()
    }

    fn value_or_change(
        &self,
        varied: &VariedKey,
        before: Option<f64>,
        entry: &Entry<'_>,
        text: Option<&str>,
    ) -> Result<Value, Fault> {
        match Relative::read(&varied.kind, text.unwrap_or_default())? {
            Some(change) => change.of(before, &varied.kind, "write the values themselves".to_owned()),
            None => self.as_kind(&varied.kind, entry),
        }
    }

    fn range(
        &mut self,
        varied: &VariedKey,
        before: Option<f64>,
        whole: &Entry<'a>,
        table: DeTable<'a>,
        design: Design,
    ) -> Option<Levels> {
        let name = |key: &str| format!("{}.{key}", varied.name);
        let problems = self.problems();
        self.take_table(&name(""), RANGE, table, None);
        self.reject_unreadable();
        let mut ends = [None; 2];
        for Named { row, name, entry } in self.named(RANGE) {
            ends[usize::from(row.short() == "to")] = self.level(varied, before, &name, &entry);
        }
        if self.problems() > problems {
            return None;
        }
        let [Some(from), Some(to)] = ends else {
            let missing = [("from", "first"), ("to", "last")].into_iter().zip(ends);
            for ((key, which), _) in missing.filter(|(_, end)| end.is_none()) {
                let what = Fault::missing("", &format!("{key} = with the {which} value"));
                let (place, key) = (whole.place.clone(), name(key));
                self.key_values.problems.push(Diagnostic { place, key, ..what.into() });
            }
            return None;
        };
        let steps = self.key_values.integer(&name("steps"));
        let is_log = self.key_values.text(&name("spacing")).as_deref() == Some(Spacing::Logarithmic.name());
        let spacing = if is_log { Spacing::Logarithmic } else { Spacing::Linear };
        let name = design.name();
        let fault = match steps {
            None if !design.draws() => Fault::new(
                format!("has no steps, which design = \"{name}\" needs"),
                "add steps = 5, or list the values",
            ),
            Some(_) if design.draws() => Fault::new(
                format!("has steps, but design = \"{name}\" draws its values from the range"),
                "leave steps out",
            ),
            _ if from == to => {
                Fault::new("has two equal ends", "write two different ends, or a list of one value")
            }
            _ if spacing == Spacing::Logarithmic && (from <= 0.0 || to <= 0.0) => Fault::new(
                "has logarithmic spacing, which needs both ends above zero",
                "write spacing = \"linear\"",
            ),
            _ => return Some(Levels::Range { from, to, steps, spacing }),
        };
        self.reject(&varied.name, whole, fault);
        None
    }
}

impl Reader<'_> {
    pub(super) fn replicates(&mut self, base: &dyn Base) -> Replicates {
        let until = self.until(base);
        if until.is_empty() && !self.key_values.has_table("replicates") {
            let written = self.key_values.integer("replicates");
            return Replicates::fixed(written.unwrap_or(base.seed_and_replicates().1));
        }
        if until.is_empty() && self.problems() == 0 {
            let line =
                "until = { amplitude_y = \"5 %\" } (the wanted standard error as a fraction of the mean)";
            self.key_values.reject("replicates.until", Fault::missing("replicates", line));
        }
        let most = self.value("replicates.at_most").and_then(|most| most.number());
        let at_most = most.map_or(u64::MAX, |most| most as u64);
        let at_least = self.key_values.integer("replicates.at_least").unwrap_or_else(|| at_most.min(8));
        if at_least > at_most {
            let fault = Fault::new(format!("is larger than at_most = {at_most}"), "lower it");
            self.key_values.reject("replicates.at_least", fault);
        }
        Replicates { at_least, at_most, until }
    }

    fn until(&mut self, base: &dyn Base) -> Vec<(usize, f64)> {
        let (mut until, quantities) = (Vec::new(), base.quantities());
        for Named { row, name, entry } in self.named("replicates.until") {
            let measure = quantities.iter().position(|quantity| quantity.name == name).ok_or_else(|| {
                let names: Vec<&str> = quantities.iter().map(|quantity| &*quantity.name).collect();
                let nearest = nearest_word(&name, names.iter().copied()).map(ToOwned::to_owned);
                Fault::unknown("is not the name of a result", nearest, "the results are", &names)
            });
            let fraction = || match self.as_kind(&row.kind, &entry)?.number() {
                Some(fraction) if fraction < 1.0 => Ok(fraction),
                _ => Err(Fault::new(
                    "is not a fraction of the mean",
                    "write a number between 0 and 1, like 0.05 or \"5 %\"",
                )),
            };
            match measure.and_then(|measure| Ok((measure, fraction()?))) {
                Ok(wanted) => until.push(wanted),
                Err(fault) => self.reject(&format!("replicates.until.{name}"), &entry, fault),
            }
        }
        until
    }
}

const FORM: &str =
    "write `RESULT: KEY > 5 * OTHER KEY`, `RESULT: KEY rises`, `RESULT: KEY falls` or `RESULT: KEY turns`";

impl Reader<'_> {
    /// The claims. Those that cannot be judged are noted as problems.
    pub(super) fn claims(&mut self, factors: &[Factor], quantities: &[Quantity]) -> Vec<StudyClaim> {
        let mut claims = Vec::new();
        for Named { row, name, entry } in self.named("claims") {
            let claim = self.as_kind(&row.kind, &entry).and_then(|_| {
                let text = entry.value.as_str().unwrap_or_default().trim().to_owned();
                let (result, statement) = read(&text, factors, quantities)?;
                Ok(StudyClaim { sentence: name.clone(), text, result, statement })
            });
            match claim {
                Ok(claim) => claims.push(claim),
                Err(fault) => self.reject(&format!("claims.{name:?}"), &entry, fault),
            }
        }
        claims
    }
}

/// Reads what is claimed: the name of the result, and the statement.
fn read(text: &str, factors: &[Factor], quantities: &[Quantity]) -> Result<(String, Statement), Fault> {
    let (result, said) = text.split_once(':').ok_or_else(|| Fault::new("names no result", FORM))?;
    let result = result.trim();
    if !quantities.iter().any(|quantity| quantity.name == result) {
        return Err(unknown("is not the name of a result", "the results are", result, &names_of(quantities)));
    }
    let keys: Vec<&str> = factors.iter().map(|factor| &*factor.key.name).collect();
    let factor = |key: &str| {
        let found = keys.iter().position(|name| *name == key.trim());
        let unknown = || unknown("names a key that does not vary here", "the keys are", key.trim(), &keys);
        let index = found.ok_or_else(unknown)?;
        match factors[index].key.words().is_empty() {
            true => Ok(index),
            false => Err(Fault::new("names a key of words, which have no order", "name a key of numbers")),
        }
    };
    let statement = match said.split_once('>') {
        Some((more, less)) => {
            let (times, less) = less.split_once('*').unwrap_or(("1", less));
            let times = times.trim().parse::<f64>().ok().filter(|times| times.is_finite() && *times > 0.0);
            let times = times.ok_or_else(|| Fault::new("has no number above zero before `*`", FORM))?;
            Statement::Matters { more: factor(more)?, times, less: factor(less)? }
        }
        None => {
            let said = said.trim();
            let found =
                Trend::ALL.into_iter().find_map(|trend| Some((said.strip_suffix(trend.name())?, trend)));
            let (key, trend) =
                found.ok_or_else(|| Fault::new("contains nothing that can be judged", FORM))?;
            Statement::Follows(factor(key)?, trend)
        }
    };
    Ok((result.to_owned(), statement))
}

fn names_of(quantities: &[Quantity]) -> Vec<&str> {
    quantities.iter().map(|quantity| &*quantity.name).collect()
}

fn unknown(what: &'static str, all: &'static str, name: &str, names: &[&str]) -> Fault {
    Fault::unknown(what, nearest_word(name, names.iter().copied()).map(ToOwned::to_owned), all, names)
}
