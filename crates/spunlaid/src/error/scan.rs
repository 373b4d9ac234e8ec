//! Errors of scans and maps of a web.

use crate::units::{Dimension, shortest};

/// What is wrong with a scan or with how it is to be read, and how to correct it.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ScanFault {
    /// The file is of another kind.
    #[error(
        "is {found}; save the scan as PNG or TIFF in shades of grey, or the map as NumPy array (.npy) or CSV"
    )]
    Format {
        /// What it seems to be, with an article.
        found: &'static str,
    },
    /// The file is broken.
    #[error("cannot be decoded: {message}; is the file complete?")]
    Broken {
        /// Message of the decoder.
        message: String,
    },
    /// The file is written in a way that is not read.
    #[error("has {found}, which is not read; {advice}")]
    Unsupported {
        /// What it has.
        found: String,
        /// How to write it instead.
        advice: &'static str,
    },
    /// The picture is too large.
    #[error(
        "has {columns} × {rows} pixels; at most {most} are read, so cut out a part of the picture, or make its pixels larger"
    )]
    TooManyPixels {
        /// Pixels in a row.
        columns: u64,
        /// Rows.
        rows: u64,
        /// The most pixels.
        most: usize,
    },
    /// The picture is too small.
    #[error(
        "has {columns} × {rows} pixels; at least {least} are needed either way, so scan a larger piece of the web"
    )]
    TooFewPixels {
        /// Pixels in a row.
        columns: usize,
        /// Rows.
        rows: usize,
        /// The least either way.
        least: usize,
    },
    /// A row of a table is too long.
    #[error(
        "this row is longer than {most} bytes, the limit for a table; save so wide a map as NumPy array (.npy)"
    )]
    RowTooLong {
        /// The longest row that is read [bytes].
        most: usize,
    },
    /// The side of a pixel is no length.
    #[error("cannot have pixels of {}; give the side of a pixel, a length above zero", Dimension::Length.pretty(*pixel))]
    Pixel {
        /// As given [m].
        pixel: f64,
    },
    /// Nothing tells how large a pixel is.
    #[error("does not say how large its pixels are; give the side of a pixel, as \"0.1 mm\"")]
    NoPixel,
    /// The file says that its pixels are wider than high, or higher than wide.
    #[error(
        "says that its pixels are {} wide and {} high; scan with the same resolution both ways, or give the side of a pixel if the \
         file is wrong",
        Dimension::Length.pretty_to(*width, 4), Dimension::Length.pretty_to(*height, 4)
    )]
    Oblong {
        /// Width of a pixel [m].
        width: f64,
        /// Its height [m].
        height: f64,
    },
    /// A setting is not above zero.
    #[error("cannot be read with {name} = {}; give a number above zero", shortest(*value))]
    Setting {
        /// What it is.
        name: &'static str,
        /// As given.
        value: f64,
    },
    /// A patch that is smaller than a pixel or larger than the picture.
    #[error(
        "has no patches of {}: they can have sides from a pixel, {}, to the shorter side of the picture, {}",
        Dimension::Length.pretty(*patch), Dimension::Length.pretty(*pixel), Dimension::Length.pretty(*side)
    )]
    Patch {
        /// As given [m].
        patch: f64,
        /// Side of a pixel [m].
        pixel: f64,
        /// Shorter side of the picture [m].
        side: f64,
    },
    /// Too many pixels say nothing.
    #[error(
        "has {unusable} pixels of {pixels} that are {what}; at most one in a hundred can be filled from its neighbours; {advice}"
    )]
    Unusable {
        /// How many.
        unusable: usize,
        /// Of how many.
        pixels: usize,
        /// Why they say nothing.
        what: &'static str,
        /// How to make a better file.
        advice: &'static str,
    },
    /// Every pixel is the same.
    #[error("has the same value everywhere; is it the right file?")]
    Flat,
    /// The picture is not darker than the lamp.
    #[error(
        "is no darker than the lamp without web: its mean grey level is {}, and that of the lamp {}; give the level of the lamp \
         without web at the same exposure, or say that the values are basis weights",
        shortest(*level), shortest(*white)
    )]
    NotDarker {
        /// Geometric mean of the grey level.
        level: f64,
        /// Level of the lamp without web.
        white: f64,
    },
    /// The picture of the lamp has another size.
    #[error(
        "has {} × {} pixels, and the picture of the lamp without web {} × {}; take both with the same camera from the same place",
        wanted[0], wanted[1], found[0], found[1]
    )]
    OtherLamp {
        /// Columns and rows of the picture of the lamp.
        found: [usize; 2],
        /// Columns and rows of the picture of the web.
        wanted: [usize; 2],
    },
    /// The bare lamp is seen beside the web, and what is left is no rectangle.
    #[error(
        "shows the bare lamp on {:.0} % of its area, and no large rectangle without it can be cut out; turn the scan straight, and cut the \
         picture so that it holds web only",
        100.0 * share
    )]
    Bare {
        /// As a share of the picture.
        share: f64,
    },
    /// Much of the picture is far darker than the rest.
    #[error(
        "has spots that are far darker than the rest of the web on {:.1} % of its area, more than dust and blots may cover; clean the \
         glass, cut the picture so that it holds web only, or keep the spots if they are web",
        100.0 * share
    )]
    Dark {
        /// As a share of the web.
        share: f64,
    },
    /// The basis weights are not positive.
    #[error("has a mean basis weight of {}, which must be above zero; is it a map of basis weight?", shortest(*mean))]
    NoWeight {
        /// The mean of the values.
        mean: f64,
    },
    /// The given noise is more than all that is seen.
    #[error(
        "varies by less over patches of {} than the given noise of the camera, {}, alone would; give the noise of a single pixel, \
         from two pictures of the same place",
        Dimension::Length.pretty(*patch), shortest(*noise)
    )]
    NoiseTooLarge {
        /// Side of the patches [m].
        patch: f64,
        /// As given [grey levels].
        noise: f64,
    },
}
