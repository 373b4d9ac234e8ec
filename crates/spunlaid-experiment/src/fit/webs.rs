//! The simulated webs of each trial, laid or read from the journal.

use super::parameter::Parameter;
use super::simulator::Simulator;
use super::target::Target;
use super::weights::mean_of;
use crate::study::{Journal, Record, ReplicateOutcome};
use spunlaid_ground::Error;

/// A trial: values of the keys, and the numbers of the webs that were laid with them.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    /// Coordinates of the values.
    pub(super) coordinates: Vec<f64>,
    /// The values [SI].
    pub(super) values: Vec<f64>,
    /// Logarithms of the numbers of each web.
    pub(super) webs: Vec<Vec<f64>>,
    /// Their mean.
    pub(super) mean: Vec<f64>,
}

/// What is being laid.
#[derive(Clone, Copy, Debug)]
pub struct WebInProgress<'a> {
    /// Number of the trial, from 1; those that cannot be laid count too.
    pub trial: usize,
    /// Number of its web, from 1.
    pub web: u64,
    /// Number of webs of each trial.
    pub webs: u64,
    /// The values of the trial [SI].
    pub values: &'a [f64],
}

/// Most trials of a fit, with those that cannot be laid.
pub const MOST_TRIALS: usize = 200;

/// The webs of trials.
pub(super) struct Webs<'a> {
    pub(super) parameters: &'a [Parameter],
    pub(super) target: &'a Target,
    pub(super) simulator: &'a mut dyn Simulator,
    /// Of each trial.
    pub(super) count: u64,
    pub(super) journal: &'a mut Journal,
    pub(super) watch: &'a dyn Fn(WebInProgress<'_>),
    pub(super) trials: Vec<Trial>,
    /// Sensitivity that could not be laid, and why the last of them could not.
    pub(super) refused: Vec<(Vec<f64>, Error)>,
}

impl<'a> Webs<'a> {
    /// No webs yet.
    ///
    /// * `count` – of the webs of each trial
    pub(super) fn new(
        parameters: &'a [Parameter],
        target: &'a Target,
        simulator: &'a mut dyn Simulator,
        count: u64,
        journal: &'a mut Journal,
        watch: &'a dyn Fn(WebInProgress<'_>),
    ) -> Self {
        let (trials, refused) = (Vec::new(), Vec::new());
        Self { parameters, target, simulator, count, journal, watch, trials, refused }
    }

    /// The values at some coordinates.
    pub(super) fn values(&self, at: &[f64]) -> Vec<f64> {
        self.parameters.iter().zip(at).map(|(parameter, at)| parameter.value(*at)).collect()
    }

    /// The index of the trial at these coordinates. None if the web cannot be laid with these values.
    ///
    /// # Errors
    /// If it is stopped, if the journal cannot be used, or if there are too many trials.
    pub(super) fn trial(&mut self, at: &[f64]) -> Result<Option<usize>, Error> {
        let at: Vec<f64> =
            self.parameters.iter().zip(at).map(|(parameter, at)| parameter.taken(*at)).collect();
        let values = self.values(&at);
        if let Some(known) = self.trials.iter().position(|trial| trial.values == values) {
            return Ok(Some(known));
        }
        if self.refused.iter().any(|(refused, _)| *refused == values) {
            return Ok(None);
        }
        let index = self.trials.len() + self.refused.len();
        if index >= MOST_TRIALS {
            let message = format!("has not come to an end after {MOST_TRIALS} trials");
            return Err(Error::flight(message, "seek fewer keys, or give them narrower ranges"));
        }
        match self.lay(index, &values) {
            Ok(webs) => {
                let mean = mean_of(webs.iter());
                self.trials.push(Trial { coordinates: at, values, webs, mean });
                Ok(Some(self.trials.len() - 1))
            }
            // Another value of a key may do.
            Err(error) if error.is_of_values() => {
                self.refused.push((values, error));
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// Why no web can be laid at some coordinates, which were tried.
    pub(super) fn refusal(&mut self, at: &[f64]) -> Option<Error> {
        let values = self.values(at);
        let place = self.refused.iter().position(|(refused, _)| *refused == values)?;
        Some(self.refused.swap_remove(place).1)
    }

    /// The numbers of all webs of these values.
    ///
    /// * `index` – of the trial in the journal
    fn lay(&mut self, index: usize, values: &[f64]) -> Result<Vec<Vec<f64>>, Error> {
        self.simulator.set(values)?;
        let known = self.journal.records(index, self.count)?;
        let mut webs = Vec::with_capacity(self.count as usize);
        for replicate in 0..self.count {
            let journaled = known.iter().find(|record| record.replicate == replicate);
            if let Some(measured) = journaled.and_then(|record| record.outcome.measured()) {
                webs.push(measured.to_vec());
                continue;
            }
            (self.watch)(WebInProgress { trial: index + 1, web: replicate + 1, webs: self.count, values });
            let numbers = self.simulator.web(replicate)?;
            let outcome = ReplicateOutcome::Measured(numbers.clone().into_boxed_slice());
            self.journal.add(&[Record { point: index as u64, replicate, outcome }])?;
            webs.push(numbers);
        }
        Ok(webs)
    }
}
