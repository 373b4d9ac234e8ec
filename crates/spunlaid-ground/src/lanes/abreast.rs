//! Several registers used as one: while one operation waits for its input, the processor works on the others.

use super::{Lanes, Simd};

/// The same operation on each register. This is a macro because a closure would not be compiled for its instructions.
macro_rules! each {
    ($($name:ident($($other:ident),*);)*) => {$(
        #[inline(always)]
        fn $name(mut self $(, $other: Self)*) -> Self {
            for k in 0..K {
                self[k] = self[k].$name($($other[k]),*);
            }
            self
        }
    )*};
}

/// The same for operations with a common argument: bits, or a number of bits.
macro_rules! each_with {
    ($($name:ident$(::<$count:ident>)?($($bits:ident)?);)*) => {$(
        #[inline(always)]
        fn $name$(<const $count: u32>)?(mut self $(, $bits: u64)?) -> Self {
            for one in &mut self {
                *one = one.$name$(::<$count>)?($($bits)?);
            }
            self
        }
    )*};
}

// Some operations need the register of the same index of several arguments.
#[allow(clippy::needless_range_loop)]
impl<S: Simd, const K: usize> Simd for [S; K] {
    each! {
        add(other);
        sub(other);
        mul(other);
        div(other);
        mul_add(factor, addend);
        neg_mul_add(factor, addend);
        sqrt();
        floor();
        max(other);
        xor(other);
        add_as_integers(other);
    }
    each_with! {
        and_bits(bits);
        or_bits(bits);
        add_bits(bits);
        shift_right::<N>();
        shift_left::<N>();
    }
    #[inline(always)]
    fn splat(value: f64) -> Self {
        [S::splat(value); K]
    }
    #[inline(always)]
    fn load(lanes: &Lanes) -> Self {
        [S::load(lanes); K]
    }
    #[inline(always)]
    fn select_less(a: Self, b: Self, yes: Self, mut no: Self) -> Self {
        for k in 0..K {
            no[k] = S::select_less(a[k], b[k], yes[k], no[k]);
        }
        no
    }
    #[inline(always)]
    fn any_above(self, other: Self) -> bool {
        self.into_iter().zip(other).any(|(one, other)| one.any_above(other))
    }
}
