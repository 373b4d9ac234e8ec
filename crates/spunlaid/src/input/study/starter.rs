//! A study to start from, beside the file that it varies.

use super::super::Resources;
use super::super::write::quoted;
use super::super::{file, kind_of, read_case, read_spinline, read_web};
use super::{Base, VariedKey, open_base, parse_study};
use crate::error::{Error, Fault, FileKind};
use std::path::Path;

/// Keys to begin with, the first ones that fit.
const OF_CASES: &[&str] = &[
    "air.velocity",
    "fibre.diameter",
    "fibre.linear_density",
    "belt.speed",
    "spinline.throughput",
    "air.turbulence_intensity",
    "air.length_scale",
    "fibre.length",
];
const OF_WEBS: &[&str] = &[
    "line.belt_speed",
    "belt.speed",
    "layer.1.line.belt_speed",
    "spinline.throughput",
    "line.depth",
    "laydown.sigma_md",
    "layer.1.laydown.sigma_md",
    "fibre.diameter",
    "air.length_scale",
];
const OF_SPINLINES: &[&str] = &[
    "spinline.throughput",
    "spinline.velocity",
    "spinline.hole_diameter",
    "spinline.take_up_speed",
    "spinline.length",
];
/// Number of keys that it varies.
const FACTORS: usize = 2;
/// The values of each, over that of the file.
const LEVELS: [f64; 3] = [0.8, 1.0, 1.25];

/// A commented study of a case, a web or a spinline. It stands in the same folder and varies two keys around
/// their values; all its points can be flown.
///
/// # Errors
/// If the file cannot be read, is wrong, or has no key to begin with.
pub fn starter_study(path: &Path) -> Result<String, Error> {
    let kind = kind_of(path);
    match kind {
        FileKind::Study => {
            let fault = Fault::new("is a study already", "name the case, the web or the spinline to vary");
            return Err(Error::folder(path, fault));
        }
        FileKind::Web => drop(read_web(path, &[])?),
        FileKind::Spinline => drop(read_spinline(path, &[])?),
        _ => drop(read_case(path, &[])?),
    }
    let (text, name) = (file::read(path, kind)?, path.display().to_string());
    let base = open_base(kind, text.clone(), &name, [(&[]).into(), (&[]).into()], &Resources::default())?;
    let (word, noun, keys) = match kind {
        FileKind::Web => ("web", "webs", OF_WEBS),
        FileKind::Spinline => ("spinline", "", OF_SPINLINES),
        _ => ("case", "fibres", OF_CASES),
    };
    let study = |vary: &[String]| {
        let named = path.file_name().unwrap_or_default().to_string_lossy();
        let replicates = base.seed_and_replicates().1;
        text_of(word, &named, (replicates, noun), vary)
    };
    let mut vary = Vec::new();
    for key in keys.iter().filter_map(|key| base.varied(key).ok()) {
        vary.extend(line(&key, &*base));
        // A value may not fit the others, as a finer fibre does not fit a given time step.
        let read = parse_study(&study(&vary), "study", None, |_, _| Ok((text.clone(), name.clone())));
        if read.is_err() {
            vary.pop();
        }
        if vary.len() == FACTORS {
            break;
        }
    }
    if vary.is_empty() {
        let fault =
            Fault::new("has no key that a first study varies", "write a study by hand: docs/studies.md");
        return Err(Error::folder(path, fault));
    }
    Ok(study(&vary))
}

/// `"air.velocity" = ["8 m/s", "10 m/s", "12.5 m/s"]`.
fn line(key: &VariedKey, base: &dyn Base) -> Option<String> {
    let value = Some(base.value(key)).filter(|value| *value > 0.0 && key.words().is_empty())?;
    let levels = LEVELS.map(|level| format!("\"{}\"", key.pretty(level * value)));
    Some(format!("\"{}\" = [{}]", key.name, levels.join(", ")))
}

/// * `replicates` – their number, and what they are called; none have a name where nothing is by chance
fn text_of(word: &str, file: &str, replicates: (u64, &str), vary: &[String]) -> String {
    let points = LEVELS.len().pow(vary.len() as u32);
    let replicates = match replicates {
        (_, "") => String::new(),
        (count, noun) => format!(
            "replicates = {count}                       # {noun} at each point; more of them lower the errors\n\
             # seed = 1                           # of the turbulence; left out, that of the {word}\n"
        ),
    };
    let quoted = quoted(file);
    format!(
        "# How the results of {file} change with some of its keys: {points} points.\n\
        # Run it: spunlaid sweep FILE      Look at its first point: spunlaid sweep FILE --print-point 1\n\
        # Lines that begin with # are optional. All designs, ranges and links: docs/studies.md of the \
        project.\n{word} = {quoted}\ndesign = \"grid\"                      # every combination; or \
        \"one-at-a-time\", \"latin-hypercube\" and others\n{replicates}\n\
        [vary]                               # a list of values, or a range: {{ from = \"5 m/s\", to = \"30 \
        m/s\", steps = 6 }}\n{}\n\n# [set]                              # keys that are the same at all \
        points, in place of those of the {word}\n",
        vary.join("\n")
    )
}
