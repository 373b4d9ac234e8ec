//! The way of the air from the inlet to the belt, and the generations of the field along it.

use crate::field::Hint;
use crate::motion::{Air, EddyModel, LocalAir};
use spunlaid_ground::Vec3;

/// Pieces of the way. The travel time is then exact to 1e-4 of the shortest period.
const PIECES: usize = 2048;
/// Largest age between two generations, in decay times. theory.md (82)
const LONGEST_AGE: f64 = 1.0 / 6.0;
/// Largest change of speed, length scale or cut-off frequency from one generation to the next, as a logarithm.
const LARGEST_CHANGE: f64 = 0.2;
/// Most generations.
const MOST: usize = 1000;
/// Share by which two numbers of one pattern may differ.
const SAME: f64 = 1e-6;
/// Slowest air that carries eddies, over the fastest.
const SLOWEST: f64 = 1e-3;

/// The air where a generation is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stage {
    /// Travel time from the inlet [s].
    pub(super) travel: f64,
    /// Mean speed [m/s].
    pub(super) speed: f64,
    /// Length of an eddy [m].
    pub(super) length_scale: f64,
    /// Cut-off frequency [Hz].
    pub(super) cutoff_frequency: f64,
}

/// How eddies pass from the inlet to the belt.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct EddyPath {
    pieces_per_length: f64,
    /// At the ends of the pieces: the number of the generation before it and, as its fraction, the way to the
    /// next; and the time that the air has travelled since the inlet [s]. The label of air is the time less
    /// this.
    passages: Vec<[f64; 2]>,
    pub(super) stages: Vec<Stage>,
    /// Age from one generation to the next, in decay times; zero for a frozen pattern, infinite for independent eddies.
    pub(super) ageing: f64,
}

/// Steps from one generation of eddies to the next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GenerationSteps {
    /// Number that there are at least, where eddies are carried.
    pub(super) least: usize,
    /// How many times as much of their age and of the air they may be apart as usual.
    pub(super) longer: f64,
}

impl GenerationSteps {
    /// As many as the air needs.
    pub(super) const USUAL: Self = Self { least: 0, longer: 1.0 };
}

impl EddyPath {
    /// * `distance` – from the inlet, or the root, to the end of the way [m]
    pub(super) fn new(air: &Air, distance: f64) -> Self {
        Self::with_steps(air, distance, GenerationSteps::USUAL)
    }

    pub(super) fn with_steps(air: &Air, distance: f64, steps: GenerationSteps) -> Self {
        let GenerationSteps { least, longer } = steps;
        let mut hint = Hint::default();
        let x = |i: f64| distance * i / PIECES as f64;
        let mut stage = |i: f64| {
            let local = air.local(Vec3::new(x(i), 0.0, 0.0), &mut hint);
            Stage { travel: 0.0, ..Stage::from_air(&local, air) }
        };
        let mut stages: Vec<Stage> = (0..=PIECES).map(|i| stage(i as f64)).collect();
        let mut middles: Vec<Stage> = (0..PIECES).map(|i| stage(i as f64 + 0.5)).collect();
        let fastest = stages.iter().map(|stage| stage.speed).fold(f64::MIN_POSITIVE, f64::max);
        for stage in stages.iter_mut().chain(&mut middles) {
            stage.speed = stage.speed.max(SLOWEST * fastest);
        }
        // Simpson's rule.
        let piece = distance / PIECES as f64;
        let sums = |value: fn(&Stage) -> f64| {
            let mut sums = vec![0.0];
            for (ends, middle) in stages.windows(2).zip(&middles) {
                let step = (value(&ends[0]) + 4.0 * value(middle) + value(&ends[1])) * piece / 6.0;
                sums.push(sums[sums.len() - 1] + step);
            }
            sums
        };
        let travels = sums(|stage| 1.0 / stage.speed);
        let lengths = sums(|stage| 1.0 / stage.length_scale);
        for (stage, travel) in stages.iter_mut().zip(&travels) {
            stage.travel = *travel;
        }
        let pieces_per_length = 1.0 / piece;
        let EddyModel::Convected { decay_time } = air.eddies else {
            let passages = lengths.iter().map(|&generation| [generation, 0.0]).collect();
            let eddies = lengths[PIECES].ceil().clamp(1.0, MOST as f64) as usize;
            let stages = (0..eddies)
                .map(|eddy| Stage { travel: 0.0, ..at(&stages, &lengths, eddy as f64 + 0.5) })
                .collect();
            return Self { pieces_per_length, passages, stages, ageing: f64::INFINITY };
        };
        let whole = travels[PIECES];
        let steps = self::steps(&stages, &travels, whole / decay_time, longer, least);
        let travel = if steps == 0 { 0.0 } else { whole / steps as f64 };
        let passages = travels.iter().map(|&time| [if steps == 0 { 0.0 } else { time / travel }, time]);
        Self {
            pieces_per_length,
            passages: passages.collect(),
            stages: (0..=steps).map(|j| at(&stages, &travels, j as f64 * travel)).collect(),
            ageing: travel / decay_time,
        }
    }

    /// How many times as fast as on another way the same pattern passes on this one; None if the two have
    /// other patterns.
    pub(super) fn pace_of(&self, other: &Self) -> Option<f64> {
        let (first, of_other) = (self.stages.first()?, other.stages.first()?);
        let pace = first.cutoff_frequency / of_other.cutoff_frequency;
        let is_near = |a: f64, b: f64| (a - b).abs() <= SAME * a.abs().max(b.abs());
        let stages_agree = self.stages.iter().zip(&other.stages).all(|(a, b)| {
            is_near(a.travel * pace, b.travel)
                && is_near(a.speed, b.speed * pace)
                && is_near(a.cutoff_frequency, b.cutoff_frequency * pace)
                && is_near(a.length_scale, b.length_scale)
        });
        let ageing_agrees = self.ageing == other.ageing || is_near(self.ageing, other.ageing);
        (self.stages.len() == other.stages.len() && stages_agree && ageing_agrees).then_some(pace)
    }

    /// Whether the pattern of one generation passes into that of the next.
    pub(super) fn is_carried(&self) -> bool {
        self.ageing.is_finite()
    }

    /// The highest frequency that is felt by a fibre which moves along the way at a speed [m/s], in places
    /// more slowly [Hz].
    pub(super) fn highest_frequency_at(&self, speed: f64) -> f64 {
        let felt = |stage: &Stage| stage.cutoff_frequency * (1.0 - speed / stage.speed).abs().max(0.5);
        self.stages.iter().map(felt).fold(0.0, f64::max)
    }

    /// Travel time of the air at the end of the way [s].
    pub(super) fn longest_travel(&self) -> f64 {
        self.passages[PIECES][1]
    }

    /// Travel times of the youngest and the oldest air that is looked at in a generation [s].
    pub(super) fn travels(&self, generation: usize) -> [f64; 2] {
        let last = self.stages.len() - 1;
        match last {
            0 => [0.0, self.longest_travel()],
            _ if !self.is_carried() => [0.0, 0.0],
            _ => [generation.saturating_sub(1), (generation + 1).min(last)].map(|j| self.stages[j].travel),
        }
    }

    /// The farthest place at which a generation is looked at, as its distance from the inlet [m].
    pub(super) fn farthest(&self, generation: usize) -> f64 {
        let behind = self.passages.partition_point(|[number, _]| *number <= generation as f64 + 1.0);
        let is_last = generation + 1 == self.stages.len();
        (if is_last { PIECES } else { behind.min(PIECES) }) as f64 / self.pieces_per_length
    }

    /// Pieces of the way per length [1/m].
    #[inline(always)]
    pub(super) fn pieces_per_length(&self) -> f64 {
        self.pieces_per_length
    }

    /// Generation and travel time [s] of the air at the start and at the end of a piece of the way, and the
    /// share of the piece that lies before a place.
    ///
    /// * `place` – distance from the inlet in pieces, zero or above
    #[inline(always)]
    pub(super) fn piece(&self, place: f64) -> (&[f64; 4], f64) {
        let place = place.min(PIECES as f64);
        let piece = (place as usize).min(PIECES - 1);
        let ends = self.passages.as_flattened()[2 * piece..].first_chunk();
        (ends.unwrap_or(&[0.0; 4]), place - piece as f64)
    }
}

impl Stage {
    fn from_air(local: &LocalAir, air: &Air) -> Self {
        Self {
            travel: 0.0,
            speed: local.velocity.norm(),
            length_scale: local.length_scale,
            cutoff_frequency: local.cutoff_frequency.min(air.cutoff_frequency),
        }
    }
}

/// The stage at which a rising quantity has a value.
fn at(stages: &[Stage], rising: &[f64], value: f64) -> Stage {
    let end = rising.partition_point(|known| *known < value).clamp(1, rising.len() - 1);
    let (a, b) = (&stages[end - 1], &stages[end]);
    let rise = rising[end] - rising[end - 1];
    let share = if rise > 0.0 { ((value - rising[end - 1]) / rise).clamp(0.0, 1.0) } else { 0.0 };
    let between = |quantity: fn(&Stage) -> f64| quantity(a) + share * (quantity(b) - quantity(a));
    Stage {
        travel: between(|stage| stage.travel),
        speed: between(|stage| stage.speed),
        length_scale: between(|stage| stage.length_scale),
        cutoff_frequency: between(|stage| stage.cutoff_frequency),
    }
}

/// Steps of equal travel time in which neither age nor air change too much. None if the pattern is the same everywhere.
///
/// * `age` – of the air at the end of the way, in decay times
/// * `longer` – how many times as large as usual a step may be
/// * `least` – number of them
fn steps(stages: &[Stage], travels: &[f64], age: f64, longer: f64, least: usize) -> usize {
    let whole = travels[travels.len() - 1];
    let change = |a: &Stage, b: &Stage| {
        let ratios =
            [a.speed / b.speed, a.length_scale / b.length_scale, a.cutoff_frequency / b.cutoff_frequency];
        ratios.into_iter().map(|ratio| libm::log(ratio).abs()).fold(0.0, f64::max)
    };
    let least = least.max((age / (longer * LONGEST_AGE) - 1e-9).ceil().clamp(0.0, MOST as f64) as usize);
    (least..MOST)
        .find(|&steps| {
            let stage = |j: usize| at(stages, travels, whole * j as f64 / steps.max(1) as f64);
            let largest = if steps == 0 { 1e-6 } else { longer * LARGEST_CHANGE };
            (0..steps.max(1)).all(|j| change(&stage(j), &stage(j + 1)) <= largest)
        })
        .unwrap_or(MOST)
}
