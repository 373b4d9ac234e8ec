//! What pages see: frames, and as JSON the settings, the state and the statistics.

use super::Session;
use crate::live::board::Topic;
use crate::live::frame::Frame;
use crate::live::message::Pace;
use crate::live::settings::{Setting, SettingValue, present, settings};
use serde::Serialize;
use spunlaid::case::Case;
use spunlaid::chain::schemes::Scheme;
use spunlaid::fibre::Root;
use spunlaid::lanes::WIDTH;
use spunlaid::units::Dimension;
use spunlaid_results::output::spinline::filament;
use std::time::Instant;

/// The state of the flight, as pages get it.
#[derive(Serialize)]
#[serde(tag = "is", rename = "state")]
struct State<'a> {
    generation: u32,
    title: String,
    text: &'a str,
    command: String,
    values: Vec<SettingValue>,
    notes: &'a [String],
    remark: Option<&'a String>,
    /// What a fed case says of its filament.
    filament: Vec<String>,
    trouble: &'a Option<String>,
    pace: Pace,
    stands: bool,
    scheme: &'static str,
    step: String,
    /// Time from one recorded instant to the next.
    instant: String,
    length_mm: f64,
    held: bool,
    air: f64,
    gravity: f64,
    cutoff: f64,
    belt: Option<Belt>,
}

#[derive(Serialize)]
struct Belt {
    speed: f64,
    feed: f64,
}

#[derive(Serialize)]
#[serde(tag = "is", rename = "settings")]
struct SettingsMessage {
    settings: Vec<Setting>,
}

fn json(value: &impl Serialize) -> String {
    // These values always have a text.
    serde_json::to_string(value).unwrap_or_default()
}

impl Session {
    pub(super) fn show_frame(&self) {
        let fed = self.fibres.case().line;
        let mut frame = Frame::new(self.fibres.snapshot(), &self.recent_motion);
        frame.generation = self.generation;
        frame.stands = self.stands;
        frame.behind = self.clock.is_behind();
        frame.fed = fed.is_some();
        frame.belt_run = fed.map_or(0.0, |line| line.belt_speed * frame.time);
        frame.time = self.now();
        frame.speed = if self.stands { 0.0 } else { self.clock.speed() };
        self.board.show_frame(frame);
    }

    pub(super) fn tell(&mut self) {
        self.statistics_shown = Instant::now();
        let statistics = self.measured.message(self.generation, self.fibres.flight());
        self.board.show_text(Topic::Statistics, json(&statistics));
    }

    /// Shows settings, state, statistics and a frame.
    pub(super) fn show_all(&mut self) {
        let case = self.fibres.case();
        let offered = json(&SettingsMessage { settings: settings(case) });
        if !self.board.shows(Topic::Settings, &offered) {
            self.board.show_text(Topic::Settings, offered);
        }
        self.board.show_text(Topic::State, json(&self.state(case)));
        self.tell();
        self.show_frame();
    }

    fn state<'a>(&'a self, case: &Case) -> State<'a> {
        let line = case.line;
        State {
            generation: self.generation,
            title: self.document.title(),
            text: self.document.text(),
            command: self.document.command(WIDTH),
            values: present(case),
            notes: &self.notes,
            remark: self.remark.as_ref().filter(|_| case.run.scheme == Scheme::ImplicitTension),
            filament: filament(case),
            trouble: &self.trouble,
            pace: self.clock.pace,
            stands: self.stands,
            scheme: case.run.scheme.name(),
            step: Dimension::Time.pretty_to(case.run.time_step, 3),
            instant: Dimension::Time.pretty_to(case.run.output_interval(), 3),
            length_mm: 1e3 * line.map_or(case.fibre.length, |line| line.distance),
            held: case.fibre.root != Root::Free,
            air: case.air.velocity,
            gravity: case.run.gravity,
            cutoff: case.air.cutoff_frequency,
            belt: line.map(|line| Belt { speed: line.belt_speed, feed: line.feed_speed }),
        }
    }
}
