//! The changed webs of a file.

use super::super::web::AssumedValue;
use super::super::{Overrides, Source};
use super::Base;
use super::line::WebToChange;
use super::web::WebBase;
use spunlaid_experiment::{Change, setting};
use spunlaid_fibre::case::keys::VariedKey;
use spunlaid_ground::{ChangedKey, Error, FileKind};

/// Which changes of a web are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Changes {
    /// One setting of the line, on the belt that lays the same weight.
    OfLine,
    /// Half and twice of each number that the file calls an assumed value (`web.assumed`).
    OfAssumedValues,
}

/// Reads the file of a web and makes changed webs of it.
///
/// # Errors
/// If the web cannot be read.
pub fn read_changes<'a>(
    source: impl Into<Source<'a>>,
    set: Overrides<'_>,
    changes: Changes,
) -> Result<Vec<Change>, Error> {
    source.into().open(FileKind::Web, set, |text, name, resources| {
        let base = WebBase::new(text, name.to_owned(), &[set], resources)?;
        let web = WebToChange { base: &base, set: set.values, resources };
        Ok(match changes {
            Changes::OfLine => web.changes_of_line(),
            Changes::OfAssumedValues => changes_of_assumed_values(&web),
        })
    })
}

/// The factors on an assumed value.
const FACTORS: [f64; 2] = [0.5, 2.0];
/// Largest lateral wave number times the length of the eddies.
const CUTOFF: &str = "air.lateral_cutoff";
/// AssumedValues at the length of the eddies. Half as long ones keep the smallest waves across, because a field of
/// half as long waves would take four times the memory.
const OF_EDDIES: [&str; 3] = ["air.length_factor", "air.length_scale", "air.length_constant"];

fn changes_of_assumed_values(web: &WebToChange<'_>) -> Vec<Change> {
    let spec = web.base.spec();
    let named = spec.assumed.iter().filter_map(|name| Some((name, AssumedValue::new(spec, name).ok()?)));
    named
        .flat_map(|(name, assumed)| FACTORS.map(|factor| with_assumed_value(web, name, &assumed, factor)))
        .flatten()
        .collect()
}

/// The web with another value of an assumed value; None if that is no other value.
fn with_assumed_value(
    web: &WebToChange<'_>,
    name: &str,
    assumed: &AssumedValue,
    factor: f64,
) -> Option<Change> {
    let value = factor * assumed.value;
    let to = if assumed.kind.dimension().is_none() { value.round().max(1.0) } else { value };
    let mut values: Vec<(VariedKey, f64)> =
        assumed.keys.iter().map(|key| (VariedKey::new(key, assumed.kind), to)).collect();
    let key = web.changed_key(&values.first()?.0, [assumed.value, to]);
    if OF_EDDIES.contains(&name)
        && factor < 1.0
        && let Some(cutoff) = web.base.spec().lateral_cutoff(0)
    {
        values.push((web.base.varied(CUTOFF).ok()?, factor * cutoff));
    }
    let keys = vec![ChangedKey { key: name.to_owned(), ..key }];
    let new = values.iter().map(|(key, value)| web.setting(key, *value)).collect();
    (to != assumed.value).then(|| web.change(setting::ASSUMED, Vec::new(), keys, new, web.with(&values)))
}
