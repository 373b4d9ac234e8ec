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
    pub fn push_root(&mut self, entry: T) {
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
    pub fn truncate(&mut self, entries: usize) {
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
