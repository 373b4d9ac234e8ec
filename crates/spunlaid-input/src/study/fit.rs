//! The web of a fit: which keys can be sought in it, and the web of some values of theirs.

use super::super::web::WebFile;
use super::super::{Overrides, Resources, Source};
use super::Base;
use super::web::WebBase;
use spunlaid_experiment::{Parameter, USUAL_FACTOR};
use spunlaid_fibre::case::keys::{Kind, Relative, Sign, VariedKey};
use spunlaid_ground::error::Place;
use spunlaid_ground::{Diagnostic, Error, Fault, FileKind};

/// The web of a fit, with the keys that are sought in it.
pub struct FitFile {
    base: WebBase,
    /// The web before anything is sought.
    pub start: WebFile,
    /// The keys that are sought, with the values of the file and their ranges.
    pub parameters: Vec<Parameter>,
}

impl std::fmt::Debug for FitFile {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("FitFile").field("parameters", &self.parameters).finish_non_exhaustive()
    }
}

/// Reads the file of a web in which keys are sought.
///
/// * `vary` – the keys, each by its name, or with its range: `line.slot_gap=5 mm..40 mm`
/// * `word` – what messages call them, `--vary`
///
/// # Errors
/// If the web cannot be laid, or if a key cannot be sought.
pub fn read_fit<'a>(
    source: impl Into<Source<'a>>,
    set: Overrides<'_>,
    vary: &[String],
    word: &str,
) -> Result<FitFile, Error> {
    let base = source.into().open(FileKind::Web, set, |text, name, resources| {
        WebBase::new(text, name.to_owned(), &[set], resources)
    })?;
    let mut parameters = Vec::<Parameter>::new();
    let mut problems = Vec::<Diagnostic>::new();
    for item in vary {
        let (key, range) =
            item.split_once('=').map_or((item.trim(), None), |(key, range)| (key.trim(), Some(range.trim())));
        let problem = |value: Option<&str>, what: Fault| Diagnostic {
            place: Place::Override(word.to_owned()),
            key: key.to_owned(),
            value: value.map(ToOwned::to_owned),
            ..what.into()
        };
        let found = base.varied(key).map_err(|remedy| Fault::new("cannot be sought", remedy));
        let found = found.and_then(|found| {
            let is_twice = parameters.iter().any(|other| other.key == found);
            if is_twice { Err(Fault::new("is named twice", "name it once")) } else { Ok(found) }
        });
        match found.and_then(|found| parameter(&base, found, range)) {
            Ok(parameter) => parameters.push(parameter),
            Err(fault) => problems.push(problem(range, fault)),
        }
    }
    if !problems.is_empty() {
        return Err(problems.into());
    }
    Ok(FitFile { start: base.file.clone(), base, parameters })
}

impl FitFile {
    /// The web with these values of the keys [SI].
    ///
    /// # Errors
    /// Every problem with it.
    pub fn web(&self, values: &[f64], resources: &Resources) -> Result<WebFile, Error> {
        let keys = self.parameters.iter().map(|parameter| parameter.key.clone());
        let values: Vec<(VariedKey, f64)> = keys.zip(values.iter().copied()).collect();
        self.base.with(&values, None, resources)
    }
}

/// How the names of keys begin that say how a web is computed.
const COMPUTATION: [&str; 3] = ["web.", "run.", "fibre.element_length"];

/// A key that is sought, with its range.
fn parameter(base: &WebBase, key: VariedKey, range: Option<&str>) -> Result<Parameter, Fault> {
    if COMPUTATION.iter().any(|start| key.name.starts_with(start)) {
        let remedy = "seek a key of the line: of its air, fibres, laydown or rows";
        return Err(Fault::new(
            "cannot be sought: it sets how the web is computed, not how it is made",
            remedy,
        ));
    }
    let is_share = match key.kind {
        Kind::Quantity(_, sign) => sign == Sign::Share,
        Kind::Whole(..) => false,
        _ => {
            return Err(Fault::new(
                "cannot be sought: its values are not numbers",
                "seek a key whose value is a number",
            ));
        }
    };
    let value = base.value(&key);
    let range = match range {
        Some(range) => {
            let ends = range
                .split_once("..")
                .ok_or_else(|| Fault::new("is not a range", "write FROM..TO, as in 5 mm..40 mm"))?;
            let [from, to] =
                [ends.0, ends.1].map(|end| end_of_range(&key, value, end.trim().trim_matches('"')));
            let (from, to) = (from?, to?);
            if !(from < to && from.is_finite() && to.is_finite()) {
                return Err(Fault::new(
                    "is not a range",
                    "write the smaller value first, and two values that differ",
                ));
            }
            [from, to]
        }
        None => match value {
            Some(value) if value > 0.0 => [
                value / USUAL_FACTOR,
                if is_share { (value * USUAL_FACTOR).min(1.0) } else { value * USUAL_FACTOR },
            ],
            _ => {
                let reason = match value {
                    None => "has no value in the file from which the search could start",
                    Some(_) => "is not above zero, so it needs a range",
                };
                return Err(Fault::new(reason, format!("write {}=FROM..TO", key.name)));
            }
        },
    };
    if let Some(value) = value.filter(|value| *value < range[0] || *value > range[1]) {
        return Err(Fault::new(
            format!("has {} in the file, which lies outside its range", key.pretty(value)),
            format!("write a range that holds it, or another start with --set {}=VALUE", key.name),
        ));
    }
    let middle = if range[0] > 0.0 { (range[0] * range[1]).sqrt() } else { 0.5 * (range[0] + range[1]) };
    let start = value.unwrap_or(middle);
    Ok(Parameter { key, start, range })
}

/// An end of a range: a value, or a change of the value in the file [SI], if there is one.
fn end_of_range(key: &VariedKey, value: Option<f64>, text: &str) -> Result<f64, Fault> {
    let Some(change) = Relative::read(&key.kind, text)? else { return key.dimension().parse(text) };
    let end = change.of(value, &key.kind, format!("write {}=FROM..TO with values", key.name))?;
    end.number().ok_or_else(|| Fault::new("is not a range", "write numbers"))
}
