//! What pages see: frames, and as JSON the settings, the state and the statistics.

use super::Session;
use super::frame::Frame;
use super::settings::{present, settings};
use crate::board::Topic;
use serde_json::{Value as Json, json};
use spunlaid::fibre::chain::Scheme;
use spunlaid::fibre::{Case, Root};
use spunlaid::ground::{Dimension, WIDTH};
use spunlaid_results::reports::spinline::files::filament;
use std::time::Instant;

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
        self.board.show_picture(frame);
    }

    pub(super) fn send_statistics(&mut self) {
        self.statistics_shown = Instant::now();
        let statistics = self.measured.message(self.generation, self.fibres.flight());
        self.board.show_text(Topic::Numbers, serde_json::to_string(&statistics).unwrap_or_default());
    }

    /// Shows settings, state, statistics and a frame.
    pub(super) fn show_all(&mut self) {
        let case = self.fibres.case();
        let offered = json!({ "is": "settings", "settings": settings(case) }).to_string();
        if !self.board.shows(Topic::Keys, &offered) {
            self.board.show_text(Topic::Keys, offered);
        }
        self.board.show_text(Topic::State, self.state(case).to_string());
        self.send_statistics();
        self.show_frame();
    }

    /// The state of the flight, as pages get it.
    fn state(&self, case: &Case) -> Json {
        let line = case.line;
        json!({
            "is": "state",
            "generation": self.generation,
            "title": self.document.title(),
            "text": self.document.text(),
            "command": self.document.command(WIDTH),
            "values": present(case),
            "notes": self.notes,
            "remark": self.remark.as_ref().filter(|_| case.run.scheme == Scheme::ImplicitTension),
            // What a fed case says of its filament.
            "filament": filament(case),
            "trouble": self.trouble,
            "pace": self.clock.pace,
            "stands": self.stands,
            "scheme": case.run.scheme.name(),
            "step": Dimension::Time.pretty_to(case.run.time_step, 3),
            // Time from one recorded instant to the next.
            "instant": Dimension::Time.pretty_to(case.run.output_interval(), 3),
            "length_mm": 1e3 * line.map_or(case.fibre.length, |line| line.distance),
            "held": case.fibre.root != Root::Free,
            "air": case.air.velocity,
            "gravity": case.run.gravity,
            "cutoff": case.air.cutoff_frequency,
            "belt": line.map(|line| json!({ "speed": line.belt_speed, "feed": line.feed_speed })),
        })
    }
}
