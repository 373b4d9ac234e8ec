//! How opaque the fabric is.

use super::patches::weights;
use crate::map::uniformity::PatchCv;
use crate::map::{Map, straight_fibres};
use spunlaid_ground::Known;

/// Reflectance of the white behind the sheet when its opacity is measured.
const WHITE: f64 = 0.89;

/// Opacity of a sheet that scatters and does not absorb.                         theory.md (109)
///
/// * `scattering` – coefficient of scattering times basis weight
///
/// Source: P. Kubelka, F. Munk, Z. Techn. Physik 12 (1931) 593–601; opacity as in ISO 2471.
pub fn opacity(scattering: f64) -> f64 {
    let black = scattering / (1.0 + scattering);
    black / (black + (1.0 - black).powi(2) * WHITE / (1.0 - WHITE * black))
}

/// The coefficient of scattering times basis weight of a sheet of this opacity.
///
/// * `measured` – from above 0 to below 1
pub fn scattering(measured: f64) -> f64 {
    // The opacity grows with the scattering.
    let (mut low, mut high) = (0.0, 1.0);
    while opacity(high) < measured && high < 1e9 {
        high *= 2.0;
    }
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if opacity(middle) < measured { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Side of the patches over which the weight is local [m].
pub(super) const LOCAL: f64 = 2e-3;

/// The weight about each place over the mean. Patches of straight fibres at random differ by chance, which
/// formulas for fibres at random know already; so the deviations from the mean are lowered until they vary by
/// as much as the web varies more than straight fibres do.                                    theory.md (111)
///
/// * `length` – of fibre per area of the sheet [1/m]
/// * `found` – the CV over patches of 2 mm
pub(crate) fn local_weights(map: &Map, length: f64, found: &PatchCv) -> Vec<f64> {
    let (_, weights) = weights(map, found.patch);
    let variance = weights.iter().map(|weight| (weight - 1.0).powi(2)).sum::<f64>() / weights.len() as f64;
    let of_clouds = (found.cv * found.cv - straight_fibres(length, found.patch).powi(2)).max(0.0);
    let lower = if variance > 0.0 { (of_clouds / variance).sqrt() } else { 0.0 };
    weights.into_iter().map(|weight| (1.0 + lower * (weight - 1.0)).max(0.0)).collect()
}

/// The share of the sheet that no fibre covers, `⟨exp(−τd)⟩`, where τ is the length of fibre per area about a
/// place, as it was fed: what round fibres leave bare that lie independently of each other within 2 mm.
///                                                                                            theory.md (110)
///
/// * `local` – of `local_weights`
/// * `length` – of fibre per area of the sheet [1/m]
/// * `error` – of this length, as a fraction of it
/// * `diameter` – of the fibres, the mean over their length [m]
/// * `found` – the CV over patches of 2 mm; its error becomes that of the share
pub fn bare_area(local: &[f64], length: f64, error: f64, diameter: f64, found: &PatchCv) -> Known {
    let covered = length * diameter;
    let share = local.iter().map(|weight| libm::exp(-covered * weight)).sum::<f64>() / local.len() as f64;
    // It grows with the clouds, whose chance is that of the CV, and all of it falls with τd.           theory.md (113)
    let of_clouds = found.cv * found.cv - straight_fibres(length, found.patch).powi(2);
    let by_clouds = |error: f64| share * growth_with_clouds(covered, of_clouds.max(0.0)) * found.cv * error;
    Known::Value(share, found.standard_error.map(|chance| by_clouds(chance).hypot(share * covered * error)))
}

/// By which share the bare area grows with half of the squared variation c² of the clouds.   theory.md (112), (113)
fn growth_with_clouds(covered: f64, square: f64) -> f64 {
    let x = covered * square;
    // Close to a uniform web the difference of two large numbers is that of its series.
    if x < 1e-3 {
        return covered * covered * (1.0 - 4.0 / 3.0 * x);
    }
    2.0 * libm::log1p(x) / (square * square) - 2.0 * covered / (square * (1.0 + x))
}

/// The formation number: CV² over that of straight fibres at random of the same mass, which have 1.   theory.md (102)
///
/// Source: C. T. J. Dodson, J. R. Stat. Soc. B 33 (1971) 88–94, as W. W. Sampson, Modelling Stochastic
/// Fibrous Materials (2009), uses it for paper.
pub fn formation(found: &PatchCv, straight_fibres: f64) -> Known {
    let number = (found.cv / straight_fibres).powi(2);
    Known::Value(number, found.standard_error.map(|error| 2.0 * number * error / found.cv))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By differences of (112), from a uniform web to one in which only thin spots are bare.
    #[test]
    fn analytic_the_bare_area_grows_with_the_clouds() {
        let logarithm = |covered: f64, square: f64| -libm::log1p(covered * square) / square;
        for (covered, square) in [(0.5, 1e-4), (2.0, 0.01), (8.3, 0.1), (8.3, 0.3)] {
            let step = 1e-4 * square;
            let by_hand = (logarithm(covered, square + step) - logarithm(covered, square - step)) / step;
            let found = growth_with_clouds(covered, square);
            assert!((found / by_hand - 1.0).abs() < 1e-3, "{covered} {square}: {found} {by_hand}");
        }
    }

    /// The next term of the series is 3/2 x². In a uniform web the growth is τ²d².
    #[test]
    fn order_the_growth_close_to_a_uniform_web() {
        for (x, within) in [(1e-9, 1e-12), (0.999e-3, 2e-6), (1.001e-3, 1e-8)] {
            let covered = 2.0;
            let found = growth_with_clouds(covered, x / covered) / (covered * covered);
            assert!((found - (1.0 - 4.0 / 3.0 * x + 1.5 * x * x)).abs() < within, "{x}: {found}");
        }
    }

    /// The error is that of `(1 + τdc²)^(−1/c²)` by the CV and of `exp(−τd)` by the length.
    #[test]
    fn analytic_the_error_of_the_bare_area() {
        let length = 80e3;
        let diameter = 18e-6;
        let patch = 2e-3;
        let error = 1e-5;
        let covered = length * diameter;
        let by_chance = straight_fibres(length, patch).powi(2);
        let cv = (0.1 + by_chance).sqrt();
        let logarithm = |cv: f64| {
            let square = cv * cv - by_chance;
            -libm::log1p(covered * square) / square
        };
        let by_cv = 0.5 * (logarithm(cv + error) - logarithm(cv - error));
        for of_length in [0.0, 1e-5] {
            let found = PatchCv { patch, cv, standard_error: Some(error) };
            let found = bare_area(&[0.8, 1.2], length, of_length, diameter, &found);
            let share = 0.5 * (libm::exp(-0.8 * covered) + libm::exp(-1.2 * covered));
            let Known::Value(value, Some(error)) = found else { panic!("{found:?}") };
            let wanted = share * by_cv.hypot(covered * of_length);
            assert!(
                (value / share - 1.0).abs() < 1e-12 && (error / wanted - 1.0).abs() < 1e-6,
                "{error} {wanted}"
            );
        }
    }

    #[test]
    fn analytic_opacity_and_scattering_are_inverses() {
        for measured in [0.05, 0.3, 0.6, 0.9, 0.99] {
            let found = opacity(scattering(measured));
            assert!((found - measured).abs() < 1e-12, "{measured}: {found}");
        }
        assert!(opacity(0.0).abs() < 1e-15);
    }

    /// Over a black and over a white ground: with the light that goes forth and back between sheet and ground
    /// summed bounce by bounce.
    #[test]
    fn analytic_opacity_from_the_bounces_of_the_light() {
        for scattering in [0.1, 1.0, 5.0] {
            let (back, through): (f64, f64) = (scattering / (1.0 + scattering), 1.0 / (1.0 + scattering));
            let bounces: f64 = (0..2000).map(|n| through * WHITE * (back * WHITE).powi(n) * through).sum();
            let expected = back / (back + bounces);
            assert!((opacity(scattering) - expected).abs() < 1e-12, "{scattering}");
        }
    }
}
