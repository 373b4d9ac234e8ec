//! Flights at their start: what may fly together, and how the fibres and the air around them begin.

use super::{AirOf, Common, EndNodeStatistics, Flight, Job, Start, Surrounded};
use crate::air::{Stations, Surroundings, Wind};
use crate::case::Case;
use crate::chain::laying::Fed;
use crate::chain::schemes::Scheme;
use crate::chain::work::WorkDone;
use crate::chain::{Chain, Strand};
use crate::energy::Energy;
use crate::error::{Error, FlightFault};
use crate::fibre::Fibre;
use crate::lanes::{Isa, Lanes, WIDTH};
use crate::vec3::Vec3;

impl Flight {
    /// Fibres at the start of their cases: straight and at rest, in moving air.
    ///
    /// # Errors
    /// There is no job or there are more than eight, a case cannot be run ([`Case::check`]), or the cases cannot
    /// fly together. Cases that fly together have the same number of elements, eddy of each element, times,
    /// scheme, kinds of drag laws, cut-off frequency, number of harmonics and records; and either all or none of
    /// them are damped.
    pub fn new(jobs: &[Job<'_>], isa: Isa) -> Result<Self, Error> {
        let first = jobs.first().ok_or(FlightFault::Empty)?;
        Self::in_air(jobs, isa, AirOf::run(first.case))
    }

    /// As [`Flight::new`], in the air of another run.
    pub(crate) fn in_air(jobs: &[Job<'_>], isa: Isa, air: AirOf<'_>) -> Result<Self, Error> {
        let first = jobs.first().ok_or(FlightFault::Empty)?;
        for (lane, job) in jobs.iter().enumerate() {
            // Replicates of one case usually share one reference.
            if lane > 0 && std::ptr::eq(job.case, jobs[lane - 1].case) {
                continue;
            }
            job.case.check().map_err(Error::Rejected)?;
            if lane > 0 {
                Common::of(first.case).check(&Common::of(job.case), lane)?;
            }
        }
        let run = &first.case.run;
        let strands: Vec<Strand> = jobs.iter().map(|job| job.case.strand()).collect();
        let cases = jobs.iter().map(|job| (job.case.clone(), job.replicate)).collect::<Vec<_>>();
        let air = surrounded(&cases, isa, air)?;
        let laid: Option<Vec<_>> = jobs.iter().map(Job::fed).collect();
        let mut flight = match laid {
            Some(laid) => Self::fed(isa, &strands, &laid, air, run.scheme, run.time_step)?,
            None => Self::assembled(isa, &strands, air, run.scheme, run.time_step)?,
        };
        (flight.cases, flight.spin_up) = (cases, run.spin_up_steps);
        Ok(flight)
    }

    /// Straight fibres at rest in given air, to be advanced by steps of `h` [s].
    ///
    /// # Errors
    /// There is no strand or there are more than eight, the strands have different numbers of elements or
    /// different kinds of drag laws, the eddies or surroundings have another number of elements, the wind has
    /// another number of eddies, or the step is not positive.
    pub fn assembled(
        isa: Isa,
        strands: &[Strand],
        air: impl Into<Surrounded>,
        scheme: Scheme,
        h: f64,
    ) -> Result<Self, FlightFault> {
        let air = air.into();
        check_strands(strands)?;
        let elements = strands[0].fibre.elements;
        let around = air.surroundings.as_ref().map_or(elements, Surroundings::elements);
        for (what, of, found, wanted) in [
            ("air", "elements", air.eddies.of_element().len(), elements),
            ("surrounding flow", "elements", around, elements),
        ] {
            if found != wanted {
                return Err(FlightFault::Size { what, of, found, wanted });
            }
        }
        Self::with_chain(isa, Chain::straight(strands, scheme), strands, air, scheme, h)
    }

    /// Fibres that begin to be fed, in given air.
    fn fed(
        isa: Isa,
        strands: &[Strand],
        laid: &[Fed],
        air: Surrounded,
        scheme: Scheme,
        h: f64,
    ) -> Result<Self, FlightFault> {
        check_strands(strands)?;
        let mut chain = Chain::straight(strands, scheme);
        chain.feed(laid);
        Self::with_chain(isa, chain, strands, air, scheme, h)
    }

    fn with_chain(
        isa: Isa,
        chain: Chain,
        strands: &[Strand],
        Surrounded { eddies, wind, surroundings, stations }: Surrounded,
        scheme: Scheme,
        h: f64,
    ) -> Result<Self, FlightFault> {
        if !(h > 0.0 && h.is_finite()) {
            return Err(FlightFault::Step { step: h });
        }
        if wind.eddies() != eddies.count() {
            let (what, of, found, wanted) = ("wind", "eddies", wind.eddies(), eddies.count());
            return Err(FlightFault::Size { what, of, found, wanted });
        }
        let mut flight = Self {
            isa,
            cases: Vec::new(),
            scheme,
            damped: strands.iter().any(|s| s.damping != 0.0),
            h,
            start: Start::default(),
            chain,
            eddies,
            wind,
            surroundings,
            stations,
            work: WorkDone::default(),
            steps_done: 0,
            spin_up: 0,
            end_node: EndNodeStatistics::default(),
            root_strain: Lanes::ZERO,
        };
        // Clones made later share the first samples.
        flight.wind.prepare();
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
    ) -> Result<(), FlightFault> {
        if self.stations.is_some() {
            return Err(FlightFault::Fed);
        }
        let wanted = self.chain.position.len();
        for found in [position.len(), velocity.len()] {
            if found != wanted {
                return Err(FlightFault::Size { what: "start", of: "nodes", found, wanted });
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
    fn begin(&mut self) {
        let (position, velocity) = (self.chain.position.to_vec(), self.chain.velocity.to_vec());
        let energy = Energy::held(self.isa, &self.chain.constants, &position, &velocity, &position);
        self.start = Start { position, velocity, energy };
        self.start_staggered();
        if let Some(surroundings) = &mut self.surroundings {
            surroundings.forget();
        }
        if let Some(stations) = &mut self.stations {
            stations.forget();
        }
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
        self.run(1, (-0.5 * self.h, 0.0), false);
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

/// The air of cases that can fly together.
pub(super) fn surrounded(cases: &[(Case, u64)], isa: Isa, air: AirOf<'_>) -> Result<Surrounded, FlightFault> {
    let case = &cases[0].0;
    let airs = || cases.iter().map(|(case, _)| case.air.clone());
    let stations = match case.stations() {
        Some(grid) => {
            let every = case.steps_between_looks();
            Some((grid, Stations::new(airs().collect(), grid, case.strand().fibre.elements, every)?))
        }
        None => None,
    };
    let eddies = stations.as_ref().map_or_else(|| air.case.eddies(), |(grid, _)| grid.eddies());
    let elements = air.case.fibre.elements;
    let streams = cases
        .iter()
        .map(|(case, replicate)| {
            let fibre = Fibre { elements, ..case.fibre };
            let case = Case { fibre, ..case.clone() };
            Job { case: &case, replicate: *replicate }.stream(&eddies)
        })
        .collect();
    let wind = Wind::along(isa, streams, air.horizon)?;
    if let Some((_, stations)) = stations {
        return Ok(Surrounded { eddies, wind, surroundings: None, stations: Some(stations) });
    }
    let wind = wind.for_steps_of(case.run.time_step);
    let surroundings = case.surroundings(airs())?;
    let eddies = eddies.of_coarser(case.fibre.elements);
    Ok(Surrounded { eddies, wind, surroundings, stations: None })
}

/// Refuses strands that cannot fly together.
pub(super) fn check_strands(strands: &[Strand]) -> Result<(), FlightFault> {
    let Some(first) = strands.first() else {
        return Err(FlightFault::Empty);
    };
    if strands.len() > WIDTH {
        return Err(FlightFault::TooMany { fibres: strands.len(), most: WIDTH });
    }
    if first.fibre.elements == 0 {
        return Err(FlightFault::NoElements);
    }
    for (lane, strand) in strands.iter().enumerate() {
        let same = [
            ("the number of elements", strand.fibre.elements == first.fibre.elements),
            ("the kind of their drag laws", strand.drag.curves() == first.drag.curves()),
        ];
        FlightFault::unless_same(lane, &same)?;
    }
    Ok(())
}
