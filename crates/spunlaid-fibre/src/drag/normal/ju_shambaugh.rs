//! The law of Ju & Shambaugh, the paper's.

use super::{Form, Law, Source};

/// `C_n = 6.96 Re^-0.440 (d/d₀)^0.404`, `d₀ = 78 µm`                          theory.md (4)
///
/// The Reynolds numbers of the measurements are not known here.
///
/// It was fitted to filaments of 13 to 390 µm.
pub(super) const LAW: Law = Law {
    name: "ju-shambaugh",
    source: Source {
        short: "Ju and Shambaugh 1994",
        full: "Y. D. Ju, R. L. Shambaugh: Air drag on fine filaments at oblique and normal angles to the air \
            stream. Polymer Engineering and Science 34(12), 958–964, 1994.",
    },
    fitted_diameters: Some(13e-6..=390e-6),
    fitted_reynolds: None,
    form: Form::Power {
        exponent: EXPONENT,
        coefficient: |re, diameter| 6.96 * libm::pow(re, -EXPONENT) * libm::pow(diameter / 78e-6, 0.404),
    },
};

const EXPONENT: f64 = 0.440;
