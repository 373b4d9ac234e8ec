//! How opaque the fabric is.

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

#[cfg(test)]
mod tests {
    use super::*;

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
