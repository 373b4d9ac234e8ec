//! Exact solutions of threads, and spinlines of four kinds that were solved by another program.

use super::thread::Thread;
use super::*;

fn pp() -> Spinline {
    let table = AirTable {
        distance: vec![0.0, 0.8, 0.85, 1.0],
        velocity: vec![2.0, 2.0, 2.0, 70.0],
        cross_velocity: vec![1.0, 1.0, 0.0, 0.0],
        temperature: vec![293.15; 4],
    };
    Spinline {
        polymer: PolymerSource::Known(Polymer::Pp),
        material: Polymer::Pp.material(false),
        melt: Melt::FlowRate(35.0),
        die_temperature: 503.15,
        hole_diameter: 0.6e-3,
        throughput: 0.5e-3 / 60.0,
        length: 1.6,
        air: Surroundings::Behind(table),
        ..Spinline::UNKNOWN
    }
}

#[test]
fn scratch() {
    let matsui = FrictionLaw::Matsui { factor: 0.37 };
    let a = pp();
    let s = a.solve(matsui).unwrap();
    println!(
        "{} {} {} {:?} {} {}",
        s.final_speed,
        s.final_diameter,
        s.force_at_die,
        s.freezing,
        s.largest_strain_rate,
        s.largest_strain_rate_at
    );
    println!("residuals {} {} ", s.momentum_residual, s.energy_residual);
    let start = std::time::Instant::now();
    for _ in 0..20 {
        a.solve(matsui).unwrap();
    }
    println!("{:?}", start.elapsed() / 20);
    let hit = super::shooting::find(&Thread::new(&a, matsui, &a.air), false).ok().unwrap();
    println!("steps {}", hit.shot.steps.len());
    let mut d = pp();
    d.crystallisation = true;
    d.material = Polymer::Pp.material(true);
    if let Surroundings::Behind(t) = &mut d.air {
        t.velocity[3] = 100.0;
    }
    let s = d.solve(FrictionLaw::Matsui { factor: 0.9 }).unwrap();
    println!(
        "D {} {} {} {:?} {} {} {}",
        s.final_speed,
        s.final_diameter,
        s.force_at_die,
        s.freezing,
        s.largest_strain_rate,
        s.largest_strain_rate_at,
        s.has_second
    );
    println!("residuals {} {} ", s.momentum_residual, s.energy_residual);
    let mut b = pp();
    b.material = Polymer::Pet.material(false);
    b.melt = Melt::Viscosity;
    b.die_temperature = 563.15;
    b.hole_diameter = 0.3e-3;
    b.throughput = 1.5e-3 / 60.0;
    b.length = 2.0;
    b.air = Surroundings::Uniform(AirState { velocity: 0.0, cross_velocity: 0.3, temperature: 293.15 });
    b.end = End::TakeUp(50.0);
    let s = b.solve(matsui).unwrap();
    println!(
        "B {} {} {} {:?} {} {} {}",
        s.final_speed,
        s.final_diameter,
        s.force_at_die,
        s.freezing,
        s.largest_strain_rate,
        s.largest_strain_rate_at,
        s.has_second
    );
    println!("residuals {} {} ", s.momentum_residual, s.energy_residual);
    let mut c = pp();
    c.law = Law::Giesekus;
    c.throughput = 1e-3 / 60.0;
    c.length = 2.0;
    c.air = b.air.clone();
    c.end = End::TakeUp(25.0);
    let s = c.solve(matsui).unwrap();
    println!(
        "C {} {} {} {:?} {} {} {}",
        s.final_speed,
        s.final_diameter,
        s.force_at_die,
        s.freezing,
        s.largest_strain_rate,
        s.largest_strain_rate_at,
        s.has_second
    );
    println!("residuals {} {} ", s.momentum_residual, s.energy_residual);
    let start = std::time::Instant::now();
    for _ in 0..20 {
        c.solve(matsui).unwrap();
    }
    println!("{:?}", start.elapsed() / 20);
    for m in [250.0, 500.0] {
        let mut k = pp();
        k.curtain = Some(Curtain { rows: 10, filaments_per_metre: m });
        let start = std::time::Instant::now();
        let rows = k.solve_rows(FrictionLaw::Matsui { factor: 0.9 }).unwrap();
        println!(
            "{:?} {:?}",
            rows.iter().map(|r| r.final_diameter * 1e6).collect::<Vec<_>>(),
            start.elapsed()
        );
    }
}
