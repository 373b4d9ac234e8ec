//! The record of a fibre at an instant.

use crate::energy::Energy;
use crate::flight::Snapshot;
use crate::vec3::Vec3;

/// One recorded instant of a fibre.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sample {
    /// Time [s].
    pub time: f64,
    /// Position of the end node [m].
    pub end: Vec3<f64>,
    /// Kinetic energy [J].
    pub kinetic: f64,
    /// Energy stored in stretch [J].
    pub axial: f64,
    /// Energy stored in bending [J].
    pub bending: f64,
    /// Work of all forces on the nodes by the trapezoidal rule [J].
    pub work: f64,
    /// Work of gravity [J].
    pub gravity_work: f64,
    /// Work of the air [J].
    pub air_work: f64,
    /// Work of the damping [J].
    pub damping_work: f64,
    /// Work of what drives the root of a fed fibre [J]. Energies and works of a fed fibre are those seen from the belt.
    pub feed_work: f64,
    /// Work of the belt [J], negative.
    pub belt_work: f64,
    /// Energy that came with fed fibre, minus the energy that left with laid fibre [J].
    pub carried: f64,
    /// Energy that the implicit tension has taken out of the motion and that the elements do not store [J]; zero
    /// with the explicit schemes.
    pub tension_dissipation: f64,
    /// Error of the energy balance [J].
    pub imbalance: f64,
}

impl Sample {
    /// The sample of the fibre in a lane.
    pub(crate) fn of(snapshot: &Snapshot, lane: usize) -> Self {
        let e: &Energy = &snapshot.energy;
        let end = snapshot.position.get(snapshot.nodes[lane] - 1);
        Self {
            time: snapshot.time,
            end: end.map_or_else(Vec3::default, |p| p.lane(lane)),
            kinetic: e.kinetic.0[lane],
            axial: e.axial.0[lane],
            bending: e.bending.0[lane],
            work: e.work.0[lane],
            gravity_work: e.gravity_work.0[lane],
            air_work: e.drag_work.0[lane],
            damping_work: e.damping_work.0[lane],
            feed_work: e.feed_work.0[lane],
            belt_work: e.belt_work.0[lane],
            carried: e.carried.0[lane],
            tension_dissipation: e.tension_dissipation.0[lane],
            imbalance: e.imbalance().0[lane],
        }
    }

    /// The work check `100 |W − T|/T` [%]; NaN at rest.                      theory.md (35)
    pub fn work_error_percent(&self) -> f64 {
        percent(self.work - self.kinetic, self.kinetic).abs()
    }

    /// Error of the energy balance divided by the work of the air [%]. If that work is zero, the divisor is the
    /// work of gravity or else the kinetic energy; NaN if all are zero.      theory.md (36)
    pub fn balance_error_percent(&self) -> f64 {
        percent(self.imbalance, self.input()).abs()
    }

    /// Dissipation of the implicit tension, with the same divisor as the balance [%].
    pub fn tension_dissipation_percent(&self) -> f64 {
        percent(self.tension_dissipation, self.input().abs())
    }

    /// The divisor of the relative errors [J].
    fn input(&self) -> f64 {
        let scales = [self.air_work, self.gravity_work, self.kinetic];
        scales.into_iter().find(|&w| w != 0.0).unwrap_or(0.0)
    }
}

fn percent(part: f64, whole: f64) -> f64 {
    if whole == 0.0 { f64::NAN } else { 100.0 * (part / whole) }
}
