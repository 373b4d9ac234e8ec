//! A web of a line with some knobs turned, and what is known of it.

use super::flight::steps;
use super::laid::Laid;
use super::plan::WebState;
use spunlaid::experiment::advice::Look;
use spunlaid::experiment::{PlantNumber, plant_numbers};
use spunlaid::input::{Turn, TurnedLine, WebSpec};
use std::sync::Arc;

/// See the [module](self).
#[derive(Debug)]
pub(super) struct KnownWeb {
    /// Its number, by which pages call it.
    pub(super) number: u32,
    pub(super) turns: Vec<Turn>,
    pub(super) line: TurnedLine,
    pub(super) spec: Arc<WebSpec>,
    pub(super) plant: Vec<PlantNumber>,
    /// What the turned knobs are called.
    pub(super) label: String,
    /// Steps that it takes, about.
    pub(super) steps: u64,
    /// The last look at the coarse web.
    pub(super) coarse: Option<Look>,
    /// The last look at its comparison with the web of this number, and whether it is the last one of all.
    pub(super) compared: Option<(u32, Look, bool)>,
    pub(super) laid: Option<Laid>,
}

impl KnownWeb {
    /// A web of which nothing is known.
    pub(super) fn new(number: u32, turns: Vec<Turn>, line: TurnedLine) -> Self {
        let spec = Arc::new(line.spec.clone());
        let of_turn = |turn: &Turn| {
            let knob = line.knobs.iter().find(|knob| knob.name == turn.name)?;
            Some(format!("{} {}", knob.label, knob.dimension.pretty_to(turn.value, DIGITS)))
        };
        let labels: Vec<String> = turns.iter().filter_map(of_turn).collect();
        let label = if labels.is_empty() { "as in the file".to_owned() } else { labels.join(", ") };
        let (plant, steps) = (plant_numbers(&spec), steps(&spec));
        let (coarse, compared, laid) = (None, None, None);
        Self { number, turns, line, spec, plant, label, steps, coarse, compared, laid }
    }

    pub(super) fn state(&self) -> WebState {
        let (is_settled, is_laid) = (!self.line.needs_flights, self.laid.is_some());
        WebState { number: self.number, is_settled, is_laid }
    }

    /// The last look at its comparison with a web.
    pub(super) fn look_beside(&self, before: u32) -> Option<&Look> {
        self.compared.as_ref().filter(|(with, ..)| *with == before).map(|(_, look, _)| look)
    }

    /// Whether it has been compared with a web.
    pub(super) fn is_compared_with(&self, before: u32) -> bool {
        self.compared.as_ref().is_some_and(|(with, _, is_last)| *with == before && *is_last)
    }
}

/// Digits of a number on a page.
pub(super) const DIGITS: usize = 4;
