//! How much the guesses of a web matter.

use super::{Advice, Change, CvChange, Effect, all_webs, steps};
use crate::layers::{Method, WebSpec, fits_memory};
use crate::web::Findings;

/// Most steps of all fibres that are flown for guesses without being asked: some twenty seconds of a processor.
const fn most_steps(method: Method) -> u64 {
    match method {
        Method::Surrogate | Method::Dynamics => 4_000_000,
        Method::SharedAir => 20_000_000,
    }
}

/// Whether guesses are tried without being asked: there are some, their flights are short and fit into the memory, and a few filaments tell the web. Where all filaments in one air
/// are flown, whole webs would have to be compared.
pub fn are_tried(spec: &WebSpec, findings: &Findings, guesses: &[Change]) -> bool {
    let few = findings.laid.shared_air.as_ref().map(|together| together.few.len());
    let says_enough = few.is_none_or(|layers| layers == spec.layers.len());
    let fits = || spec.method != Method::SharedAir || fits_memory(&all_webs(spec, guesses));
    !guesses.is_empty() && says_enough && steps(spec, guesses) <= most_steps(spec.method) && fits()
}

impl Advice {
    /// The least and the greatest CV over patches of a size [m] among all that were tried and the web as it is, over that of the latter. What is
    /// within chance does not count.
    pub fn range(&self, patch: f64) -> [f64; 2] {
        let changes = self.effects.iter().filter_map(|effect: &Effect| effect.over(patch));
        changes.filter(|cv| cv.is_beyond_chance()).fold([1.0, 1.0], |[least, most], cv: &CvChange| {
            [least.min(1.0 + cv.change), most.max(1.0 + cv.change)]
        })
    }
}
