//! Stands in for `spunlaid::input::read_line` until it is there.

use spunlaid::experiment::{Change, Setting};
use spunlaid::fibre::Note;
use spunlaid::ground::{Dimension, Error};
use spunlaid::input::{Changes, Overrides, Resources, WebSpec, read_changes, read_web};

pub struct LineFile { text: String, name: String, spec: WebSpec, notes: Vec<Note>, changes: Vec<Change> }

pub fn read_line(text: &str, name: &str, resources: &Resources) -> Result<LineFile, Error> {
    let web = read_web((text, name), Overrides::from(&[]).with(resources))?;
    let changes = read_changes((text, name), Overrides::from(&[]).with(resources), Changes::OfLine)?;
    Ok(LineFile { text: text.to_owned(), name: name.to_owned(), spec: web.spec, notes: web.notes, changes })
}

impl LineFile {
    pub fn spec(&self) -> &WebSpec { &self.spec }
    pub fn notes(&self) -> &[Note] { &self.notes }
    pub fn knobs(&self) -> Vec<Knob> {
        let mut all: Vec<Knob> = Vec::new();
        for change in &self.changes {
            let Some(key) = change.keys.first() else { continue };
            if all.iter().any(|knob| knob.name == change.setting.name) { continue }
            all.push(Knob {
                name: change.setting.name.to_owned(),
                label: change.setting.words.to_owned(),
                setting: change.setting,
                layers: change.layers.clone(),
                keys: vec![key.key.clone()],
                dimension: key.dimension,
                is_whole: key.whole,
                value: key.from,
                range: [0.5 * key.from, 2.0 * key.from],
            });
        }
        all
    }
    pub fn turned(&self, turns: &[Turn], resources: &Resources) -> Result<TurnedLine, Error> {
        let knobs = self.knobs();
        let set: Vec<(String, String)> = turns.iter().filter_map(|turn| {
            let knob = knobs.iter().find(|knob| knob.name == turn.name)?;
            Some((knob.keys[0].clone(), knob.dimension.written(turn.value)))
        }).collect();
        let web = read_web((&self.text, &self.name), Overrides::from(&set).with(resources))?;
        Ok(TurnedLine { spec: web.spec, set, text: self.text.clone(), notes: web.notes, needs_flights: false })
    }
    pub fn changes(&self, _: &Resources) -> Vec<Change> { self.changes.clone() }
}

#[derive(Clone, Debug, PartialEq)]
pub struct Knob {
    pub name: String, pub label: String, pub setting: Setting, pub layers: Vec<usize>, pub keys: Vec<String>,
    pub dimension: Dimension, pub is_whole: bool, pub value: f64, pub range: [f64; 2],
}
impl Knob {
    pub fn is_changed_by(&self, change: &Change) -> bool { self.setting == change.setting }
}
#[derive(Clone, Debug, PartialEq)]
pub struct Turn { pub name: String, pub value: f64 }
#[derive(Clone, Debug)]
pub struct TurnedLine {
    pub spec: WebSpec, pub set: Vec<(String, String)>, pub text: String, pub notes: Vec<Note>, pub needs_flights: bool,
}
pub struct PlantNumber { pub name: String, pub label: String, pub value: f64, pub text: String }
pub fn plant_numbers(spec: &WebSpec) -> Vec<PlantNumber> {
    let one = |name: &str, value: f64, text: String| PlantNumber { name: name.to_owned(), label: name.replace('_', " "), value, text };
    let (belt, weight) = (spec.belt_speed(), spec.weight());
    vec![one("belt_speed", belt, Dimension::Velocity.pretty_to(belt, 3)), one("basis_weight", weight, format!("{:.3} g/m²", 1e3 * weight))]
}
