//! Changes in flight.

use super::{Flight, surrounded};
use crate::case::Case;
use crate::chain::Strand;
use crate::energy::Energy;
use crate::error::{Error, FlightFault};

impl Flight {
    /// Changes the cases of all fibres while they fly. Whatever it was that the fibres had in common they must still
    /// have; the energy that the change gives to the fibres or takes from them is not counted as an error of the
    /// balance.
    pub(super) fn change(
        &mut self,
        key: &'static str,
        change: impl Fn(&mut Case) -> Result<(), Error>,
    ) -> Result<(), Error> {
        let mut cases = self.cases.clone();
        if cases.is_empty() {
            return Err(FlightFault::NoCase.into());
        }
        for (case, _) in &mut cases {
            let (before, step) = (case.air.clone(), case.run.time_step);
            change(case)?;
            case.check().map_err(Error::Rejected)?;
            if case.run.time_step != step || case.air.files() != before.files() {
                return Err(FlightFault::NotInFlight {
                    key,
                    reason: "a flight keeps its mesh, its step and its files",
                }
                .into());
            }
        }
        let air = surrounded(&cases, self.isa)?;
        let strands: Vec<Strand> = cases.iter().map(|(case, _)| case.strand()).collect();
        super::check_strands(&strands)?;
        if air.eddies != self.eddies || strands[0].fibre.elements != self.chain.elements() {
            let reason = "other elements would lie in other eddies";
            return Err(FlightFault::NotInFlight { key, reason }.into());
        }

        let before = self.held();
        self.chain.become_of(&strands);
        let after = self.held();
        let start = &mut self.start.energy;
        start.axial = start.axial + (after.axial - before.axial);
        start.bending = start.bending + (after.bending - before.bending);
        let (fallen, falling) = (before.gravity_work, after.gravity_work);
        start.kinetic = start.kinetic + (after.kinetic - before.kinetic) - (falling - fallen);

        self.damped = strands.iter().any(|strand| strand.damping != 0.0);
        self.wind = air.wind;
        if let (Some(around), Some(new)) = (&mut self.surroundings, air.surroundings) {
            around.change(new);
        }
        self.cases = cases;
        Ok(())
    }

    /// What the chains hold by the velocities as the scheme keeps them.
    fn held(&self) -> Energy {
        let Self { isa, chain, start, .. } = self;
        Energy::held(*isa, chain, &chain.position, &chain.velocity, &start.position)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Flight, Job};
    use crate::chain::schemes::Scheme;
    use crate::lanes::Isa;
    use crate::study::tests::table1;

    #[test]
    fn energy_balance_closes_across_changes() {
        for scheme in Scheme::ALL {
            let mut case = table1();
            case.run.scheme = scheme;
            case.run.time_step = 2e-6;
            let jobs = [0, 1].map(|replicate| Job { case: &case, replicate });
            let mut flight = Flight::new(&jobs, Isa::detect()).unwrap();
            flight.step_to(0.02).unwrap();
            flight.change("run.gravity", |case| Ok(case.run.gravity = 5.0)).unwrap();
            flight.step_to(0.03).unwrap();
            flight.change("fibre.youngs_modulus", |case| Ok(case.fibre.youngs_modulus *= 0.5)).unwrap();
            flight.change("air.velocity", |case| Ok(case.air.velocity = 20.0)).unwrap();
            flight.step_to(0.04).unwrap();
            flight.change("fibre.diameter", |case| Ok(case.fibre.diameter *= 1.1)).unwrap();
            flight.step_to(0.06).unwrap();
            let energy = flight.snapshot().energy;
            for lane in 0..2 {
                let error = energy.imbalance().0[lane] / energy.drag_work.0[lane];
                assert!(error.abs() < 1e-3, "{}: {error:e}", scheme.name());
            }
        }
    }

    #[test]
    fn identical_to_a_flight_that_began_so_when_set_at_the_start() {
        let slow = table1();
        let mut fast = slow.clone();
        fast.air.velocity = 20.0;
        let at_end = |case, change: bool| {
            let mut flight = Flight::new(&[Job { case, replicate: 3 }], Isa::detect()).unwrap();
            if change {
                flight.change("air.velocity", |case| Ok(case.air.velocity = 20.0)).unwrap();
            }
            flight.step_to(0.01).unwrap();
            flight.snapshot().position
        };
        assert_eq!(at_end(&slow, true), at_end(&fast, false));
    }
}
