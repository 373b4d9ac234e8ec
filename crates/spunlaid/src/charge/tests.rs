//! Sheets and neighbours together.

use super::{Charge, ChargedNode, Curtain, MovingNode, Repulsion, Sheets};
use crate::lanes::Isa;

const ELEMENT: f64 = 2e-3;
/// Nodes of a straight filament.
const NODES: usize = 32;
/// Charge of a node [C].
const CHARGE: f64 = 1e-12;

/// Neighbours and the rest of the field are together the field of sheets, where filaments are even across:
/// in a slab as at its edges, whatever the reach.
#[test]
fn analytic_neighbours_take_nothing_twice() {
    const ROWS: usize = 12;
    const ACROSS: usize = 60;
    let (pitch, width) = (0.4e-3, 0.4e-3 * ACROSS as f64);
    let y = |row: usize| 0.8e-3 * (row as f64 - 0.5 * (ROWS - 1) as f64);
    let mut nodes: Vec<MovingNode> = Vec::new();
    for i in 0..ROWS * ACROSS {
        let z = (i / ROWS) as f64 * pitch;
        nodes.extend((0..NODES).map(|j| MovingNode {
            filament: i,
            at: [(j as f64 + 0.25) * ELEMENT, y(i % ROWS), z],
            half_way: [0.0; 2],
        }));
    }
    let (per_mass, node_mass) = (1e-3, CHARGE / 1e-3);
    let count = (ROWS * ACROSS) as u64;
    let (per_metre, element, distance) = (count as f64 / width, ELEMENT, NODES as f64 * ELEMENT);
    let curtain = Curtain { per_metre, node_mass, element, distance, weights: count };
    let charge = Charge { per_mass, walls: None, pairs: true };
    let charged = |node: &MovingNode| ChargedNode { x: node.at[0], y: node.at[1], weight: 1 };
    let charged: Vec<ChargedNode> = nodes.iter().map(charged).collect();
    let field = |reach: f64| {
        let mut sheets = Sheets::new(&charge, &curtain).without_neighbours(reach);
        sheets.renew(&charged, 1.0);
        sheets.field()
    };
    let all = field(0.0);
    let edge = all.at(nodes[16].at[0], 20e-3);
    for reach in [2e-3, 4e-3, 8e-3] {
        let rest = field(reach);
        let (charge, height, width) = (CHARGE, element, Some(width));
        let repulsion = Repulsion { charge, reach, height, least: 18e-6, distance, width };
        let forces = repulsion.forces(&nodes, (Isa::detect(), 2));
        for row in 0..ROWS {
            let at = row * NODES + 16;
            let (x, y) = (nodes[at].at[0], nodes[at].at[1]);
            let of_neighbours = forces[at][0] / CHARGE;
            let found = rest.at(x, y) + of_neighbours;
            assert!((found - all.at(x, y)).abs() < 0.01 * edge, "{reach} {row}: {found} {}", all.at(x, y));
            assert!(row > 0 || of_neighbours.abs() > 0.04 * edge, "they are a part of it");
            assert!(forces[at][1].abs() < 1e-9 * CHARGE * edge);
        }
    }
}
