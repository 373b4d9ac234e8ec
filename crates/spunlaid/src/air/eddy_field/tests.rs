use super::{EddyField, Extent};
use crate::air::{Air, EddyModel, SpectrumShape, StreamKey};

const SPEED: f64 = 25.0;
const LENGTH_SCALE: f64 = 16e-3;
const KEY: StreamKey = StreamKey { seed: 1, replicate: 0 };

fn air(eddies: EddyModel, spectrum: SpectrumShape, cutoff_frequency: f64) -> Air {
    Air { eddies, spectrum, ..Air::uniform(SPEED, 0.1, LENGTH_SCALE, cutoff_frequency) }
}

#[test]
fn trial() {
    let flat =
        air(EddyModel::Convected { decay_time: 5e-3 }, SpectrumShape::Flat, SPEED / 4.0 / LENGTH_SCALE);
    let extent = Extent { y: 0.16, z: 0.2 };
    let start = std::time::Instant::now();
    let mut field = EddyField::new(&flat, 0.5, extent, 15.0, KEY);
    println!(
        "plan {:?} {} generations, {:?} points",
        start.elapsed(),
        field.tapes.len(),
        field.plan.lattice.points
    );
    let start = std::time::Instant::now();
    let until = 4.0 * field.plan.repeat_time;
    field.make(0.0..until, 1);
    println!("made {:?} {until}", start.elapsed());
    let mut squares = [0.0; 3];
    let mut number = 0.0;
    for i in 0..100_000 {
        let u = |a: f64| (i as f64 * a).fract();
        let v =
            field.fluctuation(u(0.618034) * until, [0.5 * u(0.7548776), 0.16 * u(0.56984), 0.2 * u(0.4142)]);
        (0..3).for_each(|k| squares[k] += v[k] * v[k]);
        number += 1.0;
    }
    println!("variance {:?}", squares.map(|s| s / number));
    for steps in [1.0, 2.0, 4.0, 8.0, 16.0, 32.0] {
        let r = LENGTH_SCALE / 16.0 * steps;
        let mut sums = [[0.0; 3]; 3];
        for i in 0..100_000 {
            let u = |a: f64| (i as f64 * a).fract();
            let (t, p) = (u(0.618034) * until, [0.5 * u(0.7548776), 0.16 * u(0.56984), 0.2 * u(0.4142)]);
            let a = field.fluctuation(t, p);
            let b = field.fluctuation(t, [p[0], p[1], p[2] + r]);
            (0..3).for_each(|k| sums[0][k] += a[k] * b[k]);
            (0..3).for_each(|k| sums[1][k] += 0.5 * (a[k] * a[k] + b[k] * b[k]));
        }
        println!("{} {:?}", steps / 16.0, [0, 1, 2].map(|k| sums[0][k] / sums[1][k]));
    }
    let start = std::time::Instant::now();
    let mut s = 0.0;
    for i in 0..1_000_000 {
        let j = i as f64;
        s += field.fluctuation(0.02 + j * 1e-9, [0.1 + 1e-7 * j, 0.01 * (j * 1e-4).sin(), 0.02])[0];
    }
    println!("look {:?} {s}", start.elapsed() / 1_000_000);
}
