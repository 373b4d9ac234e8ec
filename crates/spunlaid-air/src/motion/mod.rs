//! The air: its mean flow, and the turbulence along the fibre.
//!
//! ```text
//! Flow (uniform, profile, field) → mean velocity, rms, length scale and cut-off at each place
//! SpectrumShape, or a Measured record → signals of the turbulence, one to an eddy and direction
//! EddyModel → how the signals are related along the fibre
//! Atmosphere → the velocity at each element at a time, from all of these
//! ```

mod at_places;
mod atmosphere;
mod cabin;
mod dry_air;
mod eddies;
mod eddy_field;
mod flow;
mod from_file;
mod in_space;
mod measured;
mod placed_field;
pub mod spectrum;
mod stations;
mod surroundings;
#[cfg(test)]
mod tests;
mod wind;

pub use at_places::{AirAtPlaces, PlaceAxes};
pub use atmosphere::{Atmosphere, EddyWind};
pub use atmosphere::{Instant, LastEddy, Velocities, VelocityAt, VelocityTask};
pub use cabin::Cabin;
pub use dry_air::{
    HEAT_CAPACITY_OF_AIR, SUTHERLAND_RANGE, density_at, kinematic_viscosity_at, temperature_of,
};
pub use eddies::{Eddies, EddyModel, EddyTurbulence};
pub use eddy_field::Room;
pub use eddy_field::{EddyField, Extent};
pub use flow::{Flow, FlowNumbers, LocalAir};
pub use from_file::FileContent;
pub use in_space::{AirInSpace, FibreInField};
pub use measured::{APART, Measured, Profile, RecordLayout, RecordNumbers};
pub use placed_field::{Axis, PlacedField};
pub use placed_field::{LENGTH_CONSTANT, TIME_CONSTANT};
pub use spectrum::{Spectrum, SpectrumShape, SpectrumTable};
pub use stations::{FibreOnWay, StationGrid, Stations};
pub use stations::{Way, time_between_looks};
use std::path::{Path, PathBuf};
pub use surroundings::{FibreAir, Surroundings};
pub use wind::Sampling;
pub use wind::{Stream, StreamKey, Wind};

/// The air of a case, in SI units. If the flow varies from place to place, the numbers that come from it are those
/// along the fibre, see [`Air::settle_along`].
#[derive(Clone, Debug, PartialEq)]
pub struct Air {
    /// Mean velocity `Ū` along x [m/s].
    pub velocity: f64,
    /// Turbulence intensity `Tu = u/Ū` [-], `u` the rms of each component.
    pub turbulence_intensity: f64,
    /// Length scale `L_T` of the eddies [m].
    pub length_scale: f64,
    /// Cut-off frequency `f` of the spectrum [Hz].
    pub cutoff_frequency: f64,
    /// Density `ρ_a` [kg/m³].
    pub density: f64,
    /// Kinematic viscosity `ν` [m²/s].
    pub kinematic_viscosity: f64,
    /// Number of harmonics `N_h` of a component.
    pub harmonics: usize,
    /// How the mean flow varies from place to place.
    pub flow: Flow,
    /// Which of the numbers above come from the flow.
    pub from_flow: FlowNumbers,
    /// Factor on all velocities of a flow that is not uniform [-].
    pub speed_factor: f64,
    /// Pressure of the cabin above that under the belt, if it gives the velocity [Pa].
    pub cabin_pressure: Option<f64>,
    /// See [`Cabin::coefficient`].
    pub speed_coefficient: f64,
    /// Factor on the turbulence intensity that a flow gives [-].
    pub intensity_factor: f64,
    /// Factor on the length of the eddies that a flow gives [-].
    pub length_factor: f64,
    /// How the energy of the turbulence spreads over frequency.
    pub spectrum: SpectrumShape,
    /// How the turbulence is related along the fibre.
    pub eddies: EddyModel,
    /// How the turbulence differs across the flow.
    pub lateral: Lateral,
    /// Where the mean flow of a profile widens as it slows; nowhere if the case does not say.
    pub widening: Option<Widening>,
    /// Records of the fluctuation, one for all eddies or one for each; empty if the fluctuation is synthesised.
    pub records: Vec<FileContent<Measured>>,
}

impl Air {
    /// A uniform flow with the paper's turbulence: flat spectrum, independent eddies.
    ///
    /// * `velocity` – [m/s]
    /// * `turbulence_intensity` – [-]
    /// * `length_scale` – of the eddies [m]
    /// * `cutoff_frequency` – [Hz]
    ///
    /// Density and viscosity are those of air at 20 °C. The number of harmonics is that for a flight of one
    /// second.
    pub fn uniform(
        velocity: f64,
        turbulence_intensity: f64,
        length_scale: f64,
        cutoff_frequency: f64,
    ) -> Self {
        let mut air = Self {
            velocity,
            turbulence_intensity,
            length_scale,
            cutoff_frequency,
            density: 1.204,
            kinematic_viscosity: 1.51e-5,
            harmonics: 0,
            flow: Flow::Uniform,
            from_flow: FlowNumbers::default(),
            speed_factor: 1.0,
            cabin_pressure: None,
            speed_coefficient: Cabin::COEFFICIENT,
            intensity_factor: 1.0,
            length_factor: 1.0,
            spectrum: SpectrumShape::Flat,
            eddies: EddyModel::Independent,
            lateral: Lateral::Uniform,
            widening: None,
            records: Vec::new(),
        };
        air.harmonics = air.default_harmonics(1.0);
        air
    }

    /// The cabin that blows the air through the slot, if the case says it so.
    pub fn cabin(&self) -> Option<Cabin> {
        self.cabin_pressure.map(|pressure| Cabin { pressure, coefficient: self.speed_coefficient })
    }

    /// The files that the air was read from, each with the parts that it names, relative to its folder.
    pub fn files(&self) -> Vec<(&Path, &[PathBuf])> {
        fn paths<T>(file: &FileContent<T>) -> (&Path, &[PathBuf]) {
            (file.path(), file.parts())
        }
        let mut files: Vec<_> = self.records.iter().map(paths).collect();
        match &self.flow {
            Flow::Uniform => {}
            Flow::Profile(profile) => files.push(paths(profile)),
            Flow::Field(placed) => files.push(paths(&placed.field)),
        }
        if let SpectrumShape::Measured(table) = &self.spectrum {
            files.push(paths(table));
        }
        files
    }

    /// The same air with its files at other paths.
    pub fn with_files_at(&self, place: impl Fn(&Path) -> PathBuf) -> Self {
        fn moved<T>(file: &FileContent<T>, place: impl Fn(&Path) -> PathBuf) -> FileContent<T> {
            file.moved_to(place(file.path()))
        }
        let mut air = self.clone();
        for record in &mut air.records {
            *record = moved(record, &place);
        }
        match &mut air.flow {
            Flow::Uniform => {}
            Flow::Profile(profile) => *profile = moved(profile, &place),
            Flow::Field(placed) => placed.field = moved(&placed.field, &place),
        }
        if let SpectrumShape::Measured(table) = &mut air.spectrum {
            *table = moved(table, &place);
        }
        air
    }

    /// The memory of a CFD field, which all fibres share [bytes].
    pub fn field_memory(&self) -> usize {
        match &self.flow {
            Flow::Field(placed) => placed.field.memory(),
            Flow::Uniform | Flow::Profile(_) => 0,
        }
    }

    /// Rms of each velocity component `u = Tu Ū` [m/s].
    pub fn rms(&self) -> f64 {
        self.turbulence_intensity * self.velocity.abs()
    }

    /// Energy spectrum of a velocity component, 0 along the mean flow.
    pub fn energy_spectrum(&self, component: usize) -> Spectrum<'_> {
        self.turbulence_of_an_eddy().spectrum(self, component)
    }

    /// The time after which one sum of cosines repeats with the opposite sign, `N_h/f` [s].
    pub fn repeat_time(&self) -> f64 {
        self.harmonics as f64 / self.cutoff_frequency
    }

    /// How long the turbulence at a place is correlated [s]: for as long as three eddies take to pass, or three
    /// quarters of the shortest period. Zero without turbulence.
    pub fn memory(&self) -> f64 {
        const TIMES: f64 = 3.0;
        match self.turbulence_intensity * self.velocity.abs() > 0.0 {
            true => TIMES * (self.length_scale / self.velocity.abs()).max(0.25 / self.cutoff_frequency),
            false => 0.0,
        }
    }

    /// The number of harmonics if the case does not give it: a power of two, at least 128.
    ///
    /// Their repeat time is at least twice `duration` [s], so that one window lasts for the flight. Long flights
    /// pass through several windows: then there are at most 1024 harmonics, or as many as make a window last for
    /// 256 integral times. theory.md (50)
    ///
    /// * `duration` – of the flight [s]
    pub fn default_harmonics(&self, duration: f64) -> usize {
        self.harmonics_lasting(duration, 1024.0)
    }

    /// As [`Air::default_harmonics`], for the many stations along the way of a fed fibre: at most 256
    /// harmonics, or as many as make a window last for 256 integral times.
    pub fn default_harmonics_at_stations(&self, duration: f64) -> usize {
        self.harmonics_lasting(duration, 256.0)
    }

    fn harmonics_lasting(&self, duration: f64, most: f64) -> usize {
        const INTEGRAL_TIMES: f64 = 256.0;
        let lasting = INTEGRAL_TIMES * self.cutoff_frequency * self.length_scale / self.velocity.abs();
        let most = if lasting.is_finite() { lasting.max(most) } else { most };
        let wanted = (2.0 * self.cutoff_frequency * duration).min(most).ceil().max(128.0);
        if wanted < (1u64 << 62) as f64 { (wanted as usize).next_power_of_two() } else { usize::MAX }
    }
}

/// How the turbulence differs across the flow.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Lateral {
    /// The same at each distance from the axis. Each fibre has turbulence of its own.
    #[default]
    Uniform,
    /// A field in space with the lateral structure of von Kármán's isotropic turbulence, which many fibres share.
    VonKarman {
        /// Largest lateral wave number times the length scale, `k_max L_T` [-].
        cutoff: f64,
    },
}

impl Lateral {
    /// `k_max L_T` of a case that leaves it out [-].
    pub(crate) const USUAL_CUTOFF: f64 = 10.0;
    /// Every kind; the second one has the usual cut-off.
    pub const ALL: [Self; 2] = [Self::Uniform, Self::VonKarman { cutoff: Self::USUAL_CUTOFF }];

    /// Name in the case file.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::VonKarman { .. } => "von-karman",
        }
    }

    /// `k_max L_T` [-]; none if the turbulence is the same across the flow.
    pub const fn cutoff(self) -> Option<f64> {
        match self {
            Self::Uniform => None,
            Self::VonKarman { cutoff } => Some(cutoff),
        }
    }

    /// What it is where all filaments hang in shared turbulence: a field in space, with the usual cut-off where there
    /// was none.
    pub const fn in_one_air(self) -> Self {
        match self {
            Self::Uniform => Self::VonKarman { cutoff: Self::USUAL_CUTOFF },
            Self::VonKarman { .. } => self,
        }
    }
}

named! {
    /// Where the mean flow of a profile widens as it slows.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub enum Widening {
        /// Nowhere: the velocity of the profile is all.
        None = "none",
        /// Along y, the machine direction, as in a plane channel.
        MachineDirection = "md",
    }
}

impl Air {
    /// Whether the mean flow of a profile widens as it slows.
    pub fn widens(&self) -> bool {
        self.widening == Some(Widening::MachineDirection)
    }

    /// `k_max L_T` of the field of eddies in space [-]. None if the turbulence is the same across the flow,
    /// and in still air, which has no turbulence.
    pub fn field_cutoff(&self) -> Option<f64> {
        self.lateral.cutoff().filter(|_| self.velocity != 0.0)
    }
}
