//! How the mean flow, and the strength and size of its turbulence, change from place to place.

use super::{Air, FileContent, PlacedField, Profile};
use crate::field::{AirAround, Hint, Local};
use spunlaid_ground::Vec3;

/// Where the mean flow comes from.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Flow {
    /// The same everywhere: the numbers of the case.
    #[default]
    Uniform,
    /// Along x as in a table.
    Profile(FileContent<Profile>),
    /// In space as in a CFD solution.
    Field(Box<PlacedField>),
}

/// Which numbers of the case come from the flow instead.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FlowNumbers {
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

    /// The CFD solution, if it is one.
    pub fn field(&self) -> Option<&PlacedField> {
        match self {
            Self::Field(placed) => Some(placed),
            _ => None,
        }
    }

    /// Whether it is a CFD solution.
    pub const fn is_field(&self) -> bool {
        matches!(self, Self::Field(_))
    }

    /// Which numbers the flow contains besides the velocity.
    pub fn numbers(&self) -> FlowNumbers {
        match self {
            Self::Uniform => FlowNumbers::default(),
            Self::Profile(profile) => FlowNumbers {
                turbulence_intensity: !profile.turbulence_intensity.is_empty(),
                length_scale: !profile.length_scale.is_empty(),
                cutoff_frequency: !profile.cutoff_frequency.is_empty(),
            },
            Self::Field(placed) => {
                let turbulent = placed.field.has_turbulence();
                FlowNumbers {
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

    /// The velocity at the root, which is that at the slot of a line [m/s]; None of a field, and in a vacuum.
    pub fn velocity_at_slot(&self) -> Option<f64> {
        let velocity = match &self.flow {
            Flow::Uniform => self.velocity,
            Flow::Profile(profile) => self.speed_factor * profile.velocity_at_root()?,
            Flow::Field(_) => return None,
        };
        Some(velocity).filter(|velocity| *velocity > 0.0 && self.density > 0.0)
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
            Flow::Profile(profile) => self.profile_air(profile, at),
            Flow::Field(field) => self.field_air(field, at, hint),
        }
    }

    /// Turbulence from `k` and `ε`: rms √(2k/3), length scale `C_L k^1.5/ε`, and the cut-off frequency `1/(4T)` of
    /// a flat spectrum with the integral time `T`. Eddies pass by and decay: `1/T = |U|/L + ε/(C_T k)`.
    /// theory.md (48), (49)
    fn field_air(&self, placed: &PlacedField, at: Vec3<f64>, hint: &mut Hint) -> LocalAir {
        let Local { velocity, k, epsilon, inside } = self.in_field(placed, at, hint);
        let speed = velocity.norm();
        let from = self.from_flow;
        let turbulent = k > 0.0 && epsilon > 0.0;
        let length = if turbulent { placed.length_constant * k * k.sqrt() / epsilon } else { f64::INFINITY };
        let length_scale = if from.length_scale {
            (self.length_factor * length).min(placed.size())
        } else {
            self.length_scale
        };
        // Longer eddies live longer, and stronger ones less long.
        let lifetimes = self.length_factor / self.intensity_factor;
        let turnover = if turbulent { epsilon / (placed.time_constant * k) / lifetimes } else { 0.0 };
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

    /// The air that acts on a fibre around a place, linear in space: mean velocity and, in the fourth place, the
    /// rms of the fluctuation [m/s].
    ///
    /// * `hint` – as of [`Air::local`]
    pub(super) fn around(&self, at: Vec3<f64>, hint: &mut Hint) -> AirAround {
        match &self.flow {
            Flow::Uniform | Flow::Profile(_) => self.around_in_profile(at, hint),
            Flow::Field(placed) => {
                let mut around = placed.around(at, hint);
                let [u, v, w, root_k] = around.value.map(|value| value * self.speed_factor);
                around.gradients =
                    around.gradients.map(|gradient| gradient.map(|change| change * self.speed_factor));
                let rms_per_root = self.intensity_factor * (2.0_f64 / 3.0).sqrt();
                let rms = if self.from_flow.turbulence_intensity {
                    around.gradients.iter_mut().for_each(|gradient| gradient[3] *= rms_per_root);
                    rms_per_root * root_k
                } else {
                    let speed = Vec3::new(u, v, w).norm();
                    let per_speed = if speed > 0.0 { self.turbulence_intensity / speed } else { 0.0 };
                    around.gradients.iter_mut().for_each(|gradient| {
                        gradient[3] = per_speed * (u * gradient[0] + v * gradient[1] + w * gradient[2])
                    });
                    self.turbulence_intensity * speed
                };
                AirAround { value: [u, v, w, rms], ..around }
            }
        }
    }

    /// In a profile the air changes along x only, apart from the velocity with which it widens. The gradient
    /// is that between two points near by.
    fn around_in_profile(&self, at: Vec3<f64>, hint: &mut Hint) -> AirAround {
        let mut value = |x: f64| {
            let LocalAir { velocity, rms, inside, .. } = self.local(Vec3::new(x, at.y, at.z), hint);
            ([velocity.x, velocity.y, velocity.z, rms], inside)
        };
        let (here, inside) = value(at.x);
        let reach = match &self.flow {
            Flow::Profile(profile) => profile.closest_rows() / 32.0,
            _ => f64::INFINITY,
        };
        let mut gradients = [[0.0; 4]; 3];
        if reach.is_finite() && reach > 0.0 {
            let (before, after) = (value(at.x - reach).0, value(at.x + reach).0);
            gradients[0] = std::array::from_fn(|i| (after[i] - before[i]) / (2.0 * reach));
        }
        if let Flow::Profile(profile) = &self.flow
            && let Some(rate) = self.widening_rate(profile, at.x)
        {
            // Between two rows the rate is the same for all x.
            (gradients[0][1], gradients[1][1]) = (0.0, rate);
        }
        AirAround { value: here, gradients, reach, inside }
    }

    /// The largest mean speed along a straight fibre, with six standard deviations of the turbulence there [m/s].
    ///
    /// * `along` – from its root to its end [m]
    pub fn fastest(&self, along: Vec3<f64>) -> f64 {
        const PLACES: usize = 64;
        let mut hint = Hint::default();
        let places = (0..=PLACES).map(|i| along * (i as f64 / PLACES as f64));
        let speeds =
            places.map(|at| self.local(at, &mut hint)).map(|air| air.velocity.norm() + 6.0 * air.rms);
        speeds.fold(0.0, f64::max)
    }

    /// Mean velocity along a straight fibre, and mean speed there [m/s].
    ///
    /// * `along` – from its root to its end [m]
    pub fn along_and_speed(&self, along: Vec3<f64>) -> (f64, f64) {
        const PLACES: usize = 64;
        let (mut hint, way) = (Hint::default(), along * (1.0 / along.norm()));
        let velocities = (0..PLACES).map(|i| along * ((i as f64 + 0.5) / PLACES as f64));
        let velocities = velocities.map(|at| self.local(at, &mut hint).velocity);
        let share = 1.0 / PLACES as f64;
        velocities.fold((0.0, 0.0), |(mean, speed), v| (mean + share * v.dot(way), speed + share * v.norm()))
    }

    /// Longest time between two looks at the air around the elements of a fibre [s].
    ///
    /// It is 1/64 of the time in which the mean flow passes an eddy, or in which the flow's own gradients change
    /// the velocity by as much as the largest velocity, if that is shorter.
    ///
    /// * `along` – from the root to the end of the straight fibre [m]
    pub fn time_between_looks(&self, along: Vec3<f64>) -> f64 {
        let passing = self.length_scale / self.velocity.abs();
        let steepest = if matches!(self.flow, Flow::Field(_)) { self.steepest(along) } else { 0.0 };
        passing.min(1.0 / steepest) / 64.0
    }

    /// The largest gradient of the velocity [1/s] at points around a straight fibre, as far from it as a tenth of
    /// its length.
    fn steepest(&self, along: Vec3<f64>) -> f64 {
        const PLACES: usize = 1024;
        let mut hint = Hint::default();
        let length = along.norm();
        let share = |i: usize, ratio: f64| ((i + 1) as f64 * ratio).fract();
        let gradient = |i: usize| {
            let across = [0.671_043_606_703_789_2, 0.549_700_477_901_967_3];
            let [y, z] = across.map(|ratio| 0.2 * length * (share(i, ratio) - 0.5));
            let at = along * share(i, 0.819_172_513_396_164_5) + Vec3::new(0.0, y, z);
            let AirAround { mut gradients, inside, reach, .. } = self.around(at, &mut hint);
            if reach == 0.0 {
                // The field is too rough for gradients, so the change over a short way is taken.
                let h = 1e-4 * length;
                gradients = [[h, 0.0, 0.0], [0.0, h, 0.0], [0.0, 0.0, h]].map(|[x, y, z]| {
                    let by = Vec3::new(x, y, z);
                    let [before, after] = [at - by, at + by].map(|at| self.around(at, &mut hint).value);
                    std::array::from_fn(|i| (after[i] - before[i]) / (2.0 * h))
                });
            }
            let squares: f64 =
                gradients.iter().flat_map(|gradient| &gradient[..3]).map(|change| change * change).sum();
            if inside { squares.sqrt() } else { 0.0 }
        };
        (0..PLACES).map(gradient).fold(0.0, f64::max)
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
            self.intensity_factor * (2.0 / 3.0 * k).sqrt()
        } else {
            self.turbulence_intensity * velocity.norm()
        }
    }

    /// How fast air that slows moves away from the middle of the slot, per distance from it: `−dU/dx` [1/s].
    /// None if the mean flow does not widen.                                                  theory.md (49a)
    fn widening_rate(&self, profile: &Profile, x: f64) -> Option<f64> {
        self.widens().then(|| -self.speed_factor * profile.velocity_gradient(x))
    }

    fn profile_air(&self, profile: &Profile, at: Vec3<f64>) -> LocalAir {
        let x = at.x;
        let column = |wanted: bool, column: &[f64], factor: f64, otherwise: f64| {
            if wanted { profile.at(column, x).map_or(otherwise, |value| factor * value) } else { otherwise }
        };
        let velocity = self.speed_factor * profile.at(&profile.velocity, x).unwrap_or(0.0);
        let from = self.from_flow;
        let intensity = column(
            from.turbulence_intensity,
            &profile.turbulence_intensity,
            self.intensity_factor,
            self.turbulence_intensity,
        );
        LocalAir {
            velocity: Vec3::new(
                velocity,
                self.widening_rate(profile, x).map_or(0.0, |rate| rate * at.y),
                0.0,
            ),
            rms: intensity * velocity.abs(),
            length_scale: column(
                from.length_scale,
                &profile.length_scale,
                self.length_factor,
                self.length_scale,
            ),
            // In faster air the same eddies pass in less time, and longer ones take more.
            cutoff_frequency: column(
                from.cutoff_frequency,
                &profile.cutoff_frequency,
                self.speed_factor / self.length_factor,
                self.cutoff_frequency,
            ),
            inside: profile.contains(x),
        }
    }

    /// Sets the numbers that come from the flow to their values along a fibre: the means of velocity, intensity
    /// and length scale, and the highest cut-off frequency.
    ///
    /// They are used where a single number is needed: in messages, and to choose the time step.
    ///
    /// * `along` – from the root to the end of the straight fibre [m]
    pub fn settle_along(&mut self, along: Vec3<f64>) {
        if self.is_uniform() {
            return;
        }
        let local = self.sampled(along);
        let mean = |quantity: &dyn Fn(&LocalAir) -> f64| {
            local.iter().map(quantity).sum::<f64>() / local.len() as f64
        };
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

    /// The air along a fibre, at the middles of equal pieces.
    fn sampled(&self, along: Vec3<f64>) -> Vec<LocalAir> {
        const PLACES: usize = 256;
        let mut hint = Hint::default();
        let places = (0..PLACES).map(|i| along * ((i as f64 + 0.5) / PLACES as f64));
        places.map(|at| self.local(at, &mut hint)).collect()
    }

    /// Where along a fibre the turbulence changes fastest, as a share of its length, if the flow reports its
    /// cut-off frequency. This place sets [`Air::cutoff_frequency`], and so the time step where the case
    /// gives none.
    ///
    /// * `along` – from the root to the end of the straight fibre [m]
    pub fn place_of_cutoff(&self, along: Vec3<f64>) -> Option<f64> {
        let cutoffs = self.sampled(along).into_iter().map(|air| air.cutoff_frequency).enumerate();
        let count = cutoffs.len() as f64;
        let (fastest, _) = cutoffs.max_by(|a, b| a.1.total_cmp(&b.1))?;
        self.from_flow.cutoff_frequency.then_some((fastest as f64 + 0.5) / count)
    }
}
