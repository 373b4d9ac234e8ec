//! Elementary functions with the same bits on every machine.
//!
//! The system's `pow`, `sin` and `atan2` differ between machines in the last bit, and they work on one lane at a
//! time. The functions here are polynomials (minimax fits made with 40 digits) of fused multiply-adds only.

// The coefficients are written as fitted, although some are close to known constants.
#![allow(clippy::approx_constant, clippy::excessive_precision)]

use super::{Register, Simd, WIDTH, Wide};

/// `Σ cᵢ xⁱ` by Horner's rule, which needs the fewest operations.
#[inline(always)]
fn polynomial<S: Simd, const N: usize>(x: Wide<S>, c: &[f64; N]) -> Wide<S> {
    let mut sum = Wide::splat(c[N - 1]);
    for i in (0..N - 1).rev() {
        sum = sum.mul_add(x, Wide::splat(c[i]));
    }
    sum
}

/// `log2(1+f)/f` for `1+f` in [√½, √2], `log2(1+f)` to 4.9e-8.
const LOG2: [f64; 8] = [
    1.442_694_772_308_484_024,
    -0.721_357_147_623_069_291_6,
    0.480_939_459_441_339_921_8,
    -0.360_087_267_892_780_057_2,
    0.286_707_137_436_586_439_3,
    -0.250_068_272_038_381_442_4,
    0.236_892_264_557_206_750_8,
    -0.145_748_660_825_513_837_1,
];

/// `2^r` for r in [−½, ½], to 7.5e-8 relative.
const EXP2: [f64; 6] = [
    1.000_000_071_669_896_481,
    0.693_146_967_218_494_789_4,
    0.240_221_196_834_190_199_8,
    0.055_507_130_278_307_851_89,
    0.009_675_542_989_262_678_982,
    0.001_327_654_753_763_408_038,
];

/// `θ/sin θ` as a function of `δ² = 4 sin²(θ/2)` in [0, ¼], to 1.9e-13.
const NARROW_BEND: [f64; 7] = [
    1.000_000_000_000_184_199,
    0.166_666_666_595_071_680_7,
    0.033_333_337_874_179_846_29,
    0.007_142_749_333_326_964_89,
    0.001_588_515_902_818_558_907,
    0.000_353_785_599_991_397_257_2,
    0.000_102_649_137_481_651_149_2,
];

/// `θ/sin θ` as a function of `δ² = 4 sin²(θ/2)` in [0, 1], to 1.5e-13.
const BEND: [f64; 11] = [
    1.000_000_000_000_146_228,
    0.166_666_666_632_101_755_2,
    0.033_333_334_683_048_653_73,
    0.007_142_836_622_277_689_827,
    0.001_587_461_097_506_760_32,
    0.000_360_030_628_318_844_193_3,
    0.000_085_258_730_419_921_384_06,
    0.000_015_871_161_956_598_320_44,
    0.000_008_518_803_437_859_721_532,
    -0.000_001_518_936_717_846_449_014,
    0.000_001_116_733_502_542_407_263,
];

/// Bits of √½. Mantissas begin here, so that `log2` is smooth at 1.
const SQRT_HALF: u64 = 0x3fe6_a09e_667f_3bcd;
const MANTISSA: u64 = (1 << 52) - 1;
const ONE: u64 = 0x3ff0_0000_0000_0000;
/// 2⁵²; the low bits of `2⁵² + integer` are the integer.
const TWO_52: f64 = 4_503_599_627_370_496.0;
/// 1.5·2⁵²; adding it rounds a small number to the nearest integer.
pub(super) const ROUND: f64 = 6_755_399_441_055_744.0;

/// Base-2 logarithm of positive, normal numbers, to 4.9e-8 absolute.
///
/// Zero and subnormals give −1022, the value of the smallest normal number, so that a positive power of them is
/// negligibly small instead of undefined. NaN and infinity give a finite number; callers multiply by the argument
/// again.
#[inline(always)]
pub fn log2<S: Simd>(x: Wide<S>) -> Wide<S> {
    let shifted = x.max(Wide::splat(f64::MIN_POSITIVE)).0.add_bits(ONE - SQRT_HALF);
    let exponent = Wide(shifted.shift_right::<52>().or_bits(TWO_52.to_bits())) - Wide::splat(TWO_52 + 1023.0);
    let f = Wide(shifted.and_bits(MANTISSA).add_bits(SQRT_HALF)) - Wide::splat(1.0);
    f.mul_add(polynomial(f, &LOG2), exponent)
}

/// `2^x` for `x` in [−1022, 1023], to 7.5e-8 relative.
#[inline(always)]
pub fn exp2<S: Simd>(x: Wide<S>) -> Wide<S> {
    let rounded = x + Wide::splat(ROUND);
    let rest = x - (rounded - Wide::splat(ROUND));
    // The low bits of `rounded` are the integer in two's complement. The shift removes all other bits, and adding
    // the result to the exponent multiplies by the power of two.
    Wide(polynomial(rest, &EXP2).0.add_as_integers(rounded.0.shift_left::<52>()))
}

/// Whole numbers from 0 to below 2³² as indices.
#[inline(always)]
pub fn indices<S: Register>(whole: Wide<S>) -> [usize; WIDTH] {
    let mut indices = [0; WIDTH];
    // The low bits of 2⁵² + integer are the integer.
    for (index, lane) in indices.iter_mut().zip((whole + Wide::splat(TWO_52)).store().0) {
        *index = lane.to_bits() as u32 as usize;
    }
    indices
}

/// Whole numbers within ±2⁵¹ as integers.
#[inline(always)]
pub fn integers<S: Register>(whole: Wide<S>) -> [i64; WIDTH] {
    let mut integers = [0; WIDTH];
    // From one number to the next the bits of 1.5·2⁵² + integer grow by one.
    for (integer, lane) in integers.iter_mut().zip((whole + Wide::splat(ROUND)).store().0) {
        *integer = lane.to_bits().wrapping_sub(ROUND.to_bits()) as i64;
    }
    integers
}

/// Numbers rounded to single precision.
#[inline(always)]
pub fn singles<S: Register>(numbers: Wide<S>) -> [f32; WIDTH] {
    let mut singles = [0.0; WIDTH];
    for (single, lane) in singles.iter_mut().zip(numbers.store().0) {
        *single = lane as f32;
    }
    singles
}

/// `x^exponent` for `x ≥ 0` and exponents between 0 and ½, to 1e-7 relative; tends to 0 with `x`.
#[inline(always)]
pub fn power<S: Simd>(x: Wide<S>, exponent: Wide<S>) -> Wide<S> {
    exp2(log2(x) * exponent)
}

/// `θ/sin θ` for two unit vectors at the angle `θ`, from the square of their difference,
/// `δ² = 4 sin²(θ/2)`, to 2e-13 relative.
///
/// Up to 29° it uses a short polynomial, up to 60° a longer one, and beyond the longer one at a quarter of
/// the angle. The value of a lane does not depend on its neighbours.
#[inline(always)]
pub fn bend_ratio<S: Register>(turn_squared: Wide<S>) -> Wide<S> {
    const NARROW: f64 = 0.25;
    const WIDE: f64 = 1.0;
    let mut ratio = polynomial(turn_squared, &NARROW_BEND);
    if turn_squared.any_above(NARROW) {
        let wider = polynomial(turn_squared, &BEND);
        ratio = Wide::select_less(Wide::splat(NARROW), turn_squared, wider, ratio);
        if turn_squared.any_above(WIDE) {
            let widest = bend_ratio_by_quarter(turn_squared);
            ratio = Wide::select_less(Wide::splat(WIDE), turn_squared, widest, ratio);
        }
    }
    ratio
}

/// `θ/sin θ = (θ/4)/sin(θ/4) / (cos(θ/2) cos(θ/4))`, for bends of more than some degrees.
#[inline(always)]
fn bend_ratio_by_quarter<S: Simd>(turn_squared: Wide<S>) -> Wide<S> {
    let (quarter, half) = (Wide::splat(0.25), Wide::splat(0.5));
    let (one, two) = (Wide::splat(1.0), Wide::splat(2.0));
    // δ² may exceed 4 by rounding; the bound keeps the moment of a folded fibre finite.
    let cos_half = turn_squared.neg_mul_add(quarter, one).max(Wide::splat(f64::EPSILON)).sqrt();
    let cos_quarter = cos_half.mul_add(half, half).sqrt();
    polynomial(two.neg_mul_add(cos_quarter, two), &BEND).over(cos_half * cos_quarter)
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
pub fn cos_sin_turn<S: Simd>(turns: Wide<S>) -> (Wide<S>, Wide<S>) {
    let rounded = turns.mul_add(Wide::splat(4.0), Wide::splat(ROUND));
    let t = (rounded - Wide::splat(ROUND)).neg_mul_add(Wide::splat(0.25), turns);
    let s = polynomial(t * t, &SIN_TURN) * t;
    let c = polynomial(t * t, &COS_TURN);
    // The low bits are the number of the quarter turn. Odd ones swap cos and sin; cos is + − − +, sin is + + − −.
    let odd = Wide(rounded.0.and_bits(1).or_bits(TWO_52.to_bits())) - Wide::splat(TWO_52);
    let half = Wide::splat(0.5);
    let cos = Wide::select_less(half, odd, s, c);
    let sin = Wide::select_less(half, odd, c, s);
    let cos_sign = rounded.0.add_bits(1).and_bits(2).shift_left::<62>();
    let sin_sign = rounded.0.and_bits(2).shift_left::<62>();
    (Wide(cos.0.xor(cos_sign)), Wide(sin.0.xor(sin_sign)))
}
