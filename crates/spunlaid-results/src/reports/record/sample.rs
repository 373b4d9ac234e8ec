//! A synthetic record for tests.

use spunlaid_air::record::analyse;
use spunlaid_air::{Analysis, Record, Samples, Settings};

/// 10 m/s along the flow, rms 1 m/s, ten samples to an integral time of 10 ms.
pub fn autoregression(components: usize, samples: usize) -> (Record, Analysis) {
    made(components, samples, |_, u| u)
}

/// The same, changed by sample number and velocity.
pub fn made(components: usize, samples: usize, change: impl Fn(usize, f64) -> f64) -> (Record, Analysis) {
    let mut state = 12_345u64;
    let mut uniform = move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64 - 0.5
    };
    let components = ["u", "v", "w"].iter().take(components).map(|name| {
        let mut u = 0.0;
        let mean = if *name == "u" { 10.0 } else { 0.0 };
        let mut next = |i| {
            u = 0.9 * u + 1.51 * uniform();
            change(i, mean + u)
        };
        Samples { name: (*name).to_owned(), values: (0..samples).map(&mut next).collect() }
    });
    let record = Record {
        file: "made.csv".to_owned(),
        interval: 1e-3,
        components: components.collect(),
        ..Record::default()
    };
    let analysis = analyse(&record, &Settings::default()).expect("a record that can be analysed");
    (record, analysis)
}
