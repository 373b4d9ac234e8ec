//! What a computation took.

use serde::Serialize;
use spunlaid::ground::Isa;
use spunlaid::web::TimeSpent;
use spunlaid::web::map::Findings;
use std::time::{Duration, Instant};

/// The speed of the work. This is the only part that differs when it is repeated.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Performance {
    /// Wall-clock time [s]; of a run that of the flights.
    pub wall_s: f64,
    /// Number of threads.
    pub threads: usize,
    /// Of a run: number of steps of single elements.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub element_steps: Option<u64>,
    /// Of a run: time that one thread needs for one element and one step of one fibre.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ns_per_element_step: Option<f64>,
    /// Name of the instruction set.
    pub instruction_set: &'static str,
    /// Time that the flights of filaments in one air took [s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flights_s: Option<f64>,
    /// The part of it that is shared among the threads [s].
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flights_in_parallel_s: Option<f64>,
}

impl Performance {
    /// The time since an instant, on so many threads.
    pub fn measure(started: Instant, threads: usize, isa: Isa) -> Self {
        let wall_s = started.elapsed().as_secs_f64();
        Self { wall_s, threads, instruction_set: isa.name(), ..Self::default() }
    }

    /// With the times of flights in one air, if there were some.
    #[must_use]
    pub fn with_flights(self, findings: &Findings) -> Self {
        let flown = Some(&findings.laid.flown).filter(|flown| !flown.is_empty());
        let sum = |of: fn(&TimeSpent) -> Duration| {
            flown.map(|flown| flown.iter().map(|layer| of(&layer.spent)).sum::<Duration>().as_secs_f64())
        };
        Self {
            flights_s: sum(|spent| spent.whole),
            flights_in_parallel_s: sum(|spent| spent.in_parallel),
            ..self
        }
    }
}
