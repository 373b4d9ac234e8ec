//! How windows follow each other and are joined to endless samples.

use super::lattice::{BRICK, REPEATED, line_size, row_size};
use super::synthesis::LineMaker;
use super::transform::{ABREAST, Numbers};
use half::f16;
use spunlaid_ground::{F32x16, Isa, Register, Task};
use std::f64::consts::FRAC_PI_2;

/// Blocks in a pair of windows.
pub(super) const BLOCKS: usize = 6;

/// Three components at some points.
type Points = [[f16; ABREAST]; 3];
/// The same, point by point.
type Triples = [f16; 3 * ABREAST];

/// How windows follow each other, in samples.
#[derive(Clone, Debug)]
pub(super) struct FieldWindows {
    /// Time in which one fades out and the next one in.
    pub(super) fade: usize,
    /// From the start of one to that of the next.
    pub(super) hop: usize,
    /// What each sample of a pair is made of, and of what it leaves to the next.
    sums: Vec<Sum>,
}

/// A sample as the sum of one of each window.
#[derive(Clone, Copy, Debug)]
struct Sum {
    samples: [usize; 2],
    factors: [f32; 2],
}

/// What a pair of windows leaves to the next, along one line.
#[derive(Clone, Debug, Default)]
pub(super) struct Rest {
    /// What the last window adds to the samples of the next pair. `[points][sample]`
    fading: Vec<Points>,
    /// The last samples. `[points][sample]`
    last: Vec<Triples>,
}

impl FieldWindows {
    /// Both windows come from one transform, as its real and its imaginary part. At equal times these have
    /// nothing in common, but at unequal ones they do. So the second window begins where the fade of the
    /// first one does, and the two are joined at equal times: the variance is one in the joint too. Where it
    /// has come to the end of the period it goes on from the start, with the other sign, because its
    /// frequencies are half-odd.
    ///
    /// * `period` – time in which a window repeats
    pub(super) fn new(period: usize) -> Self {
        let (fade, hop) = (period / 4, period - period / 4);
        let mut sums = vec![Sum { samples: [0; 2], factors: [0.0; 2] }; 2 * hop + fade];
        for (window, start) in [0, hop].into_iter().enumerate() {
            // `start` is also where the window begins in its period.
            for m in 0..period {
                let factor = match m {
                    m if m < fade => factors(m, fade)[1],
                    m if m < hop => 1.0,
                    m => factors(m - hop, fade)[0],
                };
                let at = start + m;
                let (sample, factor) = if at < period { (at, factor) } else { (at - period, -factor) };
                sums[at].samples[window] = sample;
                sums[at].factors[window] = factor;
            }
        }
        Self { fade, hop, sums }
    }

    /// Number of samples that a pair adds.
    pub(super) fn total(&self) -> usize {
        2 * self.hop
    }

    /// The pair of windows that has to be made first for a sample to be complete.
    pub(super) fn first_pair(&self, sample: i64) -> i64 {
        (sample - self.fade as i64).div_euclid(self.total() as i64)
    }

    /// Samples of a block, counted from the start of the pair; those that it repeats of the one before it come on top.
    pub(super) fn block(&self, number: usize) -> std::ops::Range<usize> {
        let each = self.total().div_ceil(BLOCKS);
        (number * each).min(self.total())..((number + 1) * each).min(self.total())
    }

    /// Joins two windows to what the ones before have left, along one line: the samples of each block in
    /// bricks, and what is left.
    pub(super) fn join(&self, isa: Isa, mut line: LineMaker<'_>, rest: &Rest) -> (Vec<Box<[f16]>>, Rest) {
        let points = line.points();
        let row_size = row_size(points);
        let mut blocks: Vec<Box<[f16]>> = (0..BLOCKS)
            .map(|number| vec![f16::ZERO; line_size(self.block(number).len() + REPEATED, points)].into())
            .collect();
        let chunks = points.div_ceil(ABREAST);
        let mut left = Rest {
            fading: Vec::with_capacity(chunks * self.fade),
            last: Vec::with_capacity(chunks * REPEATED),
        };
        let mut samples = vec![[f16::ZERO; 3 * ABREAST]; REPEATED + self.total()];
        let mut fading = vec![[[f16::ZERO; ABREAST]; 3]; self.fade];
        for (number, first) in (0..points).step_by(ABREAST).enumerate() {
            if let Some(last) = rest.last.get(number * REPEATED..).and_then(|last| last.get(..REPEATED)) {
                samples[..REPEATED].copy_from_slice(last);
            }
            isa.run(Join {
                sums: &self.sums,
                windows: line.windows(first),
                before: rest
                    .fading
                    .get(number * self.fade..)
                    .and_then(|of| of.get(..self.fade))
                    .unwrap_or_default(),
                samples: &mut samples[REPEATED..],
                fading: &mut fading,
            });
            left.fading.extend_from_slice(&fading);
            left.last.extend_from_slice(&samples[self.total()..]);
            let count = 3 * ABREAST.min(points - first);
            let (brick, place) = (first / BRICK, 3 * (first % BRICK));
            for (number, block) in blocks.iter_mut().enumerate() {
                let within = self.block(number);
                let samples = &samples[within.start..within.end + REPEATED];
                let rows = block[brick * samples.len() * row_size..].chunks_exact_mut(row_size);
                for (row, sample) in rows.zip(samples) {
                    row[place..][..count].copy_from_slice(&sample[..count]);
                }
            }
        }
        for (number, block) in blocks.iter_mut().enumerate() {
            repeat(block, self.block(number).len() + REPEATED, points);
        }
        (blocks, left)
    }
}

/// Factors of the window that fades out and of the one that fades in, at a sample of the fade.
fn factors(sample: usize, fade: usize) -> [f32; 2] {
    let angle = FRAC_PI_2 * (sample as f64 + 0.5) / fade as f64;
    [libm::cos(angle) as f32, libm::sin(angle) as f32]
}

/// Repeats in each brick of a line the first points of the next one.
///
/// * `samples` – in the line
fn repeat(line: &mut [f16], samples: usize, points: usize) {
    let (bricks, row_size) = (points.div_ceil(BRICK), row_size(points));
    for brick in 0..bricks {
        let here = BRICK.min(points - brick * BRICK);
        for further in 0..REPEATED {
            let from = (brick * BRICK + here + further) % points;
            for sample in 0..samples {
                let from = (from / BRICK * samples + sample) * row_size + 3 * (from % BRICK);
                line.copy_within(
                    from..from + 3,
                    (brick * samples + sample) * row_size + 3 * (here + further),
                );
            }
        }
    }
}

/// Some points of [`FieldWindows::join`].
struct Join<'a> {
    sums: &'a [Sum],
    /// Of each component, the samples of one window as real parts and those of the other as imaginary parts.
    windows: &'a [Vec<Numbers>; 3],
    /// What the windows before add.
    before: &'a [Points],
    samples: &'a mut [Triples],
    fading: &'a mut [Points],
}

impl Task for Join<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        let Self { sums, windows, before, samples, fading } = self;
        let [x, y, z] = windows;
        let total = samples.len();
        for (m, sum) in sums.iter().enumerate() {
            let [one, other] = sum.samples;
            let mut values = [S::F32x16::splat(0.0); 3];
            for (value, window) in values.iter_mut().zip([x, y, z]) {
                let of_one = S::F32x16::load(&window[one].re).mul(S::F32x16::splat(sum.factors[0]));
                let of_other = S::F32x16::load(&window[other].im).mul(S::F32x16::splat(sum.factors[1]));
                *value = of_one.add(of_other);
            }
            if m < before.len() {
                for (value, before) in values.iter_mut().zip(&before[m]) {
                    *value = value.add(S::F32x16::load_halves(before));
                }
            }
            if m < total {
                S::F32x16::store_interleaved(values, &mut samples[m]);
            } else {
                for (value, into) in values.into_iter().zip(&mut fading[m - total]) {
                    value.store_halves(into);
                }
            }
        }
    }
}
