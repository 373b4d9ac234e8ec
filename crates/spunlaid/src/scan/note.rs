//! What a reader of the results must know about the picture.

use super::findings::{Aside, Doubt, PatchFindings, Settings};
use super::picture::Picture;
use super::weigh::{Light, Weighed};
use crate::units::{Dimension, shortest};
use std::fmt;

/// Something that was assumed, corrected or left out.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Note {
    /// The side of a pixel is that of the file.
    PixelOfFile {
        /// It [m].
        pixel: f64,
    },
    /// The file tells another side of a pixel than the given one.
    OtherPixel {
        /// As given [m].
        given: f64,
        /// As the file tells it [m].
        of_file: f64,
    },
    /// Only the luminance of a picture in colours was used.
    Colour,
    /// The file has more pictures than the first.
    OnlyTheFirst,
    /// The lamp was not given.
    White {
        /// Level that was taken in its place.
        white: f64,
        /// Whether it is the largest that the file can hold, or else the largest that it holds.
        full_scale: bool,
    },
    /// The mean weight was not given.
    Relative,
    /// Values were taken as basis weights in kg/m².
    Kilograms {
        /// Their mean [kg/m²].
        mean: f64,
    },
    /// The lamp was found uneven and corrected.
    Shading {
        /// How much brighter its brightest place is than its darkest, as a share.
        share: f64,
    },
    /// Pixels without a value were filled in.
    Filled {
        /// How many.
        pixels: usize,
    },
    /// Some pixels are as light as can be.
    Saturated {
        /// How many.
        pixels: usize,
        /// As a share of all.
        share: f64,
    },
    /// Some pixels are lighter than the lamp without web.
    Lighter {
        /// How many.
        pixels: usize,
        /// As a share of all.
        share: f64,
    },
    /// The bare lamp is seen beside the web, and the web was cut out.
    Bare {
        /// Area that was cut off [m²].
        area: f64,
        /// Median grey level of the bare lamp, over its picture if there is one.
        level: f64,
        /// Whether there is a picture of the lamp.
        over_lamp: bool,
    },
    /// Dark spots on the web were left out.
    Dark {
        /// How many.
        spots: usize,
        /// Their area [m²].
        area: f64,
        /// Area of the largest one [m²].
        largest: f64,
        /// Its middle, from the left and the upper edge of the picture [m].
        place: [f64; 2],
    },
    /// Large patches are too few.
    Few {
        /// The smallest patch of which there are too few [m].
        from: f64,
    },
    /// Small patches are lowered by the blur of the optics.
    Blur {
        /// The smallest patch for which a pixel of blur does not matter, if there is one [m].
        from: Option<f64>,
    },
}

/// Heaviest web that is believed [kg/m²].
const HEAVIEST: f64 = 2.0;
/// A larger difference between two sides of a pixel is not one of rounding.
const OTHER: f64 = 0.01;
/// Dots per inch that programs write into files when they do not know the resolution.
const UNKNOWN: [f64; 2] = [72.0, 96.0];
/// A larger share of pixels changes the CV.
const MANY: f64 = 1e-3;

/// The notes on a picture, in the order of their use.
pub(super) fn notes(
    picture: &Picture,
    settings: &Settings,
    of: &Weighed,
    patches: &[PatchFindings],
    aside: &Aside,
) -> Vec<Note> {
    let share = |pixels: usize| pixels as f64 / picture.values.len() as f64;
    let pixels = of.pixels;
    let white = match (settings.light, of.white) {
        (Light::Transmitted { white: None, .. }, Some(white)) => {
            Some(Note::White { white, full_scale: picture.full_scale.is_some() })
        }
        _ => None,
    };
    let in_kilograms = settings.light == Light::Weight { mean: None } && picture.weight_of_black.is_none();
    let lamp = of.shading.as_ref().map(|shading| libm::expm1(shading.range()));
    let blurred = patches.first().is_some_and(|patch| !patch.is_sharp());
    let sharp = || patches.iter().find(|patch| patch.is_sharp()).map(|patch| patch.unevenness.patch);
    let few = patches.iter().find(|patch| patch.interval == Err(Doubt::Few));
    let pixel = picture.pixel_of_file.and_then(|of_file| {
        let given = picture.pixel;
        if (given / of_file - 1.0).abs() > OTHER {
            Some(Note::OtherPixel { given, of_file })
        } else {
            // A map tells its cells itself.
            (given == of_file && picture.weight_of_black.is_none())
                .then_some(Note::PixelOfFile { pixel: given })
        }
    });
    let told = [
        pixel,
        picture.colour.then_some(Note::Colour),
        picture.more.then_some(Note::OnlyTheFirst),
        white,
        (!of.mean_known).then_some(Note::Relative),
        in_kilograms.then(|| Note::Kilograms { mean: of.map.basis_weight() }),
        lamp.map(|share| Note::Shading { share }),
        aside.bare.map(|level| Note::Bare { area: aside.cut_off, level, over_lamp: settings.lamp.is_some() }),
        aside.spots.first().map(|largest| Note::Dark {
            spots: aside.spots.len(),
            area: aside.masked,
            largest: largest.area,
            place: largest.place,
        }),
        (pixels.filled > 0).then_some(Note::Filled { pixels: pixels.filled }),
        (pixels.saturated > 0)
            .then(|| Note::Saturated { pixels: pixels.saturated, share: share(pixels.saturated) }),
        (pixels.lighter > 0).then(|| Note::Lighter { pixels: pixels.lighter, share: share(pixels.lighter) }),
        blurred.then(|| Note::Blur { from: sharp() }),
        few.map(|patch| Note::Few { from: patch.unevenness.patch }),
    ];
    told.into_iter().flatten().collect()
}

/// `12 mm²`.
fn square(area: f64) -> String {
    let digits: f64 = format!("{:.2e}", 1e6 * area).parse().unwrap_or(f64::NAN);
    format!("{} mm²", shortest(digits))
}

/// `0.25 %`.
fn per_cent(share: f64) -> String {
    let digits: f64 = format!("{:.1e}", 100.0 * share).parse().unwrap_or(f64::NAN);
    format!("{} %", shortest(digits))
}

impl fmt::Display for Note {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::PixelOfFile { pixel } => {
                let dots = 25.4e-3 / pixel;
                write!(
                    f,
                    "a pixel is {} wide, as the file says ({} dots per inch)",
                    Dimension::Length.pretty_to(*pixel, 4),
                    shortest((dots * 10.0).round() / 10.0)
                )?;
                if UNKNOWN.iter().any(|unknown| (dots / unknown - 1.0).abs() < OTHER) {
                    f.write_str("; many programs write this when they do not know it, so measure it and give the side of a pixel")?;
                }
                Ok(())
            }
            Self::OtherPixel { given, of_file } => write!(
                f,
                "a pixel is taken to be {} wide as given, and the file says {}",
                Dimension::Length.pretty_to(*given, 4),
                Dimension::Length.pretty_to(*of_file, 4)
            ),
            Self::Colour => f.write_str("the picture has colours, and only its luminance is used"),
            Self::OnlyTheFirst => f.write_str("the file has several pictures, and only the first is used"),
            Self::White { white, full_scale } => write!(
                f,
                "the lamp without web is taken to have the grey level {}, the largest that the file {}. If it has not, every CV is \
                 wrong by the same factor, and nothing in the picture tells, so no interval is told: take a picture of the lamp at the same exposure",
                shortest(*white),
                if *full_scale { "can hold" } else { "holds" }
            ),
            Self::Relative => f.write_str(
                "the mean basis weight is not known, so all basis weights are told as parts of it",
            ),
            Self::Kilograms { mean } => {
                write!(
                    f,
                    "the values are taken as basis weights in kg/m², with a mean of {}",
                    Dimension::BasisWeight.pretty(*mean)
                )?;
                if *mean > HEAVIEST {
                    f.write_str("; that is too much for a web, so give the mean basis weight of the sheet")?;
                }
                Ok(())
            }
            Self::Shading { share } => write!(
                f,
                "the lamp is brighter by {} at its brightest than at its darkest place, which was taken out as a polynomial of second \
                 order. What the web itself varies so smoothly over the whole picture went with it, and what the polynomial does not follow has stayed, so no interval is told: take a picture \
                 of the lamp without web, or say that the lamp is even",
                per_cent(*share)
            ),
            Self::Filled { pixels } => {
                write!(f, "black pixels, or without a value: {pixels}; they were filled in along their row")
            }
            Self::Saturated { pixels, share } => {
                write!(f, "pixels of the largest grey level: {pixels} ({})", per_cent(*share))?;
                if *share > MANY {
                    f.write_str(
                        "; the thinnest places may be thinner than they look, so expose for less long",
                    )?;
                }
                Ok(())
            }
            Self::Lighter { pixels, share } => {
                write!(
                    f,
                    "pixels lighter than the lamp without web: {pixels} ({}), which count as empty",
                    per_cent(*share)
                )?;
                if *share > MANY {
                    f.write_str("; is the level of the lamp right?")?;
                }
                Ok(())
            }
            Self::Bare { area, level, over_lamp } => {
                write!(
                    f,
                    "the bare lamp is seen beside the web, so the largest rectangle of web was cut out, without {}; ",
                    square(*area)
                )?;
                if !over_lamp {
                    write!(f, "there the lamp has the grey level {}", shortest((level * 10.0).round() / 10.0))
                } else if (level - 1.0).abs() > OTHER {
                    write!(
                        f,
                        "there it is {} {} than in its own picture, so take both pictures at the same exposure",
                        per_cent((level - 1.0).abs()),
                        if *level > 1.0 { "brighter" } else { "darker" }
                    )
                } else {
                    f.write_str("there it is as bright as in its own picture")
                }
            }
            Self::Dark { spots, area, largest, place } => {
                let [right, down] = place.map(|place| Dimension::Length.pretty_to(place, 3));
                write!(
                    f,
                    "dark spots such as dust or blots: {spots}, {} in all, which were left out; the largest, {}, is {right} from the left and \
                     {down} from the upper edge of the picture. If they are web, say so",
                    square(*area),
                    square(*largest)
                )
            }
            Self::Few { from } => write!(
                f,
                "patches of {} and more are too few on this sheet, so no interval is told there; scan a larger piece of the web",
                Dimension::Length.pretty(*from)
            ),
            Self::Blur { from } => {
                f.write_str("one more pixel of blur would lower the CV of small patches by more than 1 %, so the blur of the camera has lowered \
                             it too, and no interval is told there; ")?;
                match from {
                    Some(from) => write!(
                        f,
                        "from patches of {} on this does not matter",
                        Dimension::Length.pretty(*from)
                    ),
                    None => f.write_str("it matters at all sizes of patch here, so scan with smaller pixels"),
                }
            }
        }
    }
}
