//! What is kept of simulations: a command that was interrupted goes on, and so does one that asks for a smaller error.
//!
//! ```text
//! FOLDER/kept of an earlier command → .FOLDER.kept, to which each simulation adds → FOLDER/kept, when all is found
//! ```

use super::counted;
use crate::delivery::Delivery;
use crate::failure::Failure;
use spunlaid::ground::Log;
use spunlaid::simulation::KEPT_SIMULATIONS;
use spunlaid_results::reports::web::KEPT;
use std::fs;
use std::path::PathBuf;

/// Numbers of simulations in a file next to the folder.
pub(super) struct Kept {
    file: PathBuf,
    pub(super) log: Log,
}

impl Kept {
    /// Opens the file, if there is a folder. Nothing here ends the command: what is not kept is simulated again.
    pub(super) fn open(delivery: &Delivery<'_>) -> Option<Self> {
        let folder = delivery.folder()?;
        let name = folder.file_name().unwrap_or_default().to_string_lossy();
        let file = folder.with_file_name(format!(".{name}.kept"));
        if !file.exists() {
            // It is no loss where there is none.
            drop(fs::copy(folder.join(KEPT), &file));
        }
        let log = Log::open(&file, KEPT_SIMULATIONS).ok()?;
        let is_whole = !log.torn && log.damaged == 0;
        if !log.keys().is_empty() || !is_whole {
            let torn = if is_whole { "" } else { "; what is torn or damaged is simulated again" };
            let count = log.keys().len() as u64;
            let simulations = counted(count, "simulation");
            let are = if count == 1 { "is" } else { "are" };
            delivery.line(&format!("going on: {simulations} of earlier commands {are} kept{torn}"));
        }
        Some(Self { file, log })
    }

    /// What a failure is where something is kept, from which the same command goes on.
    pub(super) fn after(kept: Option<&Self>, failure: Failure) -> Failure {
        match kept.map_or(0, |kept| kept.log.keys().len()) {
            0 => failure,
            count => failure.or_paused(count as u64, None, "simulation"),
        }
    }

    /// Moves the file into the folder, which has all else.
    pub(super) fn finish(self, delivery: &Delivery<'_>) {
        let is_kept = !self.log.keys().is_empty();
        let Some(staging) = delivery.staging().filter(|_| is_kept) else { return };
        if let Ok(content) = fs::read(&self.file)
            && staging.write(KEPT, content).is_ok()
        {
            drop(fs::remove_file(&self.file));
        }
    }
}

impl Drop for Kept {
    fn drop(&mut self) {
        if self.log.keys().is_empty() {
            drop(fs::remove_file(&self.file));
        }
    }
}
