//! Scratch: tries a fed fibre.
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
    let l = num(1, 4e-3);
    let div = num(2, 8.0);
    let duration = num(3, 0.2);
    let tu = num(4, 0.1);
    let scheme = match num(5, 0.0) as u32 {
        0 => Scheme::ImplicitTension,
        1 => Scheme::Leapfrog,
        _ => Scheme::SemiImplicitEuler,
    };
    let (vf, distance) = (50.0, 0.5);
    let n = div as u64;
    let h = l / vf / n as f64;
    let mut air = Air::uniform(35.0, tu, 16e-3, 940.0);
    air.eddies = EddyModel::Convected { decay_time: 5e-3 };
    air.harmonics = 256;
    let fibre = Fibre {
        length: distance,
        diameter: 18e-6,
        density: 910.0,
        youngs_modulus: 2e9,
        bending_viscosity_time: 0.0,
        elements: (distance / l).round() as usize,
        root: Root::Clamped,
        direction: Vec3::new(1.0, 0.0, 0.0),
    };
    let case = Case {
        fibre,
        air,
        drag: Drag { along: FrictionLaw::ALL[0], across: NormalLaw::MarheinekeWegener },
        line: Some(Line {
            feed_speed: vf,
            distance,
            belt_speed: 3.0,
            contact: Contact::Stick,
            kept_length: 0.02f64.max(5.0 * l),
            steps_per_element: n,
        }),
        run: Run {
            time_step: h,
            steps: (duration / h) as u64,
            spin_up_steps: 0,
            output_steps: 100,
            replicates: 8,
            seed: num(6, 1.0) as u64,
            scheme,
            gravity: 9.81,
            damping: 0.0,
            shapes: None,
        },
    };
    println!(
        "h {h:e}, bending limit {:e}, axial {:e}, stations {:?}, looks {}",
        case.fibre.bending_step_limit(),
        case.fibre.axial_step_limit(),
        case.stations(),
        case.steps_between_looks()
    );
    let jobs: Vec<Job> = (0..8).map(|replicate| Job { case: &case, replicate }).collect();
    let mut flight = Flight::new(&jobs, Isa::detect()).unwrap();
    let start = std::time::Instant::now();
    let mut laid: Vec<Vec<LaidPoint>> = vec![Vec::new(); 8];
    let mut element_steps = 0.0;
    let quiet = arg.len() > 7;
    let mut tension = (0.0, 0.0, 0.0);
    for k in 0..(duration / 1e-3) as u64 {
        let steps = (1e-3 / h).round() as u64;
        flight.advance(steps);
        element_steps += (steps * flight.chain().elements() as u64) as f64;
        for (lane, laid) in laid.iter_mut().enumerate() {
            laid.extend(flight.take_laid(lane));
        }
        if quiet {
            continue;
        }
        let s = flight.snapshot();
        let t = s.tension[0].0[0];
        if k > 50 {
            tension = (tension.0 + 1.0, tension.1 + t, tension.2 + t * t);
        }
        if k % 20 == 19 {
            let e = &s.energy;
            let low = s.position.iter().map(|p| p.x.0[0]).fold(0.0, f64::max);
            println!(
                "t {:.4} N {} nodes {:?} x {low:.4} T0 {:.3e} kin {:.3e} drag {:.3e} feed {:.3e} belt {:.3e} grav {:.2e} carried {:.2e} diss {:.2e} imbalance {:.2e} laid {} strain {:.4}",
                s.time,
                flight.chain().elements(),
                s.nodes,
                t,
                e.kinetic.0[0],
                e.drag_work.0[0],
                e.feed_work.0[0],
                e.belt_work.0[0],
                e.gravity_work.0[0],
                e.carried.0[0],
                e.tension_dissipation.0[0],
                e.imbalance().0[0],
                laid[0].len(),
                e.strain.0[0]
            );
        }
    }
    let wall = start.elapsed().as_secs_f64();
    println!(
        "tension mean {:.3e} rms/mean {:.3}",
        tension.1 / tension.0,
        ((tension.2 / tension.0 - (tension.1 / tension.0).powi(2)).sqrt()) / (tension.1 / tension.0)
    );
    println!(
        "wall {wall:.2} s; per fibre-second {:.3}; ns per element, step and fibre {:.1}; elements {:.0}",
        wall / duration / 8.0,
        wall * 1e9 / element_steps / 8.0,
        element_steps / (duration / h)
    );
    let (mut s1, mut s2, mut count, mut slope) = (0.0, 0.0, 0.0, 0.0);
    for laid in &laid {
        let used: Vec<_> = laid.iter().filter(|p| p.fed > 3.0).collect();
        if used.len() < 10 {
            continue;
        }
        let r = 3.0 / vf;
        let m = used.iter().fold((0.0, 0.0), |m, p| (m.0 + p.md + r * p.fed, m.1 + p.cd));
        let k = used.len() as f64;
        let (m1, m2) = (m.0 / k, m.1 / k);
        s1 += used.iter().map(|p| (p.md + r * p.fed - m1).powi(2)).sum::<f64>();
        s2 += used.iter().map(|p| (p.cd - m2).powi(2)).sum::<f64>();
        count += k;
        let (a, b) = (used[0], used[used.len() - 1]);
        slope += (a.md - b.md) / (b.fed - a.fed) / r / 8.0;
    }
    println!(
        "sigma md {:.2} mm cd {:.2} mm, slope {slope:.4} ({count} points)",
        1e3 * (s1 / count).sqrt(),
        1e3 * (s2 / count).sqrt()
    );
    let order = laid[0].windows(2).filter(|p| p[1].time < p[0].time).count() as f64 / laid[0].len() as f64;
    println!("out of order {order:.3}");
}
