//! The air: mean flow, and turbulence synthesised along the fibre.

mod eddies;
mod interpolation;
pub mod spectrum;
mod synthesis;

pub use eddies::Eddies;
pub(crate) use interpolation::Gust;
pub use interpolation::Wind;
pub use spectrum::Spectrum;
pub use synthesis::{StreamKey, Turbulence};

/// A uniform mean flow along x with isotropic turbulence, in SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// Mean velocity `Ū` along x [m/s].
    pub velocity: f64,
    /// Turbulence intensity `Tu = u/Ū` [-], `u` the rms of each component.
    pub turbulence_intensity: f64,
    /// Length `L_T` over which the velocity is one eddy's [m].
    pub length_scale: f64,
    /// Cut-off frequency `f` of the spectrum [Hz].
    pub cutoff_frequency: f64,
    /// Density `ρ_a` [kg/m³].
    pub density: f64,
    /// Kinematic viscosity `ν` [m²/s].
    pub kinematic_viscosity: f64,
    /// Number of harmonics `N_h` a component is summed from.
    pub harmonics: usize,
}

impl Air {
    /// Rms of each velocity component `u = Tu Ū` [m/s].
    pub fn rms(&self) -> f64 {
        self.turbulence_intensity * self.velocity.abs()
    }

    /// Energy spectrum of each velocity component.
    pub fn spectrum(&self) -> Spectrum {
        Spectrum::flat(self.rms(), self.cutoff_frequency)
    }

    /// The time after which the synthesised turbulence repeats but for its sign, `N_h/f` [s].
    pub fn repeat_time(&self) -> f64 {
        self.harmonics as f64 / self.cutoff_frequency
    }

    /// The number of harmonics taken where the case leaves it open: the power of two from 128 up whose
    /// signal repeats no sooner than after twice `duration` [s].
    pub fn default_harmonics(cutoff_frequency: f64, duration: f64) -> usize {
        let wanted = (2.0 * cutoff_frequency * duration).ceil().max(128.0);
        if wanted < (1u64 << 62) as f64 { (wanted as usize).next_power_of_two() } else { usize::MAX }
    }
}
