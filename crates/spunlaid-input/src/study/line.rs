//! The settings of a line that can be turned, and the webs of advice: the same web with one of them changed, on the
//! belt that lays the same weight.

use super::super::Resources;
use super::super::entry::Entry;
use super::super::influence::{Step, changed_key};
use super::super::web::WebFile;
use super::Base;
use super::web::WebBase;
use spunlaid_air::{Air, Flow};
use spunlaid_experiment::plausible::outside;
use spunlaid_experiment::{Change, ChangedWeb, setting};
use spunlaid_fibre::FilamentFeed;
use spunlaid_fibre::case::keys::VariedKey;
use spunlaid_ground::{ChangedKey, Dimension, Error, Setting};
use spunlaid_simulation::layers::full_names::{replaced_by, web_key};
use spunlaid_simulation::{LayerSpec, WebSpec};
use spunlaid_web::map::Filaments;

/// How settings are changed.
const STEPS: [Step; 2] = [Step { factor: 0.8, kelvin: -10.0 }, Step { factor: 1.2, kelvin: 10.0 }];

/// Digits of a changed setting.
const CHANGED: usize = 4;
/// Digits of what is held and stands in no file: it is rounded by less than 0.01 %.
const HELD: usize = 5;

/// A number as a person would write it in a file, of so many digits in its unit.
fn rounded(dimension: Dimension, number: f64, digits: usize) -> f64 {
    dimension.parse(&dimension.pretty_to(number, digits)).unwrap_or(number)
}

/// The key of the throughput of a hole, and those of the belt.
const THROUGHPUT: &str = "line.throughput";
const BELT_SPEED: &str = "layer.1.line.belt_speed";
const BASIS_WEIGHT: &str = "layer.1.line.basis_weight";

/// The throughput of a hole of a layer, with a power of the factor.
fn throughput(layer: usize, power: f64) -> (String, f64) {
    (format!("layer.{layer}.{THROUGHPUT}"), power)
}

/// Keys that change together, each with the power of the factor by which it changes.
type KeyPowers = Vec<(String, f64)>;

/// A setting of the line, and the keys by which it can be turned.
struct Ways {
    setting: Setting,
    /// The numbers of the layers in which it is turned, from 1; none where it is turned in all.
    layers: Vec<usize>,
    /// Keys that change together, the best ones first.
    ways: Vec<KeyPowers>,
}

/// A key that a setting turns.
#[derive(Clone, Debug)]
pub(super) struct KnownKey {
    pub(super) key: VariedKey,
    /// Its value in the file [SI].
    pub(super) from: f64,
    /// The power of the factor by which it changes; zero for one that is held.
    pub(super) power: f64,
}

/// A setting of the line with the keys that turn it.
#[derive(Clone, Debug)]
pub(super) struct LineKnob {
    pub(super) setting: Setting,
    /// As in [`Change::layers`].
    pub(super) layers: Vec<usize>,
    /// The first one says how far it is turned.
    pub(super) known: Vec<KnownKey>,
    /// The webs with less and with more of it; none of a setting of the belt.
    pub(super) changes: Vec<Change>,
}

impl WebToChange<'_> {
    fn spec(&self) -> &WebSpec {
        self.base.spec()
    }

    /// The changes of the settings of the line.
    pub(super) fn changes_of_line(&self) -> Vec<Change> {
        self.knobs().into_iter().flat_map(|knob| knob.changes).collect()
    }

    /// The settings of the line that can be turned.
    pub(super) fn knobs(&self) -> Vec<LineKnob> {
        self.settings().iter().filter_map(|ways| self.knob(ways)).collect()
    }

    /// The settings of the line, each with its ways.
    fn settings(&self) -> Vec<Ways> {
        let every: Vec<usize> = (1..=self.spec().layers.len()).collect();
        let of_each = |setting: Setting, layers: &[usize], keys: &dyn Fn(usize) -> KeyPowers| {
            let ways = vec![layers.iter().flat_map(|layer| keys(*layer)).collect::<KeyPowers>()];
            // Nobody has to say which layers where all are changed.
            let layers = if layers.len() == every.len() { Vec::new() } else { layers.to_vec() };
            Ways { setting, layers, ways }
        };
        let titre =
            |layer: usize| vec![(format!("layer.{layer}.fibre.linear_density"), 1.0), throughput(layer, 0.0)];
        let (groups, mut settings) = (self.equal_layers(), Vec::new());
        for group in &groups {
            settings.push(of_each(setting::THROUGHPUT, group, &|layer| vec![throughput(layer, 1.0)]));
            settings.push(of_each(setting::HOLES, group, &|layer| self.holes(layer)));
        }
        if self.spec().flies() {
            // The spinline decides the titre.
            if self.base.number_of_cases("spinline.throughput").is_none() {
                settings.push(of_each(setting::TITRE, &every, &titre));
            }
            let of_all = |(setting, ways)| Ways { setting, layers: Vec::new(), ways };
            settings.extend(self.settings_of_air().into_iter().map(of_all));
            settings.push(of_each(setting::DEPTH, &every, &|layer| self.depth(layer)));
            settings.push(of_each(setting::ROW_PLACES, &every, &|layer| self.row_places(layer)));
            settings.push(of_each(setting::CHARGE, &every, &|layer| self.charge(layer)));
        } else {
            settings.extend(groups.iter().map(|group| of_each(setting::TITRE, group, &titre)));
        }
        settings
    }

    /// A change that is refused if it leads to numbers that no such line has.
    fn refuse_outside(&self, change: Change) -> Change {
        let refusal = outside(self.spec(), &change.experiment.spec);
        Change { refusal: change.refusal.or(refusal), ..change }
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

    /// The settings of the spinline and of the air, each with the keys of which one changes it, the best first.
    fn settings_of_air(&self) -> Vec<(Setting, Vec<KeyPowers>)> {
        // A web that names the factor as an assumed value has no other number in its place.
        let turbulence: &[&str] = match self.is_evenly_turbulent() {
            true => &["air.turbulence_intensity", "air.intensity_factor"],
            false => &[],
        };
        let settings: [(Setting, &[&str]); 6] = [
            (setting::DRAWING_AIR, &["spinline.velocity_factor", "spinline.velocity"]),
            (setting::DIE_TEMPERATURE, &["spinline.die_temperature"]),
            (setting::QUENCH, &["spinline.cross_velocity_factor", "spinline.cross_velocity"]),
            (setting::DISTANCE, &["belt.distance"]),
            (setting::AIR_SPEED, &["air.cabin_pressure", "air.speed_factor", "air.velocity"]),
            (setting::TURBULENCE, turbulence),
        ];
        let alone = |key: &&str| vec![((*key).to_owned(), 1.0)];
        settings.map(|(setting, keys)| (setting, keys.iter().map(alone).collect())).to_vec()
    }

    /// Whether one number reports how turbulent the air of the cases is. A flow whose turbulence differs from
    /// place to place would become another flow.
    fn is_evenly_turbulent(&self) -> bool {
        let is_even = |air: &Air| match &air.flow {
            Flow::Profile(profile) => profile.turbulence_intensity.windows(2).all(|pair| pair[0] == pair[1]),
            Flow::Uniform | Flow::Field(_) => true,
        };
        self.spec().cases().all(|case| {
            !case.air.from_flow.turbulence_intensity || (!case.air.flow.is_field() && is_even(&case.air))
        })
    }

    /// The depth of the slot of a layer, if it has one.
    fn depth(&self, layer: usize) -> KeyPowers {
        match self.spec().layers[layer - 1].filaments {
            Filaments::Slot { .. } => vec![(format!("layer.{layer}.line.slot_gap"), 1.0)],
            _ => Vec::new(),
        }
    }

    /// The places of the rows of a layer.
    fn row_places(&self, layer: usize) -> KeyPowers {
        let Filaments::Rows(rows) = &self.spec().layers[layer - 1].filaments else { return Vec::new() };
        let rows = (1..).zip(rows).filter(|(_, row)| row.md != 0.0);
        rows.map(|(row, _)| (format!("layer.{layer}.line.rows.{row}.md"), 1.0)).collect()
    }

    /// The charge of a layer, if it has one.
    fn charge(&self, layer: usize) -> KeyPowers {
        let charge = self.spec().layers[layer - 1].charge.filter(|charge| *charge != 0.0);
        charge.map(|_| (format!("layer.{layer}.line.charge"), 1.0)).into_iter().collect()
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
        if let Some(number) = self.base.value(key) {
            return if name.starts_with("layer.") { Some(number) } else { self.base.number_of_cases(name) };
        }
        // Another key may stand in its place.
        let layer = name.strip_prefix("layer.")?.split('.').next()?.parse::<usize>().ok()?;
        web_key(name)?.value_in(&self.spec().alone(layer.checked_sub(1)?))?.number()
    }

    /// The keys that turn a setting, in the first of its ways in which the web can be made with less and with more of
    /// it; None if there is no such way.
    fn knob(&self, Ways { setting, layers, ways }: &Ways) -> Option<LineKnob> {
        ways.iter().find_map(|way| {
            let known: Option<Vec<KnownKey>> =
                way.iter().map(|(name, power)| self.known(name, *power)).collect();
            let mut knob = LineKnob {
                setting: setting::on_line_of(self.spec(), *setting),
                layers: layers.clone(),
                known: known.filter(|known| !known.is_empty())?,
                changes: Vec::new(),
            };
            let made = STEPS.iter().filter_map(|step| self.changed(&knob, *step));
            knob.changes = made.map(|change| self.refuse_outside(change)).collect();
            (!knob.changes.is_empty()).then_some(knob)
        })
    }

    /// A key that is changed; None if it has no number, or zero, which is no share of anything.
    fn known(&self, name: &str, power: f64) -> Option<KnownKey> {
        let key = self.base.varied(name).ok()?;
        let from = self.number(name, &key).filter(|number| *number != 0.0)?;
        Some(KnownKey { key, from, power })
    }

    /// The value of a knob in this web; None if it has none.
    pub(super) fn value(&self, knob: &LineKnob) -> Option<f64> {
        let key = &knob.known.first()?.key;
        match knob.setting {
            setting::BELT_SPEED => Some(self.spec().belt_speed),
            setting::BASIS_WEIGHT => Some(self.spec().weight()),
            _ => self.number(&key.name, key),
        }
    }

    /// The values of the keys of a knob after a step.
    ///
    /// * `digits` – of the first one, in its unit; others that were equal stay equal
    pub(super) fn values(&self, knob: &LineKnob, step: Step, digits: usize) -> Vec<(VariedKey, f64)> {
        let mut factor = 1.0_f64;
        let first = knob.known.first().map_or(f64::NAN, |known| known.from);
        let to = |KnownKey { key, from, power }: &KnownKey| {
            let dimension = key.dimension();
            let to = match *power {
                0.0 if self.is_held(key) => *from,
                0.0 => rounded(dimension, *from, HELD),
                1.0 if key.is_whole() || dimension == Dimension::Temperature => step.apply(&key.kind, *from),
                1.0 => {
                    let digits = if *from == first { digits } else { CHANGED };
                    rounded(dimension, step.apply(&key.kind, *from), digits)
                }
                // A row stays as wide as its web, to the last digit.
                _ => from * factor.powf(*power),
            };
            // What comes behind follows from the rounded number, as the pitch of a row from its holes.
            if *power == 1.0 {
                factor = to / from;
            }
            (key.clone(), to)
        };
        knob.known.iter().map(to).collect()
    }

    /// The web with a knob turned by a step; None if it cannot be made.
    fn changed(&self, knob: &LineKnob, step: Step) -> Option<Change> {
        let values = self.values(knob, step, CHANGED);
        let mut made = self.with(&values).ok()?;
        let belt = made.spec.belt_speed_for(self.weight());
        let slowest = made
            .spec
            .layers
            .iter()
            .map(|layer| layer.fed_filament().feed_speed())
            .fold(f64::INFINITY, f64::min);
        if belt.is_nan() || belt > slowest {
            return None;
        }
        made.spec.set_belt_speed(belt);
        let changed = |(KnownKey { key, from, power }, (_, to)): (&KnownKey, &(VariedKey, f64))| {
            (*power != 0.0 && from != to).then(|| self.changed_key(key, [*from, *to]))
        };
        let keys: Vec<ChangedKey> = knob.known.iter().zip(&values).filter_map(changed).collect();
        let new = self.settings_of(&values).chain(self.held_weight()).collect();
        (!keys.is_empty()).then(|| self.change(knob.setting, knob.layers.clone(), keys, new, Ok(made)))
    }

    /// Whether the file says the throughput of a layer itself, so that it holds.
    fn is_held(&self, key: &VariedKey) -> bool {
        let layer = key.name.strip_prefix("layer.").and_then(|rest| rest.split_once('.'));
        let layer = layer.filter(|(_, name)| *name == THROUGHPUT);
        let layer = layer.and_then(|(number, _)| self.spec().layers.get(number.parse::<usize>().ok()? - 1));
        layer.is_some_and(|layer| matches!(layer.filament.feed, FilamentFeed::Throughput(_)))
    }

    /// Values as they are set in the file, without those that stand there.
    pub(super) fn settings_of(&self, values: &[(VariedKey, f64)]) -> impl Iterator<Item = (String, String)> {
        let is_new =
            |(key, value): &&(VariedKey, f64)| !(self.is_held(key) && Some(*value) == self.base.value(key));
        values.iter().filter(is_new).map(|(key, value)| self.setting(key, *value))
    }

    /// What is set so that the basis weight stays, if the file does not say it.
    pub(super) fn held_weight(&self) -> Option<(String, String)> {
        let weight = self.base.short_name(BASIS_WEIGHT).to_owned();
        let is_free = self.spec().basis_weight.is_none();
        is_free.then(|| (weight, Dimension::BasisWeight.written(self.weight())))
    }

    /// The knobs of the belt, under which the filaments fly as they did: one sets its speed, and the other one the
    /// basis weight that the belt follows.
    pub(super) fn knobs_of_belt(&self) -> Vec<LineKnob> {
        let spec = self.spec();
        let knob = |(setting, name, from): (Setting, &str, f64)| {
            let key = self.base.varied(name).ok()?;
            let known = vec![KnownKey { key, from, power: 1.0 }];
            Some(LineKnob { setting, layers: Vec::new(), known, changes: Vec::new() })
        };
        let speed = (setting::BELT_SPEED, BELT_SPEED, spec.belt_speed);
        let weight = (setting::BASIS_WEIGHT, BASIS_WEIGHT, spec.weight());
        [speed, weight].into_iter().filter_map(knob).collect()
    }

    /// Mass per area of the changed webs [kg/m²].
    fn weight(&self) -> f64 {
        let found = || rounded(Dimension::BasisWeight, self.spec().weight(), HELD);
        self.spec().basis_weight.unwrap_or_else(found)
    }
}

/// A web that is changed.
pub(super) struct WebToChange<'a> {
    pub(super) base: &'a WebBase,
    /// What is set beside the file.
    pub(super) set: &'a [(String, String)],
    pub(super) resources: &'a Resources,
}

impl WebToChange<'_> {
    /// The web with these values of keys.
    pub(super) fn with(&self, values: &[(VariedKey, f64)]) -> Result<WebFile, Error> {
        self.base.with(values, None, self.resources)
    }

    /// What has changed of a key, with the name that it has in the file.
    pub(super) fn changed_key(&self, key: &VariedKey, ends: [f64; 2]) -> ChangedKey {
        changed_key(self.base.short_name(&key.name).to_owned(), &key.kind, ends)
    }

    /// A value of a key as it is set in the file.
    pub(super) fn setting(&self, key: &VariedKey, value: f64) -> (String, String) {
        (self.base.short_name(&key.name).to_owned(), key.written(value))
    }

    /// A change that makes a web of this one.
    ///
    /// * `new` – keys and values that have to be set in the file for it; what was set before stays, unless it
    ///   is replaced
    /// * `made` – the web, or why there is none
    pub(super) fn change(
        &self,
        setting: Setting,
        layers: Vec<usize>,
        keys: Vec<ChangedKey>,
        new: Vec<(String, String)>,
        made: Result<WebFile, Error>,
    ) -> Change {
        let names: Vec<&str> = new.iter().map(|(key, _)| &**key).collect();
        let is_displaced = replaced_by(&names, self.base.is_layered());
        let stays = |set: &str| !names.contains(&set) && !is_displaced(set);
        let before = self.set.iter().filter(|(key, _)| stays(self.base.short_name(key.trim())));
        let before = before.map(|(key, value)| (key.clone(), Entry::plain_override(value)));
        let set = before.chain(new.iter().cloned()).collect();
        let (spec, refusal) = match made {
            Ok(made) => (made.spec, None),
            Err(why) => (self.base.spec().clone(), Some(why.to_string())),
        };
        let ends = [self.base.spec(), &spec];
        let belt_speed = ends.map(|spec| spec.belt_speed);
        let mass_flow = ends.map(WebSpec::mass_flow);
        let file = self.base.path().to_owned();
        let experiment = ChangedWeb { file, set, spec, belt_speed, mass_flow };
        Change { setting, layers, keys, experiment, refusal }
    }
}
