//! Does what pages ask, or refuses it and says why.

use super::Session;
use super::document::Document;
use super::measured::Statistics;
use super::start::adapt_to_clock;
use super::tension::TensionSearch;
use crate::board::PageId;
use crate::message::{Answer, Command, KeyValue, Receives, diagnostics};
use crate::save;
use spunlaid::fibre::case::keys::{self, Key, Kind};
use spunlaid::ground::Dimension;
use std::collections::BTreeSet;
use std::time::Instant;

/// Digits of a number of a slider, in the unit in which it is shown.
const DIGITS: usize = 3;

impl Receives for Session {
    fn next_generation(&self) -> u32 {
        self.generation + 1
    }

    fn pages(&mut self) -> &mut BTreeSet<PageId> {
        &mut self.pages
    }

    fn dispatch(&mut self, command: &Command) -> Result<Option<Answer>, Answer> {
        match command {
            Command::Set { key, value, stamp } => {
                let document = self.with(key, value)?;
                self.become_of(document)?;
                return Ok(Some(Answer::Applied { stamp: *stamp, generation: self.generation }));
            }
            Command::Case { text } => self.become_of(self.document.with_text(text.clone()))?,
            Command::Filament { text } => self.fly_filament(text.clone()),
            Command::Pace { pace } => {
                self.clock.pace = *pace;
                self.clock.begin(Instant::now());
            }
            Command::Pause {} => self.stands = true,
            Command::Go {} => {
                (self.stands, self.trouble) = (false, None);
                self.clock.begin(Instant::now());
            }
            Command::Step {} => {
                self.stands = true;
                self.step();
            }
            Command::Reset {} => {
                self.fibres.reset().map_err(|error| Answer::rejected(diagnostics(&error)))?;
                self.since = 0.0;
                self.restart_statistics();
            }
            Command::Forget {} => self.changed(),
            Command::Look { .. } => {}
            Command::Pin {} | Command::Back { .. } | Command::Confirm {} | Command::Preview { .. } => {
                return Err(Answer::refused(
                    "the page of a fibre makes no comparisons; the page of a line does",
                ));
            }
            Command::Save { name, replace } => {
                let name = save::plain_name(name).map_err(Answer::refused)?;
                let text = self.document.to_save();
                save::save(&self.folder, &name, &text, *replace)?;
                self.document = Document::saved(&name, text);
                return Ok(Some(Answer::Saved { name }));
            }
        }
        Ok(None)
    }
}

impl Session {
    /// Simulates the filament of a line as its knobs are now. If that is not possible, a note says why, and the one
    /// before stays.
    fn fly_filament(&mut self, text: String) {
        let adapted = adapt_to_clock(self.document.with_text(text)).map_err(Answer::rejected);
        let simulated = adapted.and_then(|(document, remark)| {
            self.become_of(document)?;
            self.remark = remark;
            Ok(())
        });
        if let Err(answer) = simulated {
            self.notes =
                vec![format!("the filament of the line as it is now cannot be shown: {}", answer.words())];
        }
    }

    /// The document with another value of a key.
    fn with(&self, name: &str, value: &KeyValue) -> Result<Document, Answer> {
        let key = keys::named(name).map_err(|problem| Answer::refused(problem.to_string()))?;
        let refused = Answer::rejected;
        let written = toml_of(key, value).map_err(Answer::refused)?;
        let mut document = self.document.with(key, Some(written)).map_err(refused)?;
        for other in keys::CASE.replaced_by(&[key.name]).into_iter().filter_map(keys::find) {
            if document.gives(other.table(), other.short()) {
                document = document.with(other, None).map_err(refused)?;
            }
        }
        Ok(document)
    }

    pub(super) fn become_of(&mut self, document: Document) -> Result<(), Answer> {
        let refused = Answer::rejected;
        let read = document.read().map_err(refused)?;
        let (since, waits) = (self.now(), read.case.waits_for_flights());
        let is_replaced = self.fibres.become_of(read.case).map_err(|error| refused(diagnostics(&error)))?;
        (self.document, self.notes, self.trouble) = (document, read.warnings, None);
        // A search for the tension of the case before is of no use any more.
        self.search = waits.then(|| TensionSearch::begin(&self.document));
        if is_replaced {
            self.since = since;
            self.restart_statistics();
        } else {
            self.changed();
        }
        Ok(())
    }

    pub(super) fn restart_statistics(&mut self) {
        self.recent_motion.clear_belt();
        self.trouble = None;
        self.changed();
    }

    /// Begins the statistics of the next generation.
    pub(super) fn changed(&mut self) {
        self.generation = self.generation.wrapping_add(1);
        self.measured = Statistics::new(self.fibres.case(), self.fibres.flight());
        self.clock.begin(Instant::now());
    }
}

/// A value as a case file has it: a number gets the unit of its key.
fn toml_of(key: &Key, value: &KeyValue) -> Result<toml_edit::Value, String> {
    match (value, &key.kind) {
        (KeyValue::Number(number), _) if !number.is_finite() => Err("the number is not finite".to_owned()),
        (KeyValue::Number(number), Kind::Quantity(Dimension::Ratio, _)) => {
            let rounded = Dimension::Ratio.pretty_to(*number, DIGITS);
            Ok(rounded.parse().unwrap_or(*number).into())
        }
        (KeyValue::Number(number), Kind::Quantity(dimension, _)) => {
            Ok(dimension.pretty_to(*number, DIGITS).into())
        }
        (KeyValue::Number(number), Kind::Whole(..))
            if number.fract() == 0.0 && (0.0..9e15).contains(number) =>
        {
            Ok((*number as i64).into())
        }
        (KeyValue::Text(text), Kind::Quantity(Dimension::Ratio, _)) => {
            Ok(text.trim().parse::<f64>().map_or_else(|_| text.trim().into(), Into::into))
        }
        (KeyValue::Text(text), Kind::Whole(..)) => {
            Ok(text.trim().parse::<i64>().map_or_else(|_| text.trim().into(), Into::into))
        }
        (KeyValue::Text(text), _) => Ok(text.trim().into()),
        _ => Err(format!("{} takes {}", key.name, key.allowed())),
    }
}
