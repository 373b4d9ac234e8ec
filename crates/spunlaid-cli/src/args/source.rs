//! The case that a command reads, with the changes to it.

use clap::{Args, ValueHint};
use spunlaid::ground::{Diagnostic, Error, Fault};
use spunlaid::input::{CaseWithNotes, LARGEST_FILE, Overrides, Resources, read_case, text_of};
use spunlaid_results::command::{beside_of, quoted};
use std::cell::OnceCell;
use std::io::Read;
use std::path::{Path, PathBuf};

/// A case and changes to it.
#[derive(Debug, Args)]
pub(crate) struct CaseSource {
    /// Case file (TOML). A single - is standard input
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub(crate) case: PathBuf,
    /// Set a key of the case for this run, as air.velocity="20 m/s"; can be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_and_value)]
    pub(crate) set: Vec<(String, String)>,
    /// What standard input gave, which can be read once
    #[arg(skip)]
    read: OnceCell<String>,
}

/// The values of `--set`, as messages name them.
pub(crate) fn overrides(values: &[(String, String)]) -> Overrides<'_> {
    Overrides::new(values, "--set")
}

impl CaseSource {
    /// Reads the case with the values of `--set` and these.
    pub(crate) fn read(
        &self,
        more: &[(&str, String)],
        resources: &Resources,
    ) -> Result<CaseWithNotes, Error> {
        let more = more.iter().map(|(key, value)| ((*key).to_owned(), value.clone()));
        let values: Vec<_> = self.set.iter().cloned().chain(more).collect();
        let overrides = overrides(&values).with(resources);
        if !is_standard(&self.case) {
            return read_case(&self.case, overrides);
        }
        let text = self.read.get().map_or_else(standard_input, |text| Ok(text.clone()))?;
        read_case((self.read.get_or_init(|| text), STANDARD_INPUT), overrides)
    }

    /// The same as arguments of a command line; what is set has a folder of its own.
    ///
    /// * `name` – of its results
    pub(crate) fn words(&self, name: &str) -> String {
        let set = self.set.iter().map(|(key, value)| format!(" --set {}", quoted(&format!("{key}={value}"))));
        let all = self.set.iter().map(|(key, value)| (&**key, &**value));
        let out = format!(" --out {}", quoted(&beside_of(&format!("results/{name}"), all)));
        let out = if self.set.is_empty() { "" } else { &out };
        quoted(&self.case.to_string_lossy()) + &set.collect::<String>() + out
    }
}

/// Whether a path means standard input or output.
pub(crate) fn is_standard(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// What messages call it.
const STANDARD_INPUT: &str = "standard input";

/// The text on standard input, which is no longer than that of a file.
fn standard_input() -> Result<String, Error> {
    let mut bytes = Vec::new();
    let refused = |fault| Error::File(Box::new(Diagnostic::with_path(Path::new(STANDARD_INPUT), fault)));
    let advice = "name the file of a case";
    let most = LARGEST_FILE + 1;
    std::io::stdin()
        .lock()
        .take(most)
        .read_to_end(&mut bytes)
        .map_err(|error| refused(Fault::new(format!("cannot be read: {error}"), advice)))?;
    if bytes.len() as u64 == most {
        return Err(refused(Fault::new(format!("is longer than {LARGEST_FILE} bytes"), advice)));
    }
    text_of(bytes, STANDARD_INPUT).map_err(Error::File)
}

pub(super) fn key_and_value(text: &str) -> Result<(String, String), String> {
    match text.split_once('=').map(|(key, value)| (key.trim(), value.trim())) {
        Some((key, value)) if !key.is_empty() => Ok((key.to_owned(), value.to_owned())),
        _ => Err("write a key and a value, as air.velocity=\"20 m/s\"".to_owned()),
    }
}
