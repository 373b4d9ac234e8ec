//! Air that comes from a file: the same air in other coordinates, axes and units.

use super::Outcome;
use super::errors::{pairs, with_seed};
use crate::draw::{Change, Drawn};
use crate::program::{Program, with_folder};
use serde_json::Value as Json;

/// A table with a heading, its numbers as they are written.
struct Table {
    heads: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    fn read(path: &str) -> Self {
        let text = std::fs::read_to_string(with_folder(path)).expect("a table");
        let mut lines = text.lines().filter(|line| !line.starts_with('#'));
        let heads = lines.next().expect("a heading").split(',').map(str::to_owned).collect();
        let row = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        Self { heads, rows: lines.map(row).collect() }
    }

    fn write(&self, program: &Program, name: &str) -> String {
        let row = |row: &Vec<f64>| row.iter().map(ToString::to_string).collect::<Vec<_>>().join(",");
        let rows: Vec<String> = self.rows.iter().map(row).collect();
        let path = program.place(name);
        std::fs::write(&path, format!("{}\n{}\n", self.heads.join(","), rows.join("\n"))).expect("a file");
        path.to_string_lossy().into_owned()
    }
}

/// The same flights with a key of the air changed in two ways.
fn alike(program: &Program, drawn: &Drawn, what: &str, [one, other]: [Vec<Change>; 2]) -> Outcome {
    let is_own =
        |change: &Change| change.key.starts_with("air.field_") || change.key.starts_with("air.record_");
    if drawn.changes.iter().any(is_own) {
        return Outcome::Refused;
    }
    pairs(
        what,
        |_| true,
        |number| {
            let of = |changes: &[Change]| program.numbers(&with_seed(&drawn.with(changes), number));
            Some((of(&one)?, of(&other)?))
        },
    )
}

/// A field whose coordinates begin elsewhere, and one that is turned about the axis of the flow.
pub fn field_moved(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    /// Where the coordinates begin [m].
    const FROM: [f64; 3] = [0.25, -1.5, 0.75];
    let own = Table::read("CASES/fields/diffuser_core.csv");
    let file = own.write(program, "own.csv");
    let mut moved = Table { heads: own.heads.clone(), rows: own.rows.clone() };
    for row in &mut moved.rows {
        // y becomes z, and z becomes -y: of places and of velocities.
        let [x, y, z, u, v, w] = [0, 1, 2, 3, 4, 5].map(|i| row[i]);
        row[..6].copy_from_slice(&[x + FROM[0], FROM[1] - z, FROM[2] + y, u, -w, v]);
    }
    let elsewhere = moved.write(program, "moved.csv");
    let root = FROM.map(|from| format!("\"{from} m\"")).join(", ");
    let one = vec![
        Change::new("air.field", file),
        Change::new("air.field_root", "[\"0 m\", \"0 m\", \"0 m\"]"),
        Change::new("air.field_machine_direction", "y"),
    ];
    let other = vec![
        Change::new("air.field", elsewhere),
        Change::new("air.field_root", format!("[{root}]")),
        Change::new("air.field_machine_direction", "z"),
    ];
    alike(program, drawn, "in a field that is moved and turned", [one, other])
}

/// A field in a mirror through which the machine direction runs.
pub fn field_mirrored(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    let own = Table::read("CASES/fields/diffuser_core.csv");
    let mut mirrored = Table { heads: own.heads.clone(), rows: own.rows.clone() };
    for row in &mut mirrored.rows {
        // The third coordinate and the third velocity.
        row[2] = -row[2];
        row[5] = -row[5];
    }
    let changes = [own.write(program, "own.csv"), mirrored.write(program, "mirrored.csv")]
        .map(|file| vec![Change::new("air.field", file), Change::new("air.field_machine_direction", "y")]);
    alike(program, drawn, "in a field that is mirrored", changes)
}

/// A record in other units of time and velocity.
pub fn record_in_other_units(program: &Program, drawn: &Drawn, _: &Json) -> Outcome {
    let own = Table::read("CASES/records/probe.csv");
    let scaled =
        |row: &Vec<f64>| row.iter().zip([1e3, 100.0, 100.0]).map(|(value, factor)| value * factor).collect();
    let heads = ["time [ms]", "u [cm/s]", "v [cm/s]"].map(str::to_owned).to_vec();
    let other = Table { heads, rows: own.rows.iter().map(scaled).collect() };
    let files = [own.write(program, "own.csv"), other.write(program, "scaled.csv")];
    let changes = files.map(|file| vec![Change::new("air.record", file)]);
    alike(program, drawn, "in air of a record in other units", changes)
}
