//! Eight replicates of a case in flight, changed while they fly.

use spunlaid::fibre::case::keys;
use spunlaid::fibre::{Case, Flight, Job, LaidPoint, Snapshot};
use spunlaid::ground::{Error, Isa, Lanes, Vec3, WIDTH};
use std::array::from_fn;

/// Eight fibres in flight.
#[derive(Debug)]
pub(super) struct Fibres {
    flight: Flight,
    case: Case,
    /// Steps since the start of the flight.
    done: u64,
    /// The fibres at the end of the last stretch.
    snapshot: Snapshot,
}

/// What is there to see at a recorded instant.
pub(super) struct Instant<'a> {
    pub(super) snapshot: &'a Snapshot,
    /// What each fibre has laid since the last one.
    pub(super) laid: &'a [Vec<LaidPoint>; WIDTH],
    pub(super) flight: &'a mut Flight,
}

impl Fibres {
    /// Fibres at the start of a case.
    ///
    /// # Errors
    /// Those of [`Flight::new`].
    pub(super) fn new(case: Case) -> Result<Self, Error> {
        let jobs: Vec<Job<'_>> = (0..WIDTH as u64).map(|replicate| Job::new(&case, replicate)).collect();
        let flight = Flight::new(&jobs, Isa::detect())?;
        let snapshot = flight.snapshot();
        Ok(Self { flight, case, done: 0, snapshot })
    }

    pub(super) const fn case(&self) -> &Case {
        &self.case
    }

    pub(super) const fn snapshot(&self) -> &Snapshot {
        &self.snapshot
    }

    pub(super) const fn flight(&self) -> &Flight {
        &self.flight
    }

    /// Goes over to another case. The fibres fly on if only keys differ that may change in flight. Otherwise they start
    /// again, from their present shapes if both cases have a fibre of fixed length that is held in the same way.
    ///
    /// Returns whether they started again.
    ///
    /// # Errors
    /// The other case cannot be simulated. Nothing has changed then.
    pub(super) fn become_of(&mut self, case: Case) -> Result<bool, Error> {
        let changed = keys::all().iter().filter(|key| key.get(&self.case) != key.get(&case));
        let changed: Vec<_> = changed.collect();
        if changed.iter().all(|key| key.in_flight) {
            let mut flight = self.flight.clone();
            let set = changed.iter().try_for_each(|key| match key.get(&case) {
                Some(value) => flight.set(key.name, value),
                None => Ok(()),
            });
            if set.is_ok() && flight.case(0) == Some(&case) {
                (self.flight, self.case) = (flight, case);
                return Ok(false);
            }
        }
        let mut other = Self::new(case)?;
        if let Some([position, velocity]) = transferred_state(&self.case, &self.snapshot, &other.case) {
            other.flight.restart_from(position, velocity)?;
            other.snapshot = other.flight.snapshot();
        }
        *self = other;
        Ok(true)
    }

    /// Starts the fibres again, straight and at rest.
    ///
    /// # Errors
    /// Those of [`Flight::new`].
    pub(super) fn reset(&mut self) -> Result<(), Error> {
        *self = Self::new(self.case.clone())?;
        Ok(())
    }

    /// Flies on by some steps, one at least.
    ///
    /// * `see` – is shown each recorded instant
    ///
    /// # Errors
    /// A position is no longer finite, or a fed fibre does not come down.
    pub(super) fn fly(&mut self, steps: u64, mut see: impl FnMut(Instant<'_>)) -> Result<(), Error> {
        let every = self.case.run.output_steps;
        let end = self.done + steps.max(1);
        while self.done < end {
            let to_instant = (every - self.done % every) % every;
            // The last step is looked at for the picture.
            let blind = to_instant.min(end - 1 - self.done);
            if blind > 0 {
                self.flight.step_to((self.done + blind) as f64 * self.flight.time_step())?;
                self.done += blind;
                continue;
            }
            let is_instant = self.done.is_multiple_of(every);
            self.snapshot = self.flight.observe();
            self.done += 1;
            if is_instant {
                let laid = from_fn(|lane| self.flight.take_laid(lane));
                see(Instant { snapshot: &self.snapshot, laid: &laid, flight: &mut self.flight });
            }
        }
        // Looking does not check the positions; flying on does, and says which fibre is lost.
        let is_finite = |p: &Vec3<Lanes>| (0..WIDTH).all(|lane| p.lane(lane).norm().is_finite());
        if !self.snapshot.position.iter().all(is_finite) {
            self.flight.step_to(self.flight.time() + self.flight.time_step())?;
        }
        Ok(())
    }
}

/// Positions and velocities of the nodes of another case at which fibres of fixed length go on. Their
/// directions stay, along the share of the length; strain stays as well.
fn transferred_state(old: &Case, snapshot: &Snapshot, new: &Case) -> Option<[Vec<Vec3<Lanes>>; 2]> {
    let same_hold = (old.fibre.root, old.fibre.direction) == (new.fibre.root, new.fibre.direction);
    if old.line.is_some() || new.line.is_some() || !same_hold {
        return None;
    }
    let (from, to) = (old.fibre.elements, new.fibre.elements);
    let longer = new.fibre.rest_length() / old.fibre.rest_length();
    let element = |i: usize| snapshot.position[i + 1] - snapshot.position[i];
    let mut at = *snapshot.position.first()?;
    let mut position = vec![at];
    for i in 0..to {
        // The old element at the middle of the new one.
        let place = (2 * i + 1) * from / (2 * to);
        at += element(place.min(from - 1)) * Lanes::splat(longer);
        position.push(at);
    }
    let velocity = (0..=to)
        .map(|i| {
            let (place, share) = (i * from / to, ((i * from) % to) as f64 / to as f64);
            let [a, b] = [place, (place + 1).min(from)].map(|place| snapshot.velocity[place]);
            a + (b - a) * Lanes::splat(share)
        })
        .collect();
    Some([position, velocity])
}

#[cfg(test)]
mod tests {
    use super::*;
    use spunlaid::input::{read_case, starter_case, starter_case_of_fed};

    fn case(changes: &[(&str, &str)]) -> Case {
        let usual = [
            ("fibre.element_length", "50 mm"),
            ("run.scheme", "implicit-tension"),
            ("run.time_step", "auto"),
            ("run.seed", "3"),
        ];
        let values: Vec<_> =
            usual.iter().chain(changes).map(|(k, v)| ((*k).to_owned(), (*v).to_owned())).collect();
        read_case((starter_case(), "starter.toml"), &values).unwrap().0
    }

    fn end(fibres: &Fibres) -> Vec3<Lanes> {
        *fibres.snapshot().position.last().unwrap()
    }

    #[test]
    fn identical_motion_as_the_flight_of_a_run_and_recorded_instants_as_asked() {
        let case = case(&[]);
        let (run, mut times) = (case.run, Vec::new());
        let mut fibres = Fibres::new(case.clone()).unwrap();
        for steps in [1, 7, 300, 2, 90] {
            fibres.fly(steps, |instant| times.push(instant.snapshot.time)).unwrap();
        }
        let expected: Vec<f64> = (0..times.len()).map(|i| i as f64 * run.output_interval()).collect();
        assert!(
            times.len() > 70 && times.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-12),
            "{times:?}"
        );
        let jobs: Vec<Job<'_>> = (0..8).map(|replicate| Job::new(&case, replicate)).collect();
        let mut other = Flight::new(&jobs, Isa::detect()).unwrap();
        other.step_to(fibres.flight().time()).unwrap();
        assert_eq!(other.chain().position.last(), fibres.flight().chain().position.last());
    }

    #[test]
    fn keys_of_the_flight_change_at_once_and_others_start_from_the_present_shape() {
        let mut fibres = Fibres::new(case(&[])).unwrap();
        fibres.fly(2000, |_| {}).unwrap();
        let before = end(&fibres);
        let step = fibres.case().run.time_step;
        let faster = case(&[("air.velocity", "11 m/s"), ("run.time_step", &format!("{step:e} s"))]);
        assert!(!fibres.become_of(faster.clone()).unwrap());
        assert_eq!((fibres.case(), end(&fibres)), (&faster, before));
        // Other eddies: the flight starts again, with the fibre where it was.
        let time = fibres.flight().time();
        assert!(
            time > 0.1
                && fibres
                    .become_of(case(&[("air.length_scale", "60 mm"), ("fibre.element_length", "50 mm")]))
                    .unwrap()
        );
        assert!(fibres.flight().time() < time);
        for lane in 0..WIDTH {
            assert!((end(&fibres).lane(lane) - before.lane(lane)).norm() < 1e-9);
        }
        fibres.fly(100, |_| {}).unwrap();
    }

    #[test]
    fn a_longer_fibre_on_another_mesh_keeps_its_directions() {
        let mut fibres = Fibres::new(case(&[])).unwrap();
        fibres.fly(2000, |_| {}).unwrap();
        let before = end(&fibres);
        fibres.become_of(case(&[("fibre.length", "1.2 m"), ("fibre.element_length", "25 mm")])).unwrap();
        assert_eq!(fibres.snapshot().position.len(), 49);
        for lane in 0..WIDTH {
            let [a, b] = [before, end(&fibres)].map(|end| end.lane(lane));
            // Each old element became two or three new ones; what is left is rounding of shares.
            assert!((b - a * 1.2).norm() < 0.02, "{a:?} {b:?}");
        }
        fibres.fly(200, |_| {}).unwrap();
        // A clamp that was not there before: straight and at rest.
        fibres.become_of(case(&[("fibre.root", "clamped")])).unwrap();
        assert_eq!(end(&fibres).y.0, [0.0; WIDTH]);
    }

    #[test]
    fn a_case_that_cannot_be_flown_changes_nothing() {
        let mut fibres = Fibres::new(case(&[])).unwrap();
        let mut bad = case(&[]);
        bad.fibre.diameter = -1.0;
        assert!(fibres.become_of(bad).is_err());
        assert_eq!(fibres.case(), &case(&[]));
        fibres.fly(10, |_| {}).unwrap();
    }

    #[test]
    fn a_fed_fibre_lays_points_and_starts_at_its_inlet() {
        let (case, _) = read_case((starter_case_of_fed(), "fed.toml"), &[]).unwrap();
        let mut fibres = Fibres::new(case.clone()).unwrap();
        let steps = (0.06 / case.run.time_step) as u64;
        let mut laid = [0; WIDTH];
        fibres
            .fly(steps, |instant| (0..WIDTH).for_each(|lane| laid[lane] += instant.laid[lane].len()))
            .unwrap();
        assert!(laid.iter().all(|points| *points > 100), "{laid:?}");
        let mut slower = case;
        slower.run.seed = 5;
        assert!(fibres.become_of(slower).unwrap());
        assert!(fibres.snapshot().position.len() < 10);
    }
}
