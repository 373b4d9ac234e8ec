//! How a command writes its figures.

use clap::Args;
use spunlaid::units::Dimension;
use spunlaid_results::output::pictures::{COLUMNS, FigureFiles, Format, WIDTHS};

/// Formats and width of the figures of a command.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Figures")]
pub(crate) struct Figures {
    /// Formats of the figures, as pdf,svg,png [default: svg,png]
    #[arg(long = "figures", value_name = "FORMATS", value_delimiter = ',', value_parser = format)]
    formats: Vec<Format>,
    #[command(flatten)]
    width: FigureWidth,
}

/// Width of the figures of a command.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Figures")]
pub(crate) struct FigureWidth {
    /// Width of the figures in print: one-column (84 mm), two-columns (174 mm) or as "90 mm"; PNG then has 300 dpi
    #[arg(long, value_name = "WIDTH", value_parser = width)]
    figure_width: Option<f64>,
}

impl Figures {
    /// How the figures are written.
    pub(crate) fn files(&self) -> FigureFiles {
        self.width.files(&self.formats)
    }
}

impl FigureWidth {
    /// How the figures are written, in these formats if any are named.
    pub(crate) fn files(&self, formats: &[Format]) -> FigureFiles {
        let usual = FigureFiles { width: self.figure_width, ..FigureFiles::default() };
        if formats.is_empty() { usual } else { FigureFiles { formats: formats.to_vec(), ..usual } }
    }
}

/// The format of this name.
pub(crate) fn format(name: &str) -> Result<Format, String> {
    let known = Format::ALL.into_iter().find(|format| format.name().eq_ignore_ascii_case(name.trim()));
    known.ok_or_else(|| "write svg, png or pdf, or several of them with commas, as pdf,svg,png".to_owned())
}

fn width(text: &str) -> Result<f64, String> {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_and_lengths_are_widths() {
        assert_eq!(
            ["one-column", "two-columns", "90 mm", "9cm"].map(|text| width(text).unwrap()),
            [84e-3, 174e-3, 90e-3, 9.0 / 100.0]
        );
        for wrong in ["3 columns", "90", "5 mm", "1 m", "NaN mm"] {
            let message = width(wrong).unwrap_err();
            assert!(
                message.contains("one-column (84 mm), two-columns (174 mm), or a width from 60 to 400 mm"),
                "{message}"
            );
        }
    }
}
