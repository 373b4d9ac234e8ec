//! The law of Marheineke & Wegener: slow flow in theory, measured cylinders, boundary layer and wake.

use super::{Form, Law, Source};
use std::f64::consts::PI;

/// `C_n = 2 c_n(Re)` in three pieces                                       theory.md (44)
///
/// It follows measured cylinders up to a Reynolds number of 1e4.
///
/// Tomotika & Aoi 1951 gave the theory of slow flow.
pub(super) const LAW: Law = Law {
    name: "marheineke-wegener",
    source: Source {
        short: "Marheineke and Wegener 2011",
        full: "N. Marheineke, R. Wegener: Modeling and application of a stochastic drag for fibers in \
            turbulent flows. International Journal of Multiphase Flow 37(2), 136–148, 2011.",
    },
    fitted_diameters: None,
    fitted_reynolds: Some(0.0..=1e4),
    form: Form::Curve { resistance, joins: Some(PIECES) },
};

/// Reynolds numbers at which the law goes from slow flow over to boundary layer and wake
/// [-].
const PIECES: (f64, f64) = (0.1, 100.0);
/// Coefficients between, by powers of `ln Re`: those with which value and slope go on at both ends. The source
/// has them to five digits.
const BRIDGE: [f64; 4] = [
    1.691_089_891_757_472_3,
    -0.672_218_198_383_895_5,
    0.033_287_388_058_704_66,
    0.003_501_464_267_607_456_5,
];

/// `w c_n(w)` [-] of the law, the line force by `ρνV`.  theory.md (44)
///
/// * `w` – Reynolds number on diameter and normal velocity [-], `w > 0`
fn resistance(w: f64) -> f64 {
    let ln = libm::log(w);
    if w < PIECES.0 {
        // ln 8 + ½ − γ, to the digits that the law was fitted with.
        let s = 2.0022 - ln;
        4.0 * PI / s * (1.0 - w * w * (s * s - 0.5 * s + 0.3125) / (32.0 * s))
    } else if w <= PIECES.1 {
        let [p0, p1, p2, p3] = BRIDGE;
        w * libm::exp(p0 + ln * (p1 + ln * (p2 + ln * p3)))
    } else {
        2.0 * libm::sqrt(w) + 0.5 * w
    }
}

#[cfg(test)]
mod tests {
    use super::{BRIDGE, PIECES, resistance};

    #[test]
    fn published_coefficients_are_those_that_join_smoothly() {
        // Marheineke & Wegener print 1.6911, −6.7222e-1, 3.3287e-2, 3.5015e-3.
        for (ours, printed, digits) in [
            (BRIDGE[0], 1.6911, 4),
            (BRIDGE[1], -0.67222, 5),
            (BRIDGE[2], 0.033287, 6),
            (BRIDGE[3], 0.0035015, 7),
        ] {
            assert!((ours - printed).abs() <= 0.5 * 10f64.powi(-digits), "{ours} {printed}");
        }
        let log = |ln: f64| resistance(ln.exp()).ln();
        for join in [PIECES.0, PIECES.1].map(f64::ln) {
            let h = 1e-5;
            let rise = log(join + h) - log(join - h);
            let below = log(join - h) - log(join - 2.0 * h);
            let above = log(join + 2.0 * h) - log(join + h);
            // Rounding of logarithms of some 1e-15, and h times a curvature below 0.2, over slopes of h.
            assert!((below - above).abs() < 0.2 * 4.0 * h * h, "{}", (below - above) / h);
            assert!((rise - below - above).abs() < 0.2 * 4.0 * h * h, "gap of {}", rise - below - above);
        }
    }
}
