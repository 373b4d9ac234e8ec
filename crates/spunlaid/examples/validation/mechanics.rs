//! Forces, statics and vibrations.

use crate::common::beams::{at_rest, slender_beam};
use crate::common::modes::{frequency_of, vibrations};
use crate::common::reference::{ReferenceDrag, forces as scalar_forces};
use crate::common::*;
use crate::title;
use spunlaid::fibre::chain::Scheme;
use spunlaid::fibre::{Fibre, FibreParameters, Flight, Root};
use spunlaid::ground::{Isa, Vec3};
use std::f64::consts::PI;

const AIR: ReferenceDrag = ReferenceDrag { air_density: 1.204, viscosity: 1.51e-5, beta: 0.9 };

fn stubby(root: Root) -> FibreParameters {
    let fibre =
        Fibre { length: 0.05, diameter: 300e-6, youngs_modulus: 1e6, elements: 10, root, ..table1_fibre() };
    let drag = paper_drag().element_drag(&fibre, AIR.air_density, AIR.viscosity);
    FibreParameters { fibre, drag, gravity: 9.81, damping: 0.0 }
}

pub fn forces() {
    title("forces on the nodes of 700 crooked fibres against the plain scalar model");
    let strand = stubby(Root::Free);
    let (l, n) = (strand.fibre.rest_length(), strand.fibre.elements);
    let mut worst: f64 = 0.0;
    for seed in 0..700 {
        let angle = [1e-6, 0.01, 0.1, 0.3, 1.0, 3.0, 30.0][seed % 7];
        let (mut at, mut heading) = (V::default(), X);
        let mut r = vec![at];
        for j in 0..n {
            let turned = heading + scattered_vector(seed * 100 + j) * angle;
            heading = turned * (1.0 / turned.norm());
            at += heading * (l * (1.0 + 0.1 * scatter(seed * 100 + j + 50)));
            r.push(at);
        }
        let v: Vec<V> = (0..=n).map(|i| scattered_vector(90_000 + seed * 50 + i) * 3.0).collect();
        let expected = scalar_forces(&strand, Some(&AIR), &vec![X * 7.0; n], &r, &v);
        let found = kernel_forces(&strand, 7.0, &r, &v);
        let scale = expected.iter().map(|f| f.norm()).fold(0.0, f64::max);
        let off = found.iter().zip(&expected).map(|(&a, &b)| (a - b).norm()).fold(0.0, f64::max);
        worst = worst.max(off / scale);
    }
    println!("  largest difference {worst:.1e} of the largest force");
}

pub fn terminal_velocity() {
    title("terminal velocity of a falling fibre, 300 µm, reached by falling");
    for (name, heading) in [("along itself", X), ("across itself", Y)] {
        let mut strand = stubby(Root::Free);
        strand.fibre.direction = heading;
        let d = strand.fibre.diameter;
        let nu = AIR.viscosity;
        let rho = AIR.air_density;
        let weight = strand.fibre.density * strand.fibre.cross_section() * 9.81;
        let expected = if heading == X {
            (weight / (0.5 * PI * d * rho * 0.9 * (d / nu).powf(-0.61))).powf(1.0 / 1.39)
        } else {
            (weight / (0.5 * d * rho * 6.96 * (d / nu).powf(-0.44) * (d / 78e-6f64).powf(0.404)))
                .powf(1.0 / 1.56)
        };
        let h = 2e-5;
        let (eddies, turbulence) = steady_air(0.0, strand.fibre.elements, 100.0);
        let mut flight =
            Flight::assembled(Isa::detect(), &[strand], (&eddies, &turbulence), Scheme::SemiImplicitEuler, h)
                .expect("fibres that agree");
        flight.advance((40.0 * expected / 9.81 / h) as u64);
        let found = flight.chain().velocity[5].lane(0).x;
        println!(
            "  {name}: {found:.6} m/s, from the law {expected:.6}, off by {:.1e}",
            found / expected - 1.0
        );
    }
}

pub fn cantilevers() {
    title("cantilevers: deflection and shortening by the length (16 and 32 elements, extrapolated)");
    let fibre = slender_beam(32);
    let stiffness = fibre.youngs_modulus * fibre.second_moment();
    let weight = fibre.density * fibre.cross_section();
    let load = [1.0, 2.0, 10.0, 0.0, 0.0, 0.0, 0.0, 0.0].map(|alpha| alpha * stiffness);
    let gravity = [0.0, 0.0, 0.0, 1.0, 10.0, 0.0, 0.0, 0.0].map(|gamma| gamma * stiffness / weight);
    let (coarse, fine) = (at_rest(16, load, gravity), at_rest(32, load, gravity));
    let names = ["end load 1", "end load 2", "end load 10", "own weight 1", "own weight 10"];
    for (i, name) in names.into_iter().enumerate() {
        let extrapolated = |c: f64, f: f64| f + (f - c) / 3.0;
        println!(
            "  {name:<14} {:.5} {:.5}   (deflection at 16: {:.5}, at 32: {:.5})",
            extrapolated(coarse[i].0, fine[i].0),
            extrapolated(coarse[i].1, fine[i].1),
            coarse[i].0,
            fine[i].0
        );
    }
}

pub fn pure_moment() {
    title("pure end moment, 40 elements: force left on inner nodes by the couple; tip from the circle");
    let elements = 40;
    let strand = in_vacuum(slender_beam(elements), 0.0);
    let l = strand.fibre.rest_length();
    for turned in [0.5, 2.0, 2.0 * PI, 9.0] {
        let theta: f64 = turned / elements as f64;
        let mut r = vec![V::default()];
        for j in 0..elements {
            let angle = (j as f64 + 0.5) * theta;
            r.push(r[j] + V::new(angle.sin(), angle.cos(), 0.0) * l);
        }
        let f = kernel_forces(&strand, 0.0, &r, &vec![V::default(); r.len()]);
        let couple = strand.fibre.rotational_stiffness() * theta / l;
        let stray = f[1..elements - 1].iter().map(|f| f.norm()).fold(0.0, f64::max);
        let circle = V::new(1.0 - turned.cos(), turned.sin(), 0.0) * (1.0 / turned);
        println!(
            "  turned {turned:.3}: {:.1e} of the couple; tip off by {:.2e} L, θ²/24 = {:.2e}",
            stray / couple,
            (r[elements] - circle).norm(),
            theta * theta / 24.0
        );
    }
}

/// Time step and duration of a flight [s].
#[derive(Clone, Copy)]
struct FlightTimes {
    h: f64,
    duration: f64,
}

/// Frequencies of a chain released from each of the mode shapes, one per lane, by leapfrog.
fn simulated(
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
    let mut position = in_all_lanes(start);
    for (lane, mode) in modes.iter().enumerate() {
        let largest = mode.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
        for (p, q) in position[1..].iter_mut().zip(mode) {
            let moved = p.lane(lane) + axis * (q / largest * size);
            p.set_lane(lane, moved);
        }
    }
    flight.restart_from(position, vec![Vec3::ZERO; start.len()]).expect("as many as nodes");
    let stride = 4;
    let mut traces = vec![Vec::new(); modes.len()];
    for _ in 0..(duration / h) as usize / stride {
        flight.advance(stride as u64);
        for (lane, (trace, mode)) in traces.iter_mut().zip(modes).enumerate() {
            let on_mode = |i: usize| {
                (flight.chain().position[i].lane(lane) - start[i]).dot(axis)
                    * mode[i - 1]
                    * fibre.node_mass(i)
            };
            trace.push((1..start.len()).map(on_mode).sum());
        }
    }
    traces.iter().map(|trace| frequency_of(trace, stride as f64 * h)).collect()
}

fn spring(matrix: &mut [Vec<f64>], weights: &[(usize, f64)], k: f64) {
    for &(i, a) in weights {
        for &(j, b) in weights {
            matrix[i][j] += k * a * b;
        }
    }
}

fn masses(fibre: &Fibre) -> Vec<f64> {
    (1..=fibre.elements).map(|i| fibre.node_mass(i)).collect()
}

fn thread(elements: usize) -> Fibre {
    Fibre { diameter: 1e-6, elements, ..table1_fibre() }
}

pub fn hanging_chain() {
    title("hanging chain [Hz]: matrices of the bead chain, simulated by leapfrog");
    for elements in [20, 100] {
        let fibre = thread(elements);
        let l = fibre.rest_length();
        let tension: Vec<f64> =
            (0..elements).map(|j| ((j + 1)..=elements).map(|i| fibre.node_mass(i) * 9.81).sum()).collect();
        let (mut x, mut nodes) = (0.0, vec![V::default()]);
        let mut k = vec![vec![0.0; elements]; elements];
        for (j, t) in tension.iter().enumerate() {
            x += l + t / fibre.axial_stiffness();
            nodes.push(X * x);
            let weights = if j == 0 { vec![(0, 1.0)] } else { vec![(j - 1, -1.0), (j, 1.0)] };
            spring(&mut k, &weights, t / l);
        }
        let (discrete, modes) = vibrations(&k, &masses(&fibre));
        let h = 0.5 * fibre.axial_step_limit();
        let found = simulated(fibre, 9.81, &nodes, &modes[..3], Y, 1e-4, FlightTimes { h, duration: 6.0 });
        println!("  N = {elements}: {:.5?}, simulated {found:.5?}", &discrete[..3]);
        println!("     simulated over matrices less 1: {}", short(&ratios(&found, &discrete)));
    }
}

fn ratios(found: &[f64], expected: &[f64]) -> Vec<f64> {
    found.iter().zip(expected).map(|(a, b)| a / b - 1.0).collect()
}

fn short(values: &[f64]) -> String {
    values.iter().map(|x| format!("{x:.1e}")).collect::<Vec<_>>().join(", ")
}

pub fn beam() {
    title(
        "clamped-free beam: simulated over matrices less 1 (24 elements), matrices over βL less 1 (80 elements)",
    );
    let fibre = |elements| Fibre {
        length: 0.1,
        diameter: 1e-3,
        density: 1000.0,
        youngs_modulus: 1e9,
        elements,
        root: Root::Clamped,
        direction: X,
        ..Fibre::UNKNOWN
    };
    let bending = |fibre: &Fibre| {
        let (n, l) = (fibre.elements, fibre.rest_length());
        let mut k = vec![vec![0.0; n]; n];
        spring(&mut k, &[(0, 1.0 / l)], fibre.root_stiffness());
        for i in 1..n {
            let mut weights = vec![(i - 1, -2.0 / l), (i, 1.0 / l)];
            if i >= 2 {
                weights.push((i - 2, 1.0 / l));
            }
            spring(&mut k, &weights, fibre.rotational_stiffness());
        }
        vibrations(&k, &masses(fibre))
    };
    let f = fibre(24);
    let (discrete, modes) = bending(&f);
    let nodes: Vec<V> = (0..=24).map(|i| X * (f.rest_length() * f64::from(i))).collect();
    let h = 0.2 * f.axial_step_limit().min(f.bending_step_limit());
    let found =
        simulated(f, 0.0, &nodes, &modes[..3], Y, 1e-6, FlightTimes { h, duration: 20.0 / discrete[0] });
    println!("  simulated: {}", short(&ratios(&found, &discrete)));
    let wave = (f.youngs_modulus * f.second_moment() / (f.density * f.cross_section())).sqrt();
    let exact: Vec<f64> =
        [1.875_104, 4.694_091, 7.854_757].map(|b: f64| (b / f.length).powi(2) * wave / (2.0 * PI)).to_vec();
    let coarse = ratios(&bending(&fibre(40)).0, &exact);
    let fine = ratios(&bending(&fibre(80)).0, &exact);
    let falls: Vec<f64> = coarse.iter().zip(&fine).map(|(a, b)| a / b).collect();
    println!("  mesh: {}; from 40 to 80 elements the error falls by {falls:.2?}", short(&fine[..3]));
}

pub fn axial_chain() {
    title(
        "axial chain, 16 elements: simulated over 2√(k/m) sin((2n−1)π/4N) with leapfrog's own error, less 1",
    );
    let fibre = Fibre { elements: 16, ..table1_fibre() };
    let (n, l) = (fibre.elements, fibre.rest_length());
    let modes: Vec<Vec<f64>> = (0..4)
        .map(|mode| (1..=n).map(|i| ((2 * mode + 1) as f64 * PI * i as f64 / (2 * n) as f64).sin()).collect())
        .collect();
    let nodes: Vec<V> = (0..=n).map(|i| X * (l * i as f64)).collect();
    let h = 0.02 * fibre.axial_step_limit();
    let w = 2.0 * (fibre.axial_stiffness() / fibre.element_mass()).sqrt();
    let exact: Vec<f64> = (0..4)
        .map(|mode| w * (f64::from(2 * mode + 1) * PI / (4 * n) as f64).sin() / (2.0 * PI))
        .map(|f| (PI * f * h).asin() / (PI * h))
        .collect();
    let found = simulated(fibre, 0.0, &nodes, &modes, X, 1e-7, FlightTimes { h, duration: 30.0 / exact[0] });
    println!("  {}", short(&ratios(&found, &exact)));
}

pub fn taut_string() {
    title("taut string, 20 elements: simulated over 2√(T/ml) sin(kπ/2N) with leapfrog's own error, less 1");
    let fibre = thread(20);
    let n = fibre.elements;
    let m = fibre.element_mass();
    let tension = 1e-6;
    let spacing = fibre.rest_length() + tension / fibre.axial_stiffness();
    let stretched: Vec<V> = (0..=n).map(|i| X * (i as f64 * spacing)).collect();
    let h = 0.5 * fibre.axial_step_limit();
    for mode in 1..=2usize {
        let w = 2.0 * (tension / (m * spacing)).sqrt() * (mode as f64 * PI / (2 * n) as f64).sin();
        let duration = 12.0 * 2.0 * PI / w;
        let (eddies, turbulence) = steady_air(0.0, n, duration);
        let strand = in_vacuum(fibre, 0.0);
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
        let expected = (0.5 * w * h).asin() / (PI * h);
        println!("  mode {mode}: {:.1e}", frequency_of(&trace, h) / expected - 1.0);
    }
}
