//! The air around eight fibres in a flow that is not uniform.

use super::{Air, EddyVelocities};
use crate::error::FlightFault;
use crate::field::Hint;
use crate::lanes::{Lanes, Register, WIDTH, Wide};
use crate::vec3::Vec3;

/// The air velocity at one instant, element by element.
pub(crate) trait AirAtElements<S: Register>: Copy {
    /// The signal of an eddy, the same for all of its elements.
    fn signal(&self, eddy: u32) -> Vec3<Wide<S>>;

    /// Velocity of the air at element `j` [m/s]; `signal` is that of its eddy.
    fn at(&self, j: usize, signal: Vec3<Wide<S>>) -> Vec3<Wide<S>>;
}

impl<S: Register> AirAtElements<S> for EddyVelocities<'_, S> {
    #[inline(always)]
    fn signal(&self, eddy: u32) -> Vec3<Wide<S>> {
        self.velocity(eddy)
    }

    #[inline(always)]
    fn at(&self, _: usize, signal: Vec3<Wide<S>>) -> Vec3<Wide<S>> {
        signal
    }
}

/// Mean velocity and rms where an element is, of eight fibres.
///
/// Looked up every few steps and carried on along a straight line from the last two looks in between: the
/// error is of second order in the time between them.
#[derive(Clone, Copy, Debug, Default)]
struct Place {
    /// Velocity x, y, z and rms at the last look [m/s].
    value: [Lanes; 4],
    /// Their rise in a step [m/s].
    rise: [Lanes; 4],
}

/// The air around the elements of eight fibres.
#[derive(Clone, Debug)]
pub struct Surroundings {
    airs: Vec<Air>,
    places: Vec<Place>,
    /// Where each fibre's element was found last.
    hints: Vec<[Hint; WIDTH]>,
    /// Steps from one look to the next.
    every: u64,
    looked: bool,
    /// Of each fibre's looks, those at elements outside of what the flow knows, and all.
    outside: [u64; WIDTH],
    looks: u64,
}

impl Surroundings {
    /// * `airs` – of up to eight fibres; lanes left over repeat the first
    /// * `every` – steps from one look at the flow to the next
    ///
    /// # Errors
    /// No air or more than eight.
    pub fn new(airs: Vec<Air>, elements: usize, every: u64) -> Result<Self, FlightFault> {
        match airs.len() {
            0 => Err(FlightFault::Empty),
            1..=WIDTH => Ok(Self::around_elements(airs, elements, every.max(1))),
            fibres => Err(FlightFault::TooMany { fibres, most: WIDTH }),
        }
    }

    fn around_elements(airs: Vec<Air>, elements: usize, every: u64) -> Self {
        let places = vec![Place::default(); elements];
        let hints = vec![[Hint::default(); WIDTH]; elements];
        Self { airs, places, hints, every, looked: false, outside: [0; WIDTH], looks: 0 }
    }

    /// Number of elements.
    pub(crate) fn elements(&self) -> usize {
        self.places.len()
    }

    /// Share of the time that the elements of a lane's fibre have spent outside of what the flow knows.
    pub fn outside(&self, lane: usize) -> f64 {
        if self.looks == 0 { 0.0 } else { self.outside[lane] as f64 / self.looks as f64 }
    }

    /// Replaces the air by another one of the same flow. The values of the last look are kept until the next.
    pub(crate) fn change(&mut self, by: Self) {
        (self.airs, self.every) = (by.airs, by.every);
    }

    /// Forgets the looks so far.
    pub(crate) fn forget(&mut self) {
        *self = Self::around_elements(std::mem::take(&mut self.airs), self.places.len(), self.every);
    }

    /// The wind before a step: `now` where and as strong as the elements feel it.
    pub(crate) fn around<'s, S: Register>(
        &'s mut self,
        step: u64,
        position: &[Vec3<Lanes>],
        now: EddyVelocities<'s, S>,
    ) -> LocalVelocities<'s, S> {
        let since = step % self.every;
        if since == 0 {
            self.look(position);
        }
        LocalVelocities { now, places: &self.places, steps: Wide::splat(since as f64) }
    }

    #[inline(never)]
    fn look(&mut self, position: &[Vec3<Lanes>]) {
        let per_step = 1.0 / self.every as f64;
        let places = self.places.iter_mut().zip(&mut self.hints);
        for ((place, hints), ends) in places.zip(position.windows(2)) {
            let mut value = [Lanes::ZERO; 4];
            for (lane, hint) in hints.iter_mut().enumerate() {
                let Some(air) = self.airs.get(lane) else {
                    value.iter_mut().for_each(|of| of.0[lane] = of.0[0]);
                    continue;
                };
                let centre = (ends[0].lane(lane) + ends[1].lane(lane)) * 0.5;
                let (velocity, rms, inside) = air.felt(centre, hint);
                self.outside[lane] += u64::from(!inside);
                let found = [velocity.x, velocity.y, velocity.z, rms];
                value.iter_mut().zip(found).for_each(|(of, found)| of.0[lane] = found);
            }
            let rise = |i: usize| (value[i] - place.value[i]) * Lanes::splat(per_step);
            let rise = if self.looked { std::array::from_fn(rise) } else { [Lanes::ZERO; 4] };
            *place = Place { value, rise };
        }
        self.looks += self.places.len() as u64;
        self.looked = true;
    }
}

/// A [`EddyVelocities`] of rms one and mean zero in the flow around the elements.
#[derive(Clone, Copy)]
pub(crate) struct LocalVelocities<'a, S: Register> {
    now: EddyVelocities<'a, S>,
    places: &'a [Place],
    /// Steps since the last look.
    steps: Wide<S>,
}

impl<S: Register> AirAtElements<S> for LocalVelocities<'_, S> {
    #[inline(always)]
    fn signal(&self, eddy: u32) -> Vec3<Wide<S>> {
        self.now.velocity(eddy)
    }

    #[inline(always)]
    fn at(&self, j: usize, signal: Vec3<Wide<S>>) -> Vec3<Wide<S>> {
        let Place { value, rise } = &self.places[j];
        // No closures here, because the compiler does not inline them.
        let rms = Wide::load(&rise[3]).mul_add(self.steps, Wide::load(&value[3]));
        let x = Wide::load(&rise[0]).mul_add(self.steps, Wide::load(&value[0]));
        let y = Wide::load(&rise[1]).mul_add(self.steps, Wide::load(&value[1]));
        let z = Wide::load(&rise[2]).mul_add(self.steps, Wide::load(&value[2]));
        Vec3::new(signal.x.mul_add(rms, x), signal.y.mul_add(rms, y), signal.z.mul_add(rms, z))
    }
}
