//! The keys of a case file: what their quantities measure and which sign these may have, and what
//! there is to choose from.

use crate::chain::schemes::Scheme;
use crate::drag::{FrictionLaw, NormalLaw};
use crate::error::Fault;
use crate::fibre::Root;
use crate::units::Dimension;

/// A key whose value is a quantity.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Quantity {
    /// Full name, `fibre.length`.
    pub(crate) key: &'static str,
    /// What it measures.
    pub(crate) dimension: Dimension,
    sign: Sign,
}

#[derive(Clone, Copy, Debug)]
enum Sign {
    Positive,
    NotNegative,
    Any,
}

use Sign::{Any, NotNegative, Positive};

const fn quantity(key: &'static str, dimension: Dimension, sign: Sign) -> Quantity {
    Quantity { key, dimension, sign }
}

pub(crate) const LENGTH: Quantity = quantity("fibre.length", Dimension::Length, Positive);
pub(crate) const DIAMETER: Quantity = quantity("fibre.diameter", Dimension::Length, Positive);
pub(crate) const FIBRE_DENSITY: Quantity = quantity("fibre.density", Dimension::Density, Positive);
pub(crate) const YOUNGS_MODULUS: Quantity = quantity("fibre.youngs_modulus", Dimension::Pressure, Positive);
pub(crate) const ELEMENT_LENGTH: Quantity = quantity("fibre.element_length", Dimension::Length, Positive);

pub(crate) const VELOCITY: Quantity = quantity("air.velocity", Dimension::Velocity, Any);
pub(crate) const TURBULENCE_INTENSITY: Quantity =
    quantity("air.turbulence_intensity", Dimension::Ratio, NotNegative);
pub(crate) const LENGTH_SCALE: Quantity = quantity("air.length_scale", Dimension::Length, Positive);
pub(crate) const CUTOFF_FREQUENCY: Quantity =
    quantity("air.cutoff_frequency", Dimension::Frequency, Positive);
pub(crate) const AIR_DENSITY: Quantity = quantity("air.density", Dimension::Density, NotNegative);
pub(crate) const VISCOSITY: Quantity =
    quantity("air.kinematic_viscosity", Dimension::KinematicViscosity, Positive);

pub(crate) const SPEED_FACTOR: Quantity = quantity("air.speed_factor", Dimension::Ratio, Positive);
pub(crate) const RECORD_RATE: Quantity = quantity("air.record_rate", Dimension::Frequency, Positive);
pub(crate) const FIELD_UNIT: Quantity = quantity("air.field_unit", Dimension::Length, Positive);
pub(crate) const LENGTH_CONSTANT: Quantity = quantity("air.length_constant", Dimension::Ratio, Positive);
pub(crate) const TIME_CONSTANT: Quantity = quantity("air.time_constant", Dimension::Ratio, Positive);
pub(crate) const DECAY_TIME: Quantity = quantity("air.decay_time", Dimension::Time, Positive);

pub(crate) const FRICTION_COEFFICIENT: Quantity =
    quantity("drag.friction_coefficient", Dimension::Ratio, NotNegative);

pub(crate) const DURATION: Quantity = quantity("run.duration", Dimension::Time, Positive);
pub(crate) const ERROR_TOLERANCE: Quantity = quantity("run.error_tolerance", Dimension::Ratio, Positive);
pub(crate) const TIME_STEP: Quantity = quantity("run.time_step", Dimension::Time, Positive);
pub(crate) const GRAVITY: Quantity = quantity("run.gravity", Dimension::Acceleration, Any);
pub(crate) const SPIN_UP: Quantity = quantity("run.spin_up", Dimension::Time, NotNegative);
pub(crate) const OUTPUT_INTERVAL: Quantity = quantity("run.output_interval", Dimension::Time, Positive);
pub(crate) const DAMPING: Quantity = quantity("run.damping", Dimension::Rate, NotNegative);

/// Every key whose value is a quantity.
pub(crate) const QUANTITIES: [&Quantity; 23] = [
    &LENGTH,
    &DIAMETER,
    &FIBRE_DENSITY,
    &YOUNGS_MODULUS,
    &ELEMENT_LENGTH,
    &VELOCITY,
    &TURBULENCE_INTENSITY,
    &LENGTH_SCALE,
    &CUTOFF_FREQUENCY,
    &AIR_DENSITY,
    &VISCOSITY,
    &SPEED_FACTOR,
    &DECAY_TIME,
    &LENGTH_CONSTANT,
    &TIME_CONSTANT,
    &FRICTION_COEFFICIENT,
    &DURATION,
    &TIME_STEP,
    &ERROR_TOLERANCE,
    &GRAVITY,
    &SPIN_UP,
    &OUTPUT_INTERVAL,
    &DAMPING,
];

pub(crate) const PROFILE: &str = "air.profile";
pub(crate) const FIELD: &str = "air.field";
pub(crate) const FIELD_ROOT: &str = "air.field_root";
pub(crate) const FIELD_AXIS: &str = "air.field_axis";
pub(crate) const SPECTRUM: &str = "air.spectrum";
pub(crate) const RECORD: &str = "air.record";
pub(crate) const EDDIES: &str = "air.eddies";
pub(crate) const HARMONICS: &str = "air.harmonics";
pub(crate) const DIRECTION: &str = "fibre.direction";
pub(crate) const REPLICATES: &str = "run.replicates";

/// The ways to hold the root.
pub(crate) const ROOTS: [Root; 3] = [Root::Pinned, Root::Clamped, Root::Free];
/// The laws along the fibre.
pub(crate) const FRICTION_LAWS: [FrictionLaw; 4] = FrictionLaw::ALL;
/// The laws across the fibre.
pub(crate) const NORMAL_LAWS: [NormalLaw; 2] = NormalLaw::ALL;
/// The schemes.
pub(crate) const SCHEMES: [Scheme; 3] = Scheme::ALL;

impl Quantity {
    /// What is wrong with the value on its own.
    pub(crate) fn fault(&self, value: f64) -> Option<Fault> {
        let quantity = self.dimension.name();
        if !value.is_finite() {
            return Some(Fault::NotFinite);
        }
        match self.sign {
            Positive if value <= 0.0 => Some(Fault::NotPositive { quantity }),
            NotNegative if value < 0.0 => Some(Fault::Negative { quantity }),
            Positive | NotNegative | Any => None,
        }
    }
}
