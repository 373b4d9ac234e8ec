//! The units of each dimension.

use super::Dimension;

/// How a unit relates to the SI unit of its dimension.
#[derive(Clone, Copy, Debug)]
pub(super) enum Scale {
    /// `10^n` SI units.
    Ten(i32),
    /// This number of SI units.
    Times(f64),
    /// The inverse: one SI unit is this number of these units.
    Over(f64),
    /// Counted from a zero that is this number of SI units.
    Above(f64),
}

impl Scale {
    /// Size of the unit, or of its steps, in SI units.
    pub(super) fn size(self) -> f64 {
        match self {
            Self::Ten(power) => 10f64.powi(power),
            Self::Times(size) => size,
            Self::Over(number) => 1.0 / number,
            Self::Above(_) => 1.0,
        }
    }
}

/// A unit: its symbol, its spelling in plain ASCII without `^`, and its size.
pub(super) struct Unit {
    pub(super) shown: &'static str,
    pub(super) plain: &'static str,
    pub(super) scale: Scale,
    /// Whether [`Dimension::pretty`] may choose it.
    pub(super) pretty: bool,
}

const fn unit(shown: &'static str, plain: &'static str, scale: Scale) -> Unit {
    Unit { shown, plain, scale, pretty: true }
}

const fn also(shown: &'static str, plain: &'static str, scale: Scale) -> Unit {
    Unit { shown, plain, scale, pretty: false }
}

use Scale::{Above, Over, Ten, Times};

const LENGTH: &[Unit] = &[
    unit("m", "m", Ten(0)),
    also("cm", "cm", Ten(-2)),
    unit("mm", "mm", Ten(-3)),
    unit("µm", "um", Ten(-6)),
    unit("nm", "nm", Ten(-9)),
];
const VELOCITY: &[Unit] = &[
    unit("m/s", "m/s", Ten(0)),
    also("cm/s", "cm/s", Ten(-2)),
    also("mm/s", "mm/s", Ten(-3)),
    also("km/h", "km/h", Over(3.6)),
    also("m/min", "m/min", Over(60.0)),
];
const TIME: &[Unit] = &[
    unit("s", "s", Ten(0)),
    unit("ms", "ms", Ten(-3)),
    unit("µs", "us", Ten(-6)),
    unit("ns", "ns", Ten(-9)),
    also("min", "min", Times(60.0)),
    also("h", "h", Times(3600.0)),
];
const FREQUENCY: &[Unit] = &[unit("Hz", "Hz", Ten(0)), unit("kHz", "kHz", Ten(3))];
const RATE: &[Unit] = &[unit("1/s", "1/s", Ten(0)), also("s⁻¹", "s-1", Ten(0))];
const DENSITY: &[Unit] = &[unit("kg/m³", "kg/m3", Ten(0)), also("g/cm³", "g/cm3", Ten(3))];
const LINEAR_DENSITY: &[Unit] = &[
    unit("kg/m", "kg/m", Ten(0)),
    also("g/m", "g/m", Ten(-3)),
    unit("tex", "tex", Ten(-6)),
    unit("dtex", "dtex", Ten(-7)),
    // A denier is a gram per 9 km.
    also("den", "den", Over(9e6)),
];
const BASIS_WEIGHT: &[Unit] =
    &[unit("kg/m²", "kg/m2", Ten(0)), unit("g/m²", "g/m2", Ten(-3)), also("gsm", "gsm", Ten(-3))];
const PRESSURE: &[Unit] = &[
    unit("Pa", "Pa", Ten(0)),
    unit("kPa", "kPa", Ten(3)),
    unit("MPa", "MPa", Ten(6)),
    unit("GPa", "GPa", Ten(9)),
    also("N/mm²", "N/mm2", Ten(6)),
];
const KINEMATIC_VISCOSITY: &[Unit] =
    &[unit("m²/s", "m2/s", Ten(0)), also("mm²/s", "mm2/s", Ten(-6)), also("cSt", "cSt", Ten(-6))];
const ACCELERATION: &[Unit] = &[unit("m/s²", "m/s2", Ten(0))];
const TEMPERATURE: &[Unit] = &[unit("K", "K", Ten(0)), unit("°C", "°C", Above(273.15))];
const DYNAMIC_VISCOSITY: &[Unit] =
    &[unit("Pa s", "Pa s", Ten(0)), also("Pa·s", "Pa·s", Ten(0)), also("mPa s", "mPa s", Ten(-3))];
const MASS_FLOW: &[Unit] = &[
    also("kg/s", "kg/s", Ten(0)),
    also("g/s", "g/s", Ten(-3)),
    also("kg/h", "kg/h", Over(3600.0)),
    unit("g/min", "g/min", Over(60_000.0)),
    // Of a hole, in the words of a line.
    also("g/min/hole", "g/min/hole", Over(60_000.0)),
    also("g/hole/min", "g/hole/min", Over(60_000.0)),
    also("ghm", "ghm", Over(60_000.0)),
];
const FORCE: &[Unit] = &[
    unit("N", "N", Ten(0)),
    unit("mN", "mN", Ten(-3)),
    unit("µN", "uN", Ten(-6)),
    also("cN", "cN", Ten(-2)),
];
const SURFACE_TENSION: &[Unit] = &[unit("N/m", "N/m", Ten(0)), unit("mN/m", "mN/m", Ten(-3))];
const INVERSE_PRESSURE: &[Unit] = &[unit("1/Pa", "1/Pa", Ten(0)), also("Pa⁻¹", "Pa-1", Ten(0))];
const SPECIFIC_VOLUME: &[Unit] = &[unit("m³/kg", "m3/kg", Ten(0)), also("cm³/g", "cm3/g", Ten(-3))];
const SPECIFIC_VOLUME_SLOPE: &[Unit] =
    &[unit("m³/(kg K)", "m3/(kg K)", Ten(0)), also("cm³/(g K)", "cm3/(g K)", Ten(-3))];
const SPECIFIC_ENERGY: &[Unit] =
    &[unit("J/kg", "J/kg", Ten(0)), unit("kJ/kg", "kJ/kg", Ten(3)), also("J/g", "J/g", Ten(3))];
const HEAT_CAPACITY: &[Unit] = &[
    unit("J/(kg K)", "J/(kg K)", Ten(0)),
    also("kJ/(kg K)", "kJ/(kg K)", Ten(3)),
    also("J/(g K)", "J/(g K)", Ten(3)),
];
const HEAT_CAPACITY_SLOPE: &[Unit] =
    &[unit("J/(kg K²)", "J/(kg K2)", Ten(0)), also("J/(g K²)", "J/(g K2)", Ten(3))];
const MOLAR_ENERGY: &[Unit] = &[unit("J/mol", "J/mol", Ten(0)), unit("kJ/mol", "kJ/mol", Ten(3))];
const TEMPERATURE_DIFFERENCE: &[Unit] = &[unit("K", "K", Ten(0))];
const NOISE: &[Unit] = &[unit("m^-0.5", "m-0.5", Ten(0)), also("1/√m", "1/√m", Ten(0))];
const SPECIFIC_CHARGE: &[Unit] = &[
    also("C/kg", "C/kg", Ten(0)),
    also("mC/kg", "mC/kg", Ten(-3)),
    unit("µC/g", "uC/g", Ten(-3)),
    unit("nC/g", "nC/g", Ten(-6)),
    also("µC/kg", "uC/kg", Ten(-6)),
];
const ELECTRIC_FIELD: &[Unit] =
    &[unit("V/m", "V/m", Ten(0)), unit("kV/m", "kV/m", Ten(3)), unit("MV/m", "MV/m", Ten(6))];
const MEMORY: &[Unit] = &[
    unit("B", "B", Ten(0)),
    unit("kB", "kB", Ten(3)),
    unit("MB", "MB", Ten(6)),
    unit("GB", "GB", Ten(9)),
    also("MiB", "MiB", Times(1_048_576.0)),
    also("GiB", "GiB", Times(1_073_741_824.0)),
];
// A degree is the 180th part of π.
const ANGLE: &[Unit] = &[
    also("rad", "rad", Ten(0)),
    unit("°", "°", Over(180.0 / std::f64::consts::PI)),
    also("deg", "deg", Over(180.0 / std::f64::consts::PI)),
];
const RATIO: &[Unit] = &[unit("", "", Ten(0)), also("%", "%", Ten(-2))];

impl Dimension {
    /// The units of this dimension, the SI unit first.
    pub(super) const fn units(self) -> &'static [Unit] {
        match self {
            Self::Length => LENGTH,
            Self::Velocity => VELOCITY,
            Self::Time => TIME,
            Self::Frequency => FREQUENCY,
            Self::Rate => RATE,
            Self::Density => DENSITY,
            Self::LinearDensity => LINEAR_DENSITY,
            Self::BasisWeight => BASIS_WEIGHT,
            Self::Pressure => PRESSURE,
            Self::KinematicViscosity => KINEMATIC_VISCOSITY,
            Self::Acceleration => ACCELERATION,
            Self::Temperature => TEMPERATURE,
            Self::DynamicViscosity => DYNAMIC_VISCOSITY,
            Self::MassFlow => MASS_FLOW,
            Self::Force => FORCE,
            Self::SurfaceTension => SURFACE_TENSION,
            Self::InversePressure => INVERSE_PRESSURE,
            Self::SpecificVolume => SPECIFIC_VOLUME,
            Self::SpecificVolumeSlope => SPECIFIC_VOLUME_SLOPE,
            Self::SpecificEnergy => SPECIFIC_ENERGY,
            Self::HeatCapacity => HEAT_CAPACITY,
            Self::HeatCapacitySlope => HEAT_CAPACITY_SLOPE,
            Self::MolarEnergy => MOLAR_ENERGY,
            Self::TemperatureDifference => TEMPERATURE_DIFFERENCE,
            Self::Noise => NOISE,
            Self::SpecificCharge => SPECIFIC_CHARGE,
            Self::ElectricField => ELECTRIC_FIELD,
            Self::Memory => MEMORY,
            Self::Angle => ANGLE,
            Self::Ratio => RATIO,
        }
    }
}
