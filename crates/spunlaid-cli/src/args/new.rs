//! `spunlaid new`: a file to start from, and the numbers of a line for one of a web.

use super::quantity;
use clap::{Args, ValueHint};
use spunlaid::spinline::Polymer;
use spunlaid::units::Dimension;
use std::path::PathBuf;

/// Most beams of a line, and most holes of a beam.
pub(crate) const MOST_BEAMS: u64 = 20;
pub(crate) const MOST_HOLES: u64 = 10_000_000;

#[derive(Debug, Args)]
pub(crate) struct New {
    /// File to write; it must not exist yet. A single - is standard output
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    /// A fibre that is fed at an inlet and laid on a moving belt, in place of one of fixed length
    #[arg(long, conflicts_with = "web")]
    pub(crate) fed: bool,
    /// The file of a web, with the case of its filament and a table of the air beside it
    #[arg(long)]
    pub(crate) web: bool,
    /// Write FILE_study.toml beside FILE, a study of this case, web or spinline; a case that does not exist yet is written too
    #[arg(long, conflicts_with = "web")]
    pub(crate) study: bool,
    #[command(flatten)]
    pub(crate) line: LineNumbers,
}

/// The numbers by which a line is known.
#[derive(Clone, Debug, Default, Args)]
#[command(next_help_heading = "Numbers of the line, with --web")]
pub(crate) struct LineNumbers {
    /// Polymer: pp, pet, pa6 or pla
    #[arg(long, value_name = "NAME", requires = "web", value_parser = polymer)]
    pub(crate) polymer: Option<Polymer>,
    /// Throughput of a hole in g/min, or with its unit, as "0.5 g/min/hole"
    #[arg(long, value_name = "FLOW", requires = "web", value_parser = throughput)]
    pub(crate) throughput: Option<f64>,
    /// Titre of a filament in dtex, or with its unit, as "1.8 den"
    #[arg(long, value_name = "TITRE", requires = "web", conflicts_with = "diameter", value_parser = titre)]
    pub(crate) dtex: Option<f64>,
    /// Diameter of a filament in µm in place of the titre, or with its unit, as "16 µm"
    #[arg(long, value_name = "LENGTH", requires = "web", value_parser = diameter)]
    pub(crate) diameter: Option<f64>,
    /// Basis weight of the web in g/m², of all beams together, or with its unit, as "20 gsm"
    #[arg(long, value_name = "WEIGHT", requires = "web", value_parser = basis_weight)]
    pub(crate) basis_weight: Option<f64>,
    /// Holes of a beam per metre of width
    #[arg(long, value_name = "N", requires = "web", value_parser = holes())]
    pub(crate) holes_per_metre: Option<u64>,
    /// Holes of a beam in all, in place of those per metre; needs --width
    #[arg(long, value_name = "N", requires_all = ["web", "width"], conflicts_with = "holes_per_metre", value_parser = holes())]
    pub(crate) holes: Option<u64>,
    /// Speed of the air at the end of the slot in m/s, or with its unit, as "3600 m/min"
    #[arg(long, value_name = "SPEED", requires = "web", value_parser = speed)]
    pub(crate) air_speed: Option<f64>,
    /// Width of the web in m, or with its unit, as "3200 mm" [default: "1 m"]
    #[arg(long, value_name = "LENGTH", requires = "web", value_parser = length)]
    pub(crate) width: Option<f64>,
    /// Distance from the slot to the belt in m, or with its unit, as "500 mm" [default: "0.5 m"]
    #[arg(long, value_name = "LENGTH", requires = "web", value_parser = length)]
    pub(crate) distance: Option<f64>,
    /// Number of equal beams, one behind the other [default: 1]
    #[arg(long, value_name = "N", requires = "web", value_parser = clap::value_parser!(u64).range(1..=MOST_BEAMS))]
    pub(crate) beams: Option<u64>,
}

fn holes() -> impl clap::builder::TypedValueParser<Value = u64> {
    clap::value_parser!(u64).range(1..=MOST_HOLES)
}

/// A polymer by its name, in capitals or not.
pub(crate) fn polymer(name: &str) -> Result<Polymer, String> {
    let wanted = name.trim().to_lowercase().replace(['-', ' '], "");
    let known = Polymer::ALL.into_iter().find(|polymer| polymer.name() == wanted);
    known.ok_or_else(|| {
        let all = Polymer::ALL.map(Polymer::name).join(", ");
        let melt = ["mfr", "mfi", "melt flow", "g/10"].iter().any(|word| name.to_lowercase().contains(word));
        match melt {
            true => format!(
                "write one of {all} alone; a melt flow rate changes nothing here, because the filaments begin at the slot with their titre \
                 (of a line from the die it is spinline.melt_flow_rate)"
            ),
            false => format!("write one of {all}"),
        }
    })
}

/// A quantity [SI]; a number without a unit has the unit of its question.
fn in_unit(dimension: Dimension, unit: &'static str) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |text| {
        let with_unit = match text.trim().parse::<f64>() {
            Ok(_) => format!("{} {unit}", text.trim()),
            Err(_) => text.to_owned(),
        };
        quantity(dimension)(&with_unit)
    }
}

/// A titre [kg/m]; a number without a unit is one in dtex.
pub(crate) fn titre(text: &str) -> Result<f64, String> {
    in_unit(Dimension::LinearDensity, "dtex")(text)
}

/// A throughput of a hole [kg/s]; a number without a unit is one in g/min.
pub(crate) fn throughput(text: &str) -> Result<f64, String> {
    in_unit(Dimension::MassFlow, "g/min")(text)
}

/// A diameter [m]; a number without a unit is one in µm.
fn diameter(text: &str) -> Result<f64, String> {
    in_unit(Dimension::Length, "µm")(text)
}

/// A basis weight [kg/m²]; a number without a unit is one in g/m².
pub(crate) fn basis_weight(text: &str) -> Result<f64, String> {
    in_unit(Dimension::BasisWeight, "g/m²")(text)
}

/// A speed [m/s].
pub(crate) fn speed(text: &str) -> Result<f64, String> {
    in_unit(Dimension::Velocity, "m/s")(text)
}

/// A length [m].
pub(crate) fn length(text: &str) -> Result<f64, String> {
    in_unit(Dimension::Length, "m")(text)
}
