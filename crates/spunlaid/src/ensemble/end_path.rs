//! Where the free end of a fibre was, with a memory that does not grow.

use crate::observe::Sample;
use crate::statistics::EvenSample;
use crate::vec3::Vec3;
use std::collections::VecDeque;

/// Time [s] and place of the free end [m].
pub type EndPoint = (f64, Vec3<f64>);

/// The free end at all of the last recorded instants, and at evenly spaced ones of the whole flight.
#[derive(Clone, Debug, Default)]
pub struct EndPath {
    last: VecDeque<EndPoint>,
    whole: EvenSample<EndPoint>,
}

impl EndPath {
    /// Number of the last instants that are all kept.
    pub const LAST: usize = 20_000;

    /// Takes the next recorded instant.
    pub fn push(&mut self, sample: &Sample) {
        let point = (sample.time, sample.end);
        if self.last.len() == Self::LAST {
            self.last.pop_front();
        }
        self.last.push_back(point);
        self.whole.push(point);
    }

    /// All of the last recorded instants, [`EndPath::LAST`] at most.
    pub fn last(&self) -> impl Iterator<Item = &EndPoint> {
        self.last.iter()
    }

    /// The free end from a time [s] on: every recorded instant, or evenly spaced ones where not all are kept.
    pub fn since(&self, time: f64) -> impl Iterator<Item = &EndPoint> {
        let first = |points: Option<&EndPoint>| points.map_or(f64::INFINITY, |point| point.0);
        let all = first(self.last.front()) <= time.max(first(self.whole.values().first()));
        let (last, whole) = (all.then_some(&self.last), (!all).then_some(self.whole.values()));
        let points = last.into_iter().flatten().chain(whole.into_iter().flatten());
        points.filter(move |point| point.0 >= time)
    }
}

impl<'a> FromIterator<&'a Sample> for EndPath {
    fn from_iter<I: IntoIterator<Item = &'a Sample>>(samples: I) -> Self {
        let mut path = Self::default();
        samples.into_iter().for_each(|sample| path.push(sample));
        path
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_is_whole_as_long_as_it_can_be() {
        let sample = |i: usize| Sample { time: i as f64, ..Sample::default() };
        let path = |count: usize| (0..count).map(sample).collect::<Vec<_>>().iter().collect::<EndPath>();
        let times = |path: &EndPath, from: f64| path.since(from).map(|point| point.0).collect::<Vec<_>>();
        let all = |from: usize, to: usize, every: usize| {
            (from..to).step_by(every).map(|i| i as f64).collect::<Vec<f64>>()
        };
        let short = path(EndPath::LAST);
        assert_eq!(times(&short, 0.0), all(0, EndPath::LAST, 1));
        assert_eq!(times(&short, 7.5), all(8, EndPath::LAST, 1));
        let long = path(50_000);
        assert_eq!(times(&long, 0.0), all(0, 50_000, 4));
        assert_eq!(times(&long, 29_999.0), all(30_000, 50_000, 4));
        assert_eq!(times(&long, 30_000.0), all(30_000, 50_000, 1));
        assert!(times(&path(0), 0.0).is_empty());
    }
}
