//! The wind of eddies, each of which several elements of a fibre share.

use super::{Eddies, Wind};
use crate::lanes::{Lanes, Register};
use crate::vec3::Vec3;

/// The wind of eddies, and which element lies in which of them.
#[derive(Clone, Debug)]
pub struct EddyWind {
    /// Which element lies in which eddy.
    pub eddies: Eddies,
    /// The wind in each eddy.
    pub wind: Wind,
}

impl EddyWind {
    /// Writes the wind at each element from `start` on.
    #[inline(always)]
    pub(super) fn fill<S: Register>(&self, start: usize, velocity: &mut [Vec3<Lanes>]) {
        let now = self.wind.now::<S>();
        // No eddy has this number.
        let (mut last, mut wind) = (u32::MAX, Vec3::zero());
        for (velocity, &eddy) in velocity.iter_mut().zip(&self.eddies.of_element()[start..]) {
            if eddy != last {
                (last, wind) = (eddy, now.velocity(eddy));
            }
            *velocity = wind.store();
        }
    }
}
