//! Inputs drawn at random: a small file of each kind, and values for some of the keys that its table has. A key that is
//! new in the table is drawn from the day it is there.

use super::lines::Lines;
use spunlaid_fibre::case::keys::{self, Kind, Omission, Sign};
use spunlaid_ground::Dimension;
use spunlaid_ground::random::{stream, uniform};
use spunlaid_input::WEB_KEYS;
use std::collections::BTreeSet;

/// Keeps the random numbers of this program apart from all others.
const KEY: u64 = 0x65766f7270;
/// Most keys that are changed in an input.
const MOST: usize = 5;
/// A quantity without a slider lies within this factor of the middle of its usual range.
const NEAR: f64 = 5.0;
/// How many of the numbers are the smallest or the largest of their range.
const AT_ENDS: f64 = 0.25;
/// Layers of a base that has some.
const LAYERS: usize = 2;

/// A file that keys are changed in.
pub struct Base {
    /// The name of its file.
    pub name: &'static str,
    /// The command that computes it.
    pub command: &'static str,
    pub text: &'static str,
    /// Tables of the keys that are drawn.
    tables: &'static [&'static str],
    /// How often it is drawn, relative to the others.
    pub weight: f64,
}

/// Small enough for some tenths of a second each, and some seconds where filaments fly. `CASES` stands for the folder
/// of the cases.
pub const BASES: [Base; 11] = [
    base("fixed", "run", include_str!("fixed.toml"), OF_FIBRES, 3.0),
    base("field", "run", include_str!("field.toml"), OF_FIBRES, 1.0),
    base("record", "run", include_str!("record.toml"), OF_FIBRES, 1.0),
    base("fed", "run", include_str!("fed.toml"), &["fibre", "air", "drag", "feed", "belt", "run"], 2.0),
    base("web", "web", include_str!("web.toml"), WEB_MEASURES, 3.0),
    base("layers", "web", include_str!("layers.toml"), WEB_MEASURES, 2.0),
    base(
        "simulated",
        "web",
        include_str!("simulated.toml"),
        &["fibre", "air", "drag", "belt", "line", "web", "fabric"],
        1.5,
    ),
    base(
        "places",
        "web",
        include_str!("places.toml"),
        &["fibre", "air", "drag", "belt", "web", "fabric"],
        1.5,
    ),
    base(
        "in_field",
        "web",
        include_str!("in_field.toml"),
        &["fibre", "air", "drag", "belt", "line", "web", "fabric"],
        0.7,
    ),
    base("spinline", "spin", include_str!("spinline.toml"), OF_LINES, 2.0),
    base("yarn", "spin", include_str!("yarn.toml"), OF_LINES, 2.0),
];

const OF_FIBRES: &[&str] = &["fibre", "air", "drag", "run"];
const WEB_MEASURES: &[&str] = &["fibre", "laydown", "line", "web", "fabric"];
const OF_LINES: &[&str] = &["spinline", "drag"];

const fn base(
    name: &'static str,
    command: &'static str,
    text: &'static str,
    tables: &'static [&'static str],
    weight: f64,
) -> Base {
    Base { name, command, text, tables, weight }
}

/// What decides how long a computation takes or how much memory it may have, and is no number of the line.
const FIXED: [&str; 20] = [
    "run.duration",
    "run.time_step",
    "run.replicates",
    "run.output_interval",
    "run.shapes",
    "run.checks",
    "run.error_tolerance",
    "run.spin_up",
    "run.seed",
    "fibre.element_length",
    "air.harmonics",
    "air.lateral",
    "web.width",
    "web.length",
    "web.cell",
    "web.error",
    "web.time",
    "web.memory_limit",
    "web.window",
    "web.simulated",
];

/// Random numbers of a draw.
pub struct Random(Box<dyn FnMut() -> f64>);

impl Random {
    pub fn new(seed: u64, number: u64) -> Self {
        let mut random = stream([KEY, seed, number, 0]);
        Self(Box::new(move || uniform(&mut random)))
    }

    pub fn below(&mut self, count: usize) -> usize {
        ((self.0)() * count as f64) as usize
    }

    /// The position of one of several, by their weights.
    pub fn weighted(&mut self, weights: &[f64]) -> usize {
        let mut left = (self.0)() * weights.iter().sum::<f64>();
        let is_here = |weight: &f64| {
            left -= weight;
            left < 0.0
        };
        weights.iter().position(is_here).unwrap_or(0)
    }

    /// True with this probability.
    pub fn is_within(&mut self, share: f64) -> bool {
        (self.0)() < share
    }

    /// An end, where faults are more often than elsewhere, or any number in between, evenly in the logarithm.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        match self.is_within(AT_ENDS) {
            true => [low, high][self.below(2)],
            false => low * (high / low).powf((self.0)()),
        }
    }
}

/// A value of a key, as they stand after `--set`.
#[derive(Clone, Debug)]
pub struct Change {
    pub key: String,
    pub value: String,
}

impl Change {
    pub fn new(key: &str, value: impl Into<String>) -> Self {
        Self { key: key.to_owned(), value: value.into() }
    }
}

/// An input: a base with values of some keys.
#[derive(Clone)]
pub struct Drawn {
    pub base: &'static Base,
    pub changes: Vec<Change>,
    /// A number of its own, from which relations draw.
    pub number: u64,
}

/// What is drawn of a key.
struct Drawable {
    name: &'static str,
    kind: Kind,
    omission: Omission,
    slider: Option<(f64, f64)>,
    usual: Option<(f64, f64)>,
}

impl Drawn {
    pub fn new(base: &'static Base, number: u64, random: &mut Random) -> Self {
        let all = drawable(base);
        // Each input has random numbers of its own, or what is the same in many would count many times.
        let mut changes: Vec<Change> = base.seeds(number);
        for _ in 0..random.below(MOST + 1) {
            let key = &all[random.below(all.len())];
            let place = base.place(key.name, random);
            if let Some(value) = key.value(base, random)
                && changes.iter().all(|change| change.key != place)
            {
                changes.push(Change { key: place, value });
            }
        }
        Self { base, changes, number }
    }

    /// Random numbers that belong to this input.
    pub fn random(&self) -> Random {
        Random::new(self.number, u64::MAX)
    }

    /// The value that a key has been given.
    pub fn value(&self, key: &str) -> Option<&str> {
        self.changes.iter().find(|change| change.key == key).map(|change| change.value.as_str())
    }

    /// With further values, which take the place of those that the same keys have.
    pub fn with(&self, more: &[Change]) -> Self {
        let mut other = self.clone();
        other.changes.retain(|own| more.iter().all(|change| change.key != own.key));
        other.changes.extend_from_slice(more);
        other
    }

    /// With other values of some keys.
    pub fn map(&self, other: impl Fn(&Change) -> Change) -> Self {
        Self { changes: self.changes.iter().map(other).collect(), ..self.clone() }
    }

    /// The same values in SI units, `40e-6 m` in place of `40 µm`.
    pub fn in_si_units(&self) -> Self {
        let all = drawable(self.base);
        self.map(|Change { key, value }| {
            let kind = all.iter().find(|own| own.name == unplaced(key)).map(|own| own.kind);
            let value = match kind {
                Some(Kind::Quantity(dimension, _)) => dimension.parse(value).map(|si| dimension.exact(si)),
                _ => Ok(value.clone()),
            };
            Change { key: key.clone(), value: value.expect("a value that was written") }
        })
    }

    /// Values of keys that have a default, each the default.
    pub fn defaults(&self) -> Vec<Change> {
        let all = drawable(self.base)
            .into_iter()
            .filter(|key| !key.name[key.name.find('.').unwrap_or(0) + 1..].contains('.'));
        let default = |key: Drawable| match key.omission {
            Omission::Value(text) => Some(Change::new(&self.base.place(key.name, &mut self.random()), text)),
            _ => None,
        };
        let base = Lines::new(self.base.text);
        // A fed fibre has another default.
        let is_fed = self.base.tables.contains(&"belt");
        let is_written = |key: &str| {
            (is_fed && key == "air.eddies")
                || self.value(key).is_some()
                || key.split_once('.').is_some_and(|(table, name)| base.value(table, name).is_some())
        };
        all.filter_map(default).filter(|change| !is_written(&change.key)).collect()
    }

    /// Quantities that are zero or not there if they are left out, far below what is usual.
    pub fn next_to_nothing(&self) -> Vec<Change> {
        let is_none = |key: &Drawable| matches!(key.omission, Omission::Follows(text) if text == "none");
        let small = |key: Drawable| match (key.kind, key.usual) {
            (Kind::Quantity(dimension, _), Some((low, _))) => {
                Some(Change::new(&self.base.place(key.name, &mut self.random()), dimension.exact(1e-9 * low)))
            }
            _ => None,
        };
        drawable(self.base).into_iter().filter(is_none).filter_map(small).collect()
    }

    /// The commands that show a finding.
    pub fn command(&self) -> String {
        let set = |Change { key, value }: &Change| format!(" --set '{key}={value}'");
        let set: String = self.changes.iter().map(set).collect();
        format!(
            "spunlaid {} crates/spunlaid-cli/examples/prove/{}.toml{set}",
            self.base.command, self.base.name
        )
    }
}

impl Base {
    /// This input as it is.
    pub fn unchanged(&'static self) -> Drawn {
        Drawn { base: self, changes: Vec::new(), number: 0 }
    }

    pub fn has_layers(&self) -> bool {
        self.text.contains("[[layer]]")
    }

    /// Whether its filaments fly in shared turbulence.
    pub fn flies_in_one_air(&self) -> bool {
        self.command == "web" && self.text.contains("[air]")
    }

    /// Values of the keys of its random numbers.
    pub fn seeds(&self, seed: u64) -> Vec<Change> {
        let keys: &[&str] = match self.command {
            "web" if self.flies_in_one_air() => &["run.seed", "web.seed"],
            "web" => &["web.seed"],
            "run" => &["run.seed"],
            _ => &[],
        };
        keys.iter().map(|key| Change::new(key, seed.to_string())).collect()
    }

    /// The number that a key has in this file.
    fn number(&self, name: &str) -> Option<f64> {
        self.value(name)?.parse().ok()
    }

    fn quantity(&self, name: &str, dimension: Dimension) -> Option<f64> {
        dimension.parse(&self.value(name)?).ok()
    }

    fn value(&self, name: &str) -> Option<String> {
        let (table, name) = name.rsplit_once('.')?;
        let lines = Lines::new(self.text);
        lines.value(table, name).or_else(|| lines.value(&format!("layer.{table}"), name))
    }

    /// The full name of a key in this file, with the numbers of its layer and of its entry in a list.
    fn place(&self, name: &str, random: &mut Random) -> String {
        let (table, rest) = name.split_once('.').expect("a table");
        let entry = rest.split_once('.').filter(|(list, _)| self.text.contains(&format!("{list} = [")));
        let name = match entry {
            Some((list, rest)) => format!("{table}.{list}.{}.{rest}", 1 + random.below(LAYERS)),
            None => name.to_owned(),
        };
        match self.has_layers() && ["laydown", "line"].contains(&table) {
            true if entry.is_some() => format!("layer.1.{name}"),
            true => format!("layer.{}.{name}", 1 + random.below(LAYERS)),
            false => name,
        }
    }
}

/// Keys of cases and webs that some input draws, and those that none does: files, texts and lists, and what decides how
/// long a computation takes.
pub fn drawn_keys() -> [Vec<&'static str>; 2] {
    let mut random = Random::new(0, 0);
    let mut of_bases: Vec<&str> = Vec::new();
    for base in &BASES {
        let has_value = |key: &Drawable| key.value(base, &mut random).is_some();
        of_bases.extend(drawable(base).into_iter().filter(has_value).map(|key| key.name));
    }
    let all = keys::all().iter().map(|key| key.name).chain(WEB_KEYS.iter().map(|key| key.name));
    let all: BTreeSet<&str> = all.collect();
    let (drawn, others) = all.into_iter().partition(|name| of_bases.contains(name));
    [drawn, others]
}

/// The name of a key in its table, without numbers of layers and entries.
fn unplaced(key: &str) -> String {
    let parts = key.split('.').filter(|part| *part != "layer" && part.parse::<u32>().is_err());
    parts.collect::<Vec<_>>().join(".")
}

fn drawable(base: &Base) -> Vec<Drawable> {
    macro_rules! drawable {
        ($keys:expr) => {
            $keys.iter().map(|key| Drawable {
                name: key.name,
                kind: key.kind,
                omission: key.omission,
                slider: key.slider,
                usual: key.usual,
            })
        };
    }
    let of_case = drawable!(keys::all());
    let of_web = drawable!(WEB_KEYS);
    // A list that a base does not have cannot be set in it.
    let is_there = |name: &str| {
        let list =
            name.split('.').nth(1).filter(|_| name.starts_with("line.") && name.matches('.').count() == 2);
        list.is_none_or(|list| base.text.contains(&format!("{list} = [")))
    };
    let is_of_base = |name: &str| {
        name.split_once('.').is_some_and(|(table, _)| base.tables.contains(&table))
            && !FIXED.iter().any(|fixed| name.starts_with(fixed))
            && is_there(name)
    };
    let mut all: Vec<Drawable> = if base.command == "web" { of_web.collect() } else { Vec::new() };
    let more: Vec<Drawable> = of_case.filter(|key| all.iter().all(|own| own.name != key.name)).collect();
    all.extend(more);
    all.retain(|key| is_of_base(key.name));
    all
}

impl Drawable {
    /// A value; None of a kind that names files or lists.
    fn value(&self, base: &Base, random: &mut Random) -> Option<String> {
        Some(match self.kind {
            Kind::Quantity(dimension, sign) => {
                // A key whose range is that of another one lies near the value of the file.
                let own = || base.quantity(self.name, dimension).map(|own| (own / NEAR, own * NEAR));
                let (low, high) = match (self.slider, self.usual) {
                    (Some(ends), _) => ends,
                    (None, Some((low, high))) => {
                        let middle = (low.max(1e-12) * high).sqrt();
                        (low.max(middle / NEAR), high.min(middle * NEAR))
                    }
                    (None, None) => own()?,
                };
                let low = if low > 0.0 { low } else { high / (NEAR * NEAR) };
                let value = random.between(low, high);
                let is_turned = sign == Sign::Any && random.below(4) == 0;
                rounded(dimension, if is_turned { -value } else { value })
            }
            Kind::Whole(least, most) => match base.number(self.name) {
                // A count lies near that of the file.
                Some(own) => whole(random.between(own / NEAR, own * NEAR)).to_string(),
                None => (least + random.below(most.min(least + 20) as usize) as u64).to_string(),
            },
            Kind::Switch => ["true", "false"][random.below(2)].to_owned(),
            // A law of the drag may come from a file too.
            Kind::File(_) if !self.name.starts_with("drag.") => return None,
            Kind::Choice(_) | Kind::File(_) => {
                let names = self.kind.words();
                names[random.below(names.len())].to_owned()
            }
            _ => return None,
        })
    }
}

/// A count of which a half is whole too, also that on a tenth of a metre.
fn whole(value: f64) -> u64 {
    20 * (value / 20.0).round().max(1.0) as u64
}

/// A value of few digits with its unit, as people write it.
fn rounded(dimension: Dimension, value: f64) -> String {
    dimension.pretty_to(value, 3)
}
