//! The samples of one generation, in the order of their labels.

use super::Plan;
use super::lattice::Lattice;
use super::synthesis::{Line, Synthesis};
use crate::air::StreamKey;
use half::f16;
use half::slice::HalfFloatSliceExt;
use std::f64::consts::FRAC_PI_2;
use std::ops::Range;
use std::sync::Arc;

/// Samples before a place that its interpolation needs, and all that it needs.
pub(super) const BEFORE: i64 = 1;
pub(super) const NEEDED: usize = 4;
/// Samples, or points, that a piece repeats of the one beside it, so that those around a place lie side by side.
const REPEATED: usize = NEEDED - 1;
/// Points along z in a brick. In a row of all points the samples around a place would lie far apart in memory.
const BRICK: usize = 32;
/// Numbers of a sample in a brick, with the points that it repeats of the next one.
const ROW: usize = 3 * (BRICK + REPEATED);
/// Numbers that are read for a sample: four points of three components, and what follows them.
pub(super) const READ: usize = 16;
/// Numbers from the first to the last one that are read around a place.
const AROUND: usize = (NEEDED - 1) * ROW + READ;
/// Blocks in a pair of windows.
const BLOCKS: usize = 6;

/// Some successive samples of a generation. It begins with the last [`REPEATED`] samples of the block before it.
#[derive(Debug)]
pub(super) struct Block {
    /// Number of the first sample; sample `m` has the label `m` spacings.
    pub(super) first: i64,
    samples: usize,
    /// For each y: `[brick][sample][z][component]`. Half precision adds 0.0002 of the rms of noise.
    lines: Vec<Box<[f16]>>,
}

/// The samples around a place along one line of points.
#[derive(Clone, Copy)]
pub(super) struct Rows<'a>(&'a [f16; AROUND]);

impl<'a> Rows<'a> {
    /// Where there are no samples.
    pub(super) const NONE: Self = Self(&[f16::ZERO; AROUND]);

    /// Twelve numbers of a sample, and those that happen to follow: `[z][component]`.
    ///
    /// * `sample` – of four
    #[inline(always)]
    pub(super) fn row(self, sample: usize) -> &'a [f16; READ] {
        self.0[sample * ROW..].first_chunk().unwrap_or(&[f16::ZERO; READ])
    }
}

impl Block {
    /// What lies around a place on a line.
    ///
    /// * `sample` – number of the first of four samples
    /// * `line` – number along y
    /// * `point` – number along z of the first of four points
    #[inline(always)]
    pub(super) fn rows(&self, sample: i64, line: usize, point: usize) -> Rows<'_> {
        let row = point / BRICK * self.samples + (sample - self.first) as usize;
        let start = row * ROW + 3 * (point % BRICK);
        let line = self.lines.get(line).map_or(&[][..], |line| line);
        line.get(start..).and_then(|line| line.first_chunk()).map_or(Rows::NONE, Rows)
    }
}

/// Numbers rounded to half precision.
fn halves(numbers: &[f32]) -> Vec<f16> {
    let mut halves = vec![f16::ZERO; numbers.len()];
    halves.convert_from_f32_slice(numbers);
    halves
}

/// A line of a block, made of samples `[sample][z][component]`.
fn bricks(samples: &[f32], points: usize) -> Box<[f16]> {
    let count = samples.len() / (3 * points);
    let bricks = points.div_ceil(BRICK);
    // What follows the last point is read, but does not count.
    let mut line = vec![f16::ZERO; bricks * count * ROW + READ - 3 * NEEDED];
    let mut row = [0.0; ROW];
    for (number, into) in line.chunks_exact_mut(ROW).enumerate() {
        let (brick, sample) = (number / count, number % count);
        let from = &samples[3 * points * sample..][..3 * points];
        let first = 3 * BRICK * brick;
        let here = ROW.min(from.len() - first);
        row[..here].copy_from_slice(&from[first..][..here]);
        for (i, number) in row[here..].iter_mut().enumerate() {
            *number = from[i % from.len()];
        }
        into.convert_from_f32_slice(&row);
    }
    line.into_boxed_slice()
}

/// A generation as far as it has been made.
#[derive(Clone, Debug, Default)]
pub(super) struct Tape {
    /// With the number after the last sample of each.
    blocks: Vec<(i64, Arc<Block>)>,
    /// The pair of windows that comes next; none before the first.
    next: Option<i64>,
    /// What the last window adds to the samples after the blocks, and the last samples of the blocks: for each y
    /// `[sample][z][component]`.
    rest: Arc<Vec<Rest>>,
}

/// What a pair of windows leaves to the next, along one line.
#[derive(Clone, Debug, Default)]
struct Rest {
    fading: Vec<f16>,
    last: Vec<f16>,
}

/// How windows follow each other, in samples.
#[derive(Clone, Copy)]
struct Windows {
    /// Time in which a window repeats.
    period: usize,
    /// Time in which one fades out and the next one in.
    fade: usize,
    /// From the start of one to that of the next.
    hop: usize,
}

impl Windows {
    fn new(period: usize) -> Self {
        Self { period, fade: period / 4, hop: period - period / 4 }
    }

    /// The pair of windows that has to be made first for a sample to be complete.
    fn first_pair(self, sample: i64) -> i64 {
        (sample - self.fade as i64).div_euclid(2 * self.hop as i64)
    }

    /// Factors of the window that fades out and of the one that fades in, at a sample of the fade.
    fn factors(self, sample: usize) -> [f32; 2] {
        let angle = FRAC_PI_2 * (sample as f64 + 0.5) / self.fade as f64;
        [libm::cos(angle) as f32, libm::sin(angle) as f32]
    }
}

/// The most memory of a tape with windows of so many samples [bytes].
///
/// * `looked_at` – samples that are looked at in a block of time
pub(super) fn memory(lattice: &Lattice, period: usize, looked_at: f64) -> f64 {
    let windows = Windows::new(period);
    let block = (2 * windows.hop).div_ceil(BLOCKS) as f64;
    // A pair of windows is made when less than what is looked at is left of the one before: that and the rest of its block.
    let left = looked_at + 2.0 * NEEDED as f64 + block;
    let repeated = ((1.0 + left / block).ceil() + BLOCKS as f64) * REPEATED as f64;
    let samples = 2.0 * windows.hop as f64 + left + repeated;
    let [lines, points] = lattice.points;
    let sample = lines * points.div_ceil(BRICK) * ROW * size_of::<f16>();
    samples * sample as f64 + memory_of_rest(lattice, period)
}

/// What more a tape takes while a thread joins a pair of windows to it, line by line [bytes].
pub(super) fn memory_while_joining(lattice: &Lattice, period: usize) -> f64 {
    let Windows { fade, hop, .. } = Windows::new(period);
    let samples = 2 * (2 * hop + fade + REPEATED) + 2 * period;
    memory_of_rest(lattice, period) + samples as f64 * memory_of_sample(lattice) / lattice.points[0] as f64
}

/// Memory of what a pair of windows leaves to the next, in half precision [bytes].
fn memory_of_rest(lattice: &Lattice, period: usize) -> f64 {
    0.5 * (Windows::new(period).fade + REPEATED) as f64 * memory_of_sample(lattice)
}

/// Memory of a sample of all points, before it is stored in bricks [bytes].
fn memory_of_sample(lattice: &Lattice) -> f64 {
    let [lines, points] = lattice.points;
    (lines * points * size_of::<[f32; 3]>()) as f64
}

impl Tape {
    /// Makes the samples of a range, and forgets those before it.
    pub(super) fn extend(
        &mut self,
        (plan, synthesis, key): (&Plan, &Synthesis, StreamKey),
        generation: usize,
        samples: Range<i64>,
        threads: usize,
    ) {
        let windows = Windows::new(plan.generations[generation].samples);
        self.blocks.retain(|(end, _)| *end > samples.start);
        let first = windows.first_pair(samples.start - REPEATED as i64);
        let goes_on = match self.blocks.first() {
            Some((_, block)) => block.first <= samples.start,
            None => self.next.is_some_and(|next| next > first),
        };
        if !goes_on {
            *self = Self { next: Some(first), ..Self::default() };
        }
        let mut pair = self.next.unwrap_or(first);
        while 2 * pair * (windows.hop as i64) < samples.end {
            let rest = std::mem::take(&mut self.rest);
            let nothing = Rest::default();
            let made = synthesis.lines(plan, key, (generation, pair), threads, |y, line| {
                windows.join(plan.lattice.points[1], line, rest.get(y).unwrap_or(&nothing))
            });
            let (mut blocks, mut left) = (Vec::new(), Vec::new());
            for (lines, rest) in made {
                blocks.push(lines);
                left.push(rest);
            }
            let start = 2 * pair * windows.hop as i64;
            let each = (2 * windows.hop).div_ceil(BLOCKS);
            for number in 0..BLOCKS {
                let first = start + (number * each) as i64;
                let end = first + each.min(2 * windows.hop - number * each) as i64;
                let lines = blocks.iter_mut().map(|lines| std::mem::take(&mut lines[number])).collect();
                if end > samples.start {
                    let samples = (end - first) as usize + REPEATED;
                    let block = Block { first: first - REPEATED as i64, samples, lines };
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

impl Windows {
    /// Joins two windows to what the ones before have left, along one line: the samples of each block, and what is left.
    ///
    /// Both come from one transform, as its real and its imaginary part. At equal times these have nothing in common, but at unequal
    /// ones they do. So the second window begins where the fade of the first one does, and the two are joined at equal times: the
    /// variance is one in the joint too. Where it has come to the end of the period it goes on from the start, with the other sign,
    /// because its frequencies are half-odd.
    fn join(self, points: usize, [one, other]: Line, rest: &Rest) -> (Vec<Box<[f16]>>, Rest) {
        let row = 3 * points;
        let total = 2 * self.hop;
        let mut samples = vec![0.0_f32; (REPEATED + total + self.fade) * row];
        if !rest.last.is_empty() {
            rest.last.convert_to_f32_slice(&mut samples[..REPEATED * row]);
        }
        let mut add = |sample: usize, window: &[f32], at: usize, factor: f32| {
            let into = &mut samples[(REPEATED + sample) * row..][..row];
            let (m, factor) = if at < self.period { (at, factor) } else { (at - self.period, -factor) };
            for component in 0..3 {
                let values = &window[(component * self.period + m) * points..][..points];
                for (z, value) in values.iter().enumerate() {
                    into[3 * z + component] += factor * value;
                }
            }
        };
        for (start, window) in [(0, &one), (self.hop, &other)] {
            // `start` is also where the window begins in its period.
            for m in 0..self.period {
                let factor = match m {
                    m if m < self.fade => self.factors(m)[1],
                    m if m < self.hop => 1.0,
                    m => self.factors(m - self.hop)[0],
                };
                add(start + m, window, start + m, factor);
            }
        }
        for (sample, fading) in samples[REPEATED * row..].iter_mut().zip(rest.fading.to_f32_vec()) {
            *sample += fading;
        }
        let fading = halves(&samples[(REPEATED + total) * row..]);
        let last = halves(&samples[total * row..][..REPEATED * row]);
        let each = total.div_ceil(BLOCKS);
        let blocks = (0..BLOCKS).map(|number| {
            let first = number * each;
            let end = (first + each).min(total) + REPEATED;
            bricks(&samples[first * row..end * row], points)
        });
        (blocks.collect(), Rest { fading, last })
    }
}
