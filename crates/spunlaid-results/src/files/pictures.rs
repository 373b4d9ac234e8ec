//! Figures in the formats and at the width that are asked for.

use super::table::TableFormat;
use crate::Failure;
use crate::failure::undrawable;
use spunlaid_charts::{Figure, Picture, PictureError, pdf, png, svg};
use spunlaid_ground::Dimension;

/// A format of figures; `spunlaid-charts` has a file for each, which says how a picture is written.
#[derive(Debug)]
pub struct Format {
    /// The ending of its files.
    pub name: &'static str,
    write: fn(&Figure, &Picture, u32) -> Result<Vec<u8>, PictureError>,
}

/// All formats.
static FORMATS: [Format; 3] = [
    // Lines and texts, for browsers and drawing programs.
    Format { name: "svg", write: |_, picture, _| Ok(svg(picture).into_bytes()) },
    // Pixels.
    Format {
        name: "png",
        write: |figure, picture, dpi| png(picture, dpi, &[("Title", &figure.title), ("Software", SOFTWARE)]),
    },
    // Lines and outlines of texts, a page of the figure's size.
    Format { name: "pdf", write: |figure, picture, _| pdf(picture, &figure.title, SOFTWARE) },
];

impl Format {
    /// The format of this name.
    ///
    /// # Errors
    /// What to write, if there is none.
    pub fn named(name: &str) -> Result<&'static Self, String> {
        let known = FORMATS.iter().find(|format| format.name.eq_ignore_ascii_case(name.trim()));
        known.ok_or_else(|| format!("write one of {}, or several of them with commas", Self::names()))
    }

    /// The names of all formats.
    pub fn names() -> String {
        FORMATS.each_ref().map(|format| format.name).join(", ")
    }
}

/// How figures and tables are written.
#[derive(Clone, Debug)]
pub struct FigureFiles {
    /// Their formats.
    pub formats: Vec<&'static Format>,
    /// Width in print [m]; none: as on the screen.
    pub width: Option<f64>,
    /// The formats in which tables are written besides the usual ones.
    pub tables: Vec<&'static TableFormat>,
}

impl Default for FigureFiles {
    fn default() -> Self {
        Self { formats: FORMATS.iter().take(2).collect(), width: None, tables: Vec::new() }
    }
}

/// Width of a figure in one column and in two columns of a page [m]: Springer's journals, which are the
/// narrowest of the large publishers; Elsevier's have 90 and 190 mm.
pub const COLUMNS: [f64; 2] = [84e-3, 174e-3];
/// The narrowest figure in print in which the words still have room, and the widest [m].
pub const WIDTHS: [f64; 2] = [60e-3, 400e-3];
/// Pixels per inch of a PNG for print, as journals ask for.
const PRINT: u32 = 300;
/// Pixels per inch of a PNG as on the screen: two for each pixel of the picture.
const SCREEN: u32 = 192;
/// What files say about the program.
pub(crate) const SOFTWARE: &str = concat!("spunlaid ", env!("CARGO_PKG_VERSION"));

/// The width of figures in print [m] that is named, `one-column`, or given as a length.
///
/// # Errors
/// What to write, if it is none of these or not between the [`WIDTHS`].
pub fn width_named(text: &str) -> Result<f64, String> {
    let [one, two] = COLUMNS;
    let [narrowest, widest] = WIDTHS;
    let width = match text.trim() {
        "one-column" => return Ok(one),
        "two-columns" => return Ok(two),
        length => Dimension::Length.parse(length).ok(),
    };
    width.filter(|width| (narrowest..=widest).contains(width)).ok_or_else(|| {
        format!(
            "write one-column ({} mm), two-columns ({} mm), or a width from {} to {} mm, as \"90 mm\"",
            one * 1e3,
            two * 1e3,
            narrowest * 1e3,
            widest * 1e3
        )
    })
}

impl FigureFiles {
    /// The figure in each format, with the ending of its file.
    ///
    /// # Errors
    /// If the figure cannot be drawn.
    pub(super) fn drawn(&self, figure: &Figure) -> Result<Vec<(&'static str, Vec<u8>)>, Failure> {
        let (picture, dpi) = match self.width {
            Some(width) => (figure.in_print(width * 1e3), PRINT),
            None => (figure.picture(), SCREEN),
        };
        let undrawable = |reason: PictureError| undrawable(&figure.name, &reason.to_string());
        let file = |format: &Format| Ok((format.name, (format.write)(figure, &picture, dpi)?));
        self.formats.iter().map(|format| file(format).map_err(undrawable)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_and_lengths_are_widths() {
        assert_eq!(
            ["one-column", "two-columns", "90 mm", "9cm"].map(|text| width_named(text).unwrap()),
            [84e-3, 174e-3, 90e-3, 9.0 / 100.0]
        );
        for wrong in ["3 columns", "90", "5 mm", "1 m", "NaN mm"] {
            let message = width_named(wrong).unwrap_err();
            assert!(
                message.contains("one-column (84 mm), two-columns (174 mm), or a width from 60 to 400 mm"),
                "{message}"
            );
        }
    }
}
