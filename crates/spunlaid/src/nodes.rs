//! A list along the chain.

use std::ops::{Deref, DerefMut};

/// A list along the chain, from the root to the end. It grows at the root, where fibre is fed, and shrinks at the end,
/// where fibre is laid down; both take a constant time on average.
#[derive(Clone, Debug, Default)]
pub struct Nodes<T> {
    /// Room for entries to come, then the entries.
    buffer: Vec<T>,
    first: usize,
}

impl<T: Copy> Nodes<T> {
    /// Puts an entry before the first.
    pub(crate) fn push_root(&mut self, entry: T) {
        if self.first == 0 {
            // What the end has left free is used again.
            let (entries, room) = (self.buffer.len(), self.buffer.len() / 4 + 64);
            // Thousands of chains fly at once, so no more than that.
            self.buffer.reserve_exact(room);
            self.buffer.resize(entries + room, entry);
            self.buffer.copy_within(..entries, room);
            self.first = room;
        }
        self.first -= 1;
        self.buffer[self.first] = entry;
    }

    /// Keeps so many entries from the root on.
    pub(crate) fn truncate(&mut self, entries: usize) {
        self.buffer.truncate(self.first + entries);
    }
}

impl<T> From<Vec<T>> for Nodes<T> {
    fn from(buffer: Vec<T>) -> Self {
        Self { buffer, first: 0 }
    }
}

impl<T> FromIterator<T> for Nodes<T> {
    fn from_iter<I: IntoIterator<Item = T>>(entries: I) -> Self {
        Vec::from_iter(entries).into()
    }
}

impl<T> Deref for Nodes<T> {
    type Target = [T];

    #[inline(always)]
    fn deref(&self) -> &[T] {
        &self.buffer[self.first..]
    }
}

impl<T> DerefMut for Nodes<T> {
    #[inline(always)]
    fn deref_mut(&mut self) -> &mut [T] {
        &mut self.buffer[self.first..]
    }
}

impl<'a, T> IntoIterator for &'a Nodes<T> {
    type Item = &'a T;
    type IntoIter = std::slice::Iter<'a, T>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// Values along the chain: one for each place, or a single one where all places are alike.
#[derive(Clone, Debug)]
pub(crate) struct ChainValues<T> {
    values: Nodes<T>,
    /// From the value of one place to that of the next: 0 or 1.
    stride: usize,
}

impl<T: Copy + PartialEq> ChainValues<T> {
    /// * `count` – number of places
    /// * `value` – of each place
    pub(crate) fn new(count: usize, value: impl Fn(usize) -> T) -> Self {
        let first = value(0);
        if (1..count).all(|i| value(i) == first) {
            return Self { values: vec![first].into(), stride: 0 };
        }
        Self { values: (0..count).map(value).collect(), stride: 1 }
    }

    /// The value of a place.
    #[inline(always)]
    pub(crate) fn at(&self, i: usize) -> &T {
        self.view().at(i)
    }

    /// The values for a loop along the chain.
    #[inline(always)]
    pub(crate) fn view(&self) -> View<'_, T> {
        View { values: &self.values, stride: self.stride }
    }

    /// Whether all places are alike.
    pub(crate) fn is_uniform(&self) -> bool {
        self.stride == 0
    }

    /// Puts a place like the first before it.
    pub(crate) fn push_root(&mut self) {
        if !self.is_uniform() {
            self.values.push_root(self.values[0]);
        }
    }

    /// Keeps so many places from the root on.
    pub(crate) fn truncate(&mut self, count: usize) {
        if !self.is_uniform() {
            self.values.truncate(count);
        }
    }
}

/// [`ChainValues`] in a loop, where its parts stay in registers.
pub(crate) struct View<'a, T> {
    values: &'a [T],
    stride: usize,
}

impl<'a, T> View<'a, T> {
    /// The value of a place.
    #[inline(always)]
    pub(crate) fn at(&self, i: usize) -> &'a T {
        &self.values[i * self.stride]
    }
}
