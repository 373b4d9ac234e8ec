//! What decides the diameter: a bar for each number of the line.

use crate::figures::effects::{EffectsFigure, Panel, Row, in_unit};
use spunlaid::input::{Influence, OfFilament};
use spunlaid_charts::{Figure, Table, label::plain};

/// Most bars of a panel; the table has all.
const MOST: usize = 16;

/// The influences on the diameter, relative changes and those of 10 K apart.
pub(super) fn figure(prefix: &str, influences: &[Influence]) -> Figure {
    let panel = |by_kelvin: bool, heading: &'static str, factor: f64, decimals: usize| {
        let row = |influence: &Influence| {
            let effect = influence.on(OfFilament::Diameter).map(|effect| in_unit(&effect.difference, factor));
            let (name, detail) = (influence.change.setting.words.to_owned(), String::new());
            Row { name, detail, effects: vec![effect] }
        };
        let changed =
            influences.iter().filter(|influence| influence.change.keys[0].by_kelvin == by_kelvin).take(MOST);
        let label = "Change of the diameter (%)".to_owned();
        Panel { heading, keys: Vec::new(), label, rows: changed.map(row).collect(), decimals }
    };
    let mut panels = vec![panel(false, "1 % more of", 1.0, 2), panel(true, "10 K more of", 100.0, 1)];
    panels.retain(|panel| !panel.rows.is_empty());
    let left_out = influences.len() - panels.iter().map(|panel| panel.rows.len()).sum::<usize>();
    let others = if left_out > 0 { " Weaker ones are in the numbers of the figure." } else { "" };
    let caption = format!(
        "Relative change of the diameter of the cold filament when one number changes and all others stay, \
        by small changes of the model: d ln d / d ln x, and the change for 10 K. Blue is finer, orange is \
        thicker.{others} These are slopes: they hold for small changes."
    );
    let (name, title) = (format!("{prefix}_influences"), "What decides the diameter".to_owned());
    EffectsFigure { name, title, panels }.figure(table(influences), caption)
}

/// All influences, on the diameter and on the speed.
fn table(influences: &[Influence]) -> Table {
    let mut table = Table::new([
        "diameter_dlnd_dlnx",
        "speed_dlnv_dlnx",
        "diameter_percent_per_10_k",
        "speed_percent_per_10_k",
    ]);
    for influence in influences {
        let [diameter, speed] = [OfFilament::Diameter, OfFilament::Speed]
            .map(|of| influence.on(of).map_or(f64::NAN, |effect| effect.difference.value));
        let numbers = match influence.change.keys[0].by_kelvin {
            false => [diameter, speed, f64::NAN, f64::NAN],
            true => [f64::NAN, f64::NAN, 100.0 * diameter, 100.0 * speed],
        };
        table.add(&plain(influence.change.setting.words), [numbers]);
    }
    table
}
