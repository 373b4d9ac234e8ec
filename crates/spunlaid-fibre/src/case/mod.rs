//! A case: everything that a run needs, checked and in SI units.

mod check;
mod files;
pub mod keys;
mod limits;
mod remarks;
mod step;
mod usual;

use crate::body::{FedFilament, Fibre, FilamentFeed, FilamentSize};
use crate::chain::{FibreParameters, Scheme};
use crate::drag::Drag;
use crate::line::Line;
use crate::spinline::{Solution, Spinline};
use spunlaid_air::motion::time_between_looks;
use spunlaid_air::{
    Air, AirAtPlaces, Eddies, EddyField, EddyTurbulence, Extent, Hint, Room, StationGrid, StreamKey,
};
use spunlaid_ground::{Dimension, Error, Vec3, WIDTH};
use step::FEEDING;

pub use check::too_many_steps;
pub use limits::{FLIGHT_MEMORY_LIMIT, FlightMemory, MOST_INSTANTS, MOST_REPLICATES, MOST_STEPS};
pub use limits::{MOST_SHAPES, whole_parts};
pub use step::{ERROR_TOLERANCE, StepChoice, StepLimit};
pub use usual::unusual;

/// A fibre, the air it flies in and how the flight is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// The fibre and its mesh.
    pub fibre: Fibre,
    /// The air.
    pub air: Air,
    /// The drag laws.
    pub drag: Drag,
    /// Feed and belt of a fed fibre; `None` for a fibre of fixed length. The length of a fed fibre stands for the
    /// distance to the belt.
    pub line: Option<Line>,
    /// The spinline that gives diameter, density and feed speed; `None` where the case gives them itself.
    pub spinline: Option<Box<Spinline>>,
    /// Time, integration and ensemble.
    pub run: Run,
}

/// Time, integration and ensemble of a case. Times are whole numbers of steps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Run {
    /// Time step `h` [s].
    pub time_step: f64,
    /// Number of steps.
    pub steps: u64,
    /// Number of steps at the start that the statistics leave out.
    pub spin_up_steps: u64,
    /// How many times as long as usual it takes from one look at the flow around the fibre to the next. No key
    /// of a case: a web that is compared with another one is simulated with rarer looks.
    pub rarer_looks: f64,
    /// Number of steps from one recorded instant to the next.
    pub output_steps: u64,
    /// Number of fibres with different turbulence.
    pub replicates: u64,
    /// Master seed of the random phases.
    pub seed: u64,
    /// Time integration.
    pub scheme: Scheme,
    /// Acceleration of gravity along x [m/s²].
    pub gravity: f64,
    /// Mass-proportional damping [1/s].
    pub damping: f64,
    /// Number of shapes of a fibre that are kept for pictures; `None`: as many as fit into their memory.
    pub shapes: Option<u64>,
    /// How much is simulated to find the error of step and mesh.
    pub checks: Checks,
}

impl Run {
    /// A run of which nothing is known yet; its keys are set one after another.
    pub const UNKNOWN: Self = Self {
        time_step: f64::NAN,
        steps: 0,
        spin_up_steps: 0,
        rarer_looks: 1.0,
        output_steps: 0,
        replicates: 1,
        seed: 0,
        scheme: Scheme::SemiImplicitEuler,
        gravity: f64::NAN,
        damping: f64::NAN,
        shapes: None,
        checks: Checks::Auto,
    };

    /// Simulated time [s].
    pub fn duration(&self) -> f64 {
        self.steps as f64 * self.time_step
    }

    /// Time at the start that the statistics leave out [s].
    pub fn spin_up(&self) -> f64 {
        self.spin_up_steps as f64 * self.time_step
    }

    /// Time from one recorded instant to the next [s].
    pub fn output_interval(&self) -> f64 {
        self.output_steps as f64 * self.time_step
    }
}

/// Elements of a fed fibre at its start.
const FIRST_ELEMENTS: usize = 2;

impl Case {
    /// Takes diameter, density and feed speed from a solved spinline, and the modulus where the case leaves it out.
    pub fn take_filament(&mut self, filament: &Solution) {
        let Some(spinline) = &self.spinline else { return };
        self.fibre.diameter = filament.final_diameter;
        self.fibre.density = spinline.material.solid_density;
        if spinline.gives_modulus {
            self.fibre.youngs_modulus = filament.modulus_estimate;
        }
        if let Some(line) = &mut self.line {
            line.feed_speed = filament.final_speed;
        }
    }

    /// The fibre as the filament of a hole, which has no speed if it has a fixed length.
    pub fn filament(&self) -> FedFilament {
        let speed = self.line.map_or(f64::NAN, |line| line.feed_speed);
        let size = FilamentSize::Diameter(self.fibre.diameter);
        FedFilament { density: self.fibre.density, size, feed: FilamentFeed::Speed(speed) }
    }

    /// Mass per length of the fibre [kg/m].
    pub fn linear_density(&self) -> f64 {
        self.filament().linear_density()
    }

    /// Mass flow of a fed fibre, which is that of its hole [kg/s]; `None` if the fibre has a fixed length.
    pub fn throughput(&self) -> Option<f64> {
        self.line.map(|_| self.filament().throughput())
    }

    /// Vector from the root to the free end of the straight fibre [m].
    pub fn along(&self) -> Vec3<f64> {
        self.fibre.direction * self.fibre.length
    }

    /// The number of harmonics if the case does not give it.
    pub fn default_harmonics(&self) -> usize {
        match self.line {
            Some(_) => self.air.default_harmonics_at_stations(self.run.duration()),
            None => self.air.default_harmonics(self.run.duration()),
        }
    }

    /// The stations of the air between inlet and belt; `None` for a fibre of fixed length.
    pub fn stations(&self) -> Option<StationGrid> {
        self.line.map(|line| self.air.stations(line.distance))
    }

    /// Length of the way along which the air is described, from the root to the belt or a little beyond the
    /// end of a fibre of fixed length [m].
    pub fn way_of_air(&self) -> f64 {
        self.line.map_or(1.1 * self.fibre.length, |line| line.distance)
    }

    /// Number of flights of a run.
    pub fn flights(&self) -> u64 {
        self.run.replicates.div_ceil(WIDTH as u64)
    }

    /// After what distances a field of eddies in space repeats itself: ten times the largest length scale on
    /// the way.
    pub fn extent_of_air(&self) -> Extent {
        let side = 10.0 * self.length_scales().fold(0.0, f64::max);
        Extent { y: side, z: side }
    }

    /// The room of a field of eddies in space around a fibre that is alone in it.
    pub(crate) fn room_of_air(&self) -> Room {
        /// How far aside fibres go that hang, and that are fed, over the way: three standard deviations of usual ones.
        const SWINGS: [f64; 2] = [0.035, 0.135];
        let swing = SWINGS[usize::from(self.line.is_some())];
        Room::alone(self.way_of_air(), self.extent_of_air()).for_fibre(swing)
    }

    /// The smallest length scale of the eddies on the way of the air [m].
    pub fn smallest_length_scale(&self) -> f64 {
        self.length_scales().fold(f64::INFINITY, f64::min)
    }

    /// The length scale of the eddies at places along the way of the air [m].
    fn length_scales(&self) -> impl Iterator<Item = f64> {
        const PLACES: usize = 64;
        let mut hint = Hint::default();
        let x = |i: usize| self.way_of_air() * i as f64 / PLACES as f64;
        (0..=PLACES).map(move |i| self.air.local(Vec3::new(x(i), 0.0, 0.0), &mut hint).length_scale)
    }

    /// The time that the mean flow takes from the start of the way to its end [s]; one second in still air.
    pub fn travel_of_air(&self) -> f64 {
        const PIECES: usize = 256;
        let mut hint = Hint::default();
        let piece = self.way_of_air() / PIECES as f64;
        let speed = |i: usize| {
            let x = piece * (i as f64 + 0.5);
            self.air.local(Vec3::new(x, 0.0, 0.0), &mut hint).velocity.x
        };
        let travel: f64 =
            (0..PIECES).map(speed).map(|speed| piece / speed.max(1e-3 * self.air.velocity)).sum();
        if travel.is_finite() { travel } else { 1.0 }
    }

    /// The air in which a replicate of the case flies, to be looked at wherever one likes.
    ///
    /// * `replicate` – from 0
    /// * `threads` – that make its turbulence; they do not change it
    ///
    /// # Errors
    /// If the turbulence is the same everywhere across, see [`spunlaid_air::Lateral`].
    pub fn air_at_places(&self, replicate: u64, threads: usize) -> Result<AirAtPlaces, Error> {
        let key = StreamKey { seed: self.run.seed, replicate };
        AirAtPlaces::new(&self.air, self.way_of_air(), self.extent_of_air(), key, threads)
    }

    /// The eddies along the fibre.
    pub fn eddies(&self) -> Eddies {
        self.air.eddies_along(self.along(), self.fibre.elements)
    }

    /// Steps from one look at the flow around the fibre to the next, see `Air::time_between_looks`.
    pub fn steps_between_looks(&self) -> u64 {
        let time = match self.line {
            Some(line) if self.air.field_cutoff().is_some() => {
                EddyField::time_between_looks(&self.air, self.way_of_air(), line.feed_speed)
            }
            Some(line) => time_between_looks(&self.air, line.feed_speed),
            None => self.air.time_between_looks(self.along()),
        };
        ((self.run.rarer_looks * time / self.run.time_step) as u64).clamp(1, self.run.steps.max(1))
    }

    /// Largest Reynolds number across the fibre to expect [-]. The velocity is the larger of two: the mean flow's
    /// component across the fibre at the start, and three times the rms of the fluctuation.
    pub(crate) fn reynolds_across(&self) -> f64 {
        self.reynolds_across_at(3.0)
    }

    /// Usual Reynolds number across the fibre [-], likewise with one time the rms of the fluctuation.
    pub(crate) fn usual_reynolds_across(&self) -> f64 {
        self.reynolds_across_at(1.0)
    }

    fn reynolds_across_at(&self, times_rms: f64) -> f64 {
        let sine = self.fibre.direction.y.hypot(self.fibre.direction.z);
        let speed = (self.air.velocity.abs() * sine).max(times_rms * self.air.rms());
        speed * self.fibre.diameter / self.air.kinematic_viscosity
    }

    /// Time until which the air of a run has to last [s]. It is one step more than the run, because the energies at
    /// the last instant need one more step.
    pub fn air_horizon(&self) -> f64 {
        self.run.duration() + self.run.time_step
    }

    /// The speed that mean flow, turbulence, feed, belt, gravity and a fold that springs open together can
    /// give to a fibre [m/s]; six standard deviations of the turbulence are counted. A fold with the radius
    /// of an element springs open with `√(EI/ρA)/l = d √(E/ρ)/(4l)`.
    pub fn driving_speed(&self) -> f64 {
        let line = self.line.map_or(0.0, |line| line.feed_speed.abs() + line.belt_speed.abs());
        let fall = (2.0 * self.run.gravity.abs() * self.fibre.length).sqrt();
        let own = self.air.velocity.abs() + 6.0 * self.air.rms();
        let fibre = &self.fibre;
        let spring =
            0.25 * fibre.diameter / fibre.rest_length() * (fibre.youngs_modulus / fibre.density).sqrt();
        self.air.fastest(self.along()).max(own) + line + fall + spring
    }

    /// The turbulence of each eddy.
    pub(crate) fn turbulence_along(&self, eddies: &Eddies) -> Vec<EddyTurbulence> {
        self.air.turbulence_along(self.along(), self.fibre.elements, eddies)
    }

    /// The fibre, its drag, gravity and damping, in the form that the chain uses.
    pub fn strand(&self) -> FibreParameters {
        FibreParameters {
            fibre: self.strand_at_start(),
            drag: self.drag.element_drag(&self.fibre, self.air.density, self.air.kinematic_viscosity),
            gravity: self.run.gravity,
            damping: self.run.damping,
        }
    }

    /// The fibre as it starts: a fed one is two elements long.
    fn strand_at_start(&self) -> Fibre {
        let fibre = self.fibre;
        if self.line.is_none() {
            return fibre;
        }
        Fibre { length: fibre.rest_length() * FIRST_ELEMENTS as f64, elements: FIRST_ELEMENTS, ..fibre }
    }

    /// The likely reason why the positions of a fibre of this case become infinite or NaN.
    pub fn likely_cause_of_divergence(&self) -> String {
        let (h, shown) = (self.run.time_step, |time: f64| Dimension::Time.pretty(time));
        // A step may be as long as the feed of an element, which is no limit of stability.
        let limits = self.step_limits().into_iter().filter(|limit| limit.cause != FEEDING);
        let stretched = self.line.filter(|line| line.belt_speed > line.feed_speed);
        let cause = match (stretched, limits.min_by(|a, b| a.limit.total_cmp(&b.limit))) {
            (Some(line), _) => format!(
                "the belt is faster than the feed ({} and {}) and stretches the fibre that it holds. \
                Lower belt.speed, or let the fibre slide on all of its length (belt.contact = \
                \"friction\", with a belt.kept_length as long as what is fed) and lower run.time_step",
                Dimension::Velocity.pretty(line.belt_speed),
                Dimension::Velocity.pretty(line.feed_speed)
            ),
            (None, Some(StepLimit { cause, limit })) if h > 0.5 * limit => format!(
                "the time step {} is close to the stability limit {} of the {cause}; lower run.time_step",
                shown(h),
                shown(limit)
            ),
            _ => format!(
                "the drag is too stiff for the time step {} (a thin fibre in fast air); lower run.time_step",
                shown(h)
            ),
        };
        match self.slips().first() {
            Some(slip) => format!("{cause}; but first look at this: {slip}"),
            None => cause,
        }
    }
}

named! {
    /// What the checks of a run may cost.
    #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
    pub enum Checks {
        /// At most a fifth of the flight.
        #[default]
        Auto = "auto",
        /// Nothing: the run is not checked.
        None = "none",
        /// As much as the whole run takes with a finer step and with finer elements.
        Full = "full",
    }
}

impl Case {
    /// Whether the tension at the end of its spinline has still to be found by flights.
    pub fn waits_for_flights(&self) -> bool {
        self.spinline.as_ref().is_some_and(|line| matches!(line.end, crate::spinline::End::Flown(_)))
    }

    /// Enters the name and the value of every key but those on which no fibre depends into a checksum. A case that is
    /// written and read again has the same values, to the last bit; of files, the contents count.
    pub fn enter(&self, sum: &mut crc32fast::Hasher) {
        for key in keys::all().iter().filter(|key| !["run.replicates", "run.checks"].contains(&key.name)) {
            if let Some(value) = key.get(self) {
                sum.update(key.name.as_bytes());
                // A number that the flow gives along the way is another than the same number everywhere.
                sum.update(&[u8::from(key.is_derived(self))]);
                sum.update(&value.bytes());
            }
        }
    }
}
