//! Does what pages ask, or refuses it and says why.

use super::Session;
use super::knobs::value_of;
use super::known_web::KnownWeb;
use super::plan::Air;
use super::show::of_plant;
use crate::board::PageId;
use crate::message::{Answer, Command, KeyValue, Receives, diagnostics};
use crate::save;
use spunlaid::experiment::plant_numbers;
use spunlaid::ground::Error;
use spunlaid::input::{LineFile, Turn, TurnedLine, WebSpec, read_line};
use std::collections::BTreeSet;

/// Webs that are remembered, with the present one and that of comparison.
const REMEMBERED: usize = 8;
/// Relative difference up to which a knob is where it was.
const SAME: f64 = 1e-9;
/// Knobs of the belt: of these the last one that was turned counts, so a turn to the value of the file means something.
const OF_BELT: [&str; 2] = ["belt_speed", "basis_weight"];

impl Receives for Session {
    fn next_generation(&self) -> u32 {
        self.picture.generation + 1
    }

    fn pages(&mut self) -> &mut BTreeSet<PageId> {
        &mut self.pages
    }

    fn dispatch(&mut self, command: &Command) -> Result<Option<Answer>, Answer> {
        match command {
            Command::Set { key, value, stamp } => {
                self.turn(key, value)?;
                return Ok(Some(Answer::Applied { stamp: *stamp, generation: self.picture.generation }));
            }
            Command::Preview { key, value, stamp } => {
                let (_, line) = self.turned(key, value)?;
                let before = self.web(self.before);
                let numbers = if line.needs_flights { Vec::new() } else { plant_numbers(&line.spec) };
                let plant = numbers.iter().map(|number| of_plant(number, before)).collect();
                let generation = self.picture.generation;
                return Ok(Some(Answer::Preview { stamp: *stamp, generation, plant }));
            }
            Command::Pause {} => self.stands = true,
            Command::Go {} => {
                self.stands = false;
                self.forget_failures();
            }
            Command::Reset {} => self.show_web(self.before),
            Command::Pin {} => {
                self.before = self.now;
                self.slopes.clear();
                self.tried = None;
                self.show_web(self.now);
            }
            Command::Confirm {} => self.confirm()?,
            Command::Back { to } => {
                if !self.webs.iter().any(|web| web.number == *to) {
                    return Err(Answer::refused(
                        "this answer is no longer stored; change the settings again",
                    ));
                }
                self.show_web(*to);
            }
            Command::Save { name, replace } => return self.save(name, *replace).map(Some),
            Command::Look { .. } => {}
            Command::Case { .. }
            | Command::Filament { .. }
            | Command::Pace { .. }
            | Command::Step {}
            | Command::Forget {} => {
                return Err(Answer::refused(
                    "the page of a line has no such message; the page of a fibre does",
                ));
            }
        }
        Ok(None)
    }
}

impl Session {
    /// Asks for the change of the present web in another air.
    fn confirm(&mut self) -> Result<(), Answer> {
        let (before, now) = (self.before, self.now);
        let is_known = |web: &KnownWeb| {
            web.look_beside(Air::OfFile, before).is_some_and(|look| !look.changes.is_empty())
        };
        match self.web_mut(now).filter(|web| web.number != before && is_known(web)) {
            Some(web) => web.compare(Air::Other, before),
            None => {
                let text = "there is no change to confirm; change a setting and wait for the first result";
                return Err(Answer::refused(text));
            }
        };
        self.forget_failures();
        Ok(())
    }

    /// Turns a knob.
    fn turn(&mut self, name: &str, value: &KeyValue) -> Result<(), Answer> {
        let (turns, line) = self.turned(name, value)?;
        if let Some(known) = self.webs.iter().find(|web| web.line.set == line.set) {
            self.show_web(known.number);
            return Ok(());
        }
        self.last_number += 1;
        self.webs.push(KnownWeb::new(self.last_number, turns, line));
        self.show_web(self.last_number);
        Ok(())
    }

    /// The present line with another value of a knob, and how its knobs are turned then.
    fn turned(&self, name: &str, value: &KeyValue) -> Result<(Vec<Turn>, TurnedLine), Answer> {
        let refused = |error: Error| Answer::rejected(diagnostics(&error));
        let knobs = &self.web(self.before).line.knobs;
        let Some(knob) = knobs.iter().find(|knob| knob.name == name) else {
            let names: Vec<&str> = knobs.iter().map(|knob| knob.name.as_str()).collect();
            return Err(Answer::refused(format!(
                "there is no knob \"{name}\"; there are {}",
                names.join(", ")
            )));
        };
        let value =
            value_of(knob, value).map_err(|fault| Answer::refused(format!("{} {fault}", knob.label)))?;
        let written = self.file.knobs().into_iter().find(|knob| knob.name == name).map(|knob| knob.value);
        let mut turns = self.web(self.now).turns.clone();
        turns.retain(|turn| turn.name != name);
        let is_written = written.is_some_and(|written| (value / written - 1.0).abs() < SAME);
        if !is_written || (OF_BELT.contains(&name) && !turns.is_empty()) {
            turns.push(Turn { name: name.to_owned(), value });
        }
        let line = self.file.turned(&turns, &self.resources).map_err(refused);
        // The thread that simulates finds a tension, with resources of its own.
        self.resources.forget_wanted();
        let line = line?;
        Ok((turns, line))
    }

    /// Makes a web the present one. The last ones that were are remembered.
    fn show_web(&mut self, number: u32) {
        self.now = number;
        if let Some(place) = self.webs.iter().position(|web| web.number == number) {
            let web = self.webs.remove(place);
            self.webs.push(web);
        }
        if self.webs.len() > REMEMBERED
            && let Some(oldest) = self.webs.iter().position(|web| web.number != self.before)
        {
            self.webs.remove(oldest);
        }
        self.picture.generation = self.picture.generation.wrapping_add(1);
        self.forget_failures();
        self.show_filaments();
    }

    fn forget_failures(&mut self) {
        self.failed.clear();
        self.trouble = None;
        self.no_sketch = None;
    }

    /// Writes the line with its knobs as they are.
    fn save(&mut self, name: &str, replace: bool) -> Result<Answer, Answer> {
        let name = save::plain_name(name).map_err(Answer::refused)?;
        let line = &self.web(self.now).line;
        // From another folder its files may be others, or none.
        let saved = read_line(&line.text, &name, &self.resources);
        // Numbers that are not known are NaN, and equal to nothing.
        let is_same = |saved: LineFile| cases_of(saved.spec()) == cases_of(&line.spec);
        if self.is_elsewhere && !saved.is_ok_and(is_same) {
            let text = "the line names files next to it, which a file in this folder would not find; start \
                `spunlaid live` in the folder of the line";
            return Err(Answer::refused(text));
        }
        save::save(&self.folder, &name, &line.text, replace)?;
        self.save_name = self.free_name();
        Ok(Answer::Saved { name })
    }
}

/// The cases of a web, as a text that differs where they do.
fn cases_of(spec: &WebSpec) -> String {
    format!("{:?}", spec.cases().collect::<Vec<_>>())
}
