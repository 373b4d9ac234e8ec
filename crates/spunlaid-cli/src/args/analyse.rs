//! `spunlaid analyse`: how a velocity record, or a scan of a web, is read.

use super::output::Output;
use super::{Figures, one_of, quantity};
use clap::{ArgAction, Args, ValueHint};
use spunlaid::air::{IntegralRule, Layout, Settings, SpectrumSettings};
use spunlaid::ground::{Dimension, Window};
use spunlaid::web::{LightKind, ScanRequest};
use std::path::PathBuf;

#[derive(Debug, Args)]
pub(crate) struct Analyse {
    /// Velocity record (CSV or Parquet), or scan or map of a web (PNG, TIFF, .npy, CSV)
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) record: PathBuf,
    #[command(flatten)]
    pub(crate) scan: Scan,
    #[command(flatten)]
    pub(crate) output: Output,
    #[command(flatten)]
    pub(crate) reading: RecordOptions,
    #[command(flatten)]
    pub(crate) figures: Figures,
}

/// How a velocity record is read.
#[derive(Debug, Args)]
pub(crate) struct RecordOptions {
    /// Sampling rate, as "20 kHz"; a time column is then ignored
    #[arg(long, value_name = "RATE", value_parser = quantity(Dimension::Frequency))]
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
    /// Largest number of missing samples in a row that are interpolated
    #[arg(long, value_name = "SAMPLES", default_value_t = spunlaid::air::LONGEST_GAP)]
    pub(crate) max_gap: usize,
    /// Mean velocity, as "10 m/s", if the record holds the fluctuation only
    #[arg(long, value_name = "SPEED", value_parser = quantity(Dimension::Velocity))]
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
    #[arg(long, value_name = "FREQUENCY", value_parser = quantity(Dimension::Frequency))]
    pub(crate) flat_until: Option<f64>,
}

impl RecordOptions {
    /// How its file is read.
    pub(crate) fn layout(&self) -> Layout {
        Layout {
            rate: self.rate,
            time_unit: self.time_unit.clone(),
            velocity_unit: self.velocity_unit.clone(),
            columns: self.columns.clone(),
            time_column: self.time_column.clone(),
            skip_lines: self.skip,
            longest_gap: self.max_gap,
        }
    }

    /// How it is analysed.
    pub(crate) fn settings(&self) -> Settings {
        Settings {
            integral: self.integral,
            spectrum: SpectrumSettings { window: self.window, overlap: self.overlap, segment: self.segment },
            flat_until: self.flat_until,
            mean_velocity: self.mean_velocity,
        }
    }
}

/// How a scan of a web is read.
#[derive(Debug, Args)]
#[command(next_help_heading = "Scan or map of a web")]
pub(crate) struct Scan {
    /// Side of a pixel, as "0.1 mm" [default for PNG and TIFF: as the file says]
    #[arg(long, value_name = "LENGTH", value_parser = quantity(Dimension::Length))]
    pub(crate) pixel: Option<f64>,
    /// Mean basis weight of the sheet, as "15 g/m²" or "15 gsm"
    #[arg(long, value_name = "WEIGHT", value_parser = quantity(Dimension::BasisWeight))]
    pub(crate) weight: Option<f64>,
    /// What the values are [default: transmitted for PNG and TIFF, weight for .npy and CSV]
    #[arg(long, value_parser = one_of(LIGHTS, LightKind::name))]
    pub(crate) light: Option<LightKind>,
    /// Picture of the lamp without web, at the same exposure; it takes out any shading
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) lamp: Option<PathBuf>,
    /// Grey level of the lamp without web, or in reflected light of a web too thick to see through [default:
    /// the largest that the file can hold]
    #[arg(long, value_name = "LEVEL", conflicts_with = "lamp", value_parser = above_zero)]
    pub(crate) white: Option<f64>,
    /// Take the lamp as uniform. Otherwise, without --lamp, its shading is taken out as a smooth surface
    #[arg(long)]
    pub(crate) keep_shading: bool,
    /// Take the whole picture as web. Otherwise the bare lamp or a bare strip next to it, dust and blots are left out
    #[arg(long)]
    pub(crate) keep_spots: bool,
    /// Standard deviation of the noise of a single pixel, which is then taken out
    #[arg(long, value_name = "LEVELS", value_parser = above_zero)]
    pub(crate) noise: Option<f64>,
    /// Titre of the filaments, as "2 dtex"; with --weight it gives the formation number
    #[arg(long, value_name = "TITRE", value_parser = quantity(Dimension::LinearDensity))]
    pub(crate) titre: Option<f64>,
    /// Where the machine direction runs in the picture
    #[arg(long, value_name = "MD", default_value = "columns", hide_possible_values = false, action = ArgAction::Set,
          value_parser = one_of(DIRECTIONS, |along_rows| if along_rows { "rows" } else { "columns" }))]
    pub(crate) md: bool,
    /// Sides of the patches, as "1 mm,5 mm,10 mm" [default: from 0.5 mm to a fifth of the picture]
    #[arg(long, value_name = "LENGTHS", value_delimiter = ',',
          value_parser = quantity(Dimension::Length))]
    pub(crate) patches: Vec<f64>,
}

impl Scan {
    /// How it is read and analysed.
    pub(crate) fn request(&self) -> ScanRequest {
        ScanRequest {
            pixel: self.pixel,
            light: self.light,
            weight: self.weight,
            white: self.white,
            lamp: self.lamp.clone(),
            md_along_rows: self.md,
            keep_shading: self.keep_shading,
            keep_spots: self.keep_spots,
            noise: self.noise,
            titre: self.titre,
            patches: self.patches.clone(),
        }
    }
}

const LIGHTS: &[(LightKind, &str)] = &[
    (LightKind::Transmitted, "Light that has come through the web"),
    (LightKind::Reflected, "Light that a web on a black ground throws back"),
    (LightKind::Weight, "Basis weights, in kg/m² or, with --weight, in any unit"),
];
/// Whether the machine direction runs along the rows of a picture.
const DIRECTIONS: &[(bool, &str)] =
    &[(false, "Along the columns, downwards"), (true, "Along the rows, to the right")];

fn above_zero(text: &str) -> Result<f64, String> {
    let value = text.trim().parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0);
    value.ok_or_else(|| "write a number above zero, like 240".to_owned())
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
