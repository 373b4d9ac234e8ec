//! Numbers that the file of a web says are assumed values.

use super::read::WebParser;
use super::{flies_none, is_of_case};
use spunlaid_experiment::setting::SETTINGS;
use spunlaid_fibre::case::keys::{self, Kind};
use spunlaid_ground::error::nearest_word;
use spunlaid_ground::{Dimension, Fault};
use spunlaid_simulation::layers::full_names::{full_name, value, web_key};
use spunlaid_simulation::layers::keys::WEB;
use spunlaid_simulation::{SAME, WEB_KEYS, WebKey, WebSpec};

/// The key whose value names them.
const GUESSED: &str = "web.assumed";

/// A number that is an assumed value.
#[derive(Clone, Debug)]
pub(crate) struct AssumedValue {
    /// The full names of its keys: of a key that every layer has, those of all layers.
    pub(crate) keys: Vec<String>,
    /// What kind of number it is.
    pub(crate) kind: Kind,
    /// Its value [SI].
    pub(crate) value: f64,
}

impl AssumedValue {
    /// The number of a key.
    ///
    /// * `name` – as the file of the web has it
    ///
    /// # Errors
    /// If it has no half and no twice: a name that is no key, a word, a temperature, zero, or several numbers.
    pub(crate) fn new(web: &WebSpec, name: &str) -> Result<Self, Fault> {
        let flies = web.flies();
        let (keys, kind, varies, values) = match keys::find(name).filter(|_| is_of_case(name, flies)) {
            Some(_) if !flies => {
                return Err(Fault::new(format!("names {name}"), format!("it {}", flies_none())));
            }
            Some(key) if web.cases().any(|case| key.is_derived(case)) => return Err(given_by_flow(name)),
            Some(key) => {
                let values = web.cases().map(|case| key.get(case).and_then(|value| value.number())).collect();
                (vec![name.to_owned()], key.kind, key.varies, values)
            }
            None => {
                let (keys, key) = keys_of_web(web, name)?;
                let number = |full: &String| value(web, full).and_then(|value| value.number());
                let values: Vec<Option<f64>> = keys.iter().map(number).collect();
                (keys, key.kind, key.varies, values)
            }
        };
        let is_halved = match kind {
            Kind::Quantity(dimension, _) => dimension != Dimension::Temperature,
            Kind::Whole(..) => true,
            _ => false,
        };
        if !(varies && is_halved) {
            let remedy = "name keys whose value is a number, but no temperature";
            return Err(Fault::new(format!("names {name}, which cannot be halved or doubled"), remedy));
        }
        let Some(value) = values.first().copied().flatten().filter(|value| *value != 0.0) else {
            let remedy = "name the key that gives the number, or take it out";
            return Err(Fault::new(format!("names {name}, which is zero or not written here"), remedy));
        };
        let is_same = |other: &Option<f64>| other.is_some_and(|other| (other / value - 1.0).abs() <= SAME);
        if !values.iter().all(is_same) {
            let remedy = format!("name that of each layer, as in layer.1.{name}, or take it out");
            return Err(Fault::new(format!("names {name}, which is not the same in all layers"), remedy));
        }
        Ok(Self { keys, kind, value })
    }
}

/// The fault of a number of the air that a profile, a field or a record gives.
fn given_by_flow(name: &str) -> Fault {
    let remedy = match name {
        "air.velocity" => "name air.speed_factor",
        "air.turbulence_intensity" => "name air.intensity_factor",
        "air.length_scale" | "air.cutoff_frequency" => "name air.length_factor",
        _ => "take it out",
    };
    Fault::new(format!("names {name}, which is given by a file"), remedy)
}

/// The full names of a key of the web: without a number of a layer, those of all layers.
fn keys_of_web(web: &WebSpec, name: &str) -> Result<(Vec<String>, &'static WebKey), Fault> {
    let of_layers = WEB.find(name).is_some_and(|key| ["fibre", "laydown", "line"].contains(&key.table()));
    let keys = match of_layers && web.layers.len() > 1 {
        true => Ok((1..=web.layers.len()).map(|number| format!("layer.{number}.{name}")).collect()),
        false => full_name(web, name).map(|full| vec![full]),
    };
    let keys = keys.map_err(|remedy| Fault::new(format!("names {name}"), remedy))?;
    let key = keys.first().and_then(|full| web_key(full)).ok_or_else(|| {
        let names = WEB_KEYS.iter().map(|key| key.name).chain(keys::all().iter().map(|key| key.name));
        let remedy = match nearest_word(name, names) {
            Some(near) => format!("did you mean {near}?"),
            None => "spunlaid keys --web and spunlaid keys list them".to_owned(),
        };
        Fault::new(format!("names {name}, which is not a key of the web or of its cases"), remedy)
    })?;
    Ok((keys, key))
}

/// The key that names the settings of the running line.
const TURNABLE: &str = "web.turnable";

impl WebParser<'_> {
    /// Refuses settings that a line does not have.
    pub(super) fn check_turnable(&mut self, web: &WebSpec) {
        let is_known = |name: &&String| SETTINGS.iter().any(|setting| setting.name == *name);
        if let Some(name) = web.turnable.iter().flatten().find(|name| !is_known(name)) {
            let all = SETTINGS.map(|setting| setting.name);
            let remedy = match nearest_word(name, all.into_iter()) {
                Some(near) => format!("did you mean {near}?"),
                None => format!("write some of {}", all.join(", ")),
            };
            self.key_values
                .reject(TURNABLE, Fault::new(format!("names {name}, which is not a setting"), remedy));
        }
    }

    /// Refuses assumed values that are no numbers.
    pub(super) fn check_assumed(&mut self, web: &WebSpec) {
        // What other problems hide is not known.
        if self.key_values.problems.is_empty()
            && let Some(fault) = web.assumed.iter().find_map(|name| AssumedValue::new(web, name).err())
        {
            self.key_values.reject(GUESSED, fault);
        }
    }
}
