//! Changes in flight.

use super::start::surrounded;
use super::{Entry, Flight, FlightInvariants, SurroundingRun};
use crate::case::keys::{self, Value};
use crate::energy::Energy;
use spunlaid_ground::{Error, PerLane};

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
        if !key.in_flight {
            return Err(fixed(key.name, "a flight keeps its mesh, its times, its eddies and its files"));
        }
        let mut entries = self.entries.clone();
        if entries.is_empty() {
            return Err(Error::flight(
                "this flight was put together without a case, so its keys cannot be set",
                "make it from cases",
            ));
        }
        let value = value.into();
        for Entry { case, .. } in &mut entries {
            if key.get(case).is_none() {
                return Err(fixed(key.name, "it has no meaning for the case of this flight"));
            }
            key.set(case, value.clone())?;
            case.check().map_err(Error::Rejected)?;
        }
        self.fly_on_as(entries, key.name)
    }

    fn fly_on_as(&mut self, entries: Vec<Entry>, key: &'static str) -> Result<(), Error> {
        let jobs = PerLane::new(entries.iter().map(Entry::job).collect())?;
        let common = FlightInvariants::from_jobs(&jobs)?;
        let air = surrounded(&common, &jobs, self.isa, SurroundingRun::run(&entries[0].case))?;
        let strands = jobs.map(|job| job.case.strand());
        let meshed_anew = self.chain.laying.is_none() && common.chain.elements != self.chain.elements();
        if !self.air.has_eddies_of(&air) || meshed_anew {
            let reason = "it would change which element lies in which eddy";
            return Err(fixed(key, reason));
        }

        let before = self.held();
        self.chain.become_of(&common.chain, &strands);
        let after = self.held();
        let start = &mut self.start.energy;
        start.axial = start.axial + (after.axial - before.axial);
        start.bending = start.bending + (after.bending - before.bending);
        let (fallen, falling) = (before.gravity_work, after.gravity_work);
        start.kinetic = start.kinetic + (after.kinetic - before.kinetic) - (falling - fallen);

        self.damped = common.chain.damped;
        self.air.change(air);
        self.entries = entries;
        Ok(())
    }

    /// Energies of the chains from the velocities as the scheme stores them.
    fn held(&self) -> Energy {
        let Self { isa, chain, start, .. } = self;
        Energy::stored_energy(
            *isa,
            &chain.constants,
            &chain.position,
            &chain.velocity,
            chain.origin(&start.position),
        )
    }
}

/// The error of a key that cannot change during a flight.
fn fixed(key: &str, reason: &str) -> Error {
    Error::flight(format!("{key} cannot change in flight: {reason}"), "start another flight with it")
}
