//! Fibres in company: what each of them brings to a flight, and what all of them have in common.
//!
//! ```text
//! up to eight cases → Shared values (compared: equal in all lanes) ┐
//!                   → PerLane entries (one for each lane)          ┴→ chain, wind, stations, surroundings
//! ```
//!
//! A part of a flight is made from these two alone. There is no way to take one fibre's entry for all lanes,
//! so what all lanes read has been compared, and a fibre has the same bits whatever flies beside it. Studies
//! group their points by the same values.

use crate::error::Error;
use crate::lanes::{Lanes, WIDTH};
use std::array::from_fn;

/// What each fibre of a flight brings: an entry for each of up to eight lanes. Lanes left over repeat the first.
#[derive(Clone, Debug)]
pub struct PerLane<T>(Vec<T>);

impl<T> PerLane<T> {
    /// * `entries` – one to eight
    pub fn new(entries: Vec<T>) -> Result<Self, Error> {
        match entries.len() {
            0 => Err(Error::no_fibre()),
            1..=WIDTH => Ok(Self(entries)),
            fibres => Err(Error::flight(
                format!("{fibres} fibres cannot be simulated together"),
                format!("at most {WIDTH} are possible"),
            )),
        }
    }

    /// The entry of a lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> &T {
        &self.0[if lane < self.0.len() { lane } else { 0 }]
    }

    /// The entries without repetitions.
    pub fn iter(&self) -> std::slice::Iter<'_, T> {
        self.0.iter()
    }

    /// Number of entries without repetitions.
    pub fn fibres(&self) -> usize {
        self.0.len()
    }

    /// A number of each lane.
    pub fn lanes(&self, number: impl Fn(&T) -> f64) -> Lanes {
        Lanes::from_fn(|lane| number(self.lane(lane)))
    }

    /// A value of each lane.
    pub fn each<U>(&self, value: impl Fn(&T) -> U) -> [U; WIDTH] {
        from_fn(|lane| value(self.lane(lane)))
    }

    /// What follows from each.
    pub fn map<U>(&self, value: impl FnMut(&T) -> U) -> PerLane<U> {
        PerLane(self.0.iter().map(value).collect())
    }

    /// What follows from each together with the same fibre's entry of another kind.
    pub fn zip<U, V>(&self, other: &PerLane<U>, value: impl Fn(&T, &U) -> V) -> PerLane<V> {
        PerLane(self.0.iter().enumerate().map(|(lane, entry)| value(entry, other.lane(lane))).collect())
    }

    /// Whether something holds for any of them.
    pub fn any(&self, holds: impl Fn(&T) -> bool) -> bool {
        self.0.iter().any(holds)
    }

    /// What all of them have in common.
    ///
    /// # Errors
    /// If one differs from the first; the fault says in what.
    pub fn shared<S: CompanyKey>(&self, mut setting: impl FnMut(&T) -> S) -> Result<S, Error> {
        let first = setting(&self.0[0]);
        for (lane, other) in self.0.iter().enumerate().skip(1) {
            if let Some(what) = first.difference(&setting(other)) {
                return Err(Error::flight(
                    format!(
                        "fibre {} cannot be simulated together with the first: they differ in {what}",
                        lane + 1
                    ),
                    "fibres that are simulated together must agree in it",
                ));
            }
        }
        Ok(first)
    }
}

/// What fibres have in common if they fly side by side.
pub trait CompanyKey: Ord {
    /// In words, the first thing in which two differ.
    fn difference(&self, other: &Self) -> Option<&'static str>;

    /// Adds the words and the value of each part.
    fn add_parts(&self, to: &mut Vec<(&'static str, String)>);
}

impl<S: CompanyKey> CompanyKey for Option<S> {
    fn difference(&self, other: &Self) -> Option<&'static str> {
        match (self, other) {
            (Some(one), Some(other)) => one.difference(other),
            (None, None) => None,
            _ => Some("whether the fibre is fed (feed.speed, belt.distance, belt.speed)"),
        }
    }

    fn add_parts(&self, to: &mut Vec<(&'static str, String)>) {
        self.iter().for_each(|known| known.add_parts(to));
    }
}

/// A number that must be the same to the last bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Bits(u64);

impl Bits {
    /// The number.
    #[inline]
    pub const fn number(self) -> f64 {
        f64::from_bits(self.0)
    }
}

impl From<f64> for Bits {
    fn from(number: f64) -> Self {
        Self(number.to_bits())
    }
}

/// Declares a struct of shared values: `field: type = "words for it in a message"`, or without words where
/// the field is such a struct itself.
#[macro_export]
macro_rules! shared {
    ($(#[$about:meta])* $visible:vis struct $name:ident {
        $($(#[$attribute:meta])* $field:ident: $type:ty $(= $words:literal)?,)*
    }) => {
        $(#[$about])*
        #[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
        $visible struct $name { $($(#[$attribute])* $(#[doc = $words])? $visible $field: $type,)* }

        impl $crate::company::CompanyKey for $name {
            fn difference(&self, other: &Self) -> Option<&'static str> {
                $($crate::shared!(@compare &self.$field, &other.$field $(, $words)?);)*
                None
            }

            fn add_parts(&self, to: &mut Vec<(&'static str, String)>) {
                $($crate::shared!(@add &self.$field, to $(, $words)?);)*
            }
        }
    };
    (@compare $one:expr, $other:expr, $words:literal) => {
        if $one != $other {
            return Some($words);
        }
    };
    (@compare $one:expr, $other:expr) => {
        if let Some(words) = $crate::company::CompanyKey::difference($one, $other) {
            return Some(words);
        }
    };
    (@add $part:expr, $to:ident, $words:literal) => {
        $to.push(($words, format!("{:?}", $part)));
    };
    (@add $part:expr, $to:ident) => {
        $crate::company::CompanyKey::add_parts($part, $to);
    };
}
