//! Options that most commands have in common.

use clap::{Args, ValueHint};
use spunlaid_results::files::pictures::{FigureFiles, Format, width_named};
use spunlaid_results::files::table::TableFormat;
use std::path::{Path, PathBuf};
use std::thread::available_parallelism;

/// Where results go, and what is said meanwhile.
#[derive(Clone, Debug, Args)]
pub(crate) struct Output {
    /// Folder for the results [default: results/<name of the case or file>]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) out: Option<PathBuf>,
    /// No progress bar and no table; warnings and errors are still shown
    #[arg(long, short)]
    pub(crate) quiet: bool,
    /// Replace any results in the output folder; those of the same command are replaced without it
    #[arg(long)]
    pub(crate) force: bool,
    /// Print summary.json instead of the table; without --out, write no files
    #[arg(long)]
    pub(crate) json: bool,
}

impl Output {
    /// The requested folder, or `results/NAME`.
    pub(crate) fn folder(&self, name: impl AsRef<Path>) -> PathBuf {
        self.out.clone().unwrap_or_else(|| Path::new("results").join(name))
    }

    /// The same output with a folder also where none is named.
    pub(crate) fn with_folder(&self, name: impl AsRef<Path>) -> Self {
        Self { out: Some(self.folder(name)), ..self.clone() }
    }

    /// The same; with `--json`, results go to a folder only if one is requested.
    pub(crate) fn optional_folder(&self, name: impl AsRef<Path>) -> Option<PathBuf> {
        (self.out.is_some() || !self.json).then(|| self.folder(name))
    }
}

/// The processors that may be used.
#[derive(Clone, Copy, Debug, Default, Args)]
pub(crate) struct Threads {
    /// Number of threads [default: all cores]; it does not change the results
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    threads: Option<u16>,
}

impl Threads {
    pub(crate) fn number(self) -> usize {
        self.threads.map_or_else(|| available_parallelism().map_or(1, usize::from), usize::from)
    }
}

/// Formats and width of the figures of a command, and formats of its tables.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Figures and tables")]
pub(crate) struct Figures {
    #[arg(long = "figures", value_name = "FORMATS", value_delimiter = ',', value_parser = Format::named,
          help = format!("Formats of the figures: {}, or several with commas [default: svg,png]", Format::names()))]
    formats: Vec<&'static Format>,
    #[command(flatten)]
    width: FigureWidth,
    #[arg(long, value_name = "FORMATS", value_delimiter = ',', value_parser = TableFormat::named,
          help = format!("Formats in which the folder tables/ holds the tables too: {}", TableFormat::names()))]
    tables: Vec<&'static TableFormat>,
}

/// Width of the figures of a command.
#[derive(Clone, Debug, Args)]
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
