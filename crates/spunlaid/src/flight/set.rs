//! Changes in flight.

use super::{Flight, surrounded};
use crate::case::Case;
use crate::case::keys::{self, Value};
use crate::chain::Strand;
use crate::energy::Energy;
use crate::error::{Error, FlightFault};

impl Flight {
    /// Changes a key of the cases of all fibres while they fly: `flight.set("air.velocity", "20 m/s")`, or 20.0 as a
    /// number in SI units. [`Key::in_flight`](keys::Key) says which keys may change.
    ///
    /// Positions and velocities of the fibres stay as they are. The energy that the change adds or removes does not
    /// count as an error of the balance. The statistics continue; see [`Flight::forget_statistics`].
    ///
    /// # Errors
    /// The key does not exist or cannot change in flight, the key does not accept the value, or the case cannot be run
    /// with it. The flight then stays unchanged.
    pub fn set(&mut self, key: &str, value: impl Into<Value>) -> Result<(), Error> {
        let key = keys::named(key)?;
        let refused = |reason| Err(FlightFault::NotInFlight { key: key.name, reason }.into());
        if !key.in_flight {
            return refused("a flight keeps its mesh, its times, its eddies and its files");
        }
        let mut cases = self.cases.clone();
        if cases.is_empty() {
            return Err(FlightFault::NoCase.into());
        }
        let value = value.into();
        for (case, _) in &mut cases {
            if key.get(case).is_none() {
                return refused("it has no meaning for the case of this flight");
            }
            key.set(case, value.clone())?;
            case.check().map_err(Error::Rejected)?;
        }
        self.fly_on_as(cases, key.name)
    }

    fn fly_on_as(&mut self, cases: Vec<(Case, u64)>, key: &'static str) -> Result<(), Error> {
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

    /// Energies of the chains from the velocities as the scheme stores them.
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
            flight.set("run.gravity", "5 m/s²").unwrap();
            flight.step_to(0.03).unwrap();
            flight.set("fibre.youngs_modulus", 1e9).unwrap();
            flight.set("air.velocity", "20 m/s").unwrap();
            flight.step_to(0.04).unwrap();
            flight.set("fibre.diameter", "55 µm").unwrap();
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
                flight.set("air.velocity", "20 m/s").unwrap();
            }
            flight.step_to(0.01).unwrap();
            flight.snapshot().position
        };
        assert_eq!(at_end(&slow, true), at_end(&fast, false));
    }

    #[test]
    fn rejects_what_cannot_change_and_flies_on() {
        let case = table1();
        let mut flight = Flight::new(&[Job { case: &case, replicate: 0 }], Isa::detect()).unwrap();
        flight.step_to(0.01).unwrap();
        let before = flight.snapshot().position;
        for (key, value, told) in [
            ("air.velocty", "20 m/s", "air.velocity"),
            ("air.velocity", "20 mm", "velocity"),
            ("air.velocity", "fast", "velocity"),
            ("fibre.diameter", "-1 µm", "positive"),
            ("fibre.length", "2 m", "cannot change in flight"),
            ("run.time_step", "1 µs", "cannot change in flight"),
            ("air.speed_factor", "2", "no meaning"),
            // Stiffer than the step can bear.
            ("fibre.youngs_modulus", "200 GPa", "stability limit"),
        ] {
            let message = flight.set(key, value).unwrap_err().to_string();
            assert!(message.contains(told), "{key} = {value}: {message}");
            assert_eq!(flight.snapshot().position, before, "{key}");
        }
        flight.set("air.velocity", f64::NAN).unwrap_err();
        flight.step_to(0.005).unwrap_err();
        flight.step_to(f64::NAN).unwrap_err();
        flight.step_to(0.02).unwrap();
    }

    #[test]
    fn a_flight_belongs_to_its_owner_and_may_go_to_another_thread() {
        fn is_free<T: Send + 'static>(_: &T) {}
        let flight = Flight::new(&[Job { case: &table1(), replicate: 0 }], Isa::detect()).unwrap();
        is_free(&flight);
    }
}
