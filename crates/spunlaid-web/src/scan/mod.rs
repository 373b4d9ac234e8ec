//! Webs as they are made: how even is a fabric of which there is a scan or a map of basis weight?
//!
//! file (PNG, TIFF, NumPy, CSV) → [`Picture`] → [`analyse`] → [`Findings`], with a [`Map`](crate::map::Map)
//! as that of a simulated web
//!
//! **The input** is a picture in transmitted light, whose grey levels are proportional to the light that
//! comes through, or a map of the basis weight itself.
//!
//! | format | what is read |
//! |---|---|
//! | PNG | 8 or 16 bits, or fewer as sBIT reports; colours become luminance; pixels that are not opaque have no value |
//! | TIFF | the first of the largest pages; 8, 16 or 32 bits or floating point, plain, Deflate, LZW, PackBits |
//! | NumPy | an array of two dimensions in C order, of numbers of 1 to 8 bytes, but no half floats |
//! | CSV | a line for each row of the map, as [`spunlaid_ground::table`] describes; an empty cell is a missing pixel |
//!
//! PNG and TIFF are turned as their orientation reports (Exif, TIFF tag 274). They give the side of a pixel by
//! their resolution, in the unit that ImageJ or OME-XML writes into the description, unless it is given. A PNG that
//! reports the basis weight of black in a text, [`WEIGHT_OF_BLACK`], is a map of basis weight; `spunlaid web` writes
//! such maps.
//!
//! **From light to basis weight**, by the law of Beer and Lambert: the optical density `ln(white/level)` is
//! proportional to the mass that the light has passed. Only ratios of densities count, so the absorption of
//! the polymer need not be known, and a camera that raises all levels to a power does no harm. A lamp that is
//! brighter in the middle is taken out with a picture of the lamp without web. Without one, a polynomial of
//! second order is fitted to the logarithm of the level and taken out: that is right for the fall of light
//! towards the corners of a lens, but a web of little density shows every rest of a lamp of another form,
//! enlarged by the inverse of the density.
//!
//! **Light that is thrown back** by light fibres on a black ground is another picture: heavy places are
//! light. By Kubelka's law for fibres that scatter and do not absorb, `R/(1 − R)` is proportional to the
//! mass, with the reflectance R over that of a web so thick that the ground is not visible. A picture does
//! not show which of the two it is, so it is taken as transmitted light unless the reader says otherwise, and
//! the notes say so.
//!
//! **The results** are those of a simulated map: CV over patches with standard errors, clouds,
//! autocorrelation. For each patch they also give how much the noise of the camera and the blur of its optics
//! count there.
//!
//! **What is no web** is cut off: pixels without a value along the edges, the bare lamp or a lid around the web, the
//! bare strips along the edges of a map, and rows that are all the same because a scan was not finished.
//!
//! **Limits.** At most [`MOST_PIXELS`] pixels and at least [`LEAST_SIDE`] either way. Up to one pixel in a
//! hundred may say nothing; it is filled in from its row.
//!
//! ```
//! use spunlaid_web::scan::{Light, Settings, analyse, parse};
//!
//! # fn main() -> Result<(), spunlaid_ground::error::FileError> {
//! // A map of 40 by 40 pixels of 1 mm, in g/m².
//! let row = |y: u32| (0..40).map(|x| format!("{}", 14 + (x * x + 3 * x * y) % 5)).collect::<Vec<_>>().join(",");
//! let text: String = (0..40).map(|y| row(y) + "\n").collect();
//! let picture = parse(text.as_bytes(), "gauge.csv", 1e-3)?;
//! let light = Light::Weight { mean: Some(16e-3) };
//! let found = analyse(&picture, &Settings { patches: vec![2e-3], ..Settings::new(light) })?;
//! assert!((found.map.basis_weight() / 16e-3 - 1.0).abs() < 1e-12);
//! assert!(found.patches[0].patch_cv.cv < 0.1);
//! # Ok(())
//! # }
//! ```

mod analyse;
mod border;
mod chance;
mod findings;
mod frame;
mod lamp;
mod levels;
mod measures;
mod note;
mod optics;
mod picture;
mod read;
mod request;
mod spots;
mod streaks;
mod weigh;

pub use analyse::analyse;
pub use findings::{Findings, PatchFindings, Settings};
pub use levels::flattened;
pub use measures::{
    SCAN_MEASURES, SCAN_PERIOD_MEASURES, SCAN_STREAK_MEASURES, SCANNED_PATCH_MEASURES, STREAK_LIMIT_MEASURES,
};
pub use optics::shortest_sharp_wave;
pub use picture::{Format, Picture};
pub use read::{CELL, WEIGHT_OF_BLACK, parse, read};
pub use request::{LightKind, ScanRequest, columns_of_map, is_picture_file};
pub use spots::{ForeignParts, Spot};
use std::fmt;
pub use streaks::{ScanPeriod, ScanStreak, StreakLimit, StreakSearch, WIDTH};
pub use weigh::{Light, Pixels};

/// A sheet that is less than so many patches wide or long reports nothing about the web.
pub const FEWEST: usize = 4;

named! {
    /// Why the true CV over patches of a size cannot be known from a picture.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum ScanWarning {
        /// The level of the lamp without web is an assumed value: all CVs may be wrong by the same factor.
        White = "the level of the lamp is an assumed value",
        /// The shading of the lamp is an assumed value: a polynomial took it out, with what the web varies as smoothly.
        Shading = "the shading of the lamp is an assumed value",
        /// The picture of the lamp is clipped.
        ClippedLamp = "the image of the lamp is clipped",
        /// The picture of the lamp is darker than that of the web.
        DarkLamp = "the image of the lamp is darker than that of the web",
        /// What is taken as basis weights may be grey levels.
        GreyLevels = "the numbers may be grey levels and not basis weights",
        /// The blur of the camera has lowered the CV.
        Blur = "below the blur of the scan",
        /// The sheet holds too few such patches.
        Few = "the sheet holds too few such patches",
    }
}

impl fmt::Display for ScanWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl ScanWarning {
    /// What makes all numbers of a picture doubtful, by its name in files.
    pub const ASSUMPTIONS: [(&'static str, Self); 5] = [
        ("lamp", Self::White),
        ("shading", Self::Shading),
        ("clipped_lamp", Self::ClippedLamp),
        ("dark_lamp", Self::DarkLamp),
        ("grey_levels", Self::GreyLevels),
    ];
}
