//! The webs of advice: the same web with one setting of the line changed, on the belt that lays the same weight.

use super::super::Overrides;
use super::super::unread::Unread;
use super::open_web::{OpenWeb, changed_webs, changed_webs_of_file};
use super::{Base, VariedKey};
use crate::advice::{Change, ChangedKey, Setting};
use crate::air::{Air, Flow};
use crate::layers::{LaydownSource, LayerSpec, Method, WebSpec, web_key};
use crate::units::Dimension;
use crate::web::Filaments;
use std::path::Path;

/// The factors by which settings are changed.
const FACTORS: [f64; 2] = [0.8, 1.2];
/// The change of the temperature of a die, for each of the factors [K].
const KELVINS: [f64; 2] = [-10.0, 10.0];

/// Reads the file of a web and makes the webs in which one setting of its line is changed.
///
/// # Errors
/// If the web cannot be read. And what has to be flown first, if a case has a spinline whose tension is that of flights.
pub fn read_changes(path: &Path, set: Overrides<'_>) -> Result<Vec<Change>, Unread<Vec<Change>>> {
    changed_webs_of_file(path, set, changes)
}

/// [`read_changes`] of a text.
///
/// # Errors
/// As [`read_changes`].
pub fn parse_changes(
    text: String,
    name: &str,
    set: Overrides<'_>,
) -> Result<Vec<Change>, Unread<Vec<Change>>> {
    changed_webs(text, name, set, changes)
}

fn changes(web: OpenWeb<'_>) -> Vec<Change> {
    let is_laid = |layer: &LayerSpec| matches!(layer.source, LaydownSource::Results { .. });
    if web.base.spec().layers.iter().any(is_laid) {
        // What has been flown lies on the belt of its flight.
        return Vec::new();
    }
    Line { web }.changes()
}

/// Digits of a changed setting.
const CHANGED: usize = 4;
/// Digits of what is held and stands in no file: it is rounded by less than 0.01 %.
const HELD: usize = 5;

/// A number as a person would write it in a file, of so many digits in its unit.
fn rounded(dimension: Dimension, number: f64, digits: usize) -> f64 {
    dimension.parse(&dimension.pretty_to(number, digits)).unwrap_or(number)
}

/// The key of the throughput of a hole.
const THROUGHPUT: &str = "line.throughput";

/// The throughput of a hole of a layer, with a power of the factor.
fn throughput(layer: usize, power: f64) -> (String, f64) {
    (format!("layer.{layer}.{THROUGHPUT}"), power)
}

/// The line of a web, whose settings change.
struct Line<'a> {
    web: OpenWeb<'a>,
}

/// Keys that change together, each with the power of the factor by which it changes.
type KeyPowers = Vec<(String, f64)>;

impl Line<'_> {
    fn spec(&self) -> &WebSpec {
        self.web.base.spec()
    }

    fn changes(&self) -> Vec<Change> {
        let mut changes = Vec::new();
        let groups = self.equal_layers();
        // Nobody has to say which layers where all are changed.
        let numbers = |group: &Vec<usize>| if groups.len() > 1 { group.clone() } else { Vec::new() };
        let of_each = |group: &Vec<usize>, keys: &dyn Fn(usize) -> KeyPowers| -> KeyPowers {
            group.iter().flat_map(|layer| keys(*layer)).collect()
        };
        for group in &groups {
            let throughputs = of_each(group, &|layer| vec![throughput(layer, 1.0)]);
            changes.extend(self.change(Setting::Throughput, &numbers(group), &[throughputs]));
            let holes = of_each(group, &|layer| self.holes(layer));
            changes.extend(self.change(Setting::Holes, &numbers(group), &[holes]));
        }
        for group in groups.iter().filter(|group| self.spec().layers[group[0] - 1].source.case().is_none()) {
            let titres = of_each(group, &|layer| {
                vec![(format!("layer.{layer}.fibre.linear_density"), 1.0), throughput(layer, 0.0)]
            });
            changes.extend(self.change(Setting::Titre, &numbers(group), &[titres]));
        }
        for (setting, ways) in self.settings_of_all_layers() {
            changes.extend(self.change(setting, &[], &ways));
        }
        changes
    }

    /// The numbers of the layers, from 1, equal ones together: they differ in nothing but their names.
    fn equal_layers(&self) -> Vec<Vec<usize>> {
        let layers = &self.spec().layers;
        let unnamed = |number: usize| LayerSpec { name: None, ..layers[number - 1].clone() };
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for number in 1..=layers.len() {
            match groups.iter_mut().find(|group| unnamed(group[0]) == unnamed(number)) {
                Some(group) => group.push(number),
                None => groups.push(vec![number]),
            }
        }
        groups
    }

    /// The settings that all layers share, each with the ways to change it, the best first.
    fn settings_of_all_layers(&self) -> Vec<(Setting, Vec<KeyPowers>)> {
        let alone = |keys: &[&str]| keys.iter().map(|key| vec![((*key).to_owned(), 1.0)]).collect();
        let is_flown = |layer: &usize| self.spec().layers[layer - 1].source.case().is_some();
        let titre = (1..=self.spec().layers.len()).filter(is_flown);
        let titre = titre
            .flat_map(|layer| [(format!("layer.{layer}.fibre.linear_density"), 1.0), throughput(layer, 0.0)]);
        let titre = titre.collect();
        let is_spun = self.web.base.number_of_cases("spinline.throughput").is_some();
        let mut all = vec![
            // The spinline decides the titre.
            (Setting::Titre, if is_spun { Vec::new() } else { vec![titre] }),
            (Setting::DrawingAir, alone(&["spinline.velocity_factor", "spinline.velocity"])),
            (Setting::DieTemperature, alone(&["spinline.die_temperature"])),
            (Setting::Distance, alone(&["belt.distance"])),
            (Setting::AirSpeed, alone(&["air.speed_factor", "air.velocity"])),
            (
                Setting::Turbulence,
                // A web that names the factor as a guess has no other number in its place.
                match self.is_evenly_turbulent() {
                    true => alone(&["air.turbulence_intensity", "air.intensity_factor"]),
                    false => Vec::new(),
                },
            ),
        ];
        if self.spec().method == Method::SharedAir {
            all.push((
                Setting::Depth,
                vec![self.powers_of_each(|layer, filaments| match filaments {
                    Filaments::Slot { .. } => vec![(format!("layer.{layer}.line.depth"), 1.0)],
                    _ => Vec::new(),
                })],
            ));
            all.push((
                Setting::RowPlaces,
                vec![self.powers_of_each(|layer, filaments| {
                    match filaments {
                        Filaments::Rows(rows) => (1..)
                            .zip(rows)
                            .filter(|(_, row)| row.md != 0.0)
                            .map(|(row, _)| (format!("layer.{layer}.line.rows.{row}.md"), 1.0))
                            .collect(),
                        _ => Vec::new(),
                    }
                })],
            ));
        }
        all
    }

    /// Whether one number tells how turbulent the air of the cases is. A flow whose turbulence differs from place to place would become another flow.
    fn is_evenly_turbulent(&self) -> bool {
        let is_even = |air: &Air| match &air.flow {
            Flow::Profile(profile) => profile.turbulence_intensity.windows(2).all(|pair| pair[0] == pair[1]),
            Flow::Uniform | Flow::Field(_) => true,
        };
        let mut cases = self.spec().layers.iter().filter_map(|layer| layer.source.case());
        cases.all(|case| {
            !case.air.from_flow.turbulence_intensity || (!case.air.flow.is_field() && is_even(&case.air))
        })
    }

    /// What each layer adds to a way.
    fn powers_of_each(&self, keys: impl Fn(usize, &Filaments) -> KeyPowers) -> KeyPowers {
        (1..).zip(&self.spec().layers).flat_map(|(layer, spec)| keys(layer, &spec.filaments)).collect()
    }

    /// The keys of the holes of a layer.
    fn holes(&self, layer: usize) -> KeyPowers {
        let line = format!("layer.{layer}.line");
        match &self.spec().layers[layer - 1].filaments {
            Filaments::AtRandom { .. } | Filaments::Slot { .. } => {
                vec![(format!("{line}.filaments_per_metre"), 1.0)]
            }
            Filaments::Rows(rows) => (1..)
                .zip(rows)
                .flat_map(|(number, row)| {
                    let key = |name: &str, power| (format!("{line}.rows.{number}.{name}"), power);
                    // A row stays as wide as it is.
                    let pitch = (!row.is_even).then(|| key("pitch", -1.0));
                    std::iter::once(key("filaments", 1.0)).chain(pitch)
                })
                .collect(),
        }
    }

    /// The value of a key.
    fn number(&self, name: &str, key: &VariedKey) -> Option<f64> {
        let number = self.web.base.value(key);
        if !number.is_nan() && !name.starts_with("layer.") {
            return self.web.base.number_of_cases(name);
        }
        if !number.is_nan() {
            return Some(number);
        }
        // Another key may stand in its place.
        let layer = name.strip_prefix("layer.")?.split('.').next()?.parse::<usize>().ok()?;
        web_key(name)?.value_in(&self.spec().alone(layer.checked_sub(1)?))?.number()
    }

    /// The webs with less and with more of a setting, in the first of some ways in which both can be made; none if there is no such way.
    fn change(&self, setting: Setting, layers: &[usize], ways: &[KeyPowers]) -> Vec<Change> {
        let of_way = |way: &KeyPowers| -> Option<Vec<Change>> {
            let known: Vec<(VariedKey, f64, f64)> = (way.iter())
                .map(|(name, power)| {
                    let key = self.web.base.varied(name).ok()?;
                    let number = self.number(name, &key).filter(|number| *number != 0.0)?;
                    Some((key, number, *power))
                })
                .collect::<Option<_>>()?;
            let some: Vec<Change> =
                (0..FACTORS.len()).filter_map(|i| self.changed(setting, layers, &known, i)).collect();
            (!some.is_empty() && !known.is_empty()).then_some(some)
        };
        ways.iter().find_map(of_way).unwrap_or_default()
    }

    /// The web with the known keys changed by one of the factors; None if it cannot be made.
    fn changed(
        &self,
        setting: Setting,
        layers: &[usize],
        known: &[(VariedKey, f64, f64)],
        which: usize,
    ) -> Option<Change> {
        let mut factor = 1.0_f64;
        let to = |(key, from, power): &(VariedKey, f64, f64)| {
            let to = match (setting, key.dimension()) {
                (Setting::DieTemperature, Dimension::Temperature) => from + KELVINS[which],
                _ if *power == 0.0 && self.is_held(key) => *from,
                (_, dimension) if *power == 0.0 => rounded(dimension, *from, HELD),
                _ if key.is_whole() => (from * FACTORS[which]).round().max(1.0),
                (_, dimension) if *power == 1.0 => rounded(dimension, from * FACTORS[which], CHANGED),
                // A row stays as wide as its web, to the last digit.
                _ => from * factor.powf(*power),
            };
            // What comes behind follows from the rounded number, as the pitch of a row from its holes.
            if *power == 1.0 {
                factor = to / from;
            }
            (key.clone(), to)
        };
        let values: Vec<(VariedKey, f64)> = known.iter().map(to).collect();
        let mut spec = self.web.base.changed(&values, self.web.lookup).ok()?.spec;
        let belt = spec.belt_speed_for(self.weight());
        let slowest = spec.layers.iter().map(|layer| layer.feed_speed).fold(f64::INFINITY, f64::min);
        if belt.is_nan() || belt > slowest {
            return None;
        }
        spec.set_belt_speed(belt).ok()?;
        let changed = |((key, from, power), (_, to)): (&(VariedKey, f64, f64), &(VariedKey, f64))| {
            let (dimension, whole) = (key.dimension(), key.is_whole());
            let key = self.web.base.short_name(&key.name).to_owned();
            (*power != 0.0 && from != to).then_some(ChangedKey {
                key,
                dimension,
                whole,
                from: *from,
                to: *to,
            })
        };
        let keys: Vec<ChangedKey> = known.iter().zip(&values).filter_map(changed).collect();
        let (layers, file) = (layers.to_vec(), self.web.base.path().to_owned());
        let set = self.settings_of(&values);
        (!keys.is_empty()).then_some(Change { setting, layers, keys, file, set, spec, refusal: None })
    }

    /// Whether the file says the throughput of a layer itself, so that it holds.
    fn is_held(&self, key: &VariedKey) -> bool {
        let layer = key.name.strip_prefix("layer.").and_then(|rest| rest.split_once('.'));
        let layer = layer.filter(|(_, name)| *name == THROUGHPUT);
        let layer = layer.and_then(|(number, _)| self.spec().layers.get(number.parse::<usize>().ok()? - 1));
        layer.is_some_and(|layer| layer.throughput.is_some_and(|held| held == self.web.base.value(key)))
    }

    /// The keys and values that make a changed web of the file: what was set before, unless it is replaced, the values, and what else has to be held.
    fn settings_of(&self, values: &[(VariedKey, f64)]) -> Vec<(String, String)> {
        let spec = self.spec();
        let is_new =
            |(key, value): &&(VariedKey, f64)| !(self.is_held(key) && *value == self.web.base.value(key));
        let mut new: Vec<(String, String)> =
            values.iter().filter(is_new).map(|value| self.web.setting(value)).collect();
        if spec.basis_weight.is_none() {
            let weight = self.web.base.short_name("layer.1.line.basis_weight").to_owned();
            new.push((weight, Dimension::BasisWeight.written(self.weight())));
        }
        self.web.with_settings(new)
    }

    /// Mass per area of the changed webs [kg/m²].
    fn weight(&self) -> f64 {
        let spec = self.spec();
        let belt = spec.layers.first().map_or(f64::NAN, |layer| layer.belt_speed);
        let found = || rounded(Dimension::BasisWeight, spec.mass_flow() / belt, HELD);
        spec.basis_weight.unwrap_or_else(found)
    }
}
