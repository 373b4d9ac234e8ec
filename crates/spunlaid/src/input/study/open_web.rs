//! The file of a web with what is set beside it, of which changed webs are made.

use super::super::Resources;
use super::super::entry::Entry;
use super::super::step::changed_key;
use super::super::web::{WebFile, replaces};
use super::VariedKey;
use super::web::WebBase;
use crate::advice::{Change, ChangedWeb};
use crate::effects::{ChangedKey, Setting};
use crate::error::Error;
use crate::layers::WebSpec;

/// A web that is changed.
pub(super) struct OpenWeb<'a> {
    pub(super) base: &'a WebBase,
    /// What is set beside the file.
    pub(super) set: &'a [(String, String)],
    pub(super) resources: &'a Resources,
}

impl OpenWeb<'_> {
    /// The web with these values of keys.
    pub(super) fn with(&self, values: &[(VariedKey, f64)]) -> Result<WebFile, Error> {
        self.base.changed(values, self.resources)
    }

    /// What has changed of a key, with the name that it has in the file.
    pub(super) fn changed_key(&self, key: &VariedKey, ends: [f64; 2]) -> ChangedKey {
        changed_key(self.base.short_name(&key.name).to_owned(), key.kind, ends)
    }

    /// A value of a key as it is set in the file.
    pub(super) fn setting(&self, (key, value): &(VariedKey, f64)) -> (String, String) {
        let word = key.words().get(*value as usize).map(|word| (*word).to_owned());
        let number = || if key.is_whole() { format!("{value:.0}") } else { key.dimension().written(*value) };
        (self.base.short_name(&key.name).to_owned(), word.unwrap_or_else(number))
    }

    /// A change that makes a web of this one.
    ///
    /// * `new` – keys and values that have to be set in the file for it; what was set before stays, unless it
    ///   is replaced
    /// * `made` – the web, or why there is none
    pub(super) fn change(
        &self,
        (setting, layers): (Setting, Vec<usize>),
        keys: Vec<ChangedKey>,
        new: Vec<(String, String)>,
        made: Result<WebFile, Error>,
    ) -> Change {
        let is_replaced = |set: &str| new.iter().any(|(key, _)| replaces(key, set.trim()));
        let before = self.set.iter().filter(|(key, _)| !is_replaced(key));
        let before = before.map(|(key, value)| (key.clone(), Entry::plain_override(value)));
        let set = before.chain(new.iter().cloned()).collect();
        let (spec, refusal) = match made {
            Ok(made) => (made.spec, None),
            Err(why) => (self.base.spec().clone(), Some(why.to_string())),
        };
        let belt_speed = |spec: &WebSpec| spec.layers.first().map_or(f64::NAN, |layer| layer.belt_speed);
        let ends = [self.base.spec(), &spec];
        let (belt_speed, mass_flow) = (ends.map(belt_speed), ends.map(WebSpec::mass_flow));
        let file = self.base.path().to_owned();
        let experiment = ChangedWeb { file, set, spec, belt_speed, mass_flow };
        Change { setting, layers, keys, experiment, refusal }
    }
}
