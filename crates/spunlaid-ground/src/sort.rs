//! Sorts things by a number of each. The standard library compiles its sort again for every type of thing and
//! every closure, which is some 2,000 lines each time; this one is compiled once.

use std::cmp::Reverse;

/// A number by which things are sorted.
pub trait SortKey {
    /// An integer in the same order.
    fn rank(self) -> i64;
}

/// Sorts by a number, the smallest first; things of equal numbers keep their order.
pub fn sort_by_key<T, K: SortKey>(things: &mut [T], key: impl Fn(&T) -> K) {
    let mut places = places(&things.iter().map(|thing| key(thing).rank()).collect::<Vec<_>>());
    for i in 0..things.len() {
        while places[i] != i {
            let place = places[i];
            things.swap(i, place);
            places.swap(i, place);
        }
    }
}

/// The place of each number in the order of all.
fn places(ranks: &[i64]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..ranks.len()).collect();
    order.sort_by_key(|i| ranks[*i]);
    let mut places = vec![0; ranks.len()];
    for (place, i) in order.into_iter().enumerate() {
        places[i] = place;
    }
    places
}

/// In the order of [`f64::total_cmp`].
impl SortKey for f64 {
    fn rank(self) -> i64 {
        let bits = self.to_bits() as i64;
        // The greater a negative number is, the smaller are its bits without the sign.
        if bits < 0 { bits ^ i64::MAX } else { bits }
    }
}

impl SortKey for Reverse<f64> {
    fn rank(self) -> i64 {
        !self.0.rank()
    }
}

impl SortKey for usize {
    fn rank(self) -> i64 {
        self as i64
    }
}

impl SortKey for bool {
    fn rank(self) -> i64 {
        i64::from(self)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identical_to_the_sort_of_the_standard_library() {
        let mut state = 1u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            (state >> 60) as f64 - 7.5
        };
        let mut numbers: Vec<f64> = (0..200).map(|_| next()).collect();
        numbers.extend([f64::NAN, -f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 0.0, -0.0, 1e-310, -1e-310]);
        let things: Vec<(usize, f64)> = numbers.into_iter().enumerate().collect();
        // NaN is not equal to itself.
        let bits =
            |things: &[(usize, f64)]| things.iter().map(|(i, x)| (*i, x.to_bits())).collect::<Vec<_>>();
        let (mut ours, mut theirs) = (things.clone(), things.clone());
        sort_by_key(&mut ours, |thing| thing.1);
        theirs.sort_by(|a, b| a.1.total_cmp(&b.1));
        assert_eq!(bits(&ours), bits(&theirs));
        sort_by_key(&mut ours, |thing| Reverse(thing.1));
        theirs.sort_by(|a, b| b.1.total_cmp(&a.1));
        assert_eq!(bits(&ours), bits(&theirs));
        sort_by_key(&mut ours, |thing| thing.0);
        assert_eq!(bits(&ours), bits(&things));
        sort_by_key(&mut ours, |thing| thing.1 > 0.0);
        theirs = things;
        theirs.sort_by_key(|thing| thing.1 > 0.0);
        assert_eq!(bits(&ours), bits(&theirs));
    }
}
