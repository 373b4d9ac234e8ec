//! A web of a line with some knobs turned, and what is known of it.

use super::flight::steps;
use super::laid::Laid;
use super::plan::{Air, WebState};
use spunlaid::experiment::advice::Look;
use spunlaid::experiment::{PlantNumber, plant_numbers};
use spunlaid::input::{Turn, TurnedLine, WebSpec};
use std::sync::Arc;

/// A comparison of a web with the web of a number.
#[derive(Debug)]
pub(super) struct Comparison {
    pub(super) before: u32,
    /// The last look at both.
    pub(super) look: Option<Look>,
    /// Whether there will be no other look.
    pub(super) is_done: bool,
}

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
    /// Its comparisons in the air of the file and in another one.
    comparisons: [Option<Comparison>; 2],
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
        Self {
            number,
            turns,
            line,
            spec,
            plant,
            label,
            steps,
            coarse: None,
            comparisons: [None, None],
            laid: None,
        }
    }

    pub(super) fn state(&self) -> WebState {
        let (is_settled, is_laid) = (!self.line.needs_flights, self.laid.is_some());
        WebState { number: self.number, is_settled, is_laid }
    }

    /// Its comparison with a web in an air, if that has begun or is asked for.
    pub(super) fn comparison(&self, air: Air, before: u32) -> Option<&Comparison> {
        self.comparisons[air as usize].as_ref().filter(|one| one.before == before)
    }

    /// Begins its comparison with a web in an air, or goes on with it.
    pub(super) fn compare(&mut self, air: Air, before: u32) -> &mut Comparison {
        let of_air = &mut self.comparisons[air as usize];
        if of_air.as_ref().is_none_or(|one| one.before != before) {
            *of_air = None;
        }
        of_air.get_or_insert(Comparison { before, look: None, is_done: false })
    }

    /// Forgets its comparison in an air.
    pub(super) fn forget_comparison(&mut self, air: Air) {
        self.comparisons[air as usize] = None;
    }

    /// The last look at its comparison with a web in an air.
    pub(super) fn look_beside(&self, air: Air, before: u32) -> Option<&Look> {
        self.comparison(air, before)?.look.as_ref()
    }
}

/// Digits of a number on a page.
pub(super) const DIGITS: usize = 4;
