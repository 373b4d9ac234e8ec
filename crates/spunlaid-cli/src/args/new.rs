//! `spunlaid new`: a file to start from, and the numbers of a line for one of a web.

use self::Need::{IfKnown, Needed, Usual};
use super::quantity;
use clap::{Args, ValueHint};
use spunlaid::fibre::Polymer;
use spunlaid::ground::Dimension;
use spunlaid::ground::units::with_decimal_point;
use std::path::PathBuf;

/// Most beams of a line, and most holes of a beam.
const MOST_BEAMS: u64 = 20;
const MOST_HOLES: u64 = 10_000_000;

#[derive(Debug, Args)]
pub(crate) struct New {
    /// File to write; it must not exist yet. A single - is standard output
    #[arg(value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub(crate) file: PathBuf,
    /// A fibre that is fed at an inlet and laid on a moving belt, in place of one of fixed length
    #[arg(long, conflicts_with = "web")]
    pub(crate) fed: bool,
    /// The file of a web, with the case of its filament and a table of the air next to it
    #[arg(long)]
    pub(crate) web: bool,
    /// Write FILE_study.toml next to FILE, a study of this case, web or spinline; a case that does not exist
    /// yet is written too
    #[arg(long, conflicts_with = "web")]
    pub(crate) study: bool,
    #[command(flatten)]
    pub(crate) line: LineNumbers,
}

/// The numbers by which a line is known.
#[derive(Clone, Debug, Args)]
#[command(next_help_heading = "Numbers of the line, with --web")]
pub(crate) struct LineNumbers {
    /// Polymer: pp, pet, pa6, pla or pe, in capitals or not
    #[arg(long, value_name = "NAME", requires = "web", value_parser = polymer)]
    pub(crate) polymer: Option<Given<Polymer>>,
    /// Throughput of a hole in g/min, or with its unit, as "0.5 g/min/hole"
    #[arg(long, value_name = "FLOW", requires = "web", value_parser = in_unit(Dimension::MassFlow, "g/min"))]
    pub(crate) throughput: Option<Given<f64>>,
    /// Titre of a filament in dtex, or with its unit, as "1.8 den"
    #[arg(long, value_name = "TITRE", requires = "web", conflicts_with = "diameter")]
    #[arg(value_parser = in_unit(Dimension::LinearDensity, "dtex"))]
    pub(crate) dtex: Option<Given<f64>>,
    /// Diameter of a filament in µm in place of the titre, or with its unit, as "16 µm"
    #[arg(long, value_name = "LENGTH", requires = "web", value_parser = in_unit(Dimension::Length, "µm"))]
    pub(crate) diameter: Option<Given<f64>>,
    /// Basis weight of the web in g/m², of all beams together, or with its unit, as "20 gsm"
    #[arg(long, value_name = "WEIGHT", requires = "web", value_parser = in_unit(Dimension::BasisWeight, "g/m²"))]
    pub(crate) basis_weight: Option<Given<f64>>,
    /// Speed of the belt in m/min in place of the basis weight, or with its unit, as "4 m/s"
    #[arg(long, value_name = "SPEED", requires = "web", value_parser = in_unit(Dimension::Velocity, "m/min"))]
    pub(crate) belt_speed: Option<Given<f64>>,
    /// Holes of a beam per metre of width
    #[arg(long, value_name = "N", requires = "web", value_parser = count(MOST_HOLES))]
    pub(crate) holes_per_metre: Option<u64>,
    /// Holes of a beam in all, in place of those per metre; needs --width
    #[arg(long, value_name = "N", requires_all = ["web", "width"], conflicts_with = "holes_per_metre")]
    #[arg(value_parser = count(MOST_HOLES))]
    pub(crate) holes: Option<u64>,
    /// Speed of the air at the end of the slot in m/s, or with its unit, as "3600 m/min"
    #[arg(long, value_name = "SPEED", requires = "web", value_parser = in_unit(Dimension::Velocity, "m/s"))]
    pub(crate) air_speed: Option<Given<f64>>,
    /// Pressure of the cabin above that under the belt in Pa instead of that speed, or with its unit, as
    /// "14 inH2O"; the two together give the coefficient of speed of the slot
    #[arg(long, value_name = "PRESSURE", requires = "web", value_parser = in_unit(Dimension::Pressure, "Pa"))]
    pub(crate) cabin_pressure: Option<Given<f64>>,
    /// Width of the web in m, or with its unit, as "3200 mm" [default: "1 m"]
    #[arg(long, value_name = "LENGTH", requires = "web", value_parser = in_unit(Dimension::Length, "m"))]
    #[arg(default_value = "1 m", hide_default_value = true)]
    pub(crate) width: Given<f64>,
    /// Distance from the slot to the belt in m, or with its unit, as "500 mm" [default: "0.5 m"]
    #[arg(long, value_name = "LENGTH", requires = "web", value_parser = in_unit(Dimension::Length, "m"))]
    #[arg(default_value = "0.5 m", hide_default_value = true)]
    pub(crate) distance: Given<f64>,
    /// Slot gap along the machine in mm, or with its unit [default: "20 mm", assumed]
    #[arg(long, value_name = "LENGTH", requires = "web", value_parser = in_unit(Dimension::Length, "mm"))]
    pub(crate) slot_gap: Option<Given<f64>>,
    /// Turbulence intensity of the air at the end of the slot, as "12 %" [default: "10 %", assumed]
    #[arg(long, value_name = "SHARE", requires = "web", value_parser = turbulence)]
    pub(crate) turbulence: Option<Given<f64>>,
    /// Thickness of the finished fabric in mm, or with its unit, as "250 µm", for the air permeability
    #[arg(long, value_name = "LENGTH", requires = "web", value_parser = in_unit(Dimension::Length, "mm"))]
    pub(crate) thickness: Option<Given<f64>>,
    /// Number of equal beams, one behind the other [default: 1]
    #[arg(long, value_name = "N", requires = "web", value_parser = count(MOST_BEAMS))]
    #[arg(default_value_t = 1, hide_default_value = true)]
    pub(crate) beams: u64,
    #[command(flatten)]
    pub(crate) melt: MeltNumbers,
}

/// The numbers of a line above the slot. With one of them, the line begins at the die.
#[derive(Clone, Debug, Args)]
#[command(
    next_help_heading = "Numbers from the die to the slot: with one of them, titre and speed follow from the melt"
)]
pub(crate) struct MeltNumbers {
    /// Temperature of the melt in the hole in °C [default: the usual one of the polymer]
    #[arg(long, value_name = "TEMPERATURE", requires = "web", value_parser = in_unit(Dimension::Temperature, "°C"))]
    pub(crate) die_temperature: Option<Given<f64>>,
    /// Melt flow rate of the polymer in g/10 min with 2.16 kg [default: 35 for pp]
    #[arg(long, value_name = "RATE", requires = "web", conflicts_with = "viscosity")]
    #[arg(value_parser = in_unit(Dimension::MeltFlowRate, "g/10 min"))]
    pub(crate) melt_flow_rate: Option<Given<f64>>,
    /// Viscosity of the melt in Pa s at the usual temperature of the polymer, in place of the melt flow rate
    #[arg(long, value_name = "VISCOSITY", requires = "web")]
    #[arg(value_parser = in_unit(Dimension::DynamicViscosity, "Pa s"))]
    pub(crate) viscosity: Option<Given<f64>>,
    /// Diameter of a hole of the spinneret in mm [default: "0.6 mm"]
    #[arg(long, value_name = "LENGTH", requires = "web", value_parser = in_unit(Dimension::Length, "mm"))]
    pub(crate) hole_diameter: Option<Given<f64>>,
    /// Velocity of the quench air across the filaments in m/s [default: "1 m/s"]
    #[arg(long, value_name = "SPEED", requires = "web", value_parser = in_unit(Dimension::Velocity, "m/s"))]
    pub(crate) quench: Option<Given<f64>>,
    /// Distance from the die to the end of the slot in m [default: "2.2 m"]
    #[arg(long, value_name = "LENGTH", requires = "web", value_parser = in_unit(Dimension::Length, "m"))]
    pub(crate) spinline_length: Option<Given<f64>>,
}

impl MeltNumbers {
    /// The numbers that were given.
    pub(crate) fn given(&self) -> impl Iterator<Item = &Given<f64>> {
        let Self { die_temperature, melt_flow_rate, viscosity, hole_diameter, quench, spinline_length } =
            self;
        let all = [die_temperature, melt_flow_rate, viscosity, hole_diameter, quench, spinline_length];
        all.into_iter().flatten()
    }
}

/// Whether a line can be written without a number.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Need {
    /// There is no line without it.
    Needed,
    /// The usual one is taken.
    Usual,
    /// It stays away if it is not known.
    IfKnown,
}
/// What is asked: the options of which the first takes the answer that can read it, the question, and what an empty
/// answer means.
pub(crate) const QUESTIONS: [(&[&str], Need, &str, &str); 12] = [
    (&["polymer"], Needed, "Polymer: pp, pet, pa6, pla or pe", "pp"),
    (&["throughput"], Needed, "Throughput of a hole", "0.5 g/min"),
    (&["dtex", "diameter"], Needed, "Titre or diameter of a filament", "2 dtex"),
    (&["basis-weight", "belt-speed"], Needed, "Basis weight of the web, or speed of its belt", "20 g/m²"),
    (&["width"], Usual, "Width of the web", "1 m"),
    (&["holes-per-metre", "holes"], Needed, "Holes of a beam per metre of width", "5000"),
    (&["beams"], Usual, "Number of equal beams", "1"),
    (
        &["air-speed", "cabin-pressure"],
        Needed,
        "Speed of the air at the end of the slot, or pressure of the cabin",
        "60 m/s",
    ),
    (&["distance"], Usual, "Distance from the slot to the belt", "0.5 m"),
    (&["slot-gap"], IfKnown, "Slot gap", "20 mm, assumed"),
    (&["turbulence"], IfKnown, "Turbulence of the air at its end", "10 %, assumed"),
    (&["thickness"], IfKnown, "Thickness of the finished fabric", "not known"),
];

/// A value as it was given, and what there is to say about it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Given<T> {
    pub(crate) value: T,
    pub(crate) remark: Option<String>,
}

impl<T> From<T> for Given<T> {
    fn from(value: T) -> Self {
        Self { value, remark: None }
    }
}

/// The value of a number that was given.
pub(crate) fn value<T: Copy>(given: &Option<Given<T>>) -> Option<T> {
    given.as_ref().map(|given| given.value)
}

impl LineNumbers {
    /// What there is to say about the numbers, each once.
    pub(crate) fn remarks(&self) -> impl Iterator<Item = &str> {
        let Self { polymer, throughput, dtex, diameter, basis_weight, belt_speed, air_speed, .. } = self;
        let Self { cabin_pressure, width, distance, slot_gap, turbulence, thickness, .. } = self;
        let of_line = [throughput, dtex, diameter, basis_weight, belt_speed, air_speed].into_iter().flatten();
        let of_air = [cabin_pressure, slot_gap, turbulence, thickness].into_iter().flatten();
        let numbers = of_line.chain([width, distance]).chain(of_air).chain(self.melt.given());
        let numbers = numbers.map(|given| &given.remark);
        polymer.iter().map(|given| &given.remark).chain(numbers).flatten().map(String::as_str)
    }
}

/// A number of holes or beams.
fn count(most: u64) -> impl Fn(&str) -> Result<u64, String> + Clone {
    move |text| {
        let number = text.trim().parse().ok().filter(|number| (1..=most).contains(number));
        number.ok_or_else(|| format!("write a whole number from 1 to {most}"))
    }
}

/// A polymer by its name, in capitals or not. A melt flow rate next to it is ignored, with a remark.
fn polymer(text: &str) -> Result<Given<Polymer>, String> {
    let lower = text.trim().to_lowercase();
    let named = |words: &[&str]| {
        let name = words.concat().replace('-', "");
        Polymer::ALL.into_iter().find(|polymer| polymer.name() == name)
    };
    let words: Vec<&str> =
        lower.split([' ', ',', ';', ':', '=', '(', ')']).filter(|word| !word.is_empty()).collect();
    if let Some(polymer) = named(&words) {
        return Ok(polymer.into());
    }
    let all = Polymer::ALL.map(Polymer::name).join(", ");
    let is_melt = ["mfr", "mfi", "melt flow", "g/10"].iter().any(|word| lower.contains(word));
    if !is_melt {
        return Err(format!("write one of {all}"));
    }
    // `PA 6` is two words.
    let among = || (1..=2).rev().flat_map(|count| words.windows(count)).find_map(named);
    let value = among().ok_or_else(|| format!("write one of {all} before the melt flow rate"))?;
    let remark = "the melt flow rate next to the polymer is not used: write it as --melt-flow-rate, and the line \
        begins at the die";
    Ok(Given { value, remark: Some(remark.to_owned()) })
}

/// A quantity [SI]; a number without a unit has the unit of its question, and a comma that can only be a decimal sign
/// is one. Both are said.
fn in_unit(dimension: Dimension, unit: &'static str) -> impl Fn(&str) -> Result<Given<f64>, String> + Clone {
    move |text| {
        let text = text.trim();
        let point = with_decimal_point(text);
        let read = point.as_deref().unwrap_or(text);
        let whole = match read.parse::<f64>() {
            Ok(_) => format!("{read} {unit}"),
            Err(_) => read.to_owned(),
        };
        let remark = match (&point, whole == read) {
            (None, true) => None,
            (None, false) => Some(format!("{text} has no unit and is taken as {whole}")),
            (Some(_), _) => Some(format!("{text} has a decimal comma and is taken as {whole}")),
        };
        Ok(Given { value: quantity(dimension)(&whole)?, remark })
    }
}

/// A turbulence intensity; a number without a unit is a share up to one, and per cent above.
fn turbulence(text: &str) -> Result<Given<f64>, String> {
    match text.trim().parse::<f64>() {
        Ok(share) if share <= 1.0 => quantity(Dimension::Ratio)(text.trim()).map(Given::from),
        _ => in_unit(Dimension::Ratio, "%")(text),
    }
}
