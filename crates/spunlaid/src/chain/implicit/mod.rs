//! Leapfrog with implicit tension: the time step is not limited by axial waves nor by the waves of a taut string.
//!
//! The scheme uses the tension `λ = k_a (ℓ_{k+1} − l)` that an element will have at the end of the step. The
//! tension acts along the element's direction at the start of the step. The change of that direction during
//! the step is averaged as in Newmark's rule, which adds a share of `h²` times the string's stiffness to the
//! mass. The share is `½ s/(1+s)` with `s = h²λ/(ℓm)`: the square of the ratio of the step to the time that a
//! wave of the string needs to pass the element. The share is close to zero for short steps, where plain
//! leapfrog is better, and large enough for long steps. Each step solves two scalar tridiagonal systems along
//! the chain.                                                             theory.md (51) to (54)
//!
//! 1. A force pass from the root computes the forces with the tensions of the last step, and eliminates the
//!    system of the accelerations.
//! 2. A pass from the free end to the root computes the accelerations, the predicted velocities and edges,
//!    and eliminates the system of the corrections `δ` of the tensions (Newton's method, one iteration).
//! 3. A pass from the root to the free end corrects the tensions and moves the nodes.

mod accelerations;
mod corrections;
mod iterations;
mod motion;
mod tensions;

pub(crate) use tensions::Tensions;

use super::force_pass::{ElementBlock, force_pass};
use super::work::{Supports, WorkDone, WorkRegisters};
use super::{Chain, Stride};
use crate::air::Velocities;
use crate::lanes::{Register, Wide};
use crate::vec3::Vec3;
use accelerations::{Predictor, most_kept};
use corrections::predict_and_eliminate;
use motion::correct_and_move;

/// Advances eight chains by one step. The arguments are those of the explicit step, with equal times of kick and drift.
#[inline(always)]
pub(crate) fn step<S: Register, const FED: bool>(
    chain: &mut Chain,
    air: &Velocities<'_, S>,
    Stride { drift: h, damped, split, .. }: Stride,
    work: &mut WorkDone,
    block: &mut ElementBlock<S>,
) {
    let c = &chain.constants;
    let mut predictor = Predictor::<S> {
        damped,
        charged: chain.charged.as_ref(),
        position: &chain.position,
        velocity: &chain.velocity,
        earlier: &chain.earlier,
        c,
        h,
        h_squared: Wide::splat(h * h),
        most_kept: most_kept::<S, FED>(h),
        t: &mut chain.tensions,
        string: (Wide::zero(), Wide::zero()),
        above: (Vec3::zero(), Wide::zero()),
        dissipation: Wide::zero(),
    };
    force_pass(&mut predictor, c, air, chain.position.len() - 1, block);
    work.dissipate(predictor.dissipation, c, h);
    predict_and_eliminate::<S, FED>(chain, h);
    if FED {
        chain.hold_landing();
    }
    let mut sums = (WorkRegisters::new(work, split), Supports::start(work));
    let change = correct_and_move::<S, FED>(chain, h, damped, &mut sums);
    sums.0.put(work);
    sums.1.put(work);
    if FED {
        chain.iterate(&change.store(), h, split, work);
    }
}
