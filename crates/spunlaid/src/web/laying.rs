//! What lays a web: threads, instruction set, how it is watched and stopped.

use crate::lanes::Isa;
use std::sync::atomic::{AtomicBool, AtomicU64};
use std::time::Duration;

/// Threads and instruction set of the computation, its progress and its stop flag.
#[derive(Clone, Copy, Debug)]
pub struct LayControl<'a> {
    /// Number of threads. The map does not depend on it.
    pub threads: usize,
    /// Instruction set. The map does not depend on it.
    pub isa: Isa,
    /// Ends the laying when it is set.
    pub stop: &'a AtomicBool,
    /// Grows by the pieces of filaments that have been laid; [`pieces`] says how many there are.
    pub laid: &'a AtomicU64,
}

/// Time that a computation took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TimeSpent {
    /// All of it.
    pub whole: Duration,
    /// The parts that are shared among threads.
    pub in_parallel: Duration,
}
