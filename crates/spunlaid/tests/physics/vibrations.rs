//! Small vibrations in a vacuum: the flight's frequency against the discrete chain's own, to the time
//! step's error, and the discrete chain's against the continuous formulas.

use crate::common::modes::{frequency_of, vibrations};
use crate::common::*;
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{Fibre, Flight, Root};
use spunlaid_ground::{Isa, Vec3, WIDTH};
use std::f64::consts::PI;

/// Time step and duration of a flight [s].
#[derive(Clone, Copy)]
struct FlightTimes {
    h: f64,
    duration: f64,
}

/// Flies a chain from rest at `start` displaced along each mode (one per lane, by `size` at the largest),
/// and measures the frequency of each lane's displacement on its own mode.
///
/// * `axis` – picks the displaced coordinate
fn flown_frequencies(
    fibre: Fibre,
    gravity: f64,
    start: &[V],
    modes: &[Vec<f64>],
    axis: V,
    size: f64,
    times: FlightTimes,
) -> Vec<f64> {
    let FlightTimes { h, duration } = times;
    let strand = in_vacuum(fibre, gravity);
    let (eddies, turbulence) = steady_air(0.0, fibre.elements, duration);
    let mut flight = Flight::assembled(Isa::detect(), &[strand], (&eddies, &turbulence), Scheme::Leapfrog, h)
        .expect("fibres that agree");
    let scaled: Vec<Vec<f64>> = modes
        .iter()
        .map(|mode| {
            let largest = mode.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            // Mode 0 is the root, held.
            std::iter::once(0.0).chain(mode.iter().map(|x| x / largest * size)).collect()
        })
        .collect();
    let mut position = in_all_lanes(start);
    for (lane, mode) in scaled.iter().enumerate().take(WIDTH) {
        for (p, q) in position.iter_mut().zip(mode) {
            let moved = p.lane(lane) + axis * *q;
            p.set_lane(lane, moved);
        }
    }
    flight.restart_from(position, vec![Vec3::ZERO; start.len()]).expect("as many as nodes");
    let stride = 4;
    let mut traces = vec![Vec::new(); scaled.len()];
    for _ in 0..(duration / h) as usize / stride {
        flight.advance(stride as u64);
        for (lane, (trace, mode)) in traces.iter_mut().zip(&scaled).enumerate() {
            let on_mode = |i: usize| {
                let off = flight.chain().position[i].lane(lane) - start[i];
                off.dot(axis) * mode[i] * fibre.node_mass(i)
            };
            trace.push((1..start.len()).map(on_mode).sum());
        }
    }
    traces.iter().map(|trace| frequency_of(trace, stride as f64 * h)).collect()
}

fn node_masses(fibre: &Fibre) -> Vec<f64> {
    (1..=fibre.elements).map(|i| fibre.node_mass(i)).collect()
}

/// Adds a spring of `k` between the free nodes (held: `None`) to a stiffness matrix.
fn add_spring(matrix: &mut [Vec<f64>], weights: &[(usize, f64)], k: f64) {
    for &(i, a) in weights {
        for &(j, b) in weights {
            matrix[i][j] += k * a * b;
        }
    }
}

/// Lateral stiffness of a string of nodes 1..=N from the tension over the length of each element.
fn string_stiffness(springs: &[f64]) -> Vec<Vec<f64>> {
    let n = springs.len();
    let mut k = vec![vec![0.0; n]; n];
    for (j, spring) in springs.iter().enumerate() {
        if j == 0 {
            add_spring(&mut k, &[(0, 1.0)], *spring);
        } else {
            add_spring(&mut k, &[(j - 1, -1.0), (j, 1.0)], *spring);
        }
    }
    k
}

/// So thin that bending counts for nothing (EI/(ρgAL³) is 1e-8), stiff enough not to stretch.
fn thread(elements: usize) -> Fibre {
    Fibre { diameter: 1e-6, elements, ..table1_fibre() }
}

/// Tensions of the elements of a chain that hangs under its weight.
fn hung(fibre: &Fibre, gravity: f64) -> Vec<f64> {
    let below = |j: usize| ((j + 1)..=fibre.elements).map(|i| fibre.node_mass(i) * gravity).sum();
    (0..fibre.elements).map(below).collect()
}

/// Frequencies and modes of a chain that hangs, its elements as long as their tension makes them.
fn hanging(fibre: &Fibre, length: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<Vec<f64>>) {
    let springs: Vec<f64> = hung(fibre, 9.81).into_iter().map(|tension| tension / length(tension)).collect();
    vibrations(&string_stiffness(&springs), &node_masses(fibre))
}

#[test]
fn published_hanging_chain() {
    // Frequencies of the bead chain itself, which does not stretch [Hz], computed elsewhere.
    for (elements, published) in [(20, [0.59894, 1.36261, 2.07626]), (100, [0.59937, 1.37532, 2.15360])] {
        // Soft, so that the steps are long; how far it is stretched is known.
        let fibre = Fibre { youngs_modulus: 3e7, ..thread(elements) };
        let (stiff, _) = hanging(&fibre, |_| fibre.rest_length());
        let stretched = |tension: f64| fibre.rest_length() + tension / fibre.axial_stiffness();
        let (discrete, modes) = hanging(&fibre, stretched);
        let mut nodes = vec![V::default()];
        for tension in hung(&fibre, 9.81) {
            nodes.push(nodes[nodes.len() - 1] + X * stretched(tension));
        }
        let h = 0.8 * fibre.axial_step_limit();
        let simulated =
            flown_frequencies(fibre, 9.81, &nodes, &modes[..3], Y, 1e-4, FlightTimes { h, duration: 6.0 });
        for i in 0..3 {
            // Half of the last digit published.
            assert!((stiff[i] - published[i]).abs() < 6e-6, "N = {elements}: {} Hz", stiff[i]);
            // Amplitude squared (1e-8), linear passages, time step. Found: up to 4e-7.
            assert!(
                (simulated[i] / discrete[i] - 1.0).abs() < 2e-6,
                "N = {elements}, mode {i}: {} Hz",
                simulated[i]
            );
        }
    }
}

#[test]
fn analytic_hanging_chain_tends_to_the_continuous_one() {
    // f_n = (j_n/4π)√(g/L); the discrete error falls by four when the elements halve.
    let zeros = [2.404_826, 5.520_078, 8.653_728];
    let off = |elements: usize| -> Vec<f64> {
        let fibre = thread(elements);
        let (found, _) = hanging(&fibre, |_| fibre.rest_length());
        zeros.iter().zip(found).map(|(j, f)| f - j / (4.0 * PI) * 9.81f64.sqrt()).collect()
    };
    let (coarse, fine) = (off(50), off(100));
    for i in 0..3 {
        let ratio = coarse[i] / fine[i];
        assert!((ratio - 4.0).abs() < 0.1, "mode {i}: error falls by {ratio}");
    }
}

#[test]
fn analytic_clamped_beam() {
    let fibre = Fibre {
        length: 0.1,
        diameter: 1e-3,
        density: 1000.0,
        youngs_modulus: 1e9,
        elements: 24,
        root: Root::Clamped,
        direction: X,
        ..Fibre::UNKNOWN
    };
    let bending = |fibre: &Fibre| {
        // Turn at node i: (y_{i−1} − 2y_i + y_{i+1})/l; at the clamped root y_1/l with twice the spring.
        let (n, l) = (fibre.elements, fibre.rest_length());
        let mut k = vec![vec![0.0; n]; n];
        add_spring(&mut k, &[(0, 1.0 / l)], fibre.root_stiffness());
        for i in 1..n {
            let mut weights = vec![(i - 1, -2.0 / l), (i, 1.0 / l)];
            if i >= 2 {
                weights.push((i - 2, 1.0 / l));
            }
            add_spring(&mut k, &weights, fibre.rotational_stiffness());
        }
        vibrations(&k, &node_masses(fibre))
    };
    let (discrete, modes) = bending(&fibre);
    let l = fibre.rest_length();
    let nodes: Vec<V> = (0..=fibre.elements).map(|i| X * (l * i as f64)).collect();
    let h = 0.2 * fibre.axial_step_limit().min(fibre.bending_step_limit());
    let duration = 20.0 / discrete[0];
    let simulated = flown_frequencies(fibre, 0.0, &nodes, &modes[..3], Y, 1e-6, FlightTimes { h, duration });
    for i in 0..3 {
        // Leapfrog raises a frequency by (ωh)²/24, below 1e-6 here; linear passages the same order.
        assert!(
            (simulated[i] / discrete[i] - 1.0).abs() < 1e-5,
            "mode {i}: {} of {} Hz",
            simulated[i],
            discrete[i]
        );
    }
    // βL = 1.87510, 4.69409, 7.85476: the discrete error falls by four when the elements halve.
    let wave =
        (fibre.youngs_modulus * fibre.second_moment() / (fibre.density * fibre.cross_section())).sqrt();
    let (coarse, _) = bending(&Fibre { elements: 40, ..fibre });
    let (fine, _) = bending(&Fibre { elements: 80, ..fibre });
    for (i, beta) in [1.875_104, 4.694_091, 7.854_757].into_iter().enumerate() {
        let exact = (beta / fibre.length).powi(2) * wave / (2.0 * PI);
        let ratio = (coarse[i] - exact) / (fine[i] - exact);
        assert!((ratio - 4.0).abs() < 0.2, "mode {i}: error falls by {ratio}");
        assert!((fine[i] / exact - 1.0).abs() < 5e-3, "mode {i}: {} of {exact} Hz", fine[i]);
    }
}

#[test]
fn analytic_axial_chain() {
    // Held at one end, half a mass at the other: ω_n = 2√(k/m) sin((2n−1)π/4N), no mesh error.
    let fibre = Fibre { elements: 16, ..table1_fibre() };
    let (n, l) = (fibre.elements, fibre.rest_length());
    let exact = |mode: usize| {
        let w = 2.0 * (fibre.axial_stiffness() / fibre.element_mass()).sqrt();
        w * ((2 * mode + 1) as f64 * PI / (4 * n) as f64).sin() / (2.0 * PI)
    };
    let modes: Vec<Vec<f64>> = (0..4)
        .map(|mode| (1..=n).map(|i| ((2 * mode + 1) as f64 * PI * i as f64 / (2 * n) as f64).sin()).collect())
        .collect();
    let nodes: Vec<V> = (0..=n).map(|i| X * (l * i as f64)).collect();
    let h = 0.02 * fibre.axial_step_limit();
    let times = FlightTimes { h, duration: 30.0 / exact(0) };
    let simulated = flown_frequencies(fibre, 0.0, &nodes, &modes, X, 1e-7, times);
    for (mode, f) in simulated.into_iter().enumerate() {
        // Leapfrog: ω_flown = (2/h) asin(ωh/2).
        let leapfrog = (PI * exact(mode) * h).asin() / (PI * h);
        assert!((f / leapfrog - 1.0).abs() < 1e-6, "mode {mode}: {f} of {leapfrog} Hz");
    }
}

#[test]
fn analytic_taut_string() {
    // Stretched to a tension and its free end held there, step by step.
    let fibre = thread(20);
    let l = fibre.rest_length();
    let tension = 1e-6;
    let (n, m) = (fibre.elements, fibre.element_mass());
    // Both ends held: ω_k = 2√(T/(ml)) sin(kπ/2N).
    let stretched: Vec<V> =
        (0..=n).map(|i| X * (i as f64 * (l + tension / fibre.axial_stiffness()))).collect();
    let spacing = stretched[1].x;
    let strand = in_vacuum(fibre, 0.0);
    let h = 0.5 * fibre.axial_step_limit();
    for mode in 1..=2usize {
        let w = 2.0 * (tension / (m * spacing)).sqrt() * (mode as f64 * PI / (2 * n) as f64).sin();
        let exact = w / (2.0 * PI);
        let duration = 12.0 / exact;
        let (eddies, turbulence) = steady_air(0.0, n, duration);
        let mut flight =
            Flight::assembled(Isa::detect(), &[strand], (&eddies, &turbulence), Scheme::Leapfrog, h)
                .expect("fibres that agree");
        let shape = |i: usize| (mode as f64 * PI * i as f64 / n as f64).sin();
        let start: Vec<V> = (0..=n).map(|i| stretched[i] + Y * (1e-5 * shape(i))).collect();
        flight.restart_from(in_all_lanes(&start), vec![Vec3::ZERO; n + 1]).expect("as many as nodes");
        let mut trace = Vec::new();
        for _ in 0..(duration / h) as usize {
            flight.advance(1);
            flight.hold(n, Vec3::splat(stretched[n]));
            trace.push((1..n).map(|i| flight.chain().position[i].lane(0).y * shape(i)).sum());
        }
        let simulated = frequency_of(&trace, h);
        let leapfrog = (0.5 * w * h).asin() / (PI * h);
        // Amplitude squared over length squared, 1e-8, at its worst times the stiffness over the tension.
        assert!((simulated / leapfrog - 1.0).abs() < 1e-5, "mode {mode}: {simulated} of {leapfrog} Hz");
    }
}
