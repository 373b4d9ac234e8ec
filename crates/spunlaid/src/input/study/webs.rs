//! Studies of webs: the file of a web, or the case that it flies, with keys that vary from point to point.

use super::super::web::{WEB_KEYS, WebFile, WebSpec, document, parse_web_of_case, write_web};
use super::super::{FORMAT_VERSION, Overrides, file};
use super::reader::{self, Reader, not_varied, set_twice, unknown_key};
use super::write::write_values;
use super::{StudyChanges, StudyNote, Varied, level, points, varied};
use crate::case::Case;
use crate::case::keys::nearest_word;
use crate::error::{Error, Fault, FileKind, Place, Problem};
use crate::study::{Design, Factor, enter_keys};
use std::fmt::Write;
use std::path::{Path, PathBuf};
use toml::de::DeValue;

/// Largest number of webs of a point.
const MOST_WEBS: u64 = 10_000;
/// The key that names the web.
const WEB: &str = "web";

/// A study of webs, read.
#[derive(Clone, Debug)]
pub struct WebStudyFile {
    /// The study.
    pub study: WebStudy,
    /// Remarks on its points.
    pub notes: Vec<StudyNote>,
    /// The web that the points vary, with every default written out.
    pub web_text: String,
    /// The study with every default written out; it names the web `web.toml`.
    pub text: String,
}

/// Webs that differ in a few keys.
#[derive(Clone, Debug)]
pub struct WebStudy {
    /// The keys that vary from point to point, of the web or of the case that it flies.
    pub factors: Vec<Factor>,
    /// How the factors are combined.
    pub design: Design,
    /// Number of webs of each point, each with a seed of its own.
    pub replicates: u64,
    /// The points.
    pub points: Vec<WebPoint>,
}

/// A point of a study of webs.
#[derive(Clone, Debug)]
pub struct WebPoint {
    /// Values of the factors: numbers in SI units, words as indices into those of the factor.
    pub values: Vec<f64>,
    /// The web.
    pub spec: WebSpec,
}

impl WebStudy {
    /// A checksum over all that the results of the webs depend on: every point's web as it is written, and the keys of the
    /// cases that it flies. The number of webs is left out, so that a finished study can be given more.
    pub fn identity(&self) -> u32 {
        let mut sum = crc32fast::Hasher::new();
        for WebPoint { spec, .. } in &self.points {
            sum.update(write_web(spec).as_bytes());
            for case in spec.layers.iter().filter_map(|layer| layer.source.case()) {
                enter_keys(&mut sum, case);
            }
        }
        sum.finalize()
    }
}

/// Whether a study file varies a web, and not a case. False for a file that cannot be read.
pub fn varies_a_web(path: &Path) -> bool {
    file::read(path, FileKind::Study)
        .is_ok_and(|text| Reader::new(&text, "").is_ok_and(|reader| reader.entries.contains_key(WEB)))
}

/// Reads a study of webs and the web that it names, and checks every point.
///
/// # Errors
/// When a file cannot be read, and when the study or any of its points is wrong; the error lists all problems.
pub fn read_web_study(path: &Path, changes: &StudyChanges<'_>) -> Result<WebStudyFile, Error> {
    let text = file::read(path, FileKind::Study)?;
    parse_web_study(&text, &path.display().to_string(), changes, |web| {
        let web = path.parent().map_or_else(|| PathBuf::from(web), |folder| folder.join(web));
        Ok((file::read(&web, FileKind::Web)?, web.display().to_string()))
    })
}

/// Reads the text of a study of webs.
///
/// * `web` – returns text and path of the web that the study names
///
/// # Errors
/// As [`read_web_study`].
pub fn parse_web_study(
    text: &str,
    name: &str,
    changes: &StudyChanges<'_>,
    web: impl FnOnce(&str) -> Result<(String, String), Error>,
) -> Result<WebStudyFile, Error> {
    let mut reader = Reader::new(text, name)?;
    let Some(named) = reader.web() else {
        return Err(reader.rejected());
    };
    let (text, path) = web(&named)?;
    let set = reader.set_of_web(changes.set);
    let base = Base::new(text, path, &set, &format!("{name}: [set]"))?;
    let Some(plan) = reader.plan_of_webs(&base, &set, changes) else {
        return Err(reader.rejected());
    };
    let (points, notes) = plan.points(name, &base)?;
    let Plan { factors, design, seed, replicates } = plan;
    let study = WebStudy { factors, design, replicates, points };
    let text = written(&study, seed, &set);
    Ok(WebStudyFile { study, notes, web_text: base.file.text, text })
}

/// The web of a study before its keys vary.
struct Base {
    text: String,
    /// The path of its file.
    path: String,
    /// What is the same at all points: keys of the web, and of its case.
    set: [Vec<(String, String)>; 2],
    file: WebFile,
}

impl Base {
    fn new(text: String, path: String, set: &[(String, String)], word: &str) -> Result<Self, Error> {
        let set = sides(set.iter().cloned());
        let overrides = |values| Overrides { values, word };
        let file = parse_web_of_case(&text, &path, overrides(&set[0]), overrides(&set[1]))?;
        Ok(Self { text, path, set, file })
    }

    /// The case that it flies, if it flies one.
    fn case(&self) -> Option<&Case> {
        self.file.spec.layers.iter().find_map(|layer| match &layer.source {
            super::super::LaydownSource::Case { case, .. } => Some(&**case),
            _ => None,
        })
    }

    /// The value of a factor; NaN if it has none.
    fn value(&self, factor: &Factor) -> f64 {
        if let Some(key) = varied(factor.key) {
            let value = self.case().and_then(|case| level(key, &key.get(case)?));
            return value.unwrap_or(f64::NAN);
        }
        let overrides = Overrides { values: &self.set[0], word: "" };
        let document = document::read(&self.text, &self.path, overrides);
        let number = |document: document::WebDocument| {
            let text = document.written.text(factor.key);
            let word = text.and_then(|text| factor.words.iter().position(|word| *word == text));
            word.map(|place| place as f64).or_else(|| document.written.number(factor.key))
        };
        document.ok().and_then(number).unwrap_or(f64::NAN)
    }
}

/// Keys and values of a web, and those of its case.
fn sides(all: impl Iterator<Item = (String, String)>) -> [Vec<(String, String)>; 2] {
    let (of_case, of_web) = all.partition(|(key, _)| of_web(key).is_none() && varied(key).is_some());
    [of_web, of_case]
}

/// The key of a web with this name, if its values can vary.
fn of_web(name: &str) -> Option<Varied> {
    let key = WEB_KEYS.iter().find(|key| key.name == name)?;
    let varied = Varied::from(key);
    let varies = varied.kind.dimension().is_some() || varied.is_whole() || !varied.words().is_empty();
    (varies && key.table() != "line.rows").then_some(varied)
}

/// A study of webs before its points are made.
struct Plan {
    factors: Vec<Factor>,
    design: Design,
    seed: u64,
    replicates: u64,
}

impl Plan {
    fn points(&self, study: &str, base: &Base) -> Result<(Vec<WebPoint>, Vec<StudyNote>), Error> {
        let values: Vec<f64> = self.factors.iter().map(|factor| base.value(factor)).collect();
        let rows = self.design.rows(&self.factors, &values, self.seed);
        let count = rows.len() as u64;
        let (mut points, mut problems, mut notes) = (Vec::new(), Vec::new(), points::Notes::default());
        for (number, values) in (1..).zip(rows) {
            let exact = |(factor, value): (&Factor, &f64)| {
                let key = of_web(factor.key).or_else(|| varied(factor.key).map(Varied::from))?;
                Some((factor.key.to_owned(), key.exact(*value)))
            };
            let of_point = sides(self.factors.iter().zip(&values).filter_map(exact));
            let [web, case] = [0, 1].map(|side| [&base.set[side][..], &of_point[side][..]].concat());
            let overrides = |values| Overrides { values, word: "" };
            match parse_web_of_case(&base.text, &base.path, overrides(&web), overrides(&case)) {
                Ok(file) => {
                    file.notes.into_iter().for_each(|note| notes.add(note));
                    points.push(WebPoint { values, spec: file.spec });
                }
                Err(Error::Rejected(of_point)) => {
                    let pretty = |(factor, value): (&Factor, &f64)| {
                        format!("{} = {}", factor.key, factor.input().pretty(*value))
                    };
                    let all: Vec<String> = self.factors.iter().zip(&values).map(pretty).collect();
                    let place = Place::Point { study: study.to_owned(), number, values: all.join(", ") };
                    problems
                        .extend(of_point.into_iter().map(|what| Problem { place: place.clone(), ..what }));
                }
                Err(other) => return Err(other),
            }
        }
        if problems.is_empty() { Ok((points, notes.finish(count))) } else { Err(problems.into()) }
    }
}

impl<'a> Reader<'a> {
    /// The name of the web; `None` if it is missing or the file is newer, after noting the problem.
    fn web(&mut self) -> Option<String> {
        if !self.version() {
            return None;
        }
        if let Some(entry) = self.entries.remove("case") {
            let fault =
                Fault::new("stands beside web", "a study varies a case or a web, so keep one of them");
            self.reject(&entry, "case", fault);
            return None;
        }
        let entry = self.entries.remove(WEB);
        match entry.as_ref().map(|entry| &entry.value) {
            Some(DeValue::String(text)) => return Some(text.clone().into_owned()),
            Some(_) => {
                entry.iter().for_each(|entry| {
                    self.wrong_type(entry, WEB, "the path of the file of a web, in quotes")
                });
            }
            None => {
                let line = "web = \"web.toml\" (the web to vary, beside this file)";
                self.missing(WEB, line);
            }
        }
        None
    }

    /// The keys that are the same at all points: those of the file, and then those asked for from outside, which replace them.
    fn set_of_web(&mut self, asked: Overrides<'_>) -> Vec<(String, String)> {
        let mut set: Vec<(String, String)> = Vec::new();
        if let Some(entry) = self.entries.remove("set") {
            match entry.value {
                DeValue::Table(table) => {
                    set.extend(self.flat(table).into_iter().map(|(key, entry)| (key, entry.text.to_owned())));
                }
                _ => self.wrong_type(&entry, "set", "a table, [set]"),
            }
        }
        for (key, text) in asked.values {
            set.retain(|(other, _)| other != key.trim());
            set.push((key.trim().to_owned(), text.clone()));
        }
        set
    }

    /// The plan; `None` if the file has problems.
    fn plan_of_webs(
        &mut self,
        base: &Base,
        set: &[(String, String)],
        changes: &StudyChanges<'_>,
    ) -> Option<Plan> {
        for key in ["common_phases", "link"] {
            if let Some(entry) = self.entries.remove(key) {
                let advice = "it belongs to studies of a case; leave it out".to_owned();
                self.reject(&entry, key, unknown_key(advice));
            }
        }
        let entry = self.entries.remove("design");
        let design = self.design(entry.as_ref());
        let seed = self.whole("seed", 0, u64::MAX).unwrap_or(base.file.spec.seed);
        let mut replicates = self.whole("replicates", 1, MOST_WEBS).unwrap_or(1);
        if let Some(asked) = changes.replicates {
            if !(1..=MOST_WEBS).contains(&asked) {
                self.reject_whole("replicates", reader::replicates(asked, MOST_WEBS));
            }
            replicates = asked;
        }
        let (layers, flies) = (base.file.spec.layers.len(), base.case().is_some());
        let factors = self.factors(design, |reader, entry, name| {
            let refusal = match (of_web(name), varied(name)) {
                (Some(key), _) if layers == 1 || key.name.starts_with("web.") => return Some(key),
                (Some(_), _) => "the web has several layers; vary keys of its table [web], or of its cases",
                (None, Some(key)) if flies => return Some(key.into()),
                (None, Some(_)) => {
                    "it is a key of a case, and this web flies none; write laydown.case in its file"
                }
                (None, None) => match nearest_word(name, WEB_KEYS.iter().map(|key| key.name)) {
                    Some(near) if near != name => {
                        let advice = format!("did you mean {near}?");
                        reader.reject(entry, name, not_varied(advice));
                        return None;
                    }
                    _ => {
                        "take a key whose value is a number or one of a few words, of the web or of its case"
                    }
                },
            };
            reader.reject(entry, name, not_varied(refusal));
            None
        });
        for factor in factors.iter().filter(|factor| set.iter().any(|(set, _)| set == factor.key)) {
            self.reject_whole(factor.key, set_twice());
        }
        if let Some(entry) = entry.filter(|_| !self.has_problems()) {
            let values: Vec<f64> = factors.iter().map(|factor| base.value(factor)).collect();
            self.combination(&entry, design, &factors, &values);
            if !self.has_problems() {
                self.size(&entry, design.count(&factors, &values), changes.points, replicates);
            }
        }
        (!self.has_problems()).then_some(Plan { factors, design, seed, replicates })
    }
}

/// Writes a study of webs as TOML; it names the web `web.toml`, in the same folder.
fn written(study: &WebStudy, seed: u64, set: &[(String, String)]) -> String {
    let mut text = format!("version = {FORMAT_VERSION}\nweb = \"web.toml\"\n");
    // Writing to a text cannot fail.
    let _ = writeln!(text, "design = \"{}\"", study.design.name());
    if let Design::LatinHypercube(points) | Design::Sobol(points) = study.design {
        let _ = writeln!(text, "points = {points}");
    }
    let _ = writeln!(text, "seed = {seed}\nreplicates = {}", study.replicates);
    // What is set is in the web already, but for its case.
    let of_case = &sides(set.iter().cloned())[1];
    write_values(&mut text, of_case, &study.factors, |name| {
        of_web(name).or_else(|| varied(name).map(Varied::from))
    });
    text
}
