//! Flights at their start: what may fly together, and how the fibres and the air around them begin.

use super::turbulence::Drawing;
use super::{EndNodeStatistics, Entry, Flight, Job, Start, SurroundingRun};
use crate::body::Fibre;
use crate::case::Case;
use crate::chain::work::WorkDone;
use crate::chain::{self, Chain, FibreParameters, Scheme};
use crate::energy::Energy;
use spunlaid_air::{
    AirInSpace, Atmosphere, EddyField, EddyWind, FibreAir, FibreInField, FibreOnWay, Stations, StreamKey,
    Surroundings, Way, Wind,
};
use spunlaid_ground::{Bits, Error, Fault, Isa, Lanes, PerLane, Vec3};
use std::sync::Arc;

impl Flight {
    /// Fibres at the start of their cases: straight and at rest, in moving air.
    ///
    /// # Errors
    /// There is no job or there are more than eight, a case cannot be run ([`Case::check`]), or the cases cannot
    /// fly together. Cases that fly together have the same number of elements, eddy of each element, times,
    /// scheme, kinds of drag laws, cut-off frequency, number of harmonics and records; and either all or none of
    /// them are damped.
    pub fn new(jobs: &[Job<'_>], isa: Isa) -> Result<Self, Error> {
        let first = jobs.first().ok_or_else(Error::no_fibre)?;
        Self::in_air(jobs, isa, SurroundingRun::run(first.case))
    }

    /// As [`Flight::new`], in the air of another run.
    pub fn in_air(jobs: &[Job<'_>], isa: Isa, air: SurroundingRun<'_>) -> Result<Self, Error> {
        let (jobs, common) = checked(jobs)?;
        let air = surrounded(&common, &jobs, isa, air)?;
        let strands = jobs.map(|job| job.case.strand());
        let mut chain = Chain::straight(&common.chain, &strands, common.scheme);
        let laid: Option<Vec<_>> = jobs.iter().map(Job::fed).collect();
        if let (Some(laid), Some(steps_per_element)) = (laid, common.chain.steps_per_element) {
            chain.feed(&laid, steps_per_element);
        }
        let damped = common.chain.damped;
        let mut flight = Self::with_chain(isa, chain, damped, air, common.scheme, common.clock)?;
        flight.entries = jobs.iter().map(Entry::from).collect();
        Ok(flight)
    }

    /// Straight fibres at rest in given air, which is made for their elements, to be advanced by steps of `h` [s].
    ///
    /// # Errors
    /// There is no strand or there are more than eight, the strands have different numbers of elements or
    /// different kinds of drag laws, or the step is not positive.
    pub fn assembled(
        isa: Isa,
        strands: &[FibreParameters],
        air: impl Into<Atmosphere>,
        scheme: Scheme,
        h: f64,
    ) -> Result<Self, Error> {
        let air = air.into();
        let strands = PerLane::new(strands.to_vec())?;
        let common = strands.shared(|strand| chain::ChainInvariants::new(strand, None))?;
        if common.elements == 0 {
            return Err(Error::Flight(Fault::plain("a fibre needs at least one element")));
        }
        Self::with_chain(
            isa,
            Chain::straight(&common, &strands, scheme),
            common.damped,
            air,
            scheme,
            Clock::from_step(h),
        )
    }

    fn with_chain(
        isa: Isa,
        chain: Chain,
        damped: bool,
        air: Atmosphere,
        scheme: Scheme,
        clock: Clock,
    ) -> Result<Self, Error> {
        let h = clock.time_step();
        if !(h > 0.0 && h.is_finite()) {
            return Err(Error::flight(
                format!("a time step of {h:e} s cannot be taken"),
                "it must be positive and finite",
            ));
        }
        let mut flight = Self {
            isa,
            entries: Vec::new(),
            scheme,
            damped,
            h,
            start: Start::default(),
            chain,
            air,
            work: WorkDone::default(),
            steps_done: 0,
            clock,
            end_node: EndNodeStatistics::default(),
            root_strain: Lanes::ZERO,
        };
        // Clones made later share the first samples.
        flight.air.prepare();
        flight.begin();
        Ok(flight)
    }

    /// Sets positions and velocities of all nodes, and starts the clock and all statistics again.
    ///
    /// * `position`, `velocity` – of the `N+1` nodes [m, m/s]
    ///
    /// # Errors
    /// The number of positions or velocities is not the number of nodes, or the fibre is being fed.
    pub fn restart_from(
        &mut self,
        position: Vec<Vec3<Lanes>>,
        velocity: Vec<Vec3<Lanes>>,
    ) -> Result<(), Error> {
        if self.chain.laying.is_some() {
            return Err(Error::flight("a fed fibre starts at its inlet", "start a new flight of it"));
        }
        let wanted = self.chain.position.len();
        for found in [position.len(), velocity.len()] {
            if found != wanted {
                let message = format!("the start is for {found} nodes, the fibres have {wanted}");
                return Err(Error::Flight(Fault::plain(message)));
            }
        }
        (self.chain.position, self.chain.velocity) = (position.into(), velocity.into());
        self.steps_done = 0;
        self.work = WorkDone::default();
        self.end_node = EndNodeStatistics::default();
        self.root_strain = Lanes::ZERO;
        self.begin();
        Ok(())
    }

    /// Stores the start, and takes the first half kick of the staggered schemes.
    pub(super) fn begin(&mut self) {
        let position = self.chain.position.to_vec();
        let velocity = self.chain.velocity.to_vec();
        let energy = Energy::stored_energy(self.isa, &self.chain.constants, &position, &velocity, &position);
        self.start = Start { position, velocity, energy };
        self.start_staggered();
        self.air.forget();
    }

    /// Moves the velocities from time 0 to half a step before it, and chooses the earlier velocities so that the
    /// first extrapolation gives the velocities at time 0.
    fn start_staggered(&mut self) {
        if !self.scheme.is_staggered() {
            return;
        }
        let scheme = std::mem::replace(&mut self.scheme, Scheme::Leapfrog);
        self.chain.settle_tensions();
        let at_rest = self.chain.velocity.clone();
        self.chain.earlier.clone_from(&at_rest);
        self.run(1, -0.5 * self.h, 0.0, false);
        self.scheme = scheme;
        self.steps_done = 0;
        self.work = WorkDone::default();
        self.end_node = EndNodeStatistics::default();
        self.root_strain = Lanes::ZERO;
        for (i, &v0) in at_rest.iter().enumerate() {
            let v = self.chain.velocity[i];
            self.chain.earlier[i] = v + (v - v0) * Lanes::splat(2.0);
        }
    }
}

/// The jobs of a flight whose cases can be run, and what they have in common.
fn checked<'a>(jobs: &[Job<'a>]) -> Result<(PerLane<Job<'a>>, FlightInvariants), Error> {
    let jobs = PerLane::new(jobs.to_vec())?;
    let mut last: Option<*const Case> = None;
    for job in jobs.iter() {
        // Replicates of one case usually share one reference.
        if last.replace(job.case) != Some(std::ptr::from_ref(job.case)) {
            job.case.check().map_err(Error::Rejected)?;
        }
    }
    let common = FlightInvariants::from_jobs(&jobs)?;
    Ok((jobs, common))
}

/// The air of fibres that have this in common.
pub(super) fn surrounded(
    common: &FlightInvariants,
    jobs: &PerLane<Job<'_>>,
    isa: Isa,
    air: SurroundingRun<'_>,
) -> Result<Atmosphere, Error> {
    let FlightInvariants { way, every, chain, turbulence, .. } = common;
    let around = |job: &Job<'_>| FibreAir { air: job.case.air.clone(), inlet: job.place };
    if let Some(cutoff) = turbulence.lateral_cutoff {
        let every = every.unwrap_or_else(|| way.as_ref().map_or(1, |way| way.every));
        let mut last: Option<(&Job<'_>, Arc<EddyField>)> = None;
        let lanes = jobs.iter().map(|job| {
            let key = StreamKey { seed: job.case.run.seed, replicate: job.replicate };
            let distance = job.case.way_of_air();
            let field = match (air.field, &last) {
                (Some(field), _) => Arc::clone(field),
                // Fibres of one replicate are neighbours, and replicates of one case have one plan.
                (_, Some((other, field))) if std::ptr::eq(other.case, job.case) => {
                    match other.replicate == job.replicate {
                        true => Arc::clone(field),
                        false => Arc::new(field.with_key(key)),
                    }
                }
                _ => {
                    let (air, room) = (&job.case.air, job.case.room_of_air());
                    Arc::new(EddyField::in_room(air, &room, cutoff.number(), key))
                }
            };
            last = Some((job, Arc::clone(&field)));
            FibreInField { around: around(job), field, distance }
        });
        let lanes = PerLane::new(lanes.collect())?;
        return Ok(Atmosphere::Space(AirInSpace::new(&lanes, chain.elements, every)));
    }
    // Eddies of finer elements, if the air is that of finer elements.
    let eddies = if way.is_some() { turbulence.eddies.clone() } else { air.case.eddies() };
    let elements = air.case.fibre.elements;
    let streams = jobs.map(|job| {
        let case = Case { fibre: Fibre { elements, ..job.case.fibre }, ..job.case.clone() };
        Job { case: &case, ..*job }.stream(&eddies)
    });
    let wind = Wind::sampled(isa, turbulence.wind.clone().with_eddies(eddies.count()), streams, air.horizon);
    if let Some(way) = way {
        let on_way = |job: &Job<'_>| Some(FibreOnWay { around: around(job), grid: job.case.stations()? });
        let lanes = PerLane::new(jobs.iter().filter_map(on_way).collect())?;
        let stations = Stations::new(way.clone(), &lanes, chain.elements);
        return Ok(Atmosphere::Way(wind, stations));
    }
    let wind = wind.for_steps_of(common.clock.time_step());
    let air = EddyWind { eddies: eddies.coarsen(chain.elements), wind };
    Ok(match every {
        None => Atmosphere::Uniform(air),
        Some(every) => {
            Atmosphere::Flow(air, Surroundings::around_elements(jobs.map(around), chain.elements, *every))
        }
    })
}

shared! {
    /// The times of a flight, in steps.
    pub struct Clock {
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
    pub struct FlightInvariants {
        /// What their chains have in common.
        chain: chain::ChainInvariants,
        /// Its times.
        clock: Clock,
        scheme: Scheme = "run.scheme",
        /// The air along the way, of fed fibres.
        way: Option<Way>,
        /// How the turbulence is made.
        turbulence: Drawing,
        /// Steps from one look at the flow around a fibre of fixed length to the next; none if the air is the
        /// same everywhere.
        every: Option<u64> = "how often the flow around the fibre is looked up (air.length_scale, \
            air.velocity, or a flow that is not uniform)",
    }
}

impl FlightInvariants {
    /// Of the fibres of a case.
    pub fn from_case(case: &Case) -> Self {
        let Case { air, run, line, .. } = case;
        let looks = || case.steps_between_looks();
        let stations = case.stations();
        Self {
            chain: chain::ChainInvariants::new(&case.strand(), line.as_ref()),
            clock: Clock {
                time_step: run.time_step.into(),
                steps: run.steps,
                spin_up_steps: run.spin_up_steps,
                output_steps: run.output_steps,
            },
            scheme: run.scheme,
            way: stations.map(|stations| Way::from_air(air, &stations, looks())),
            turbulence: Drawing::from_case(case),
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
