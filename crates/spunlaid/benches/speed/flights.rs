//! Whole flights for the tables of speed and accuracy: Table 1 by any scheme and step, and how far its
//! paths are off.

use spunlaid_fibre::Case;
use spunlaid_ground::{Isa, RunContext, WIDTH};
use spunlaid_simulation::ensemble::{Sample, fly_together};
use spunlaid_simulation::{Job, Recorded, Trajectory};
use std::sync::atomic::{AtomicBool, AtomicU64};

/// The first eight flights of a case, on this thread.
pub fn trajectories_of(case: &Case) -> Vec<Trajectory> {
    let (stop, fibre_steps) = (AtomicBool::new(false), AtomicU64::new(0));
    let computing = RunContext { threads: 1, isa: Isa::detect(), stop: &stop, done: &fibre_steps };
    let jobs: Vec<Job<'_>> = (0..WIDTH as u64).map(|replicate| Job::new(case, replicate)).collect();
    fly_together(&jobs, Recorded::SAMPLES, computing).expect("the case flies")
}

/// How flights differ from others with the same phases.
pub struct Difference {
    /// Root mean square distance of the end nodes' paths across the air, over the spread of the others'.
    pub path: f64,
    /// Relative difference of the amplitudes.
    pub amplitude: f64,
}

/// Compares flights with converged ones, at the recorded instants that all steps share: every 4 ms.
pub fn compare(flights: &[Trajectory], exact: &[Trajectory]) -> Difference {
    let square = |y: f64, z: f64| y * y + z * z;
    let (mut off, mut spread) = (0.0, 0.0);
    let (mut found, mut wanted) = (0.0, 0.0);
    for (flight, exact) in flights.iter().zip(exact) {
        let n = shared(exact).count() as f64;
        let mean = shared(exact).fold((0.0, 0.0), |sum, s| (sum.0 + s.end.y / n, sum.1 + s.end.z / n));
        for (a, b) in shared(flight).zip(shared(exact)) {
            off += square(a.end.y - b.end.y, a.end.z - b.end.z);
            spread += square(b.end.y - mean.0, b.end.z - mean.1);
        }
        found += flight.number("amplitude_y") + flight.number("amplitude_z");
        wanted += exact.number("amplitude_y") + exact.number("amplitude_z");
    }
    Difference { path: (off / spread).sqrt(), amplitude: found / wanted - 1.0 }
}

fn shared(flight: &Trajectory) -> impl Iterator<Item = &Sample> {
    let whole = |time: f64| (time / 4e-3 - (time / 4e-3).round()).abs() < 1e-6;
    flight.samples.iter().filter(move |sample| whole(sample.time))
}
