//! The record of a fibre at an instant.

use spunlaid_fibre::{Energy, Snapshot};
use spunlaid_ground::Vec3;

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
    pub(crate) fn new(snapshot: &Snapshot, lane: usize) -> Self {
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

    /// Error of the energy balance, as a share of the energy that flowed [%]; NaN where none did.      theory.md (36)
    pub fn balance_error_percent(&self) -> f64 {
        percent(self.imbalance, self.energy_flow()).abs()
    }

    /// Dissipation of the implicit tension, with the same divisor as the balance [%].
    pub(crate) fn tension_dissipation_percent(&self) -> f64 {
        percent(self.tension_dissipation, self.energy_flow())
    }

    /// Energy that flowed since the start [J]: what came in, or what is held and went out, whichever is more. Both are
    /// equal but for the error of the balance and the energy at the start.
    fn energy_flow(&self) -> f64 {
        let works = [
            self.gravity_work,
            self.air_work,
            self.damping_work,
            self.feed_work,
            self.belt_work,
            self.carried,
            -self.tension_dissipation,
        ];
        let came: f64 = works.iter().map(|work| work.max(0.0)).sum();
        let went: f64 = works.iter().map(|work| (-work).max(0.0)).sum();
        came.max(went + self.kinetic + self.axial + self.bending)
    }
}

fn percent(part: f64, whole: f64) -> f64 {
    if whole == 0.0 { f64::NAN } else { 100.0 * (part / whole) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_balance_is_relative_to_what_flowed() {
        let error = |sample: Sample| Sample { imbalance: 1e-3, ..sample }.balance_error_percent();
        let close =
            |found: f64, wanted: f64| assert!((found / wanted - 1.0).abs() < 1e-14, "{found}, {wanted}");
        // A free fall in vacuum: 2 J of gravity become motion. In air that takes 1e-6 J it is the same fall.
        let fall = Sample { gravity_work: 2.0, kinetic: 2.0, ..Sample::default() };
        close(error(fall), 0.05);
        close(error(Sample { air_work: -1e-6, kinetic: 2.0 - 1e-6, ..fall }), 0.05);
        // Turbulence moves a fibre: its work is what is held and what lifts the fibre.
        let blown =
            Sample { air_work: 2.0, kinetic: 1.2, axial: 0.3, gravity_work: -0.5, ..Sample::default() };
        close(error(blown), 0.05);
        // A fed fibre in air that hardly works: gravity and the feed do, and the belt takes it all.
        let fed = Sample {
            gravity_work: 1.5,
            feed_work: 2.5,
            air_work: -1e-3,
            belt_work: -4.0,
            ..Sample::default()
        };
        close(error(fed), 0.1e-3 / 4.001 * 1000.0);
        // A fibre that only keeps its motion: relative to its energy.
        close(error(Sample { kinetic: 5.0, ..Sample::default() }), 0.02);
        assert!(Sample { imbalance: 1e-3, ..Sample::default() }.balance_error_percent().is_nan());
        // Damping of the scheme is a share of what flows; what it feeds in has the other sign.
        let damped = Sample { tension_dissipation: 1.0, air_work: 4.0, kinetic: 3.0, ..Sample::default() };
        close(damped.tension_dissipation_percent(), 25.0);
        let driven = Sample {
            tension_dissipation: -1.0,
            air_work: -4.0,
            gravity_work: 6.0,
            kinetic: 3.0,
            ..Sample::default()
        };
        close(driven.tension_dissipation_percent(), -100.0 / 7.0);
    }
}
