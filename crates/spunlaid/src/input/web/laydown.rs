//! What tells how the filaments of a layer lie.

use super::super::{Overrides, file, parse_with};
use super::read::{Reading, THROUGHPUT};
use crate::case::keys::{Value, find};
use crate::case::{Case, Note};
use crate::error::{Error, Fault, FileKind, Place};
use crate::layers::LaydownSource;
use crate::layers::keys::{METHODS, NUMBERS, ONE_SOURCE};
use std::path::{Path, PathBuf};
use std::sync::Arc;

const CASE: &str = "laydown.case";
const RESULTS: &str = "laydown.results";
/// Files of a finished run.
const SUMMARY: &str = "summary.json";
const CASE_OF_RESULTS: &str = "case.toml";

impl Reading<'_> {
    /// What tells how the filaments of a layer lie; none if there is a problem with it, which is noted.
    ///
    /// # Errors
    /// A case that cannot be read for another reason than what is in it.
    pub(super) fn laydown(&mut self, prefix: &str) -> Result<Option<LaydownSource>, Error> {
        let is_written = |name: &&&str| self.is_written(&format!("{prefix}{name}"));
        let numbers = NUMBERS.iter().find(is_written);
        let ways: Vec<&'static str> =
            [&CASE, &RESULTS].into_iter().chain(numbers).filter(is_written).copied().collect();
        match ways[..] {
            [] if self.key_values.is_excused(&format!("{prefix}laydown.")) => Ok(None),
            [] => {
                let fault = Fault::new(
                    "says nothing of how the fibres lie",
                    "write in it case = \"spunbond.toml\" (a case to fly), results = \"results/spunbond\" (a finished run), \
                     or sigma_md, sigma_cd and noise",
                );
                self.key_values.reject(&format!("{prefix}laydown"), fault);
                Ok(None)
            }
            [CASE] => self.case(prefix),
            [RESULTS] => self.results(&format!("{prefix}{RESULTS}")),
            // They are still to be set.
            [_] => Ok(Some(LaydownSource::UNKNOWN)),
            [other, ref more @ ..] => {
                for way in more {
                    self.key_values.reject(&format!("{prefix}{way}"), Fault::excludes(other, ONE_SOURCE));
                }
                Ok(None)
            }
        }
    }

    fn case(&mut self, prefix: &str) -> Result<Option<LaydownSource>, Error> {
        let key = format!("{prefix}{CASE}");
        let Some(path) = self.path(&key) else { return Ok(None) };
        let unflown = self.lookup.unflown_cases();
        let in_one_air = self.set_in_one_air();
        let in_one_air = Overrides { values: &in_one_air, word: "web.method as" };
        let of_case = [self.of_case, &[in_one_air]].concat();
        let read = self.read_case(&path, &of_case);
        let change = match &read {
            // How a case whose tension is still to be found has to change is known when it is.
            Ok((case, _)) if self.lookup.unflown_cases() == unflown => {
                self.change_throughput(prefix, case, &path)
            }
            _ => None,
        };
        let read = match change {
            None => read,
            Some(change) => {
                let change = Overrides { values: &[change], word: "line.throughput as" };
                let read = self.read_case(&path, &[&of_case[..], &[change]].concat());
                if let Err(Error::Rejected(_)) = &read {
                    let message = format!(
                        "cannot be flown by {} (the message about that file says why)",
                        path.display()
                    );
                    let fault = Fault::new(message, "write another throughput, or change the case");
                    self.key_values.reject(&format!("{prefix}{THROUGHPUT}"), fault);
                }
                read
            }
        };
        let case = self.fed_case(&key, read)?;
        Ok(case.map(|case| LaydownSource::Case { path, case }))
    }

    /// What the cases of a web in one air have anyway, and must say for the keys that are set for them.
    fn set_in_one_air(&self) -> Vec<(String, String)> {
        if self.key_values.text("web.method").is_some_and(|method| method != METHODS[2]) {
            return Vec::new();
        }
        let set = || self.of_case.iter().flat_map(|set| set.values).map(|(key, _)| key.trim());
        let needed = set().filter_map(|key| find(key)?.relations.with_in_one_air);
        let new = needed.filter(|(needed, _)| !set().any(|key| key == *needed));
        new.map(|(key, value)| (key.to_owned(), value.to_owned())).collect()
    }

    fn results(&mut self, key: &str) -> Result<Option<LaydownSource>, Error> {
        let Some(folder) = self.path(key) else { return Ok(None) };
        if let Some(missing) =
            [SUMMARY, CASE_OF_RESULTS].into_iter().find(|name| !folder.join(name).is_file())
        {
            let fault = Fault::new(
                format!("does not hold the results of a run ({missing} is not there)"),
                "name a folder that `spunlaid run` has written",
            );
            self.key_values.reject(key, fault);
            return Ok(None);
        }
        let read = self.read_case(&folder.join(CASE_OF_RESULTS), &[]);
        let case = self.fed_case(key, read)?;
        Ok(case.map(|case| LaydownSource::Results { folder, case }))
    }

    /// The path that a key names: of the file, relative to its folder.
    fn path(&self, key: &str) -> Option<PathBuf> {
        let written_value = self.key_values.get(key)?;
        let Some(Value::Text(named)) = &written_value.value else { return None };
        Some(match &written_value.place {
            Place::Override(_) => PathBuf::from(named),
            _ => self.folder.join(named),
        })
    }

    fn read_case(&self, path: &Path, changes: &[Overrides<'_>]) -> Result<(Case, Vec<Note>), Error> {
        let text = match self.cases.iter().find(|(case, _)| case == path) {
            Some((_, text)) => Ok(text.clone()),
            None => file::read(path, FileKind::Case),
        };
        let name = path.display().to_string();
        let unflown = self.lookup.unflown_cases();
        let read = text.and_then(|text| parse_with(self.lookup, &text, &name, changes));
        if self.lookup.unflown_cases() > unflown {
            // What the web has from a case, it has from one with another tension.
            self.lookup.doubt();
        }
        read
    }

    /// A case whose fibres are laid down on a moving belt.
    fn fed_case(
        &mut self,
        key: &str,
        read: Result<(Case, Vec<Note>), Error>,
    ) -> Result<Option<Arc<Case>>, Error> {
        let (case, notes) = match read {
            Ok(read) => read,
            Err(Error::File(error)) => {
                self.key_values.reject(key, error.into());
                return Ok(None);
            }
            Err(Error::Rejected(problems)) => {
                self.key_values.problems.extend(problems);
                return Ok(None);
            }
            Err(other) => return Err(other),
        };
        let fault = match case.line {
            None => Fault::new(
                "is the case of a fibre of fixed length, which lays nothing",
                "name a case with [feed] and [belt]",
            ),
            Some(line) if line.belt_speed <= 0.0 => Fault::new(
                "has a belt that stands still (belt.speed = 0 m/s), on which no web is laid",
                "give the belt of the case a speed",
            ),
            Some(_) => {
                self.note(notes);
                if let Some(what) = case.slows_only() {
                    let note =
                        Note { place: self.key_values.whole(), key: key.to_owned(), value: None, what };
                    self.note(vec![self.key_values.placed(note)]);
                }
                return Ok(Some(Arc::new(case)));
            }
        };
        self.key_values.reject(key, fault);
        Ok(None)
    }
}
