//! How a solid filament goes on cooling below its spinline.

use super::filament::STEFAN_BOLTZMANN;
use super::{Solution, Spinline};
use std::f64::consts::PI;

/// A solid filament that has left its spinline, in air of one temperature.
#[derive(Clone, Debug)]
pub struct SolidFilament<'a> {
    line: &'a Spinline,
    diameter: f64,
    /// Temperature with which it leaves the spinline [K].
    pub at_start: f64,
    /// Temperature of the air [K].
    pub of_air: f64,
}

/// What a piece of filament has done on a stretch of its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cooled {
    /// Temperature at the end of the stretch [K].
    pub temperature: f64,
    /// Heat that the air gets on the stretch [W].
    pub heat: f64,
    /// By how much less it would get if it were warmer [W/K].
    pub per_kelvin: f64,
}

impl<'a> SolidFilament<'a> {
    /// * `of_air` – temperature of the air [K]
    pub fn new(line: &'a Spinline, solution: &Solution, of_air: f64) -> Self {
        Self { line, diameter: solution.final_diameter, at_start: solution.end().temperature, of_air }
    }

    /// Cools what flows through a stretch of the way, with the heat capacity and the heat transfer in its middle.
    ///                                                                                        theory.md (121)
    ///
    /// * `temperature` – at the start of the stretch [K]
    /// * `length` – of the filament on the stretch [m]
    /// * `relative` – velocity of the air relative to it, along and across [m/s]
    pub fn cool(&self, temperature: f64, length: f64, relative: [f64; 2]) -> Cooled {
        let (line, material) = (self.line, &self.line.material);
        let decay = |at: f64, length: f64| {
            let share =
                self.transfer(at, relative) * length / (line.throughput * material.heat_capacity_at(at));
            self.of_air + (temperature - self.of_air) * libm::exp(-share)
        };
        let middle = decay(temperature, 0.5 * length);
        let end = decay(middle, length);
        let heat = line.throughput * (material.heat_content(temperature) - material.heat_content(end));
        Cooled { temperature: end, heat, per_kelvin: self.transfer(middle, relative) * length }
    }

    /// Heat that the air takes per length and kelvin, by convection and by radiation [W/(m K)].
    fn transfer(&self, temperature: f64, relative: [f64; 2]) -> f64 {
        let (line, sum) = (self.line, temperature + self.of_air);
        let squares = temperature * temperature + self.of_air * self.of_air;
        let radiation = self.diameter * line.emissivity * STEFAN_BOLTZMANN * sum * squares;
        PI * (line.convection(self.diameter, relative, 0.5 * sum) + radiation)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::drag::FrictionLaw;
    use crate::spinline::{AirState, End, Melt, Polymer, Surroundings};

    const OF_AIR: f64 = 293.15;

    /// Polypropylene that is as dense when it is hot, taken up at 50 m/s.
    fn line(length: f64) -> Spinline {
        let mut line = Spinline {
            material: Polymer::Pp.material(false),
            melt: Melt::FlowRate(35.0),
            die_temperature: 503.15,
            hole_diameter: 0.6e-3,
            throughput: 0.7e-3 / 60.0,
            length,
            end: End::TakeUp(50.0),
            air: Surroundings::Uniform(AirState { velocity: 10.0, cross_velocity: 1.0, temperature: OF_AIR }),
            ..Spinline::UNKNOWN
        };
        line.material.specific_volume = 1.0 / line.material.solid_density;
        line.material.specific_volume_slope = 0.0;
        line
    }

    /// None: a godet gives the speed.
    const FRICTION: FrictionLaw = FrictionLaw::Matsui { factor: 0.0 };

    /// Over so many stretches of a length.
    fn cooled(filament: &SolidFilament<'_>, stretches: u32, length: f64, relative: [f64; 2]) -> (f64, f64) {
        let each = length / f64::from(stretches);
        (0..stretches).fold((filament.at_start, 0.0), |(temperature, heat), _| {
            let cooled = filament.cool(temperature, each, relative);
            (cooled.temperature, heat + cooled.heat)
        })
    }

    /// A degree above air of 20 °C; the formulas of (89) give for 20.5 °C 0.02576 W/(m K) and 1.510e-5 m²/s.
    #[test]
    fn analytic_a_filament_cools_exponentially_in_uniform_air() {
        let line = line(0.5);
        let solution = line.solve(FRICTION).unwrap();
        let mut filament = SolidFilament::new(&line, &solution, OF_AIR);
        filament.at_start = OF_AIR + 1.0;
        let (along, across) = (-30.0_f64, 2.0_f64);
        let relative = (along * along + 64.0 * across * across).powf(1.0 / 6.0);
        let nusselt = 0.42 * (solution.final_diameter / 1.510e-5).cbrt() * relative;
        let per_kelvin = line.throughput * (2100.0 + 3.35 * 20.5);
        let share = PI * 0.02576 * nusselt * 0.2 / per_kelvin;
        let (temperature, heat) = cooled(&filament, 1, 0.2, [along, across]);
        let expected = (-share).exp();
        assert!(expected > 0.1 && expected < 0.9);
        // Air and polymer differ a little from those at 20.5 °C.
        assert!(((temperature - OF_AIR) / expected - 1.0).abs() < 3e-3, "{temperature} {expected}");
        assert!((heat / (per_kelvin * (1.0 - expected)) - 1.0).abs() < 3e-3, "{heat}");
        let transfer = filament.cool(OF_AIR + 1.0, 0.2, [along, across]).per_kelvin;
        assert!((transfer / (share * per_kelvin) - 1.0).abs() < 3e-3, "{transfer}");
    }

    /// What a spinline goes on to do is what its filament does below it.
    #[test]
    fn identical_cooling_below_a_spinline_and_of_a_longer_one() {
        let [short, long] = [0.3, 0.8].map(line);
        let [above, below] = [&short, &long].map(|line| line.solve(FRICTION).unwrap());
        let filament = SolidFilament::new(&short, &above, OF_AIR);
        let relative = [10.0 - 50.0, 1.0];
        let fallen = above.end().temperature - below.end().temperature;
        assert!(fallen > 10.0, "{fallen}");
        let off = |stretches: u32| {
            (cooled(&filament, stretches, 0.5, relative).0 - below.end().temperature).abs() / fallen
        };
        // Elements of 8 and 4 mm: four times better, down to the tolerance of the spinlines.
        assert!(off(125) < 1e-5 && off(8) < 1e-2, "{} {}", off(125), off(8));
        assert!(off(16) < 0.3 * off(8), "{} {}", off(16), off(8));
    }

    #[test]
    fn invariant_radiation_adds_to_the_heat_and_cold_filaments_take_it() {
        let mut line = line(0.5);
        let solution = line.solve(FRICTION).unwrap();
        let heat = |line: &Spinline, at_start: f64| {
            let mut filament = SolidFilament::new(line, &solution, OF_AIR);
            filament.at_start = at_start;
            cooled(&filament, 10, 0.5, [0.0, 0.0]).1
        };
        // Without wind there is radiation alone.
        assert_eq!(heat(&line, 350.0), 0.0);
        line.emissivity = 0.9;
        let surface = PI * solution.final_diameter * 0.5;
        let full = surface * 0.9 * STEFAN_BOLTZMANN * (350.0_f64.powi(4) - OF_AIR.powi(4));
        assert!(heat(&line, 350.0) < full && heat(&line, 350.0) > 0.8 * full);
        assert!(heat(&line, 280.0) < 0.0);
    }
}
