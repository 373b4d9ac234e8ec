//! The drag laws: against measured cylinders, against the equations of the boundary layer, and as the kernel
//! has them.

use crate::common::*;
use spunlaid_air::FileContent;
use spunlaid_fibre::chain::Scheme;
use spunlaid_fibre::{
    BoundaryLayer, Drag, DragTable, Fibre, FibreParameters, Flight, FrictionLaw, Job, NormalLaw, Root,
    TableLaw,
};
use spunlaid_ground::Isa;
use std::f64::consts::PI;
use std::sync::Arc;

const DENSITY: f64 = 1.204;
const VISCOSITY: f64 = 1.51e-5;

/// Every pair of laws.
fn pairs() -> impl Iterator<Item = Drag> {
    FrictionLaw::ALL
        .into_iter()
        .flat_map(|along| NormalLaw::ALL.into_iter().map(move |across| Drag { along, across }))
}

/// A law as a table of ten rows to a decade, Reynolds numbers from 1e-4 to 1e5.
fn as_table(law: impl Fn(f64) -> f64) -> TableLaw {
    let re: Vec<f64> = (-40..=50).map(|i| 10f64.powf(0.1 * f64::from(i))).collect();
    let coefficients: Vec<f64> = re.iter().map(|re| law(*re)).collect();
    let table = DragTable::new(&re, &coefficients);
    TableLaw::new(FileContent::new("law.csv".into(), 1, Arc::new(table)))
}

/// The paper's law along and that of measurements across, as they are and as tables.
fn named_and_as_tables() -> [Drag; 2] {
    let (along, across) = (FrictionLaw::ALL[0], NormalLaw::MarheinekeWegener);
    let tables = Drag {
        along: FrictionLaw::Table(as_table(|re| along.coefficient(re, 1.0))),
        across: NormalLaw::Table(as_table(|re| across.coefficient(re, 1e-5))),
    };
    [Drag { along, across }, tables]
}

/// Every pair of named laws, and pairs with tables.
fn pairs_with_tables() -> impl Iterator<Item = Drag> {
    let [named, tables] = named_and_as_tables();
    let laminar = FrictionLaw::GlauertLighthill;
    pairs().chain([
        tables,
        Drag { along: tables.along, ..named },
        Drag { along: laminar, across: tables.across },
    ])
}

fn strand(drag: Drag, root: Root, diameter: f64, direction: V) -> FibreParameters {
    let fibre = Fibre { length: 0.0625, diameter, elements: 8, root, direction, ..table1_fibre() };
    FibreParameters {
        fibre,
        drag: drag.element_drag(&fibre, DENSITY, VISCOSITY),
        gravity: 9.81,
        damping: 0.0,
    }
}

/// Force of a stream of velocity `v` on element `j` of a fibre [N], from the coefficients.
fn element_force(drag: Drag, fibre: &Fibre, j: usize, v: V, tangent: V) -> V {
    let (d, l) = (fibre.diameter, fibre.rest_length());
    let along = v.dot(tangent);
    let across = v - tangent * along;
    let re = |speed: f64| speed.abs() * d / VISCOSITY;
    let mut force = V::default();
    if along != 0.0 {
        let cf = drag.along.coefficient(re(along), (j as f64 + 0.5) * l / d);
        force += tangent * (0.5 * PI * d * l * DENSITY * cf * along.abs() * along);
    }
    let speed = across.norm();
    if speed > 0.0 {
        force += across * (0.5 * d * l * DENSITY * drag.across.coefficient(re(speed), d) * speed);
    }
    force
}

/// Cylinders across a stream that Wieselsberger measured: Reynolds number and drag coefficient.
fn measured_cylinders() -> Vec<(f64, f64)> {
    let measured: Vec<(f64, f64)> = include_str!("../../../spunlaid-results/assets/published/cylinders.csv")
        .lines()
        .filter_map(|line| line.split_once(','))
        .filter_map(|(re, c)| Some((re.parse().ok()?, c.parse().ok()?)))
        .collect();
    assert_eq!(measured.len(), 15);
    measured
}

/// The uncertainty of the measured cylinders: read off a figure over six decades, to a few percent each in Re and in C.
const READ: f64 = 0.06;

#[test]
fn published_law_of_marheineke_and_wegener_worked_out_by_hand() {
    // 8π/(Re (ln 8 + ½ − γ − ln Re)) below 0.1, 2 exp(1.6911 − 0.67222 ln Re + 0.033287 ln² Re + 0.0035015 ln³ Re) to
    // 100, and 1 + 4/√Re above; the source prints five digits.
    for (re, by_hand) in [(0.01, 380.373), (1.0, 10.8509), (10.0, 2.87380), (400.0, 1.2), (1e4, 1.04)] {
        let found = NormalLaw::MarheinekeWegener.coefficient(re, 50e-6);
        assert!((found / by_hand - 1.0).abs() < 5e-5, "Re = {re}: {found}, by hand {by_hand}");
    }
}

#[test]
fn published_drag_of_cylinders_in_slow_flow() {
    for (re, expected) in measured_cylinders().into_iter().filter(|(re, _)| *re < 1.0) {
        let found = NormalLaw::MarheinekeWegener.coefficient(re, 50e-6);
        assert!((found / expected - 1.0).abs() < READ, "Re = {re}: {found}, measured {expected}");
    }
}

/// Above Re 1 the law is not as exact as the measurement: from 1 to 100 a polynomial only joins its two neighbours,
/// and 1 + 4/√Re does not contain the measured dip to 0.89 at 2000 and of the rise to 1.2 beyond. How far it is off
/// was taken from the law itself, so this shows that the law stays as it is, not that it is right.
#[test]
fn frozen_deviation_from_cylinders_in_fast_flow() {
    for (re, expected) in measured_cylinders().into_iter().filter(|(re, _)| *re >= 1.0) {
        let known = match re {
            ..60.0 => 0.06,
            ..400.0 => 0.03,
            ..6000.0 => 0.17,
            _ => -0.05,
        };
        let found = NormalLaw::MarheinekeWegener.coefficient(re, 50e-6);
        assert!((found / expected - 1.0 - known).abs() < READ, "Re = {re}: {found}, measured {expected}");
    }
}

#[test]
fn published_drag_across_cotton_fibres() {
    let numbers = |line: &str| line.split(',').filter_map(|n| n.parse().ok()).collect::<Vec<f64>>();
    let fits: Vec<[f64; 4]> = include_str!("../../../spunlaid-results/assets/published/cotton_fibres.csv")
        .lines()
        .filter_map(|line| numbers(line).try_into().ok())
        .collect();
    assert_eq!(fits.len(), 2);
    // The uncertainty of the data.
    const MEASURED: f64 = 0.2;
    for [from, to, factor, exponent] in fits {
        for i in 0..=20 {
            let re = from * (to / from).powf(f64::from(i) / 20.0);
            let expected = factor * re.powf(-exponent);
            let off = NormalLaw::MarheinekeWegener.coefficient(re, 12e-6) / expected - 1.0;
            if re <= 2.0 {
                assert!(off.abs() < MEASURED, "Re = {re}: off by {off}");
            } else {
                // The fit falls off faster than the drag of Wieselsberger's cylinders, which is 24 % above it at 3.18,
                // and which the law follows to its bias of 6 % and the reading of 6 %.
                let cylinders =
                    4.87 * (3.18 / re).powf((13.2f64 / 4.87).ln() / (3.18f64 / 0.728).ln()) / expected;
                assert!(off > -MEASURED && off < 1.12 * cylinders - 1.0, "Re = {re}: off by {off}");
            }
            // The other law is two to ten times too low for these fibres of 9 to 16 µm: a case is warned of it.
            for diameter in [9e-6, 15e-6, 16e-6] {
                let share = NormalLaw::JuShambaugh.coefficient(re, diameter) / expected;
                assert!(share > 0.10 && share < 0.55, "Re = {re}, {diameter} m: {share}");
            }
        }
    }
}

#[test]
fn published_friction_of_towed_cylinders() {
    // FEDSM2002-1123: cylinders of 0.89 mm, 30 to 150 m long, towed in sea water at 2.4 to 17.4 m/s; the drag was two
    // to three times that of a flat plate of their length, 0.455/(log₁₀ Re_L)^2.58 (Schlichting).
    const SEA_WATER: f64 = 1.05e-6;
    let plate = |re: f64| 0.455 / re.log10().powf(2.58);
    let measured = |speed: f64| {
        let of = |length: f64| plate(speed * length / SEA_WATER);
        (2.0 * of(150.0), 3.0 * of(30.0))
    };
    let re = |speed: f64| speed * 0.89e-3 / SEA_WATER;
    let law = |factor, speed| FrictionLaw::Matsui { factor }.coefficient(re(speed), 1.0);
    // At 2,000 the three factors of the literature, 0.37 to 0.9, span the measurements; at 15,000 all are below them.
    let (low, high) = measured(2.4);
    assert!(law(0.37, 2.4) < low * 1.05 && law(0.9, 2.4) > high, "{low} to {high}");
    let (low, high) = measured(17.4);
    assert!(law(0.9, 17.4) < low && law(0.9, 17.4) > 0.4 * high, "{low} to {high}, {}", law(0.9, 17.4));
    assert!(law(0.37, 17.4) < 0.5 * low, "{low}, {}", law(0.37, 17.4));
}

#[test]
fn published_friction_coefficients_worked_out_by_hand() {
    // β Re^-0.61 with the three factors of the literature: 10^-0.61 = 0.245471, 300^-0.61 = 0.0308287.
    for (law, factor) in [
        (FrictionLaw::MajumdarShambaugh, 0.78),
        (FrictionLaw::Matsui { factor: 0.37 }, 0.37),
        (FrictionLaw::ALL[0], 0.9),
    ] {
        for (re, power) in [(1.0, 1.0), (10.0, 0.245471), (300.0, 0.0308287)] {
            let found = law.coefficient(re, 1.0);
            assert!((found / (factor * power) - 1.0).abs() < 5e-6, "{law:?} at {re}: {found}");
        }
    }
}

#[test]
fn identical_forces_of_majumdar_and_shambaugh_and_of_matsui_with_their_factor() {
    let r: Vec<V> = (0..=8).map(|i| V::new(0.8, 0.0, 0.6) * (0.0078125 * f64::from(i))).collect();
    let forces = |along| {
        let drag = Drag { along, across: NormalLaw::JuShambaugh };
        [1e-2, 1.0, 30.0]
            .map(|speed| kernel_forces(&strand(drag, Root::Free, 50e-6, X), speed, &r, &[V::default(); 9]))
    };
    let theirs = forces(FrictionLaw::MajumdarShambaugh);
    assert_eq!(theirs, forces(FrictionLaw::Matsui { factor: 0.78 }));
    assert_ne!(theirs, forces(FrictionLaw::Matsui { factor: 0.37 }));
}

/// Stress at the surface over `ρνV/a` at distances `X = νx/(V a²)` from 1e-6 on by tens, from the equations
/// of the boundary layer themselves: `e^2t u u_X − F_X u_t = u_tt`, `t = ln(r/a)`, `F = ∫ u e^2t dt`,
/// implicit in steps of ln X.
fn stress_by_boundary_layer(layer: BoundaryLayer, decades: usize) -> Vec<f64> {
    const N: usize = 300;
    const STEPS: usize = 100;
    let t: Vec<f64> = (0..=N)
        .map(|i| if i == 0 { 0.0 } else { 1e-6 * 1.6e7f64.powf((i - 1) as f64 / (N - 1) as f64) })
        .collect();
    let weight: Vec<f64> = t.iter().map(|t| (2.0 * t).exp()).collect();
    let (wall, far) = if layer == BoundaryLayer::Moving { (1.0, 0.0) } else { (0.0, 1.0) };
    let flux = |u: &[f64]| {
        let mut sum = vec![0.0; N + 1];
        for i in 0..N {
            sum[i + 1] = sum[i] + 0.5 * (u[i] * weight[i] + u[i + 1] * weight[i + 1]) * (t[i + 1] - t[i]);
        }
        sum
    };
    // Any profile to begin with: its memory fades within a decade of X.
    let mut x = 1e-8f64;
    let mut u: Vec<f64> =
        t.iter().map(|t| far + (wall - far) * (1.0 - (0.55 * t / x.sqrt()).tanh())).collect();
    let mut stress = Vec::new();
    for decade in 0..decades + 2 {
        for _ in 0..STEPS {
            let step = x * (10f64.powf(1.0 / STEPS as f64) - 1.0);
            x += step;
            let (before, flux_before) = (u.clone(), flux(&u));
            for _ in 0..60 {
                let flux_now = flux(&u);
                let (mut c, mut d) = (vec![0.0; N + 1], vec![wall; N + 1]);
                for i in 1..N {
                    let (hm, hp) = (t[i] - t[i - 1], t[i + 1] - t[i]);
                    let inflow = (flux_now[i] - flux_before[i]) / step;
                    let carried = weight[i] * u[i] / step;
                    let below = (inflow * hp - 2.0) / (hm * (hm + hp));
                    let above = (-inflow * hm - 2.0) / (hp * (hm + hp));
                    let here = carried + 2.0 / (hm * hp) - inflow * (hp - hm) / (hp * hm);
                    let pivot = here - below * c[i - 1];
                    c[i] = above / pivot;
                    d[i] = (carried * before[i] - below * d[i - 1]) / pivot;
                }
                // Half way each time, for the flux and the profile feed on one another.
                let (mut next, mut change) = (far, 0.0f64);
                for i in (0..N).rev() {
                    next = d[i] - c[i] * next;
                    change = change.max((next - u[i]).abs());
                    u[i] += 0.5 * (next - u[i]);
                }
                if change < 1e-8 {
                    break;
                }
            }
        }
        if decade >= 1 {
            stress.push((u[1] - u[0]).abs() / t[1]);
        }
    }
    stress
}

#[test]
fn analytic_laminar_friction_against_the_equations_of_the_boundary_layer() {
    // The momentum integral falls short by 8 to 9 % and by 13 % where the layer is thin, as for the plate, less
    // and less as it thickens. First-order steps of 2.3 % in X and 300 points leave 1 %.
    for (layer, thin, plate) in
        [(BoundaryLayer::Moving, 0.09, 0.443_75), (BoundaryLayer::Held, 0.131, 0.332_06)]
    {
        let exact = stress_by_boundary_layer(layer, 12);
        assert!((exact[0] * 1e-3 / plate - 1.0).abs() < 0.01, "{layer:?}: plate {}", exact[0] * 1e-3);
        for (k, exact) in exact.iter().enumerate() {
            let x = 10f64.powi(k as i32 - 6);
            let short = 1.0 - 1.0 / (layer.thickness(x) * exact);
            assert!(short > 0.0 && short < thin + 0.01, "{layer:?} at {x:e}: short by {short}");
            assert!(x < 1e4 || short < 0.055, "{layer:?} at {x:e}: short by {short}");
        }
    }
}

#[test]
fn analytic_forces_of_every_law_in_the_kernel() {
    for drag in pairs() {
        for diameter in [5e-6, 60e-6, 1e-3] {
            let strand = strand(drag, Root::Free, diameter, X);
            let heading = V::new(0.8, 0.0, 0.6);
            let l = strand.fibre.rest_length();
            let r: Vec<V> = (0..=8).map(|i| heading * (l * i as f64)).collect();
            for speed in [1e-3, 0.3, 10.0, 300.0] {
                let found = kernel_forces(&strand, speed, &r, &[V::default(); 9]);
                let force = |j: usize| element_force(drag, &strand.fibre, j, X * speed, heading);
                for (i, found) in found.iter().enumerate() {
                    let above = if i > 0 { force(i - 1) } else { V::default() };
                    let below = if i < 8 { force(i) } else { V::default() };
                    let weight = X * (strand.fibre.node_mass(i) * 9.81);
                    let expected = (above + below) * 0.5 + weight;
                    // The table's 1e-6, and the rounding of a taut straight chain's tension.
                    let slack = strand.fibre.axial_stiffness() * l * 1e-14;
                    let error = (*found - expected).norm();
                    assert!(error < 1e-6 * expected.norm() + slack, "{drag:?} {diameter} {speed}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn analytic_a_flight_by_a_named_law_as_a_table_is_that_flight() {
    let mut case = table1(Scheme::SemiImplicitEuler, 1e-5, 0.05, 1);
    let ends = named_and_as_tables().map(|drag| {
        case.drag = drag;
        let mut flight = Flight::new(&[Job::new(&case, 0)], Isa::detect()).expect("a flight");
        flight.step_to(0.05).expect("it flies");
        flight.snapshot().position[case.fibre.elements].lane(0)
    });
    // Where it hung before.
    let moved = ends[0] - X * case.fibre.length;
    let error = (ends[1] - ends[0]).norm() / moved.norm();
    assert!(moved.norm() > 1e-3 && error < 1e-3 && error > 0.0, "{error:e} of {moved:?}");
}

#[test]
fn analytic_terminal_velocity_across_by_marheineke_and_wegener() {
    // A free fibre falls across itself at w = ½ d ρ C_n(V) V² per length, for V by halving.
    let drag = Drag { along: FrictionLaw::GlauertLighthill, across: NormalLaw::MarheinekeWegener };
    for diameter in [10e-6, 100e-6] {
        let mut strand = strand(drag, Root::Free, diameter, Y);
        // Soft, for long steps.
        strand.fibre.youngs_modulus = 1e5;
        let weight = strand.fibre.density * strand.fibre.cross_section() * 9.81;
        let drag_at = |v: f64| {
            0.5 * diameter * DENSITY * drag.across.coefficient(v * diameter / VISCOSITY, diameter) * v * v
        };
        let (mut low, mut high) = (1e-6, 100.0);
        for _ in 0..100 {
            let middle = f64::sqrt(low * high);
            if drag_at(middle) < weight { low = middle } else { high = middle }
        }
        // The slower way of dying out is that of the linear law, e^(−gt/V).
        let h = 1e-5 * diameter / 10e-6;
        let steps = (30.0 * low / 9.81 / h) as u64;
        let (eddies, turbulence) = steady_air(0.0, 8, 100.0);
        let mut flight =
            Flight::assembled(Isa::detect(), &[strand], (&eddies, &turbulence), Scheme::SemiImplicitEuler, h)
                .expect("fibres that agree");
        flight.advance(steps);
        for v in &flight.chain().velocity {
            let v = v.lane(0);
            assert!((v - X * low).norm() < 1e-6 * low, "{diameter}: {v:?}, expected {low} m/s");
        }
    }
}

#[test]
fn analytic_no_drag_at_no_velocity() {
    for drag in pairs() {
        let strand = FibreParameters { gravity: 0.0, ..strand(drag, Root::Free, 20e-6, X) };
        let l = strand.fibre.rest_length();
        let r: Vec<V> = (0..=8).map(|i| X * (l * i as f64)).collect();
        let mut last = f64::INFINITY;
        for speed in [1.0, 1e-3, 1e-9, 1e-100, 1e-300, 0.0] {
            let v = V::new(-speed, speed, 0.0);
            let force = kernel_forces(&strand, 0.0, &r, &[v; 9])[4].norm();
            assert!(force < last || force == 0.0, "{drag:?} at {speed}: {force}");
            last = force;
        }
        assert_eq!(last, 0.0, "{drag:?}");
        // What is no number any more stays so, without a panic.
        for odd in [f64::NAN, f64::INFINITY] {
            let force = kernel_forces(&strand, 0.0, &r, &[V::new(odd, odd, 0.0); 9])[4];
            assert!(!force.norm().is_finite());
        }
    }
}

#[test]
fn identical_alone_or_in_company_on_any_instruction_set() {
    let (eddies, turbulence) = steady_air(7.0, 8, 1.0);
    for drag in pairs_with_tables() {
        for scheme in Scheme::ALL {
            let strands: Vec<FibreParameters> = (1..=8)
                .map(|i| strand(drag, Root::Pinned, 7e-6 * f64::from(i), V::new(0.6, 0.0, 0.8)))
                .collect();
            let fly = |isa: Isa, strands: &[FibreParameters]| {
                let mut flight = Flight::assembled(isa, strands, (&eddies, &turbulence), scheme, 1e-7)
                    .expect("fibres that agree");
                flight.advance(40);
                let nodes = flight.chain().position.clone();
                (0..strands.len())
                    .map(|lane| nodes.iter().map(|p| p.lane(lane)).collect())
                    .collect::<Vec<Vec<V>>>()
            };
            let together = fly(Isa::Baseline, &strands);
            for isa in Isa::available() {
                assert!(fly(isa, &strands) == together, "{drag:?} {scheme:?} {}", isa.name());
                for (strand, together) in strands.iter().zip(&together) {
                    assert!(fly(isa, &[*strand])[0] == *together, "{drag:?} {scheme:?} {} alone", isa.name());
                }
            }
        }
    }
}
