//! The samples of one generation, in the order of their labels.

use super::Plan;
use super::lattice::{BRICK, NEEDED, Part, READ, REPEATED, row_size};
use super::synthesis::{Synthesis, WindowPair};
use super::transform::{ABREAST, Numbers};
use super::windows::{BLOCKS, FieldWindows, Rest};
use crate::motion::StreamKey;
use half::f16;
use std::ops::Range;
use std::sync::Arc;

/// Some successive samples of a generation. It begins with the last [`REPEATED`] samples of the block before it.
#[derive(Debug)]
pub(super) struct Block {
    /// Number of the first sample; sample `m` has the label `m` spacings.
    pub(super) first: i64,
    samples: usize,
    /// Numbers of a sample in a brick.
    row: usize,
    /// For each y: `[brick][sample][z][component]`. Half precision adds 0.0002 of the rms of noise.
    lines: Vec<Box<[f16]>>,
}

/// The samples around a place along one line of points.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a> {
    numbers: &'a [f16],
    /// From one sample to the next.
    row: usize,
}

impl<'a> Rows<'a> {
    /// Where there are no samples.
    pub(super) const NONE: Self = Self { numbers: &[], row: 0 };

    /// Twelve numbers of a sample, and those that happen to follow: `[z][component]`.
    ///
    /// * `sample` – of four
    #[inline(always)]
    pub(super) fn row(self, sample: usize) -> &'a [f16; READ] {
        self.numbers.get(sample * self.row..).and_then(<[_]>::first_chunk).unwrap_or(&[f16::ZERO; READ])
    }
}

impl Block {
    /// What lies around a place on a line.
    ///
    /// * `sample` – number of the first of four samples
    /// * `line` – number along y, in the part that is made
    /// * `point` – number along z of the first of four points, likewise
    #[inline(always)]
    pub(super) fn rows(&self, sample: i64, line: usize, point: usize) -> Rows<'_> {
        let before = point / BRICK * self.samples + (sample - self.first) as usize;
        let start = before * self.row + 3 * (point % BRICK);
        let line = self.lines.get(line).map_or(&[][..], |line| line);
        Rows { numbers: line.get(start..).unwrap_or_default(), row: self.row }
    }
}

/// A generation as far as it has been made.
#[derive(Clone, Debug)]
pub(super) struct Tape {
    /// The points across that are made.
    pub(super) part: Part,
    /// With the number after the last sample of each.
    blocks: Vec<(i64, Arc<Block>)>,
    /// The pair of windows that comes next; none before the first.
    next: Option<i64>,
    /// What the last pair of windows leaves to the next, for each y.
    rest: Arc<Vec<Rest>>,
}

/// The most memory of a tape with windows of so many samples [bytes].
///
/// * `looked_at` – samples that are looked at in a block of time
pub(super) fn memory([lines, points]: [usize; 2], period: usize, looked_at: f64) -> f64 {
    let windows = FieldWindows::new(period);
    let block = windows.block(0).len() as f64;
    // A pair of windows is made when less than what is looked at is left of the one before: that and the rest
    // of its block.
    let left = looked_at + 2.0 * NEEDED as f64 + block;
    let repeated = ((1.0 + left / block).ceil() + BLOCKS as f64) * REPEATED as f64;
    let samples = windows.total() as f64 + left + repeated;
    let sample = lines * points.div_ceil(BRICK) * row_size(points) * size_of::<f16>();
    samples * sample as f64 + memory_of_rest([lines, points], period)
}

/// What more a tape takes while a thread joins a pair of windows to it, line by line [bytes].
pub(super) fn memory_while_joining(points: [usize; 2], period: usize) -> f64 {
    let windows = FieldWindows::new(period);
    let joined = (REPEATED + windows.total() + windows.fade) * size_of::<[[f16; ABREAST]; 3]>();
    memory_of_rest(points, period) + (joined + 4 * period * size_of::<Numbers>()) as f64
}

/// Memory of what a pair of windows leaves to the next, in half precision [bytes].
fn memory_of_rest([lines, points]: [usize; 2], period: usize) -> f64 {
    let sample = lines * points.div_ceil(ABREAST) * size_of::<[[f16; ABREAST]; 3]>();
    ((FieldWindows::new(period).fade + REPEATED) * sample) as f64
}

impl Tape {
    /// Nothing is made of a part yet.
    pub(super) fn unmade(part: Part) -> Self {
        Self { part, blocks: Vec::new(), next: None, rest: Arc::default() }
    }

    /// Makes the samples of a range, and forgets those before it.
    pub(super) fn extend(
        &mut self,
        plan: &Plan,
        synthesis: &Synthesis,
        key: StreamKey,
        generation: usize,
        samples: Range<i64>,
        threads: usize,
    ) {
        let windows = FieldWindows::new(plan.generations[generation].samples);
        self.blocks.retain(|(end, _)| *end > samples.start);
        let first = windows.first_pair(samples.start - REPEATED as i64);
        let goes_on = match self.blocks.first() {
            Some((_, block)) => block.first <= samples.start,
            None => self.next.is_some_and(|next| next > first),
        };
        if !goes_on {
            *self = Self { next: Some(first), ..Self::unmade(self.part) };
        }
        let mut pair = self.next.unwrap_or(first);
        while pair * (windows.total() as i64) < samples.end {
            let rest = std::mem::take(&mut self.rest);
            let nothing = Rest::default();
            let of_pair = WindowPair { generation, number: pair, part: &self.part };
            let made = synthesis.lines(plan, key, &of_pair, threads, |y, line| {
                windows.join(synthesis.isa, line, rest.get(y).unwrap_or(&nothing))
            });
            let (mut blocks, mut left) = (Vec::new(), Vec::new());
            for (lines, rest) in made {
                blocks.push(lines);
                left.push(rest);
            }
            let start = pair * windows.total() as i64;
            for number in 0..BLOCKS {
                let [first, end] = {
                    let within = windows.block(number);
                    [within.start, within.end].map(|sample| start + sample as i64)
                };
                let lines = blocks.iter_mut().map(|lines| std::mem::take(&mut lines[number])).collect();
                if end > samples.start {
                    let samples = (end - first) as usize + REPEATED;
                    let row = row_size(self.part.counts()[1]);
                    let block = Block { first: first - REPEATED as i64, samples, row, lines };
                    self.blocks.push((end, Arc::new(block)));
                }
            }
            self.rest = Arc::new(left);
            pair += 1;
            self.next = Some(pair);
        }
    }

    /// The block in which all samples around a place lie.
    ///
    /// * `first` – the first of them
    #[inline(always)]
    pub(super) fn around(&self, first: i64) -> Option<&Block> {
        let last = first + NEEDED as i64 - 1;
        self.blocks.iter().find(|(end, _)| last < *end).map(|(_, block)| &**block)
    }
}
