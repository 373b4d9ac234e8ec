//! The command line.

mod analyse;
mod fit;
mod help;
mod invocation;
mod new;
mod output;
mod source;

pub(crate) use analyse::{Analyse, RecordOptions, Scan};
pub(crate) use fit::Fit;
pub(crate) use invocation::Invocation;
pub(crate) use new::{LineNumbers, MeltNumbers, Need, New, QUESTIONS, value};
pub(crate) use output::{Figures, Output, Threads};
pub(crate) use source::{CaseSource, is_standard, overrides};

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueHint};
use clap_complete::Shell;
use help::{
    AIR_HELP, ANALYSE_HELP, CHECK_HELP, COMPARE_HELP, EXAMPLES, FIT_HELP, FORCE_HELP, KEYS_HELP, LIVE_HELP,
    NEW_HELP, REPRODUCE_HELP, RUN_HELP, SPIN_HELP, SWEEP_HELP, WEB_HELP,
};
use output::FigureWidth;
use source::key_and_value;
use spunlaid::air::PlaceAxes;
use spunlaid::fibre::Checks;
use spunlaid::fibre::chain::Scheme;
use spunlaid::ground::Dimension;
use std::path::PathBuf;

/// Simulate fibres from the die to the web: how the melt is drawn, how fibres move in turbulent air, how uniform the
/// web is
#[derive(Debug, Parser)]
#[command(name = "spunlaid", version, about, after_help = EXAMPLES, propagate_version = true)]
pub(crate) struct Arguments {
    #[command(subcommand)]
    pub(crate) command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// Simulate the fibres of a case and write table, data, figures and report
    #[command(after_help = RUN_HELP, mut_arg("json", |json| json.help("Print summary.json instead of the \
        table; without --out, write no files")))]
    Run(Run),
    /// Simulate a case with many values of its keys, and rank which keys matter
    #[command(after_help = SWEEP_HELP, mut_arg("force", |force| force.help(FORCE_HELP)))]
    #[command(mut_arg("json", |json| json.help("Print results.json instead of the table")))]
    Sweep(Sweep),
    /// Solve a spinline, from the hole of the spinneret to the solid filament: diameter, speed, solidification
    #[command(after_help = SPIN_HELP)]
    Spin(Spin),
    /// Lay a web of many filaments: map of its basis weight, uniformity, fibre directions
    #[command(after_help = WEB_HELP)]
    Web(Web),
    /// Find the settings whose webs have the CV of a scanned one, with their intervals
    #[command(after_help = FIT_HELP, mut_arg("out", |out| out.help("Folder for the results [default: \
        results/<name of the web>_fit]")), mut_arg("force", |force| force.help(FORCE_HELP)))]
    #[command(mut_arg("json", |json| json.help("Print fit.json instead of the table")))]
    Fit(Fit),
    /// Show the turbulent air of a case: pictures of its eddies, slices for ParaView, numbers at given positions
    #[command(after_help = AIR_HELP, mut_arg("out", |out| out.help("Folder for the results [default: \
        results/<name of the case>_air], or file for the numbers of --at")))]
    Air(Air),
    /// Open a page: the web of a line while you turn its knobs, or eight moving fibres while you change them
    #[command(after_help = LIVE_HELP)]
    Live(Live),
    /// Reproduce every result figure of the paper and test its claims
    #[command(after_help = REPRODUCE_HELP, mut_arg("out", |out| out.help("Folder for the results [default: \
        results/paper]")))]
    Reproduce(Reproduce),
    /// Make the air of a case from a velocity record, or measure how uniform the web of a scan is
    #[command(after_help = ANALYSE_HELP, mut_arg("json", |json| json.help("Print analysis.json, or \
        summary.json of a web, instead of the table")))]
    Analyse(Box<Analyse>),
    /// Compare the results of runs or of webs: differences, whether they are significant, curves in one figure
    #[command(after_help = COMPARE_HELP, mut_arg("out", |out| out.help("Folder for the report [default: \
        results/<name>_against_<name>]")), mut_arg("json", |json| json.help("Print comparison.json instead \
        of the table; without --out, write no files")))]
    Compare(Compare),
    /// Show a case, a web or a study with all defaults and what follows from it, without a simulation
    #[command(after_help = CHECK_HELP)]
    Check(Check),
    /// Explain the keys of a case or of a web: meaning, allowed values, default
    #[command(after_help = KEYS_HELP)]
    Keys(Keys),
    /// Write a commented case file to start from, or the file of a web from the numbers of a line
    #[command(after_help = NEW_HELP)]
    New(Box<New>),
    /// Print a script that completes commands, options and keys in your shell
    #[command(
        after_help = "Example:\n  spunlaid completions bash > ~/.local/share/bash-completion/completions/spunlaid"
    )]
    Completions(Completions),
    /// Write the manual pages of all commands
    #[command(after_help = "Example:\n  spunlaid man ~/.local/share/man/man1 && man spunlaid-run")]
    Man(Man),
}

#[derive(Debug, Args)]
pub(crate) struct Run {
    #[command(flatten)]
    pub(crate) source: CaseSource,
    #[command(flatten)]
    pub(crate) output: Output,
    /// Number of fibres, each in its own turbulence; replaces run.replicates
    #[arg(long, value_name = "N", value_parser = whole(0))]
    pub(crate) replicates: Option<u64>,
    /// Seed of the turbulence; replaces run.seed
    #[arg(long, value_name = "S", value_parser = whole(0))]
    pub(crate) seed: Option<u64>,
    /// What the checks of step and mesh may cost; replaces run.checks
    #[arg(long, value_parser = one_of(CHECKS, Checks::name))]
    pub(crate) checks: Option<Checks>,
    #[command(flatten)]
    pub(crate) threads: Threads,
    #[command(flatten)]
    pub(crate) figures: Figures,
}

#[derive(Debug, Args)]
pub(crate) struct Sweep {
    /// Study file (TOML)
    #[arg(value_name = "STUDY", value_hint = ValueHint::FilePath)]
    pub(crate) study: PathBuf,
    #[command(flatten)]
    pub(crate) output: Output,
    #[command(flatten)]
    pub(crate) threads: Threads,
    /// Set a key of the case or of the web for all points, as run.duration="2 s"; can be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_and_value)]
    pub(crate) set: Vec<(String, String)>,
    /// Fibres or webs at each point, in place of the study's; with more than before, a finished study goes on
    #[arg(long, value_name = "N", value_parser = whole(1))]
    pub(crate) replicates: Option<u64>,
    /// Confirm the number of points; needed above 10000 points
    #[arg(long, value_name = "N", value_parser = whole(0))]
    pub(crate) points: Option<u64>,
    /// Print the case or the web of point K, counted from 1, and simulate nothing
    #[arg(long, value_name = "K", value_parser = whole(0))]
    pub(crate) print_point: Option<u64>,
    #[command(flatten)]
    pub(crate) figures: Figures,
}

impl Run {
    /// The keys that options of their own replace, with their values.
    pub(crate) fn changes(&self) -> Vec<(&'static str, String)> {
        let numbers = [("run.replicates", self.replicates), ("run.seed", self.seed)];
        let numbers = numbers.into_iter().filter_map(|(key, value)| Some((key, value?.to_string())));
        numbers.chain(self.checks.map(|checks| ("run.checks", format!("\"{}\"", checks.name())))).collect()
    }
}

#[derive(Debug, Args)]
pub(crate) struct Spin {
    /// File with the table [spinline] (TOML), alone or in a case
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    #[command(flatten)]
    pub(crate) output: Output,
    /// Set a key of the spinline, as spinline.throughput="0.4 g/min"; can be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_and_value)]
    pub(crate) set: Vec<(String, String)>,
    #[command(flatten)]
    pub(crate) figures: Figures,
}

#[derive(Debug, Args)]
pub(crate) struct Air {
    #[command(flatten)]
    pub(crate) source: CaseSource,
    #[command(flatten)]
    pub(crate) output: Output,
    /// Simulate the filaments of a line in its CFD field, and write what they do to the air of each cell, for the CFD
    /// program
    #[arg(long, conflicts_with_all = ["replicate", "frames", "duration"])]
    pub(crate) sources: bool,
    /// Print the air at the positions of this table (columns x [m], y [m] and z [m], or in other units) as CSV; --out
    /// names a file for it
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath,
          conflicts_with_all = ["sources", "replicate", "frames", "duration", "json"])]
    pub(crate) at: Option<PathBuf>,
    /// Axes of the positions and velocities of --at: of the line, from the inlet or the root, or of the file of a CFD
    /// field [default: field, if the air is one]
    #[arg(long, value_parser = one_of(AXES, PlaceAxes::name), requires = "at")]
    pub(crate) axes: Option<PlaceAxes>,
    /// The replicate whose air it is, as they are numbered in a run
    #[arg(long, value_name = "N", default_value_t = 1)]
    #[arg(value_parser = clap::value_parser!(u64).range(1..=u64::from(u32::MAX)))]
    pub(crate) replicate: u64,
    /// Number of instants
    #[arg(long, value_name = "N", default_value_t = 60, value_parser = clap::value_parser!(u64).range(1..=200))]
    pub(crate) frames: u64,
    /// Time from the first instant to the last, as "20 ms" [default: as long as the air needs for the way]
    #[arg(long, value_name = "TIME", value_parser = quantity(Dimension::Time))]
    pub(crate) duration: Option<f64>,
    #[command(flatten)]
    pub(crate) threads: Threads,
    #[command(flatten)]
    pub(crate) figures: Figures,
}

#[derive(Debug, Args)]
pub(crate) struct Web {
    /// File of the web (TOML)
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    #[command(flatten)]
    pub(crate) output: Output,
    /// Set a key of the web, as line.belt_speed="6 m/s", or change it, as line.throughput="+20 %"; or one of
    /// its case, as belt.distance="0.4 m"; can be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_and_value)]
    pub(crate) set: Vec<(String, String)>,
    #[command(flatten)]
    pub(crate) threads: Threads,
    /// Try which settings make the web more uniform, also where that takes long: where every filament is
    /// simulated in shared turbulence, or the simulated time is long
    #[arg(long)]
    pub(crate) advice: bool,
    /// Do not try which settings make the web more uniform, which takes two simulations for each
    #[arg(long, conflicts_with = "advice")]
    pub(crate) no_advice: bool,
    /// Judge settings and assumed values by the CV over patches of this side, as 10mm, one of web.patches; or for
    /// thin-places or strips by the patches that these follow [default: 10 mm, or the size nearest to it]
    #[arg(long = "for", value_name = "PATCH")]
    pub(crate) judged_by: Option<String>,
    /// Write a specification sheet of one page (PDF): every number with its error
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) sheet: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) figures: Figures,
}

#[derive(Debug, Args)]
pub(crate) struct Live {
    /// Case file or file of a web (TOML) [default: the fibre of Table 1 of the paper]
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) case: Option<PathBuf>,
    /// Port of the page on this machine [default: any that is free]
    #[arg(long, value_name = "N")]
    pub(crate) port: Option<u16>,
    /// Print the address, and open no browser
    #[arg(long)]
    pub(crate) no_open: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Reproduce {
    #[command(flatten)]
    pub(crate) output: Output,
    /// Figures to draw, as 9,10,11a [default: all], and their formats, as 9,10,pdf [default: svg,png]
    #[arg(long, value_name = "LIST", value_delimiter = ',')]
    pub(crate) figures: Vec<String>,
    /// Fibres at each point; the paper has ten
    #[arg(long, value_name = "N", default_value_t = 10, value_parser = whole(1))]
    pub(crate) replicates: u64,
    /// Time integration: the paper's with 1 µs, or another with a suitable step
    #[arg(long, value_parser = one_of(SCHEMES, Scheme::name), default_value = "semi-implicit-euler")]
    pub(crate) scheme: Scheme,
    #[command(flatten)]
    pub(crate) threads: Threads,
    #[command(flatten)]
    pub(crate) width: FigureWidth,
}

/// Takes one of some values by its name.
///
/// * `all` – the values, each with what it means
pub(super) fn one_of<T: Copy + Send + Sync + 'static>(
    all: &'static [(T, &'static str)],
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T> {
    let names = all.iter().map(|(value, help)| PossibleValue::new(name(*value)).help(*help));
    let value =
        move |text: String| all.iter().find(|(value, _)| name(*value) == text).map(|(value, _)| *value);
    PossibleValuesParser::new(names).try_map(move |text| value(text).ok_or("is no such name"))
}

const CHECKS: &[(Checks, &str)] = &[
    (Checks::Auto, "Together a fifth of the flight"),
    (Checks::None, "Nothing: no check"),
    (Checks::Full, "As much as the whole run takes with a finer step and finer elements"),
];
const AXES: &[(PlaceAxes, &str)] = &[
    (PlaceAxes::Line, "x along gravity, y in machine direction, z in cross direction"),
    (PlaceAxes::Field, "x, y and z of the file"),
];
const SCHEMES: &[(Scheme, &str)] = &[
    (Scheme::SemiImplicitEuler, "First order, the paper's"),
    (Scheme::Leapfrog, "Second order"),
    (Scheme::ImplicitTension, "Long steps, hundreds of times faster"),
];

/// Reads a whole number from `least`.
fn whole(least: u64) -> impl Fn(&str) -> Result<u64, String> + Clone {
    move |text| {
        let number = text.trim().parse().ok().filter(|number| *number >= least);
        number.ok_or_else(|| format!("write a whole number from {least} in digits, like 1000"))
    }
}

/// Reads a quantity in SI units.
pub(crate) fn quantity(dimension: Dimension) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| {
        let value = dimension.parse(text).map_err(|fault| fault.to_string())?;
        let signed = dimension == Dimension::Velocity;
        if value > 0.0 || (signed && value < 0.0) { Ok(value) } else { Err("is not above zero".to_owned()) }
    }
}

#[derive(Debug, Args)]
pub(crate) struct Compare {
    /// Results folders of runs, or of webs, the one to compare with first; or files of which these are made
    #[arg(value_name = "RUN", value_hint = ValueHint::AnyPath, num_args = 2.., required = true)]
    pub(crate) runs: Vec<PathBuf>,
    #[command(flatten)]
    pub(crate) output: Output,
    #[command(flatten)]
    pub(crate) figures: Figures,
}

#[derive(Debug, Args)]
pub(crate) struct Check {
    #[command(flatten)]
    pub(crate) source: CaseSource,
}

#[derive(Debug, Args)]
pub(crate) struct Keys {
    /// Show only keys with this word in their name, their meaning or other words for them, or with this unit
    pub(crate) pattern: Option<String>,
    /// Print Markdown; docs/keys.md is made this way
    #[arg(long)]
    pub(crate) markdown: bool,
    /// Show the keys of the file of a web in place of those of a case
    #[arg(long)]
    pub(crate) web: bool,
    /// Show the keys of the file of a study in place of those of a case
    #[arg(long, conflicts_with = "web")]
    pub(crate) study: bool,
}

#[derive(Debug, Args)]
pub(crate) struct Man {
    /// Folder to write to; it is made if it does not exist
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) folder: PathBuf,
}

#[derive(Debug, Args)]
pub(crate) struct Completions {
    /// The shell
    pub(crate) shell: Shell,
}
