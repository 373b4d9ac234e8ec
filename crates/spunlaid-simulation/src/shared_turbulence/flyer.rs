//! What flies layers, and shows how far they have come.

use super::BeamFindings;
use super::layer_beam::LayerBeam;
use crate::WebSpec;
use spunlaid_ground::threads::{lock, unlock};
use spunlaid_ground::{Error, Isa, Log, RunContext, Workers};
use spunlaid_web::Depositor;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64};

/// The flights of a case, to be watched.
#[derive(Clone, Copy, Debug)]
pub struct Flights<'a> {
    /// Path of the case.
    pub path: &'a Path,
    /// Number of fibres.
    pub fibres: u64,
    /// Steps of all fibres that have been done.
    pub done: &'a AtomicU64,
    /// Their number at the end; where it is not known yet, about so many.
    pub steps: u64,
    /// Time of a step [s].
    pub time_step: f64,
}

/// Shows the progress of a case's flights while it does the work that it is given.
pub(crate) type ProgressDisplay<'a> = &'a dyn Fn(Flights<'_>, &mut (dyn FnMut() + Send));

/// Makes the fibres of the layers.
pub struct Flyer<'a> {
    pub(super) threads: usize,
    pub(super) stop: &'a AtomicBool,
    pub(super) follow: ProgressDisplay<'a>,
    pub(super) kept: Option<&'a Log>,
}

impl std::fmt::Debug for Flyer<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Flyer").field("threads", &self.threads).finish_non_exhaustive()
    }
}

impl<'a> Flyer<'a> {
    /// * `stop` – set from elsewhere to stop early
    pub const fn new(threads: usize, stop: &'a AtomicBool, follow: ProgressDisplay<'a>) -> Self {
        Self { threads, stop, follow, kept: None }
    }

    /// Keeps the numbers of coarse sheets, and takes those that are kept in place of simulating them again.
    #[must_use]
    pub const fn keeping(self, kept: Option<&'a Log>) -> Self {
        Self { kept, ..self }
    }

    /// The threads that simulate.
    pub(super) const fn workers(&self) -> Workers<'a> {
        Workers { threads: self.threads, stop: self.stop }
    }

    /// Flies a layer and shows the progress.
    ///
    /// * `on` – what lays an element of fibre; None if only a few are simulated
    pub(super) fn fly_layer(
        &self,
        layer: &LayerBeam<'_>,
        spec: &WebSpec,
        on: Option<&Depositor<'_>>,
    ) -> Result<BeamFindings, Error> {
        let simulated = Mutex::new(None);
        let threads = self.threads;
        let stop = self.stop;
        self.watched(&[layer], |done| {
            let by = RunContext { threads, isa: Isa::detect(), stop, done };
            *lock(&simulated) = Some(layer.beam().fly(&layer.sheet, spec.window(), on, by)?);
            Ok(())
        })?;
        unlock(simulated).ok_or_else(Error::no_fibre)
    }
}
