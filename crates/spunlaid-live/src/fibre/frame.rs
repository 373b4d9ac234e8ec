//! The moving picture: one frame holds what a page needs to draw an instant, and no more.
//!
//! A frame is binary, little-endian; lengths are in millimetres and single precision.
//!
//! ```text
//!  0  u32     generation: counts the changes of the case
//!  4  u8      bits: 1 the time stands, 2 it cannot keep the pace, 4 the fibres are fed
//!  5  u8      number of fibres
//!  6  u16     samples
//!  8  f64     time [s]
//! 16  f32     time of the fibres over time of the clock, within the last second
//! 20  u16     laid points
//! 22  u16     nodes of each fibre, eight times
//! 38  u16     zero
//! 40  u32     number of the first sample, counted from the start of the program
//! 44  u32     number of the first laid point, likewise
//! 48  f32     x, y, z of each node, fibre after fibre
//!     f32     of each sample: its time before that of the frame [s]; x, y and z of the free end of the first fibre
//!     f32     of each laid point of the first fibre: y and z where it is now, the belt having moved
//! ```
//!
//! Samples and laid points are those that the page has not had yet.

use crate::board::Picture;
use spunlaid::fibre::{LaidPoint, Snapshot};
use spunlaid::ground::WIDTH;
use std::collections::VecDeque;

/// Most samples that a page can lag behind.
const SAMPLES: usize = 1024;
/// Most laid points that a page can lag behind.
const POINTS: usize = 4096;
/// Most nodes of the first fibre, and of each of the others.
const NODES: [usize; 2] = [512, 96];

/// The last entries of a list that only grows.
#[derive(Clone, Debug)]
struct Tail<T> {
    last: VecDeque<T>,
    /// Number of entries so far.
    count: u32,
    most: usize,
}

impl<T: Copy> Tail<T> {
    fn new(most: usize) -> Self {
        Self { last: VecDeque::with_capacity(most), count: 0, most }
    }

    fn push(&mut self, entry: T) {
        if self.last.len() == self.most {
            self.last.pop_front();
        }
        self.last.push_back(entry);
        self.count = self.count.wrapping_add(1);
    }

    /// The entries from a number on, and the number of the first of them. Entries that are there no more are left out.
    fn since(&self, number: u32) -> (u32, impl Iterator<Item = T>) {
        let missing = (self.count.wrapping_sub(number) as usize).min(self.last.len());
        (self.count.wrapping_sub(missing as u32), self.last.iter().skip(self.last.len() - missing).copied())
    }
}

/// What has happened lately: motion of the first fibre's free end, points that it laid.
#[derive(Clone, Debug)]
pub(super) struct RecentMotion {
    /// Time [s]; x, y and z [m].
    samples: Tail<[f64; 4]>,
    /// md and cd [m].
    laid: Tail<[f64; 2]>,
}

impl RecentMotion {
    pub(super) fn new() -> Self {
        Self { samples: Tail::new(SAMPLES), laid: Tail::new(POINTS) }
    }

    /// Adds a recorded instant.
    ///
    /// * `time` – on the clock of the pages [s]
    pub(super) fn add(&mut self, time: f64, snapshot: &Snapshot, laid: &[LaidPoint]) {
        if let Some(end) = snapshot.position.get(snapshot.nodes[0] - 1) {
            self.samples.push([time, end.x.0[0], end.y.0[0], end.z.0[0]]);
        }
        laid.iter().for_each(|point| self.laid.push([point.md, point.cd]));
    }

    /// Forgets what lies on the belt.
    pub(super) fn clear_belt(&mut self) {
        self.laid.last.clear();
    }
}

/// How far a page is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct PageProgress {
    samples: u32,
    laid: u32,
}

/// An instant.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    pub(super) generation: u32,
    pub(super) stands: bool,
    pub(super) behind: bool,
    pub(super) fed: bool,
    /// On the clock of the pages [s].
    pub(super) time: f64,
    /// Time of the fibres over time of the clock.
    pub(super) speed: f64,
    /// Speed of the belt times the time of the flight [m].
    pub(super) belt_run: f64,
    nodes: [u16; WIDTH],
    positions: Vec<f32>,
    recent_motion: RecentMotion,
}

impl Frame {
    /// A frame that shows these shapes; its other fields are to be set.
    pub(super) fn new(snapshot: &Snapshot, recent_motion: &RecentMotion) -> Self {
        let mut nodes = [0; WIDTH];
        let mut positions = Vec::new();
        for (lane, count) in nodes.iter_mut().enumerate() {
            let all = snapshot.nodes[lane].min(snapshot.position.len());
            let chosen = thinned(all, NODES[usize::from(lane > 0)]);
            *count = chosen.len() as u16;
            for node in chosen {
                let at = snapshot.position[node].lane(lane);
                positions.extend([at.x, at.y, at.z].map(|x| (x * 1e3) as f32));
            }
        }
        Self {
            generation: 0,
            stands: false,
            behind: false,
            fed: false,
            time: snapshot.time,
            speed: 0.0,
            belt_run: 0.0,
            nodes,
            positions,
            recent_motion: recent_motion.clone(),
        }
    }

    /// The bytes for a page that has had so much.
    fn bytes(&self, had: &mut PageProgress) -> Vec<u8> {
        let (first_sample, samples) = self.recent_motion.samples.since(had.samples);
        let (first_point, points) = self.recent_motion.laid.since(had.laid);
        let samples: Vec<[f64; 4]> = samples.collect();
        let points: Vec<[f64; 2]> = points.collect();
        *had =
            PageProgress { samples: self.recent_motion.samples.count, laid: self.recent_motion.laid.count };

        let bits = u8::from(self.stands) | u8::from(self.behind) << 1 | u8::from(self.fed) << 2;
        let mut bytes =
            Vec::with_capacity(48 + 4 * self.positions.len() + 16 * samples.len() + 8 * points.len());
        bytes.extend(self.generation.to_le_bytes());
        bytes.extend([bits, WIDTH as u8]);
        bytes.extend((samples.len() as u16).to_le_bytes());
        bytes.extend(self.time.to_le_bytes());
        bytes.extend((self.speed as f32).to_le_bytes());
        bytes.extend((points.len() as u16).to_le_bytes());
        self.nodes.iter().for_each(|count| bytes.extend(count.to_le_bytes()));
        bytes.extend([0; 2]);
        bytes.extend(first_sample.to_le_bytes());
        bytes.extend(first_point.to_le_bytes());
        let mut put = |x: f32| bytes.extend(x.to_le_bytes());
        self.positions.iter().copied().for_each(&mut put);
        for [time, x, y, z] in samples {
            [self.time - time, 1e3 * x, 1e3 * y, 1e3 * z].into_iter().for_each(|x| put(x as f32));
        }
        for [md, cd] in points {
            [1e3 * (md + self.belt_run), 1e3 * cd].into_iter().for_each(|x| put(x as f32));
        }
        bytes
    }
}

impl Picture for Frame {
    type Had = PageProgress;

    fn messages(&self, had: &mut PageProgress) -> Vec<Vec<u8>> {
        vec![self.bytes(had)]
    }
}

/// Indices of at most so many of the nodes, evenly spread, the first and the last among them.
fn thinned(nodes: usize, most: usize) -> Vec<usize> {
    if nodes <= most {
        return (0..nodes).collect();
    }
    (0..most).map(|i| i * (nodes - 1) / (most - 1)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::fibres::Fibres;
    use super::*;
    use spunlaid::input::{read_case, starter_case};

    fn number(bytes: &[u8], at: usize) -> f32 {
        f32::from_le_bytes(bytes[at..at + 4].try_into().unwrap())
    }

    fn u16_at(bytes: &[u8], at: usize) -> usize {
        usize::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]))
    }

    #[test]
    fn a_frame_is_laid_out_as_described_and_gives_each_page_what_is_new() {
        let set = [("fibre.element_length", "50 mm"), ("run.scheme", "leapfrog"), ("run.time_step", "1 µs")];
        let set = set.map(|(key, value)| (key.to_owned(), value.to_owned()));
        let (case, _) = read_case((starter_case(), "a.toml"), &set).unwrap();
        let mut fibres = Fibres::new(case).unwrap();
        let mut recent_motion = RecentMotion::new();
        let see = |fibres: &mut Fibres, recent_motion: &mut RecentMotion, steps| {
            fibres.fly(steps, |i| recent_motion.add(i.snapshot.time, i.snapshot, &i.laid[0])).unwrap();
        };
        see(&mut fibres, &mut recent_motion, 4001);
        let mut frame = Frame::new(fibres.snapshot(), &recent_motion);
        (frame.generation, frame.behind, frame.speed) = (7, true, 0.5);
        let (mut had, mut other) = (PageProgress::default(), PageProgress::default());
        let bytes = frame.bytes(&mut had);
        assert_eq!(bytes[..6], [7, 0, 0, 0, 2, 8]);
        let (samples, nodes) = (u16_at(&bytes, 6), u16_at(&bytes, 22));
        assert_eq!((samples, nodes, number(&bytes, 16)), (5, 21, 0.5));
        assert_eq!(bytes.len(), 48 + 12 * 8 * nodes + 16 * samples);
        assert_eq!(f64::from_le_bytes(bytes[8..16].try_into().unwrap()), fibres.snapshot().time);
        // The last node of the third fibre.
        let third = fibres.snapshot().position[20].lane(2);
        let at = 48 + 12 * (3 * nodes - 1);
        for (i, x) in [third.x, third.y, third.z].into_iter().enumerate() {
            assert_eq!(number(&bytes, at + 4 * i), (1e3 * x) as f32);
        }
        // The fourth sample is of 3 ms.
        let at = 48 + 12 * 8 * nodes + 16 * 3;
        assert!((number(&bytes, at) - (fibres.snapshot().time - 3e-3) as f32).abs() < 1e-7);

        see(&mut fibres, &mut recent_motion, 2000);
        let frame = Frame::new(fibres.snapshot(), &recent_motion);
        assert_eq!(u16_at(&frame.bytes(&mut had), 6), 2);
        assert_eq!(u16_at(&frame.bytes(&mut had), 6), 0);
        assert_eq!(u16_at(&frame.bytes(&mut other), 6), 7);
    }

    #[test]
    fn a_page_that_lags_far_behind_gets_the_last_entries() {
        let mut tail = Tail::new(4);
        (0..10).for_each(|i| tail.push(i));
        let entries_since = |since| {
            let (first, entries) = tail.since(since);
            (first, entries.collect::<Vec<i32>>())
        };
        assert_eq!(entries_since(0), (6, vec![6, 7, 8, 9]));
        assert_eq!(entries_since(8), (8, vec![8, 9]));
        assert_eq!(entries_since(10), (10, vec![]));
    }

    #[test]
    fn many_nodes_are_thinned_with_both_ends() {
        assert_eq!(thinned(3, 5), [0, 1, 2]);
        let indices = thinned(1000, 96);
        assert_eq!((indices.len(), indices[0], indices[95]), (96, 0, 999));
        assert!(indices.is_sorted_by(|a, b| a < b));
    }
}
