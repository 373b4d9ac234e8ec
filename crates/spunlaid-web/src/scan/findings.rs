//! Everything that is found out about a scanned web.

use super::ScanWarning;
use super::picture::Picture;
use super::spots::ForeignParts;
use super::streaks::StreakSearch;
use super::weigh::{Light, Pixels};
use crate::map::uniformity::PatchCv;
use crate::map::{Clouds, Map};
use spunlaid_ground::Fault;

/// How a picture is read.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// What its values mean.
    pub light: Light,
    /// Whether that is only what is usual: then the notes say so.
    pub light_is_assumed: bool,
    /// A picture of the lamp without web, at the same exposure and of the same size: it takes the place of
    /// the level of the lamp and of the polynomial for its shading.
    pub lamp: Option<Picture>,
    /// Whether the lamp is taken as even. Maps of basis weight are never corrected.
    pub keep_shading: bool,
    /// Whether all of a picture is web. Otherwise the bare lamp beside it, dust and blots are left out of one in
    /// transmitted light, and the bare strips along the edges of a map.
    pub keep_spots: bool,
    /// Standard deviation of the noise of a single pixel, if it is known: its variance is taken out [levels].
    pub noise: Option<f64>,
    /// Mass per length of a filament, if it is known: then the length of fibre is known too [kg/m].
    pub titre: Option<f64>,
    /// Sides of the patches; if empty, usual ones up to a fifth of the picture [m].
    pub patches: Vec<f64>,
}

impl Settings {
    /// What is usual.
    pub const fn new(light: Light) -> Self {
        Self {
            light,
            light_is_assumed: false,
            lamp: None,
            keep_shading: false,
            keep_spots: false,
            noise: None,
            titre: None,
            patches: Vec::new(),
        }
    }
}

/// A scanned web.
#[derive(Clone, Debug)]
pub struct Findings {
    /// The map of its basis weight.
    pub map: Map,
    /// Whether the mean of the map is that of the sheet; otherwise it is 1 kg/m².
    pub mean_known: bool,
    /// Grey level of the lamp without web; none for a map of basis weight, and where there is a picture of the lamp.
    pub white: Option<f64>,
    /// Mean optical density; none for a map of basis weight.
    pub density: Option<f64>,
    /// How much brighter the lamp is at its brightest than at its darkest place, as a share, if that was taken out.
    pub shading: Option<f64>,
    /// Standard deviation of the noise of a single pixel, if it was given: its variance has been taken out [levels].
    pub noise: Option<f64>,
    /// Mass per length of a filament, if it was given [kg/m].
    pub titre: Option<f64>,
    /// Pixels that needed care.
    pub pixels: Pixels,
    /// What is only an assumed value about the lamp or the numbers, if anything: then nothing that depends on it has an
    /// interval.
    pub assumption: Option<ScanWarning>,
    /// The parts of the picture that are not web and were left out.
    pub aside: ForeignParts,
    /// How uneven it is, patch by patch.
    pub patches: Vec<PatchFindings>,
    /// Sizes of the clouds.
    pub clouds: Option<Clouds>,
    /// Autocorrelation coefficients of the basis weight in cross and in machine direction, pixel by pixel
    /// from lag zero.
    pub autocorrelation: [Vec<f64>; 2],
    /// Streaks along the machine; none if the scan is too small, or too short for its clouds.
    pub streaks: Option<StreakSearch>,
    /// What was assumed, corrected or left out, and what to do about it.
    pub notes: Vec<Fault>,
}

/// The CV over patches of one size.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PatchFindings {
    /// The CV, without the noise of the camera if that is known. It has no standard error where
    /// [`interval`](Self::interval) has none.
    pub patch_cv: PatchCv,
    /// The 95 % confidence interval of the CV of the web, of which this is a piece, or why none can be given.
    pub interval: Result<[f64; 2], ScanWarning>,
    /// CV of the noise of the camera over such patches: as given and taken out, or at most.
    pub noise: f64,
    /// Share by which one more pixel of blur lowers the CV; none of a map of basis weight, which no camera has
    /// blurred.
    pub blur: Option<f64>,
}

impl PatchFindings {
    /// Whether a blur of a pixel lowers the CV by less than one per cent.
    pub fn is_sharp(&self) -> bool {
        self.blur.is_none_or(|blur| blur < SHARP)
    }
}

/// Share of the CV that may be lost by one pixel of blur.
pub(super) const SHARP: f64 = 0.01;
