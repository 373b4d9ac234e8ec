//! The air: its flow, its turbulence and its properties.

mod flow;
mod numbers;
mod turbulence;

use crate::fibre::case::keys::Key;

/// The keys of the air, concern by concern.
pub(super) const KEYS: &[&[Key]] = &[flow::KEYS, numbers::KEYS, turbulence::KEYS];
