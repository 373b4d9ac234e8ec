//! What is measured of a scanned web. `summary.json`, the report, the terminal and Python follow from it.

use super::streaks::WIDTH;
use super::{Findings, PatchFindings, ScanPeriod, ScanStreak, StreakLimit};
use Formula::{Count, Known, Number, Reported};
use spunlaid_ground::{ErrorRole, Formula, Known as What, MILLIMETRES, Measure, PERCENT, RATIO, Unit};

type OfScan = Measure<Findings>;
type OfPatch = Measure<PatchFindings>;
type OfStreak = Measure<ScanStreak>;
type OfPeriod = Measure<ScanPeriod>;
type OfLimit = Measure<StreakLimit>;

/// The measures of a scan, in the order of `summary.json`; what has no label stands there alone.
pub const SCAN_MEASURES: &[Measure<Findings>] = &[
    OfScan::new("white", "Grey level of the lamp without web", RATIO, Known(|scan| scan.white))
        .meaning("grey level of the lamp without web; none with an image of the lamp")
        .digits(5),
    OfScan::new("mean_density", "Mean optical density ln(white/level)", RATIO, Known(|scan| scan.density))
        .meaning("mean over the web of ln(white/level)")
        .digits(3),
    OfScan::new(
        "shading",
        "Shading that was taken out, brightest over darkest",
        PERCENT,
        Known(|scan| scan.shading),
    )
    .meaning("brightest over darkest part of the lamp, if shading was taken out")
    .digits(2),
    OfScan::new("noise", "", RATIO, Known(|scan| scan.noise))
        .meaning("standard deviation of the noise of a pixel, in levels, if it was given and taken out"),
    OfScan::new("filled_pixels", "", RATIO, Count(|scan| scan.pixels.filled as u64))
        .meaning("pixels without a value, black ones included, filled in along their row"),
    OfScan::new("saturated_pixels", "", RATIO, Count(|scan| scan.pixels.saturated as u64))
        .meaning("pixels of the largest grey level, where there may have been more light"),
    OfScan::new("lighter_pixels", "", RATIO, Count(|scan| scan.pixels.lighter as u64))
        .meaning("pixels lighter than the lamp, which count as empty"),
    OfScan::new(
        "cut_off_m2",
        "Cut off next to the web",
        SQUARE_MILLIMETRES,
        Number(|scan| scan.aside.cut_off),
    )
    .meaning("area next to the web that was cut off")
    .digits(3),
    OfScan::new("bare_lamp", "", RATIO, Known(|scan| scan.aside.bare))
        .meaning("median grey level of the bare lamp next to the web"),
    OfScan::new("dark_spots", "", RATIO, Count(|scan| scan.aside.spots.len() as u64))
        .meaning("dark spots on the web, which count for no patch"),
    OfScan::new("dark_spots_m2", "", SQUARE_MILLIMETRES, Number(|scan| scan.aside.masked))
        .meaning("area of the dark spots"),
];

/// The measures of the patches of one size, in the order of `summary.json`, where the interval follows the first.
pub const SCANNED_PATCH_MEASURES: &[Measure<PatchFindings>] = &[
    OfPatch::new("cv", "CV", PERCENT, Number(|patch| patch.patch_cv.cv))
        .meaning("coefficient of variation of the basis weight over square patches")
        .errors(&[OfPatch::new(
            "cv_standard_error",
            "Sampling error of the CV",
            PERCENT,
            Known(|patch| patch.patch_cv.standard_error),
        )
        .meaning("standard error of the CV between pieces of the same web")
        .role(ErrorRole::OfOne)]),
    OfPatch::new("cv_noise", "Noise of the pixels", PERCENT, Number(|patch| patch.noise))
        .meaning("CV of the noise of the camera: as given and taken out, or at most")
        .short("pixel noise")
        .digits(2),
    OfPatch::new("blur_of_a_pixel", "Lost by one more pixel of blur", PERCENT, Known(|patch| patch.blur))
        .meaning("fraction by which one more pixel of blur lowers the CV")
        .short("lost by blur")
        .digits(2),
];

/// The measures of a streak of a scan.
pub const SCAN_STREAK_MEASURES: &[Measure<ScanStreak>] = &[
    OfStreak::new("place_m", "Position", MILLIMETRES, Reported(|streak| Some(What::Exact(streak.place))))
        .meaning("middle of the streak, from the left edge of the web"),
    OfStreak::new("amplitude", "Amplitude", PERCENT, Reported(|streak| Some(streak.height())))
        .meaning("how much heavier the web is there than next to it; below zero where it is lighter"),
    OfStreak::new(
        "width_m",
        "Width",
        MILLIMETRES,
        Reported(|streak| Some(What::Exact(WIDTH * streak.sigma))),
    )
    .meaning("width at half of the amplitude of the normal profile that fits best"),
    OfStreak::new(
        "width_range_m",
        "95 % interval of the width",
        MILLIMETRES,
        Reported(|streak| Some(streak.widths())),
    )
    .meaning("widths of normal profiles that fit hardly worse"),
    OfStreak::new("chance", "p-value", PERCENT, Reported(|streak| Some(What::AtMost(streak.chance))))
        .meaning("probability that clouds alone make a streak as clear, of any width at any position")
        .digits(2),
];

/// The measures of a period of a scan across the machine direction.
pub const SCAN_PERIOD_MEASURES: &[Measure<ScanPeriod>] = &[
    OfPeriod::new("period_m", "Period", MILLIMETRES, Reported(|wave| Some(What::Exact(wave.period))))
        .meaning("distance of streaks that repeat"),
    OfPeriod::new("amplitude", "Amplitude", PERCENT, Reported(|wave| Some(wave.height())))
        .meaning("half of the way from the lightest to the heaviest part of the wave"),
    OfPeriod::new("chance", "p-value", PERCENT, Reported(|wave| Some(What::AtMost(wave.chance))))
        .meaning("probability that clouds alone make a wave as strong, of any length")
        .digits(2),
];

/// The least streaks that a scan can show.
pub const STREAK_LIMIT_MEASURES: &[Measure<StreakLimit>] = &[
    OfLimit::new("width_m", "Width", MILLIMETRES, Reported(|limit| Some(What::Exact(WIDTH * limit.sigma))))
        .meaning("width of a streak at half of its amplitude"),
    OfLimit::new(
        "amplitude",
        "Least amplitude",
        PERCENT,
        Reported(|limit| Some(What::Exact(limit.amplitude))),
    )
    .meaning("amplitude from which on such a streak is significant at 95 %"),
];

const SQUARE_MILLIMETRES: Unit = Unit { shown: "mm²", per_si: 1e6 };
