//! What is reported of a map follows from its cells, by sums that anybody would write.

use super::Outcome;
use crate::draw::Drawn;
use crate::program::{Program, Said};
use serde_json::Value as Json;

/// A web that is closed to a ring both ways.
struct Map {
    columns: usize,
    rows: usize,
    /// Row by row.
    cells: Vec<f64>,
}

impl Map {
    /// Reads the numbers of a file of NumPy.
    fn read(file: &[u8], [columns, rows]: [usize; 2]) -> Option<Self> {
        let header = usize::from(u16::from_le_bytes([*file.get(8)?, *file.get(9)?]));
        let (numbers, _) = file.get(10 + header..)?.as_chunks::<4>();
        let cells: Vec<f64> = numbers.iter().map(|bytes| f64::from(f32::from_le_bytes(*bytes))).collect();
        (cells.len() == columns * rows).then_some(Self { columns, rows, cells })
    }

    fn mean(&self) -> f64 {
        self.cells.iter().sum::<f64>() / self.cells.len() as f64
    }

    /// The weights of all patches of a side over the mean, row by row.
    fn patches(&self, side: usize) -> Vec<f64> {
        let scale = 1.0 / ((side * side) as f64 * self.mean());
        let across = turned(&sums(&self.cells, self.columns, side), self.columns);
        let patches = turned(&sums(&across, self.rows, side), self.rows);
        patches.into_iter().map(|sum| scale * sum).collect()
    }
}

/// The sums of so many numbers from each one on, around lines of a length.
fn sums(numbers: &[f64], length: usize, count: usize) -> Vec<f64> {
    let of_line = |line: &[f64]| {
        let mut sum: f64 = (0..count).map(|i| line[i % length]).sum();
        let mut next = |i: usize| {
            let own = sum;
            sum += line[(i + count) % length] - line[i];
            own
        };
        (0..length).map(&mut next).collect::<Vec<f64>>()
    };
    numbers.chunks_exact(length).flat_map(of_line).collect()
}

/// Columns of lines as lines.
fn turned(numbers: &[f64], length: usize) -> Vec<f64> {
    (0..length).flat_map(|column| numbers.iter().skip(column).step_by(length)).copied().collect()
}

/// The CV, thin and thick spots, quantiles and the thinnest spot of a web, from all patches of its map.
pub fn map_of_a_web(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    /// The file has 24 bits of a number.
    const ROUNDING: f64 = 1e-5;
    let out = program.new_place("mapped");
    let Said::Results(results) = program.computed(drawn, &["--out=mapped"]) else { return Outcome::Refused };
    let web = &results["web"];
    // Filaments of a layer at random positions have another number on each sheet, which is in its CV.
    let is_random_layer = drawn.value("layer.1.line.filaments_per_metre").is_some()
        || drawn.value("layer.2.line.slot_gap").is_some_and(|gap| gap == "auto");
    if is_random_layer || drawn.value("web.edges").is_some_and(|edges| edges != "periodic") {
        return Outcome::Refused;
    }
    let number = |of: &Json| of.as_f64().unwrap_or(f64::NAN);
    let cell = number(&web["cell_m"]);
    let counts = [0, 1].map(|axis| number(&web["cells"][axis]) as usize);
    let Some(map) = Map::read(&std::fs::read(out.join("map.npy")).unwrap_or_default(), counts) else {
        return Outcome::Broken(format!("map.npy has no {counts:?} numbers"));
    };
    let is_near = |found: f64, wanted: f64| (found - wanted).abs() <= ROUNDING * wanted.abs();
    let off = |what: &str, found: f64, wanted: f64| {
        Outcome::Broken(format!("{what} is {found}, and {wanted} by the cells of its map"))
    };
    let weight = number(&web["basis_weight_kg_m2"]);
    if !is_near(weight, map.mean()) {
        return off("basis weight", weight, map.mean());
    }
    let side = |of: &Json| (number(&of["patch_m"]) / cell).round() as usize;
    // On a sheet of another web of filaments at random positions there is another number of them, by a Poisson number.
    let is_at_random = drawn.base.name == "web" && drawn.value("line.slot_gap").is_none();
    let of_mean = if is_at_random { 1.0 / number(&results["layers"][0]["filaments"]) } else { 0.0 };
    for patch in web["patches"].as_array().into_iter().flatten() {
        let patches = map.patches(side(patch));
        let square = patches.iter().map(|of| (of - 1.0).powi(2)).sum::<f64>() / patches.len() as f64;
        let wanted = (square + of_mean).sqrt();
        if !is_near(number(&patch["cv"]), wanted) {
            return off(&format!("CV over {} m", patch["patch_m"]), number(&patch["cv"]), wanted);
        }
    }
    let fabric = &results["fabric"];
    // The middle of a web that is sold has edges.
    if !is_near(number(&fabric["width_m"]), counts[0] as f64 * cell) {
        return Outcome::Holds;
    }
    for of in fabric["patches"].as_array().into_iter().flatten() {
        let mut patches = map.patches(side(of));
        patches.sort_by(f64::total_cmp);
        let below =
            |edge: f64| patches.partition_point(|weight| *weight < edge) as f64 / patches.len() as f64;
        let what = |name: &str| format!("{name} over {} m", of["patch_m"]);
        let area = number(&of["patch_m"]).powi(2);
        for (name, part) in [
            ("lighter_than_50_percent_per_m2", below(0.5)),
            ("lighter_than_70_percent_per_m2", below(0.7)),
            ("lighter_than_80_percent_per_m2", below(0.8)),
            ("heavier_than_130_percent_per_m2", 1.0 - below(1.3)),
        ] {
            // Where none is found, there is a bound. Rounding moves some patches over an edge.
            let found = of[name]["value"].as_f64().unwrap_or(0.0) * area;
            if (found - part).abs() > 1e-3 * part + 4.0 / patches.len() as f64 {
                return off(&what(name), found / area, part / area);
            }
        }
        for (name, part) in [
            ("weight_of_1_percent", 0.01),
            ("weight_of_5_percent", 0.05),
            ("median_weight", 0.5),
            ("weight_of_95_percent", 0.95),
            ("weight_of_99_percent", 0.99),
        ] {
            // It is found in classes of a hundredth of the mean.
            let found = number(&of[name]["value"]);
            let [least, most] = [-0.0101, 0.0101].map(|by| below(found + by));
            if !(least..=most).contains(&part) {
                return off(&what(name), found, patches[(part * patches.len() as f64) as usize]);
            }
        }
    }
    let thinnest = &fabric["thinnest"][0];
    let side = (5e-3 / cell).round() as usize;
    // It does not lie across the joint of the ring.
    let inner =
        |(i, _): &(usize, f64)| i % map.columns + side <= map.columns && i / map.columns + side <= map.rows;
    let least = map.patches(side).into_iter().enumerate().filter(inner).map(|(_, weight)| weight);
    let least = least.fold(f64::INFINITY, f64::min);
    match number(&thinnest["weight"]) {
        found if is_near(found, least) => Outcome::Holds,
        found => off("weight of the thinnest spot", found, least),
    }
}
