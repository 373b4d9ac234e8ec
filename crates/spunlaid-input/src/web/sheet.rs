//! The sheet: its size, cells, patches and edges.

use super::filament::Filament;
use super::read::{BELT_SPEED, CASE, WebParser};
use spunlaid_fibre::case::whole_parts;
use spunlaid_ground::{Dimension, Fault};
use spunlaid_simulation::layers::full_names::without_numbers;
use spunlaid_simulation::layers::keys::{EITHER, WEB};
use spunlaid_simulation::{LayerSpec, SAME, WebSpec};
use spunlaid_web::Sheet;

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

impl WebParser<'_> {
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

impl WebParser<'_> {
    /// Gives the layers the belt on which they have the basis weight that is written, if one is. The cases
    /// are simulated above it.
    pub(super) fn lay_weight(&mut self, web: &mut WebSpec, filaments: &mut [Option<Filament>]) {
        let Some(key) = self.of_all_layers(BASIS_WEIGHT) else { return };
        self.basis_weight_key.clone_from(&key);
        let of_same_layer = key.replace(BASIS_WEIGHT, BELT_SPEED);
        let mut belts = self.written_in_layers(BELT_SPEED).into_iter();
        if let Some(belt) = belts.find(|belt| *belt != of_same_layer) {
            self.key_values.reject(&key, Fault::excludes(&belt, EITHER));
        }
        let Some(weight) = self.key_values.number(&key) else { return };
        web.basis_weight = Some(weight);
        let belt = web.belt_speed_for(weight);
        // What is missing, or that nothing is laid, is reported elsewhere.
        web.belt_speed = if belt == 0.0 { f64::NAN } else { belt };
        let Some(written_value) = self.key_values.get(&key).filter(|_| !web.belt_speed.is_nan()) else {
            return;
        };
        for filament in filaments.iter_mut().flatten() {
            filament.derive("belt.speed", Dimension::Velocity, web.belt_speed, &key, written_value);
        }
    }

    /// The full names of a key in the layers in which it is written.
    fn written_in_layers(&self, name: &str) -> Vec<String> {
        let keys = self.prefixes.iter().map(|prefix| format!("{prefix}{name}"));
        keys.filter(|key| self.is_written(key)).collect()
    }

    /// The full name of a key of all layers in the first one in which it is written, if it is written in any. Another
    /// number in another layer is refused.
    fn of_all_layers(&mut self, name: &str) -> Option<String> {
        let key = WEB.find(name)?;
        let mut written = self.written_in_layers(name).into_iter();
        let first = written.next()?;
        let number = self.key_values.number(&first);
        for full in written {
            if let (Some(number), Some(other)) = (number, self.key_values.number(&full))
                && (other / number - 1.0).abs() > SAME
            {
                let number = key.kind.pretty(&number.into());
                let why = key.relations.of_all_layers;
                let fault = Fault::new(
                    format!("differs from {first} = {number}, and {}", why.unwrap_or_default()),
                    "write it in one layer and leave it out of the others",
                );
                self.key_values.reject(&full, fault);
            }
        }
        Some(first)
    }

    /// Checks that all layers lie on one belt, which tears none of them.
    pub(super) fn settle_belt(&mut self, web: &mut WebSpec) {
        let by_weight = !self.basis_weight_key.is_empty();
        if !by_weight {
            self.lay_on_common_belt(web);
        }
        let is_torn = |(_, layer): &(usize, &LayerSpec)| web.belt_speed > layer.filament.feed_speed();
        let torn = (0..).zip(&web.layers).filter(is_torn);
        // The belt of a basis weight is one number for all.
        for (number, layer) in torn.take(if by_weight { 1 } else { usize::MAX }) {
            let [belt, feed] =
                [web.belt_speed, layer.filament.feed_speed()].map(|speed| Dimension::Velocity.pretty(speed));
            if by_weight {
                let message = format!(
                    "takes a belt of {belt}, which is more than line.feed_speed = {feed} and would tear the fibre"
                );
                let key = self.basis_weight_key.clone();
                self.key_values.reject(&key, Fault::new(message, "lay more, or feed faster"));
            } else {
                let message = format!("is more than line.feed_speed = {feed}, which would tear the fibre");
                let key = format!("{}{BELT_SPEED}", self.prefixes[number]);
                self.refuse(&key, belt, Fault::new(message, "slow the belt, or feed faster"));
            }
        }
    }

    /// Gives the web the speed of the belt, which is written in one layer or is that of the simulated cases.
    fn lay_on_common_belt(&mut self, web: &mut WebSpec) {
        self.of_all_layers(BELT_SPEED);
        let of_case = |layer: &LayerSpec| Some(layer.source.case()?.line?.belt_speed);
        let belts: Vec<Option<f64>> = web.layers.iter().map(of_case).collect();
        let first = belts.iter().position(Option::is_some);
        if let Some(of_cases) = first.and_then(|first| belts[first]) {
            web.belt_speed = of_cases;
        }
        if web.belt_speed.is_nan() {
            let keys: Vec<String> =
                self.prefixes.iter().map(|prefix| format!("{prefix}{BELT_SPEED}")).collect();
            if let Some(key) = keys.first().filter(|_| !keys.iter().any(|key| self.is_given(key))) {
                let table = without_numbers(key.trim_end_matches(".belt_speed"));
                self.key_values.reject(key, Fault::missing(&table, "belt_speed = \"3 m/s\""));
            }
            return;
        }
        for (own, prefix) in belts.into_iter().zip(self.prefixes.clone()) {
            if let Some(own) = own.filter(|own| (own / web.belt_speed - 1.0).abs() > SAME) {
                let [own, belt] = [own, web.belt_speed].map(|speed| Dimension::Velocity.pretty(speed));
                let message = format!(
                    "has belt.speed = {own}, which differs from the belt speed of layer {}, {belt}, and all layers \
                    lie on one belt",
                    first.unwrap_or_default() + 1
                );
                let key = self.says(&prefix, "belt.speed").unwrap_or_else(|| format!("{prefix}{CASE}"));
                self.key_values.reject(&key, Fault::new(message, "give all cases the same belt.speed"));
            }
        }
    }
}
