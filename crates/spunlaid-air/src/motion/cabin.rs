//! The pressure of the cabin above the slot, which blows the air through it.

use super::dry_air::PRESSURE;

/// Ratio of the heat capacities of air.
const GAMMA: f64 = 1.4;

/// A cabin of which the overpressure blows air through a slot into the open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cabin {
    /// Pressure above that under the belt [Pa].
    pub pressure: f64,
    /// Speed of the air at the slot over that of air without friction [-].
    pub coefficient: f64,
}

impl Cabin {
    /// A usual coefficient of a slot with smooth walls: it has not been measured for any spunbond line that we know.
    pub const COEFFICIENT: f64 = 0.9;

    /// A cabin of this pressure [Pa] with the usual coefficient.
    pub const fn new(pressure: f64) -> Self {
        Self { pressure, coefficient: Self::COEFFICIENT }
    }

    /// The cabin that gives the air this speed [m/s].                         theory.md (49c)
    ///
    /// * `density` – of the air at the end of the slot [kg/m³]
    pub fn of_speed(speed: f64, coefficient: f64, density: f64) -> Self {
        let square = (speed / coefficient).powi(2);
        let warming = 0.5 * (GAMMA - 1.0) / GAMMA * density * square / PRESSURE;
        Self { pressure: PRESSURE * power_less_one(warming, GAMMA / (GAMMA - 1.0)), coefficient }
    }

    /// Speed of the air at the end of the slot [m/s].                          theory.md (49b)
    ///
    /// * `density` – of the air there [kg/m³]
    pub fn speed(&self, density: f64) -> f64 {
        self.mach() * (GAMMA * PRESSURE / density).sqrt()
    }

    /// Speed of the air at the end of the slot over that of sound there [-].
    pub fn mach(&self) -> f64 {
        let warming = power_less_one(self.pressure / PRESSURE, (GAMMA - 1.0) / GAMMA);
        self.coefficient * (2.0 / (GAMMA - 1.0) * warming).sqrt()
    }
}

/// `(1 + x)^n − 1`, also of a small x.
fn power_less_one(x: f64, n: f64) -> f64 {
    libm::expm1(n * libm::log1p(x))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// NACA Report 1135 (1953), table of subsonic flow: p/p_t = 0.9395 at Mach 0.3, 0.7840 at 0.6, 0.5913 at 0.9.
    #[test]
    fn published_isentropic_flow() {
        for (mach, ratio) in [(0.3, 0.9395), (0.6, 0.7840), (0.9, 0.5913)] {
            let cabin = Cabin { pressure: PRESSURE * (1.0 / ratio - 1.0), coefficient: 1.0 };
            assert!((cabin.mach() / mach - 1.0).abs() < 5e-4, "{mach}: {}", cabin.mach());
        }
    }

    /// At small pressures Bernoulli's equation holds: v = c √(2 Δp/ρ).
    #[test]
    fn analytic_slow_air_follows_from_bernoullis_equation() {
        let speed = Cabin::new(10.0).speed(1.2);
        assert!((speed / (0.9 * (20.0_f64 / 1.2).sqrt()) - 1.0).abs() < 1e-4, "{speed}");
    }

    #[test]
    fn speed_and_pressure_give_each_other() {
        for pressure in [10.0, 3500.0, 60e3] {
            let cabin = Cabin { pressure, coefficient: 0.85 };
            let back = Cabin::of_speed(cabin.speed(1.15), 0.85, 1.15);
            assert!((back.pressure / pressure - 1.0).abs() < 1e-12, "{back:?}");
        }
    }
}
