//! Normal random numbers.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use std::f64::consts::PI;

/// Standard normal numbers by Box and Muller.
pub fn normal(seed: u64) -> impl FnMut() -> f64 {
    let mut stream = ChaCha8Rng::seed_from_u64(seed);
    move || {
        let mut uniform = || ((stream.next_u64() >> 11) as f64 + 0.5) * 2f64.powi(-53);
        (-2.0 * uniform().ln()).sqrt() * (2.0 * PI * uniform()).cos()
    }
}
