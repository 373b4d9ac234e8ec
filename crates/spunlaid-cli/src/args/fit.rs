//! The arguments of `spunlaid fit`.

use super::output::{Figures, Output, Threads};
use super::source::key_and_value;
use clap::{Args, ValueHint};
use spunlaid::experiment::{FEWEST_WEBS, USUAL_WEBS};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Fit {
    /// File of the web (TOML)
    #[arg(value_name = "WEB", value_hint = ValueHint::FilePath)]
    pub(crate) web: PathBuf,
    /// Results folder of spunlaid analyse of a scan, or of spunlaid web: the webs become like this one
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub(crate) to: PathBuf,
    /// One to four keys whose values are sought, each alone or with its range, as line.slot_gap, line.slot_gap="5
    /// mm..40 mm" or line.slot_gap="-50 %..+50 %"
    #[arg(long, value_name = "KEY[=FROM..TO],…", value_delimiter = ',', required = true)]
    pub(crate) vary: Vec<String>,
    /// Compare the spectrum too, across and along the web
    #[arg(long)]
    pub(crate) spectrum: bool,
    #[command(flatten)]
    pub(crate) output: Output,
    /// Set a key of the web or of its case, as line.belt_speed="6 m/s"; can be repeated
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = key_and_value)]
    pub(crate) set: Vec<(String, String)>,
    /// Simulated webs of each trial; more make the intervals more certain
    #[arg(long, value_name = "N", default_value_t = USUAL_WEBS)]
    #[arg(value_parser = clap::value_parser!(u64).range(FEWEST_WEBS..=1000))]
    pub(crate) webs: u64,
    #[command(flatten)]
    pub(crate) threads: Threads,
    #[command(flatten)]
    pub(crate) figures: Figures,
}
