//! Fourier transforms of sixteen signals side by side, of any size without other factors than 2, 3 and 5.
//!
//! Sums and products are rounded one by one, so every machine gives the same bits.

use crate::lanes::{Isa, Register, Task};
use std::array::from_fn;
use std::f64::consts::TAU;

/// Signals side by side.
pub(super) const ABREAST: usize = 16;

/// A complex number of each signal.
#[derive(Clone, Copy, Debug)]
#[repr(C, align(64))]
pub(super) struct Numbers {
    pub(super) re: [f32; ABREAST],
    pub(super) im: [f32; ABREAST],
}

impl Numbers {
    pub(super) const ZERO: Self = Self { re: [0.0; ABREAST], im: [0.0; ABREAST] };

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self { re: from_fn(|i| self.re[i] + other.re[i]), im: from_fn(|i| self.im[i] + other.im[i]) }
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self { re: from_fn(|i| self.re[i] - other.re[i]), im: from_fn(|i| self.im[i] - other.im[i]) }
    }

    #[inline(always)]
    fn scaled(self, factor: f32) -> Self {
        Self { re: self.re.map(|part| part * factor), im: self.im.map(|part| part * factor) }
    }

    #[inline(always)]
    pub(super) fn times(self, [re, im]: [f32; 2]) -> Self {
        Self {
            re: from_fn(|i| self.re[i] * re - self.im[i] * im),
            im: from_fn(|i| self.re[i] * im + self.im[i] * re),
        }
    }

    /// `i` times the numbers.
    #[inline(always)]
    fn turned(self) -> Self {
        Self { re: self.im.map(|part| -part), im: self.re }
    }
}

/// Unscaled transform `y_m = Σ_n x_n e^{2πi nm/N}`.
///
/// Stockham's form, which needs no reordering: one pass for each factor.
#[derive(Debug)]
pub(super) struct Transform {
    factors: Vec<usize>,
    /// `e^{2πi k/N}`
    roots: Vec<[f32; 2]>,
}

impl Transform {
    pub(super) fn new(size: usize) -> Self {
        let (mut left, mut factors) = (size, Vec::new());
        for factor in [4, 2, 3, 5] {
            while left.is_multiple_of(factor) {
                factors.push(factor);
                left /= factor;
            }
        }
        debug_assert_eq!(left, 1, "{size}");
        Self { factors, roots: (0..size).map(|k| root(k as f64 / size as f64)).collect() }
    }

    /// Transforms the signals in `numbers`, which end there too.
    ///
    /// * `scratch` – of the same size
    pub(super) fn pass(&self, isa: Isa, numbers: &mut Vec<Numbers>, scratch: &mut Vec<Numbers>) {
        isa.run(Pass { transform: self, numbers, scratch });
    }
}

/// `e^{2πi turns}`
pub(super) fn root(turns: f64) -> [f32; 2] {
    [libm::cos(TAU * turns) as f32, libm::sin(TAU * turns) as f32]
}

/// [`Transform::pass`].
struct Pass<'a> {
    transform: &'a Transform,
    numbers: &'a mut Vec<Numbers>,
    scratch: &'a mut Vec<Numbers>,
}

impl Task for Pass<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        let Self { transform, numbers, scratch } = self;
        let (roots, mut stride) = (&transform.roots[..], 1);
        for &factor in &transform.factors {
            match factor {
                2 => stage::<2>(roots, stride, numbers, scratch, two),
                3 => stage::<3>(roots, stride, numbers, scratch, three),
                4 => stage::<4>(roots, stride, numbers, scratch, four),
                _ => stage::<5>(roots, stride, numbers, scratch, five),
            }
            stride *= factor;
            std::mem::swap(numbers, scratch);
        }
    }
}

/// The pass for a factor `F`.
#[inline(always)]
fn stage<const F: usize>(
    roots: &[[f32; 2]],
    stride: usize,
    from: &[Numbers],
    into: &mut [Numbers],
    small: impl Fn([Numbers; F]) -> [Numbers; F],
) {
    let groups = from.len() / (stride * F);
    for group in 0..groups {
        let turns: [[f32; 2]; F] = from_fn(|r| roots[r * group * stride]);
        for place in 0..stride {
            let parts = from_fn(|k| from[place + stride * (group + groups * k)]);
            for (r, part) in small(parts).into_iter().enumerate() {
                into[place + stride * (F * group + r)] = if r == 0 { part } else { part.times(turns[r]) };
            }
        }
    }
}

#[inline(always)]
fn two([a, b]: [Numbers; 2]) -> [Numbers; 2] {
    [a.plus(b), a.minus(b)]
}

#[inline(always)]
fn three([a, b, c]: [Numbers; 3]) -> [Numbers; 3] {
    const SIN_60: f32 = 0.866_025_4;
    let (sum, rest) = (b.plus(c), b.minus(c).scaled(SIN_60).turned());
    let middle = a.minus(sum.scaled(0.5));
    [a.plus(sum), middle.plus(rest), middle.minus(rest)]
}

#[inline(always)]
fn four([a, b, c, d]: [Numbers; 4]) -> [Numbers; 4] {
    let ([even, odd], [other_even, other_odd]) = (two([a, c]), two([b, d]));
    let turned = other_odd.turned();
    [even.plus(other_even), odd.plus(turned), even.minus(other_even), odd.minus(turned)]
}

#[inline(always)]
fn five([a, b, c, d, e]: [Numbers; 5]) -> [Numbers; 5] {
    const COS: [f32; 2] = [0.309_017, -0.809_017];
    const SIN: [f32; 2] = [0.951_056_5, 0.587_785_25];
    let ([near, near_rest], [far, far_rest]) = (two([b, e]), two([c, d]));
    let middle = [0, 1].map(|i| a.plus(near.scaled(COS[i])).plus(far.scaled(COS[1 - i])));
    let rest = [
        near_rest.scaled(SIN[0]).plus(far_rest.scaled(SIN[1])).turned(),
        near_rest.scaled(SIN[1]).minus(far_rest.scaled(SIN[0])).turned(),
    ];
    [
        a.plus(near).plus(far),
        middle[0].plus(rest[0]),
        middle[1].plus(rest[1]),
        middle[1].minus(rest[1]),
        middle[0].minus(rest[0]),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn analytic_a_transform_is_the_sum_that_it_stands_for() {
        for size in [1, 2, 3, 4, 5, 8, 12, 60, 75, 96] {
            let value = |n: usize, i: usize| {
                [0.7548776 * (n + 3 * i) as f64, 0.618034 * (n * n + i) as f64].map(|x| x.fract() - 0.5)
            };
            let number = |n: usize| Numbers {
                re: from_fn(|i| value(n, i)[0] as f32),
                im: from_fn(|i| value(n, i)[1] as f32),
            };
            for isa in Isa::available() {
                let mut numbers: Vec<_> = (0..size).map(number).collect();
                let mut scratch = numbers.clone();
                Transform::new(size).pass(isa, &mut numbers, &mut scratch);
                for (m, found) in numbers.iter().enumerate() {
                    for i in [0, 7, 15] {
                        let (mut re, mut im) = (0.0, 0.0);
                        for n in 0..size {
                            let [a, b] = value(n, i);
                            let turn = TAU * (n * m) as f64 / size as f64;
                            re += a * turn.cos() - b * turn.sin();
                            im += a * turn.sin() + b * turn.cos();
                        }
                        let error = (f64::from(found.re[i]) - re).hypot(f64::from(found.im[i]) - im);
                        assert!(error < 1e-5 * (size as f64).sqrt(), "{size}, {m}, {i}: {error}");
                    }
                }
            }
        }
    }
}
