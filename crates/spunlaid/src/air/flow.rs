//! How the mean flow, and the strength and size of its turbulence, change from place to place.

use super::{Air, FromFile, PlacedField, Profile};
use crate::field::{Hint, Local};
use crate::vec3::Vec3;

/// Where the mean flow comes from.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Flow {
    /// The same everywhere: the numbers of the case.
    #[default]
    Uniform,
    /// Along x as in a table.
    Profile(FromFile<Profile>),
    /// In space as in a CFD solution.
    Field(PlacedField),
}

/// Which numbers of the case come from the flow instead.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FromFlow {
    /// [`Air::turbulence_intensity`].
    pub turbulence_intensity: bool,
    /// [`Air::length_scale`].
    pub length_scale: bool,
    /// [`Air::cutoff_frequency`].
    pub cutoff_frequency: bool,
}

/// The air at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LocalAir {
    /// Mean velocity [m/s].
    pub velocity: Vec3<f64>,
    /// Rms of each component of the fluctuation [m/s].
    pub rms: f64,
    /// Length of an eddy [m].
    pub length_scale: f64,
    /// Cut-off frequency of the spectrum [Hz].
    pub cutoff_frequency: f64,
    /// Whether the place lies inside the flow's data.
    pub inside: bool,
}

impl Flow {
    /// What it is called.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Profile(_) => "profile",
            Self::Field(_) => "field",
        }
    }

    /// Which numbers the flow contains besides the velocity.
    pub fn tells(&self) -> FromFlow {
        match self {
            Self::Uniform => FromFlow::default(),
            Self::Profile(profile) => FromFlow {
                turbulence_intensity: !profile.turbulence_intensity.is_empty(),
                length_scale: !profile.length_scale.is_empty(),
                cutoff_frequency: !profile.cutoff_frequency.is_empty(),
            },
            Self::Field(PlacedField { field, .. }) => {
                let turbulent = field.has_turbulence();
                FromFlow {
                    turbulence_intensity: turbulent,
                    length_scale: turbulent,
                    cutoff_frequency: turbulent,
                }
            }
        }
    }
}

impl Air {
    /// Whether the mean flow and the turbulence are the same everywhere.
    pub fn is_uniform(&self) -> bool {
        self.flow == Flow::Uniform
    }

    /// The air at a place [m]. The origin is the root, and x points along gravity.
    ///
    /// * `hint` – remembers the last place near by; it saves time and does not change the result
    pub fn local(&self, at: Vec3<f64>, hint: &mut Hint) -> LocalAir {
        match &self.flow {
            Flow::Uniform => LocalAir {
                velocity: Vec3::new(self.velocity, 0.0, 0.0),
                rms: self.rms(),
                length_scale: self.length_scale,
                cutoff_frequency: self.cutoff_frequency,
                inside: true,
            },
            Flow::Profile(profile) => self.of_profile(profile, at.x),
            Flow::Field(field) => self.of_field(field, at, hint),
        }
    }

    /// Turbulence from `k` and `ε`: rms √(2k/3), length scale `C_L k^1.5/ε`, and the cut-off frequency `1/(4T)` of
    /// a flat spectrum with the integral time `T`. Eddies pass by and decay: `1/T = |U|/L + ε/(C_T k)`.
    /// theory.md (48), (49)
    fn of_field(&self, placed: &PlacedField, at: Vec3<f64>, hint: &mut Hint) -> LocalAir {
        let Local { velocity, k, epsilon, inside } = self.in_field(placed, at, hint);
        let speed = velocity.norm();
        let from = self.from_flow;
        let turbulent = k > 0.0 && epsilon > 0.0;
        let told = if turbulent { placed.length_constant * k * k.sqrt() / epsilon } else { f64::INFINITY };
        let length_scale = if from.length_scale { told.min(placed.size()) } else { self.length_scale };
        let turnover = if turbulent { epsilon / (placed.time_constant * k) } else { 0.0 };
        LocalAir {
            velocity,
            rms: self.rms_in_field(velocity, k),
            length_scale,
            cutoff_frequency: if from.cutoff_frequency {
                0.25 * (speed / length_scale + turnover)
            } else {
                self.cutoff_frequency
            },
            inside,
        }
    }

    /// The air that acts on a fibre at a place: mean velocity and rms of the fluctuation [m/s], and whether the
    /// place lies inside the flow's data.
    ///
    /// * `hint` – as of [`Air::local`]
    pub(super) fn felt(&self, at: Vec3<f64>, hint: &mut Hint) -> (Vec3<f64>, f64, bool) {
        match &self.flow {
            Flow::Field(placed) => {
                let Local { velocity, k, inside, .. } = self.in_field(placed, at, hint);
                (velocity, self.rms_in_field(velocity, k), inside)
            }
            Flow::Uniform | Flow::Profile(_) => {
                let LocalAir { velocity, rms, inside, .. } = self.local(at, hint);
                (velocity, rms, inside)
            }
        }
    }

    /// The field's values, with all velocities multiplied by the speed factor.
    fn in_field(&self, placed: &PlacedField, at: Vec3<f64>, hint: &mut Hint) -> Local {
        let Local { velocity, k, epsilon, inside } = placed.at(at, hint);
        let factor = self.speed_factor;
        Local {
            velocity: velocity * factor,
            k: k * factor * factor,
            epsilon: epsilon * factor * factor * factor,
            inside,
        }
    }

    fn rms_in_field(&self, velocity: Vec3<f64>, k: f64) -> f64 {
        if self.from_flow.turbulence_intensity {
            (2.0 / 3.0 * k).sqrt()
        } else {
            self.turbulence_intensity * velocity.norm()
        }
    }

    fn of_profile(&self, profile: &Profile, x: f64) -> LocalAir {
        let column = |wanted: bool, column: &[f64], otherwise: f64| {
            if wanted { profile.at(column, x).unwrap_or(otherwise) } else { otherwise }
        };
        let velocity = self.speed_factor * profile.at(&profile.velocity, x).unwrap_or(0.0);
        let from = self.from_flow;
        let intensity =
            column(from.turbulence_intensity, &profile.turbulence_intensity, self.turbulence_intensity);
        let (first, last) = profile.range();
        LocalAir {
            velocity: Vec3::new(velocity, 0.0, 0.0),
            rms: intensity * velocity.abs(),
            length_scale: column(from.length_scale, &profile.length_scale, self.length_scale),
            cutoff_frequency: if from.cutoff_frequency {
                // In faster air the same eddies pass in less time.
                let cutoff = profile.at(&profile.cutoff_frequency, x);
                self.speed_factor * cutoff.unwrap_or(self.cutoff_frequency)
            } else {
                self.cutoff_frequency
            },
            inside: (first..=last).contains(&x),
        }
    }

    /// Sets the numbers that come from the flow to their values along a fibre: the means of velocity, intensity
    /// and length scale, and the highest cut-off frequency.
    ///
    /// They are used where a single number is needed: in messages, and to choose the time step.
    ///
    /// * `along` – from the root to the end of the straight fibre [m]
    pub fn settle(&mut self, along: Vec3<f64>) {
        if self.is_uniform() {
            return;
        }
        const PLACES: usize = 256;
        let places = (0..PLACES).map(|i| along * ((i as f64 + 0.5) / PLACES as f64));
        let mut hint = Hint::default();
        let local: Vec<LocalAir> = places.map(|at| self.local(at, &mut hint)).collect();
        let mean = |of: &dyn Fn(&LocalAir) -> f64| local.iter().map(of).sum::<f64>() / PLACES as f64;
        let speed = mean(&|air| air.velocity.norm());
        self.velocity = if mean(&|air| air.velocity.x) < 0.0 { -speed } else { speed };
        if self.from_flow.turbulence_intensity && speed > 0.0 {
            self.turbulence_intensity = mean(&|air| air.rms) / speed;
        }
        if self.from_flow.length_scale {
            self.length_scale = mean(&|air| air.length_scale);
        }
        if self.from_flow.cutoff_frequency {
            self.cutoff_frequency = local.iter().map(|air| air.cutoff_frequency).fold(0.0, f64::max);
        }
    }
}
