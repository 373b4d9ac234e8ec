//! Scratch: coiling.
use spunlaid::air::*;
use spunlaid::case::*;
use spunlaid::chain::schemes::Scheme;
use spunlaid::drag::*;
use spunlaid::fibre::*;
use spunlaid::flight::*;
use spunlaid::lanes::Isa;
use spunlaid::line::*;
use spunlaid::vec3::Vec3;

fn main() {
    let arg: Vec<String> = std::env::args().collect();
    let num = |i: usize, or: f64| arg.get(i).map_or(or, |a| a.parse().unwrap());
    let g_number = num(1, 28.6);
    let height = 0.1;
    let l = num(2, 0.04) * height;
    let tau = num(3, 3e-3) * (height / 9.81f64).sqrt();
    let turns = num(4, 8.0);
    let scheme = match num(5, 0.0) as u32 {
        0 => Scheme::ImplicitTension,
        1 => Scheme::Leapfrog,
        _ => Scheme::SemiImplicitEuler,
    };
    let (d, rho, g) = (3e-4, 1000.0, 9.81);
    let e = 16.0 * rho * g * height.powi(3) / (g_number * d * d);
    let v = 0.05 * (g * height).sqrt();
    let mut air = Air::uniform(1.0, 0.0, 0.05, 10.0);
    air.density = 0.0;
    air.velocity = 0.0;
    air.harmonics = 128;
    let fibre = Fibre {
        length: height,
        diameter: d,
        density: rho,
        youngs_modulus: e,
        bending_viscosity_time: tau,
        elements: (height / l).round() as usize,
        root: Root::Clamped,
        direction: Vec3::new(1.0, 0.0, 0.0),
    };
    let run = Run {
        time_step: 1.0,
        steps: 1,
        spin_up_steps: 0,
        output_steps: 100,
        replicates: 8,
        seed: 1,
        scheme,
        gravity: g,
        damping: 0.1 * (g / height).sqrt(),
        shapes: None,
    };
    let belt = num(6, 0.0) * v;
    let mut case = Case {
        fibre,
        air,
        drag: Drag { along: FrictionLaw::ALL[0], across: NormalLaw::MarheinekeWegener },
        line: Some(Line {
            feed_speed: v,
            distance: height,
            belt_speed: belt,
            contact: Contact::Stick,
            kept_length: num(7, 5.0) * l,
            steps_per_element: 1,
        }),
        run,
    };
    let limit = case.stable_step_limits().into_iter().map(|l| l.limit).fold(f64::INFINITY, f64::min);
    let n = (l / v / (0.5 * limit)).ceil().max(2.0) as u64;
    let duration = turns * std::f64::consts::TAU * 0.4 * height / v;
    let h = l / v / n as f64;
    case.run.time_step = h;
    case.run.steps = (duration / h) as u64;
    case.line.as_mut().unwrap().steps_per_element = n;
    println!("h {h:e} limits {:?} n {n}", case.stable_step_limits());
    let jobs: Vec<Job> = (0..1).map(|replicate| Job { case: &case, replicate }).collect();
    let mut flight = Flight::new(&jobs, Isa::detect()).unwrap();
    let mut laid = Vec::new();
    let (mut sum, mut sq, mut k) = (0.0, 0.0, 0.0);
    while flight.time() < duration {
        flight.advance(20);
        laid.extend(flight.take_laid(0));
        if flight.time() > 0.4 * duration {
            let t = flight.chain().tension()[0].0[0];
            (sum, sq, k) = (sum + t, sq + t * t, k + 1.0);
        }
    }
    let s = flight.snapshot();
    let w = rho * 3.14159265 / 4.0 * d * d * g * height;
    println!(
        "{} laid, elements {}, drag-free imbalance {:.2e} of {:.2e}; root tension/(wH) {:.4} rms/mean {:.3}",
        laid.len(),
        flight.chain().elements(),
        s.energy.imbalance().0[0],
        s.energy.gravity_work.0[0],
        sum / k / w,
        (sq / k - (sum / k).powi(2)).sqrt() / (sum / k)
    );
    // circle through the last turn
    let last: Vec<_> = laid.iter().rev().take((6.28 * 0.4 * height / l) as usize * 2).collect();
    // least squares circle
    let (mut a, mut b) = ([[0.0; 3]; 3], [0.0; 3]);
    for p in &last {
        let row = [p.md, p.cd, 1.0];
        let z = p.md * p.md + p.cd * p.cd;
        for i in 0..3 {
            for j in 0..3 {
                a[i][j] += row[i] * row[j];
            }
            b[i] += row[i] * z;
        }
    }
    for i in 0..3 {
        let p = a[i][i];
        for j in i + 1..3 {
            let f = a[j][i] / p;
            for c in 0..3 {
                a[j][c] -= f * a[i][c];
            }
            b[j] -= f * b[i];
        }
    }
    let mut x = [0.0; 3];
    for i in (0..3).rev() {
        x[i] = (b[i] - (i + 1..3).map(|j| a[i][j] * x[j]).sum::<f64>()) / a[i][i];
    }
    let r = (x[2] + x[0] * x[0] / 4.0 + x[1] * x[1] / 4.0f64).sqrt();
    let spread =
        (last.iter().map(|p| (((p.md - x[0] / 2.0).hypot(p.cd - x[1] / 2.0)) - r).powi(2)).sum::<f64>()
            / last.len() as f64)
            .sqrt();
    println!(
        "R/H {:.4} centre {:.4} {:.4} spread {:.4}",
        r / height,
        x[0] / 2.0 / height,
        x[1] / 2.0 / height,
        spread / height
    );
    // radius by curvature: turning of chords
    let mut turn = 0.0;
    let mut len = 0.0;
    for w in last.windows(3) {
        let (a, b) = ((w[1].md - w[0].md, w[1].cd - w[0].cd), (w[2].md - w[1].md, w[2].cd - w[1].cd));
        turn += (a.0 * b.1 - a.1 * b.0).atan2(a.0 * b.0 + a.1 * b.1);
        len += l;
    }
    println!("R by turning {:.4}", (len / turn).abs() / height);
    if arg.len() > 8 {
        for p in laid.iter().rev().take(60) {
            println!("{:.4} {:.4} {:.4}", p.fed / height, p.md / height, p.cd / height);
        }
    }
}
