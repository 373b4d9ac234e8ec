//! The forces of neighbours against those of threads, of means and of all nodes.

use super::pairs::mean_on_a_way;
use super::{MovingNode, Repulsion};
use crate::charge::PERMITTIVITY;
use crate::lanes::Isa;
use std::f64::consts::PI;

const ELEMENT: f64 = 2e-3;
const DISTANCE: f64 = 64e-3;
const OPEN: Repulsion =
    Repulsion { charge: 1e-12, reach: 8e-3, height: ELEMENT, least: 18e-6, distance: DISTANCE, width: None };

fn by(threads: usize) -> (Isa, usize) {
    (Isa::detect(), threads)
}

/// A straight thread, whose nodes are as far from the inlet as the others and `off` more.
fn thread(filament: usize, [y, z]: [f64; 2], off: f64) -> impl Iterator<Item = MovingNode> {
    let nodes = (DISTANCE / ELEMENT) as usize;
    let at = move |j: usize| [(j as f64 + 0.25) * ELEMENT + off, y, z];
    (0..nodes).map(move |j| MovingNode { filament, at: at(j), half_way: [0.0; 2] })
}

/// Numbers from 0 to 1 that look like chance.
fn chance(i: usize, of: f64) -> f64 {
    (i as f64 * of + 0.5).fract()
}

/// Filaments at places and with ways of chance, 20 mm wide and deep.
fn crowd() -> Vec<MovingNode> {
    let node = |i: usize| MovingNode {
        filament: i % 50,
        at: [
            DISTANCE * chance(i, 0.618_033_988_75),
            20e-3 * chance(i, 0.754_877_666_25),
            20e-3 * chance(i, 0.569_840_290_99),
        ],
        half_way: [chance(i, 0.819_172_513_4), chance(i, 0.671_043_606_7)].map(|share| 1e-3 * (share - 0.5)),
    };
    (0..5000).map(node).collect()
}

#[test]
fn analytic_two_parallel_threads() {
    for (height, off, distance) in [(1.0, 0.0, 1e-3), (1.0, 0.7e-3, 2e-3), (3.0, 1.1e-3, 5e-3)] {
        let place = [0.6 * distance, -0.8 * distance];
        let nodes: Vec<MovingNode> = thread(0, [0.0; 2], 0.0).chain(thread(1, place, off)).collect();
        let of = Repulsion { height: height * ELEMENT, ..OPEN };
        let forces = of.forces(&nodes, by(1));
        let line = OPEN.charge / ELEMENT;
        let exact = line * line * ELEMENT / (2.0 * PI * PERMITTIVITY)
            * (1.0 / distance - distance / (OPEN.reach * OPEN.reach));
        let node = 16;
        let [y, z] = forces[node].map(|force| force / exact);
        assert!((y + 0.6).abs() < 1e-6 && (z - 0.8).abs() < 1e-6, "{height}: {y} {z}");
        // Beyond the reach there is none, nor from its own filament.
        let far: Vec<MovingNode> = thread(0, [0.0; 2], 0.0)
            .chain(thread(0, place, off))
            .chain(thread(1, [-8.1e-3, 0.0], 0.0))
            .collect();
        assert!(of.forces(&far, by(1)).iter().all(|force| *force == [0.0; 2]));
    }
}

#[test]
fn invariant_forces_of_neighbours_add_up_to_nothing() {
    for width in [None, Some(20e-3), Some(17e-3)] {
        let of = Repulsion { width, ..OPEN };
        let nodes = crowd();
        let forces = of.forces(&nodes, by(2));
        for axis in [0, 1] {
            let sum: f64 = forces.iter().map(|force| force[axis]).sum();
            let all: f64 = forces.iter().map(|force| force[axis].abs()).sum();
            assert!(all > 0.0 && sum.abs() < 1e-13 * all, "{sum:e} {all:e}");
        }
        // A pair alone to the last bit, wherever it is on the ring.
        for pair in nodes.chunks_exact(2) {
            let [one, other] =
                [0, 1].map(|i| MovingNode { at: [0.03, pair[i].at[1], pair[i].at[2]], ..pair[i] });
            let forces = of.forces(&[one, other], by(1));
            assert_eq!(forces[0], forces[1].map(|force| -force));
        }
    }
}

/// Cells find all neighbours: as when all nodes are looked at.
#[test]
fn invariant_cells_leave_no_neighbour_out() {
    for width in [None, Some(20e-3), Some(50e-3)] {
        let of = Repulsion { width, reach: 3e-3, ..OPEN };
        let nodes = crowd();
        for (node, force) in nodes.iter().zip(of.forces(&nodes, by(1))).step_by(1000) {
            let mut sum = [0.0; 2];
            for other in &nodes {
                let pair = of.forces(&[*node, *other], by(1))[0];
                (0..2).for_each(|axis| sum[axis] += pair[axis]);
            }
            for axis in [0, 1] {
                let exact = sum[axis];
                assert!((force[axis] - exact).abs() <= 1e-9 * exact.abs(), "{force:?} {exact:e}");
            }
        }
    }
}

#[test]
fn identical_forces_of_neighbours_on_any_threads_and_registers() {
    let nodes = crowd();
    let of = Repulsion { width: Some(20e-3), ..OPEN };
    let one = of.forces(&nodes, by(1));
    for isa in Isa::available() {
        assert!((1..4).all(|threads| of.forces(&nodes, (isa, threads)) == one), "{isa:?}");
    }
}

/// The mean on a straight way is that of many places of it, near by and far.
#[test]
fn analytic_the_mean_force_on_a_way() {
    let half_way = [0.3e-3, 0.4e-3];
    for place in [[0.1e-3, -0.05e-3], [0.5e-3, 0.2e-3], [-2e-3, 1e-3]] {
        let found = mean_on_a_way(place, half_way, 0.0);
        let places = 100_000;
        let mut sum = [0.0; 2];
        for i in 0..places {
            let part = 2.0 * (i as f64 + 0.5) / f64::from(places) - 1.0;
            let at = [0, 1].map(|axis| place[axis] + part * half_way[axis]);
            let squared = at[0] * at[0] + at[1] * at[1];
            (0..2).for_each(|axis| sum[axis] += at[axis] / squared / f64::from(places));
        }
        for axis in [0, 1] {
            assert!((found[axis] / sum[axis] - 1.0).abs() < 1e-6, "{found:?} {sum:?}");
        }
    }
}

/// The series for slow nodes is the mean on their way, up to where the logarithm takes its place.
#[test]
fn analytic_the_series_of_slow_nodes() {
    for [way_y, way_z] in [[0.49, 0.0], [0.0, -0.49], [0.3, 0.35], [-0.2, 0.1], [0.0, 0.0], [0.4, 0.4]] {
        let distance = 2e-3;
        let node = |filament: usize, y: f64, half_way: [f64; 2]| MovingNode {
            filament,
            at: [0.03, y, 0.0],
            half_way,
        };
        let half_way = [way_y, way_z].map(|way| way * distance);
        let force = OPEN.forces(&[node(0, distance, half_way), node(1, 0.0, [0.0; 2])], by(1))[0];
        let strength = OPEN.charge * OPEN.charge / (2.0 * PI * PERMITTIVITY * OPEN.height);
        let mut exact = match half_way {
            [0.0, 0.0] => [1.0 / distance, 0.0],
            _ => mean_on_a_way([distance, 0.0], half_way, 0.0),
        };
        exact[0] -= distance / (OPEN.reach * OPEN.reach);
        for axis in [0, 1] {
            let off = (force[axis] / strength - exact[axis]) * distance;
            assert!(off.abs() < 3e-3, "{way_y} {way_z}: {off}");
        }
    }
}
