//! Inputs drawn at random: a small file of each kind, and values for some of the keys that its table has. A key that is
//! new in the table is drawn from the day it is there.

use spunlaid::fibre::case::keys::{self, Kind, Sign};
use spunlaid::ground::Dimension;
use spunlaid::ground::random::{stream, uniform};
use spunlaid::input::WEB_KEYS;

/// Keeps the random numbers of this program apart from all others.
const KEY: u64 = 0x65766f7270;
/// Most keys that are changed in an input.
const MOST: usize = 5;
/// A quantity without a slider lies within this factor of the middle of its usual range.
const NEAR: f64 = 5.0;

/// A file that keys are changed in.
pub struct Base {
    pub name: &'static str,
    /// The command that computes it.
    pub command: &'static str,
    pub text: &'static str,
    /// Tables of the keys that are drawn.
    pub tables: &'static [&'static str],
    /// How often it is drawn, relative to the others.
    pub weight: f64,
}

/// Small enough for some tenths of a second each; `CASES` stands for the folder of cases.
pub const BASES: [Base; 4] = [
    Base {
        name: "fixed fibre",
        command: "run",
        text: include_str!("fixed.toml"),
        tables: &["fibre", "air", "drag", "run"],
        weight: 3.0,
    },
    Base {
        name: "fed fibre",
        command: "run",
        text: include_str!("fed.toml"),
        tables: &["fibre", "air", "drag", "feed", "belt", "run"],
        weight: 2.0,
    },
    Base {
        name: "web",
        command: "web",
        text: include_str!("web.toml"),
        tables: &["fibre", "laydown", "line", "web", "fabric"],
        weight: 3.0,
    },
    Base {
        name: "spinline",
        command: "spin",
        text: include_str!("spinline.toml"),
        tables: &["spinline", "drag"],
        weight: 2.0,
    },
];

/// What decides how long a computation takes or how much memory it may have, and is no number of the line.
const FIXED: [&str; 16] = [
    "run.duration",
    "run.time_step",
    "run.replicates",
    "run.output_interval",
    "run.shapes",
    "run.checks",
    "run.error_tolerance",
    "run.spin_up",
    "fibre.element_length",
    "air.harmonics",
    "air.lateral",
    "web.width",
    "web.length",
    "web.cell",
    "web.memory_limit",
    "web.window",
];

/// Random numbers of a draw.
pub struct Random(Box<dyn FnMut() -> f64>);

impl Random {
    pub fn new(seed: u64, number: u64) -> Self {
        let mut random = stream([KEY, seed, number, 0]);
        Self(Box::new(move || uniform(&mut random)))
    }

    fn below(&mut self, count: usize) -> usize {
        ((self.0)() * count as f64) as usize
    }

    /// The place of one of several, by their weights.
    pub fn weighted(&mut self, weights: &[f64]) -> usize {
        let mut left = (self.0)() * weights.iter().sum::<f64>();
        let is_here = |weight: &f64| {
            left -= weight;
            left < 0.0
        };
        weights.iter().position(is_here).unwrap_or(0)
    }

    /// Evenly in the logarithm.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf((self.0)())
    }
}

/// An input: a base with values of some keys, as they stand after `--set`.
#[derive(Clone)]
pub struct Drawn {
    pub base: &'static Base,
    pub changes: Vec<(&'static str, String)>,
}

/// What is drawn of a key.
struct Drawable {
    name: &'static str,
    kind: Kind,
    slider: Option<(f64, f64)>,
    usual: Option<(f64, f64)>,
}

impl Drawn {
    pub fn new(base: &'static Base, random: &mut Random) -> Self {
        let all = drawable(base);
        let mut changes: Vec<(&'static str, String)> = Vec::new();
        for _ in 0..random.below(MOST + 1) {
            let key = &all[random.below(all.len())];
            if let Some(value) = key.value(random)
                && changes.iter().all(|(name, _)| *name != key.name)
            {
                changes.push((key.name, value));
            }
        }
        Self { base, changes }
    }

    /// The same values in SI units, `40e-6 m` in place of `40 µm`.
    pub fn in_si_units(&self) -> Self {
        let all = drawable(self.base);
        let in_si = |(name, value): &(&'static str, String)| {
            let kind = all.iter().find(|key| key.name == *name).map(|key| key.kind);
            let value = match kind {
                Some(Kind::Quantity(dimension, _)) => dimension.parse(value).map(|si| dimension.exact(si)),
                _ => Ok(value.clone()),
            };
            (*name, value.expect("a value that was written"))
        };
        Self { base: self.base, changes: self.changes.iter().map(in_si).collect() }
    }

    /// The commands that show a finding.
    pub fn command(&self) -> String {
        let set = |(key, value): &(&str, String)| format!(" --set '{key}={value}'");
        let set: String = self.changes.iter().map(set).collect();
        format!(
            "spunlaid {} crates/spunlaid-cli/examples/prove/{}.toml{set}",
            self.base.command,
            self.base.name.split(' ').next().unwrap_or_default()
        )
    }
}

fn drawable(base: &Base) -> Vec<Drawable> {
    let is_of_base = |name: &str| {
        name.split_once('.').is_some_and(|(table, _)| base.tables.contains(&table))
            && !FIXED.iter().any(|fixed| name.starts_with(fixed))
    };
    let of_case = keys::all().iter().map(|key| Drawable {
        name: key.name,
        kind: key.kind,
        slider: key.slider,
        usual: key.usual,
    });
    let of_web = WEB_KEYS.iter().map(|key| Drawable {
        name: key.name,
        kind: key.kind,
        slider: key.slider,
        usual: key.usual,
    });
    let all: Box<dyn Iterator<Item = Drawable>> =
        if base.command == "web" { Box::new(of_web) } else { Box::new(of_case) };
    all.filter(|key| is_of_base(key.name)).collect()
}

impl Drawable {
    /// A value; None of a kind that names files or lists.
    fn value(&self, random: &mut Random) -> Option<String> {
        Some(match self.kind {
            Kind::Quantity(dimension, sign) => {
                let (low, high) = self.slider.or(self.usual)?;
                let middle = (low.max(1e-12) * high).sqrt();
                let (low, high) = match self.slider {
                    Some(ends) => ends,
                    None => (low.max(middle / NEAR), high.min(middle * NEAR)),
                };
                let low = if low > 0.0 { low } else { high / (NEAR * NEAR) };
                let value = random.between(low, high);
                let is_turned = sign == Sign::Any && random.below(4) == 0;
                rounded(dimension, if is_turned { -value } else { value })
            }
            Kind::Whole(least, most) => {
                (least + random.below(most.min(least + 20) as usize) as u64).to_string()
            }
            Kind::Switch => ["true", "false"][random.below(2)].to_owned(),
            Kind::Choice(names) => {
                let names = names();
                names[random.below(names.len())].to_owned()
            }
            _ => return None,
        })
    }
}

/// A value of few digits with its unit, as people write it.
fn rounded(dimension: Dimension, value: f64) -> String {
    dimension.pretty_to(value, 3)
}
