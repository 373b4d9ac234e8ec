//! How a command writes its figures and tables.

use clap::Args;
use spunlaid_results::output::pictures::{FigureFiles, Format, width_named};
use spunlaid_results::output::table::TableFormat;

/// Formats and width of the figures of a command, and formats of its tables.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Figures and tables")]
pub(crate) struct Figures {
    /// Formats of the figures, as pdf,svg,png [default: svg,png]
    #[arg(long = "figures", value_name = "FORMATS", value_delimiter = ',', value_parser = Format::named)]
    formats: Vec<&'static Format>,
    #[command(flatten)]
    width: FigureWidth,
    /// Formats in which the folder tables/ holds the tables too: tsv, csv, parquet
    #[arg(long, value_name = "FORMATS", value_delimiter = ',', value_parser = TableFormat::named)]
    tables: Vec<&'static TableFormat>,
}

/// Width of the figures of a command.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Figures")]
pub(crate) struct FigureWidth {
    /// Width of the figures in print: one-column (84 mm), two-columns (174 mm) or as "90 mm"; PNG then has 300 dpi
    #[arg(long, value_name = "WIDTH", value_parser = width_named)]
    figure_width: Option<f64>,
}

impl Figures {
    /// How the figures are written.
    pub(crate) fn files(&self) -> FigureFiles {
        FigureFiles { tables: self.tables.clone(), ..self.width.files(&self.formats) }
    }
}

impl FigureWidth {
    /// How the figures are written, in these formats if any are named.
    pub(crate) fn files(&self, formats: &[&'static Format]) -> FigureFiles {
        let usual = FigureFiles { width: self.figure_width, ..FigureFiles::default() };
        if formats.is_empty() { usual } else { FigureFiles { formats: formats.to_vec(), ..usual } }
    }
}
