//! The sheet: its size, cells, patches and edges.

use super::open::{Layer, Way};
use super::read::{BELT_SPEED, Reading};
use crate::fibre::case::whole_parts;
use crate::ground::{Dimension, Fault};
use crate::simulation::layers::full_names::without_numbers;
use crate::simulation::layers::keys::EITHER;
use crate::simulation::{LayerSpec, SAME, WebSpec};
use crate::web::Sheet;

/// Sides of the cells and of the patches that are chosen if the file gives none [m].
const CELLS: [f64; 5] = [0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3];
const PATCHES: [f64; 6] = [1e-3, 2e-3, 5e-3, 10e-3, 20e-3, 50e-3];
/// Most cells that are chosen, and that are possible.
const MANY_CELLS: f64 = 1e7;
const MOST_CELLS: f64 = 4e8;
/// Most patches that are compared.
const MOST_PATCHES: usize = 100;
/// The window that is chosen [m].
const WINDOW: f64 = 20e-3;

impl Reading<'_> {
    /// Sets what a file leaves out of the sheet, and checks it.
    pub(super) fn complete_sheet(&mut self, web: &mut WebSpec) {
        let Sheet { width, length, .. } = web.sheet;
        if !self.is_written("web.cell") {
            web.sheet.cell = chosen_cell(width, length);
        }
        let cell = web.sheet.cell;
        if [width, length, cell].iter().any(|size| size.is_nan()) {
            return;
        }
        let cells = width / cell * (length / cell);
        if !cells.is_finite() || cells > MOST_CELLS {
            let cell = Dimension::Length.pretty(cell);
            let fault = Fault::new(
                format!("makes {cells:.1e} cells of {cell} in the web; at most {MOST_CELLS:e} are possible"),
                "make the cells larger, or the web smaller",
            );
            self.refuse("web.cell", cell, fault);
            return;
        }
        let mut whole = true;
        for (key, size) in [("web.width", width), ("web.length", length)] {
            if !is_whole(size, cell) {
                whole = false;
                self.key_values.reject(key, not_whole("is", size, cell));
            }
        }
        let side = width.min(length);
        if whole {
            self.complete_patches(&mut web.sheet.patches, side, cell);
        }
        if let Some(saleable) = web.fabric.saleable_width.filter(|saleable| *saleable > width) {
            let [shown, width] = [saleable, width].map(|size| Dimension::Length.pretty(size));
            let fault = Fault::new(format!("is wider than the web, {width}"), "write a smaller one");
            self.refuse("fabric.saleable_width", shown, fault);
        }
        if !self.is_written("web.window") {
            web.window = WINDOW.min(side);
        } else if web.window > side {
            let side = Dimension::Length.pretty(side);
            let fault =
                Fault::new(format!("is larger than the web's smaller side, {side}"), "write a smaller one");
            self.key_values.reject("web.window", fault);
        }
    }

    /// Sorts the sides of the patches, or chooses them, and checks them.
    fn complete_patches(&mut self, patches: &mut Vec<f64>, side: f64, cell: f64) {
        const KEY: &str = "web.patches";
        if !self.is_written(KEY) {
            let fits = |patch: &f64| is_whole(*patch, cell) && *patch <= 0.5 * side;
            *patches = PATCHES.into_iter().filter(fits).collect();
            if patches.is_empty() && !self.key_values.is_excused(KEY) {
                let [shown, exact] = [4, 12].map(|digits| Dimension::Length.pretty_to(cell, digits));
                let fault = Fault::new(
                    format!(
                        "is missing, and none of the usual patches, 1, 2, 5, 10, 20 and 50 mm, is a whole \
                        number of cells of {shown} and at most half as large as the web"
                    ),
                    format!("add patches = [\"{exact}\"] to [web], or change web.cell"),
                );
                self.key_values.reject(KEY, fault);
            }
            return;
        }
        patches.sort_by(f64::total_cmp);
        patches.dedup();
        if patches.len() > MOST_PATCHES {
            let fault = Fault::new(
                format!("lists {} patches", patches.len()),
                format!("at most {MOST_PATCHES} are compared"),
            );
            self.key_values.reject(KEY, fault);
            return;
        }
        for &patch in &*patches {
            if !is_whole(patch, cell) {
                let shown = Dimension::Length.pretty(patch);
                let fault = not_whole(&format!("has {shown}, which is"), patch, cell);
                self.key_values.reject(KEY, fault);
            } else if patch > 0.5 * side {
                let [patch, side] = [patch, side].map(|size| Dimension::Length.pretty(size));
                let fault = Fault::new(
                    format!(
                        "has {patch}, which is more than half of the web's smaller side, {side}, so that \
                        there is nothing to compare"
                    ),
                    "leave it out, or make the web larger",
                );
                self.key_values.reject(KEY, fault);
            }
        }
    }
}

/// The fault of a size that is not a whole number of cells.
fn not_whole(is: &str, size: f64, cell: f64) -> Fault {
    let below = (size / cell).floor();
    let shown = |cells: f64| Dimension::Length.pretty_to(cells * cell, 12);
    let nearest =
        if below < 1.0 { shown(1.0) } else { format!("{} or {}", shown(below), shown(below + 1.0)) };
    Fault::new(
        format!("{is} not a whole number of cells of {}", Dimension::Length.pretty(cell)),
        format!("write {nearest}, or another web.cell"),
    )
}

fn is_whole(size: f64, cell: f64) -> bool {
    let (cells, whole) = whole_parts(size, cell);
    whole && cells > 0
}

/// The smallest of the usual cells that makes not too many of them, of those that divide the sheet if any does.
fn chosen_cell(width: f64, length: f64) -> f64 {
    let few = |cell: &f64| width / cell * (length / cell) <= MANY_CELLS;
    let divides = |cell: &f64| is_whole(width, *cell) && is_whole(length, *cell);
    let mut fitting = CELLS.into_iter().filter(few);
    fitting.clone().find(divides).or_else(|| fitting.next()).unwrap_or(CELLS[CELLS.len() - 1])
}

/// The key that stands in its place.
const BASIS_WEIGHT: &str = "line.basis_weight";

impl Reading<'_> {
    /// Gives the layers the belt on which they have the basis weight that is written, if one is. The cases
    /// are flown above it.
    pub(super) fn lay_weight(&mut self, web: &mut WebSpec, layers: &mut [Layer]) {
        let Some((key, weight)) = self.basis_weight() else { return };
        self.basis_weight_key.clone_from(&key);
        let of_other = |prefix: &&String| format!("{prefix}{BASIS_WEIGHT}") != key;
        let belts = self.prefixes.iter().filter(of_other).map(|prefix| format!("{prefix}{BELT_SPEED}"));
        if let Some(belt) = belts.into_iter().find(|key| self.is_written(key)) {
            self.key_values.reject(&key, Fault::excludes(&belt, EITHER));
        }
        let Some(weight) = weight else { return };
        web.basis_weight = Some(weight);
        let flow = |layer: &Layer| {
            let each = layer.spun.unwrap_or(layer.spec.hole_flow());
            each * layer.spec.filaments.count(&web.sheet) as f64
        };
        let belt = layers.iter().map(flow).sum::<f64>() / web.sheet.width / weight;
        // What is missing, or that nothing is laid, is reported elsewhere.
        let belt = if belt == 0.0 { f64::NAN } else { belt };
        let written_value = self.key_values.get(&key).cloned();
        for layer in layers {
            layer.spec.belt_speed = belt;
            if let (Some(filament), Some(written_value)) = (&mut layer.filament, &written_value)
                && !belt.is_nan()
            {
                filament.derive("belt.speed", Dimension::Velocity, belt, (&key, written_value));
            }
        }
    }

    /// The basis weight that is written in one of the layers, with the full name of its key.
    fn basis_weight(&mut self) -> Option<(String, Option<f64>)> {
        let keys = self.prefixes.iter().map(|prefix| format!("{prefix}{BASIS_WEIGHT}"));
        let keys: Vec<String> = keys.filter(|key| self.is_written(key)).collect();
        let first = keys.first()?;
        let weight = self.key_values.number(first);
        for key in &keys[1..] {
            if let (Some(weight), Some(other)) = (weight, self.key_values.number(key))
                && (other / weight - 1.0).abs() > SAME
            {
                let weight = Dimension::BasisWeight.pretty(weight);
                let fault = Fault::new(
                    format!("differs from {first} = {weight}, and it is the weight of all layers together"),
                    "write it in one layer and leave it out of the others",
                );
                self.key_values.reject(key, fault);
            }
        }
        Some((first.clone(), weight))
    }

    /// Checks that all layers lie on one belt, which tears none of them.
    pub(super) fn settle_belt(&mut self, web: &mut WebSpec, ways: &[Way]) {
        if self.basis_weight_key.is_empty() {
            self.settle_common_belt(&mut web.layers, ways);
        } else if let Some(layer) = web.layers.iter().find(|layer| layer.belt_speed > layer.feed_speed) {
            let [belt, feed] =
                [layer.belt_speed, layer.feed_speed].map(|speed| Dimension::Velocity.pretty(speed));
            let message = format!(
                "takes a belt of {belt}, which is more than line.feed_speed = {feed} and would tear the fibre"
            );
            let key = self.basis_weight_key.clone();
            self.key_values.reject(&key, Fault::new(message, "lay more, or feed faster"));
        }
    }

    /// Gives every layer the speed of the belt, which is written in one layer or is that of a flown case.
    fn settle_common_belt(&mut self, layers: &mut [LayerSpec], ways: &[Way]) {
        let keys: Vec<String> = self.prefixes.iter().map(|prefix| format!("{prefix}{BELT_SPEED}")).collect();
        // Flown fibres come first, because they would lie otherwise on another belt.
        let known = (0..layers.len()).filter(|&layer| !layers[layer].belt_speed.is_nan());
        let Some(first) = known.min_by_key(|&layer| layers[layer].source.case().is_none()) else {
            let is_there = |key: &String| self.is_told(key);
            let is_known = ways.iter().all(|way| *way == Way::Numbers || *way == Way::Unknown);
            if let Some(key) = keys.first().filter(|_| is_known && !keys.iter().any(is_there)) {
                let table = without_numbers(key.trim_end_matches(".belt_speed"));
                self.key_values.reject(key, Fault::missing(&table, "belt_speed = \"3 m/s\""));
            }
            return;
        };
        let LayerSpec { belt_speed: belt, source, .. } = layers[first].clone();
        for (number, (layer, key)) in layers.iter_mut().zip(&keys).enumerate() {
            let is_written = self.is_written(key);
            if layer.belt_speed.is_nan() && !is_written {
                layer.belt_speed = belt;
            }
            let its_own = self.key_values.number(key).unwrap_or(layer.belt_speed);
            let [own, feed, first_belt] =
                [its_own, layer.feed_speed, belt].map(|speed| Dimension::Velocity.pretty(speed));
            if (its_own / belt - 1.0).abs() > SAME {
                let whose =
                    if is_written { String::new() } else { format!("has belt.speed = {own}, which ") };
                let message = format!(
                    "{whose}differs from the belt speed of layer {}, {first_belt}, and all layers lie on one belt",
                    first + 1
                );
                let remedy = match source.case() {
                    _ if !is_written => "give all cases the same belt.speed".to_owned(),
                    Some(_) => {
                        format!("leave it out here, and set belt.speed in {}", source.path().display())
                    }
                    None => "write it in one layer and leave it out of the others".to_owned(),
                };
                let ways = ["laydown.case", "belt.speed"];
                let ways = ways.map(|way| format!("{}{way}", self.prefixes[number]));
                let way = ways.iter().find(|way| self.is_written(way)).filter(|_| !is_written);
                self.key_values.reject(way.unwrap_or(key), Fault::new(message, remedy));
            }
            if layer.belt_speed > layer.feed_speed {
                let message = format!("is more than line.feed_speed = {feed}, which would tear the fibre");
                self.refuse(key, own, Fault::new(message, "slow the belt, or feed faster"));
            }
        }
    }
}
