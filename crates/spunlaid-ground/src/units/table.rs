//! The units of each dimension.

/// How a unit relates to the SI unit of its dimension.
#[derive(Clone, Copy, Debug)]
pub(super) enum Scale {
    /// `10^n` SI units.
    Ten(i32),
    /// This number of SI units.
    Times(f64),
    /// The inverse: one SI unit is this number of these units.
    Over(f64),
    /// Counted from a zero that is this number of SI units, in steps of so many.
    Above(f64, f64),
}

impl Scale {
    /// Size of the unit, or of its steps, in SI units.
    pub(super) fn size(self) -> f64 {
        match self {
            Self::Ten(power) => 10f64.powi(power),
            Self::Times(size) => size,
            Self::Over(number) => 1.0 / number,
            Self::Above(_, size) => size,
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

/// A dimension: its name with an article, the powers of metre, kilogram, second, kelvin and ampere of its SI unit, and
/// its units, the SI unit first.
pub(super) struct Row {
    pub(super) dimension: Dimension,
    pub(super) name: &'static str,
    pub(super) powers: [f64; 5],
    pub(super) units: &'static [Unit],
}

macro_rules! dimensions {
    ($($(#[$doc:meta])+ $variant:ident $name:literal $powers:tt $units:tt;)+) => {
        /// The dimension of a quantity, which decides the units that it takes.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Dimension {
            $($(#[$doc])+ $variant,)+
        }

        /// Every dimension, as they are declared.
        pub(super) const TABLE: &[Row] = &[
            $(Row { dimension: Dimension::$variant, name: $name, powers: $powers, units: &$units },)+
        ];
    };
}

dimensions! {
    /// [m]
    Length "a length" [1.0, 0.0, 0.0, 0.0, 0.0] [
        unit("m", "m", Ten(0)), also("cm", "cm", Ten(-2)), unit("mm", "mm", Ten(-3)),
        unit("µm", "um", Ten(-6)), unit("nm", "nm", Ten(-9))];
    /// [m/s]
    Velocity "a velocity" [1.0, 0.0, -1.0, 0.0, 0.0] [
        unit("m/s", "m/s", Ten(0)), also("cm/s", "cm/s", Ten(-2)), also("mm/s", "mm/s", Ten(-3)),
        also("km/h", "km/h", Over(3.6)), also("m/min", "m/min", Over(60.0))];
    /// [s]
    Time "a time" [0.0, 0.0, 1.0, 0.0, 0.0] [
        unit("s", "s", Ten(0)), unit("ms", "ms", Ten(-3)), unit("µs", "us", Ten(-6)),
        unit("ns", "ns", Ten(-9)), also("min", "min", Times(60.0)), also("h", "h", Times(3600.0))];
    /// [Hz]
    Frequency "a frequency" [0.0, 0.0, -1.0, 0.0, 0.0] [
        unit("Hz", "Hz", Ten(0)), unit("kHz", "kHz", Ten(3))];
    /// [1/s]
    Rate "a rate" [0.0, 0.0, -1.0, 0.0, 0.0] [unit("1/s", "1/s", Ten(0)), also("s⁻¹", "s-1", Ten(0))];
    /// [kg/m³]
    Density "a density" [-3.0, 1.0, 0.0, 0.0, 0.0] [
        unit("kg/m³", "kg/m3", Ten(0)), also("g/cm³", "g/cm3", Ten(3))];
    /// [kg/m]
    // A denier is a gram per 9 km.
    LinearDensity "a linear density" [-1.0, 1.0, 0.0, 0.0, 0.0] [
        unit("kg/m", "kg/m", Ten(0)), also("g/m", "g/m", Ten(-3)), unit("tex", "tex", Ten(-6)),
        unit("dtex", "dtex", Ten(-7)), also("den", "den", Over(9e6))];
    /// [kg/m²]
    // An ounce is 28.349523125 g, a yard 0.9144 m.
    BasisWeight "a basis weight" [-2.0, 1.0, 0.0, 0.0, 0.0] [
        unit("kg/m²", "kg/m2", Ten(0)), unit("g/m²", "g/m2", Ten(-3)), also("gsm", "gsm", Ten(-3)),
        also("osy", "osy", Times(0.028_349_523_125 / (0.9144 * 0.9144))),
        also("oz/yd²", "oz/yd2", Times(0.028_349_523_125 / (0.9144 * 0.9144)))];
    /// [Pa]
    Pressure "a pressure" [-1.0, 1.0, -2.0, 0.0, 0.0] [
        unit("Pa", "Pa", Ten(0)), unit("kPa", "kPa", Ten(3)), unit("MPa", "MPa", Ten(6)),
        unit("GPa", "GPa", Ten(9)), also("N/mm²", "N/mm2", Ten(6)), also("mbar", "mbar", Ten(2)),
        also("inH₂O", "inH2O", Times(249.088_908_333)),
        also("mmH₂O", "mmH2O", Times(9.806_65))];
    /// [m²/s]
    KinematicViscosity "a kinematic viscosity" [2.0, 0.0, -1.0, 0.0, 0.0] [
        unit("m²/s", "m2/s", Ten(0)), also("mm²/s", "mm2/s", Ten(-6)), also("cSt", "cSt", Ten(-6))];
    /// [m/s²]
    Acceleration "an acceleration" [1.0, 0.0, -2.0, 0.0, 0.0] [unit("m/s²", "m/s2", Ten(0))];
    /// [K]
    Temperature "a temperature" [0.0, 0.0, 0.0, 1.0, 0.0] [
        unit("K", "K", Ten(0)), unit("°C", "°C", Above(273.15, 1.0)),
        also("°F", "°F", Above(459.67 * 5.0 / 9.0, 5.0 / 9.0))];
    /// [Pa s]
    DynamicViscosity "a viscosity" [-1.0, 1.0, -1.0, 0.0, 0.0] [
        unit("Pa s", "Pa s", Ten(0)), also("Pa·s", "Pa·s", Ten(0)), also("mPa s", "mPa s", Ten(-3))];
    /// [kg/s]
    // Of a hole, in the words of a line.
    MassFlow "a mass flow" [0.0, 1.0, -1.0, 0.0, 0.0] [
        also("kg/s", "kg/s", Ten(0)), also("g/s", "g/s", Ten(-3)), also("kg/h", "kg/h", Over(3600.0)),
        unit("g/min", "g/min", Over(60_000.0)), also("g/min/hole", "g/min/hole", Over(60_000.0)),
        also("g/hole/min", "g/hole/min", Over(60_000.0)), also("ghm", "ghm", Over(60_000.0))];
    /// [N]
    Force "a force" [1.0, 1.0, -2.0, 0.0, 0.0] [
        unit("N", "N", Ten(0)), unit("mN", "mN", Ten(-3)), unit("µN", "uN", Ten(-6)),
        also("cN", "cN", Ten(-2))];
    /// [N/m]
    SurfaceTension "a surface tension" [0.0, 1.0, -2.0, 0.0, 0.0] [
        unit("N/m", "N/m", Ten(0)), unit("mN/m", "mN/m", Ten(-3))];
    /// [1/Pa]
    InversePressure "an inverse pressure" [1.0, -1.0, 2.0, 0.0, 0.0] [
        unit("1/Pa", "1/Pa", Ten(0)), also("Pa⁻¹", "Pa-1", Ten(0))];
    /// [m³/kg]
    SpecificVolume "a specific volume" [3.0, -1.0, 0.0, 0.0, 0.0] [
        unit("m³/kg", "m3/kg", Ten(0)), also("cm³/g", "cm3/g", Ten(-3))];
    /// [m³/(kg K)]
    SpecificVolumeSlope "a specific volume per kelvin" [3.0, -1.0, 0.0, -1.0, 0.0] [
        unit("m³/(kg K)", "m3/(kg K)", Ten(0)), also("cm³/(g K)", "cm3/(g K)", Ten(-3))];
    /// [J/kg]
    SpecificEnergy "an energy per mass" [2.0, 0.0, -2.0, 0.0, 0.0] [
        unit("J/kg", "J/kg", Ten(0)), unit("kJ/kg", "kJ/kg", Ten(3)), also("J/g", "J/g", Ten(3))];
    /// [J/(kg K)]
    HeatCapacity "a heat capacity" [2.0, 0.0, -2.0, -1.0, 0.0] [
        unit("J/(kg K)", "J/(kg K)", Ten(0)), also("kJ/(kg K)", "kJ/(kg K)", Ten(3)),
        also("J/(g K)", "J/(g K)", Ten(3))];
    /// [J/(kg K²)]
    HeatCapacitySlope "a heat capacity per kelvin" [2.0, 0.0, -2.0, -2.0, 0.0] [
        unit("J/(kg K²)", "J/(kg K2)", Ten(0)), also("J/(g K²)", "J/(g K2)", Ten(3))];
    /// [J/mol]
    MolarEnergy "an energy per mole" [2.0, 1.0, -2.0, 0.0, 0.0] [
        unit("J/mol", "J/mol", Ten(0)), unit("kJ/mol", "kJ/mol", Ten(3))];
    /// [K]
    TemperatureDifference "a temperature difference" [0.0, 0.0, 0.0, 1.0, 0.0] [unit("K", "K", Ten(0))];
    /// [m^-½]
    Noise "a noise" [-0.5, 0.0, 0.0, 0.0, 0.0] [
        unit("m^-0.5", "m-0.5", Ten(0)), also("1/√m", "1/√m", Ten(0))];
    /// [C/kg]
    SpecificCharge "a charge per mass" [0.0, -1.0, 1.0, 0.0, 1.0] [
        also("C/kg", "C/kg", Ten(0)), also("mC/kg", "mC/kg", Ten(-3)), unit("µC/g", "uC/g", Ten(-3)),
        unit("nC/g", "nC/g", Ten(-6)), also("µC/kg", "uC/kg", Ten(-6))];
    /// [V/m]
    ElectricField "an electric field" [1.0, 1.0, -3.0, 0.0, -1.0] [
        unit("V/m", "V/m", Ten(0)), unit("kV/m", "kV/m", Ten(3)), unit("MV/m", "MV/m", Ten(6))];
    /// [B]
    Memory "a size of memory" [0.0, 0.0, 0.0, 0.0, 0.0] [
        unit("B", "B", Ten(0)), unit("kB", "kB", Ten(3)), unit("MB", "MB", Ten(6)), unit("GB", "GB", Ten(9)),
        also("MiB", "MiB", Times(1_048_576.0)), also("GiB", "GiB", Times(1_073_741_824.0))];
    /// [rad]
    // A degree is the 180th part of π.
    Angle "an angle" [0.0, 0.0, 0.0, 0.0, 0.0] [
        also("rad", "rad", Ten(0)), unit("°", "°", Over(180.0 / std::f64::consts::PI)),
        also("deg", "deg", Over(180.0 / std::f64::consts::PI))];
    /// [g/10 min], as it is always given; a plain number is one too.
    MeltFlowRate "a melt flow rate" [0.0, 0.0, 0.0, 0.0, 0.0] [
        unit("g/10min", "g/10min", Ten(0)), also("", "g/10 min", Ten(0)), also("", "", Ten(0))];
    /// A plain number, or a percentage.
    Ratio "a ratio" [0.0, 0.0, 0.0, 0.0, 0.0] [unit("", "", Ten(0)), also("%", "%", Ten(-2))];
}

impl Dimension {
    /// Every one.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|row| row.dimension)
    }

    pub(super) const fn row(self) -> &'static Row {
        &TABLE[self as usize]
    }

    /// The units of this dimension, the SI unit first.
    pub(super) const fn units(self) -> &'static [Unit] {
        self.row().units
    }
}
