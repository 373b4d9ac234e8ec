//! Dormand and Prince's method of order 5 with steps of its own choice, in the root of the distance.
//!
//! The friction of a boundary layer that begins at the die is infinite there like `1/√z`; in `s = √z` it is finite.

use super::thread::{ACROSS, ALONG, PROGRESS, Phase, Rates, SIZE, State, TEMPERATURE, Thread};

/// Relative error of a step.
pub(super) const TOLERANCE: f64 = 1e-8;
/// The smallest distance at which the air is looked at, as a share of the line.
const LEAST_DISTANCE: f64 = 1e-14;

/// Butcher's tableau. J. R. Dormand, P. J. Prince: J. Comput. Appl. Math. 6, 19, 1980.
const NODES: [f64; 7] = [0.0, 1.0 / 5.0, 3.0 / 10.0, 4.0 / 5.0, 8.0 / 9.0, 1.0, 1.0];
const WEIGHTS: [[f64; 6]; 7] = [
    [0.0; 6],
    [1.0 / 5.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0 / 40.0, 9.0 / 40.0, 0.0, 0.0, 0.0, 0.0],
    [44.0 / 45.0, -56.0 / 15.0, 32.0 / 9.0, 0.0, 0.0, 0.0],
    [19372.0 / 6561.0, -25360.0 / 2187.0, 64448.0 / 6561.0, -212.0 / 729.0, 0.0, 0.0],
    [9017.0 / 3168.0, -355.0 / 33.0, 46732.0 / 5247.0, 49.0 / 176.0, -5103.0 / 18656.0, 0.0],
    [35.0 / 384.0, 0.0, 500.0 / 1113.0, 125.0 / 192.0, -2187.0 / 6784.0, 11.0 / 84.0],
];
/// The result of order 5 less that of order 4.
const ERROR: [f64; 7] =
    [71.0 / 57600.0, 0.0, -71.0 / 16695.0, 71.0 / 1920.0, -17253.0 / 339_200.0, 22.0 / 525.0, -1.0 / 40.0];
/// For values between the ends of a step. E. Hairer, S. P. Nørsett, G. Wanner: Solving Ordinary Differential
/// Equations I.
const DENSE: [f64; 7] = [
    -12_715_105_075.0 / 11_282_082_432.0,
    0.0,
    87_487_479_700.0 / 32_700_410_799.0,
    -10_690_763_975.0 / 1_880_347_072.0,
    701_980_252_875.0 / 199_316_789_632.0,
    -1_453_857_185.0 / 822_651_844.0,
    69_997_945.0 / 29_380_423.0,
];

/// Steps along a thread in one phase.
pub(super) struct Stepper<'t, 'a> {
    pub(super) thread: &'t Thread<'a>,
    pub(super) phase: Phase,
    /// Size of the tensions that occur [N].
    tension: f64,
    hint: usize,
    /// Whether a state was as fast as its own elastic wave.
    pub(super) is_elastic_wave: bool,
}

/// A step: the states at its ends and what is between them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// `s` at its start, and its length [√m].
    pub(super) start: f64,
    pub(super) length: f64,
    pub(super) phase: Phase,
    pub(super) from: State,
    pub(super) to: State,
    /// The error over what is allowed [-].
    pub(super) error: f64,
    slopes: [State; 2],
    bend: State,
}

impl<'t, 'a> Stepper<'t, 'a> {
    pub(super) fn new(thread: &'t Thread<'a>, tension: f64) -> Self {
        Self { thread, phase: Phase::Melt, tension, hint: 0, is_elastic_wave: false }
    }

    /// The rates at the distance `s²`.
    pub(super) fn rates(&mut self, s: f64, state: &State) -> Rates {
        let distance = (s * s).max(LEAST_DISTANCE * self.thread.line.length);
        self.thread.rates(distance, state, self.phase, &mut self.hint)
    }

    /// `d/ds = 2s d/dz`.
    fn slopes(&mut self, s: f64, state: &State) -> State {
        let s = s.max(libm::sqrt(LEAST_DISTANCE * self.thread.line.length));
        let rates = self.rates(s, state);
        self.is_elastic_wave |= rates.is_elastic_wave;
        std::array::from_fn(|i| 2.0 * s * rates.slopes[i])
    }

    /// Tries a step.
    pub(super) fn step(&mut self, start: f64, length: f64, from: &State) -> Step {
        self.is_elastic_wave = false;
        let mut k = [[0.0; SIZE]; 7];
        let mut to = *from;
        for stage in 0..7 {
            let row = &WEIGHTS[stage];
            to = std::array::from_fn(|i| {
                from[i] + length * (0..stage).map(|before| row[before] * k[before][i]).sum::<f64>()
            });
            k[stage] = self.slopes(start + NODES[stage] * length, &to);
        }
        let sum = |weights: &[f64; 7], i: usize| {
            length * (0..7).map(|stage| weights[stage] * k[stage][i]).sum::<f64>()
        };
        // An error of ln v is a share of v.
        let larger = |i: usize| from[i].abs().max(to[i].abs());
        let sizes = [
            1.0,
            larger(TEMPERATURE),
            self.tension,
            larger(PROGRESS).max(0.01),
            larger(ALONG),
            larger(ACROSS),
        ];
        let error = sizes.iter().enumerate().map(|(i, size)| {
            let share = sum(&ERROR, i) / (TOLERANCE * size);
            share * share
        });
        let error = libm::sqrt(error.sum::<f64>() / sizes.len() as f64);
        let bend = std::array::from_fn(|i| sum(&DENSE, i));
        let slopes = [0, 6].map(|stage| std::array::from_fn(|i| length * k[stage][i]));
        Step { start, length, phase: self.phase, from: *from, to, error, slopes, bend }
    }
}

impl Step {
    /// The length to try next, from the error of this one [√m].
    pub(super) fn next_length(&self) -> f64 {
        let factor = if self.error.is_finite() { 0.9 * libm::pow(self.error.max(1e-10), -0.2) } else { 0.0 };
        self.length * factor.clamp(0.2, 5.0)
    }

    pub(super) fn end(&self) -> f64 {
        self.start + self.length
    }

    /// The state at a place of the step.
    pub(super) fn at(&self, s: f64) -> State {
        let share = ((s - self.start) / self.length).clamp(0.0, 1.0);
        let rest = 1.0 - share;
        std::array::from_fn(|i| {
            let rise = self.to[i] - self.from[i];
            let first = self.slopes[0][i] - rise;
            let last = rise - self.slopes[1][i] - first;
            self.from[i] + share * (rise + rest * (first + share * (last + rest * self.bend[i])))
        })
    }
}
