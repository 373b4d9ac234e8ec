//! What a reading looks up beside the text of its file: data files, and tensions that flights have found.

use super::data::DataFiles;
use super::fed_back_tension::{FlownTension, flown_replicates, most_steps};
use super::open::OpenCase;
use crate::case::keys::Value;
use crate::case::{Case, Note};
use crate::error::Error;
use crate::study::Experiment;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;

/// Data files and tensions, and the tensions that are still to be found. The same reading goes on with them
/// when they are.
#[derive(Default)]
pub(super) struct Lookup {
    pub(super) files: DataFiles,
    /// By the identities of their cases; none of a speed that does not settle.
    tensions: BTreeMap<u64, Option<FlownTension>>,
    wanted: RefCell<BTreeMap<u64, WantedTension>>,
    unflown: Cell<usize>,
    in_doubt: Cell<bool>,
}

/// A case that has to fly for the tension at the end of its spinline.
pub(super) struct WantedTension {
    /// The same for cases of which the same fibres fly.
    pub(super) identity: u64,
    pub(super) open: OpenCase,
    /// Steps of all its fibres at most.
    pub(super) most_steps: u64,
}

impl Lookup {
    /// The checked case. If its tension is still to be found, it is noted as wanted, and the case is one with
    /// a tension of zero.
    ///
    /// # Errors
    /// Every reason why the case cannot be run.
    pub(super) fn resolve(&self, open: OpenCase) -> Result<(Case, Vec<Note>), Error> {
        if !open.waits_for_flights() {
            return open.resolve_at_once();
        }
        let (case, notes) = open.resolve_without()?;
        let (identity, most_steps) = (identity(&open, &case), most_steps(&case));
        if let Some(found) = self.tensions.get(&identity) {
            return open.resolve_with(*found);
        }
        self.unflown.set(self.unflown.get() + 1);
        self.wanted.borrow_mut().insert(identity, WantedTension { identity, open, most_steps });
        Ok((case, notes))
    }

    /// Number of tensions that are still to be found.
    pub(super) fn wanted(&self) -> usize {
        self.wanted.borrow().len()
    }

    /// How many cases have been handed out whose tension is still to be found.
    pub(super) fn unflown_cases(&self) -> usize {
        self.unflown.get()
    }

    /// Takes the wanted tensions out, the cases in an order that their values decide.
    pub(super) fn take_wanted(&mut self) -> Vec<WantedTension> {
        self.in_doubt.set(false);
        std::mem::take(self.wanted.get_mut()).into_values().collect()
    }

    /// Steps of all fibres at most that fly for the wanted tensions.
    pub(super) fn most_steps(&self) -> u64 {
        self.wanted.borrow().values().map(|wanted| wanted.most_steps).sum()
    }

    pub(super) fn add(&mut self, identity: u64, found: Option<FlownTension>) {
        self.tensions.insert(identity, found);
    }

    /// Notes that problems may go away when the wanted tensions are found.
    pub(super) fn doubt(&self) {
        self.in_doubt.set(true);
    }

    pub(super) fn is_in_doubt(&self) -> bool {
        self.in_doubt.get()
    }
}

/// A checksum over all on which the tension of a case depends: every number of it, and which of them are
/// written, because the others may follow from the speed.
///
/// * `case` – with a tension of zero
fn identity(open: &OpenCase, case: &Case) -> u64 {
    let mut sum = Checksum::default();
    sum.enter(&Experiment::Case(case.clone()).checksum().to_le_bytes());
    sum.enter(&flown_replicates(case.run.replicates).to_le_bytes());
    for (key, written) in open.key_values.all().filter(|(key, _)| *key != "run.replicates") {
        sum.enter(key.as_bytes());
        match &written.value {
            // What counts are their contents, which the case has.
            None | Some(Value::Paths(_)) => {}
            Some(value) => sum.enter(&value.bytes()),
        }
    }
    sum.0
}

/// The checksum FNV-1a.
struct Checksum(u64);

impl Default for Checksum {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Checksum {
    /// Enters some bytes, and where they end.
    fn enter(&mut self, bytes: &[u8]) {
        for byte in bytes.iter().chain(&(bytes.len() as u32).to_le_bytes()) {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    }
}
