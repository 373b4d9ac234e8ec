//! Elementary functions with the same bits on every machine.
//!
//! The system's `pow`, `sin` and `atan2` differ between machines in the last bit, and call one lane at
//! a time. These are polynomials (minimax fits made with 40 digits) in fused multiply-adds only.

// The fits' coefficients are written as fitted, near to known constants as some are.
#![allow(clippy::approx_constant, clippy::excessive_precision)]

use super::{Lanes, Register, Simd, Wide};

/// `Σ cᵢ xⁱ`, even and odd terms side by side by Horner's rule in `x²`: half the wait, one more product.
#[inline(always)]
fn polynomial<S: Simd, const N: usize>(x: Wide<S>, c: &[f64; N]) -> Wide<S> {
    const { assert!(N >= 2) };
    let x2 = x * x;
    let (mut last, mut other) = (Wide::splat(c[N - 1]), Wide::splat(c[N - 2]));
    for i in (0..N - 2).rev() {
        (last, other) = (other, last.mul_add(x2, Wide::splat(c[i])));
    }
    // `other` holds the even terms, `last` the odd ones.
    last.mul_add(x, other)
}

/// `log2(1+f)/f` for `1+f` in [√½, √2], to 7.8e-9.
const LOG2: [f64; 10] = [
    1.442_695_039_999_188_4,
    -0.721_347_354_478_905_3,
    0.480_898_520_324_064_2,
    -0.360_696_541_807_505_1,
    0.288_552_561_437_467_4,
    -0.239_608_121_909_572_85,
    0.204_857_647_786_219_3,
    -0.191_388_376_566_725_4,
    0.184_760_333_651_813_8,
    -0.107_497_894_180_832_06,
];

/// `2^r` for r in [−½, ½], to 2.0e-9.
const EXP2: [f64; 7] = [
    1.0,
    0.693_147_206_702_832_6,
    0.240_226_509_222_887_58,
    0.055_503_272_266_703_02,
    0.009_618_056_678_524_638,
    0.001_340_042_817_761_583_8,
    0.000_154_614_446_985_691_3,
];

/// `θ/sin θ` as a function of `x = sin²(θ/2)` in [0, 1/16], to 1.9e-13.
const NARROW_BEND: [f64; 7] = [
    1.000_000_000_000_178_7,
    0.666_666_666_386_659_8,
    0.533_333_404_794_306_6,
    0.457_136_038_904_004_56,
    0.406_657_550_423_975_9,
    0.362_312_343_291_399_2,
    0.420_259_299_214_237_5,
];

/// `θ/sin θ` as a function of `x = sin²(θ/2)` in [0, ¼], to 1.7e-13.
const BEND: [f64; 11] = [
    1.000_000_000_000_126_8,
    0.666_666_666_544_056_9,
    0.533_333_352_852_226_8,
    0.457_141_650_607_714_3,
    0.406_387_254_367_918_7,
    0.368_713_109_185_019_33,
    0.348_839_196_959_667_5,
    0.262_179_555_059_688_65,
    0.550_974_518_495_669_9,
    -0.384_386_190_510_997_44,
    1.159_925_416_559_732,
];

/// Bits of √½: mantissas are taken from here up, so that `log2` is smooth through 1.
const SQRT_HALF: u64 = 0x3fe6_a09e_667f_3bcd;
const MANTISSA: u64 = (1 << 52) - 1;
const ONE: u64 = 0x3ff0_0000_0000_0000;
/// 2⁵²; an integer below it stands in the low bits of `2⁵² + integer`.
const TWO_52: f64 = 4_503_599_627_370_496.0;
/// 1.5·2⁵²; adding it rounds a small number to the nearest integer.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Base-2 logarithm of positive, normal numbers, to 3.3e-9 absolute.
///
/// Zero and subnormals give −1022 (the smallest normal's), so that a positive power of them is
/// negligibly small instead of undefined. NaN and infinity give some finite number: callers multiply
/// by the argument again.
#[inline(always)]
fn log2<S: Simd>(x: Wide<S>) -> Wide<S> {
    let shifted = x.max(Wide::splat(f64::MIN_POSITIVE)).0.add_bits(ONE - SQRT_HALF);
    let exponent = Wide(shifted.shift_right::<52>().or_bits(TWO_52.to_bits())) - Wide::splat(TWO_52 + 1023.0);
    let f = Wide(shifted.and_bits(MANTISSA).add_bits(SQRT_HALF)) - Wide::splat(1.0);
    f.mul_add(polynomial(f, &LOG2), exponent)
}

/// `2^x` for `x` in [−1022, 1023], to 2e-9 relative.
#[inline(always)]
fn exp2<S: Simd>(x: Wide<S>) -> Wide<S> {
    let rounded = x + Wide::splat(ROUND);
    let rest = x - (rounded - Wide::splat(ROUND));
    // The low bits of `rounded` hold the integer in two's complement; the rest shifts out, and adding it
    // to the exponent multiplies by its power of two.
    Wide(polynomial(rest, &EXP2).0.add_as_integers(rounded.0.shift_left::<52>()))
}

/// `x^exponent` for `x ≥ 0` and exponents between 0 and 1, to 4e-9 relative; tends to 0 with `x`.
#[inline(always)]
pub(crate) fn power<S: Simd>(x: Wide<S>, exponent: Wide<S>) -> Wide<S> {
    exp2(log2(x) * exponent)
}

/// `θ/sin θ` for two unit vectors at the angle `θ`, from `x = sin²(θ/2)`, to 2e-13 relative.
///
/// Up to 29° a short polynomial, up to 60° a longer one, beyond the arctangent lane by lane. A lane's
/// value does not depend on which way its neighbours go.
#[inline(always)]
pub(crate) fn bend_ratio<S: Register>(x: Wide<S>) -> Wide<S> {
    const NARROW: f64 = 1.0 / 16.0;
    const WIDE: f64 = 0.25;
    let mut ratio = polynomial(x, &NARROW_BEND);
    if x.any_above(NARROW) {
        ratio = Wide::select_less(Wide::splat(NARROW), x, polynomial(x, &BEND), ratio);
        if x.any_above(WIDE) {
            let arc = Wide::load(&arc_ratios(x.store(), WIDE));
            ratio = Wide::select_less(Wide::splat(WIDE), x, arc, ratio);
        }
    }
    ratio
}

#[cold]
#[inline(never)]
fn arc_ratios(x: Lanes, above: f64) -> Lanes {
    Lanes::from_fn(|i| if x.0[i] > above { arc_ratio(x.0[i]) } else { 1.0 })
}

/// `θ/sin θ` from `x = sin²(θ/2)` by the arctangent.
fn arc_ratio(x: f64) -> f64 {
    // x may exceed 1 by rounding; a fold back onto itself keeps a finite moment.
    let y = (1.0 - x).max(f64::EPSILON);
    libm::atan2(libm::sqrt(x), libm::sqrt(y)) / libm::sqrt(x * y)
}

/// `sin(2πt)/t` in `t²`, |t| ≤ ⅛, to 2e-17.
const SIN_TURN: [f64; 7] = [
    6.283_185_307_179_586,
    -41.341_702_240_399_64,
    81.605_249_275_948_04,
    -76.705_859_704_274_55,
    42.058_685_020_160_894,
    -15.093_804_209_987_114,
    3.780_868_959_302_295_5,
];

/// `cos(2πt)` in `t²`, |t| ≤ ⅛, to 5e-17.
const COS_TURN: [f64; 7] = [
    1.0,
    -19.739_208_802_178_42,
    64.939_394_022_365_37,
    -85.456_817_090_341_15,
    60.244_620_085_930_29,
    -26.424_257_034_882_69,
    7.810_290_968_144_190_6,
];

/// Cosine and sine of a number of turns `|t| < 2⁴⁸` (one turn = 2π), to 4e-16 absolute.
#[inline(always)]
pub(crate) fn cos_sin_turn<S: Simd>(turns: Wide<S>) -> (Wide<S>, Wide<S>) {
    let rounded = turns.mul_add(Wide::splat(4.0), Wide::splat(ROUND));
    let t = (rounded - Wide::splat(ROUND)).neg_mul_add(Wide::splat(0.25), turns);
    let s = polynomial(t * t, &SIN_TURN) * t;
    let c = polynomial(t * t, &COS_TURN);
    // Which quarter turn, in the low bits: odd ones swap, and cos is + − − +, sin is + + − −.
    let odd = Wide(rounded.0.and_bits(1).or_bits(TWO_52.to_bits())) - Wide::splat(TWO_52);
    let half = Wide::splat(0.5);
    let (cos, sin) = (Wide::select_less(half, odd, s, c), Wide::select_less(half, odd, c, s));
    let cos_sign = rounded.0.add_bits(1).and_bits(2).shift_left::<62>();
    let sin_sign = rounded.0.and_bits(2).shift_left::<62>();
    (Wide(cos.0.xor(cos_sign)), Wide(sin.0.xor(sin_sign)))
}
