//! The autocorrelation of the surrogate from its generator, without simulation.
//!
//! In lengths of σ₁ and with `x_i = ξ_i/σ_i`, the mean of a function f of the state changes along the fibre
//! by `L f = H f + D f`,
//!
//! ```text
//! H = cos α ∂₁ + r sin α ∂₂ + (x₁ sin α − r x₂ cos α) ∂_α,   r = σ₁/σ₂,      D = ½A²σ₁ ∂_α²
//! ```
//!
//! and the autocorrelation of ξ₁ is `C(s) = ⟨x₁, e^{Ls} x₁⟩` in the stationary state. In Hermite functions of
//! x₁ and x₂ of the degrees m and n and cosines (n even) or sines (n odd) of kα, H is antisymmetric, changes
//! k and one of m and n by one, and D is `−½A²σ₁k²`. Reflection in both axes leaves those functions of which
//! m+n+k is odd.
//!
//! Turning α by half a turn changes the sign of H only. Therefore, with e and o the parts of `e^{Ls/2} x₁` with k even
//! and odd, `C(s) = |e|² − |o|²`: it is enough to follow x₁ along half the lag.

use spunlaid_ground::{Isa, Lanes, Register, Simd, Task, WIDTH, Wide};

/// How many functions are taken: m+n up to `degree`, k up to `harmonic`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    pub(super) degree: usize,
    pub(super) harmonic: usize,
}

impl Size {
    /// Enough to find the order of magnitude of the noise.
    pub(super) const COARSE: Self = Self { degree: 12, harmonic: 8 };

    /// Enough for a relative noise: the less noise, the finer the functions that a curve goes through.
    pub(super) fn for_noise(noise: f64) -> Self {
        match noise {
            x if x < 0.4 => Self { degree: 30, harmonic: 10 },
            x if x < 0.8 => Self { degree: 24, harmonic: 10 },
            x if x < 2.0 => Self { degree: 18, harmonic: 10 },
            _ => Self { degree: 12, harmonic: 8 },
        }
    }
}

/// Step along half the lag that keeps the error of the integration below 6e-5, as its test measures [σ₁].
const STEP: f64 = 0.025;

/// Half the step of the lag between the values that are kept, as long as one step is no longer [σ₁].
const KEPT: f64 = 0.05;

/// The autocorrelation of ξ₁ for eight strengths of noise.
pub(super) struct Correlations {
    /// Step of the lag [σ₁].
    step: f64,
    values: Vec<Lanes>,
}

impl Correlations {
    /// * `other` – σ₂/σ₁
    /// * `noise` – A²σ₁ of each lane
    /// * `reach` – largest lag that is wanted [σ₁]
    pub(super) fn new(other: f64, noise: [f64; WIDTH], reach: f64, size: Size) -> Self {
        Self::with_step(STEP, other, noise, reach, size)
    }

    fn with_step(step: f64, other: f64, noise: [f64; WIDTH], reach: f64, size: Size) -> Self {
        let generator = Generator::new(1.0 / other, size);
        // Leapfrog is stable below 2/|H|; the norm is found from below.
        let largest = step.min(1.7 / generator.norm());
        let half = 0.5 * reach.max(1e-3);
        let values = (half / KEPT.max(largest)).ceil().max(4.0);
        let spacing = half / values;
        let substeps = (spacing / largest).ceil();
        let follow = Follow {
            generator: &generator,
            noise,
            step: spacing / substeps,
            substeps: substeps as usize,
            values: values as usize,
        };
        Self { step: 2.0 * spacing, values: Isa::detect().run(follow) }
    }

    /// The coefficients at a lag [σ₁] up to the reach, by a cubic through the four nearest.
    pub(super) fn at(&self, lag: f64) -> [f64; WIDTH] {
        let place = lag / self.step;
        let first = (place.floor() as usize).saturating_sub(1).min(self.values.len() - 4);
        let t = place - first as f64;
        let a = t - 1.0;
        let b = t - 2.0;
        let c = t - 3.0;
        let weights = [-a * b * c / 6.0, 0.5 * t * b * c, -0.5 * t * a * c, t * a * b / 6.0];
        let mut sum = [0.0; WIDTH];
        for (weight, values) in weights.iter().zip(&self.values[first..]) {
            for (sum, value) in sum.iter_mut().zip(values.0) {
                *sum += weight * value;
            }
        }
        sum
    }
}

/// H between the functions with even and with odd k.
struct Generator {
    /// Rates of change of the even functions from the odd ones, and the reverse.
    even: SparseMatrix,
    odd: SparseMatrix,
}

/// A sparse matrix, row by row.
#[derive(Default)]
struct SparseMatrix {
    /// Harmonic of each row, and the end of its entries.
    rows: Vec<(usize, usize)>,
    /// Column and value.
    entries: Vec<(u32, f64)>,
}

impl Generator {
    fn new(rate: f64, Size { degree, harmonic }: Size) -> Self {
        let is_used = |m: usize, n: usize, k: usize| {
            m + n <= degree && k <= harmonic && (m + n + k) % 2 == 1 && (k > 0 || n.is_multiple_of(2))
        };
        // Number of each function among those with k of the same parity; m = 1 alone, x₁, comes first.
        let width = degree + 1;
        let place = |m: usize, n: usize, k: usize| (k * width + n) * width + m;
        let mut numbers = vec![0; place(0, 0, harmonic + 1)];
        let mut functions = [Vec::new(), Vec::new()];
        for k in 0..=harmonic {
            for n in 0..=degree {
                for m in (0..=degree - n).filter(|m| is_used(*m, n, k)) {
                    let alike = &mut functions[k % 2];
                    numbers[place(m, n, k)] = alike.len() as u32;
                    alike.push((m, n, k));
                }
            }
        }
        let part = |functions: &[(usize, usize, usize)]| {
            let mut part = SparseMatrix::default();
            for &(m, n, k) in functions {
                let mut from = |m: usize, n: usize, k: usize, value: f64| {
                    if is_used(m, n, k) && value != 0.0 {
                        part.entries.push((numbers[place(m, n, k)], value));
                    }
                };
                let (root_m, root_n) = ((m as f64).sqrt(), rate * (n as f64).sqrt());
                let above_m = (m as f64 + 1.0).sqrt();
                let above_n = rate * (n as f64 + 1.0).sqrt();
                // From the function with one harmonic less; that without any is normalised differently.
                if k > 0 {
                    let less = k as f64 - 1.0;
                    let scale = if k == 1 { std::f64::consts::FRAC_1_SQRT_2 } else { 0.5 };
                    from(m + 1, n, k - 1, scale * above_m * (1.0 + less));
                    from(m, n + 1, k - 1, scale * above_n * (1.0 + less));
                    if m > 0 {
                        from(m - 1, n, k - 1, scale * root_m * less);
                    }
                    if n > 0 {
                        from(m, n - 1, k - 1, -scale * root_n * less);
                    }
                }
                // From the function with one more, by antisymmetry.
                let scale = if k == 0 { std::f64::consts::FRAC_1_SQRT_2 } else { 0.5 };
                let own = k as f64;
                if m > 0 {
                    from(m - 1, n, k + 1, -scale * root_m * (1.0 + own));
                }
                if n > 0 {
                    from(m, n - 1, k + 1, -scale * root_n * (1.0 + own));
                }
                from(m + 1, n, k + 1, -scale * above_m * own);
                from(m, n + 1, k + 1, scale * above_n * own);
                part.rows.push((k, part.entries.len()));
            }
            part
        };
        Self { even: part(&functions[0]), odd: part(&functions[1]) }
    }

    /// The largest factor by which H lengthens a vector, by iteration, a few per cent low.
    fn norm(&self) -> f64 {
        let mut even = vec![1.0; self.even.rows.len()];
        let length = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let mut norm = 0.0;
        for _ in 0..30 {
            let before = length(&even);
            even.iter_mut().for_each(|x| *x /= before);
            even = self.even.times(&self.odd.times(&even));
            norm = length(&even).sqrt();
        }
        norm
    }
}

impl SparseMatrix {
    fn times(&self, from: &[f64]) -> Vec<f64> {
        let mut start = 0;
        let row = |&(_, end): &(usize, usize)| {
            let entries = &self.entries[start..end];
            start = end;
            entries.iter().map(|(column, value)| value * from[*column as usize]).sum()
        };
        self.rows.iter().map(row).collect()
    }

    /// The exact change of `to` over a step in which `from` stands still.
    ///
    /// * `decay` – for each harmonic, what is left of a coefficient, and the factor of its rate of change
    #[inline(always)]
    fn advance<S: Register>(&self, from: &[Lanes], to: &mut [Lanes], decay: &[[Lanes; 2]]) {
        let mut start = 0;
        for (to, &(k, end)) in to.iter_mut().zip(&self.rows) {
            let mut rate = Wide::<S>::zero();
            // No fused operations: machines without them would take many times as long.
            for (column, value) in &self.entries[start..end] {
                rate += Wide::load(&from[*column as usize]) * Wide::splat(*value);
            }
            let [left, gain] = &decay[k];
            *to = (Wide::load(to) * Wide::load(left) + rate * Wide::load(gain)).store();
            start = end;
        }
    }
}

/// Follows x₁ along half the lag: even half a step, odd a step, even half a step. Of second order, and exact in
/// what decays fast.
struct Follow<'a> {
    generator: &'a Generator,
    noise: [f64; WIDTH],
    step: f64,
    /// Steps from one value to the next, and number of values.
    substeps: usize,
    values: usize,
}

impl Follow<'_> {
    /// Decay and gain of each harmonic over a length of fibre.
    fn decay(&self, length: f64) -> Vec<[Lanes; 2]> {
        let harmonics =
            self.generator.even.rows.iter().chain(&self.generator.odd.rows).map(|(k, _)| *k).max();
        let exponent = |k: usize, i: usize| -0.5 * self.noise[i] * (k * k) as f64 * length;
        let entry = |k: usize| {
            let left = Lanes::from_fn(|i| libm::exp(exponent(k, i)));
            let gain = |x: f64| if x == 0.0 { length } else { length * libm::expm1(x) / x };
            [left, Lanes::from_fn(|i| gain(exponent(k, i)))]
        };
        (0..=harmonics.unwrap_or(0)).map(entry).collect()
    }
}

impl Task for Follow<'_> {
    type Output = Vec<Lanes>;

    #[inline(always)]
    fn call<S: Register>(self) -> Vec<Lanes> {
        let Generator { even: to_even, odd: to_odd } = self.generator;
        let (half, whole) = (self.decay(0.5 * self.step), self.decay(self.step));
        let mut even = vec![Lanes::ZERO; to_even.rows.len()];
        let mut odd = vec![Lanes::ZERO; to_odd.rows.len()];
        even[0] = Lanes::splat(1.0);
        let mut values = vec![Lanes::splat(1.0)];
        for _ in 0..self.values {
            to_even.advance::<S>(&odd, &mut even, &half);
            for _ in 1..self.substeps {
                to_odd.advance::<S>(&even, &mut odd, &whole);
                to_even.advance::<S>(&odd, &mut even, &whole);
            }
            to_odd.advance::<S>(&even, &mut odd, &whole);
            to_even.advance::<S>(&odd, &mut even, &half);
            let squares = |values: &[Lanes]| sum_of_squares::<S>(values);
            values.push((squares(&even) - squares(&odd)).store());
        }
        values
    }
}

#[inline(always)]
fn sum_of_squares<S: Simd>(values: &[Lanes]) -> Wide<S> {
    let mut sum = Wide::<S>::zero();
    for x in values {
        let x = Wide::load(x);
        sum += x * x;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest difference of two sets of curves up to a lag of twelve, by lane.
    fn difference(a: &Correlations, b: &Correlations) -> [f64; WIDTH] {
        let mut largest = [0.0_f64; WIDTH];
        for lag in (0..=120).map(|i| f64::from(i) * 0.1) {
            let (a, b) = (a.at(lag), b.at(lag));
            for (i, largest) in largest.iter_mut().enumerate() {
                *largest = largest.max((a[i] - b[i]).abs());
            }
        }
        largest
    }

    /// `A²σ₁` for a relative noise.
    fn noises(other: f64, relative: [f64; 4]) -> [f64; WIDTH] {
        std::array::from_fn(|i| relative[i % 4] / other.sqrt())
    }

    #[test]
    fn order_of_the_error_of_the_size_is_as_documented() {
        for other in [1.0, 0.25, 4.0] {
            let at_least = [0.25, 0.4, 0.8, 2.0];
            let noises = noises(other, at_least);
            let fine = Correlations::with_step(5e-3, other, noises, 12.0, Size { degree: 44, harmonic: 12 });
            for ((i, noise), most) in at_least.iter().enumerate().zip([2e-3, 3e-4, 1e-4, 1e-5]) {
                let coarse = Correlations::with_step(5e-3, other, noises, 12.0, Size::for_noise(*noise));
                let found = difference(&coarse, &fine)[i];
                assert!(found < most, "{other} {noise}: {found:e}");
            }
        }
    }

    #[test]
    fn order_two_in_the_step() {
        for other in [1.0, 0.4, 2.5] {
            let noises = noises(other, [0.8, 2.0, 8.0, 40.0]);
            let correlations = |step: f64| {
                Correlations::with_step(step, other, noises, 12.0, Size { degree: 10, harmonic: 6 })
            };
            let exact = correlations(1e-3);
            let fine = correlations(0.00625);
            let coarse = correlations(0.025);
            let fine = difference(&fine, &exact);
            let coarse = difference(&coarse, &exact);
            for i in 0..4 {
                let order = (coarse[i] / fine[i]).ln() / 4.0_f64.ln();
                assert!((1.8..2.3).contains(&order), "{other} {i}: {order}, {:e}", coarse[i]);
                // The step that is used.
                assert!(coarse[i] < 6e-5, "{other} {i}: {:e}", coarse[i]);
            }
        }
    }
}
