//! What the fibres of one flight have in common.

use super::Job;
use crate::air::{Eddies, Sampling, Way};
use crate::case::Case;
use crate::chain;
use crate::chain::schemes::Scheme;
use crate::company::{Bits, PerLane, shared};
use crate::error::Error;

shared! {
    /// The times of a flight, in steps.
    pub(crate) struct Clock {
        time_step: Bits = "run.time_step",
        steps: u64 = "run.duration",
        spin_up_steps: u64 = "run.spin_up",
        output_steps: u64 = "run.output_interval",
    }
}

impl Clock {
    /// A clock of steps of `h` [s] that may go on for any time.
    pub(crate) fn from_step(h: f64) -> Self {
        Self { time_step: h.into(), steps: u64::MAX, spin_up_steps: 0, output_steps: 1 }
    }

    /// The time step [s].
    pub(crate) const fn time_step(&self) -> f64 {
        self.time_step.number()
    }
}

shared! {
    /// What the fibres of one flight have in common. All else may differ from lane to lane: a flight is made
    /// from this value and from entries of each lane, and nothing else.
    pub(crate) struct Common {
        chain: chain::Common,
        clock: Clock,
        scheme: Scheme = "run.scheme",
        way: Option<Way>,
        eddies: Eddies = "which element lies in which eddy (air.length_scale, air.eddies)",
        wind: Sampling,
        /// Of turbulence that differs across the flow, `k_max L_T`.
        lateral_cutoff: Option<Bits> = "how the turbulence differs across the flow (air.lateral, air.lateral_cutoff)",
        /// Steps from one look at the flow around a fibre of fixed length to the next; none if the air is the
        /// same everywhere.
        every: Option<u64> = "how often the flow around the fibre is looked up (air.length_scale, \
            air.velocity, or a flow that is not uniform)",
    }
}

impl Common {
    pub(crate) fn from_case(case: &Case) -> Self {
        let Case { air, run, line, .. } = case;
        let looks = || case.steps_between_looks();
        let stations = case.stations();
        let eddies = stations.as_ref().map_or_else(|| case.eddies(), |stations| stations.eddies());
        Self {
            chain: chain::Common::new(&case.strand(), line.as_ref()),
            clock: Clock {
                time_step: run.time_step.into(),
                steps: run.steps,
                spin_up_steps: run.spin_up_steps,
                output_steps: run.output_steps,
            },
            scheme: run.scheme,
            way: stations.map(|stations| Way::from_air(air, &stations, looks())),
            wind: Sampling::new(air, eddies.count()),
            eddies,
            lateral_cutoff: air.field_cutoff().map(Bits::from),
            every: (line.is_none() && !air.is_uniform()).then(looks),
        }
    }

    /// What several fibres have in common.
    ///
    /// # Errors
    /// If one differs from the first.
    pub(crate) fn from_jobs(jobs: &PerLane<Job<'_>>) -> Result<Self, Error> {
        // Replicates of one case usually share one reference.
        let mut last: Option<(*const Case, Self)> = None;
        jobs.shared(|job| match &last {
            Some((case, common)) if std::ptr::eq(*case, job.case) => common.clone(),
            _ => {
                let common = Self::from_case(job.case);
                last = Some((job.case, common.clone()));
                common
            }
        })
    }
}
