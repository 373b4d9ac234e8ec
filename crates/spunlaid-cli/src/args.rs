//! The command line.

use clap::{Args, Parser, Subcommand, ValueHint};
use clap_complete::Shell;
use spunlaid::case::{Case, Note};
use spunlaid::error::Error;
use spunlaid::input::{Overrides, read_case};
use spunlaid::record::IntegralRule;
use spunlaid::statistics::Window;
use spunlaid::units::Dimension;
use std::path::PathBuf;

/// Simulate fibres in turbulent air: amplitude, frequency and shape of their motion
#[derive(Debug, Parser)]
#[command(name = "spunlaid", version, about, after_help = EXAMPLES, propagate_version = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

const EXAMPLES: &str = "\
Examples:
  spunlaid new my.toml                              write a commented case to start from
  spunlaid new --fed line.toml                      one of a fibre that is laid on a moving belt
  spunlaid keys field                               explain the keys about a field
  spunlaid check my.toml                            show mesh, limits, expected time and memory
  spunlaid run my.toml                              fly it; then open results/my/report.html
  spunlaid run my.toml --set air.velocity=\"20 m/s\" --out results/faster
  spunlaid sweep my_study.toml                      fly it with many values of some keys
  spunlaid web my_web.toml                          lay a fabric of many such filaments
  spunlaid run results/my --until \"20 s\"             fly it for longer, in the same turbulence
  spunlaid web cases/web.toml                       lay thousands of filaments: how even is the fabric?
  spunlaid compare results/my results/faster        say what differs between two runs
  spunlaid analyse wire.csv                         make the air of a case from a velocity record
  spunlaid analyse scan.png --pixel \"0.1 mm\"       say how even your own web is

A case is a small text file that describes fibre, air and run, and feed and belt of a fibre that is
laid. Quantities have a unit:
\"50 µm\" or \"50 um\", \"10 m/s\", \"2 GPa\".

Exit codes: 0 done; 1 the input is wrong (arguments, case, study, record, or the named folder);
2 another failure (a file cannot be written, a flight diverged); 130 interrupted.";

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Fly the fibres of a case and write table, data, figures and report
    #[command(after_help = RUN_HELP)]
    Run(Run),
    /// Fly a case with many values of its keys, and rank which keys matter
    #[command(after_help = SWEEP_HELP)]
    Sweep(Sweep),
    /// Lay a web of many filaments: map of its basis weight, how uneven it is, directions
    #[command(after_help = WEB_HELP)]
    Web(Web),
    /// Reproduce every result figure of the paper and test its claims
    #[command(after_help = REPRODUCE_HELP)]
    Reproduce(Reproduce),
    /// Make the air of a case from a velocity record, or say how even the web of a scan is
    #[command(after_help = ANALYSE_HELP)]
    Analyse(Box<Analyse>),
    /// Compare the results of runs or of webs: differences, whether they are beyond chance, curves in one picture
    #[command(after_help = COMPARE_HELP)]
    Compare(Compare),
    /// Show a case with all defaults, its mesh, limits and expected cost, without flying it
    #[command(after_help = CHECK_HELP)]
    Check(Check),
    /// Explain the keys of a case or of a web: meaning, allowed values, default
    #[command(after_help = KEYS_HELP)]
    Keys(Keys),
    /// Write a commented case file to start from
    #[command(after_help = "Examples:\n  spunlaid new my.toml && spunlaid run my.toml\n  \
        spunlaid new --fed line.toml        a fibre that is fed and laid on a moving belt")]
    New(New),
    /// Print a script that completes commands and options in your shell
    #[command(
        after_help = "Example:\n  spunlaid completions bash > ~/.local/share/bash-completion/completions/spunlaid"
    )]
    Completions(Completions),
}

const KEYS_HELP: &str = "\
Examples:
  spunlaid keys                        every key
  spunlaid keys field                  the keys with this word in their name or meaning
  spunlaid keys run.spin_up            one of them
  spunlaid keys --markdown > keys.md   the same as a Markdown document
  spunlaid keys --web                  the keys of the file of a web";

const RUN_HELP: &str = "\
The results folder holds
  report.html          for the browser: the moving fibre, figures, table; works offline
  summary.json         every result with mean, standard error and the replicates' values
  case.toml            the case with every default; running it gives the same bits
  case_files/          copies of the files that the case names
  end_node.parquet     the free end over time      energy.parquet   both energy ledgers over time
  shape.pvd, shape/    the fibre over time, for ParaView (open shape.pvd)
  laid.parquet         of a fed fibre, in place of end_node.parquet: where each point lies on the belt
  laid.vtp             the same of the first fibres as curves, for ParaView
  figures/             the report's figures as SVG and PNG, and their numbers as CSV

With --until, a finished run is flown for longer, again from the start: everything but the duration
is as in its case.toml, harmonics of the turbulence and time step too, and the first part has the
same bits. The new results replace the old ones when they are complete, or go to --out.

Examples:
  spunlaid run cases/table1.toml
  spunlaid run cases/table1.toml --set fibre.diameter=\"18 um\" --replicates 40 --out results/fine
  spunlaid run results/table1 --until \"20 s\"";

const SWEEP_HELP: &str = "\
A study is a small text file beside the case it varies:

  case = \"table1.toml\"
  design = \"grid\"           # or \"one-at-a-time\", \"paired\", \"latin-hypercube\", \"sobol\"
  # points = 64              # how many a latin-hypercube or sobol design draws
  replicates = 10            # fibres per point; or a table:
                             #   [replicates] at_most = 100, until = { amplitude_y = \"3 %\" }
  # common_phases = true     # the same random phases of turbulence at all points
  # seed = 1
  [vary]                     # any key of a case with a number or one of a few words as value
  \"air.velocity\"   = [\"5 m/s\", \"10 m/s\", \"20 m/s\"]
  \"fibre.diameter\" = { from = \"20 um\", to = \"200 um\", steps = 4, spacing = \"log\" }
  \"drag.along\"     = [\"matsui\", \"sakiadis\"]
  [link]                     # keys that follow from others
  \"air.cutoff_frequency\" = \"air.velocity / (4 * air.length_scale)\"    # or just \"taylor\"

If a sweep is interrupted, the same command continues it and gives the same bits. The results
folder holds
  report.html          for the browser: the study, table, figures, ranking
  results.csv          a row per point: seed, inputs, n, lost, then mean and standard error (_se) of every result
  results.json         the same with the ranking
  results.parquet      the same            replicates.parquet   a row per fibre
  figures/             the report's figures as SVG and PNG, and their numbers as CSV
  study.toml, case.toml   the study as it was run; sweeping it again gives the same bits
  case_files/          copies of the files that the case names
  journal              the results of every fibre; with it the study can be continued

Examples:
  spunlaid sweep cases/studies/velocity.toml
  spunlaid sweep cases/studies/velocity.toml --replicates 16       adds replicates to the same
  spunlaid sweep my_study.toml --print-point 7 > point7.toml && spunlaid run point7.toml";

const WEB_HELP: &str = "\
A web is a small text file:

  [laydown]                       # how a filament lies; one of these three:
  case = \"spunbond.toml\"          #   a case with [feed] and [belt], which is flown first
  # results = \"results/spunbond\"  #   the results folder of such a case
  # sigma_md = \"18.4 mm\"          #   the numbers of the surrogate, with [fibre] and both speeds
  # sigma_cd = \"18.3 mm\"
  # noise = \"12.4 m^-0.5\"
  [line]
  filaments_per_metre = 5000      # at random places, or the rows of nozzles of a beam:
  # rows = [{ offset = \"0 mm\", pitch = \"0.2 mm\", filaments = 5000 }]
  # feed_speed = \"50 m/s\"         # with a case, these are the case's
  # belt_speed = \"3 m/s\"
  [web]
  width = \"1 m\"
  length = \"1 m\"
  # method = \"dynamics\"           # lay the flown curves themselves, in place of the surrogate's

Several beams are [[layer]] tables, each with its own [layer.laydown], [layer.line] and
[layer.fibre]. `spunlaid keys --web` explains every key. The results folder holds
  report.html    for the browser: the web on a light table, what makes it uneven, figures
  summary.json   basis weight, CV over patches with errors, directions, clouds, sensitivities
  map.npy, map.parquet, map.png   the basis weight of each cell
  fibres.vtp     the single fibres of a window, for ParaView
  figures/       every figure as SVG, PNG and CSV
  web.toml       the file with every default; laying it again gives the same bits

Examples:
  spunlaid web cases/web.toml
  spunlaid web cases/web_known.toml --set line.belt_speed=\"6 m/s\" --out results/faster
  spunlaid web two_beams.toml --set layer.2.line.filaments_per_metre=4000";

const REPRODUCE_HELP: &str = "\
The results folder holds
  report.html   the paper's claims with evidence and verdict, its open questions, the figures
  figures/      every figure as SVG and PNG, and its numbers as CSV
  summary.json  the claims, their evidence and verdicts      case.toml  the base case, Table 1

It flies the studies cases/paper/*.toml of the repository, which are built into the program.

Examples:
  spunlaid reproduce                                       with the paper's scheme
  spunlaid reproduce --scheme implicit-tension --replicates 40   faster, with smaller errors
  spunlaid reproduce --figures 9,11a --out results/two";

const ANALYSE_HELP: &str = "\
A record is an evenly sampled CSV or Parquet file with one time column and one to three velocity
columns. CSV cells are separated by comma, semicolon, tab or blanks:

  time_s,u_m_s,v_m_s          Zeit [ms];u [m/s]          (or no time column and --rate \"20 kHz\")
  0.00000,10.12,-0.31         0,00;10,12
  0.00005,10.25,-0.28         0,05;10,25

The first velocity column, or the one called u, is along the mean flow. Missing samples are
interpolated, up to --max-gap in a row.

The results folder holds
  report.html          for the browser: record, histogram, spectrum, autocorrelation, table
  analysis.json        every result as {value, low, high} with a 95 % confidence interval
  air.toml             the [air] table of a case, to be pasted into a case file
  spectrum.csv, autocorrelation.csv      the curves          figures/   the figures as SVG, PNG, CSV

The integral time is the integral of the autocorrelation up to
  first-zero           its first zero (the usual choice)
  e-fold               the lag where it falls to 1/e (63 % of the integral of an exponential)
  fixed=\"50 ms\"        a given lag

With --pixel, the file is the scan of a web in transmitted light (PNG or TIFF) or the map of its
basis weight (.npy or CSV, a line for each row of the map). The results folder then holds what that
of `spunlaid web` holds: report.html, summary.json, map.npy and figures/.

Examples:
  spunlaid analyse cases/records/probe.csv
  spunlaid analyse scan.png --pixel \"0.1 mm\" --weight \"15 g/m²\" --lamp empty.png
  spunlaid analyse gauge.csv --pixel \"2 mm\" --md rows --patches \"4 mm,10 mm,20 mm\"
  spunlaid analyse wire.csv --rate \"20 kHz\" --velocity-unit m/s --integral e-fold --out results/wire";

const COMPARE_HELP: &str = "\
Every run is compared with the first. Runs with the same seed and the same eddies are compared
replicate by replicate, which shows small differences; others by Welch's t. Webs, laid by `spunlaid web`
or scanned (`spunlaid analyse --pixel`), are compared patch by patch.

The results folder holds
  report.html       for the browser: a table for each pair, and the curves in one picture each
  comparison.json   every measure with both means, the difference and its error
  figures/          the figures as SVG and PNG, and their numbers as CSV

Examples:
  spunlaid compare results/table1 results/faster
  spunlaid compare results/a results/b results/c --out results/three --json
  spunlaid compare results/web results/scan";

const CHECK_HELP: &str = "\
Prints the case with every default, the mesh, the limits of the time step, and the expected time,
memory and size of the results. The output is itself a case file.

Example:
  spunlaid check cases/table1.toml --set fibre.element_length=\"5 mm\"";

/// A case and changes to it.
#[derive(Debug, Args)]
pub(crate) struct CaseSource {
    /// Case file (TOML)
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub(crate) case: PathBuf,
    /// Set a key of the case for this run, as air.velocity="20 m/s"; can be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_and_value)]
    pub(crate) set: Vec<(String, String)>,
}

impl CaseSource {
    /// Reads the case with the values of `--set` and these.
    pub(crate) fn read(&self, more: &[(&str, String)]) -> Result<(Case, Vec<Note>), Error> {
        let more = more.iter().map(|(key, value)| ((*key).to_owned(), value.clone()));
        let values: Vec<_> = self.set.iter().cloned().chain(more).collect();
        read_case(&self.case, Overrides { values: &values, word: "--set" })
    }

    /// The same as arguments of a command line.
    pub(crate) fn words(&self) -> String {
        let set = self.set.iter().map(|(key, value)| format!(" --set {}", quoted(&format!("{key}={value}"))));
        quoted(&self.case.to_string_lossy()) + &set.collect::<String>()
    }
}

/// A word of a command line, in quotes if the shell would not take it as one word. It stays in its line.
fn quoted(word: &str) -> String {
    if word.chars().all(|c| c.is_alphanumeric() || "-_./=:,+%".contains(c)) {
        return word.to_owned();
    }
    format!("'{}'", word.replace(char::is_control, "?").replace('\'', "'\\''"))
}

fn key_and_value(text: &str) -> Result<(String, String), String> {
    match text.split_once('=').map(|(key, value)| (key.trim(), value.trim())) {
        Some((key, value)) if !key.is_empty() => Ok((key.to_owned(), value.to_owned())),
        _ => Err("write a key and a value, as air.velocity=\"20 m/s\"".to_owned()),
    }
}

#[derive(Debug, Args)]
pub(crate) struct Run {
    #[command(flatten)]
    pub(crate) source: CaseSource,
    /// Folder for the results [default: results/<name of the case>]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) out: Option<PathBuf>,
    /// Number of fibres, each in its own turbulence; replaces run.replicates
    #[arg(long, value_name = "N")]
    pub(crate) replicates: Option<u64>,
    /// Seed of the turbulence; replaces run.seed
    #[arg(long, value_name = "S")]
    pub(crate) seed: Option<u64>,
    /// Fly a finished run again for longer, to this time, as "20 s"; CASE is its results folder
    #[arg(long, value_name = "TIME", value_parser = |t: &str| quantity(Dimension::Time, t),
          conflicts_with_all = ["set", "replicates", "seed"])]
    pub(crate) until: Option<f64>,
    /// Number of threads [default: all cores]; it does not change the results
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) threads: Option<u16>,
    /// No progress bar and no table; warnings and errors are still shown
    #[arg(long, short)]
    pub(crate) quiet: bool,
    /// Print summary.json instead of the table; without --out or --until, write no files
    #[arg(long)]
    pub(crate) json: bool,
    /// Replace the results in the output folder
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Sweep {
    /// Study file (TOML)
    #[arg(value_name = "STUDY", value_hint = ValueHint::FilePath)]
    pub(crate) study: PathBuf,
    /// Folder for the results [default: results/<name of the study>]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) out: Option<PathBuf>,
    /// Number of threads [default: all cores]; it does not change the results
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) threads: Option<u16>,
    /// No progress and no table; warnings and errors are still shown
    #[arg(long, short)]
    pub(crate) quiet: bool,
    /// Start again; deletes the study in the output folder
    #[arg(long)]
    pub(crate) force: bool,
    /// Set a key of the case for all points, as run.duration="2 s"; can be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_and_value)]
    pub(crate) set: Vec<(String, String)>,
    /// Fibres at each point, in place of the study's; with more than before, a finished study goes on
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) replicates: Option<u64>,
    /// Print results.json instead of the table
    #[arg(long)]
    pub(crate) json: bool,
    /// Confirm the number of points; needed above 10000 points
    #[arg(long, value_name = "N")]
    pub(crate) points: Option<u64>,
    /// Print the case of point K, counted from 1, and fly nothing
    #[arg(long, value_name = "K")]
    pub(crate) print_point: Option<u64>,
}

#[derive(Debug, Args)]
pub(crate) struct Web {
    /// File of the web (TOML)
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    /// Folder for the results [default: results/<name of the file>]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) out: Option<PathBuf>,
    /// Set a key of the web, as line.belt_speed="6 m/s"; can be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_and_value)]
    pub(crate) set: Vec<(String, String)>,
    /// Number of threads [default: all cores]; it does not change the results
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) threads: Option<u16>,
    /// No progress bar and no table; warnings and errors are still shown
    #[arg(long, short)]
    pub(crate) quiet: bool,
    /// Print summary.json instead of the table; without --out, write no files
    #[arg(long)]
    pub(crate) json: bool,
    /// Replace the results in the output folder
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Reproduce {
    /// Folder for the results [default: results/paper]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) out: Option<PathBuf>,
    /// Figures to draw, as 9,10,11a [default: all]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub(crate) figures: Vec<String>,
    /// Fibres at each point; the paper has ten
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) replicates: u64,
    /// Time integration: the paper's with 1 µs, or another with a suitable step
    #[arg(long, value_enum, default_value = "semi-implicit-euler")]
    pub(crate) scheme: SchemeName,
    /// Number of threads [default: all cores]; it does not change the results
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub(crate) threads: Option<u16>,
    /// No progress bar and no list of claims; errors are still shown
    #[arg(long, short)]
    pub(crate) quiet: bool,
    /// Replace the results in the output folder
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Analyse {
    /// Velocity record (CSV or Parquet), or scan or map of a web (PNG, TIFF, .npy, CSV)
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) record: PathBuf,
    #[command(flatten)]
    pub(crate) scan: Scan,
    /// Folder for the results [default: results/<name of the file>]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) out: Option<PathBuf>,
    /// Sampling rate, as "20 kHz"; a time column is then ignored
    #[arg(long, value_name = "RATE", value_parser = |t: &str| quantity(Dimension::Frequency, t))]
    pub(crate) rate: Option<f64>,
    /// Unit of the time if the header has none: s, ms, us
    #[arg(long, value_name = "UNIT")]
    pub(crate) time_unit: Option<String>,
    /// Unit of the velocities if the header has none: m/s, cm/s, km/h
    #[arg(long, value_name = "UNIT")]
    pub(crate) velocity_unit: Option<String>,
    /// Velocity columns by name or number, the one along the flow first, as u,v
    #[arg(long, value_name = "COLUMNS", value_delimiter = ',')]
    pub(crate) columns: Vec<String>,
    /// Time column by name or number
    #[arg(long, value_name = "COLUMN")]
    pub(crate) time_column: Option<String>,
    /// Lines to skip at the start of a CSV file
    #[arg(long, value_name = "LINES", default_value_t = 0)]
    pub(crate) skip: u64,
    /// Most missing samples in a row that are interpolated
    #[arg(long, value_name = "SAMPLES", default_value_t = spunlaid::record::LONGEST_GAP)]
    pub(crate) max_gap: usize,
    /// Mean velocity, as "10 m/s", if the record holds the fluctuation only
    #[arg(long, value_name = "SPEED", value_parser = |t: &str| quantity(Dimension::Velocity, t))]
    pub(crate) mean_velocity: Option<f64>,
    /// End of the integral of the autocorrelation: first-zero, e-fold or fixed="50 ms"
    #[arg(long, value_name = "RULE", default_value = "first-zero", value_parser = integral)]
    pub(crate) integral: IntegralRule,
    /// Samples in a segment of the spectrum, a power of two [default: from the integral time]
    #[arg(long, value_name = "SAMPLES")]
    pub(crate) segment: Option<usize>,
    /// Window of the segments: hann, hamming or rectangular
    #[arg(long, value_name = "NAME", default_value = "hann", value_parser = window)]
    pub(crate) window: Window,
    /// Overlap of neighbouring segments, 0 to 0.9
    #[arg(long, value_name = "SHARE", default_value_t = 0.5, value_parser = overlap)]
    pub(crate) overlap: f64,
    /// End of the flat part of the spectrum, as "20 Hz" [default: an eighth of the cut-off]
    #[arg(long, value_name = "FREQUENCY", value_parser = |t: &str| quantity(Dimension::Frequency, t))]
    pub(crate) flat_until: Option<f64>,
    /// No table; warnings and errors are still shown
    #[arg(long, short)]
    pub(crate) quiet: bool,
    /// Print analysis.json, or summary.json of a web, instead of the table
    #[arg(long)]
    pub(crate) json: bool,
    /// Replace the results in the output folder
    #[arg(long)]
    pub(crate) force: bool,
}

/// How a scan of a web is read.
#[derive(Debug, Args)]
#[command(next_help_heading = "Scan or map of a web")]
pub(crate) struct Scan {
    /// Side of a pixel, as "0.1 mm"
    #[arg(long, value_name = "LENGTH", value_parser = |t: &str| quantity(Dimension::Length, t), conflicts_with_all = [
        "rate", "time_unit", "velocity_unit", "columns", "time_column", "skip", "max_gap", "mean_velocity", "integral",
        "segment", "window", "overlap", "flat_until",
    ])]
    pub(crate) pixel: Option<f64>,
    /// Mean basis weight of the sheet, as "15 g/m²" or "15 gsm"
    #[arg(long, value_name = "WEIGHT", requires = "pixel", value_parser = |t: &str| quantity(Dimension::BasisWeight, t))]
    pub(crate) weight: Option<f64>,
    /// What the values are [default: transmitted for PNG and TIFF, weight for .npy and CSV]
    #[arg(long, value_enum, requires = "pixel")]
    pub(crate) light: Option<LightName>,
    /// Picture of the lamp without web, at the same exposure; it takes out any shading
    #[arg(long, value_name = "FILE", requires = "pixel", value_hint = ValueHint::FilePath)]
    pub(crate) lamp: Option<PathBuf>,
    /// Grey level of the lamp without web [default: the largest that the file can hold]
    #[arg(long, value_name = "LEVEL", requires = "pixel", conflicts_with = "lamp", value_parser = above_zero)]
    pub(crate) white: Option<f64>,
    /// Take the lamp as even; without --lamp, its shading is else taken out as a polynomial
    #[arg(long, requires = "pixel")]
    pub(crate) keep_shading: bool,
    /// Standard deviation of the noise of a single pixel, which is then taken out
    #[arg(long, value_name = "LEVELS", requires = "pixel", value_parser = above_zero)]
    pub(crate) noise: Option<f64>,
    /// Where the machine direction runs in the picture
    #[arg(long, value_enum, requires = "pixel", default_value = "columns", hide_possible_values = false)]
    pub(crate) md: Direction,
    /// Sides of the patches, as "1 mm,5 mm,10 mm" [default: from 0.5 mm to a fifth of the picture]
    #[arg(long, value_name = "LENGTHS", requires = "pixel", value_delimiter = ',',
          value_parser = |t: &str| quantity(Dimension::Length, t))]
    pub(crate) patches: Vec<f64>,
}

/// What the values of a picture are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum LightName {
    /// Light that has come through the web
    Transmitted,
    /// Basis weights, in kg/m² or, with --weight, in any unit
    Weight,
}

/// Where the machine direction runs in a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Direction {
    /// Along the columns, downwards
    Columns,
    /// Along the rows, to the right
    Rows,
}

fn above_zero(text: &str) -> Result<f64, String> {
    let value = text.trim().parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0);
    value.ok_or_else(|| "write a number above zero, like 240".to_owned())
}

/// A scheme by its name in a case file.
#[derive(Clone, Copy, Debug, clap::ValueEnum)]
pub(crate) enum SchemeName {
    /// First order, the paper's
    SemiImplicitEuler,
    /// Second order
    Leapfrog,
    /// Long steps, hundreds of times faster
    ImplicitTension,
}

fn quantity(dimension: Dimension, text: &str) -> Result<f64, String> {
    let value = dimension.parse(text).map_err(|fault| fault.to_string())?;
    let signed = dimension == Dimension::Velocity;
    if value > 0.0 || (signed && value < 0.0) { Ok(value) } else { Err("is not above zero".to_owned()) }
}

fn integral(text: &str) -> Result<IntegralRule, String> {
    match IntegralRule::parse(text) {
        Some(rule) => rule.map_err(|fault| fault.to_string()),
        None => Err("write first-zero, e-fold or fixed=\"50 ms\"".to_owned()),
    }
}

fn window(text: &str) -> Result<Window, String> {
    let known = Window::ALL.into_iter().find(|window| window.name() == text);
    known.ok_or_else(|| "write hann, hamming or rectangular".to_owned())
}

fn overlap(text: &str) -> Result<f64, String> {
    let share = text.parse().ok().filter(|share| (0.0..=0.9).contains(share));
    share.ok_or_else(|| "write a number from 0 to 0.9, like 0.5".to_owned())
}

#[derive(Debug, Args)]
pub(crate) struct Compare {
    /// Results folders of runs, or of webs, the one to compare with first
    #[arg(value_name = "RUN", value_hint = ValueHint::DirPath, num_args = 2.., required = true)]
    pub(crate) runs: Vec<PathBuf>,
    /// Folder for the report [default: results/<name>_against_<name>]
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) out: Option<PathBuf>,
    /// No table; warnings and errors are still shown
    #[arg(long, short)]
    pub(crate) quiet: bool,
    /// Print comparison.json instead of the table; without --out, write no files
    #[arg(long)]
    pub(crate) json: bool,
    /// Replace the comparison in the output folder
    #[arg(long)]
    pub(crate) force: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Check {
    #[command(flatten)]
    pub(crate) source: CaseSource,
    /// Print the same as JSON
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Keys {
    /// Show only keys with this word in their name or meaning
    pub(crate) pattern: Option<String>,
    /// Print Markdown; docs/keys.md is made this way
    #[arg(long)]
    pub(crate) markdown: bool,
    /// Show the keys of the file of a web in place of those of a case
    #[arg(long)]
    pub(crate) web: bool,
}

#[derive(Debug, Args)]
pub(crate) struct New {
    /// File to write; it must not exist yet
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    /// A fibre that is fed at an inlet and laid on a moving belt, in place of one of fixed length
    #[arg(long)]
    pub(crate) fed: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Completions {
    /// The shell
    pub(crate) shell: Shell,
}
