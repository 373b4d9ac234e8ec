//! Whether the numbers of a line are such as spunbond lines have.

use spunlaid_ground::Diagnostic;
use spunlaid_ground::units::rounded;
use spunlaid_simulation::layers::full_names::web_key;
use spunlaid_simulation::{LayerSpec, WebSpec};
use std::fmt;

/// A number of a line, with the range in which spunbond lines have it; `docs/theory.md` has the sources.
#[derive(Debug)]
pub struct Limit {
    /// The key of a web that is this number, or from which it follows.
    pub key: &'static str,
    /// What it is called.
    pub words: &'static str,
    /// The unit in which a plant says it, and its size [SI].
    pub unit: (&'static str, f64),
    /// Least and greatest in this unit.
    pub range: [f64; 2],
    /// Whether no line can be outside, or only none is known to be.
    pub is_law: bool,
    /// What may be wrong where it is outside.
    advice: &'static str,
    /// The number of a web or of one of its layers, if it has it [SI].
    of: fn(&WebSpec, &LayerSpec) -> Option<f64>,
}

/// All numbers that are looked at.
pub const LIMITS: &[Limit] = &[
    Limit {
        key: "line.throughput",
        words: "throughput of a hole",
        unit: ("g/min", 1e-3 / 60.0),
        range: [0.05, 5.0],
        is_law: false,
        advice: "is it that of several holes?",
        of: |_, layer| Some(layer.fed_filament().throughput()),
    },
    Limit {
        key: "fibre.linear_density",
        words: "titre",
        unit: ("dtex", 1e-7),
        range: [0.3, 20.0],
        is_law: false,
        advice: "check titre or diameter, and the density",
        of: |_, layer| Some(layer.fed_filament().linear_density()),
    },
    Limit {
        key: "line.feed_speed",
        words: "spinning speed",
        unit: ("m/min", 1.0 / 60.0),
        range: [500.0, 8000.0],
        is_law: false,
        advice: "it follows from throughput and titre, so check both",
        of: |_, layer| Some(layer.fed_filament().feed_speed()),
    },
    Limit {
        key: "line.feed_speed",
        words: "filament",
        unit: ("times the speed of its fastest air", 1.0),
        range: [0.0, 0.9],
        is_law: true,
        advice: "air draws no filament as fast as it blows: check the speed of the air, throughput and \
            titre; for a filament that begins at the die ([spinline]) the titre follows",
        of: |_, layer| {
            let case = layer.source.case().filter(|case| case.spinline.is_none())?;
            Some(layer.fed_filament().feed_speed() / case.fastest_air()?)
        },
    },
    Limit {
        key: "line.belt_speed",
        words: "speed of the belt",
        unit: ("m/min", 1.0 / 60.0),
        range: [5.0, 1500.0],
        is_law: false,
        advice: "it follows from holes, throughput and basis weight, so check them",
        of: |web, _| Some(web.belt_speed),
    },
    Limit {
        key: "line.basis_weight",
        words: "basis weight",
        unit: ("g/m²", 1e-3),
        range: [3.0, 800.0],
        is_law: false,
        advice: "check it, or holes, throughput and belt from which it follows",
        of: |web, _| Some(web.weight()),
    },
];

/// A number that is outside the range of spunbond lines.
#[derive(Debug)]
pub struct Implausible {
    /// The layer, from 0.
    pub layer: usize,
    /// The range.
    pub limit: &'static Limit,
    /// The number [SI].
    pub value: f64,
}

impl Implausible {
    /// How far it is outside, as a factor above 1.
    fn excess(&self) -> f64 {
        let [least, greatest] = self.limit.range;
        let value = self.value / self.limit.unit.1;
        (least / value).max(value / greatest)
    }

    /// The number and the range, with the unit of a plant.
    fn words(&self) -> (String, String) {
        let Limit { unit: (unit, size), range, .. } = self.limit;
        let range = match range {
            [0.0, most] => format!("{} at most", shown(*most)),
            ends => format!("{} {unit}", ends.map(shown).join(" to ")),
        };
        (format!("{} {unit}", shown(self.value / size)), range)
    }

    /// What is reported of it.
    ///
    /// * `is_written` – whether its key is, so that another unit may have been meant
    pub fn note(&self, is_written: bool) -> Diagnostic {
        let Limit { key, words, unit: (unit, _), range: ends, advice, .. } = self.limit;
        let dimension = web_key(key).and_then(|key| key.kind.dimension()).filter(|_| is_written);
        let meant = dimension.and_then(|dimension| dimension.meant_in(unit, self.value, *ends));
        let advice =
            meant.map_or_else(|| (*advice).to_owned(), |meant| format!("did you mean {meant} {unit}?"));
        let (found, range) = self.words();
        Diagnostic::implausible(format!(
            "is outside the usual range: a {words} of {found}, where spunbond lines have {range}; {advice}"
        ))
        .outside_by(self.excess())
        .with_key(*key, None)
    }
}

impl fmt::Display for Implausible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.note(false).fmt(f)
    }
}

/// A number with three digits.
fn shown(number: f64) -> String {
    rounded(number, 2).to_string()
}

/// The numbers of a web that are outside the ranges of spunbond lines, each once: its layers share some.
pub fn implausible(web: &WebSpec) -> Vec<Implausible> {
    let mut all: Vec<Implausible> = Vec::new();
    for found in of_layers(web) {
        if !all.iter().any(|other| std::ptr::eq(other.limit, found.limit) && other.value == found.value) {
            all.push(found);
        }
    }
    all
}

/// The numbers of each layer that are outside.
fn of_layers(web: &WebSpec) -> Vec<Implausible> {
    let of_layer = |(number, layer)| {
        let of = move |limit: &'static Limit| {
            Some(Implausible { layer: number, limit, value: (limit.of)(web, layer)? })
        };
        LIMITS.iter().filter_map(of).filter(|found| found.excess() > 1.0 + ROUNDING)
    };
    web.layers.iter().enumerate().flat_map(of_layer).collect()
}

/// Share by which a number may be outside.
const ROUNDING: f64 = 1e-6;

/// Why no spunbond line is a changed web: a number outside the ranges that the web itself has not, or a filament that
/// is even faster than its air; none if there is no such number.
pub fn outside(before: &WebSpec, after: &WebSpec) -> Option<String> {
    let before = of_layers(before);
    let most = |found: &Implausible| {
        let same = |old: &&Implausible| old.layer == found.layer && std::ptr::eq(old.limit, found.limit);
        match before.iter().find(same) {
            Some(old) if found.limit.is_law => old.excess(),
            Some(_) => f64::INFINITY,
            None => 1.0,
        }
    };
    let found = of_layers(after).into_iter().find(|found| found.excess() > most(found) * (1.0 + ROUNDING))?;
    let (measured, range) = found.words();
    Some(format!("it makes a {} of {measured}, where spunbond lines have {range}", found.limit.words))
}
