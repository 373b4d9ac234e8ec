//! What is measured of a scanned web. Each measure is declared once: its name, label, unit, and how it is found. `summary.json`
//! and the report follow from it; the table of the terminal has its own columns.

use super::{PERCENT, Unit};
use crate::scan::{Findings, PatchFindings};

/// A measure of a scan, or of its patches of one size.
#[derive(Debug)]
pub struct ScanMeasure<T: 'static> {
    /// Name in `summary.json`, with its SI unit.
    pub name: &'static str,
    /// Its label in the report; empty if it stands in `summary.json` alone.
    pub label: &'static str,
    /// The unit in which it is shown.
    pub unit: Unit,
    /// Number of significant digits that are shown; zero for a count.
    pub digits: i32,
    /// Its value; none if this scan has none.
    pub number: fn(&T) -> Option<f64>,
}

impl<T> ScanMeasure<T> {
    /// A count, which stands in `summary.json` alone.
    const fn count(name: &'static str, number: fn(&T) -> Option<f64>) -> Self {
        Self { name, label: "", unit: PLAIN, digits: 0, number }
    }
}

/// No unit.
const PLAIN: Unit = Unit { shown: "", per_si: 1.0 };
/// Square millimetres.
const SQUARE_MILLIMETRES: Unit = Unit { shown: "mm²", per_si: 1e6 };

/// The measures of a scan, in the order of `summary.json`.
pub const OF_SCANS: &[ScanMeasure<Findings>] = &[
    ScanMeasure {
        name: "white",
        label: "Grey level of the lamp without web",
        unit: PLAIN,
        digits: 5,
        number: |scan| scan.white,
    },
    ScanMeasure {
        name: "mean_density",
        label: "Mean optical density ln(white/level)",
        unit: PLAIN,
        digits: 3,
        number: |scan| scan.density,
    },
    ScanMeasure {
        name: "shading",
        label: "Shading that was taken out, brightest over darkest",
        unit: PERCENT,
        digits: 2,
        number: |scan| scan.shading,
    },
    ScanMeasure { name: "noise", label: "", unit: PLAIN, digits: 3, number: |scan| scan.noise },
    ScanMeasure::count("filled_pixels", |scan| Some(scan.pixels.filled as f64)),
    ScanMeasure::count("saturated_pixels", |scan| Some(scan.pixels.saturated as f64)),
    ScanMeasure::count("lighter_pixels", |scan| Some(scan.pixels.lighter as f64)),
    ScanMeasure {
        name: "cut_off_m2",
        label: "Cut off beside the web, with the bare lamp",
        unit: SQUARE_MILLIMETRES,
        digits: 3,
        number: |scan| Some(scan.aside.cut_off),
    },
    ScanMeasure { name: "bare_lamp", label: "", unit: PLAIN, digits: 5, number: |scan| scan.aside.bare },
    ScanMeasure::count("dark_spots", |scan| Some(scan.aside.spots.len() as f64)),
    ScanMeasure {
        name: "dark_spots_m2",
        label: "",
        unit: SQUARE_MILLIMETRES,
        digits: 3,
        number: |scan| Some(scan.aside.masked),
    },
];

/// The measures of the patches of one size besides the unevenness and its interval.
pub const OF_SCANNED_PATCHES: &[ScanMeasure<PatchFindings>] = &[
    ScanMeasure {
        name: "cv_noise",
        label: "Noise of the camera",
        unit: PERCENT,
        digits: 2,
        number: |patch| Some(patch.noise),
    },
    ScanMeasure {
        name: "blur_of_a_pixel",
        label: "Lost by one more pixel of blur",
        unit: PERCENT,
        digits: 2,
        number: |patch| Some(patch.blur),
    },
];
