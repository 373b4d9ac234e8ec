//! Water that is held up by the fabric.

use super::Known;

/// Surface tension of water at 20 °C [N/m].
const TENSION: f64 = 0.0728;

/// Pressure at which water comes through the largest hole [Pa], `p = 2γ|cos θ|/r`: a lower bound, because
/// water that finds that hole still has to pass between all the fibres around it. None of a polymer that
/// water wets.                                                                                theory.md (113)
///
/// * `largest` – radius of the largest hole in the area of the test [m]
/// * `angle` – contact angle [rad]
pub fn hydrohead(largest: Known, angle: f64) -> Option<Known> {
    let radius = match largest {
        Known::Exact(radius) | Known::AtMost(radius) | Known::Between([_, radius]) => radius,
        Known::Value(radius, error) => radius + 2.0 * error?,
        Known::AtLeast(_) => return None,
    };
    let cosine = libm::cos(angle);
    (cosine < 0.0 && radius > 0.0).then(|| Known::AtLeast(-2.0 * TENSION * cosine / radius))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn published_hydrohead_of_a_hole_of_a_tenth_of_a_millimetre() {
        let angle = 105.0_f64.to_radians();
        let found = hydrohead(Known::Exact(100e-6), angle).map_or(f64::NAN, Known::value);
        assert!((found / 377.0 - 1.0).abs() < 1e-3, "{found}");
        let range = hydrohead(Known::Between([50e-6, 100e-6]), angle);
        assert_eq!(range, Some(Known::AtLeast(found)));
        assert_eq!(hydrohead(Known::Exact(100e-6), 1.0), None);
        assert_eq!(hydrohead(Known::AtLeast(100e-6), angle), None);
    }
}
