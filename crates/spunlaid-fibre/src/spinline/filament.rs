//! The filament at a place: how its state changes with the distance from the die.

use super::material::{Crystals, Material};
use super::{AirChange, End, Law, Melt, Spinline, Station, Surroundings};
use crate::drag::FrictionLaw;
use spunlaid_air::motion::{density_at, kinematic_viscosity_at};
use std::f64::consts::PI;

/// Number of values of a [`State`].
pub(super) const SIZE: usize = 9;
/// What changes along the filament, by these indices.
pub(super) type State = [f64; SIZE];

/// `ln v`, `v` in m/s.
pub(super) const LN_SPEED: usize = 0;
/// `T` [K].
pub(super) const TEMPERATURE: usize = 1;
/// `F` [N]. Of a viscoelastic melt the conformation gives it.
pub(super) const TENSION: usize = 2;
/// `y` of Nakamura's law [-].
pub(super) const PROGRESS: usize = 3;
/// `c_zz` and `c_rr`, the conformation of a viscoelastic melt [-].
pub(super) const ALONG: usize = 4;
pub(super) const ACROSS: usize = 5;
/// `∫ (Wg/v + f_t) dz` [N].
pub(super) const PULL: usize = 6;
/// `∫ q dz` [W].
pub(super) const HEAT: usize = 7;
/// `∫ A N_1 dv` [W].
pub(super) const WORK: usize = 8;

/// Relative error of a step.
const TOLERANCE: f64 = 1e-8;
/// Acceleration of gravity [m/s²].
pub(super) const GRAVITY: f64 = 9.81;
/// Stefan–Boltzmann constant [W/(m² K⁴)].
pub(super) const STEFAN_BOLTZMANN: f64 = 5.670_374_419e-8;
/// Gas constant [J/(mol K)].
const GAS_CONSTANT: f64 = 8.314_462_618;

/// Whether the filament flows at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Phase {
    Melt,
    /// Solid, with the orientation `f` of the solidification point [-].
    Solid {
        orientation: f64,
    },
}

/// A filament in its surroundings.
#[derive(Clone, Debug)]
pub(super) struct Filament<'a> {
    pub(super) line: &'a Spinline,
    /// What is known at the end.
    pub(super) end: End,
    pub(super) friction: FrictionLaw,
    pub(super) air: &'a Surroundings,
    pub(super) air_change: AirChange,
    /// Acceleration of gravity [m/s²].
    pub(super) gravity: f64,
    /// `k Nu` [W/(m K)], if it does not follow from the air; exact solutions have a constant one.
    pub(super) heat_transfer: Option<f64>,
    /// Viscosity at the reference temperature `η_r` [Pa s].
    pub(super) viscosity: f64,
    /// Factor on inertia, weight, friction and surface tension [-]; a continuation begins with little of them.
    pub(super) forces: f64,
    /// Whether a shot ends where the melt goes slack.
    pub(super) ends_slack: bool,
    /// Relative error of a step.
    pub(super) tolerance: f64,
}

/// The rates of a state, and what they are made of.
pub(super) struct Rates {
    /// `d/dz` of each value.
    pub(super) slopes: State,
    /// The filament at the place.
    pub(super) station: Station,
    /// Whether the filament is as fast as its own elastic wave.
    pub(super) is_elastic_wave: bool,
}

impl<'a> Filament<'a> {
    pub(super) fn new(line: &'a Spinline, friction: FrictionLaw, air: &'a Surroundings) -> Self {
        let air_change = match air {
            Surroundings::Table(_) | Surroundings::Field { .. } => line.air_change,
            // Air behind a row comes from air that was changed already.
            Surroundings::Uniform(_) | Surroundings::Behind(_) => AirChange::NONE,
        };
        let viscosity = line.viscosity();
        Self {
            line,
            end: line.end,
            friction,
            air,
            air_change,
            gravity: GRAVITY,
            heat_transfer: None,
            viscosity,
            forces: 1.0,
            ends_slack: true,
            tolerance: TOLERANCE,
        }
    }

    /// Whether the rates at the die are finite, under a usual tension.
    pub(super) fn is_computable(&self) -> bool {
        const TENSION: f64 = 1e-3;
        let Some(state) = self.at_die(TENSION) else { return true };
        let slopes = self.rates(1e-14 * self.line.length, &state, Phase::Melt, &mut 0).slopes;
        self.die_speed() > 0.0 && slopes.iter().all(|slope| slope.is_finite())
    }

    /// Lowest temperature of the air [K].
    pub(super) fn coldest_air(&self) -> f64 {
        match self.air {
            Surroundings::Uniform(air) => air.temperature,
            _ => {
                let rows = self.air.table().map_or(&[][..], |table| &table.temperature);
                rows.iter().copied().fold(f64::INFINITY, f64::min) + self.air_change.temperature_offset
            }
        }
    }

    fn material(&self) -> &Material {
        &self.line.material
    }

    /// The constants of crystallisation, if it is computed.
    fn crystals(&self) -> Option<&Crystals> {
        self.line.crystallisation.then_some(&self.line.material.crystals)
    }

    /// Diameter of the filament at the die `d_0` [m].
    fn die_diameter(&self) -> f64 {
        self.line.die_swell * self.line.hole_diameter
    }

    /// Speed at the die `v_0 = 4W/(π ρ d_0²)` [m/s].                                               theory.md (84)
    pub(super) fn die_speed(&self) -> f64 {
        let (d, line) = (self.die_diameter(), self.line);
        4.0 * line.throughput / (PI * self.material().melt_density(line.die_temperature) * d * d)
    }

    /// The state at the die under a tension [N]; none if the surface tension alone is more.
    ///
    /// A viscoelastic melt is stretched without memory there: `c_rr = c_zz^(−1/2)`.
    pub(super) fn at_die(&self, tension: f64) -> Option<State> {
        let (line, d) = (self.line, self.die_diameter());
        let pulled = tension - 0.5 * PI * self.forces * self.material().surface_tension * d;
        if pulled <= 0.0 {
            return None;
        }
        // u = √c_zz is the root of u³ − S u − 1 = 0; Newton's method comes from above.
        let stretch = pulled / (0.25 * PI * d * d * self.material().modulus);
        let mut u = 1.0 + libm::sqrt(stretch);
        for _ in 0..60 {
            let step = (u * (u * u - stretch) - 1.0) / (3.0 * u * u - stretch);
            u -= step;
            if step <= 1e-16 * u {
                break;
            }
        }
        let mut state = [0.0; SIZE];
        state[LN_SPEED] = libm::log(self.die_speed());
        state[TEMPERATURE] = line.die_temperature;
        state[TENSION] = tension;
        state[ALONG] = u * u;
        state[ACROSS] = 1.0 / u;
        Some(state)
    }

    /// Viscosity of the melt `η` [Pa s].                                                           theory.md (90)
    fn viscosity_at(&self, temperature: f64, transformed: f64) -> f64 {
        let material = self.material();
        let inverse = 1.0 / temperature - 1.0 / material.viscosity_temperature;
        let hardening = self.crystals().map_or(0.0, |crystals| {
            crystals.hardening_factor * libm::pow(transformed, crystals.hardening_exponent)
        });
        self.viscosity * libm::exp(material.activation_energy / GAS_CONSTANT * inverse + hardening)
    }

    /// Relaxation times that a viscoelastic melt takes for a stretch, with the state at its start [-].
    ///
    /// * `start`, `end` – roots of the distance from the die [√m]
    pub(super) fn relaxations(&self, state: &State, start: f64, end: f64) -> f64 {
        if self.line.law == Law::Newtonian {
            return 0.0;
        }
        let viscosity = self.viscosity_at(state[TEMPERATURE], self.transformed(state));
        (end * end - start * start) * self.material().modulus / (viscosity * libm::exp(state[LN_SPEED]))
    }

    /// By how much a change of the tension grows on a stretch by inertia, `ln`: `∫ ρv/(3η) dz`, with the state at its
    /// start.
    ///
    /// * `start`, `end` – roots of the distance from the die [√m]
    pub(super) fn growth(&self, state: &State, start: f64, end: f64) -> f64 {
        let viscosity = self.viscosity_at(state[TEMPERATURE], self.transformed(state));
        let density = self.material().melt_density(state[TEMPERATURE]);
        self.forces * density * libm::exp(state[LN_SPEED]) / (3.0 * viscosity) * (end * end - start * start)
    }

    /// The share `θ = 1 − exp(−y^n)` that has crystallised [-].                                    theory.md (94)
    pub(super) fn transformed(&self, state: &State) -> f64 {
        let progress = state[PROGRESS].max(0.0);
        self.crystals().map_or(0.0, |crystals| -libm::expm1(-libm::pow(progress, crystals.avrami_exponent)))
    }

    /// How far the state is from being solid: zero or less where it is. A share of the temperature or of the
    /// crystallinity [-].
    pub(super) fn until_solid(&self, state: &State) -> f64 {
        let cooling = state[TEMPERATURE] / self.material().solidification_temperature - 1.0;
        match self.crystals() {
            Some(crystals) => cooling.min(1.0 - self.transformed(state) / crystals.solidification_fraction),
            None => cooling,
        }
    }

    /// By how much the air is faster than the filament, along it, and its velocity across [m/s].
    ///
    /// * `hint` – the row of the air's table above which the last look was
    pub(super) fn faster_air(&self, distance: f64, state: &State, hint: &mut usize) -> [f64; 2] {
        let air = self.air_change.apply(self.air.at(distance, hint));
        [air.velocity - libm::exp(state[LN_SPEED]), air.cross_velocity]
    }

    /// Whether the temperature makes the state solid.
    pub(super) fn is_cold(&self, state: &State) -> bool {
        state[TEMPERATURE] <= self.material().solidification_temperature * (1.0 + 1e-12)
    }

    /// Orientation `f = min(1, C_op N_1/Δn_∞)` [-], by the stress alone: the enhancement was chosen for this
    /// form.  theory.md (95)
    pub(super) fn orientation(&self, stress: f64) -> f64 {
        let material = self.material();
        (material.stress_optical_coefficient * stress / material.full_birefringence).clamp(0.0, 1.0)
    }

    /// What the relaxation takes from `c_zz` and `c_rr` per time, times the relaxation time [-].   theory.md (92)
    fn relaxation(&self, along: f64, across: f64) -> [f64; 2] {
        let zeta = along - 1.0;
        let chi = across - 1.0;
        let material = self.material();
        let trace = material.extensibility * (zeta + 2.0 * chi);
        match self.line.law {
            Law::Newtonian => [0.0; 2],
            Law::Giesekus => [zeta, chi].map(|c| c + material.mobility * c * c),
            Law::Ptt => [zeta, chi].map(|c| (1.0 + trace) * c),
            Law::PttExponential => [zeta, chi].map(|c| libm::exp(trace) * c),
        }
    }

    /// Friction of the air on the filament, downwards [N/m].                                         theory.md (86)
    fn friction(&self, distance: f64, diameter: f64, faster: f64, air_temperature: f64) -> f64 {
        if faster == 0.0 {
            return 0.0;
        }
        let density = density_at(air_temperature);
        let re = faster.abs() * diameter / kinematic_viscosity_at(air_temperature);
        let coefficient = self.friction.coefficient(re, distance / diameter);
        self.line.drag_factor * 0.5 * PI * diameter * density * coefficient * faster.abs() * faster
    }

    /// Heat that the air takes from the filament, by convection and by radiation [W/m].    theory.md (88), (89)
    fn heat(
        &self,
        diameter: f64,
        faster: f64,
        cross: f64,
        temperature: f64,
        air_temperature: f64,
    ) -> [f64; 2] {
        let film = 0.5 * (temperature + air_temperature);
        let fourth = |t: f64| t * t * t * t;
        let radiation = PI
            * diameter
            * self.line.emissivity
            * STEFAN_BOLTZMANN
            * (fourth(temperature) - fourth(air_temperature));
        let transfer =
            self.heat_transfer.unwrap_or_else(|| self.line.convection(diameter, [faster, cross], film));
        [PI * transfer * (temperature - air_temperature), radiation]
    }

    /// How the state changes with the distance.                                         theory.md (84) to (95)
    ///
    /// * `distance` – from the die, above zero [m]
    /// * `hint` – the row of the air's table above which the last look was
    pub(super) fn rates(&self, distance: f64, state: &State, phase: Phase, hint: &mut usize) -> Rates {
        let (line, material) = (self.line, self.material());
        let (mass_flow, gravity) = (line.throughput, self.gravity);
        let air = self.air_change.apply(self.air.at(distance, hint));
        let (v, temperature) = (libm::exp(state[LN_SPEED]), state[TEMPERATURE]);
        let density = material.melt_density(temperature);
        let area = mass_flow / (density * v);
        let radius = libm::sqrt(area / PI);
        let diameter = 2.0 * radius;
        let faster = air.velocity - v;
        let friction = self.friction(distance, diameter, faster, air.temperature);
        let [convection, radiation] =
            self.heat(diameter, faster, air.cross_velocity, temperature, air.temperature);
        let heat = convection + radiation;
        let inertia = self.forces * mass_flow;
        let pull = self.forces * (mass_flow * gravity / v + friction);
        let surface = PI * self.forces * material.surface_tension * radius;
        let is_melt = phase == Phase::Melt;
        let viscoelastic = is_melt && line.law != Law::Newtonian;
        let (along, across) = (state[ALONG], state[ACROSS]);
        // A N_1: the tension without that of the surface.
        let stretched =
            if viscoelastic { area * material.modulus * (along - across) } else { state[TENSION] - surface };
        let stress = stretched / area;

        let transformed = self.transformed(state);
        let orientation = match phase {
            Phase::Melt => self.orientation(stress),
            Phase::Solid { orientation } => orientation,
        };
        let (mut progress, mut crystallising) = (0.0, 0.0);
        if let Some(crystals) = self.crystals() {
            let (n, y) = (crystals.avrami_exponent, state[PROGRESS].max(0.0));
            progress = crystals.rate_at(temperature, orientation) / v;
            crystallising = n * libm::pow(y, n - 1.0) * (1.0 - transformed) * progress;
        }

        // T' = cooling + heating v'.
        let per_kelvin = mass_flow * material.heat_capacity_at(temperature);
        let fusion = self.crystals().map_or(0.0, |crystals| crystals.heat_of_fusion * crystals.crystallinity);
        let cooling = (mass_flow * fusion * crystallising - heat) / per_kelvin;
        let heating = if line.dissipation { stretched / per_kelvin } else { 0.0 };

        let (mut strain_rate, mut is_elastic_wave) = (0.0, false);
        let mut conformation = [0.0; 2];
        if viscoelastic {
            let relaxation_time = self.viscosity_at(temperature, transformed) / material.modulus;
            let [relax_along, relax_across] = self.relaxation(along, across).map(|r| r / relaxation_time);
            let elastic = area * material.modulus;
            // ρ'/ρ = −a_1 ρ T'; half the surface's tension changes with the radius.
            let denser = -(stretched + 0.5 * surface) * material.specific_volume_slope * density;
            let force = elastic * (relax_along - relax_across) / v + denser * cooling - pull;
            let stiffness =
                (elastic * (along + 2.0 * across) - 0.5 * surface) / v - inertia - denser * heating;
            is_elastic_wave = stiffness <= 0.0;
            strain_rate = force / stiffness;
            conformation =
                [(2.0 * strain_rate * along - relax_along) / v, (-strain_rate * across - relax_across) / v];
        } else if is_melt {
            strain_rate = stretched / (3.0 * self.viscosity_at(temperature, transformed) * area);
        }

        let mut slopes = [0.0; SIZE];
        slopes[LN_SPEED] = strain_rate / v;
        slopes[TEMPERATURE] = cooling + heating * strain_rate;
        slopes[TENSION] = inertia * strain_rate - pull;
        slopes[PROGRESS] = progress;
        [slopes[ALONG], slopes[ACROSS]] = conformation;
        slopes[PULL] = pull;
        slopes[HEAT] = heat;
        slopes[WORK] = stretched * strain_rate;
        let station = Station {
            distance,
            speed: v,
            diameter,
            temperature,
            tension: stretched + surface,
            stress,
            transformed,
            strain_rate,
            air_velocity: air.velocity,
            air_cross_velocity: air.cross_velocity,
            air_temperature: air.temperature,
            convection,
            friction,
        };
        Rates { slopes, station, is_elastic_wave }
    }
}

impl Spinline {
    /// `k Nu` of a filament in air [W/(m K)].                                                         theory.md (89)
    ///
    /// * `diameter` – of the filament [m]
    /// * `faster`, `cross` – velocity of the air relative to it, along and across [m/s]
    /// * `film` – mean temperature of filament and air [K]
    pub(super) fn convection(&self, diameter: f64, [faster, cross]: [f64; 2], film: f64) -> f64 {
        let speeds = faster * faster + 64.0 * cross * cross;
        let nusselt = self.nusselt_factor
            * 0.42
            * libm::cbrt(diameter / kinematic_viscosity_at(film))
            * libm::sqrt(libm::cbrt(speeds));
        conductivity_at(film) * nusselt
    }

    /// Viscosity of the melt at the reference temperature `η_r` [Pa s].
    pub(crate) fn viscosity(&self) -> f64 {
        match self.melt {
            Melt::Viscosity => self.material.viscosity,
            Melt::FlowRate(rate) => self.material.viscosity_of_flow_rate(rate),
        }
    }
}

/// Conductivity of dry air [W/(m K)], U.S. Standard Atmosphere 1976.                                theory.md (89)
///
/// * `temperature` – [K]
fn conductivity_at(temperature: f64) -> f64 {
    2.64638e-3 * temperature * libm::sqrt(temperature)
        / (temperature + 245.4 * libm::exp10(-12.0 / temperature))
}
