//! How fibres that fly side by side in the same air move, or come down, together.
//!
//! ```text
//! lanes of one replicate → pairs of it and each companion in the flight → correlation of their places, for each distance
//! ```

use super::{Declaration, Figure, Kind, Measure, Observation, Observer, RATIO, Value, fed, fixed};
use crate::case::Case;
use crate::fibre::Place;
use crate::flight::Flight;
use crate::statistics::Covariance;
use std::collections::VecDeque;

pub(super) const FED_CD: Declaration = Declaration {
    measures: &[
        Measure {
            name: "neighbours_cd_correlation_md",
            column: "neighbours_cd_correlation_md",
            ..IN_MD_OF_CD
        },
        Measure {
            name: "neighbours_cd_correlation_cd",
            column: "neighbours_cd_correlation_cd",
            ..IN_CD_OF_CD
        },
    ],
    applies: |case| fed(case) && !case.companions.cd.is_empty(),
    observer: |flight| Box::new(Companions::new(flight, in_cd)),
};

pub(super) const FED_MD: Declaration = Declaration {
    measures: &[
        Measure {
            name: "neighbours_md_correlation_md",
            column: "neighbours_md_correlation_md",
            figure: &IN_MD,
            ..IN_MD_OF_CD
        },
        Measure {
            name: "neighbours_md_correlation_cd",
            column: "neighbours_md_correlation_cd",
            figure: &IN_MD,
            ..IN_CD_OF_CD
        },
    ],
    applies: |case| fed(case) && !case.companions.md.is_empty(),
    observer: |flight| Box::new(Companions::new(flight, in_md)),
};

pub(super) const FIXED_CD: Declaration = Declaration {
    measures: &[
        Measure { name: "neighbours_cd_correlation_y", column: "neighbours_cd_correlation_y", ..IN_Y_OF_CD },
        Measure { name: "neighbours_cd_correlation_z", column: "neighbours_cd_correlation_z", ..IN_Z_OF_CD },
    ],
    applies: |case| fixed(case) && !case.companions.cd.is_empty(),
    observer: |flight| Box::new(Companions::new(flight, in_cd)),
};

pub(super) const FIXED_MD: Declaration = Declaration {
    measures: &[
        Measure {
            name: "neighbours_md_correlation_y",
            column: "neighbours_md_correlation_y",
            figure: &IN_MD,
            ..IN_Y_OF_CD
        },
        Measure {
            name: "neighbours_md_correlation_z",
            column: "neighbours_md_correlation_z",
            figure: &IN_MD,
            ..IN_Z_OF_CD
        },
    ],
    applies: |case| fixed(case) && !case.companions.md.is_empty(),
    observer: |flight| Box::new(Companions::new(flight, in_md)),
};

const IN_MD_OF_CD: Measure = Measure {
    label: "Correlation with neighbours, machine direction",
    meaning: "correlation of the places in machine direction at which a fibre and its neighbour come down, \
        at equal fed length",
    series: "machine direction",
    ..NEIGHBOURS
};

const IN_CD_OF_CD: Measure = Measure {
    label: "Correlation with neighbours, cross direction",
    meaning: "correlation of the places in cross direction at which a fibre and its neighbour come down, at \
        equal fed length",
    series: "cross direction",
    ..NEIGHBOURS
};

const IN_Y_OF_CD: Measure = Measure {
    label: "Correlation with neighbours in y",
    meaning: "correlation of y of the free ends of a fibre and its neighbour at equal times",
    series: "*y*",
    ..NEIGHBOURS
};

const IN_Z_OF_CD: Measure = Measure {
    label: "Correlation with neighbours in z",
    meaning: "correlation of z of the free ends of a fibre and its neighbour at equal times",
    series: "*z*",
    ..NEIGHBOURS
};

const NEIGHBOURS: Measure = Measure { unit: RATIO, kind: Kind::Neighbour, figure: &IN_CD, ..Measure::NUMBER };

const IN_CD: Figure = Figure {
    name: "neighbours_cd",
    title: "Correlation with neighbours in cross direction",
    words: "correlation with neighbours",
    logarithmic: false,
    from_zero: false,
    caption: "Correlation of a fibre with one that hangs beside it in the same air, at a distance in cross \
        direction: of the places where both come down at equal fed length, or of their free ends at equal \
        times.",
};

const IN_MD: Figure = Figure {
    name: "neighbours_md",
    title: "Correlation with neighbours in machine direction",
    caption: "The same at a distance in machine direction.",
    ..IN_CD
};

fn in_cd(case: &Case) -> Vec<(f64, Place)> {
    case.companions.cd.iter().map(|z| (*z, Place { y: 0.0, z: *z })).collect()
}

fn in_md(case: &Case) -> Vec<(f64, Place)> {
    case.companions.md.iter().map(|y| (*y, Place { y: *y, z: 0.0 })).collect()
}

/// Correlations of the fibres of a flight with their companions in it. The distances of companions in other
/// flights have NaN.
#[derive(Debug)]
struct Companions {
    /// The distances of each fibre's companions [m].
    distances: Vec<Vec<f64>>,
    pairs: Vec<Pair>,
    tracks: Vec<Track>,
}

/// A fibre and a companion.
#[derive(Debug)]
struct Pair {
    /// Their lanes.
    lanes: [usize; 2],
    /// The index of the distance.
    distance: usize,
    /// Places of either that the other one has not reached yet.
    waiting: [VecDeque<[f64; 2]>; 2],
    /// Of both directions.
    sums: [Covariance; 2],
}

/// What is compared of a fibre: the free end, or what it has laid.
#[derive(Debug)]
struct Track {
    fed: bool,
    /// Points that have been laid, and those of the spin-up.
    laid: u64,
    skip: u64,
    /// Distance that the belt moves while a spacing is fed [m].
    belt_per_point: f64,
}

impl Track {
    fn new(case: &Case) -> Self {
        let spacing = case.fibre.rest_length();
        let (skip, belt_per_point) = case.line.map_or((0, 0.0), |line| {
            let fed = line.feed_speed * case.run.spin_up();
            ((fed / spacing).round() as u64, line.belt_ratio() * spacing)
        });
        Self { fed: case.line.is_some(), laid: 0, skip, belt_per_point }
    }

    /// The next places after the spin-up [m]: y and z of the free end, or the deviations of laid points from
    /// the straight trace of a fibre that comes down at one place.
    fn next(&mut self, observation: &Observation<'_>, lane: usize) -> Vec<[f64; 2]> {
        if !self.fed {
            let end = observation.snapshot.position.last().filter(|_| observation.settled);
            return end.map(|end| [end.y.0[lane], end.z.0[lane]]).into_iter().collect();
        }
        let mut deviations = Vec::new();
        for point in &observation.laid[lane] {
            if self.laid >= self.skip {
                deviations.push([point.md + self.laid as f64 * self.belt_per_point, point.cd]);
            }
            self.laid += 1;
        }
        deviations
    }
}

impl Companions {
    /// * `companions` – distances and places of the companions that a case asks for
    fn new(flight: &Flight, companions: fn(&Case) -> Vec<(f64, Place)>) -> Self {
        let jobs: Vec<_> = (0..flight.fibres()).filter_map(|lane| flight.job(lane)).collect();
        let mut pairs = Vec::new();
        for (fibre, job) in jobs.iter().enumerate().filter(|(_, job)| job.place == Place::default()) {
            for (distance, (_, place)) in companions(job.case).into_iter().enumerate() {
                let found =
                    jobs.iter().position(|other| other.replicate == job.replicate && other.place == place);
                pairs.extend(found.map(|companion| Pair {
                    lanes: [fibre, companion],
                    distance,
                    waiting: [VecDeque::new(), VecDeque::new()],
                    sums: [Covariance::default(); 2],
                }));
            }
        }
        let distances = |case: &Case| companions(case).into_iter().map(|(distance, _)| distance).collect();
        Self {
            distances: jobs.iter().map(|job| distances(job.case)).collect(),
            tracks: jobs.iter().map(|job| Track::new(job.case)).collect(),
            pairs,
        }
    }
}

impl Pair {
    /// Takes the next places of both.
    fn add(&mut self, next: &[Vec<[f64; 2]>]) {
        for (waiting, lane) in self.waiting.iter_mut().zip(self.lanes) {
            waiting.extend(&next[lane]);
        }
        let [fibre, companion] = &mut self.waiting;
        let both = fibre.len().min(companion.len());
        for (a, b) in fibre.drain(..both).zip(companion.drain(..both)) {
            for (direction, sums) in self.sums.iter_mut().enumerate() {
                sums.add([a[direction], b[direction]]);
            }
        }
    }
}

impl Observer for Companions {
    fn see(&mut self, observation: &Observation<'_>) {
        let tracks = self.tracks.iter_mut().enumerate();
        let next: Vec<_> = tracks.map(|(lane, track)| track.next(observation, lane)).collect();
        self.pairs.iter_mut().for_each(|pair| pair.add(&next));
    }

    fn finish(&self, lane: usize, _: &Flight) -> Vec<Value> {
        let correlation = |distance: usize, direction: usize| {
            let pair = self.pairs.iter().find(|pair| pair.lanes[0] == lane && pair.distance == distance);
            pair.map_or(f64::NAN, |pair| pair.sums[direction].correlation())
        };
        let distances = &self.distances[lane];
        let curve = |direction| {
            let correlations = (0..distances.len()).map(|distance| correlation(distance, direction));
            Value::Curve(distances.clone(), correlations.collect())
        };
        vec![curve(0), curve(1)]
    }
}
