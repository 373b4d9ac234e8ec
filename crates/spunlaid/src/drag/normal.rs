//! Drag laws across the fibre.

use std::f64::consts::PI;
use std::ops::RangeInclusive;

/// Drag law across the fibre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NormalLaw {
    /// `C_n = 6.96 Re^-0.440 (d/78 µm)^0.404`, fitted for 13–390 µm (Ju & Shambaugh 1994).
    JuShambaugh,
    /// One function of the Reynolds number that joins the theory of slow flow, measured cylinders and boundary-layer
    /// theory (Marheineke & Wegener 2011).
    MarheinekeWegener,
}

/// Constants of [`NormalLaw::JuShambaugh`]: factor, exponents of Re and of d, reference diameter [m].
pub(super) const JU_SHAMBAUGH: (f64, f64, f64, f64) = (6.96, 0.440, 0.404, 78e-6);

/// Reynolds numbers that separate the three pieces of [`NormalLaw::MarheinekeWegener`]: slow flow, transition,
/// boundary layer and wake [-].
pub(super) const PIECES: (f64, f64) = (0.1, 100.0);
/// Coefficients of the middle piece, by powers of `ln Re`. Value and slope are continuous at both ends. The source
/// gives five digits.
const BRIDGE: [f64; 4] = [
    1.691_089_891_757_472_3,
    -0.672_218_198_383_895_5,
    0.033_287_388_058_704_66,
    0.003_501_464_267_607_456_5,
];

impl NormalLaw {
    /// Every law.
    pub const ALL: [Self; 2] = [Self::JuShambaugh, Self::MarheinekeWegener];

    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::JuShambaugh => "ju-shambaugh",
            Self::MarheinekeWegener => "marheineke-wegener",
        }
    }

    /// The diameters to which the law was fitted [m]; `None` if the law depends on the Reynolds number alone.
    pub const fn fitted_diameters(self) -> Option<RangeInclusive<f64>> {
        match self {
            Self::JuShambaugh => Some(13e-6..=390e-6),
            Self::MarheinekeWegener => None,
        }
    }

    /// The Reynolds numbers the law holds for [-], as far as known here: those of Ju & Shambaugh are not; the
    /// other law follows measured cylinders up to 1e4.
    pub const fn fitted_reynolds(self) -> Option<RangeInclusive<f64>> {
        match self {
            Self::JuShambaugh => None,
            Self::MarheinekeWegener => Some(0.0..=1e4),
        }
    }

    /// Normal drag coefficient `C_n` [-].
    ///
    /// `C_n = 6.96 Re^-0.440 (d/d₀)^0.404`, `d₀ = 78 µm`                      theory.md (4),
    /// `C_n = 2 c_n(Re)` in three pieces                                      theory.md (44)
    ///
    /// * `re` – Reynolds number on diameter and normal velocity [-], `re > 0`
    /// * `diameter` – [m]; it matters to [`NormalLaw::JuShambaugh`] alone, fitted for 13–390 µm
    ///
    /// Sources: Ju & Shambaugh 1994; Marheineke & Wegener 2011, and Tomotika & Aoi 1951 for slow flow.
    pub fn coefficient(self, re: f64, diameter: f64) -> f64 {
        match self {
            Self::JuShambaugh => {
                let (a, b, c, d0) = JU_SHAMBAUGH;
                a * libm::pow(re, -b) * libm::pow(diameter / d0, c)
            }
            Self::MarheinekeWegener => 2.0 * resistance(re) / re,
        }
    }
}

/// `w c_n(w)` [-] of [`NormalLaw::MarheinekeWegener`], the line force by `ρνV`.  theory.md (44)
///
/// * `w` – Reynolds number on diameter and normal velocity [-], `w > 0`
pub(super) fn resistance(w: f64) -> f64 {
    let ln = libm::log(w);
    if w < PIECES.0 {
        // ln 8 + ½ − γ with the digits of the source.
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
            let (below, above) = (log(join - h) - log(join - 2.0 * h), log(join + 2.0 * h) - log(join + h));
            // Rounding of logarithms of some 1e-15, and h times a curvature below 0.2, over slopes of h.
            assert!((below - above).abs() < 0.2 * 4.0 * h * h, "{}", (below - above) / h);
            assert!((rise - below - above).abs() < 0.2 * 4.0 * h * h, "gap of {}", rise - below - above);
        }
    }
}
