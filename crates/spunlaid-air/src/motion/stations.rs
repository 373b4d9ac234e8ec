//! The air along the way of fed fibres: signals at fixed stations between inlet and belt.
//!
//! ```text
//! Wind (one signal for each station) → velocity at the stations at a look → velocity at each element, where it is
//! ```
//!
//! A fed element does not stay with an eddy: it feels the air of the place where it is. Between two stations the signal
//! is interpolated with weights that keep its variance.                                           theory.md (64)

use super::in_space::{AirAtElements, InstantStations};
use super::{Air, Eddies, EddyModel, EddyTurbulence, FibreAir, Flow, Wind};
use crate::field::Hint;
use spunlaid_ground::lanes::indices;
use spunlaid_ground::{Lanes, PerLane, Register, Task, Vec3, WIDTH, Wide};

/// Looks in the time in which fibre or air passes a length scale.
const LOOKS: f64 = 4.0;

shared! {
    /// What the air along the way of one flight's fibres has in common. Where the stations are may differ.
    pub struct Way {
        stations: usize = "the number of stations between inlet and belt (belt.distance, air.length_scale)",
        every: u64 = "how often the air on the way is looked up (air.length_scale, air.velocity, feed.speed)",
        in_field: bool = "whether the air is a field (air.field)",
        widens: bool = "whether the mean flow widens (air.widening)",
    }
}

impl Way {
    /// * `every` – steps from one look to the next
    pub fn from_air(air: &Air, grid: &StationGrid, every: u64) -> Self {
        Self {
            stations: grid.count,
            every: every.max(1),
            in_field: matches!(air.flow, Flow::Field(_)),
            widens: air.widens(),
        }
    }
}

/// The air along the way of up to eight fed fibres, and at their elements.
#[derive(Clone, Debug)]
pub struct Stations {
    way: Way,
    /// Distance of each root from the middle of the slot [m].
    off_middle: Lanes,
    /// Stations to a length [1/m].
    per_length: Lanes,
    /// Mean velocity along x [m/s], and factor of the signal.
    mean_flow: Vec<[Lanes; 2]>,
    /// `2(1−ρ)` with the correlation `ρ` of a station's signal and the next one's.
    decorrelation: Vec<Lanes>,
    /// Of each station, at the last look, in each lane: fluctuation, and mean velocity along x [m/s].
    last_look: Vec<[[f64; 4]; WIDTH]>,
    pub(super) elements: AirAtElements,
}

/// A fibre, and the stations on its way.
#[derive(Clone, Debug)]
pub struct FibreOnWay {
    /// The air, and the inlet.
    pub around: FibreAir,
    /// The stations.
    pub grid: StationGrid,
}

impl Stations {
    /// * `lanes` – of the fibres
    /// * `elements` – number of elements at the start
    pub fn new(way: Way, lanes: &PerLane<FibreOnWay>, elements: usize) -> Self {
        let mut hint = Hint::default();
        let here = lanes.map(|FibreOnWay { around: FibreAir { air, .. }, grid }| {
            let mean_flow = (0..way.stations).map(|k| {
                let x = (k as f64 + 0.5) * grid.spacing;
                match air.flow {
                    Flow::Uniform => (air.velocity, 1.0),
                    Flow::Profile(_) => {
                        let local = air.local(Vec3::new(x, 0.0, 0.0), &mut hint);
                        (local.velocity.x, local.rms)
                    }
                    Flow::Field(_) => (0.0, 1.0),
                }
            });
            let mean_flow: Vec<(f64, f64)> = mean_flow.collect();
            let turbulence = air.turbulence_at(grid);
            let correlations = turbulence.windows(2).map(|pair| air.correlation(&pair[0], &pair[1]));
            (mean_flow, correlations.collect::<Vec<f64>>())
        });
        let mean_flow = |k: usize| {
            [here.lanes(|(mean_flow, _)| mean_flow[k].0), here.lanes(|(mean_flow, _)| mean_flow[k].1)]
        };
        let decorrelation = |k: usize| match k + 1 < way.stations {
            true => here.lanes(|(_, correlations)| 2.0 * (1.0 - correlations[k])),
            false => Lanes::ZERO,
        };
        let in_field = way.in_field.then(|| lanes.map(|fibre| fibre.around.clone()));
        Self {
            off_middle: lanes.lanes(|fibre| fibre.around.inlet.y),
            per_length: lanes.lanes(|fibre| 1.0 / fibre.grid.spacing),
            mean_flow: (0..way.stations).map(mean_flow).collect(),
            decorrelation: (0..way.stations).map(decorrelation).collect(),
            last_look: vec![[[0.0; 4]; WIDTH]; way.stations],
            elements: AirAtElements::new(in_field, elements, way.every),
            way,
        }
    }

    /// Replaces the air by another one with as many stations. The values of the last look are kept until the next.
    pub(crate) fn change(&mut self, by: Self) {
        let Self { way, per_length, mean_flow, decorrelation, elements, .. } = by;
        (self.way, self.per_length, self.mean_flow, self.decorrelation) =
            (way, per_length, mean_flow, decorrelation);
        self.elements.change(elements);
    }

    /// Looks at the air at the elements before a step at the time `t` [s].
    #[inline(always)]
    pub(super) fn look<S: Register>(
        &mut self,
        step: u64,
        t: f64,
        wind: &mut Wind,
        position: &[Vec3<Lanes>],
    ) -> InstantStations<'_, S> {
        if self.elements.is_look_due(step) {
            S::ISA.run(Look { stations: self, t, wind, position });
        }
        self.elements.now(step)
    }

    /// Keeps the velocity at a station, which has this signal.
    #[inline(always)]
    fn hear<S: Register>(&mut self, station: usize, signal: Vec3<Wide<S>>) {
        let [mean, factor] = &self.mean_flow[station];
        let Vec3 { x, y, z } = (signal * Wide::load(factor)).store();
        for (lane, last_look) in self.last_look[station].iter_mut().enumerate() {
            *last_look = [x.0[lane], y.0[lane], z.0[lane], mean.0[lane]];
        }
    }

    /// Looks up the air at the elements at the time `t` [s].
    #[inline(always)]
    fn look_up<S: Register>(&mut self, t: f64, wind: &mut Wind, position: &[Vec3<Lanes>]) {
        // No closures here, because the compiler does not always inline them.
        match wind.among_samples::<S>(t) {
            Some(signal) => {
                for k in 0..self.way.stations {
                    self.hear(k, signal.velocity(k as u32));
                }
            }
            None => {
                let signal = wind.blow::<S>(t);
                for k in 0..self.way.stations {
                    self.hear(k, signal.velocity(k as u32));
                }
            }
        }
        let (half, one) = (Wide::<S>::splat(0.5), Wide::splat(1.0));
        let (each, field, per_step) = self.elements.look_up::<S>(position);
        let per_length = Wide::load(&self.per_length);
        let last = (self.way.stations - 1) as f64;
        let (end, before_end) = (Wide::splat(last), Wide::splat(last - 1.0));
        for (j, (ends, here)) in position.windows(2).zip(each).enumerate() {
            let centre = (Wide::<S>::load(&ends[0].x) + Wide::load(&ends[1].x)) * half;
            let place = (centre * per_length - half).max(Wide::zero());
            let place = Wide::select_less(place, end, place, end);
            let start = place.floor();
            let start = Wide::select_less(start, before_end, start, before_end);
            let mut rows = [[&[0.0; 4]; WIDTH]; 2];
            let mut decorrelation = Lanes::ZERO;
            for (lane, k) in indices(start).into_iter().enumerate() {
                let k = k.min(self.way.stations - 2);
                decorrelation.0[lane] = self.decorrelation[k].0[lane];
                rows[0][lane] = &self.last_look[k][lane];
                rows[1][lane] = &self.last_look[k + 1][lane];
            }
            let share = place - start;
            let rest = one - share;
            // (1−w)² + w² + 2w(1−w)ρ = 1 − 2w(1−w)(1−ρ)
            let scale = one.over((share * rest).neg_mul_add(Wide::load(&decorrelation), one).sqrt());
            let [[x, y, z, upper], [u, v, w, lower]] = [S::load_rows(rows[0]), S::load_rows(rows[1])];
            let [above, below] = [Vec3::new(Wide(x), Wide(y), Wide(z)), Vec3::new(Wide(u), Wide(v), Wide(w))];
            let mut fluctuation = below.mul_add(share * scale, above * (rest * scale));
            let (upper, lower) = (Wide(upper), Wide(lower));
            let mut flow = Vec3::new((lower - upper).mul_add(share, upper), Wide::zero(), Wide::zero());
            if self.way.widens {
                // −y dU/dx, with the velocity between the stations as above.                        theory.md (49a)
                let y = (Wide::load(&ends[0].y) + Wide::load(&ends[1].y))
                    .mul_add(half, Wide::load(&self.off_middle));
                flow.y = (upper - lower) * per_length * y;
            }
            if let Some(field) = field {
                let [u, v, w, rms] = field.value(j);
                flow = Vec3::new(Wide::load(u), Wide::load(v), Wide::load(w));
                fluctuation = fluctuation * Wide::load(rms);
            }
            here.keep(flow + fluctuation, per_step);
        }
    }
}

/// [`Stations::look_up`].
struct Look<'a> {
    stations: &'a mut Stations,
    t: f64,
    wind: &'a mut Wind,
    position: &'a [Vec3<Lanes>],
}

impl Task for Look<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        self.stations.look_up::<S>(self.t, self.wind, self.position);
    }
}

/// Longest time between two looks at the air [s]: fibre and air pass a quarter of a length scale.
pub fn time_between_looks(air: &Air, feed_speed: f64) -> f64 {
    air.length_scale / air.velocity.abs().max(feed_speed) / LOOKS
}

/// Most stations along the way.
const MOST: f64 = 2000.0;
/// Stations in a length scale of a carried pattern, and in the shortest wave.
const PER_LENGTH_SCALE: f64 = 4.0;
const PER_WAVE: f64 = 8.0;

/// Stations along x, the first half a spacing from the inlet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StationGrid {
    /// Number of stations, at least two.
    pub count: usize,
    /// Distance between two [m].
    pub spacing: f64,
}

impl StationGrid {
    /// Vector from the inlet to half a spacing below the last station [m].
    fn along(&self) -> Vec3<f64> {
        Vec3::new(self.spacing * self.count as f64, 0.0, 0.0)
    }

    /// The eddies, one for each station.
    pub fn eddies(&self) -> Eddies {
        Eddies::one_for_each(self.count)
    }
}

impl Air {
    /// The stations between an inlet and a belt at a distance [m] from it.
    ///
    /// Independent eddies have one in each length scale. A carried pattern has four in each length scale and
    /// eight in the shortest wave.
    pub fn stations(&self, distance: f64) -> StationGrid {
        const PLACES: usize = 64;
        let mut hint = Hint::default();
        let spacing = match self.eddies {
            EddyModel::Independent => self.length_scale,
            EddyModel::Convected { .. } => (0..PLACES)
                .map(|i| {
                    let x = distance * (i as f64 + 0.5) / PLACES as f64;
                    let air = self.local(Vec3::new(x, 0.0, 0.0), &mut hint);
                    let wave = air.velocity.norm() / air.cutoff_frequency;
                    let shortest = if wave > 0.0 { wave / PER_WAVE } else { f64::INFINITY };
                    shortest.min(air.length_scale / PER_LENGTH_SCALE)
                })
                .fold(f64::INFINITY, f64::min),
        };
        let count = (distance / spacing).ceil().clamp(1.0, MOST);
        StationGrid { count: count as usize + 1, spacing: spacing.max(distance / count) }
    }

    /// The turbulence at each station; its mean is zero. In a uniform flow it has the flow's rms, otherwise rms one.
    pub fn turbulence_at(&self, grid: &StationGrid) -> Vec<EddyTurbulence> {
        let mut turbulence = self.turbulence_along(grid.along(), grid.count, &grid.eddies());
        turbulence.iter_mut().for_each(|eddy| eddy.mean = 0.0);
        turbulence
    }

    /// Correlation of the signals of two neighbouring stations [-], the second of which is `lower`.
    pub(super) fn correlation(&self, upper: &EddyTurbulence, lower: &EddyTurbulence) -> f64 {
        let Some(time) = lower.carried else { return 0.0 };
        let (mut common, mut own) = (0.0, (0.0, 0.0));
        let spacing = std::f64::consts::TAU / self.repeat_time();
        for component in 0..3 {
            let amplitudes = [upper, lower].map(|end| end.spectrum(self, component).amplitudes());
            for (n, (a, b)) in amplitudes[0].iter().zip(&amplitudes[1]).enumerate() {
                common += a * b * libm::cos((n as f64 + 0.5) * spacing * time);
            }
            own.0 += amplitudes[0].iter().map(|a| a * a).sum::<f64>();
            own.1 += amplitudes[1].iter().map(|a| a * a).sum::<f64>();
        }
        let whole = (own.0 * own.1).sqrt();
        if whole > 0.0 { (common / whole * libm::exp(-lower.decay_times)).clamp(0.0, 1.0) } else { 1.0 }
    }
}
