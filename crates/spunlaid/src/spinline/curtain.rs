//! Rows of filaments that one stream of air crosses: each row meets the air that the one before has warmed and dragged.

use super::{AirTable, Curtain, Failure, Solution, Spinline, Surroundings, steady};
use crate::air::{HEAT_CAPACITY_OF_AIR, density_at};
use crate::drag::FrictionLaw;

/// The steady state of each row, the quenched side first.
pub(super) fn solve(line: &Spinline, friction: FrictionLaw) -> Result<Vec<Solution>, Failure> {
    let first = steady::solve(line, friction, &line.air)?;
    let Some(curtain) = line.curtain else { return Ok(vec![first]) };
    let mut rows = vec![first];
    for _ in 1..curtain.rows {
        let Some(before) = rows.last() else { break };
        let air = Surroundings::Behind(behind(before, curtain));
        rows.push(steady::solve_near(line, friction, &air, before)?);
    }
    Ok(rows)
}

/// The air behind a row of filaments.                                                               theory.md (99)
///
/// The air goes towards the temperature and the speed of the filaments, and it never goes beyond them,
/// however slowly it crosses the row. Where no air crosses it stays as it is. Radiation does not warm the
/// air.
fn behind(row: &Solution, curtain: Curtain) -> AirTable {
    let mut air = AirTable::default();
    for station in &row.stations {
        let crossing = density_at(station.air_temperature) * station.air_cross_velocity;
        let share = if crossing > 0.0 { curtain.filaments_per_metre / crossing } else { 0.0 };
        air.distance.push(station.distance);
        let dragged = towards(-share * station.friction, station.speed - station.air_velocity);
        air.velocity.push(station.air_velocity + dragged);
        air.cross_velocity.push(station.air_cross_velocity);
        let change = share * station.convection / HEAT_CAPACITY_OF_AIR;
        let warmed = towards(change, station.temperature - station.air_temperature);
        air.temperature.push(station.air_temperature + warmed);
    }
    air
}

/// A change that ends at a gap: `gap (1 − e^(−change/gap))`, the change itself where it is small.
fn towards(change: f64, gap: f64) -> f64 {
    if gap == 0.0 { 0.0 } else { -gap * libm::expm1(-change / gap) }
}
