//! Dormand and Prince's method of order 5 with steps of its own choice, in the root of the distance; where a melt
//! relaxes much faster than it flows, Hairer and Wanner's method of order 4 for stiff equations.
//!
//! The friction of a boundary layer that begins at the die is infinite there like `1/√z`; in `s = √z` it is finite.

use super::elimination::Factors;
use super::filament::{
    ACROSS, ALONG, Filament, LN_SPEED, PROGRESS, Phase, Rates, SIZE, State, TEMPERATURE, TENSION,
};

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

/// RODAS: the parts of earlier stages in the state of a stage, and in its right-hand side; where the stages are,
/// and what the change with the place adds. E. Hairer, G. Wanner: Solving Ordinary Differential Equations II, 1996.
const STIFF_GAMMA: f64 = 0.25;
const STIFF_NODES: [f64; 6] = [0.0, 0.386, 0.21, 0.63, 1.0, 1.0];
const STIFF_PLACE: [f64; 6] = [0.25, -0.1043, 0.1035, -0.036_200_000_000_000_23, 0.0, 0.0];
const STIFF_STATE: [[f64; 5]; 6] = [
    [0.0; 5],
    [1.544, 0.0, 0.0, 0.0, 0.0],
    [0.946_678_528_081_582_6, 0.255_701_169_898_328_4, 0.0, 0.0, 0.0],
    [3.314_825_187_068_521, 2.896_124_015_972_201, 0.998_641_913_997_781_7, 0.0, 0.0],
    [1.221_224_509_226_641, 6.019_134_481_288_629, 12.537_083_329_320_87, -0.687_886_036_105_895, 0.0],
    [1.221_224_509_226_641, 6.019_134_481_288_629, 12.537_083_329_320_87, -0.687_886_036_105_895, 1.0],
];
const STIFF_SIDE: [[f64; 5]; 6] = [
    [0.0; 5],
    [-5.6688, 0.0, 0.0, 0.0, 0.0],
    [-2.430_093_356_833_875, -0.206_359_915_709_191_5, 0.0, 0.0, 0.0],
    [-0.107_352_905_815_137_5, -9.594_562_251_023_355, -20.470_286_148_096_16, 0.0, 0.0],
    [7.496_443_313_967_647, -10.246_804_314_643_52, -33.999_903_528_199_05, 11.708_908_932_061_6, 0.0],
    [
        8.083_246_795_921_522,
        -7.981_132_988_064_893,
        -31.521_594_328_743_71,
        16.319_305_431_231_36,
        -6.058_818_238_834_054,
    ],
];
/// For values between the ends of such a step.
const STIFF_DENSE: [[f64; 5]; 2] = [
    [
        10.126_235_083_445_86,
        -7.487_995_877_610_167,
        -34.800_918_615_557_47,
        -7.992_771_707_568_823,
        1.025_137_723_295_662,
    ],
    [
        -0.676_280_339_280_125_3,
        6.087_714_651_680_015,
        16.430_843_208_924_78,
        24.767_225_114_183_86,
        -6.594_389_125_716_872,
    ],
];

/// Steps along a filament in one phase.
pub(super) struct Stepper<'t, 'a> {
    pub(super) filament: &'t Filament<'a>,
    pub(super) phase: Phase,
    /// Size of the tensions that occur [N].
    tension: f64,
    hint: usize,
    /// Whether to step by the method for stiff equations.
    pub(super) is_stiff: bool,
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
    /// The error over what is allowed [-], and its order.
    pub(super) error: f64,
    order: f64,
    slopes: [State; 2],
    bend: State,
}

impl<'t, 'a> Stepper<'t, 'a> {
    pub(super) fn new(filament: &'t Filament<'a>, tension: f64) -> Self {
        Self { filament, phase: Phase::Melt, tension, hint: 0, is_stiff: false, is_elastic_wave: false }
    }

    /// The rates at the distance `s²`.
    pub(super) fn rates(&mut self, s: f64, state: &State) -> Rates {
        let distance = (s * s).max(LEAST_DISTANCE * self.filament.line.length);
        self.filament.rates(distance, state, self.phase, &mut self.hint)
    }

    /// `d/ds = 2s d/dz`.
    fn slopes(&mut self, s: f64, state: &State) -> State {
        let s = s.max(libm::sqrt(LEAST_DISTANCE * self.filament.line.length));
        let rates = self.rates(s, state);
        self.is_elastic_wave |= rates.is_elastic_wave;
        std::array::from_fn(|i| 2.0 * s * rates.slopes[i])
    }

    /// How far into a step filament and air have the same speed [√m], by halves, and whether so little air crosses
    /// that the heat transfer has a cusp there. None if they do not, or have it at the start.
    pub(super) fn cusp(&mut self, step: &Step) -> Option<(f64, bool)> {
        let mut faster = |s: f64, state: &State| self.filament.faster_air(s * s, state, &mut self.hint);
        let [before, across] = faster(step.start, &step.from);
        let [after, _] = faster(step.end(), &step.to);
        let speed = libm::exp(step.from[LN_SPEED]);
        if before.abs() < 1e-6 * speed || (before < 0.0) == (after < 0.0) {
            return None;
        }
        let (mut low, mut high) = (0.0, step.length);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            let s = step.start + middle;
            if (faster(s, &step.at(s))[0] < 0.0) == (before < 0.0) { low = middle } else { high = middle }
        }
        Some((high, 8.0 * across.abs() < 0.1 * speed))
    }

    /// Tries a step.
    pub(super) fn step(&mut self, start: f64, length: f64, from: &State) -> Step {
        self.is_elastic_wave = false;
        if self.is_stiff && self.phase == Phase::Melt {
            return self.stiff_step(start, length, from);
        }
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
        let error = self.error(from, &to, |i| sum(&ERROR, i));
        let bend = std::array::from_fn(|i| sum(&DENSE, i));
        let slopes = [0, 6].map(|stage| std::array::from_fn(|i| length * k[stage][i]));
        Step { start, length, phase: self.phase, from: *from, to, error, order: 5.0, slopes, bend }
    }

    /// The error of a step over what is allowed [-].
    fn error(&self, from: &State, to: &State, of: impl Fn(usize) -> f64) -> f64 {
        let sizes = self.sizes(from, to);
        let squares = sizes.iter().enumerate().map(|(i, size)| {
            let share = of(i) / (self.filament.tolerance * size);
            share * share
        });
        libm::sqrt(squares.sum::<f64>() / sizes.len() as f64)
    }

    /// What the errors of `ln v`, `T`, `F`, `y` and the conformation are measured by. An error of `ln v` is a share
    /// of `v`, and the stress comes from the conformation less one.
    fn sizes(&self, from: &State, to: &State) -> [f64; ACROSS + 1] {
        let larger = |i: usize| from[i].abs().max(to[i].abs());
        let strained = |i: usize| (from[i] - 1.0).abs().max((to[i] - 1.0).abs());
        let strain = strained(ALONG).max(strained(ACROSS)).max(1e-6);
        let progress = larger(PROGRESS).max(0.01);
        [
            1.0,
            larger(TEMPERATURE),
            self.tension,
            progress,
            strain.min(larger(ALONG)),
            strain.min(larger(ACROSS)),
        ]
    }

    /// How the slopes change with each value of the state, by differences, and with the place.
    fn derivatives(
        &mut self,
        start: f64,
        length: f64,
        from: &State,
        slopes: &State,
    ) -> ([State; SIZE], State) {
        let sizes = self.sizes(from, from);
        let mut by_state = [[0.0; SIZE]; SIZE];
        for i in [LN_SPEED, TEMPERATURE, TENSION, PROGRESS, ALONG, ACROSS] {
            let mut near = *from;
            near[i] += 1e-6 * sizes[i];
            let moved = near[i] - from[i];
            let there = self.slopes(start, &near);
            for (row, (there, here)) in by_state.iter_mut().zip(there.iter().zip(slopes)) {
                row[i] = (there - here) / moved;
            }
        }
        let next = self.slopes(start + 1e-5 * length, from);
        (by_state, std::array::from_fn(|i| (next[i] - slopes[i]) / (1e-5 * length)))
    }

    /// Tries a step by a linearly implicit method, which a fast relaxation does not hold up.
    fn stiff_step(&mut self, start: f64, length: f64, from: &State) -> Step {
        let first = self.slopes(start, from);
        let (by_state, by_place) = self.derivatives(start, length, from, &first);
        let factors = Factors::of(SIZE, |row, column| {
            let diagonal = if row == column { 1.0 / (STIFF_GAMMA * length) } else { 0.0 };
            diagonal - by_state[row][column]
        });
        let mut u = [[0.0; SIZE]; 6];
        let mut to = *from;
        for stage in 0..6 {
            let sum = |weights: &[f64; 5], i: usize| {
                weights.iter().zip(&u).take(stage).map(|(weight, u)| weight * u[i]).sum::<f64>()
            };
            to = std::array::from_fn(|i| from[i] + sum(&STIFF_STATE[stage], i));
            let slopes = self.slopes(start + STIFF_NODES[stage] * length, &to);
            let mut side: State = std::array::from_fn(|i| {
                slopes[i] + sum(&STIFF_SIDE[stage], i) / length + STIFF_PLACE[stage] * length * by_place[i]
            });
            factors.solve(&mut side);
            u[stage] = side;
        }
        to = std::array::from_fn(|i| to[i] + u[5][i]);
        let error = self.error(from, &to, |i| u[5][i]);
        let sum = |weights: &[f64; 5], i: usize| {
            weights.iter().zip(&u).map(|(weight, u)| weight * u[i]).sum::<f64>()
        };
        let dense = STIFF_DENSE.map(|weights| -> State { std::array::from_fn(|i| sum(&weights, i)) });
        let rise: State = std::array::from_fn(|i| to[i] - from[i]);
        let slopes = [
            std::array::from_fn(|i| rise[i] + dense[0][i]),
            std::array::from_fn(|i| rise[i] - dense[0][i] - dense[1][i]),
        ];
        let bend = [0.0; SIZE];
        Step { start, length, phase: self.phase, from: *from, to, error, order: 4.0, slopes, bend }
    }
}

impl Step {
    /// The length to try next, from the error of this one [√m].
    pub(super) fn next_length(&self) -> f64 {
        let factor = if self.error.is_finite() {
            0.9 * libm::pow(self.error.max(1e-10), -1.0 / self.order)
        } else {
            0.0
        };
        self.length * factor.clamp(0.2, 5.0)
    }

    pub(super) fn end(&self) -> f64 {
        self.start + self.length
    }

    /// The state at a place of the step.
    pub fn at(&self, s: f64) -> State {
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
