//! The laid fibre: how wide it lies, in which directions, and the surrogate that describes it.

use super::{Declaration, FibreMeasure, Observation, Observer, fed, number_of_each};
use spunlaid_fibre::{Case, Flight};
use spunlaid_ground::measure::figure;
use spunlaid_ground::{Figure, Group, MILLIMETRES, Measure, MeasureKind, RATIO, Unit, Value, WIDTH};
use spunlaid_web::surrogate::identify;
use spunlaid_web::{LaidCurve, Trace, TraceSettings};

/// The laid fibre.
pub const LAYDOWN: Group = Group { name: "laydown", title: "laid fibre" };
/// The stochastic model of the laid fibre.
pub const SURROGATE: Group = Group { name: "laydown.surrogate", title: "surrogate of the laid fibre" };

const METRES: Unit = Unit { shown: "m", per_si: 1.0 };

pub(super) const DECLARATION: Declaration = Declaration {
    measures: &[
        SPREAD
            .observed("sigma_md", "sigma_md_m", "Standard deviation in machine direction")
            .meaning(
                "standard deviation in machine direction of the laid fibre about the straight trace of a fibre that \
                 always lands at one position",
            )
            .series("machine direction"),
        SPREAD
            .observed("sigma_cd", "sigma_cd_m", "Standard deviation in cross direction")
            .meaning("the same in cross direction")
            .series("cross direction"),
        HALF_LENGTH
            .observed(
                "half_correlation_length_md",
                "half_correlation_length_md_m",
                "Half correlation length in machine direction",
            )
            .meaning(
                "length of fibre over which the autocorrelation of its position in machine direction \
                 falls to one half",
            )
            .series("machine direction"),
        HALF_LENGTH
            .observed(
                "half_correlation_length_cd",
                "half_correlation_length_cd_m",
                "Half correlation length in cross direction",
            )
            .meaning("the same in cross direction")
            .series("cross direction"),
        RATIO_OF
            .observed(
                "belt_speed_ratio",
                "belt_speed_ratio",
                "Belt speed found from the laid fibre, over the true one",
            )
            .meaning(
                "belt speed from the laid fibre (mean of −d md/ds, times the feed speed) over that of the case: one \
                 within its error",
            )
            .figure(&figure("belt_speed_ratio", "Ratio of belt speeds", "ratio of belt speeds")),
        RATIO_OF
            .observed("orientation_md", "orientation_md", "Orientation in machine direction")
            .main()
            .meaning(
                "mean cos² of the angle between chords of 10 mm of fibre and the machine direction: \
                 0.5 without orientation",
            )
            .figure(&figure("orientation", "Mean cos² to the machine direction", "orientation")),
        RATIO_OF
            .observed("chord_over_arc", "chord_over_arc", "Chord over arc at 10 mm")
            .meaning(
                "mean length on the belt of 10 mm of fibre over 10 mm: the texture. It is smaller with a finer \
                 mesh, and not defined for elements longer than 10 mm",
            )
            .figure(&figure("chord_over_arc", "Chord over arc at 10 mm", "chord over arc")),
        RATIO_OF
            .observed("laid_length", "laid_length_m", "Length laid")
            .meaning(
                "length of fibre laid after the spin-up, in whole elements",
            )
            .unit(METRES)
            .figure(&figure("laid_length", "Length laid", "length laid")),
        RATIO_OF
            .observed("nodes_in_air", "nodes_in_air", "Nodes in the air")
            .meaning("mean number of nodes between the inlet and the newest touch-down")
            .figure(&figure("nodes_in_air", "Nodes in the air", "nodes in the air")),
        SURROGATE_SPREAD
            .observed("sigma_1", "sigma_1_m", "σ₁ of the surrogate")
            .meaning("standard deviation in machine direction")
            .series("*σ*_{1}"),
        SURROGATE_SPREAD
            .observed("sigma_2", "sigma_2_m", "σ₂ of the surrogate")
            .meaning("standard deviation in cross direction")
            .series("*σ*_{2}"),
        Measure {
            name: "noise",
            is_main: true,
            column: "noise_per_sqrt_m",
            label: "Noise A of the surrogate",
            meaning: "strength of the noise in the direction, from the autocorrelation over lags from 0.5 \
                 to 12 standard deviations; not defined where the laid fibre is not a random curve",
            unit: Unit { shown: "m^-0.5", per_si: 1.0 },
            group: SURROGATE,
            figure: &figure("noise", "Noise A of the surrogate", "noise of the surrogate"),
            ..Measure::NUMBER
        },
        CORRELATION
            .observed("correlation_md", "correlation_md", "Autocorrelation in machine direction")
            .series("machine direction"),
        CORRELATION
            .observed("correlation_cd", "correlation_cd", "Autocorrelation in cross direction")
            .series("cross direction"),
        CORRELATION
            .observed(
                "surrogate_correlation_md",
                "surrogate_correlation_md",
                "Autocorrelation of the surrogate in machine direction",
            )
            .series("surrogate, machine direction"),
        CORRELATION
            .observed(
                "surrogate_correlation_cd",
                "surrogate_correlation_cd",
                "Autocorrelation of the surrogate in cross direction",
            )
            .series("surrogate, cross direction"),
        Measure {
            name: "direction",
            column: "direction",
            label: "Directions of the laid fibre",
            meaning: "fraction of the chords of 10 mm in each class of 10 degrees, times the number of \
                 classes: one without orientation",
            kind: MeasureKind::Direction,
            group: LAYDOWN,
            figure: &Figure {
                caption: "Directions of chords of 10 mm on the belt, in the sense of feed. 0° is the direction in \
                    which the belt runs; the laid fibre grows in the opposite direction.",
                ..figure("directions", "Fraction of chords, times the number of classes", "directions")
            },
            ..Measure::NUMBER
        },
    ],
    applies: fed,
    observer: |flight| Box::new(LaidFibres::new(flight)),
};

const SPREAD: FibreMeasure = Measure {
    is_main: true,
    unit: MILLIMETRES,
    group: LAYDOWN,
    figure: &figure("spread", "Standard deviation of the laid fibre", "standard deviation"),
    ..Measure::NUMBER
};

const SURROGATE_SPREAD: FibreMeasure = Measure {
    is_main: false,
    group: SURROGATE,
    figure: &figure(
        "surrogate_spread",
        "Standard deviation of the surrogate",
        "standard deviation of the surrogate",
    ),
    ..SPREAD
};

const HALF_LENGTH: FibreMeasure = Measure {
    is_main: true,
    unit: MILLIMETRES,
    group: LAYDOWN,
    figure: &figure("half_correlation_length", "Half correlation length", "half correlation length"),
    ..Measure::NUMBER
};

const RATIO_OF: FibreMeasure = Measure { unit: RATIO, group: LAYDOWN, ..Measure::NUMBER };

const CORRELATION: FibreMeasure = Measure {
    meaning: "autocorrelation of the position about the straight trace, over the length of fibre between two points",
    kind: MeasureKind::Lag,
    group: LAYDOWN,
    figure: &Figure {
        from_zero: false,
        caption: "Autocorrelation of the laid fibre’s position about its straight trace, and that of the \
            surrogate fitted to it.",
        ..figure("correlation", "Autocorrelation of the position", "autocorrelation")
    },
    ..Measure::NUMBER
};

/// The laid curves of up to eight fibres.
#[derive(Debug)]
struct LaidFibres {
    traces: Vec<Trace>,
    belt_ratio: [f64; WIDTH],
    /// Recorded instants after the spin-up, and the sums of the nodes in the air.
    count: f64,
    in_air: [f64; WIDTH],
}

impl LaidFibres {
    fn new(flight: &Flight) -> Self {
        let traces = (0..WIDTH).filter_map(|lane| flight.case(lane)).map(trace).collect();
        Self { traces, belt_ratio: number_of_each(flight, belt_ratio), count: 0.0, in_air: [0.0; WIDTH] }
    }
}

/// Speed of the belt over that of the feed.
fn belt_ratio(case: &Case) -> f64 {
    case.line.map_or(0.0, |line| line.belt_ratio())
}

/// The laid curve of a fibre, before anything is laid.
fn trace(case: &Case) -> Trace {
    let spacing = case.fibre.rest_length();
    let (reach, fed) =
        case.line.map_or((0.0, 0.0), |line| (line.distance, line.feed_speed * case.run.spin_up()));
    let skip = (fed / spacing).round() as u64;
    Trace::new(TraceSettings { spacing, belt_ratio: belt_ratio(case), skip, reach })
}

impl Observer for LaidFibres {
    fn see(&mut self, observation: &Observation<'_>) {
        for (trace, laid) in self.traces.iter_mut().zip(observation.laid) {
            laid.iter().for_each(|point| trace.add(point.md, point.cd));
        }
        if observation.settled {
            self.count += 1.0;
            for (sum, nodes) in self.in_air.iter_mut().zip(observation.snapshot.in_air) {
                *sum += nodes as f64;
            }
        }
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let laid = self.traces[lane].finish();
        let sigmas = [laid.sigma_md, laid.sigma_cd];
        let found = identify(sigmas, laid.lag_step, [&laid.correlation_md, &laid.correlation_cd]);
        let surrogate =
            found.and_then(|found| found.surrogate.autocorrelation(laid.lag_step, laid.correlation_md.len()));
        let noise = found.map_or(f64::NAN, |found| found.surrogate.noise);
        // What cannot be said is left out of the mean over the replicates.
        let unknown = || vec![f64::NAN; laid.correlation_md.len()];
        let [md, cd] = surrogate.unwrap_or_else(|| [unknown(), unknown()]);
        let over_lag = |values: Vec<f64>| {
            let lags = (0..values.len()).map(|i| i as f64 * laid.lag_step).collect();
            Value::Curve(lags, values)
        };
        let numbers = [
            laid.sigma_md,
            laid.sigma_cd,
            laid.half_correlation_length_md,
            laid.half_correlation_length_cd,
            laid.slope / self.belt_ratio[lane],
            laid.orientation_md,
            laid.chord_over_arc,
            laid.length,
            self.in_air[lane] / self.count,
            laid.sigma_md,
            laid.sigma_cd,
            noise,
        ];
        let curves = [laid.correlation_md.clone(), laid.correlation_cd.clone(), md, cd].map(over_lag);
        let finite = |value: f64| Value::Number(if value.is_finite() { value } else { f64::NAN });
        numbers.into_iter().map(finite).chain(curves).chain([directions(&laid)]).collect()
    }
}

/// Share of the chords in each class of direction, times the number of classes, over the angle [degrees].
fn directions(laid: &LaidCurve) -> Value {
    let all: u64 = laid.directions.iter().sum();
    let classes = LaidCurve::DIRECTIONS as f64;
    let angles = (0..LaidCurve::DIRECTIONS).map(|i| (i as f64 + 0.5) * 360.0 / classes).collect();
    let share = |&count: &u64| count as f64 / all as f64 * classes;
    Value::Curve(angles, laid.directions.iter().map(share).collect())
}
