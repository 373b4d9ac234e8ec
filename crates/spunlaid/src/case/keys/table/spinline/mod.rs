//! The spinline and the constants of its polymer.

mod access;
mod air;
mod curtain;
mod end;
mod line;
mod material;
mod thread;

use crate::case::keys::Key;

/// The keys of the spinline, concern by concern.
pub(super) const KEYS: &[&[Key]] = &[line::KEYS, air::KEYS, end::KEYS, thread::KEYS, curtain::KEYS];
/// The constants of the polymer.
pub(super) const MATERIAL: &[&[Key]] = &[material::KEYS];
