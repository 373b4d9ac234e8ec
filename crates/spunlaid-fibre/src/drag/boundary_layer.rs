//! The laminar boundary layer of a long cylinder.

/// A laminar boundary layer that grows along a cylinder, from the momentum integral of a logarithmic profile.
///
/// The velocity changes by the share `ln(r/a)/α` of the stream between the surface and `r = a e^α`. The viscous
/// force is then the same at every radius in the layer, as it is near the wall of a thin cylinder. The growth of
/// `α` with the distance follows from the momentum of the layer.               theory.md (42)
///
/// Near its start the layer is thin and equals that of a plate. Compared with the boundary-layer equations, its
/// friction is too low there by 8 % (moving) and 13 % (held), by 6 % at `X = 100`, and by 4 % at `X = 1e4`.
///
/// Sources: Sakiadis 1961, part III; Glauert & Lighthill 1955.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoundaryLayer {
    /// The cylinder leaves its origin and moves through fluid at rest.
    Moving,
    /// The cylinder is held and the fluid flows along it.
    Held,
}

impl BoundaryLayer {
    /// Distance `X = νx/(V a²)` [-] from the origin at which the layer has the thickness `α`. theory.md (43)
    ///
    /// * `thickness` – `α = ln(1 + δ/a)` [-], `α ≥ 0`
    ///
    /// Also the derivative `dX/dα`.
    fn distance(self, thickness: f64) -> (f64, f64) {
        // 2^m α^m/(m+2)!. All terms are positive; those beyond m = 2α + 40 are below 1e-17 of the sum.
        let mut term = thickness / 3.0;
        let (mut sum, mut slope) = (0.0, 0.0);
        let mut m = 1.0;
        while m < 2.0 * thickness + 40.0 {
            let share = match self {
                Self::Moving => m,
                Self::Held => 0.5 * m * m,
            };
            slope += share * term;
            sum += share * term / (m + 1.0);
            m += 1.0;
            term *= 2.0 * thickness / (m + 2.0);
        }
        (thickness * sum, slope)
    }

    /// Thickness `α = ln(1 + δ/a)` [-] of the layer: the stress at the surface is `ρνV/(a α)`. theory.md (43)
    ///
    /// * `distance` – `X = νx/(V a²)` [-] with the radius `a`, clamped to 1e-30–1e30
    pub fn thickness(self, distance: f64) -> f64 {
        let target = distance.clamp(1e-30, 1e30);
        let plate = match self {
            Self::Moving => 6.0,
            Self::Held => 12.0,
        };
        // Newton's method on ln X(ln α), which is convex and increasing, so that it converges from above.
        let mut thickness = libm::sqrt(plate * target).min(2.0 + libm::log(1.0 + target));
        for _ in 0..50 {
            let (reached, slope) = self.distance(thickness);
            let step = libm::log(reached / target) * reached / (slope * thickness);
            thickness *= libm::exp(-step);
            if step.abs() < 1e-15 {
                break;
            }
        }
        thickness
    }
}

#[cfg(test)]
mod tests {
    use super::BoundaryLayer::{self, Held, Moving};

    fn exact(layer: BoundaryLayer, a: f64) -> f64 {
        // X = ∫ α dI, I the momentum in the layer, by parts and Simpson's rule.
        let profile = |s: f64| match layer {
            Moving => (1.0 - s).powi(2),
            Held => s * (1.0 - s),
        };
        let simpson = |integrand: &dyn Fn(f64) -> f64, n: usize| {
            let weight = |i| {
                if i == 0 || i == n {
                    1.0
                } else if i % 2 == 1 {
                    4.0
                } else {
                    2.0
                }
            };
            (0..=n).map(|i| weight(i) * integrand(i as f64 / n as f64)).sum::<f64>() / (3.0 * n as f64)
        };
        let momentum = |a: f64| a * simpson(&|s| profile(s) * (2.0 * a * s).exp(), 400);
        a * momentum(a) - a * simpson(&|s| momentum(a * s), 400)
    }

    #[test]
    fn analytic_series_is_the_momentum_integral() {
        for layer in [Moving, Held] {
            for a in [0.01, 0.3, 1.0, 3.0, 6.0] {
                // Simpson's rule over steps of α/400: (2α/400)⁴/180 of the value, twice.
                let bound = 2.0 * (2.0 * a / 400.0f64).powi(4) + 1e-12;
                let (found, expected) = (layer.distance(a).0, exact(layer, a));
                assert!((found / expected - 1.0).abs() < bound, "{layer:?} {a}: {found} {expected}");
            }
        }
    }

    #[test]
    fn analytic_slope() {
        for layer in [Moving, Held] {
            for a in [0.01, 1.0, 10.0] {
                let h = 1e-5 * a;
                let difference = (layer.distance(a + h).0 - layer.distance(a - h).0) / (2.0 * h);
                assert!((layer.distance(a).1 / difference - 1.0).abs() < 1e-8 * (1.0 + a * a));
            }
        }
    }

    #[test]
    fn analytic_inverse() {
        for layer in [Moving, Held] {
            for k in -30..=30 {
                let x = 10f64.powi(k);
                let found = layer.distance(layer.thickness(x)).0;
                assert!((found / x - 1.0).abs() < 1e-12, "{layer:?} {x}: {found}");
            }
            for odd in [0.0, -1.0, f64::INFINITY, 1e300] {
                assert!(layer.thickness(odd).is_finite(), "{odd}");
            }
        }
    }

    #[test]
    fn analytic_plate_where_the_layer_is_thin() {
        // Momentum integral of a linear profile: δ² = 6νx/V where the plate moves, 12νx/V where it is held;
        // Sakiadis's and Blasius's exact plates have 0.4437 and 0.3321 of ρV²/√(Vx/ν), 8 % and 13 % more.
        let x = 1e-12f64;
        for (layer, squared, exact, short) in
            [(Moving, 6.0, 0.443_75f64, 0.08), (Held, 12.0, 0.332_06, 0.131)]
        {
            let stress = x.sqrt() / layer.thickness(x);
            // The next term of the series is of the order of α.
            assert!((stress * f64::sqrt(squared) - 1.0).abs() < 1e-5, "{layer:?} {stress}");
            assert!((1.0 - stress / exact - short).abs() < 0.001, "{layer:?} {stress}");
        }
    }

    #[test]
    fn analytic_logarithm_where_the_layer_is_thick() {
        // Held in a stream, 2α → ln 4X as Glauert & Lighthill and Stewartson found; the momentum integral
        // leaves 1 − 3/(2α) of the argument, so that 2α − ln 4X → 3/(2α). Moving, 2α → ln 4X + ln α.
        for k in [10, 20, 30] {
            let x = 10f64.powi(k);
            let rest = |layer: BoundaryLayer| 2.0 * layer.thickness(x) - (4.0 * x).ln();
            let a = Held.thickness(x);
            assert!((rest(Held) - 1.5 / a).abs() < 2.0 / (a * a), "{}", rest(Held));
            let a = Moving.thickness(x);
            assert!((rest(Moving) - a.ln() - 0.5 / a).abs() < 2.0 / (a * a), "{}", rest(Moving) - a.ln());
        }
    }
}
