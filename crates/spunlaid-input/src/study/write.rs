//! Writes a study as a file, with every default.

use super::super::text_with_lines::fit;
use super::super::write::{in_lines, lines, own_value, quoted};
use super::super::{FORMAT_VERSION, Resources, file, kind_of, read_case, read_spinline, read_web};
use super::{Base, open_base, parse_study};
use spunlaid_experiment::{Factor, Levels, Replicates, STUDY, Study};
use spunlaid_fibre::case::keys::VariedKey;
use spunlaid_ground::units::shortest;
use spunlaid_ground::{Error, Fault, FileKind};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::Path;
use toml::de::{DeTable, DeValue};

/// Writes a study as TOML; it names `case.toml`, `web.toml` or `spinline.toml`, in the same folder.
///
/// Reading the text with the same file gives exactly the same points.
///
/// * `set` – the keys that are the same at all points, with their values as TOML
pub(super) fn write_study(study: &Study, set: &[(String, String)]) -> String {
    let lines = |table: &str| in_lines(&lines(&STUDY, table, |key| own_value(key, study)));
    let mut text = format!("version = {FORMAT_VERSION}\n{}", lines(""));
    let Replicates { until, .. } = &study.replicates;
    if !until.is_empty() {
        text += &format!("\n[replicates]\n{}\n[replicates.until]\n", lines("replicates"));
    }
    // Writing to a text cannot fail.
    for (measure, fraction) in until {
        let _ = writeln!(text, "{} = {}", study.quantities[*measure].name, shortest(*fraction));
    }
    write_values(&mut text, set, &study.factors);
    if !study.links.is_empty() {
        text.push_str("\n[link]\n");
        for link in &study.links {
            let _ = writeln!(text, "\"{}\" = \"{}\"", link.key.name, link.expression.text());
        }
    }
    if !study.claims.is_empty() {
        text.push_str("\n[claims]\n");
        for claim in &study.claims {
            let _ = writeln!(text, "{} = {}", quoted(&claim.sentence), quoted(&claim.text));
        }
    }
    text
}

/// Writes the tables `[set]` and `[vary]`.
fn write_values(text: &mut String, set: &[(String, String)], factors: &[Factor]) {
    if !set.is_empty() {
        text.push_str("\n[set]\n");
        for (key, value) in set {
            let _ = writeln!(text, "\"{key}\" = {value}");
        }
    }
    text.push_str("\n[vary]\n");
    for factor in factors {
        let exact = |value: f64| exact(&factor.key, value);
        let _ = match &factor.levels {
            Levels::List(values) => {
                let values: Vec<String> = values.iter().map(|value| exact(*value)).collect();
                writeln!(text, "\"{}\" = [{}]", factor.key.name, values.join(", "))
            }
            Levels::Range { from, to, steps, spacing } => {
                let steps = steps.map_or_else(String::new, |steps| format!(", steps = {steps}"));
                let from = exact(*from);
                let to = exact(*to);
                let spacing = spacing.name();
                writeln!(
                    text,
                    "\"{}\" = {{ from = {from}, to = {to}{steps}, spacing = \"{spacing}\" }}",
                    factor.key.name
                )
            }
        };
    }
}

/// A value in the form of a study file, without rounding.
fn exact(key: &VariedKey, value: f64) -> String {
    key.word(value).map_or_else(|| key.exact(value), quoted)
}

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
const WEB_MEASURES: &[&str] = &[
    "line.belt_speed",
    "belt.speed",
    "layer.1.line.belt_speed",
    "spinline.throughput",
    "line.slot_gap",
    "laydown.sigma_md",
    "layer.1.laydown.sigma_md",
    "fibre.diameter",
    "air.length_scale",
];
const SPINLINE_MEASURES: &[&str] = &[
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
/// their values; all its points can be simulated.
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
        FileKind::Web => ("web", "webs", WEB_MEASURES),
        FileKind::Spinline => ("spinline", "", SPINLINE_MEASURES),
        _ => ("case", "fibres", OF_CASES),
    };
    let study = |vary: &[String]| {
        let named = path.file_name().unwrap_or_default().to_string_lossy();
        let replicates = base.seed_and_replicates().1;
        text_of(word, &named, replicates, noun, vary)
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
            Fault::new("has no key that a first study varies", "write the study yourself: docs/studies.md");
        return Err(Error::folder(path, fault));
    }
    Ok(study(&vary))
}

/// `"air.velocity" = ["8 m/s", "10 m/s", "12.5 m/s"]`.
fn line(key: &VariedKey, base: &dyn Base) -> Option<String> {
    let value = base.value(key).filter(|value| *value > 0.0 && key.words().is_empty())?;
    let levels = LEVELS.map(|level| format!("\"{}\"", key.pretty(level * value)));
    Some(format!("\"{}\" = [{}]", key.name, levels.join(", ")))
}

/// * `noun` – what a replicate is called; empty where nothing is random
fn text_of(word: &str, file: &str, count: u64, noun: &str, vary: &[String]) -> String {
    let points = LEVELS.len().pow(vary.len() as u32);
    let replicates = match noun {
        "" => String::new(),
        _ => format!(
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

/// The keys whose values differ between two TOML texts: `air.velocity was "10 m/s", is "12 m/s"`.
///
/// Comments, order and spaces are ignored.
pub fn differences(was: &str, is: &str) -> Vec<String> {
    let (was, is) = (entries(was), entries(is));
    let keys: BTreeSet<&str> = was.iter().chain(&is).map(|(key, _)| &**key).collect();
    let value = |entries: &[(String, String)], key| {
        entries.iter().find_map(|(name, value)| (name == key).then(|| value.clone()))
    };
    keys.into_iter()
        .filter_map(|key| match (value(&was, key), value(&is, key)) {
            (was, is) if was == is => None,
            (was, is) => {
                let [was, is] = [was, is].map(|value| value.unwrap_or_else(|| "missing".to_owned()));
                Some(format!("{key} was {was}, is {is}"))
            }
        })
        .collect()
}

/// Full keys and the text of their values; a single entry if the text is not TOML.
fn entries(text: &str) -> Vec<(String, String)> {
    let mut entries = Vec::new();
    match DeTable::parse(text) {
        Ok(root) => gather(text, "", root.get_ref(), &mut entries),
        Err(_) => entries.push(("the file".to_owned(), "damaged".to_owned())),
    }
    entries
}

fn gather(text: &str, above: &str, table: &DeTable<'_>, entries: &mut Vec<(String, String)>) {
    for (key, value) in table {
        let key =
            if above.is_empty() { key.get_ref().to_string() } else { format!("{above}.{}", key.get_ref()) };
        match value.get_ref() {
            DeValue::Table(inner) => gather(text, &key, inner, entries),
            _ => entries.push((fit(&key), fit(text.get(value.span()).unwrap_or_default()))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::differences;

    #[test]
    fn differences_are_listed_by_key() {
        let was = "a = 1 # one\n[b]\nc = [1, 2]\nd.e = \"x\"\ngone = 1\n";
        assert_eq!(differences(was, "a=1\n[b]\nd = { e = \"x\" }\ngone =  1\nc = [1, 2]\n"), [""; 0]);
        assert_eq!(
            differences(was, "a = 2\n[b]\nc = [1, 2]\nd.e = \"y\"\nnew = 2\n"),
            [
                "a was 1, is 2",
                "b.d.e was \"x\", is \"y\"",
                "b.gone was 1, is missing",
                "b.new was missing, is 2"
            ]
        );
        assert_eq!(differences("a = 1", "a = "), ["a was 1, is missing", "the file was missing, is damaged"]);
    }
}
