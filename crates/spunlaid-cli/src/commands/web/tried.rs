//! What changes do to a web.

use super::counted;
use crate::delivery::Delivery;
use crate::failure::Failure;
use crate::{progress, say};
use spunlaid::experiment::advice::{advise, steps};
use spunlaid::experiment::{Advice, Change};
use spunlaid::ground::{Error, Log, RunContext};
use spunlaid_results::reports::web::WebFolder;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// What changes do to a web; nothing if that cannot be found, which is reported. If it is interrupted, the web
/// and what was tried before stay in their folder.
pub(super) fn try_changes(
    changes: Vec<Change>,
    [noun, of, without]: [&str; 3],
    web: &mut WebFolder,
    judged_by: Option<f64>,
    kept: Option<&Log>,
    by: RunContext<'_>,
    delivery: &mut Delivery<'_>,
) -> Result<Option<Advice>, Failure> {
    let label = format!("trying {} of {of}", counted(changes.len() as u64, noun));
    let begun = Instant::now();
    let done = AtomicU64::new(0);
    let spec = &web.file.spec;
    let (all, by) = (steps(spec, &changes), RunContext { done: &done, ..by });
    let work = || advise(spec, &web.simulated.web, &web.findings, changes, judged_by, kept, by);
    match progress::follow(&done, all, &label, delivery.is_quiet(), work) {
        Err(Error::Interrupted) => {
            by.stop.store(false, Ordering::Relaxed);
            web.awaited = false;
            delivery.rewrite(web)?;
            Err(Failure::Kept { folder: delivery.folder().map(Path::to_owned) })
        }
        Err(error) => {
            say::warning(&format!("{label} of {} failed: {error}", web.name));
            Ok(None)
        }
        Ok(advice) => {
            let seconds = begun.elapsed().as_secs_f64();
            delivery.line(&format!("{label} took {seconds:.2} s; {without} leaves it out"));
            Ok(Some(advice))
        }
    }
}
