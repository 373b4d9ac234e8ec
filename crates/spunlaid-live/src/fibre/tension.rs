//! The tension at the end of the spinline, which flights find in a thread of their own while the fibres of
//! the page fly on.

use super::Session;
use super::document::Document;
use crate::message::diagnostics;
use spunlaid::ground::{Error, Isa, RunContext};
use spunlaid::input::{CaseWithNotes, Resources};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, mpsc};
use std::thread;

/// Flights that look for a tension. They stop when nobody waits for them any more.
pub(super) struct TensionSearch {
    found: mpsc::Receiver<Result<CaseWithNotes, Error>>,
    stop: Arc<AtomicBool>,
}

impl TensionSearch {
    /// Begins to fly.
    pub(super) fn begin(document: &Document) -> Self {
        let (document, (sender, found)) = (document.clone(), mpsc::channel());
        let stop = Arc::new(AtomicBool::new(false));
        let stopped = Arc::clone(&stop);
        thread::spawn(move || {
            // Who does not wait for it any more does not hear it.
            let _ = sender.send(fly(&document, &stopped));
        });
        Self { found, stop }
    }

    /// The case with the tension, or why there is none; nothing as long as it flies.
    fn ended(&self) -> Option<Result<CaseWithNotes, Error>> {
        match self.found.try_recv() {
            Ok(found) => Some(found),
            Err(mpsc::TryRecvError::Empty) => None,
            // The thread has panicked, and said why.
            Err(mpsc::TryRecvError::Disconnected) => Some(Err(Error::Interrupted)),
        }
    }
}

impl Drop for TensionSearch {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

fn fly(document: &Document, stop: &AtomicBool) -> Result<CaseWithNotes, Error> {
    let by = RunContext { threads: 1, isa: Isa::detect(), stop, done: &AtomicU64::new(0) };
    Resources::default().resolve_tension(|resources| document.case(resources), |resources| resources.fly(by))
}

impl Session {
    /// Writes the tension into the case when flights have found it; if they cannot, the fibres fly on without it.
    pub(super) fn take_tension(&mut self) {
        let Some(ended) = self.search.as_ref().and_then(TensionSearch::ended) else { return };
        self.search = None;
        let found = ended.map_err(|error| diagnostics(&error)).map(|(case, _)| {
            let document = self.document.with_tension_of_flights(&case);
            document.map_or(Ok(()), |document| self.become_of(document))
        });
        let why = match found {
            Ok(Ok(())) => None,
            Ok(Err(answer)) => Some(answer.words()),
            Err(diagnostics) => {
                Some(diagnostics.into_iter().map(|one| one.text).collect::<Vec<_>>().join("; "))
            }
        };
        if why.is_some() {
            self.trouble = why;
        }
        self.show_all();
    }
}
