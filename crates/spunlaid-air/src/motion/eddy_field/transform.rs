//! Fourier transforms of sixteen signals side by side, of any size without other factors than 2, 3 and 5.
//!
//! Sums and products are rounded one by one, so every machine gives the same bits.

use spunlaid_ground::{F32x16, Isa, Register, Task};
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
}

/// [`Numbers`] in registers.
#[derive(Clone, Copy)]
struct Complex<R> {
    re: R,
    im: R,
}

impl<R: F32x16> Complex<R> {
    #[inline(always)]
    fn load(numbers: &Numbers) -> Self {
        Self { re: R::load(&numbers.re), im: R::load(&numbers.im) }
    }

    #[inline(always)]
    fn store(self, into: &mut Numbers) {
        self.re.store(&mut into.re);
        self.im.store(&mut into.im);
    }

    #[inline(always)]
    fn plus(self, other: Self) -> Self {
        Self { re: self.re.add(other.re), im: self.im.add(other.im) }
    }

    #[inline(always)]
    fn minus(self, other: Self) -> Self {
        Self { re: self.re.sub(other.re), im: self.im.sub(other.im) }
    }

    /// `self + i other`
    #[inline(always)]
    fn plus_turned(self, other: Self) -> Self {
        Self { re: self.re.sub(other.im), im: self.im.add(other.re) }
    }

    /// `self − i other`
    #[inline(always)]
    fn minus_turned(self, other: Self) -> Self {
        Self { re: self.re.add(other.im), im: self.im.sub(other.re) }
    }

    #[inline(always)]
    fn scaled(self, factor: f32) -> Self {
        let factor = R::splat(factor);
        Self { re: self.re.mul(factor), im: self.im.mul(factor) }
    }

    #[inline(always)]
    fn times(self, [re, im]: [f32; 2]) -> Self {
        let (re, im) = (R::splat(re), R::splat(im));
        Self { re: self.re.mul(re).sub(self.im.mul(im)), im: self.re.mul(im).add(self.im.mul(re)) }
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
    /// * `known` – numbers at the start that are given; those after them are zero, whatever is there
    /// * `scratch` – of the same size
    pub(super) fn pass(
        &self,
        isa: Isa,
        known: usize,
        numbers: &mut Vec<Numbers>,
        scratch: &mut Vec<Numbers>,
    ) {
        isa.run(Pass { transform: self, known, numbers, scratch });
    }
}

/// `e^{2πi turns}`
pub(super) fn root(turns: f64) -> [f32; 2] {
    [libm::cos(TAU * turns) as f32, libm::sin(TAU * turns) as f32]
}

/// [`Transform::pass`].
struct Pass<'a> {
    transform: &'a Transform,
    known: usize,
    numbers: &'a mut Vec<Numbers>,
    scratch: &'a mut Vec<Numbers>,
}

/// The pass for a factor. A macro, because what is passed as a function is not always compiled for the
/// instruction set of the kernel.
macro_rules! stage {
    ($factor:literal, $small:ident, $roots:expr, $stride:expr, $from:expr, $into:expr) => {{
        let roots = $roots;
        let stride = $stride;
        let from = &$from[..];
        let into = &mut $into[..];
        let groups = from.len() / (stride * $factor);
        for group in 0..groups {
            let mut turns = [[0.0; 2]; $factor];
            for (r, turn) in turns.iter_mut().enumerate() {
                *turn = roots[r * group * stride];
            }
            for place in 0..stride {
                let mut parts = [Complex::<S::F32x16>::load(&from[place + stride * group]); $factor];
                for (k, part) in parts.iter_mut().enumerate().skip(1) {
                    *part = Complex::load(&from[place + stride * (group + groups * k)]);
                }
                let sums = $small(parts);
                sums[0].store(&mut into[place + stride * $factor * group]);
                for r in 1..$factor {
                    sums[r].times(turns[r]).store(&mut into[place + stride * ($factor * group + r)]);
                }
            }
        }
    }};
}

impl Task for Pass<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        let Self { transform, known, numbers, scratch } = self;
        let (roots, mut stride) = (&transform.roots[..], 1);
        let quarter = numbers.len() / 4;
        let is_short = transform.factors.first() == Some(&4) && known <= quarter;
        let read = if is_short { quarter } else { numbers.len() };
        numbers[known.min(read)..read].fill(Numbers::ZERO);
        for &factor in &transform.factors {
            match factor {
                2 => stage!(2, two, roots, stride, numbers, scratch),
                3 => stage!(3, three, roots, stride, numbers, scratch),
                4 if stride == 1 && is_short => first_of_four::<S>(roots, numbers, scratch),
                4 => stage!(4, four, roots, stride, numbers, scratch),
                _ => stage!(5, five, roots, stride, numbers, scratch),
            }
            stride *= factor;
            std::mem::swap(numbers, scratch);
        }
    }
}

/// Turns each number of the signals by an angle of its own.
pub(super) struct Turned<'a> {
    pub(super) numbers: &'a mut [Numbers],
    pub(super) turns: &'a [[f32; 2]],
}

impl Task for Turned<'_> {
    type Output = ();

    #[inline(always)]
    fn call<S: Register>(self) {
        for (number, turn) in self.numbers.iter_mut().zip(self.turns) {
            Complex::<S::F32x16>::load(number).times(*turn).store(number);
        }
    }
}

/// The first pass, for a factor of four, of signals that are zero after their first quarter.
#[inline(always)]
fn first_of_four<S: Register>(roots: &[[f32; 2]], from: &[Numbers], into: &mut [Numbers]) {
    for (group, into) in into.chunks_exact_mut(4).enumerate() {
        let part = Complex::<S::F32x16>::load(&from[group]);
        part.store(&mut into[0]);
        for (r, into) in into.iter_mut().enumerate().skip(1) {
            part.times(roots[r * group]).store(into);
        }
    }
}

#[inline(always)]
fn two<R: F32x16>([a, b]: [Complex<R>; 2]) -> [Complex<R>; 2] {
    [a.plus(b), a.minus(b)]
}

#[inline(always)]
fn three<R: F32x16>([a, b, c]: [Complex<R>; 3]) -> [Complex<R>; 3] {
    const SIN_60: f32 = 0.866_025_4;
    let (sum, rest) = (b.plus(c), b.minus(c).scaled(SIN_60));
    let middle = a.minus(sum.scaled(0.5));
    [a.plus(sum), middle.plus_turned(rest), middle.minus_turned(rest)]
}

#[inline(always)]
fn four<R: F32x16>([a, b, c, d]: [Complex<R>; 4]) -> [Complex<R>; 4] {
    let ([even, odd], [other_even, other_odd]) = (two([a, c]), two([b, d]));
    [even.plus(other_even), odd.plus_turned(other_odd), even.minus(other_even), odd.minus_turned(other_odd)]
}

#[inline(always)]
fn five<R: F32x16>([a, b, c, d, e]: [Complex<R>; 5]) -> [Complex<R>; 5] {
    const COS: [f32; 2] = [0.309_017, -0.809_017];
    const SIN: [f32; 2] = [0.951_056_5, 0.587_785_25];
    let ([near, near_rest], [far, far_rest]) = (two([b, e]), two([c, d]));
    let one = a.plus(near.scaled(COS[0])).plus(far.scaled(COS[1]));
    let other = a.plus(near.scaled(COS[1])).plus(far.scaled(COS[0]));
    let one_rest = near_rest.scaled(SIN[0]).plus(far_rest.scaled(SIN[1]));
    let other_rest = near_rest.scaled(SIN[1]).minus(far_rest.scaled(SIN[0]));
    [
        a.plus(near).plus(far),
        one.plus_turned(one_rest),
        other.plus_turned(other_rest),
        other.minus_turned(other_rest),
        one.minus_turned(one_rest),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::array::from_fn;

    /// Numbers after the first ones are zero, whatever is there.
    #[test]
    fn identical_bits_of_signals_that_are_given_in_part() {
        for (size, known) in [(60, 15), (60, 11), (60, 16), (64, 3), (75, 20), (1, 1)] {
            let value = |n: usize, i: usize| ((0.618034 * (n * n + 3 * i) as f64).fract() - 0.5) as f32;
            let given = |n: usize| Numbers { re: from_fn(|i| value(n, i)), im: from_fn(|i| value(n + 7, i)) };
            let whole: Vec<_> = (0..size).map(|n| if n < known { given(n) } else { Numbers::ZERO }).collect();
            let bits = |isa: Isa, known: usize, mut numbers: Vec<Numbers>| {
                let mut scratch = vec![Numbers::ZERO; size];
                Transform::new(size).pass(isa, known, &mut numbers, &mut scratch);
                // A zero of either sign.
                let parts = numbers.iter().flat_map(|number| number.re.into_iter().chain(number.im));
                parts.map(|part| (part + 0.0).to_bits()).collect::<Vec<_>>()
            };
            let expected = bits(Isa::Baseline, size, whole);
            for isa in Isa::available() {
                assert!(
                    bits(isa, known, (0..size).map(given).collect()) == expected,
                    "{size} {known} {isa:?}"
                );
            }
        }
    }

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
                Transform::new(size).pass(isa, size, &mut numbers, &mut scratch);
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
