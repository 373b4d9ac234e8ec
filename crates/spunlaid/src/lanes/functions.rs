//! Elementary functions with the same bits on every machine.
//!
//! The system's `pow`, `sin` and `atan2` differ between machines in the last bit, and call one lane at
//! a time. These are polynomials (minimax fits made with 40 digits) in fused multiply-adds only.

use super::{Lanes, WIDTH};
use std::array::from_fn;

/// `Σ cᵢ xⁱ` of up to 16 terms by Estrin's scheme: pairs, pairs of pairs, …, so that few operations wait
/// for one another.
#[inline(always)]
fn polynomial<const N: usize>(x: Lanes, coefficients: &[f64; N]) -> Lanes {
    const { assert!(N >= 2 && N <= 16) };
    let x2 = x * x;
    let x4 = x2 * x2;
    let term = |i: usize| Lanes::splat(coefficients[i]);
    let two = |i: usize| if i + 1 < N { term(i + 1).mul_add(x, term(i)) } else { term(i) };
    let four = |i: usize| if i + 2 < N { two(i + 2).mul_add(x2, two(i)) } else { two(i) };
    let eight = |i: usize| if i + 4 < N { four(i + 4).mul_add(x4, four(i)) } else { four(i) };
    if N > 8 { eight(8).mul_add(x4 * x4, eight(0)) } else { eight(0) }
}

/// `log2(1+f)/f` for `1+f` in [√½, √2], to 3.2e-11.
const LOG2: [f64; 13] = [
    1.442_695_040_870_879_4,
    -0.721_347_520_963_155_2,
    0.480_898_360_176_245_9,
    -0.360_673_655_315_939_6,
    0.288_537_394_378_739_5,
    -0.240_454_336_964_119_98,
    0.206_172_832_267_519_85,
    -0.180_271_025_771_149_4,
    0.158_783_568_325_107_08,
    -0.143_490_393_752_809_9,
    0.144_950_529_998_158_44,
    -0.141_447_882_105_873_9,
    0.075_537_903_980_134_11,
];

/// `2^r` for r in [−½, ½], to 8.1e-13.
const EXP2: [f64; 9] = [
    1.0,
    0.693_147_180_545_933_45,
    0.240_226_506_958_129_88,
    0.055_504_109_412_059_33,
    0.009_618_129_159_402_558,
    0.001_333_345_056_800_064_6,
    0.000_154_034_558_524_538_4,
    1.531_007_940_224_929_7e-5,
    1.325_522_487_866_881_7e-6,
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
/// 2⁵²; an integer below it stands in the low bits of `2⁵² + integer`.
const TWO_52: f64 = 4_503_599_627_370_496.0;
/// 1.5·2⁵²; adding it rounds a small number to the nearest integer.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Base-2 logarithm of positive, normal numbers, to 1.4e-11 absolute.
///
/// Zero and subnormals give −1022 (the smallest normal's), so that a positive power of them is
/// negligibly small instead of undefined. NaN and infinity give some finite number: callers multiply
/// by the argument again.
#[inline(always)]
pub fn log2(x: Lanes) -> Lanes {
    let x = x.max(Lanes::splat(f64::MIN_POSITIVE));
    let mut exponent = [0.0; WIDTH];
    let mut fraction = [0.0; WIDTH];
    for i in 0..WIDTH {
        let shifted = x.0[i].to_bits().wrapping_add(1.0f64.to_bits() - SQRT_HALF);
        exponent[i] = f64::from_bits((shifted >> 52) | TWO_52.to_bits()) - (TWO_52 + 1023.0);
        fraction[i] = f64::from_bits((shifted & MANTISSA) + SQRT_HALF) - 1.0;
    }
    let f = Lanes(fraction);
    f.mul_add(polynomial(f, &LOG2), Lanes(exponent))
}

/// `2^x` for `x` in [−1022, 1023], to 9e-13 relative.
#[inline(always)]
pub fn exp2(x: Lanes) -> Lanes {
    let mut scale = [0.0; WIDTH];
    let mut rest = [0.0; WIDTH];
    for i in 0..WIDTH {
        let rounded = x.0[i] + ROUND;
        rest[i] = x.0[i] - (rounded - ROUND);
        // The low bits of `rounded` hold the integer in two's complement; the rest shifts out.
        scale[i] = f64::from_bits(rounded.to_bits().wrapping_add(1023) << 52);
    }
    polynomial(Lanes(rest), &EXP2) * Lanes(scale)
}

/// `x^exponent` for `x ≥ 0` and exponents between 0 and 1, to 1e-11 relative; tends to 0 with `x`.
#[inline(always)]
pub fn power(x: Lanes, exponent: Lanes) -> Lanes {
    exp2(log2(x) * exponent)
}

/// `θ/sin θ` for two unit vectors at the angle `θ`, from `x = sin²(θ/2)`, to 2e-13 relative.
///
/// Up to 60° a polynomial; beyond, lane by lane, the arctangent. A lane's value does not depend on
/// which way its neighbours go.
#[inline(always)]
pub fn bend_ratio(x: Lanes) -> Lanes {
    const WIDEST: f64 = 0.25;
    let mut ratio = polynomial(x, &BEND);
    if x.any_above(WIDEST) {
        ratio = wide_bend_ratio(x, ratio, WIDEST);
    }
    ratio
}

#[cold]
#[inline(never)]
fn wide_bend_ratio(x: Lanes, narrow: Lanes, widest: f64) -> Lanes {
    Lanes(from_fn(|i| {
        let x = x.0[i];
        if x > widest {
            // sin(θ/2)² = x may exceed 1 by rounding; a fold back onto itself keeps a finite moment.
            let y = (1.0 - x).max(f64::EPSILON);
            2.0 * libm::atan2(libm::sqrt(x), libm::sqrt(y)) / (2.0 * libm::sqrt(x * y))
        } else {
            narrow.0[i]
        }
    }))
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

/// Cosine and sine of a number of turns `|t| < 2⁵⁰` (one turn = 2π), to 2e-16 absolute.
#[inline(always)]
pub fn cos_sin_turn(turns: Lanes) -> (Lanes, Lanes) {
    let mut rest = [0.0; WIDTH];
    let mut quarter = [0u64; WIDTH];
    for i in 0..WIDTH {
        let rounded = turns.0[i].mul_add(4.0, ROUND);
        rest[i] = (rounded - ROUND).mul_add(-0.25, turns.0[i]);
        quarter[i] = rounded.to_bits() & 3;
    }
    let t = Lanes(rest);
    let s = polynomial(t * t, &SIN_TURN) * t;
    let c = polynomial(t * t, &COS_TURN);
    let mut cos = [0.0; WIDTH];
    let mut sin = [0.0; WIDTH];
    for i in 0..WIDTH {
        let odd = quarter[i] & 1 == 1;
        let (even_cos, even_sin) = if odd { (s.0[i], c.0[i]) } else { (c.0[i], s.0[i]) };
        // Quarter turns: cos is + − − +, sin is + + − −.
        let cos_sign = ((quarter[i] + 1) & 2) << 62;
        let sin_sign = (quarter[i] & 2) << 62;
        cos[i] = f64::from_bits(even_cos.to_bits() ^ cos_sign);
        sin[i] = f64::from_bits(even_sin.to_bits() ^ sin_sign);
    }
    (Lanes(cos), Lanes(sin))
}
