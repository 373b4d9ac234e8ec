//! Scratch: fed chain against the fixed chain.
use spunlaid::case::Case;
use spunlaid::flight::{Flight, Job};
use spunlaid::input::read_case;
use spunlaid::lanes::Isa;
use std::path::Path;

fn flight(case: &Case) -> Flight {
    let jobs: Vec<Job> = (0..8).map(|replicate| Job { case, replicate }).collect();
    Flight::new(&jobs, Isa::detect()).unwrap()
}

fn main() {
    let set = |pairs: &[(&str, &str)]| {
        pairs.iter().map(|(a, b)| (a.to_string(), b.to_string())).collect::<Vec<_>>()
    };
    let (fed, _) = read_case(
        Path::new("cases/spunbond.toml"),
        &set(&[("run.duration", "2 s"), ("air.harmonics", "256")]),
    )
    .unwrap();
    let (fixed, _) = read_case(
        Path::new("cases/diffuser.toml"),
        &set(&[
            ("run.duration", "2 s"),
            ("run.scheme", "implicit-tension"),
            ("run.time_step", "40 µs"),
            ("fibre.length", "0.76 m"),
            ("fibre.element_length", "4 mm"),
            ("air.harmonics", "256"),
            ("air.cutoff_frequency", "940 Hz"),
        ]),
    )
    .unwrap();
    let (mut a, mut b) = (flight(&fed), flight(&fixed));
    a.advance(2000);
    b.advance(2000);
    for _ in 0..6 {
        let mut ns = [0.0; 2];
        for (i, f) in [&mut a, &mut b].into_iter().enumerate() {
            let t = std::time::Instant::now();
            f.advance(1500);
            ns[i] = t.elapsed().as_secs_f64() / 1500.0 / 8.0 / f.chain().elements() as f64 * 1e9;
            for lane in 0..8 {
                f.take_laid(lane);
            }
        }
        println!(
            "fed {:.1} ns ({}), fixed {:.1} ns ({}), ratio {:.2}",
            ns[0],
            a.chain().elements(),
            ns[1],
            b.chain().elements(),
            ns[0] / ns[1]
        );
    }
}
