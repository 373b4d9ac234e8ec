//! Random numbers by key: equal keys give equal streams, bit for bit, and ChaCha makes those of neighbouring keys
//! independent.
//!
//! Whoever asks keeps its keys apart from those of the others: a wind has a component, 0 to 2, in the low bits of the
//! last word, a path of a surrogate 3 in all of it, a field of eddies its highest bit, a study all of them.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// The stream of a key.
pub fn stream(words: [u64; 4]) -> ChaCha8Rng {
    let mut key = [0; 32];
    for (bytes, word) in key.chunks_exact_mut(8).zip(words) {
        bytes.copy_from_slice(&word.to_le_bytes());
    }
    ChaCha8Rng::from_seed(key)
}

/// A random number from 0 to below 1.
pub fn uniform(random: &mut impl Rng) -> f64 {
    (random.next_u64() >> 11) as f64 * (0.5 * f64::EPSILON)
}
