//! The wind of eddies, each of which several elements of a fibre share.

use super::wind::EddyVelocities;
use super::{Eddies, Wind};
use crate::lanes::{Register, Wide};
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
    /// Looks at the wind at a time [s].
    #[inline(always)]
    pub(super) fn look<S: Register>(&mut self, time: f64) -> InstantEddies<'_, S> {
        InstantEddies { now: self.wind.blow(time), of_element: self.eddies.index_of_element() }
    }
}

/// The wind of eddies at one instant.
pub(crate) struct InstantEddies<'a, S: Register> {
    now: EddyVelocities<'a, S>,
    /// The eddy of each element.
    of_element: &'a [u32],
}

/// The last eddy that was asked for, and its velocity [m/s].
pub(crate) struct LastEddy<S: Register>(u32, Vec3<Wide<S>>);

impl<S: Register> LastEddy<S> {
    #[inline(always)]
    pub(crate) fn none() -> Self {
        // No eddy has this number.
        Self(u32::MAX, Vec3::zero())
    }
}

impl<S: Register> InstantEddies<'_, S> {
    /// The wind at element `j`.
    #[inline(always)]
    pub(super) fn at(&self, j: usize, last: &mut LastEddy<S>) -> Vec3<Wide<S>> {
        let eddy = self.of_element[j];
        if eddy != last.0 {
            *last = LastEddy(eddy, self.now.velocity(eddy));
        }
        last.1
    }
}
