//! The spinline: from the hole of the spinneret to the solid filament.
//!
//! The data of a process engineer, [`Spinline`], give what a fibre in flight needs: its diameter, its
//! speed and roughly its modulus. One filament in steady state, with values averaged over its cross-section.
//!                                                                                     theory.md (84) to (99)
//!
//! ```text
//! Spinline (what is known) → Filament (balances at a place) → shot (one tension at the die)
//!   → shooting (the tension that meets the end), or boundary (all places together) → Solution
//! curtain: row after row, each in the air that the one before has warmed and dragged
//! ```

mod boundary;
mod calibration;
mod cooling;
mod elimination;
mod filament;
mod integration;
mod material;
mod measures;
mod shooting;
mod shot;
mod solution;
mod steady;
mod surroundings;
#[cfg(test)]
mod tests;

use crate::drag::{Drag, FrictionLaw};
pub use cooling::{Cooled, SolidFilament};
pub use material::{Crystals, Material, Polymer, PolymerFile, ZERO_CELSIUS};
pub use measures::SPINLINE_MEASURES;
pub use solution::{Solidification, SolidificationCause, Solution, Station};
use spunlaid_air::motion::density_at;
use spunlaid_air::{Air, FileContent, HEAT_CAPACITY_OF_AIR};
use spunlaid_ground::Fault;
pub use surroundings::{AirChange, AirState, AirTable, Surroundings};

/// What is known of a spinline.
#[derive(Clone, Debug, PartialEq)]
pub struct Spinline {
    /// The polymer whose constants stand in `material`, unless a case gives them.
    pub polymer: PolymerSource,
    /// The constants of the polymer.
    pub material: Material,
    /// Where constants that differ from those of the polymer come from, in the user's words.
    pub source: Option<String>,
    /// Viscosity of the melt.
    pub melt: Melt,
    /// Temperature of the melt in the hole [K].
    pub die_temperature: f64,
    /// Diameter of the hole [m].
    pub hole_diameter: f64,
    /// Diameter of the filament at the die over that of the hole [-].
    pub die_swell: f64,
    /// Mass flow of a hole `W` [kg/s].
    pub throughput: f64,
    /// Length of the line, from the die to the end [m].
    pub length: f64,
    /// The air along the line.
    pub air: Surroundings,
    /// How the air of a table or a field is changed.
    pub air_change: AirChange,
    /// What is known at the end of the line.
    pub end: End,
    /// How the melt resists stretching.
    pub law: Law,
    /// Whether the polymer crystallises on its way.
    pub crystallisation: bool,
    /// Emissivity of the filament `ε` [-]; zero leaves radiation out.
    pub emissivity: f64,
    /// Whether the work of stretching heats the filament.
    pub dissipation: bool,
    /// Factor on the Nusselt number [-].
    pub nusselt_factor: f64,
    /// Factor on the friction between filament and air [-].
    pub drag_factor: f64,
    /// Stress at which the filament breaks [Pa]; infinite if it is not known.
    pub break_stress: f64,
    /// The rows of holes, if they share the air that crosses them.
    pub curtain: Option<HoleRows>,
    /// Whether Young's modulus of the simulated fibre is the estimate; a case that writes the modulus does not want it.
    pub gives_modulus: bool,
}

/// A spinline and the drag laws, of which the one along the filament is used.
#[derive(Clone, Debug, PartialEq)]
pub struct SpinSpec {
    /// What is known of the line.
    pub spinline: Spinline,
    /// The drag laws.
    pub drag: Drag,
    /// The air of the case, if the line takes its velocity from a CFD field.
    pub air: Option<Box<Air>>,
}

impl SpinSpec {
    /// The steady state of a filament alone in the air.
    ///
    /// # Errors
    /// As [`Spinline::solve`].
    pub fn solve(&self) -> Result<Solution, Failure> {
        self.spinline.solve(self.drag.along)
    }
}

/// Where the constants of a polymer come from.
#[derive(Clone, Debug, PartialEq)]
pub enum PolymerSource {
    /// A polymer whose constants the program has.
    Known(Polymer),
    /// A file.
    File(FileContent<PolymerFile>),
}

/// What gives the viscosity of the melt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Melt {
    /// The constant of the material.
    Viscosity,
    /// The melt flow rate [g/10 min].
    FlowRate(f64),
}

/// What is known at the end of the line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// The tension [N]; zero for a free end.
    Tension(f64),
    /// The mean tension at the root of the simulated fibre, as far as flights have reported it [N].
    Flown(f64),
    /// The speed of a godet [m/s].
    TakeUp(f64),
}

named! {
    /// How the melt resists stretching.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Law {
        /// `N_1 = 3ηv'`.
        Newtonian = "newtonian",
        /// Giesekus, one mode.
        Giesekus = "giesekus",
        /// Phan-Thien–Tanner, linear.
        Ptt = "ptt",
        /// Phan-Thien–Tanner, exponential.
        PttExponential = "ptt-exponential",
    }
}

/// The rows of holes that one stream of air crosses, the quenched side first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoleRows {
    /// Number of rows.
    pub rows: u64,
    /// Filaments per width in each row [1/m].
    pub filaments_per_metre: f64,
}

impl Spinline {
    /// A spinline of which nothing is known yet.
    pub const UNKNOWN: Self = Self {
        polymer: PolymerSource::Known(Polymer::Pp),
        material: Material::UNKNOWN,
        source: None,
        melt: Melt::Viscosity,
        die_temperature: f64::NAN,
        hole_diameter: f64::NAN,
        die_swell: 1.0,
        throughput: f64::NAN,
        length: f64::NAN,
        air: Surroundings::Uniform(AirState {
            velocity: 0.0,
            cross_velocity: 0.0,
            temperature: 20.0 + ZERO_CELSIUS,
        }),
        air_change: AirChange::NONE,
        end: End::Tension(0.0),
        law: Law::Newtonian,
        crystallisation: false,
        emissivity: 0.0,
        dissipation: false,
        nusselt_factor: 1.0,
        drag_factor: 1.0,
        break_stress: f64::INFINITY,
        curtain: None,
        gives_modulus: true,
    };

    /// The steady state, one filament alone in the air.
    ///
    /// * `friction` – law of the friction between filament and air
    ///
    /// # Errors
    /// If there is none that a line could run in, with the reason and what to do.
    pub fn solve(&self, friction: FrictionLaw) -> Result<Solution, Failure> {
        steady::solve(self, friction, &self.air)
    }

    /// The steady state of a line that differs a little from one whose state is known: that state is
    /// followed, and sought only where it is lost. Whether there is a second one is not looked for again.
    ///
    /// * `near` – the steady state of the other line
    ///
    /// # Errors
    /// As [`Spinline::solve`].
    pub fn solve_near(&self, friction: FrictionLaw, near: &Solution) -> Result<Solution, Failure> {
        steady::solve_near(self, friction, &self.air, near)
    }

    /// The speed at the end of [`Spinline::solve_near`] alone [m/s], at a fraction of the cost.
    ///
    /// # Errors
    /// As [`Spinline::solve`].
    pub fn final_speed_near(&self, friction: FrictionLaw, near: &Solution) -> Result<f64, Failure> {
        steady::final_speed_near(self, friction, &self.air, near)
    }

    /// Whether the stress-optical law gives a birefringence that is too small: the crystals of polypropylene
    /// orient more than the stress of the melt does. Measured filaments have 3 to 5 times as much.
    pub fn has_low_birefringence(&self) -> bool {
        self.polymer == PolymerSource::Known(Polymer::Pp)
    }

    /// Diameter of the cold filament that leaves the line at a speed [m].
    ///
    /// * `speed` – [m/s]
    pub fn final_diameter(&self, speed: f64) -> f64 {
        2.0 * libm::sqrt(self.throughput / speed / (std::f64::consts::PI * self.material.solid_density))
    }

    /// The steady state of each row of the curtain, the quenched side first: each in the air that the row
    /// before has warmed and dragged. One row, if there is no curtain.
    ///
    /// # Errors
    /// As [`Spinline::solve`].
    pub fn solve_rows(&self, friction: FrictionLaw) -> Result<Vec<Solution>, Failure> {
        solve(self, friction)
    }
}

/// Why a spinline cannot be solved: the key to blame, and what to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Failure {
    /// Full name of the key, `spinline.throughput`.
    pub key: &'static str,
    /// Its value in SI units, if it is a number.
    pub value: Option<f64>,
    /// What is wrong.
    pub fault: Fault,
}

impl Failure {
    fn new(key: &'static str, value: Option<f64>, fault: Fault) -> Self {
        Self { key, value, fault }
    }
}

/// The steady state of each row, the quenched side first.
fn solve(line: &Spinline, friction: FrictionLaw) -> Result<Vec<Solution>, Failure> {
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
fn behind(row: &Solution, curtain: HoleRows) -> AirTable {
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

/// Two polymers are equal if the same constants are known of both, with the same values. A constant that is
/// not known is NaN, which is not equal to itself. So their texts are compared: that of NaN is always the
/// same, and different numbers have different texts.
impl PartialEq for Material {
    fn eq(&self, other: &Self) -> bool {
        format!("{self:?}") == format!("{other:?}")
    }
}

impl PartialEq for Crystals {
    fn eq(&self, other: &Self) -> bool {
        format!("{self:?}") == format!("{other:?}")
    }
}

#[cfg(test)]
mod equality_tests {
    use super::{Polymer, *};

    #[test]
    fn polymers_are_equal_also_where_a_constant_is_not_known() {
        for polymer in Polymer::ALL {
            let material = polymer.material(false);
            assert_eq!(material, polymer.material(false));
            assert_ne!(material, Material { viscosity: 123.0, ..material });
            let crystals = Crystals { rate: 123.0, ..material.crystals };
            assert_ne!(material, Material { crystals, ..material });
        }
        assert!(
            Polymer::Pp.material(false).viscosity.is_nan()
                && Polymer::Pla.material(false).crystals.rate.is_nan()
        );
    }
}
