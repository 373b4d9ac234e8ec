//! Stiffness along MD and CD that follows from the directions of the fibres.

use super::Known;
use crate::web::Orientation;
use std::f64::consts::PI;

/// Stiffness along MD over that along CD of straight fibres that follow the strain of the sheet,
/// `⟨cos⁴⟩/⟨sin⁴⟩`. Its error is that of the directions alone; curl and bonds are not in it.
///                                                                                            theory.md (105)
///
/// Source: H. L. Cox, Br. J. Appl. Phys. 3 (1952) 72–79.
pub fn stiffness_ratio(orientation: &Orientation) -> Known {
    let classes = orientation.directions;
    let width = 2.0 * PI / classes.len() as f64;
    let whole: f64 = classes.iter().sum();
    let mean_cosine = |number: f64| {
        let middle = |i: usize| (i as f64 + 0.5) * width;
        let sum: f64 =
            classes.iter().enumerate().map(|(i, share)| share * libm::cos(number * middle(i))).sum();
        // Classes blur the directions, by as much as the mean over one does to the wave.
        let half = 0.5 * number * width;
        sum / whole * half / libm::sin(half)
    };
    let (second, fourth) = (mean_cosine(2.0), mean_cosine(4.0));
    let [md, cd] = [0.5, -0.5].map(|sign| 0.375 + sign * second + 0.125 * fourth);
    let ratio = md / cd;
    // Of ⟨cos 2θ⟩ = 2⟨cos²⟩ − 1, whose chance counts most.
    let error = orientation.cos_squared.standard_error.map(|error| ratio * error * (1.0 / md + 1.0 / cd));
    Known::Value(ratio, error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::Estimate;

    fn of_density(share: f64) -> f64 {
        let classes = Orientation::DIRECTIONS;
        let edge = |i: usize| 2.0 * PI * i as f64 / classes as f64;
        let below = |angle: f64| (angle + 0.5 * share * libm::sin(2.0 * angle)) / (2.0 * PI);
        let cos_squared = Estimate { mean: 0.5 + 0.25 * share, standard_error: None, values: Vec::new() };
        let directions = std::array::from_fn(|i| below(edge(i + 1)) - below(edge(i)));
        stiffness_ratio(&Orientation { cos_squared, directions }).value()
    }

    #[test]
    fn analytic_the_ratio_of_stiffness_of_directions_with_a_cosine() {
        for (share, expected) in [(0.0, 1.0), (0.4, 1.727_272_7), (0.8, 3.285_714_3)] {
            let found = of_density(share);
            assert!((found / expected - 1.0).abs() < 1e-6, "{share}: {found}");
        }
    }
}
