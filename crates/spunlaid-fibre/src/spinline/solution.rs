//! What a solved spinline says.

use crate::drag::FrictionLaw;
use spunlaid_air::motion::kinematic_viscosity_at;

/// A solved spinline.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// The filament from the die to the end, at rising distances: evenly spaced, and the solidification point.
    pub stations: Vec<Station>,
    /// Speed of the hole's melt `v_0` at the die [m/s].
    pub die_speed: f64,
    /// Speed at the end [m/s].
    pub final_speed: f64,
    /// Diameter of the cold filament [m].
    pub final_diameter: f64,
    /// Mass per length of the cold filament [kg/m].
    pub linear_density: f64,
    /// Where the filament becomes solid.
    pub solidification: Solidification,
    /// Tension at the die `F_0` [N].
    pub force_at_die: f64,
    /// Tension at the end [N].
    pub force_at_end: f64,
    /// Largest strain rate `v'` [1/s].
    pub largest_strain_rate: f64,
    /// Its distance from the die [m].
    pub largest_strain_rate_at: f64,
    /// Birefringence `Δn` of the solid filament by the stress-optical law [-].
    pub birefringence: f64,
    /// Whether the birefringence, and the modulus that follows from it, are known to be too small.
    pub has_low_birefringence: bool,
    /// Young's modulus to expect [Pa]; it can be wrong by a factor of two.
    pub modulus_estimate: f64,
    /// By how much the balance of momentum over the whole line fails, over the largest tension [-].
    pub momentum_residual: f64,
    /// By how much the balance of energy over the whole line fails, over the heat given to the air [-].
    pub energy_residual: f64,
    /// Whether a second steady state was found, with a larger force at the die.
    pub has_second: bool,
}

/// The filament at a distance from the die.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Station {
    /// Distance from the die `z` [m].
    pub distance: f64,
    /// Speed of the filament `v` [m/s].
    pub speed: f64,
    /// Its diameter `d` [m].
    pub diameter: f64,
    /// Its temperature `T` [K].
    pub temperature: f64,
    /// Its total tension `F` [N].
    pub tension: f64,
    /// Stress `N_1 = τ_zz − τ_rr` [Pa].
    pub stress: f64,
    /// Transformed share `θ` [-].
    pub transformed: f64,
    /// Strain rate `v'` [1/s].
    pub strain_rate: f64,
    /// Velocity of the air along the filament `u` [m/s].
    pub air_velocity: f64,
    /// Velocity of the air across the filament `v_c` [m/s].
    pub air_cross_velocity: f64,
    /// Temperature of the air `T_a` [K].
    pub air_temperature: f64,
    /// Heat that goes into the air by convection [W/m].
    pub convection: f64,
    /// Friction of the air on the filament `f_t`, downwards [N/m].
    pub friction: f64,
}

/// The point at which the filament becomes solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solidification {
    /// Distance from the die [m].
    pub distance: f64,
    /// Temperature [K].
    pub temperature: f64,
    /// Diameter there [m].
    pub diameter: f64,
    /// Stress there [Pa].
    pub stress: f64,
    /// How fast the filament cools there [K/s].
    pub cooling_rate: f64,
    /// What makes it solid.
    pub by: SolidificationCause,
}

named! {
    /// What makes the filament solid.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum SolidificationCause {
        /// It is as cold as the solidification temperature.
        Temperature = "temperature",
        /// Enough of it has crystallised.
        Crystallisation = "crystallisation",
    }
}

impl Solution {
    /// The final speed over the speed at the die [-].
    pub fn draw_ratio(&self) -> f64 {
        self.final_speed / self.die_speed
    }

    /// What is to be said where the Reynolds numbers along the filament lie beyond the rows of a law of a file. The
    /// usual one is their mean over the friction.
    pub fn beyond_table(&self, law: FrictionLaw) -> Option<String> {
        let FrictionLaw::Table(table) = law else { return None };
        let reynolds = |station: &Station| {
            (station.air_velocity - station.speed).abs() * station.diameter
                / kinematic_viscosity_at(station.air_temperature)
        };
        let sum = |of: &dyn Fn(&Station) -> f64| self.stations.iter().map(of).sum::<f64>();
        let usual = sum(&|at| at.friction.abs() * reynolds(at)) / sum(&|at| at.friction.abs());
        table.beyond([usual, self.stations.iter().map(reynolds).fold(0.0, f64::max)])
    }

    /// The filament at the end of the line.
    pub fn end(&self) -> Station {
        self.stations.last().copied().unwrap_or_default()
    }
}
